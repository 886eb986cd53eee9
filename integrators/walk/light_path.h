// Light paths: emission, first hit, and the walk from there. Used by all integrators that trace paths from lights.
#pragma once

#include <memory>

#include "integrators/walk/walk.h"
#include "media/medium_emission.h"

namespace lampyr {

struct IntegratorInput;

// Reused from path to path, because vertices are large.
struct LightPath {
  explicit LightPath(bool keepsAll = true) : vertices(keepsAll) {}

  Subpath vertices;
};

// A light path's start in a participating medium.
struct EmittedInMedium {
  Point3 position{0.0f};
  int32_t medium = kVacuum;
  Color emission;      // radiance per length
  double density = 0;  // of the point, per volume: that of starting a path in a medium is a factor
};

// Callbacks while a light path grows. Paths from participating media have no light: Emitted and FirstHit are not called
// for them.
class LightPathVisitor {
 public:
  virtual ~LightPathVisitor() = default;
  // The path starts on a surface that camera rays can hit.
  virtual void Emitted(const EmittedPhoton&) {}
  // The path starts in a participating medium.
  virtual void Glowed(LightPath& /*path*/, const EmittedInMedium&) {}
  // First hit of the path, before Arrived is called for it. False: the path ends without a vertex.
  virtual bool FirstHit(const EmittedPhoton&, PathVertex&) { return true; }
  // A vertex was added to the path: the last one.
  virtual void Arrived(LightPath& path, const PathState& state) = 0;
  // PathVisitor::Flew, with Flight::beam if that is wanted, too. `photon`: the emission; null: the path starts in a
  // medium.
  virtual bool WantsFlights() const { return false; }
  virtual bool WantsBeams() const { return false; }
  virtual void Flew(LightPath& /*path*/, const PathState&, const Flight&, const EmittedPhoton* /*photon*/) {}
};

// The participating media that emit light, as the start of light paths. A path starts in a medium or at a light in
// proportion to their powers, as far as they are known.
class GlowingMedia {
 public:
  // `scene` has to outlive it.
  explicit GlowingMedia(const RenderScene& scene);

  // Probability that a path starts in a medium; 0: no medium emits.
  double Probability() const { return probability_; }
  const MediumEmission& Emission() const { return emission_; }

 private:
  MediumEmission emission_;
  double probability_ = 0;
};

// Null if no medium of the scene emits light.
std::unique_ptr<const GlowingMedia> GlowingMediaOf(const IntegratorInput& input);

// Traces a light path with at most `maxDepth` vertices. `glowing`: null if no path is to start in a medium.
void TraceLightPath(const SampleContext& context, int maxDepth, const PathDimensions& dimensions, LightPath& path,
                    LightPathVisitor& visitor, const GlowingMedia* glowing = nullptr);

}  // namespace lampyr
