#include "integrators/walk/flight.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "sampling/rng.h"

namespace lampyr {

namespace {

// A part of a ray in one medium.
struct MediumSpan {
  float tMin, tMax;
  int32_t medium;
  Color tint{1.0f};  // of the surfaces before it
};

// The part of a ray within the scene's sphere, beyond which there is vacuum: with some margin, because the surfaces of
// the scene may touch the sphere.
std::pair<float, float> WithinScene(const BoundingSphere& sphere, const Ray& ray) {
  constexpr double kMargin = 1 + 1e-4;
  const Vector3d toCenter = Vector3d(sphere.center) - Vector3d(ray.origin);
  const Vector3d direction(ray.direction);
  const double along = glm::dot(toCenter, direction);
  const Vector3d across = toCenter - along * direction;
  const double radius = static_cast<double>(sphere.radius) * kMargin;
  const double half = radius * radius - glm::dot(across, across);
  if (!(half > 0)) return {0.0f, 0.0f};
  const double chord = std::sqrt(half);
  return {static_cast<float>(along - chord), static_cast<float>(along + chord)};
}

// Splits a ray at the surfaces that separate media or have a tint. Returns the medium at its end.
int32_t FindSpans(const RenderScene& scene, const Ray& ray, float tMax, int32_t medium,
                  std::span<const Crossing> crossings, std::vector<MediumSpan>& spans) {
  spans.clear();
  const auto [enters, leaves] = WithinScene(scene.lighting->SceneSphere(), ray);
  float from = 0;
  Color tint(1.0f);
  const auto add = [&](float to) {
    const float tMin = std::max(from, enters), tEnd = std::min(to, leaves);
    if (medium >= 0 && tEnd > tMin) spans.push_back({tMin, tEnd, medium, tint});
    from = to;
  };
  for (const Crossing& crossing : crossings) {
    if (crossing.medium == kSameMedium && crossing.transmittance == Color(1.0f)) continue;
    add(crossing.t);
    tint *= crossing.transmittance;
    if (crossing.medium != kSameMedium) medium = crossing.medium;
  }
  add(tMax);
  return medium;
}

// e^(-σ d) per channel. 1 without extinction, whatever the distance.
Color Transmittance(const Color& extinction, float distance) {
  return {std::exp(-extinction.r * distance), std::exp(-extinction.g * distance), std::exp(-extinction.b * distance)};
}

float ChannelOf(const Color& color, int channel) {
  return channel == 0 ? color.r : channel == 1 ? color.g : color.b;
}

// ∫ e^(-σ t) dt over [0, d].
float PathLength(float extinction, float distance) {
  const float depth = extinction * distance;
  if (depth < 1e-4f) return distance * (1 - 0.5f * depth);
  return -std::expm1(-depth) / extinction;
}

// State of a walk, or of the estimate of a connection, along a ray.
class Tracker {
 public:
  // `steps`: receives the parts of the ray; null: not wanted.
  Tracker(const Ray& ray, int channel, float uDistance, uint64_t seed, std::vector<BeamStep>* steps)
      : ray_(ray), channel_(channel), depth_(DepthOf(uDistance)), rng_(seed), steps_(steps) {}

  // Follows a span. `collides`: stops at a collision, and returns true.
  bool Follow(const Medium& medium, int32_t index, float tMin, float tMax, bool collides) {
    index_ = index;
    if (medium.IsHomogeneous()) return FollowHomogeneous(medium, tMin, tMax, collides);
    return FollowGrid(medium, tMin, tMax, collides);
  }

  Color value{1.0f};      // Π σ_n / σ̄: transmittance
  Color density{1.0f};    // the same, of the media that walks collide with
  Color emission;         // of what was followed since it was reset, over the density
  MediumCoefficients at;  // of the collision
  float t = 0;            // of the collision
  bool wantsEmission = false;

 private:
  static float DepthOf(float u) { return -std::log1p(-u); }

  bool FollowHomogeneous(const Medium& medium, float tMin, float tMax, bool collides) {
    const MediumCoefficients here = medium.At(Point3(0.0f));
    const bool scatters = !here.scattering.IsBlack();
    const Color extinction = here.Extinction();
    if (wantsEmission && !here.emission.IsBlack()) {
      const float length = tMax - tMin;
      const Color reach(PathLength(extinction.r, length), PathLength(extinction.g, length),
                        PathLength(extinction.b, length));
      emission += value * here.emission * reach / static_cast<float>(MeanOf(density));
    }
    float length = tMax - tMin;
    const float sampled = ChannelOf(extinction, channel_);
    bool isCollision = false;
    if (scatters && collides) {
      const float depth = sampled * length;
      isCollision = depth_ < depth;
      if (isCollision) {
        length = std::min(depth_ / sampled, length);
        at = here;
        t = tMin + length;
      } else {
        depth_ -= depth;
      }
    }
    if (steps_) steps_->push_back({tMin, tMin + length, index_, value, density, extinction, scatters});
    const Color transmittance = Transmittance(extinction, length);
    value *= transmittance;
    if (scatters) density *= transmittance;
    return isCollision;
  }

  bool FollowGrid(const Medium& medium, float tMin, float tMax, bool collides) {
    bool isCollision = false;
    medium.Majorants()->Walk(ray_, tMin, tMax, [&](const MajorantSegment& segment) {
      isCollision = FollowSegment(medium, segment, collides);
      return !isCollision && !value.IsBlack();
    });
    return isCollision;
  }

  // Tentative collisions in a cell. Without `collides` all of them are null.
  bool FollowSegment(const Medium& medium, const MajorantSegment& segment, bool collides) {
    float from = segment.tMin;
    const auto keep = [&](float to) {
      if (steps_) steps_->push_back({from, to, index_, value, density, Color(0.0f), true});
    };
    if (!(segment.majorant > 0)) {
      keep(segment.tMax);
      return false;
    }
    for (;;) {
      const float step = depth_ / segment.majorant;
      keep(std::min(from + step, segment.tMax));
      if (!(from + step < segment.tMax)) {
        depth_ = std::max(depth_ - segment.majorant * (segment.tMax - from), 0.0f);
        return false;
      }
      from += step;
      depth_ = DepthOf(rng_.NextFloat());
      const MediumCoefficients here = medium.At(ray_.origin + from * ray_.direction);
      const Color extinction = here.Extinction();
      if (wantsEmission && !here.emission.IsBlack())
        emission += value * here.emission / (segment.majorant * static_cast<float>(MeanOf(density)));
      if (collides && rng_.NextFloat() * segment.majorant < ChannelOf(extinction, channel_)) {
        at = here;
        t = from;
        return true;
      }
      const Color null = Max(Color(1.0f) - extinction / segment.majorant, Color(0.0f));
      value *= null;
      density *= null;
      if (value.IsBlack()) return false;
    }
  }

  static Color Max(const Color& a, const Color& b) {
    return {std::max(a.r, b.r), std::max(a.g, b.g), std::max(a.b, b.b)};
  }

  const Ray& ray_;
  const int channel_;
  float depth_;  // optical depth to the next tentative collision
  Rng rng_;
  std::vector<BeamStep>* const steps_;
  int32_t index_ = kVacuum;
};

std::vector<MediumSpan>& ThreadSpans() {
  thread_local std::vector<MediumSpan> spans;
  return spans;
}

std::vector<BeamStep>& ThreadSteps() {
  thread_local std::vector<BeamStep> steps;
  return steps;
}

std::vector<Crossing>& ThreadCrossings() {
  thread_local std::vector<Crossing> crossings;
  return crossings;
}

}  // namespace

Color BeamStep::TransmittanceAt(float t) const {
  return transmittance * Transmittance(extinction, t - tMin);
}

Color BeamStep::DensityAt(float t) const {
  return scatters ? density * Transmittance(extinction, t - tMin) : density;
}

void Fly(const SampleContext& context, const Ray& ray, uint32_t kinds, int32_t medium, const Color& extinction,
         uint32_t dimension, bool wantsBeam, Flight& flight) {
  const RenderScene& scene = context.scene;
  std::vector<Crossing>& crossings = ThreadCrossings();
  std::vector<MediumSpan>& spans = ThreadSpans();
  flight.isHit = scene.geometry->Trace(ray, kinds, flight.hit, crossings);
  flight.t = flight.isHit ? flight.hit.t : kInfinity;
  flight.factors = {1, MeanOf(extinction), 1};
  flight.beam = {};
  flight.crossings = crossings;
  flight.startExtinction = extinction;
  flight.medium = FindSpans(scene, ray, flight.t, medium, crossings, spans);
  if (!spans.empty()) {
    context.sampler.SetDimension(dimension);
    const Point2 u = context.sampler.Get2D();
    const uint64_t seed =
        MixBits(static_cast<uint64_t>(std::bit_cast<uint32_t>(u.x)) << 32 | std::bit_cast<uint32_t>(u.y));
    std::vector<BeamStep>& steps = ThreadSteps();
    steps.clear();
    Tracker tracker(ray, std::min(static_cast<int>(3 * u.y), 2), u.x, seed, wantsBeam ? &steps : nullptr);
    tracker.wantsEmission = true;
    for (const MediumSpan& span : spans) {
      const Medium& passed = *scene.media[static_cast<size_t>(span.medium)];
      tracker.emission = Color();
      const bool collides = tracker.Follow(passed, span.medium, span.tMin, span.tMax, true);
      flight.emission += span.tint * tracker.emission;
      if (!collides) continue;
      flight.collidesWith = &passed;
      flight.medium = span.medium;
      flight.t = tracker.t;
      flight.coefficients = tracker.at;
      break;
    }
    const Color end = flight.collidesWith ? tracker.at.Extinction() : Color(1.0f);
    flight.factors = {MeanOf(tracker.density * end), MeanOf(tracker.density * extinction), MeanOf(tracker.density)};
    flight.beam = steps;
    flight.passed = tracker.value / static_cast<float>(flight.factors.forward);
  }
  flight.passed *= flight.TintBefore(flight.t);
}

std::optional<BeamPoint> Flight::PointAt(float at, int32_t inMedium) const {
  for (const BeamStep& step : beam) {
    if (!(at < step.tMax)) continue;
    if (at < step.tMin || step.medium != inMedium) return std::nullopt;
    BeamPoint point;
    point.density = step.DensityAt(at);
    point.through = MeanOf(point.density);
    if (!(point.through > 0)) return std::nullopt;
    point.passed = TintBefore(at) * step.TransmittanceAt(at) / static_cast<float>(point.through);
    return point;
  }
  return std::nullopt;
}

Color Flight::TintBefore(float end) const {
  Color tint(1.0f);
  for (const Crossing& crossing : crossings) {
    if (crossing.t < end) tint *= crossing.transmittance;
  }
  return tint;
}

namespace {

// Ratio tracking over all spans.
Tracker Estimate(const RenderScene& scene, const Ray& ray, std::span<const MediumSpan> spans, uint64_t decider) {
  Rng first(decider);
  Tracker tracker(ray, 0, first.NextFloat(), MixBits(decider + 1), nullptr);
  for (const MediumSpan& span : spans) {
    tracker.Follow(*scene.media[static_cast<size_t>(span.medium)], span.medium, span.tMin, span.tMax, false);
    if (tracker.value.IsBlack()) break;
  }
  return tracker;
}

}  // namespace

Color TransmittanceOf(const SampleContext& context, const Ray& ray, uint32_t kinds, const EdgeEnd& start,
                      const Color& endExtinction, uint64_t decider, EdgeFactors& factors) {
  const RenderScene& scene = context.scene;
  std::vector<Crossing>& crossings = ThreadCrossings();
  const Color surfaces = scene.geometry->Transmittance(ray, kinds, crossings);
  factors = {};
  if (surfaces.IsBlack()) return surfaces;
  std::vector<MediumSpan>& spans = ThreadSpans();
  FindSpans(scene, ray, ray.tMax, start.medium, crossings, spans);
  if (!spans.empty()) {
    const Tracker tracker = Estimate(scene, ray, spans, decider);
    factors = {MeanOf(tracker.density * endExtinction), MeanOf(tracker.density * start.extinction),
               MeanOf(tracker.density)};
    return surfaces * tracker.value;
  }
  factors = {MeanOf(endExtinction), MeanOf(start.extinction), 1};
  return surfaces;
}

}  // namespace lampyr
