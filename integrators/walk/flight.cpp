#include "integrators/walk/flight.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "base/stop.h"
#include "sampling/rng.h"

namespace lampyr {

namespace {

// The part of a line within the scene's sphere, beyond which there is vacuum: with some margin, because the surfaces of
// the scene may touch the sphere.
std::pair<double, double> WithinScene(const BoundingSphere& sphere, const FineLine& line) {
  constexpr double kMargin = 1 + 1e-4;
  const Vector3d toCenter = Vector3d(sphere.center) - line.start;
  const double along = glm::dot(toCenter, line.direction);
  const Vector3d across = toCenter - along * line.direction;
  const double radius = static_cast<double>(sphere.radius) * kMargin;
  const double half = radius * radius - glm::dot(across, across);
  if (!(half > 0)) return {0.0, 0.0};
  const double chord = std::sqrt(half);
  return {along - chord, along + chord};
}

// Splits a line at the surfaces that separate media or have a tint. Returns the medium at its end.
int32_t FindSpans(const RenderScene& scene, const FineLine& line, double tMax, int32_t medium,
                  std::span<const Crossing> crossings, std::vector<MediumSpan>& spans) {
  spans.clear();
  const auto [enters, leaves] = WithinScene(scene.lighting->SceneSphere(), line);
  double from = 0;
  Color tint(1.0f);
  const auto add = [&](double to) {
    const double tMin = std::max(from, enters), tEnd = std::min(to, leaves);
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
  // `channels`: probabilities with which `channel` was chosen; not used where nothing collides.
  Tracker(const FineLine& line, int channel, const Color& channels, float uDistance, uint64_t seed,
          std::vector<BeamStep>* steps)
      : line_(line), channel_(channel), channels_(channels), depth_(DepthOf(uDistance)), rng_(seed), steps_(steps) {}

  // Follows a span. `collides`: stops at a collision, and returns true.
  bool Follow(const Medium& medium, int32_t index, double tMin, double tMax, bool collides) {
    index_ = index;
    lookups_ = 1;
    const bool isCollision = medium.IsHomogeneous() ? FollowHomogeneous(medium, tMin, tMax, medium.Scatters(), collides)
                                                    : FollowGrid(medium, tMin, tMax, collides);
    if (wantsTime) nanoseconds += lookups_ * medium.LookupNanoseconds();
    return isCollision;
  }

  Color value{1.0f};      // Π σ_n / σ̄: transmittance
  Color density{1.0f};    // the same, of the media that walks collide with
  Color emission;         // of the spans since the last reset, over the density
  MediumCoefficients at;  // of the collision
  double t = 0;           // of the collision
  bool wantsEmission = false, wantsTime = false;
  double nanoseconds = 0;  // of a typical machine, for lookups of media

 private:
  // Random numbers are multiples of 2^-24, 0 among them: a collision at the very start would have an infinite density.
  static float DepthOf(float u) { return -std::log1p(-std::max(u, 0x1p-26f)); }

  bool FollowHomogeneous(const Medium& medium, double tMin, double tMax, bool scatters, bool collides) {
    const MediumCoefficients here = medium.At(Point3(0.0f));
    const Color extinction = here.Extinction();
    auto length = static_cast<float>(tMax - tMin);
    if (wantsEmission && !here.emission.IsBlack()) {
      const Color reach(PathLength(extinction.r, length), PathLength(extinction.g, length),
                        PathLength(extinction.b, length));
      emission += value * here.emission * reach / static_cast<float>(OverChannels(channels_, density));
    }
    const float sampled = ChannelOf(extinction, channel_);
    bool isCollision = false;
    if (scatters && collides) {
      const float depth = sampled * length;
      isCollision = depth_ < depth;
      if (isCollision) {
        length = std::min(depth_ / sampled, length);
        at = here;
        t = tMin + static_cast<double>(length);
      } else {
        depth_ -= depth;
      }
    }
    if (steps_) {
      const double end = tMin + static_cast<double>(length);
      steps_->push_back(
          {static_cast<float>(tMin), static_cast<float>(end), index_, value, density, extinction, scatters});
    }
    const Color transmittance = Transmittance(extinction, length);
    value *= transmittance;
    if (scatters) density *= transmittance;
    return isCollision;
  }

  bool FollowGrid(const Medium& medium, double tMin, double tMax, bool collides) {
    bool isCollision = false;
    medium.Majorants()->Walk({line_.start, line_.direction, tMin, tMax}, [&](const MajorantSegment& segment) {
      isCollision = FollowSegment(medium, segment, collides);
      return !isCollision && !value.IsBlack();
    });
    return isCollision;
  }

  // Tentative collisions in a cell. Without `collides` all of them are null.
  bool FollowSegment(const Medium& medium, const MajorantSegment& segment, bool collides) {
    double from = segment.tMin;
    const auto keep = [&](double to) {
      if (!steps_) return;
      steps_->push_back({static_cast<float>(from), static_cast<float>(to), index_, value, density, Color(0.0f), true});
    };
    if (!(segment.majorant > 0)) {
      keep(segment.tMax);
      return false;
    }
    for (uint32_t collisions = 1;; ++collisions) {
      // A dense cell that is empty in parts has millions.
      if (collisions % 4096 == 0) [[unlikely]]
        CheckStop();
      const double step = static_cast<double>(depth_) / static_cast<double>(segment.majorant);
      keep(std::min(from + step, segment.tMax));
      if (!(from + step < segment.tMax)) {
        depth_ = std::max(depth_ - segment.majorant * static_cast<float>(segment.tMax - from), 0.0f);
        return false;
      }
      from += step;
      depth_ = DepthOf(rng_.NextFloat());
      ++lookups_;
      const MediumCoefficients here = medium.At(Point3(line_.start + from * line_.direction));
      const Color extinction = here.Extinction();
      if (wantsEmission && !here.emission.IsBlack())
        emission += value * here.emission / (segment.majorant * static_cast<float>(OverChannels(channels_, density)));
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

  const FineLine& line_;
  const int channel_;
  const Color channels_;
  float depth_;  // optical depth to the next tentative collision
  Rng rng_;
  std::vector<BeamStep>* const steps_;
  int32_t index_ = kVacuum;
  uint32_t lookups_ = 0;
};

// Storage of each thread. Walks and connections have different ones, because connections are traced while a flight
// refers to its own.
struct Buffers {
  std::vector<MediumSpan> spans;
  std::vector<Crossing> crossings;
};

Buffers& BuffersOfWalks() {
  thread_local Buffers buffers;
  return buffers;
}

Buffers& BuffersOfConnections() {
  thread_local Buffers buffers;
  return buffers;
}

// Converts the transmittances of crossed surfaces to the wavelengths of the scene.
void Tune(const RenderScene& scene, std::vector<Crossing>& crossings) {
  if (scene.wavelengths) [[unlikely]]
    TuneCrossings(*scene.wavelengths, crossings);
}

std::vector<BeamStep>& ThreadSteps() {
  thread_local std::vector<BeamStep> steps;
  return steps;
}

}  // namespace

Color BeamStep::TransmittanceAt(float t) const {
  return transmittance * Transmittance(extinction, t - tMin);
}

Color BeamStep::DensityAt(float t) const {
  return scatters ? density * Transmittance(extinction, t - tMin) : density;
}

Color ChannelsOf(const Color& throughput) {
  if (!throughput.IsValid()) return Color(1.0f / 3);
  // x^(3/4)
  const auto power = [](float x) { return std::sqrt(x) * std::sqrt(std::sqrt(x)); };
  const Color powers(power(throughput.r), power(throughput.g), power(throughput.b));
  const float sum = powers.r + powers.g + powers.b;
  return sum > 0 ? powers / sum : Color(1.0f / 3);
}

namespace {

// The channel at `u` of the cumulated probabilities. Never one of probability 0, whatever the rounding.
int ChannelAt(const Color& channels, float u) {
  if (u < channels.r) return 0;
  if (u < channels.r + channels.g || !(channels.b > 0)) return channels.g > 0 ? 1 : 0;
  return 2;
}

}  // namespace

void Fly(const SampleContext& context, const Ray& ray, uint32_t kinds, const EdgeEnd& start, const Color& throughput,
         uint32_t dimension, bool wantsBeam, Flight& flight) {
  const RenderScene& scene = context.scene;
  auto& [spans, crossings] = BuffersOfWalks();
  FineLine line{start.position, Vector3d(ray.direction)};
  line.isFineAtStart = start.isFine;
  const LineHit found = scene.geometry->Trace(ray, line, kinds, flight.hit, crossings);
  Tune(scene, crossings);
  double end = found.t;
  flight.isHit = found.isHit;
  flight.factors = {1, MeanOf(start.extinction), 1};
  flight.beam = {};
  flight.crossings = crossings;
  flight.startExtinction = start.extinction;
  if (found.isRejected) {
    flight.passed = Color(0.0f);
    return;
  }
  flight.medium = FindSpans(scene, line, end, start.medium, crossings, spans);
  flight.line = line;
  flight.spans = spans;
  if (!spans.empty()) {
    context.sampler.SetDimension(dimension);
    const Point2 u = context.sampler.Get2D();
    const uint64_t seed =
        MixBits(static_cast<uint64_t>(std::bit_cast<uint32_t>(u.x)) << 32 | std::bit_cast<uint32_t>(u.y));
    std::vector<BeamStep>& steps = ThreadSteps();
    steps.clear();
    flight.channels = ChannelsOf(throughput);
    Tracker tracker(line, ChannelAt(flight.channels, u.y), flight.channels, u.x, seed, wantsBeam ? &steps : nullptr);
    tracker.wantsEmission = true;
    tracker.wantsTime = context.mediumTimes != nullptr;
    for (const MediumSpan& span : spans) {
      const Medium& passed = *scene.media[static_cast<size_t>(span.medium)];
      tracker.emission = Color();
      const bool collides = tracker.Follow(passed, span.medium, span.tMin, span.tMax, true);
      flight.emission += span.tint * tracker.emission;
      if (!collides) continue;
      flight.collidesWith = &passed;
      flight.medium = span.medium;
      end = tracker.t;
      flight.coefficients = tracker.at;
      break;
    }
    if (tracker.wantsTime) context.mediumTimes->walks += tracker.nanoseconds;
    const Color endExtinction = flight.collidesWith ? tracker.at.Extinction() : Color(1.0f);
    flight.factors = {MeanOf(tracker.density * endExtinction), MeanOf(tracker.density * start.extinction),
                      MeanOf(tracker.density)};
    flight.beam = steps;
    flight.passed = tracker.value / static_cast<float>(OverChannels(flight.channels, tracker.density * endExtinction));
  }
  flight.t = static_cast<float>(end);
  if (flight.isHit || flight.collidesWith) flight.end = line.start + end * line.direction;
  flight.passed *= flight.TintBefore(end);
}

std::optional<BeamPoint> Flight::PointAt(float at, int32_t inMedium) const {
  for (const BeamStep& step : beam) {
    if (!(at < step.tMax)) continue;
    if (at < step.tMin || step.medium != inMedium) return std::nullopt;
    BeamPoint point;
    point.density = step.DensityAt(at);
    point.through = MeanOf(point.density);
    if (!(point.through > 0)) return std::nullopt;
    const double reached = OverChannels(channels, point.density);
    if (!(reached > 0)) return std::nullopt;
    point.passed = TintBefore(static_cast<double>(at)) * step.TransmittanceAt(at) / static_cast<float>(reached);
    return point;
  }
  return std::nullopt;
}

Color Flight::TintBefore(double end) const {
  Color tint(1.0f);
  for (const Crossing& crossing : crossings) {
    if (crossing.t < end) tint *= crossing.transmittance;
  }
  return tint;
}

namespace {

// Ratio tracking over all spans up to `end`.
Tracker Estimate(const SampleContext& context, const FineLine& line, std::span<const MediumSpan> spans, double end,
                 uint64_t decider) {
  Rng first(decider);
  Tracker tracker(line, 0, Color(1.0f / 3), first.NextFloat(), MixBits(decider + 1), nullptr);
  tracker.wantsTime = context.mediumTimes != nullptr;
  for (const MediumSpan& span : spans) {
    if (!(span.tMin < end)) break;
    tracker.Follow(*context.scene.media[static_cast<size_t>(span.medium)], span.medium, span.tMin,
                   std::min(span.tMax, end), false);
    if (tracker.value.IsBlack()) break;
  }
  if (tracker.wantsTime) context.mediumTimes->connections += tracker.nanoseconds;
  return tracker;
}

// The transmittance of the media alone up to `length`, between the crossings in BuffersOfConnections. Sets the factors
// of the edge.
Color TransmittanceOfMedia(const SampleContext& context, const FineLine& line, double length, const EdgeEnd& start,
                           const EdgeEnd& end, uint64_t decider, EdgeFactors& factors) {
  auto& [spans, crossings] = BuffersOfConnections();
  FindSpans(context.scene, line, length, start.medium, crossings, spans);
  if (spans.empty()) {
    factors = {MeanOf(end.extinction), MeanOf(start.extinction), 1};
    return Color(1.0f);
  }
  const Tracker tracker = Estimate(context, line, spans, length, decider);
  factors = {MeanOf(tracker.density * end.extinction), MeanOf(tracker.density * start.extinction),
             MeanOf(tracker.density)};
  return tracker.value;
}

// The line of a connecting ray: between both ends, or from the start in the direction of an infinite ray.
FineLine LineOf(const Ray& ray, const EdgeEnd& start, const EdgeEnd& end) {
  FineLine line{start.position, Vector3d(ray.direction)};
  line.isFineAtStart = start.isFine;
  if (ray.tMax == kInfinity) return line;
  const Vector3d between = end.position - start.position;
  line.length = glm::length(between);
  if (line.length > 0) line.direction = between / line.length;
  line.isFineAtEnd = end.isFine;
  return line;
}

}  // namespace

std::optional<MediumPoint> PointOnFlight(const SampleContext& context, const Flight& flight, double t,
                                         uint64_t decider) {
  const auto span = std::find_if(flight.spans.begin(), flight.spans.end(),
                                 [=](const MediumSpan& one) { return t >= one.tMin && t < one.tMax; });
  if (span == flight.spans.end()) return std::nullopt;
  MediumPoint point;
  point.position = flight.line.start + t * flight.line.direction;
  point.index = span->medium;
  point.medium = context.scene.media[static_cast<size_t>(span->medium)].get();
  point.coefficients = point.medium->At(Point3(point.position));
  if (point.coefficients.scattering.IsBlack()) return std::nullopt;
  const Tracker tracker = Estimate(context, flight.line, flight.spans, t, decider);
  point.transmittance = span->tint * tracker.value;
  if (point.transmittance.IsBlack()) return std::nullopt;
  point.factors = {MeanOf(tracker.density * point.coefficients.Extinction()),
                   MeanOf(tracker.density * flight.startExtinction), MeanOf(tracker.density)};
  return point;
}

Color TransmittanceOf(const SampleContext& context, const Ray& ray, uint32_t kinds, const EdgeEnd& start,
                      const EdgeEnd& end, uint64_t decider, EdgeFactors& factors) {
  const RenderScene& scene = context.scene;
  std::vector<Crossing>& crossings = BuffersOfConnections().crossings;
  const FineLine line = LineOf(ray, start, end);
  Color surfaces = scene.geometry->Transmittance(ray, line, kinds, crossings);
  factors = {};
  if (surfaces.IsBlack()) return surfaces;
  if (scene.wavelengths) [[unlikely]]
    surfaces = TunedTransmittance(*scene.wavelengths, surfaces, crossings);
  return surfaces * TransmittanceOfMedia(context, line, line.length, start, end, decider, factors);
}

bool TransmittanceToHit(const SampleContext& context, const Ray& ray, uint32_t kinds, const EdgeEnd& start,
                        const EdgeEnd& end, uint64_t decider, RayHit& hit, Color& passed, EdgeFactors& factors) {
  const RenderScene& scene = context.scene;
  std::vector<Crossing>& crossings = BuffersOfConnections().crossings;
  const FineLine line = LineOf(ray, start, end);
  const LineHit found = scene.geometry->Trace(ray, line, kinds, hit, crossings);
  if (!found.isHit) return false;
  Tune(scene, crossings);
  passed = Transmittance(crossings) * TransmittanceOfMedia(context, line, found.t, start, end, decider, factors);
  return true;
}

}  // namespace lampyr
