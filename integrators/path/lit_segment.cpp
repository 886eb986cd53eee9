#include "integrators/path/lit_segment.h"

#include <algorithm>
#include <cmath>

namespace lampyr {

namespace {

// Optical depth up to which a distance is sampled on every ray; beyond it the probability is inversely proportional to
// the depth.
constexpr double kDepthOfAll = 4;
// Upper bound of that probability in grids, whose depth is not known, for rays that do not come from the camera.
constexpr float kShareInGrids = 0.25f;

// Distances in proportion to e^(-σ t) in [0, length].
class TransmittedDistance {
 public:
  TransmittedDistance(float extinction, float length)
      : extinction_(static_cast<double>(extinction)),
        length_(static_cast<double>(length)),
        collides_(-std::expm1(-extinction_ * length_)) {}

  float Sample(float u) const {
    if (IsFlat()) return static_cast<float>(static_cast<double>(u) * length_);
    return static_cast<float>(std::min(-std::log1p(-static_cast<double>(u) * collides_) / extinction_, length_));
  }
  double Density(float t) const {
    if (IsFlat()) return 1 / length_;
    return extinction_ * std::exp(-extinction_ * static_cast<double>(t)) / collides_;
  }

 private:
  bool IsFlat() const { return !(collides_ > 1e-9); }

  double extinction_, length_, collides_;
};

}  // namespace

LitSegment::LitSegment(const RenderScene& scene, const Ray& ray, const Flight& flight, bool isFirst) {
  double end = 0, depth = 0;
  bool isKnown = true;
  for (const MediumSpan& span : flight.spans) {
    const Medium& medium = *scene.media[static_cast<size_t>(span.medium)];
    if (!medium.Scatters()) continue;
    const bool isStart = end == 0;
    if (isStart) from_ = span.tMin;
    end = span.tMax;
    if (!medium.IsHomogeneous()) {
      isKnown = false;
      continue;
    }
    const double extinction = MeanOf(medium.At(ray.origin).Extinction());
    if (isStart) extinction_ = static_cast<float>(extinction);
    depth += extinction * (span.tMax - span.tMin);
  }
  if (!(end > from_)) return;
  segment_ = {Point3(flight.line.start + from_ * flight.line.direction), ray.direction, static_cast<float>(end - from_),
              ray.time};
  share_ = static_cast<float>(depth > kDepthOfAll ? kDepthOfAll / depth : 1.0);
  if (!isKnown && !isFirst) share_ = std::min(share_, kShareInGrids);
}

std::optional<LitSegment::Sample> LitSegment::Generate(const LightingServices& lighting,
                                                       const Point2& uSelectAndDistance, const Point2& uApex) const {
  const auto chosen = lighting.GenerateSamplesForRaySegment(segment_, uSelectAndDistance.x, uApex);
  if (!chosen || !(chosen->tMin < chosen->tMax)) return std::nullopt;
  Sample sample;
  sample.light = {chosen->light, chosen->patch, chosen->selection, 0};
  float t;
  if (chosen->hasApex) {
    const EquiangularDistance distances = chosen->Distances(segment_);
    if (distances.IsEmpty()) return std::nullopt;
    t = distances.Sample(uSelectAndDistance.y);
    sample.density = static_cast<double>(distances.Density(t).value);
  } else {
    const TransmittedDistance distances(extinction_, chosen->tMax - chosen->tMin);
    t = distances.Sample(uSelectAndDistance.y);
    sample.density = distances.Density(t);
    t += chosen->tMin;
  }
  if (!(sample.density > 0)) return std::nullopt;
  sample.t = from_ + static_cast<double>(t);
  return sample;
}

double LitSegment::Density(const LightingServices& lighting, uint32_t light, int patch, double t,
                           const Point2& uApex) const {
  if (!(share_ > 0)) return 0;
  const PdfDiscrete selection = lighting.SegmentSelectionProbability(segment_, light, patch);
  if (selection.IsZero()) return 0;
  const auto reach = lighting.SampleApex(segment_, {light, patch, selection, 0}, uApex);
  if (!reach || !(reach->tMin < reach->tMax)) return 0;
  const float along = std::clamp(static_cast<float>(t - from_), 0.0f, segment_.length);
  if (along < reach->tMin || along > reach->tMax) return 0;
  const double density = reach->hasApex
                             ? static_cast<double>(reach->Distances(segment_).Density(along).value)
                             : TransmittedDistance(extinction_, reach->tMax - reach->tMin).Density(along - reach->tMin);
  return static_cast<double>(share_ * selection.value) * density;
}

}  // namespace lampyr
