#include "integrators/walk/path_layers.h"

namespace lampyr {

void AddToLayers(const SampleContext& context, std::span<const PathLabel> camera, std::span<const PathLabel> light,
                 const Color& value) {
  for (const LayerShare& part : SharesOf(*context.outputs, camera, light))
    context.layers->Add(part.layer, value * part.share);
}

void AddArrivingToLayers(const SampleContext& context, const Subpath& path, const ScatteringParts& event,
                         std::span<const PathLabel> light, const Color& value) {
  thread_local PathLabels camera;
  path.LabelsBeyond(*context.outputs, TransportMode::Radiance, event, camera);
  AddToLayers(context, camera.All(), light, value);
}

void AddFoundToLayers(const SampleContext& context, const Subpath& path, const ScatteringParts& event, uint32_t source,
                      const Color& value) {
  const PathLabel light[] = {{source}};
  AddArrivingToLayers(context, path, event, light, value);
}

}  // namespace lampyr
