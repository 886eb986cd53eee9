// The emitters for selection by importance: all lights with a position, and each triangle of a mesh light.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "lights/selection/importance.h"

namespace lampyr {

struct Emitters {
  // The light and patch of an emitter, as returned by selection.
  struct Patch {
    uint32_t light;
    int patch;  // kAnyPatch: the light has only one
  };
  std::vector<ClusterBounds> bounds;  // relative to center, size and intensity below; empty of those that emit nothing
  std::vector<uint32_t> first;        // by light: its first emitter; patches follow each other. One more at the end
  std::vector<uint32_t> lightAt;      // for every kStep-th emitter: index into `first`, where a search starts
  std::vector<uint32_t> far;          // lights without a position; they are emitters with empty bounds
  Point3 center{0.0f};
  float size = 1;           // render space units
  double intensity = 0;     // W/sr, sum over all emitters
  bool hasPatches = false;  // some light has more than one emitter

  Patch PatchOf(uint32_t emitter) const { return hasPatches ? FindPatch(emitter) : Patch{emitter, kAnyPatch}; }
  static constexpr uint32_t kStep = 32;
  // Computes lightAt from `first`.
  void IndexLights();

  Patch FindPatch(uint32_t emitter) const;

  // Converts an importance to irradiance, W/m².
  double Irradiance(double importance) const {
    return importance * intensity / (static_cast<double>(size) * static_cast<double>(size));
  }
  double ImportanceOf(double irradiance) const { return irradiance / Irradiance(1); }
  TreeReceiver Place(const Receiver& receiver) const {
    return {(receiver.position - center) * (1 / size), receiver.normal, receiver.isTransmissive, nullptr, 0};
  }
};

Emitters CollectEmitters(std::span<const PlacedLight> lights, const BoundingSphere& scene, int threads);

}  // namespace lampyr
