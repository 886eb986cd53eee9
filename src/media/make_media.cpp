// The table of types of media.
#include "media/make_media.h"

#include "media/medium_makers.h"

namespace lampyr {

namespace {

struct MediumType {
  const char* name;
  std::shared_ptr<const Medium> (*make)(const MediumInput&);
};

constexpr MediumType kTypes[] = {{"homogeneous", MakeHomogeneous},
                                 {"uniformgrid", MakeUniformGrid},
                                 {"rgbgrid", MakeRgbGrid},
                                 {"cloud", MakeCloud},
                                 {"nanovdb", MakeNanoVdb}};

std::shared_ptr<const Medium> MakeMedium(const MediumDescription& description, const Transform& renderFromWorld,
                                         MemoryBudget& memory, Diagnostics& diagnostics) {
  const ParameterList& parameters = description.medium.parameters;
  const FileLocation& where = description.medium.where;
  if (description.placement.IsAnimated()) {
    diagnostics.Warn(where, "media do not move, as in pbrt-v4: this one stays where it is when the shutter opens");
  }
  const Transform renderFromMedium = renderFromWorld * description.placement.start;
  if (!renderFromMedium.IsAffine()) throw Error(where, "a medium cannot have a perspective transform");
  for (const MediumType& type : kTypes) {
    if (description.medium.type == type.name) return type.make({description, renderFromMedium, memory, diagnostics});
  }
  const std::string& given = description.medium.type;
  throw Error(parameters.WhereOf("type"),
              "there is no medium of type \"" + given + "\"" + DidYouMean(given, MediumTypeNames()));
}

}  // namespace

std::vector<std::string> MediumTypeNames() {
  std::vector<std::string> names;
  for (const MediumType& type : kTypes) names.emplace_back(type.name);
  return names;
}

std::vector<std::shared_ptr<const Medium>> MakeMedia(const SceneDescription& description,
                                                     const Transform& renderFromWorld, MemoryBudget& memory,
                                                     Diagnostics& diagnostics) {
  std::vector<std::shared_ptr<const Medium>> media;
  for (const MediumDescription& medium : description.media) {
    media.push_back(MakeMedium(medium, renderFromWorld, memory, diagnostics));
  }
  return media;
}

}  // namespace lampyr
