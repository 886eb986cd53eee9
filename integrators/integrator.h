// What all integrators share: the scene as they see it, their settings, and the counts they keep; and what they are
// asked for, a sample of a pixel or a path from a light.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "camera/camera.h"
#include "film/layer_sample.h"
#include "film/splats.h"
#include "geometry/geometry_scene.h"
#include "lights/services/lighting_services.h"
#include "materials/material.h"
#include "sampling/sampler.h"

namespace lampyr {

// The scene, built and immutable. Lights are reached through `lighting` only.
struct RenderScene {
  std::unique_ptr<GeometryScene> geometry;
  std::vector<std::shared_ptr<const Material>> materials;  // by GeometryAttributes::material
  std::unique_ptr<LightingServices> lighting;
  std::unique_ptr<Camera> camera;
  bool hasMotion = false;  // something moves during the shutter: rays have a time; otherwise it stays 0
};

class PathObserver;  // integrators/bdpt/bdpt_path.h
class PhotonList;    // integrators/common/photon.h
struct PhotonPass;   // integrators/common/photon_pass.h

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

// Of vertex `vertex` of a path: the first surface is 0 for paths from the camera. For paths from a light, 0 is the
// light (kLightSelection, kLight: the position on it, kDirection) and the first surface is 1, where kLight chooses the
// point of the lens to connect to. The light itself is connected to the lens by kLens.
constexpr uint32_t OfVertex(int vertex, uint32_t which) {
  return kFirstVertex + static_cast<uint32_t>(vertex) * kPerVertex + which;
}
}  // namespace dimensions

// An integrator that estimates the radiance along one camera ray at a time. Stateless: any thread may call it.
class CameraIntegrator {
 public:
  virtual ~CameraIntegrator() = default;
  // One sample of the radiance that arrives along `ray`. `sampler` has been started for the pixel sample. `layers`: see
  // SampleSinks.
  virtual Color Radiance(const Ray& ray, Sampler& sampler, RenderCounts& counts, LayerSample* layers) const = 0;
};

// An integrator that follows one path at a time from a light and splats it wherever the camera sees it. As many paths
// as the full image has pixels are a sample per pixel. Stateless: any thread may call it.
class LightPathIntegrator {
 public:
  virtual ~LightPathIntegrator() = default;
  // `sampler` has been started for the path, `splats` too. Splats are what a single path would contribute: the film
  // divides by the number of paths, and each is of the layer of its light's group. `time` is that of the whole path.
  virtual void TracePath(float time, Sampler& sampler, SplatList& splats, RenderCounts& counts) const = 0;
};

// How an integrator that gathers photons wants them.
struct PhotonSettings {
  double radius = 0;        // of the first pass, scene units; 0: chosen by the integrator
  double alpha = 2. / 3;    // how fast the radius shrinks: as pass^((alpha - 1) / 2); 1: never
  uint64_t lightPaths = 0;  // whose photons a pass gathers; 0: as many as the full image has pixels
  uint64_t mostBytes = 0;   // of photons, while a map is made of them; 0: whatever it takes
  bool guided = true;       // learn where photons are of use, and aim them there if it pays (emission_learning.h)
};

// Where a sample goes, besides what it returns, and what it may use.
struct SampleSinks {
  SplatList& splats;
  RenderCounts& counts;
  PathObserver* observer = nullptr;    // is told of all that the sample is made of
  const PhotonPass* gather = nullptr;  // the photons that may be used; null: none yet
  PhotonList* photons = nullptr;       // where those of this sample's light path go; null: nobody wants them
  bool withOrigin = false;             // and where that path comes from
  bool isForPhotonsAlone = false;      // nothing else of the light path is wanted: it is not connected to the camera
  // What the sample returns, split by LightingServices::GroupOf the light that it comes from; null: nobody wants it.
  // The caller has cleared it.
  LayerSample* layers = nullptr;
};

// An integrator that follows a path from the camera and one from a light together. Stateless: any thread may call it.
class BidirectionalIntegrator {
 public:
  virtual ~BidirectionalIntegrator() = default;
  // One sample of the radiance along `ray`, and splats of the light path wherever the camera sees it; one light path is
  // traced per sample of each pixel of the full image. Without a ray (null: the pixel is not wanted) only splats and
  // photons. `time` is that of both paths.
  virtual Color Sample(const Ray* ray, float time, Sampler& sampler, const SampleSinks& sinks) const = 0;
  // Of an integrator that uses photons; nullopt: it does not.
  virtual std::optional<PhotonSettings> Photons() const { return std::nullopt; }
};

}  // namespace lampyr
