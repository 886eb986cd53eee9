// Checks that need the whole scene: every name that is used is defined, no object contains itself, and cameras, media
// and textures under a moving transform are placed at shutter open.
#include "scene/scene_parser.h"

#include "math/motion.h"

namespace lampyr {

namespace {

template <class Map>
std::vector<std::string> Names(const Map& map) {
  std::vector<std::string> names;
  for (const auto& entry : map) names.push_back(entry.first);
  return names;
}

template <class Map>
void CheckName(const Map& defined, const char* what, const std::string& name, const FileLocation& where) {
  if (defined.count(name) != 0) return;
  throw Error(where, std::string("there is no ") + what + " \"" + name + "\"" + DidYouMean(name, Names(defined)));
}

}  // namespace

void SceneParser::CheckReferences() const {
  for (const NameUse& use : materialUses_) CheckName(namedMaterials_, "material", use.name, use.where);
  for (const NameUse& use : mediumUses_) CheckName(media_, "medium", use.name, use.where);
  for (const InstanceDescription& instance : scene_.instances)
    CheckName(objects_, "object", instance.object, instance.where);
  for (const ObjectDescription& object : scene_.objects) {
    for (const InstanceDescription& instance : object.instances)
      CheckName(objects_, "object", instance.object, instance.where);
  }
}

MotionTimes MotionTimesOf(const SceneDescription& description) {
  const StatementDescription& camera = description.camera;
  const double open = camera.parameters.GetFloat("shutteropen", 0),
               close = camera.parameters.GetFloat("shutterclose", 1);
  if (!(close > open)) throw Error(camera.where, "\"shutterclose\" must be after \"shutteropen\"");
  return {(description.shutterOpen - open) / (close - open), (description.shutterClose - open) / (close - open)};
}

// Camera, media and textures do not move.
void SceneParser::StopWhatCannotMove() {
  const auto stop = [&](Placement& placement, const char* what, const FileLocation& where, const char* warning) {
    if (!placement.IsAnimated()) return;
    diagnostics_.Warn(where, warning);
    const double fraction = MotionTimesOf(scene_).FractionAt(0);
    if (fraction >= 1) placement.start = placement.end;
    if (fraction > 0 && fraction < 1)
      placement.start = AnimatedTransform(placement.start, placement.end, what, where).At(fraction);
    placement.end = placement.start;
  };
  stop(scene_.cameraToWorld, "a camera", scene_.camera.where,
       "a moving camera is not supported yet; its place at shutter open is used");
  for (MediumDescription& medium : scene_.media)
    stop(medium.placement, "a medium", medium.medium.where,
         "media do not move, as in pbrt-v4: this one stays where it is when the shutter opens");
  for (TextureDescription& texture : scene_.textures)
    stop(texture.placement, "a texture", texture.texture.where,
         "moving textures are not supported: the placement at shutter open is used");
}

// Depth-first search without recursion: objects may be nested as deep as a file is long. Nested instances multiply, so
// that a few lines can describe more than any memory holds.
void SceneParser::CountInstances() {
  enum class Mark { New, Open, Done };
  std::vector<Mark> marks(scene_.objects.size(), Mark::New);
  std::vector<double> within(scene_.objects.size(), 0);  // nested instances per instance of the object
  const auto count = [&](const std::vector<InstanceDescription>& list) {
    constexpr double most = 1e7;
    double sum = 0;
    for (const InstanceDescription& instance : list) {
      const double nested = within[objects_.at(instance.object)];
      sum += 1 + nested;
      if (nested > 0 && sum > most) throw Error(instance.where, "nested instances multiply to more than 10 million");
    }
    return sum;
  };
  struct Visit {
    int object;
    size_t next = 0;
  };
  for (size_t root = 0; root < scene_.objects.size(); ++root) {
    if (marks[root] != Mark::New) continue;
    std::vector<Visit> path = {{static_cast<int>(root)}};
    marks[root] = Mark::Open;
    while (!path.empty()) {
      const ObjectDescription& object = scene_.objects[path.back().object];
      if (path.back().next == object.instances.size()) {
        marks[path.back().object] = Mark::Done;
        within[path.back().object] = count(object.instances);
        path.pop_back();
        continue;
      }
      const InstanceDescription& instance = object.instances[path.back().next++];
      const int inner = objects_.at(instance.object);
      if (marks[inner] == Mark::Open) {
        std::string chain;
        bool inCircle = false;
        for (const Visit& visit : path) {
          inCircle |= visit.object == inner;
          if (inCircle) chain += "\"" + scene_.objects[visit.object].name + "\" -> ";
        }
        throw Error(instance.where, "an object that contains itself: " + chain + "\"" + instance.object + "\"");
      }
      if (marks[inner] == Mark::Done) continue;
      marks[inner] = Mark::Open;
      path.push_back({inner});
    }
  }
  scene_.instanceCount = count(scene_.instances);
}

}  // namespace lampyr
