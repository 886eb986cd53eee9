// Points at which participating media emit light, for paths that start there.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "geometry/geometry_scene.h"
#include "media/emission_region.h"
#include "media/medium.h"

namespace lampyr {

// A point that emits, evenly in all directions.
struct EmissionPoint {
  Point3 position{0.0f};
  int32_t medium = kVacuum;
  Color emission;      // radiance per length (MediumCoefficients::emission)
  double density = 0;  // of the point, per volume (scene units); that of choosing the medium is a factor
};

// The power that a medium emits, W: the mean of the channels. For a homogeneous medium an upper bound, as if it filled
// the box of its surfaces, or of the scene.
double RoughPowerOf(const Medium& medium, int32_t index, const GeometryScene& geometry);

class MediumEmission {
 public:
  // `geometry` has to outlive this. `within`: beyond this sphere there is vacuum. `exterior`: the medium at points from
  // which no surface that separates media is visible. `unbounded`: a medium that opaque surfaces do not bound, whatever
  // media they declare; nullopt: none.
  MediumEmission(std::vector<std::shared_ptr<const Medium>> media, const GeometryScene& geometry,
                 const BoundingSphere& within, int32_t exterior, std::optional<int32_t> unbounded = std::nullopt);

  // Estimate of the emitted power, W: the mean of the channels. Larger than 0 if a medium may emit.
  double Power() const { return power_; }

  // Samples a point in proportion to the estimated emitted power; the density is exact. nullopt: the point is not in
  // the chosen medium, or emits nothing; the sample is 0. `u`: three random numbers in [0,1) for the position, and
  // `uSelect` for choices. Requires Power() > 0.
  std::optional<EmissionPoint> Sample(double uSelect, const Vector3& u, float time) const;

 private:
  struct Source {
    int32_t medium;
    std::vector<EmissionRegion> regions;
    std::vector<double> shares;  // probabilities of the regions
    double power = 0;
  };

  void Add(int32_t index);
  Source BoundedSource(int32_t index, double& volume) const;
  bool IsThere(int32_t medium, const Point3& position, float time) const;

  std::vector<std::shared_ptr<const Medium>> media_;
  const GeometryScene& geometry_;
  BoundingSphere within_;
  int32_t exterior_;
  std::optional<int32_t> unbounded_;
  std::vector<Source> sources_;
  double power_ = 0;
};

}  // namespace lampyr
