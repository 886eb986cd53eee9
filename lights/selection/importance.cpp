#include "lights/selection/importance.h"

#include <algorithm>
#include <cmath>
#include <experimental/simd>

namespace lampyr {

namespace {

namespace simd = std::experimental;

constexpr float kNearest2 = 1e-20f;  // squared distances are no less
// How much of the variance a squared distance is at least: the mean of 1/d² at the middle of a ball is 1.8/variance.
constexpr float kInside = 0.55f;
// Rounding; and grazing light is little, and not nothing.
constexpr float kSlack = 1e-4f;
// The mean of max(0, c) over normals of all directions is 1/4 = √s²/2: what s² is then.
constexpr float kSpread = 0.25f;

using Lanes = simd::simd<float, simd::simd_abi::deduce_t<float, LobeBlock::kWidth>>;

Lanes Load(const float* values) {
  return Lanes(values, simd::vector_aligned);
}

}  // namespace

ClusterLobe LobeOf(const ClusterBounds& bounds) {
  ClusterLobe lobe;
  if (bounds.IsEmpty()) return lobe;
  lobe.mean = bounds.mean;
  lobe.variance = bounds.variance;
  lobe.meanNormal = bounds.meanNormal;
  lobe.intensity = bounds.intensity;
  lobe.twoSided = bounds.twoSided;
  constexpr float rounding = 1 + 1e-5f;
  const Vector3 reach = glm::max(bounds.box.max - bounds.mean, bounds.mean - bounds.box.min);
  lobe.radius = rounding * glm::length(glm::max(reach, Vector3(0.0f)));

  // The cone of all light, about the mean normal instead of the bounds' axis.
  constexpr double pi = 3.14159265358979323846;
  const double length = static_cast<double>(glm::length(bounds.meanNormal));
  if (!(length > 1e-6)) return lobe;
  const auto angle = [](double cosine) { return std::acos(std::clamp(cosine, -1.0, 1.0)); };
  double between = static_cast<double>(glm::dot(bounds.meanNormal, bounds.axis)) / length;
  if (bounds.twoSided) between = std::abs(between);
  const double widest = angle(between) + angle(static_cast<double>(bounds.cosThetaO)) +
                        angle(static_cast<double>(bounds.cosThetaE)) + 1e-3;
  if (widest >= pi) return lobe;
  // A place at distance d is dark when its direction is farther from the axis than the cone's angle and that under
  // which the sphere is seen, θ + σ. Of cos(θ + σ) = cosθ cosσ - sinθ sinσ a lower bound will do that needs no root:
  // cosσ is between 1 - sinσ and 1, and d sinσ is the radius.
  const double cosine = std::cos(widest), sine = std::sin(widest);
  lobe.coneCosine = static_cast<float>(length * cosine);
  lobe.coneReach = static_cast<float>(length * (sine + std::max(cosine, 0.0))) * lobe.radius;
  return lobe;
}

float Importance(const ClusterLobe& lobe, const TreeReceiver& receiver) {
  if (!(lobe.intensity > 0)) return 0;
  const Vector3 way = receiver.position - lobe.mean;
  const float distance2 = glm::dot(way, way);
  const float squared = std::max({distance2, kInside * lobe.variance, kNearest2});
  const float inverse = 1 / std::sqrt(squared);
  const float spread = std::min(lobe.variance * inverse * inverse, 1.0f);
  const bool isOutside = distance2 > lobe.radius * lobe.radius;

  float along = glm::dot(lobe.meanNormal, way);
  if (lobe.twoSided) along = std::abs(along);
  const float distance = distance2 * inverse;
  if (isOutside && along < lobe.coneCosine * distance - lobe.coneReach - kSlack * distance) return 0;
  const float unevenness = 1 - glm::dot(lobe.meanNormal, lobe.meanNormal);
  const float emittedCosine = along * inverse;
  const float emittedRoot =
      std::sqrt(emittedCosine * emittedCosine + kSpread * std::min(std::max(unevenness, 0.0f) + spread, 1.0f));
  // Of both sides together every place sees one.
  const float emitted = 0.5f * (lobe.twoSided ? emittedRoot : emittedRoot + emittedCosine);

  float received = 1;
  if (LengthSquared(receiver.normal) > 0) {
    float cosine = -glm::dot(receiver.normal, way) * inverse;
    if (receiver.isTransmissive) cosine = std::abs(cosine);
    if (isOutside && cosine + lobe.radius * inverse < -kSlack) return 0;
    const float root = std::sqrt(cosine * cosine + kSpread * spread);
    received = receiver.isTransmissive ? root : 0.5f * (root + cosine);
  }
  return lobe.intensity * inverse * inverse * std::max(emitted, kSlack) * std::max(received, kSlack);
}

void LobeBlock::Set(int slot, const ClusterLobe& lobe) {
  meanX[slot] = lobe.mean.x;
  meanY[slot] = lobe.mean.y;
  meanZ[slot] = lobe.mean.z;
  variance[slot] = lobe.variance;
  normalX[slot] = lobe.meanNormal.x;
  normalY[slot] = lobe.meanNormal.y;
  normalZ[slot] = lobe.meanNormal.z;
  intensity[slot] = lobe.intensity;
  radius[slot] = lobe.radius;
  coneCosine[slot] = lobe.coneCosine;
  coneReach[slot] = lobe.coneReach;
  oneSided[slot] = lobe.twoSided ? 0.0f : 1.0f;
}

double Importances::Sum() const {
  double sum = 0;
  for (const float importance : of) sum += static_cast<double>(importance);
  return sum;
}

[[gnu::noinline]] void Evaluate(const LobeBlock& block, const TreeReceiver& receiver, Importances& importances) {
  const Lanes x = receiver.position.x - Load(block.meanX), y = receiver.position.y - Load(block.meanY),
              z = receiver.position.z - Load(block.meanZ);
  const Lanes variance = Load(block.variance), radius = Load(block.radius);
  const Lanes distance2 = x * x + y * y + z * z;
  const Lanes squared = simd::max(simd::max(distance2, kInside * variance), Lanes(kNearest2));
  const Lanes inverse = 1.0f / simd::sqrt(squared);
  const Lanes inverse2 = inverse * inverse;
  const Lanes spread = simd::min(variance * inverse2, Lanes(1.0f));
  const auto isOutside = distance2 > radius * radius;

  const Lanes nx = Load(block.normalX), ny = Load(block.normalY), nz = Load(block.normalZ);
  const Lanes oneSided = Load(block.oneSided);
  Lanes along = nx * x + ny * y + nz * z;
  where(oneSided == 0.0f, along) = simd::abs(along);
  const Lanes distance = distance2 * inverse;
  const auto isDark = along < Load(block.coneCosine) * distance - Load(block.coneReach) - kSlack * distance;
  const Lanes unevenness = 1.0f - (nx * nx + ny * ny + nz * nz);
  const Lanes emittedCosine = along * inverse;
  const Lanes emittedRoot = simd::sqrt(emittedCosine * emittedCosine +
                                       kSpread * simd::min(simd::max(unevenness, Lanes(0.0f)) + spread, Lanes(1.0f)));
  const Lanes emitted = 0.5f * (emittedRoot + oneSided * emittedCosine);

  const Normal3 n = receiver.normal;
  Lanes importance = Load(block.intensity) * inverse2 * simd::max(emitted, Lanes(kSlack));
  where(isOutside && isDark, importance) = 0.0f;
  if (n.x != 0 || n.y != 0 || n.z != 0) {
    Lanes cosine = (n.x * x + n.y * y + n.z * z) * -inverse;
    if (receiver.isTransmissive) cosine = simd::abs(cosine);
    const auto isBehind = cosine + radius * inverse < -kSlack;
    const Lanes root = simd::sqrt(cosine * cosine + kSpread * spread);
    const Lanes received = receiver.isTransmissive ? root : 0.5f * (root + cosine);
    importance *= simd::max(received, Lanes(kSlack));
    where(isOutside && isBehind, importance) = 0.0f;
  }
  importance.copy_to(importances.of, simd::vector_aligned);
}

}  // namespace lampyr
