// The contract between an integrator and who renders with it: what is asked for, a sample of a pixel or a path from a
// light, and where its parts go.
#pragma once

#include <cstdint>
#include <optional>

#include "film/layer_sample.h"
#include "film/splats.h"
#include "integrators/walk/render_scene.h"
#include "sampling/sampler.h"

namespace lampyr {

class PathObserver;  // bidirectional/connected_path.h
class PhotonList;    // photon/photon.h
struct PhotonPass;   // photon/photon_pass.h

// What an integrator traces for a sample.
enum class TracedPaths {
  Camera,  // a path along the ray
  Light,   // a path from a light, splatted wherever the camera sees it; there is no ray
  Both,    // one of either
};

// How an integrator that gathers photons wants them.
struct PhotonSettings {
  double radius = 0;        // of the first pass, scene units; 0: chosen by the integrator
  double alpha = 2. / 3;    // how fast the radius shrinks: as pass^((alpha - 1) / 2); 1: never
  uint64_t lightPaths = 0;  // whose photons a pass gathers; 0: as many as the full image has pixels
  uint64_t mostBytes = 0;   // of photons, while a map is made of them; 0: whatever it takes
  bool guided = true;       // learn where photons are of use, and aim them there if it pays (emission_learning.h)
};

// One sample: the scene, what it draws from, what it may use, and where its parts go besides what it returns.
struct SampleContext {
  const RenderScene& scene;
  Sampler& sampler;  // has been started for the sample
  float time;        // of all of its paths, in [0,1] over the shutter
  RenderCounts& counts;
  // What the sample returns, split by LightingServices::GroupOf the light that it comes from; null: not wanted. The
  // caller has cleared it.
  LayerSample* layers = nullptr;
  // Started for the light path. Splats are what a single path contributes: the film divides by the number of paths, and
  // each is of the layer of its light's group. Null where no light path is traced.
  SplatList* splats = nullptr;
  PathObserver* observer = nullptr;    // is told of every path that contributes
  const PhotonPass* gather = nullptr;  // the photons that may be used; null: none yet
  PhotonList* photons = nullptr;       // where those of this sample's light path go; null: not wanted
  bool withOrigin = false;             // and the origin of that path
  bool isForPhotonsAlone = false;      // nothing else of the light path is wanted: it is not connected to the camera
};

// Stateless: any thread may call it.
class Integrator {
 public:
  virtual ~Integrator() = default;

  virtual TracedPaths Paths() const = 0;
  // An estimate of the radiance that arrives along `ray`, and splats and photons of the light path. Without a ray
  // (null: the pixel is not wanted, or the integrator traces light paths alone) only those, and black. Of light paths,
  // as many as the full image has pixels are a sample per pixel.
  virtual Color Sample(const Ray* ray, const SampleContext& context) const = 0;
  // Of an integrator that gathers photons; nullopt: it does not.
  virtual std::optional<PhotonSettings> Photons() const { return std::nullopt; }
};

}  // namespace lampyr
