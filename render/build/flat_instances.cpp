#include "render/build/flat_instances.h"

#include <string>
#include <string_view>
#include <unordered_map>

#include "render/build/placer.h"
#include "scene/limits.h"

namespace lampyr {

namespace {

// Memory of the motion of an instance, with the keys made of it, bytes.
double BytesOfMotion(const MotionChain& chain) {
  return static_cast<double>(chain.Length() * sizeof(AnimatedTransform) + size_t{kMaxMotionKeys} * sizeof(Affine));
}

}  // namespace

// Without recursion, because objects may be nested as deep as a file is long.
std::vector<FlatInstance> FlattenInstances(const SceneDescription& description, const std::vector<bool>& hasShapes,
                                           MemoryBudget& memory) {
  std::vector<FlatInstance> instances;
  if (!description.instances.empty()) {
    constexpr double bytesPerInstance = 1024;  // here and in the intersector
    memory.Take(
        description.instanceCount * bytesPerInstance, description.instances.front().where,
        std::to_string(static_cast<uint64_t>(description.instanceCount)) + " instances, of which this is the first,");
  }
  std::unordered_map<std::string_view, size_t> objects;
  for (size_t i = 0; i < description.objects.size(); ++i) objects.emplace(description.objects[i].name, i);
  struct Visit {
    const InstanceDescription* instance;
    Transform parent;
    std::shared_ptr<const MotionChain> parentMotion;
  };
  std::vector<Visit> open;
  const auto add = [&open](const std::vector<InstanceDescription>& list, const Transform& parent,
                           const std::shared_ptr<const MotionChain>& parentMotion) {
    for (size_t i = list.size(); i-- > 0;) open.push_back({&list[i], parent, parentMotion});
  };
  add(description.instances, Transform(), nullptr);
  while (!open.empty()) {
    const Visit visit = open.back();
    open.pop_back();
    const InstanceDescription& instance = *visit.instance;
    const Transform toWorld = visit.parent * instance.placement.start;
    std::shared_ptr<const MotionChain> motion;
    if (visit.parentMotion || instance.placement.IsAnimated()) {
      const MotionChain parent = visit.parentMotion ? *visit.parentMotion : MotionChain(visit.parent);
      const AnimatedTransform own = ToAnimated(instance.placement, "an instance", instance.where);
      motion = std::make_shared<const MotionChain>(parent * own);
      if (motion->Length() > limits::kNestedNames)
        throw Error(instance.where, "motions are nested more than 256 deep: instances that move within others that do");
      memory.Take(BytesOfMotion(*motion), instance.where, "the motions of instances within one another");
    }
    const size_t object = objects.at(instance.object);
    if (hasShapes[object]) instances.push_back({object, toWorld, motion, &instance});
    add(description.objects[object].instances, toWorld, motion);
  }
  return instances;
}

}  // namespace lampyr
