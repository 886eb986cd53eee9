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

// Splits a ray at the surfaces that separate media. Returns the medium at its end.
int32_t FindSpans(const RenderScene& scene, const Ray& ray, float tMax, int32_t medium,
                  std::span<const Crossing> crossings, std::vector<MediumSpan>& spans) {
  spans.clear();
  const auto [enters, leaves] = WithinScene(scene.lighting->SceneSphere(), ray);
  float from = 0;
  const auto add = [&](float to) {
    const float tMin = std::max(from, enters), tEnd = std::min(to, leaves);
    if (medium >= 0 && tEnd > tMin) spans.push_back({tMin, tEnd, medium});
    from = to;
  };
  for (const Crossing& crossing : crossings) {
    if (crossing.medium == kSameMedium) continue;
    add(crossing.t);
    medium = crossing.medium;
  }
  add(tMax);
  return medium;
}

// e^(-σ d) per channel. 1 without extinction, whatever the distance.
Color Transmittance(const Color& extinction, float distance) {
  return {std::exp(-extinction.r * distance), std::exp(-extinction.g * distance), std::exp(-extinction.b * distance)};
}

double Mean(const Color& a) {
  return (static_cast<double>(a.r) + static_cast<double>(a.g) + static_cast<double>(a.b)) / 3;
}

// Whether walks may collide with the medium.
bool Scatters(const Medium& medium) {
  return !medium.IsHomogeneous() || !medium.At(Point3(0.0f)).scattering.IsBlack();
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
  Tracker(const Ray& ray, int channel, float uDistance, uint64_t seed)
      : ray_(ray), channel_(channel), depth_(DepthOf(uDistance)), rng_(seed) {}

  // Follows a span. `collides`: stops at a collision, and returns true.
  bool Follow(const Medium& medium, float tMin, float tMax, bool collides) {
    const bool scatters = Scatters(medium);
    if (medium.IsHomogeneous()) return FollowHomogeneous(medium, tMin, tMax, scatters, collides);
    return FollowGrid(medium, tMin, tMax, collides);
  }

  Color value{1.0f};      // Π σ_n / σ̄: transmittance
  Color density{1.0f};    // the same, of the media that walks collide with
  Color emission;         // of what was followed, over the density
  MediumCoefficients at;  // of the collision
  float t = 0;            // of the collision
  bool wantsEmission = false;

 private:
  static float DepthOf(float u) { return -std::log1p(-u); }

  bool FollowHomogeneous(const Medium& medium, float tMin, float tMax, bool scatters, bool collides) {
    const MediumCoefficients here = medium.At(Point3(0.0f));
    const Color extinction = here.Extinction();
    if (wantsEmission && !here.emission.IsBlack()) {
      const float length = tMax - tMin;
      const Color reach(PathLength(extinction.r, length), PathLength(extinction.g, length),
                        PathLength(extinction.b, length));
      emission += value * here.emission * reach / static_cast<float>(Mean(density));
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
    if (!(segment.majorant > 0)) return false;
    float from = segment.tMin;
    for (;;) {
      const float step = depth_ / segment.majorant;
      if (!(from + step < segment.tMax)) {
        depth_ = std::max(depth_ - segment.majorant * (segment.tMax - from), 0.0f);
        return false;
      }
      from += step;
      depth_ = DepthOf(rng_.NextFloat());
      const MediumCoefficients here = medium.At(ray_.origin + from * ray_.direction);
      const Color extinction = here.Extinction();
      if (wantsEmission && !here.emission.IsBlack())
        emission += value * here.emission / (segment.majorant * static_cast<float>(Mean(density)));
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
};

std::vector<MediumSpan>& ThreadSpans() {
  thread_local std::vector<MediumSpan> spans;
  return spans;
}

std::vector<Crossing>& ThreadCrossings() {
  thread_local std::vector<Crossing> crossings;
  return crossings;
}

}  // namespace

void Fly(const SampleContext& context, const Ray& ray, uint32_t kinds, int32_t medium, const Color& extinction,
         uint32_t dimension, Flight& flight) {
  const RenderScene& scene = context.scene;
  std::vector<Crossing>& crossings = ThreadCrossings();
  std::vector<MediumSpan>& spans = ThreadSpans();
  flight.isHit = scene.geometry->Trace(ray, kinds, flight.hit, crossings);
  flight.t = flight.isHit ? flight.hit.t : kInfinity;
  flight.factors = {1, Mean(extinction)};
  flight.medium = FindSpans(scene, ray, flight.t, medium, crossings, spans);
  if (!spans.empty()) {
    context.sampler.SetDimension(dimension);
    const Point2 u = context.sampler.Get2D();
    const uint64_t seed =
        MixBits(static_cast<uint64_t>(std::bit_cast<uint32_t>(u.x)) << 32 | std::bit_cast<uint32_t>(u.y));
    Tracker tracker(ray, std::min(static_cast<int>(3 * u.y), 2), u.x, seed);
    tracker.wantsEmission = true;
    for (const MediumSpan& span : spans) {
      const Medium& passed = *scene.media[static_cast<size_t>(span.medium)];
      if (!tracker.Follow(passed, span.tMin, span.tMax, true)) continue;
      flight.collidesWith = &passed;
      flight.medium = span.medium;
      flight.t = tracker.t;
      flight.coefficients = tracker.at;
      break;
    }
    const Color end = flight.collidesWith ? tracker.at.Extinction() : Color(1.0f);
    flight.factors = {Mean(tracker.density * end), Mean(tracker.density * extinction)};
    flight.passed = tracker.value / static_cast<float>(flight.factors.forward);
    flight.emission = tracker.emission;
  }
  for (const Crossing& crossing : crossings) {
    if (crossing.t < flight.t) flight.passed *= crossing.transmittance;
  }
}

namespace {

// Ratio tracking over all spans.
Tracker Estimate(const RenderScene& scene, const Ray& ray, std::span<const MediumSpan> spans, uint64_t decider) {
  Rng first(decider);
  Tracker tracker(ray, 0, first.NextFloat(), MixBits(decider + 1));
  for (const MediumSpan& span : spans) {
    tracker.Follow(*scene.media[static_cast<size_t>(span.medium)], span.tMin, span.tMax, false);
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
    factors = {Mean(tracker.density * endExtinction), Mean(tracker.density * start.extinction)};
    return surfaces * tracker.value;
  }
  factors = {Mean(endExtinction), Mean(start.extinction)};
  return surfaces;
}

}  // namespace lampyr
