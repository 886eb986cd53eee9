// The scene as integrators see it, the counts that they keep, and the sampler's dimensions that paths draw from.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "camera/camera.h"
#include "geometry/geometry_scene.h"
#include "lights/services/lighting_services.h"
#include "materials/material.h"

namespace lampyr {

// Immutable, and cheap to copy: a pass may be given the same scene with another view of the lights
// (LightingServices::With). Lights are reached through `lighting` only.
struct RenderScene {
  std::shared_ptr<const GeometryScene> geometry;
  std::vector<std::shared_ptr<const Material>> materials;  // by GeometryAttributes::material
  std::shared_ptr<const LightingServices> lighting;
  std::shared_ptr<const Camera> camera;
  bool hasMotion = false;  // something moves during the shutter: rays have a time; otherwise it stays 0
};

// Kept per tile of work and summed afterwards: no thread shares one.
struct RenderCounts {
  uint64_t cameraRays = 0;
  uint64_t indirectRays = 0;
  uint64_t shadowRays = 0;
  uint64_t foundPhotons = 0;  // by lookups of photons
  uint64_t lookups = 0;       // of photons
  uint64_t timedLookups = 0;
  double lookupSeconds = 0;     // of those
  uint64_t droppedSamples = 0;  // NaN, infinite or negative: a defect, counted and reported

  RenderCounts& operator+=(const RenderCounts& other);
  uint64_t Rays() const { return cameraRays + indirectRays + shadowRays; }
};

// Sampler dimensions: the film and lens come first, then a fixed block per path vertex, so that the same decision of
// two paths of a pixel is always made by the same dimension and stays stratified.
namespace dimensions {
inline constexpr uint32_t kFilm = 0;
inline constexpr uint32_t kLens = 1;
inline constexpr uint32_t kTime = 2;
inline constexpr uint32_t kFirstVertex = 3;
// Within a vertex's block:
inline constexpr uint32_t kLightSelection = 0;
inline constexpr uint32_t kLight = 1;
inline constexpr uint32_t kLobe = 2;
inline constexpr uint32_t kDirection = 3;
inline constexpr uint32_t kRoulette = 4;
inline constexpr uint32_t kPerVertex = 5;
}  // namespace dimensions

// Where a path draws from: vertex v has the block step · v + first. The two paths of a bidirectional sample take turns.
//
// The first surface vertex of a path from the camera is 0. For paths from a light, 0 is the light (kLightSelection,
// kLight: the position on it, kDirection) and the first surface vertex is 1, where kLight chooses the point of the lens
// to connect to. The light itself is connected to the lens by dimensions::kLens or, where a camera path has that, by
// its kRoulette.
struct PathDimensions {
  int step = 1, first = 0;
  constexpr uint32_t Of(int vertex, uint32_t which) const {
    return dimensions::kFirstVertex + static_cast<uint32_t>(step * vertex + first) * dimensions::kPerVertex + which;
  }
};

}  // namespace lampyr
