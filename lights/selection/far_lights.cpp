#include "lights/selection/far_lights.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/parallel.h"
#include "lights/normal_cells.h"
#include "sampling/rng.h"

namespace lampyr {

namespace {

constexpr float kLargest = 1e30f;
constexpr size_t kMostEntries = size_t{1} << 18;  // 2 MiB: there may be many sets of linked lights
// Fraction of choices without regard to normals (defensive sampling, [Hesterberg95]): a normal of the table stands for
// those of its cell, and estimates of lights may be 0 where they are not.
constexpr double kOverall = 0.05;

float EstimateOf(const PlacedLight& placed, const BoundingSphere& scene, const Normal3& normal) {
  LightContext context;
  context.transform = &placed.transform;
  context.scene = scene;
  context.receiverNormal = normal;
  const float irradiance = placed.light->GetIncidentRadianceEstimate(context, scene.center);
  const float factor = placed.light->Settings().importanceMultiplier * placed.radianceModifier;
  return irradiance > 0 ? std::min(irradiance, kLargest) * factor : 0.0f;
}

double EstimateInCell(const PlacedLight& placed, const BoundingSphere& scene, uint32_t cell) {
  double sum = 0;
  const auto normals = normal_cells::NormalsOf(cell);
  for (const Normal3& normal : normals) sum += static_cast<double>(EstimateOf(placed, scene, normal));
  return sum / static_cast<double>(normals.size());
}

// The part of a light's irradiance that is left to next-event estimation by the balance heuristic, where scattering
// samples directions by the cosine: 1 for parallel light, 1/2 for an even sky.
double PartOfNextEvent(const PlacedLight& placed, const BoundingSphere& scene) {
  if (placed.light->Kind() != LightKind::Infinite) return 1;
  constexpr int kDraws = 64;
  LightContext context;
  context.transform = &placed.transform;
  context.scene = scene;
  double all = 0, part = 0;
  for (int i = 0; i < 27; ++i) {
    const Normal3 normal(static_cast<float>(i % 3 - 1), static_cast<float>(i / 3 % 3 - 1),
                         static_cast<float>(i / 9 - 1));
    if (!(LengthSquared(normal) > 0)) continue;
    context.receiverNormal = glm::normalize(normal);
    for (int k = 0; k < kDraws; ++k) {
      context.u = MovedPoint(Point2(0.5f), k + 1);
      const auto sample = placed.light->GenerateSamples(context, scene.center);
      if (!sample || sample->pdfDirect.IsZero()) continue;
      const double cosine = static_cast<double>(glm::dot(context.receiverNormal, sample->direction));
      const auto density = static_cast<double>(sample->pdfDirect.value);
      const double value = static_cast<double>((sample->diffuse + sample->specular).Average()) * cosine / density;
      if (!(cosine > 0) || !(value < std::numeric_limits<double>::max())) continue;
      all += value;
      part += value * density / (density + cosine / 3.14159265358979323846);
    }
  }
  return all > 0 ? part / all : 1;
}

}  // namespace

FarLights::FarLights(std::span<const PlacedLight> lights, std::span<const uint32_t> far, const BoundingSphere& scene)
    : lights_(far.begin(), far.end()) {
  std::vector<float> weights;
  for (const uint32_t light : far) weights.push_back(EstimateOf(lights[light], scene, Normal3(0.0f)));
  for (const float weight : weights) irradiance_ += static_cast<double>(weight);
  // A light without irradiance at the centre of the scene may illuminate other places, as through a window.
  constexpr double floor = 1e-3;
  const double mean = weights.empty() ? 0 : irradiance_ / static_cast<double>(weights.size());
  std::vector<float> raised;
  for (const float weight : weights)
    raised.push_back(mean > 0 ? std::max(weight, static_cast<float>(floor * mean)) : 1);
  overall_ = AliasTable(raised);
  const size_t count = lights_.size(), stride = count + 1;
  if (count == 0 || normal_cells::kCount * stride > kMostEntries || !(irradiance_ > 0)) return;
  // Squared: next-event estimation of what scattering finds as well may have few samples without becoming noisy, as its
  // weight falls with their number.
  for (const uint32_t light : far) parts_.push_back(Sqr(PartOfNextEvent(lights[light], scene)));
  sums_.assign(normal_cells::kCount * stride, 0.0);
  ParallelFor(normal_cells::kSide, HardwareThreads(), [&](int row) {
    const auto first = static_cast<uint32_t>(row * normal_cells::kSide);
    for (uint32_t cell = first; cell < first + normal_cells::kSide; ++cell) {
      double* sums = &sums_[cell * stride];
      for (size_t i = 0; i < count; ++i) {
        // Directions of a moving light are not known here, nor is where a light shines that does not shine at the
        // centre.
        const PlacedLight& placed = lights[lights_[i]];
        const bool isKnown = !placed.motion && weights[i] == raised[i];
        const double weight =
            parts_[i] * (isKnown ? EstimateInCell(placed, scene, cell) : static_cast<double>(raised[i]));
        sums[i + 1] = sums[i] + weight;
      }
    }
  });
}

std::optional<uint32_t> FarLights::IndexOf(uint32_t light) const {
  const auto at = std::lower_bound(lights_.begin(), lights_.end(), light);
  if (at == lights_.end() || *at != light) return std::nullopt;
  return static_cast<uint32_t>(at - lights_.begin());
}

FarLights::Place FarLights::PlaceOf(const Normal3& normal, bool isTransmissive) const {
  if (sums_.empty() || !(LengthSquared(normal) > 0)) return {};
  return {normal_cells::CellOf(normal), isTransmissive ? normal_cells::CellOf(-normal) : Place::kNone};
}

// Sum of the irradiances of the lights before `index`.
double FarLights::WeightUpTo(const Place& place, size_t index) const {
  const size_t stride = lights_.size() + 1;
  double sum = sums_[place.front * stride + index];
  if (place.back != Place::kNone) sum += sums_[place.back * stride + index];
  return sum;
}

double FarLights::Irradiance(const Place& place) const {
  return place.front == Place::kNone ? irradiance_ : WeightUpTo(place, lights_.size());
}

// Not inlined: the same receiver always gives the same bits.
[[gnu::noinline]] PdfDiscrete FarLights::Probability(const Place& place, uint32_t index) const {
  const PdfDiscrete overall = overall_.Probability(index);
  if (place.front == Place::kNone) return overall;
  const double sum = WeightUpTo(place, lights_.size());
  if (!(sum > 0)) return overall;
  const double weight = WeightUpTo(place, index + 1) - WeightUpTo(place, index);
  return PdfDiscrete(static_cast<float>(kOverall * static_cast<double>(overall.value) + (1 - kOverall) * weight / sum));
}

FarLights::Choice FarLights::Select(const Place& place, double u) const {
  const double sum = place.front == Place::kNone ? 0 : WeightUpTo(place, lights_.size());
  if (sum > 0 && u >= kOverall) {
    const double target = (u - kOverall) / (1 - kOverall) * sum;
    // The last light whose sum of those before is at most the target: not one without irradiance.
    size_t low = 0, high = lights_.size();
    while (high - low > 1) {
      const size_t middle = (low + high) / 2;
      (WeightUpTo(place, middle) <= target ? low : high) = middle;
    }
    const double before = WeightUpTo(place, low), weight = WeightUpTo(place, low + 1) - before;
    const auto index = static_cast<uint32_t>(low);
    if (weight > 0) {
      const double rest = std::clamp((target - before) / weight, 0.0, 1.0);
      return {index, Probability(place, index), std::min(static_cast<float>(rest), 0x1.fffffep-1f)};
    }
  }
  const AliasTable::Result choice = overall_.Sample(sum > 0 ? std::min(u / kOverall, 0x1.fffffffffffffp-1) : u);
  return {choice.index, Probability(place, choice.index), choice.u};
}

}  // namespace lampyr
