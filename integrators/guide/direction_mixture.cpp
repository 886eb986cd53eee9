#include "integrators/guide/direction_mixture.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "math/frame.h"
#include "sampling/warp.h"

namespace lampyr {

namespace {

// Bounds of the squared distance to a target: a target at the point itself has no direction, and farther away float
// overflows.
constexpr float kNoDistance = 1e-30f, kTooFar = 1e37f;

inline bool HasDirection(float squaredDistance) {
  return squaredDistance > kNoDistance && squaredDistance < kTooFar;
}
// NaN becomes the lower bound, because of the order of the arguments.
inline float BoundedKappa(float kappa) {
  return std::min(std::max(DirectionMixture::kLeastKappa, kappa), DirectionMixture::kMostKappa);
}

// e^x for x ≤ 0, to 2e-7. In this form a compiler vectorises it.
inline float ExpOfNegative(float x) {
  const float scaled = std::max(x, -87.0f) * 1.44269504f;
  const auto whole = static_cast<int32_t>(scaled - 0.5f);  // rounds: `scaled` is not positive
  const float f = scaled - static_cast<float>(whole);
  const float power =
      1 +
      f * (0.693147181f + f * (0.240226507f + f * (0.0555041087f +
                                                   f * (0.00961812911f + f * (0.00133335581f + f * 0.000154035304f)))));
  return power * std::bit_cast<float>((whole + 127) << 23);
}

struct Axis {
  Vector3 direction;
  float kappa;
};

}  // namespace

void DirectionMixture::SetTarget(size_t lobe, const Point3& target, bool isDirection) {
  x[lobe] = target.x;
  y[lobe] = target.y;
  z[lobe] = target.z;
  nearness[lobe] = isDirection ? 0.0f : 1.0f;
}

void DirectionMixture::Densities(const Point3& point, const Vector3& direction, Lanes& densities) const {
  for (size_t i = 0; i < kLobes; ++i) {
    float dx = x[i] - nearness[i] * point.x, dy = y[i] - nearness[i] * point.y, dz = z[i] - nearness[i] * point.z;
    float squared = dx * dx + dy * dy + dz * dz;
    const bool hasDirection = HasDirection(squared);
    dx = hasDirection ? dx : 0.0f;
    dy = hasDirection ? dy : 0.0f;
    dz = hasDirection ? dz : 1.0f;
    squared = hasDirection ? squared : 1.0f;
    const float inverse = 1 / std::sqrt(squared);
    const float kappa = BoundedKappa(kappaPerSquare[i] * squared);
    // 1 - cosθ as half the squared distance of the directions: a cosine near 1 has no precision.
    const float ax = direction.x - dx * inverse, ay = direction.y - dy * inverse, az = direction.z - dz * inverse;
    const float t = 0.5f * (ax * ax + ay * ay + az * az);
    densities[i] = kappa * ExpOfNegative(-kappa * t) / (2 * kPi * (1 - ExpOfNegative(-2 * kappa)));
  }
}

PdfSolidAngle DirectionMixture::Density(const Point3& point, const Vector3& direction) const {
  alignas(32) Lanes densities;
  Densities(point, direction, densities);
  float sum = 0;
  for (size_t i = 0; i < kLobes; ++i) sum += weight[i] * densities[i];
  return PdfSolidAngle(sum);
}

Vector3 DirectionMixture::Sample(const Point3& point, float uLobe, const Point2& u) const {
  size_t lobe = 0;
  for (float sum = weight[0]; lobe + 1 < kLobes && uLobe >= sum; sum += weight[lobe]) ++lobe;
  while (lobe > 0 && !(weight[lobe] > 0)) --lobe;  // rounding of the sum
  Vector3 way = Vector3(x[lobe], y[lobe], z[lobe]) - nearness[lobe] * point;
  float squared = LengthSquared(way);
  if (!HasDirection(squared)) {
    way = Vector3(0, 0, 1);
    squared = 1;
  }
  const float kappa = BoundedKappa(kappaPerSquare[lobe] * squared);
  const float least = std::exp(-2 * kappa);
  const float t = std::clamp(-std::log(least + (1 - u.x) * (1 - least)) / kappa, 0.0f, 2.0f);  // 1 - cosθ
  const float sine = SafeSqrt(t * (2 - t));
  const Vector2 phi = CosSinTurns(u.y);
  const Vector3 sampled = Frame::FromNormal(way / std::sqrt(squared)).ToWorld({sine * phi.x, sine * phi.y, 1 - t});
  return sampled / glm::length(sampled);
}

bool DirectionMixture::IsValid() const {
  float sum = 0;
  for (size_t i = 0; i < kLobes; ++i) {
    const bool isLobe = std::isfinite(x[i]) && std::isfinite(y[i]) && std::isfinite(z[i]) &&
                        (nearness[i] == 0 || nearness[i] == 1) && std::isfinite(kappaPerSquare[i]) &&
                        kappaPerSquare[i] >= 0 && weight[i] >= 0;
    if (!isLobe) return false;
    sum += weight[i];
  }
  return std::abs(sum - 1) < 1e-3f;
}

}  // namespace lampyr
