// Distances along a ray in participating media, sampled for a light: a light is selected for the segment of the ray, a
// point of it becomes the apex, and the distance is sampled in proportion to the inverse of the squared distance from
// there ([Kulla12]). For lights at infinity the density is that of the transmittance instead, within the segment.
//
// A walk that samples distances by the transmittance alone rarely collides near a lamp, and in thin fog rarely at all.
// Both techniques make the same paths: camera path, medium vertex, light. The apex is a random variable of the path and
// the light that every technique would have drawn alike, so that densities given the apex make weights that sum to 1.
#pragma once

#include "integrators/walk/flight.h"

namespace lampyr {

class LitSegment {
 public:
  LitSegment() = default;
  // The segment of the ray of `flight`. `isFirst`: the ray comes from the camera.
  LitSegment(const RenderScene& scene, const Ray& ray, const Flight& flight, bool isFirst);

  // Probability with which a distance is sampled at all: 1 where a walk is unlikely to collide, less in media that are
  // thick enough for the walk to scatter on its own; 0: nothing on the ray scatters.
  float Share() const { return share_; }

  struct Sample {
    SelectedLight light;  // its probability is that for the segment
    double t = 0;         // along the line of the flight
    double density = 0;   // of t, 1/scene unit, without the share and the selection
  };
  // nullopt: the light that is selected does not reach the segment.
  std::optional<Sample> Generate(const LightingServices& lighting, const Point2& uSelectAndDistance,
                                 const Point2& uApex) const;
  // Density of sampling this light at `t`: share, selection and distance, 1/scene unit. `u`: for the apex.
  double Density(const LightingServices& lighting, uint32_t light, int patch, double t, const Point2& uApex) const;
  // The density of a sample of Generate, in the same measure.
  double Density(const Sample& sample) const {
    return static_cast<double>(share_ * sample.light.probability.value) * sample.density;
  }

 private:
  RaySegment segment_;    // from the first medium that scatters to the end of the last one
  double from_ = 0;       // where it starts on the ray
  float extinction_ = 0;  // mean over channels at its start, 1/scene unit; 0 in a grid
  float share_ = 0;
};

}  // namespace lampyr
