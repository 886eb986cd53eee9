#include "lights/selection/emitters.h"

#include <algorithm>
#include <limits>

#include "base/parallel.h"

namespace lampyr {

namespace {

// Bounds of a moving light over the shutter: all positions, including those between the sampled times, and all
// directions.
ClusterBounds BoundsWhileMoving(const PlacedLight& placed, LightContext context) {
  constexpr int steps = 64;
  ClusterBounds all;
  Bounds3 before;
  Vector3 farthest(0.0f);
  for (int i = 0; i <= steps; ++i) {
    context.time = static_cast<float>(i) / steps;
    const LightTransform transform = placed.At(context.time);
    context.transform = &transform;
    const auto bounds = placed.light->GetEmissionBounds(context);
    if (!bounds) return {};
    const ClusterBounds now = BoundsOfEmitter(*bounds, placed.light->Kind());
    if (now.IsEmpty()) continue;
    if (!before.IsEmpty()) {
      farthest = glm::max(farthest, glm::max(Abs(now.box.min - before.min), Abs(now.box.max - before.max)));
    }
    before = now.box;
    all.box.Add(now.box);
    all.intensity = std::max(all.intensity, now.intensity);
  }
  if (all.IsEmpty()) return all;
  all.box.min -= farthest;
  all.box.max += farthest;
  all.cosThetaO = -1;
  all.cosThetaE = 0;
  return all;
}

ClusterBounds BoundsOfPatch(const PlacedLight& placed, int patch, const BoundingSphere& scene) {
  LightContext context;
  context.transform = &placed.transform;
  context.scene = scene;
  context.patch = patch;
  ClusterBounds result;
  if (placed.motion) {
    result = BoundsWhileMoving(placed, context);
  } else if (const auto bounds = placed.light->GetEmissionBounds(context)) {
    result = BoundsOfEmitter(*bounds, placed.light->Kind());
  }
  result.intensity = std::min(result.intensity * placed.radianceModifier, std::numeric_limits<float>::max());
  return result;
}

// Makes positions and intensities relative (light_bounds.h).
void Normalise(Emitters& emitters) {
  Bounds3 all;
  for (const ClusterBounds& bounds : emitters.bounds) {
    all.Add(bounds.box);
    emitters.intensity += static_cast<double>(bounds.intensity);
  }
  if (all.IsEmpty()) return;
  emitters.center = all.Center();
  // Lights that share one position have no extent; their size is arbitrary and set to 1.
  emitters.size = 0.5f * glm::length(all.Diagonal());
  if (!(emitters.size > std::numeric_limits<float>::min())) emitters.size = 1;
  // Energies are estimates, so an emitter whose estimate is 0 or negligible keeps a minimum intensity and can be
  // selected.
  const double floor = 1e-3 / static_cast<double>(emitters.bounds.size());
  if (!(emitters.intensity > 0)) emitters.intensity = 1;
  for (ClusterBounds& bounds : emitters.bounds) {
    if (bounds.IsEmpty()) continue;
    bounds.box.min = (bounds.box.min - emitters.center) * (1 / emitters.size);
    bounds.box.max = (bounds.box.max - emitters.center) * (1 / emitters.size);
    bounds.FillBox();
    bounds.intensity = static_cast<float>(std::max(static_cast<double>(bounds.intensity) / emitters.intensity, floor));
  }
}

}  // namespace

void Emitters::IndexLights() {
  const size_t lights = first.size() - 1;
  lightAt.clear();
  uint32_t light = 0;
  for (uint64_t emitter = 0; emitter < uint64_t{first.back()} + kStep; emitter += kStep) {
    while (light + 1 < lights && first[light + 1] <= emitter) ++light;
    lightAt.push_back(light);
  }
}

// The light is that at the start of the step of the emitter, or one of those up to the start of the next step. The
// search is short and reads a few bytes per light, independent of the number of patches.
Emitters::Patch Emitters::FindPatch(uint32_t emitter) const {
  const auto from = first.begin() + lightAt[emitter / kStep], to = first.begin() + lightAt[emitter / kStep + 1] + 1;
  const auto next = std::upper_bound(from, to, emitter);
  const auto light = static_cast<uint32_t>(next - first.begin()) - 1;
  return {light, *next - first[light] > 1 ? static_cast<int>(emitter - first[light]) : kAnyPatch};
}

Emitters CollectEmitters(std::span<const PlacedLight> lights, const BoundingSphere& scene, int threads) {
  Emitters emitters;
  uint32_t count = 0;
  for (uint32_t i = 0; i < lights.size(); ++i) {
    emitters.first.push_back(count);
    if (IsAtInfinity(lights[i].light->Kind())) emitters.far.push_back(i);
    const int patches = lights[i].light->PatchCount();
    emitters.hasPatches |= patches > 1;
    count += static_cast<uint32_t>(patches);
  }
  emitters.first.push_back(count);
  if (emitters.hasPatches) emitters.IndexLights();
  emitters.bounds.resize(count);
  constexpr size_t kChunk = 4096;
  const auto chunks = static_cast<int>((emitters.bounds.size() + kChunk - 1) / kChunk);
  ParallelFor(chunks, threads, [&](int chunk) {
    const size_t begin = static_cast<size_t>(chunk) * kChunk;
    for (size_t e = begin; e < std::min(begin + kChunk, emitters.bounds.size()); ++e) {
      const Emitters::Patch own = emitters.PatchOf(static_cast<uint32_t>(e));
      if (!IsAtInfinity(lights[own.light].light->Kind()))
        emitters.bounds[e] = BoundsOfPatch(lights[own.light], own.patch, scene);
    }
  });
  Normalise(emitters);
  return emitters;
}

}  // namespace lampyr
