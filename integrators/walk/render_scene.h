// The scene as integrators see it, the counters that they keep, and the layout of sampler dimensions.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "camera/camera.h"
#include "film/output_plan.h"
#include "geometry/geometry_scene.h"
#include "integrators/guide/path_guide.h"
#include "integrators/guide/path_roulette.h"
#include "lights/services/lighting_services.h"
#include "materials/material.h"
#include "media/medium.h"
#include "media/surface_tints.h"
#include "spectral/wavelengths.h"

namespace lampyr {

// Immutable and cheap to copy. A pass may be given a copy with another view of the lights (LightingServices::With), and
// with a guide.
// Integrators reach lights only through `lighting`.
struct RenderScene {
  std::shared_ptr<const GeometryScene> geometry;
  std::vector<std::shared_ptr<const Material>> materials;  // by GeometryAttributes::material
  std::shared_ptr<const LightingServices> lighting;
  std::shared_ptr<const Camera> camera;
  std::vector<std::shared_ptr<const Medium>> media;  // by GeometryAttributes::insideMedium and outsideMedium
  int32_t cameraMedium = kVacuum;                    // where camera rays start (MediumOf)
  // Medium of camera rays that hit no surface from which it follows. Set if camera rays start in several media (the
  // camera is on a boundary, or a boundary cuts it), or may do so because something moves.
  std::optional<int32_t> cameraExterior;
  std::shared_ptr<const OutputPlan> outputs;  // layers of the image; not null in scenes that were built
  int32_t exterior = kVacuum;                 // where rays leave the scene, and lights at infinity shine from
  std::vector<int32_t> lightMedia;            // by light: around it, or in front of it; empty: vacuum
  std::vector<int32_t>
      lightBackMedia;  // by light: behind its surface, where a two-sided light shines, too; empty: vacuum
  std::vector<uint8_t> lightStartsVary;  // by light: whether its rays start in several media, as cameraExterior has it
  std::optional<int32_t>
      unbounded;  // medium of points around which only opaque surfaces bound media; set if the camera is such a point
  std::shared_ptr<const PathGuide> guide;  // guide of walks after wide scattering; null: walks are not guided
  // Russian roulette of camera paths after wide scattering; null: by throughput alone.
  std::shared_ptr<const PathRoulette> roulette;
  // Light is carried by wavelength: each pass is given the scene at its wavelengths (AtWavelengths), and
  // `wavelengths` is null in the scene from which these are made, whose colours are in Rec. 709.
  bool isSpectral = false;
  std::shared_ptr<const Wavelengths> wavelengths;
  std::vector<std::shared_ptr<const Material>> tunedAfterWide;  // WalkSettings::materialsAfterWide at the wavelengths
  bool hasMotion = false;  // something moves while the shutter is open; otherwise all rays have time 0
  // There are flat curves that are no fibres. They turn to the ray that meets them, so that paths from lights meet
  // other surfaces than paths from the camera.
  bool hasTurningCurves = false;

  // The scene at the wavelengths of a pass. `afterWide`: materials behind a wide scattering, or none.
  RenderScene AtWavelengths(const std::shared_ptr<const Wavelengths>& wavelengths,
                            const std::vector<std::shared_ptr<const Material>>& afterWide) const;
  // GeometryScene::Transmittance and GeometryScene::Intersect, with colours at the scene's wavelengths; for scenes
  // without media.
  Color Transmittance(const Ray& ray, uint32_t kinds) const {
    if (!wavelengths) [[likely]]
      return geometry->Transmittance(ray, kinds);
    return TransmittanceAt(*wavelengths, *geometry, ray, kinds);
  }
  bool Intersect(const Ray& ray, uint32_t kinds, RayHit& hit, Color& tint) const {
    if (!wavelengths) [[likely]]
      return geometry->Intersect(ray, kinds, hit, tint);
    return IntersectAt(*wavelengths, *geometry, ray, kinds, hit, tint);
  }
  // Medium in which a camera ray starts.
  int32_t MediumOf(const Ray& cameraRay) const;
  // Medium in which light of `light` starts along `ray`; `fromBehind`: of a surface that shines to both sides.
  int32_t MediumOfLight(uint32_t light, bool fromBehind, const Ray& ray) const;
};

// Counted per tile of work and summed afterwards; never shared between threads.
struct RenderCounts {
  uint64_t cameraRays = 0;
  uint64_t indirectRays = 0;
  uint64_t shadowRays = 0;
  uint64_t foundPhotons = 0;  // in all lookups
  uint64_t lookups = 0;       // photon lookups
  uint64_t timedLookups = 0;
  double lookupSeconds = 0;     // of the timed lookups
  uint64_t droppedSamples = 0;  // NaN, infinite or negative: a defect, counted and reported

  RenderCounts& operator+=(const RenderCounts& other);
  uint64_t Rays() const { return cameraRays + indirectRays + shadowRays; }
};

// Sampler dimensions: film, lens and time come first, then a fixed block per path vertex. The same decision uses the
// same dimension in all samples of a pixel, so that it stays stratified.
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
// Beyond the blocks of all vertices: one pair for each edge of a path.
inline constexpr uint32_t kFirstFlight = 1u << 24;
// Beyond those: three pairs for each edge, for a vertex in a medium on it that is sampled for a light.
inline constexpr uint32_t kFirstSegment = 1u << 25;
inline constexpr uint32_t kSegmentChoice = 0;  // light and distance
inline constexpr uint32_t kSegmentApex = 1;
inline constexpr uint32_t kSegmentLight = 2;
inline constexpr uint32_t kPerSegment = 3;
}  // namespace dimensions

// The blocks of dimensions of a path: vertex v has the block step · v + first. The two subpaths of a bidirectional
// sample use alternating blocks.
//
// On camera paths vertex 0 is the first surface vertex. On light paths vertex 0 is the light (kLightSelection, kLight
// for the position on it, kDirection) and vertex 1 the first surface vertex, where kLight samples the lens point of a
// connection. A connection from the light itself samples its lens point by dimensions::kLens or, where the camera path
// of the sample uses that, by the light's kRoulette.
struct PathDimensions {
  int step = 1, first = 0;
  constexpr uint32_t Of(int vertex, uint32_t which) const {
    return dimensions::kFirstVertex + static_cast<uint32_t>(step * vertex + first) * dimensions::kPerVertex + which;
  }
  // Dimension of the pair for the flight through participating media to vertex v.
  constexpr uint32_t OfFlight(int vertex) const {
    return dimensions::kFirstFlight + static_cast<uint32_t>(step * vertex + first);
  }
  // Dimension of a pair for distance sampling on the edge to vertex v.
  constexpr uint32_t OfSegment(int vertex, uint32_t which) const {
    return dimensions::kFirstSegment + static_cast<uint32_t>(step * vertex + first) * dimensions::kPerSegment + which;
  }
};

}  // namespace lampyr
