// The integrator interface. A pass asks for samples, of a pixel or of a light path; the SampleContext holds what a
// sample reads and where its results go.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "film/layer_sample.h"
#include "film/output_plan.h"
#include "film/splats.h"
#include "integrators/walk/render_scene.h"
#include "sampling/sampler.h"

namespace lampyr {

class PathObserver;   // bidirectional/connected_path.h
class PathRecords;    // guide/path_records.h
class TestedSamples;  // guide/selection_test.h
class PhotonList;     // photon/photon.h
struct PhotonPass;    // photon/photon_pass.h

// The kinds of path that an integrator traces for a sample.
enum class TracedPaths {
  Camera,  // a path along the ray
  Light,   // a path from a light, splatted wherever the camera sees it; there is no ray
  Both,    // one of each
};

// Kernels of photons in media. By place: a number of pixels as the camera sees them there, or the same everywhere.
// Photons are points, found by camera rays that pass them within the radius; or beams, which are the flights of light
// paths, where mean free paths are long.
struct VolumeRadius {
  Point3 eye{0.0f};
  double constant = 0, perLength = 0;  // scene units; per scene unit of distance from `eye`
  double scale = 1;                    // of the pass, already a factor of the above
  std::vector<uint8_t> usesBeams;      // by medium; of those beyond the end 0
  // Fraction of the flights that are kept: of those from lights and surfaces, and from vertices in media, of which
  // there are few.
  double beamShare = 1, scatteredBeamShare = 1;
  double beamScale = 1;  // width of the kernel between beams, relative to the radius
  // Upper bound of the radius, in mean free paths: photons with a larger one are not gathered, and other techniques
  // find that light.
  double mostMeanFreePaths = std::numeric_limits<double>::infinity();

  float At(const Point3& position) const {
    return static_cast<float>(constant + perLength * static_cast<double>(glm::distance(position, eye)));
  }
  // Half the width of the kernel between beams. It shrinks with the square of the scale: as [Křivánek14] has it, for
  // the same variance of a sum over all passes as that of two dimensions.
  float BeamAt(const Point3& position) const { return static_cast<float>(scale * beamScale) * At(position); }
  double ShareOf(bool isFromMedium) const { return isFromMedium ? scatteredBeamShare : beamShare; }
  bool UsesBeams(int32_t medium) const {
    return medium >= 0 && static_cast<size_t>(medium) < usesBeams.size() && usesBeams[static_cast<size_t>(medium)];
  }
  VolumeRadius Scaled(double by) const {
    VolumeRadius scaled = *this;
    scaled.constant *= by;
    scaled.perLength *= by;
    scaled.scale *= by;
    return scaled;
  }
  // The same, 0 where no photons are gathered. `extinction`: σ_t there, 1/scene unit.
  float OfGathered(const Point3& position, const Color& extinction) const {
    const float radius = At(position);
    return static_cast<double>(radius * extinction.Max()) <= mostMeanFreePaths ? radius : 0.0f;
  }
};

// Settings of an integrator that gathers photons.
struct PhotonSettings {
  double radius = 0;        // gather radius of the first pass, scene units; 0: chosen by the integrator
  double alpha = 2. / 3;    // the radius shrinks as pass^((alpha - 1) / 2); 1: constant
  bool startsWide = false;  // the radius is larger in the first passes (RadiusScale)
  uint64_t lightPaths =
      0;  // light paths traced per pass; 0: one for each pixel of the full image, times 2^Log2LightPaths()
  uint64_t mostBytes = 0;  // limit on the memory of photons while their map is built; 0: none
  VolumeRadius volume;     // of the first pass
  bool guided = true;      // emission guiding, if it reduces the noise enough (emission_learning.h)
};

// The variance that a path would gain with one light at each vertex instead of several, estimated from paths with
// several.
struct LightSpread {
  double squares = 0;  // Σ over vertices of the variance of one sample of those there, chosen at random
  uint64_t vertices = 0, samples = 0;  // where lights were chosen, and how many
};

// Counted time in media, nanoseconds of a typical machine: of lookups along walks and along connections. `segments`:
// time of light samples along the segments of a path, which `path` and `sppm` take, without their shadow rays.
struct MediumTimes {
  double walks = 0, connections = 0, segments = 0;
  double segmentRays = 0;  // shadow rays from segments
  void operator+=(const MediumTimes& other) {
    walks += other.walks;
    connections += other.connections;
    segments += other.segments;
    segmentRays += other.segmentRays;
  }
};

// Inputs and outputs of one sample, besides the radiance that it returns.
struct SampleContext {
  const RenderScene& scene;
  Sampler& sampler;  // started for this sample
  float time;        // of all paths of the sample, in [0,1] over the shutter interval
  RenderCounts& counts;
  // The returned radiance, split into layers by `outputs`. Cleared by the caller. Null: not wanted.
  LayerSample* layers = nullptr;
  // Splats of the light path; the caller has started the path. A splat holds the contribution of this one path,
  // because the film divides by the number of paths. Null if no light path is traced.
  SplatList* splats = nullptr;
  PathObserver* observer = nullptr;     // receives every path that contributes; may be null
  const PhotonPass* gather = nullptr;   // photons to gather; null: none yet
  PhotonList* photons = nullptr;        // receives the photons of the light path; null: not wanted
  uint32_t lastGathering = 0xffffffff;  // no pass after this one gathers `photons`
  bool withOrigin = false;              // `photons` also receives the origin of the path
  bool isForPhotonsAlone = false;       // only photons of the light path are wanted: it is not connected to the camera
  Point2 film{0.0f};                    // where the ray starts on the film, pixels
  // False if this sample has no light path (Log2LightPaths() < 0). The sampler of the light path and of its points on
  // the lens, whose index counts light paths; null: `sampler`.
  bool tracesLight = true;
  Sampler* lightSampler = nullptr;
  const OutputPlan* outputs = nullptr;  // of the layers of the film; null: it has none
  PathRecords* records = nullptr;       // receive the camera path for path guiding; null: not wanted
  uint32_t pixel = 0, sample = 0;       // y · width + x, and index of the sample in it; of camera paths
  // The lane of a Color whose refraction the paths follow where smooth glass disperses light. SampleLanes traces such a
  // sample once for each lane.
  int lane = 0;
  bool* disperses = nullptr;   // set where a path of the sample disperses; may be null
  bool repeatsOthers = false;  // what its paths contribute before they disperse was added by another lane already
  // Receives an estimate of what merging photons within a radius adds to the expectation of the returned radiance
  // (photon/merge_bias.h). Null: not wanted.
  Color* mergeBias = nullptr;
  LightSpread* lightSpread = nullptr;  // may be null
  // Receives the second moments that the light samples would have had with another light selection; the irradiance that
  // arrived is recorded for learned selection. Null: not wanted.
  TestedSamples* tested = nullptr;
  MediumTimes* mediumTimes = nullptr;  // null: not wanted
  // Factor on the light that the ray meets before anything scatters it. If the sample has n rays that look for it: 1 / n
  // times the ray's weight over that of the first. Read by integrators that say so (Integrator::SeparatesSeenLight).
  float seenShare = 1;
  // Nothing but that light is wanted: the path ends where the ray does. There is no light path.
  bool isForSeenLight = false;

  SampleContext With(Sampler& other) const {
    SampleContext with{scene,    other,       time,      counts,        layers,     splats,
                       observer, gather,      photons,   lastGathering, withOrigin, isForPhotonsAlone,
                       film,     tracesLight, nullptr,   outputs,       nullptr,    0,
                       0,        lane,        disperses, repeatsOthers};
    with.mediumTimes = mediumTimes;
    return with;
  }
  // True if what a path contributes was added by another lane already.
  bool IsCounted(bool isDispersed) const { return repeatsOthers && !isDispersed; }
};

// Stateless: any thread may call it.
class Integrator {
 public:
  virtual ~Integrator() = default;

  virtual TracedPaths Paths() const = 0;
  // False if camera paths end at the first wide scattering. Such paths are not guided.
  virtual bool FollowsCameraPaths() const { return Paths() != TracedPaths::Light; }
  // Estimates the radiance arriving along `ray`, and records the splats and photons of the light path. With a null
  // ray (the pixel is not wanted, or the integrator traces light paths only) it records those only and returns black.
  // Light paths: as many as the full image has pixels, times 2^Log2LightPaths(), are one sample per pixel.
  virtual Color Sample(const Ray* ray, const SampleContext& context) const = 0;
  // True if Sample follows SampleContext::seenShare and isForSeenLight, so that a sample may have several camera rays.
  virtual bool SeparatesSeenLight() const { return false; }
  // Light paths for each camera path, as a power of two; of TracedPaths::Both.
  virtual int Log2LightPaths() const { return 0; }
  // Materials that take the place of those of the scene behind a wide scattering (WalkSettings::materialsAfterWide), or
  // none.
  virtual std::vector<std::shared_ptr<const Material>> MaterialsAfterWide() const { return {}; }
  // Photon settings; nullopt if the integrator does not gather photons.
  virtual std::optional<PhotonSettings> Photons() const { return std::nullopt; }
};

// Integrator::Sample; of a sample with a path that smooth glass disperses, the sum over the lanes. `context`: of the
// lane that is traced first, whose camera path may be recorded.
Color SampleLanes(const Integrator& integrator, const Ray* ray, const SampleContext& context);

}  // namespace lampyr
