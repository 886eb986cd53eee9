#include "lights/selection/importance.h"

#include <algorithm>
#include <cmath>

namespace lampyr {

using namespace importance;

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

  // The cone of emission, around the mean normal instead of the axis of the bounds.
  constexpr double pi = 3.14159265358979323846;
  const double length = static_cast<double>(glm::length(bounds.meanNormal));
  if (!(length > 1e-6)) return lobe;
  const auto angle = [](double cosine) { return std::acos(std::clamp(cosine, -1.0, 1.0)); };
  double between = static_cast<double>(glm::dot(bounds.meanNormal, bounds.axis)) / length;
  if (bounds.twoSided) between = std::abs(between);
  const double widest = angle(between) + angle(static_cast<double>(bounds.cosThetaO)) +
                        angle(static_cast<double>(bounds.cosThetaE)) + 1e-3;
  if (widest >= pi) return lobe;
  // A point at distance d is dark if its direction is farther from the axis than θ + σ, the angle of the cone plus the
  // angular radius of the sphere. A lower bound of cos(θ + σ) = cosθ cosσ - sinθ sinσ needs no square root, because
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
  // Every point sees one side of a two-sided emitter.
  const float emitted = 0.5f * (lobe.twoSided ? emittedRoot : emittedRoot + emittedCosine);

  float received = 1;
  if (LengthSquared(receiver.normal) > 0) {
    float cosine = -glm::dot(receiver.normal, way) * inverse;
    if (receiver.isTransmissive) cosine = std::abs(cosine);
    if (isOutside && cosine + lobe.radius * inverse < -kSlack) return 0;
    const float root = std::sqrt(cosine * cosine + kSpread * spread);
    received = receiver.isTransmissive ? root : 0.5f * (root + cosine);
  }
  return lobe.intensity * inverse * inverse * std::max(emitted, kLeast) * std::max(received, kLeast);
}

uint16_t RoundUpToBfloat16(float value) {
  return static_cast<uint16_t>((std::bit_cast<uint32_t>(value) + 0xffffu) >> 16);
}

void LobeBlock::Set(int slot, const ClusterLobe& lobe) {
  const auto nearest = [](float value) { return static_cast<int16_t>(std::lround(value * kUnit)); };
  intensity[slot] = lobe.intensity;
  meanX[slot] = lobe.mean.x;
  meanY[slot] = lobe.mean.y;
  meanZ[slot] = lobe.mean.z;
  variance[slot] = lobe.variance;
  normalX[slot] = nearest(lobe.meanNormal.x);
  normalY[slot] = nearest(lobe.meanNormal.y);
  normalZ[slot] = nearest(lobe.meanNormal.z);
  coneCosine[slot] = static_cast<int16_t>(std::floor(lobe.coneCosine * kUnit));
  radius[slot] = RoundUpToBfloat16(lobe.radius);
  coneReach[slot] = RoundUpToBfloat16(lobe.coneReach);
  oneSided[slot] = lobe.twoSided ? 0 : 1;
}

ClusterLobe LobeBlock::Get(int slot) const {
  const auto fraction = [](int16_t value) { return static_cast<float>(value) * (1 / kUnit); };
  ClusterLobe lobe;
  lobe.intensity = intensity[slot];
  lobe.mean = {meanX[slot], meanY[slot], meanZ[slot]};
  lobe.variance = variance[slot];
  lobe.meanNormal = {fraction(normalX[slot]), fraction(normalY[slot]), fraction(normalZ[slot])};
  lobe.coneCosine = fraction(coneCosine[slot]);
  lobe.radius = FromBfloat16(radius[slot]);
  lobe.coneReach = FromBfloat16(coneReach[slot]);
  lobe.twoSided = oneSided[slot] == 0;
  return lobe;
}

}  // namespace lampyr
