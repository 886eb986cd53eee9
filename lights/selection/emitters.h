// The emitters of a scene as selection by importance knows them: all lights with a place, meshes triangle by triangle.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "lights/selection/importance.h"

namespace lampyr {

struct Emitters {
  // What selection gives for an emitter.
  struct Patch {
    uint32_t light;
    int patch;  // kAnyPatch: the light has only one
  };
  std::vector<ClusterBounds> bounds;  // relative to center, size and intensity below; empty of those that emit nothing
  std::vector<uint32_t> first;        // by light: its first emitter; patches follow each other. One more at the end
  std::vector<uint32_t> lightAt;      // of every kStep-th emitter: where to look in `first`
  std::vector<uint32_t> far;          // lights without a place: emitters, too, but empty ones
  Point3 center{0.0f};
  float size = 1;           // render space units
  double intensity = 0;     // W/sr, of all
  bool hasPatches = false;  // some light has more than one emitter

  Patch PatchOf(uint32_t emitter) const { return hasPatches ? FindPatch(emitter) : Patch{emitter, kAnyPatch}; }
  static constexpr uint32_t kStep = 32;
  // Makes lightAt of `first`.
  void IndexLights();

  Patch FindPatch(uint32_t emitter) const;

  // An importance as irradiance, W/m².
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
