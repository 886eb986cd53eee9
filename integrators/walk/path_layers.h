// Contributions of paths to the layers of a sample. All functions but LabelsOfLast require SampleContext::layers.
#pragma once

#include "integrators/walk/integrator.h"
#include "integrators/walk/path_labels.h"
#include "integrators/walk/walk.h"

namespace lampyr {

// Adds `value`, of paths whose subpaths have these labels.
void AddToLayers(const SampleContext& context, std::span<const PathLabel> camera, std::span<const PathLabel> light,
                 const Color& value);

// Adds `value`, of light that `path`, a camera subpath, finds along its ray after `event` at its last vertex. Without
// vertices the camera sees it. `source`: label of the light.
void AddFoundToLayers(const SampleContext& context, const Subpath& path, const ScatteringParts& event, uint32_t source,
                      const Color& value);

// Adds `value`, of light that arrives at the last vertex of a camera subpath and has these labels; `event`: there.
void AddArrivingToLayers(const SampleContext& context, const Subpath& path, const ScatteringParts& event,
                         std::span<const PathLabel> light, const Color& value);

// The labels of a path at its last vertex, for its photon; nullopt without layers.
inline std::optional<std::span<const PathLabel>> LabelsOfLast(const SampleContext& context, const Subpath& path) {
  if (!context.outputs) [[likely]]
    return std::nullopt;
  return path.LabelsAt(path.Count() - 1);
}

}  // namespace lampyr
