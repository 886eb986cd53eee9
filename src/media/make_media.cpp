// The table of types of media.
#include "media/make_media.h"

#include <algorithm>
#include <cstdio>

#include "media/box_medium.h"
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

// Paths through a grid have tentative collisions by its majorant, step by step: their number has to be bounded.
void CheckDepth(const Medium& medium, const FileLocation& where) {
  constexpr double kMost = 1e8;
  const MajorantGrid* grid = medium.Majorants();
  if (!grid || grid->Values().empty()) return;
  const double largest = *std::max_element(grid->Values().begin(), grid->Values().end());
  const Affine toRender = dynamic_cast<const BoxMedium&>(medium).ToSpace().Inverse();
  const double depth = largest * glm::length(Vector3d(toRender.Vector(grid->Bounds().Diagonal())));
  if (depth <= kMost) return;
  char text[160];
  std::snprintf(
      text, sizeof text,
      "this medium is too dense: its optical depth from corner to corner is up to %.2g, and at most 1e8 can be "
      "followed; a lower \"scale\" or density looks the same",
      depth);
  throw Error(where, text);
}

std::shared_ptr<const Medium> MakeMedium(const MediumDescription& description, const Transform& renderFromWorld,
                                         MemoryBudget& memory, Diagnostics& diagnostics) {
  const ParameterList& parameters = description.medium.parameters;
  const FileLocation& where = description.medium.where;
  const Transform renderFromMedium = renderFromWorld * description.placement.start;
  if (!renderFromMedium.IsAffine()) throw Error(where, "a medium cannot have a perspective transform");
  for (const MediumType& type : kTypes) {
    if (description.medium.type != type.name) continue;
    std::shared_ptr<const Medium> medium = type.make({description, renderFromMedium, memory, diagnostics});
    CheckDepth(*medium, where);
    return medium;
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
