#include "lights/selection/light_bounds.h"

#include "geometry/rounding.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lampyr {

namespace {

double Angle(float cosine) {
  return std::acos(std::clamp(static_cast<double>(cosine), -1.0, 1.0));
}

// The smallest cone around two ([Pharr23 §3.8.4]): axis and cosine of the angle.
void UniteCones(const Vector3& axisA, float cosA, const Vector3& axisB, float cosB, Vector3& axis, float& cosine) {
  const double a = Angle(cosA), b = Angle(cosB);
  const double between = 2 * std::asin(std::min(1.0, 0.5 * static_cast<double>(glm::length(axisA - axisB))));
  axis = axisA;
  if (between + b <= a) {
    cosine = cosA;
    return;
  }
  if (between + a <= b) {
    axis = axisB;
    cosine = cosB;
    return;
  }
  const double angle = 0.5 * (a + between + b);
  constexpr double pi = 3.14159265358979323846;
  const Vector3 side = axisB - glm::dot(axisA, axisB) * axisA;
  const double length = static_cast<double>(glm::length(side));
  if (angle >= pi || !(length > 1e-12)) {  // opposite axes leave the rotation undetermined: all directions
    cosine = -1;
    return;
  }
  const double turn = angle - a;
  axis = SafeNormalize(static_cast<float>(std::cos(turn)) * axisA + static_cast<float>(std::sin(turn) / length) * side,
                       axisA);
  constexpr double rounding = 1e-6;
  cosine = static_cast<float>(std::cos(std::min(angle + rounding, pi)));
}

// Mean normal of a part of a cluster. A two-sided part in a one-sided cluster has no main direction: 0.
Vector3 NormalIn(const ClusterBounds& part, bool twoSided) {
  return part.twoSided == twoSided ? part.meanNormal : Vector3(0.0f);
}

// Merges means and variances of two groups ([Chan83 eq. 1.5]) without differences of large numbers.
void AddMoments(ClusterBounds& cluster, const ClusterBounds& other) {
  const float sum = cluster.intensity + other.intensity;
  const float share = sum > 0 ? other.intensity / sum : 0.5f;
  const Vector3 between = other.mean - cluster.mean;
  cluster.mean += share * between;
  cluster.variance += share * (other.variance - cluster.variance) + share * (1 - share) * glm::dot(between, between);
  const bool twoSided = cluster.twoSided && other.twoSided;
  const Vector3 a = NormalIn(cluster, twoSided), b = NormalIn(other, twoSided);
  // The normal of a two-sided emitter has no sign: the one nearer to the other normal is used.
  cluster.meanNormal = a + share * ((twoSided && glm::dot(a, b) < 0 ? -b : b) - a);
}

}  // namespace

void ClusterBounds::FillBox() {
  mean = box.Center();
  variance = LengthSquared(box.Diagonal()) / 12;
}

void ClusterBounds::Add(const ClusterBounds& other) {
  if (other.IsEmpty()) return;
  if (IsEmpty()) {
    *this = other;
    return;
  }
  AddMoments(*this, other);
  box.Add(other.box);
  // The axis of a two-sided emitter has no sign either.
  const bool flip = other.twoSided && glm::dot(axis, other.axis) < 0;
  const Vector3 otherAxis = flip ? -other.axis : other.axis;
  UniteCones(axis, cosThetaO, otherAxis, other.cosThetaO, axis, cosThetaO);
  cosThetaE = std::min(cosThetaE, other.cosThetaE);
  intensity += other.intensity;
  twoSided = twoSided || other.twoSided;
}

ClusterBounds BoundsOfEmitter(const EmissionBounds& bounds, LightKind kind) {
  constexpr double pi = 3.14159265358979323846;
  ClusterBounds cluster;
  if (bounds.box.IsEmpty()) return cluster;
  cluster.box = bounds.box;
  cluster.axis = bounds.axis;
  cluster.twoSided = bounds.twoSided;
  cluster.cosThetaO = bounds.cosThetaO;
  cluster.cosThetaE = std::max(bounds.cosThetaE, 0.0f);
  cluster.FillBox();
  const double energy = bounds.energy > 0 ? static_cast<double>(bounds.energy) : 0.0;
  double intensity = 0;
  if (kind == LightKind::DeltaPosition) {
    // All directions of emission of a point count as main directions: both angles are added, and nothing is emitted
    // beyond.
    const double widest = std::min(Angle(bounds.cosThetaO) + Angle(bounds.cosThetaE), pi);
    cluster.cosThetaO = static_cast<float>(std::cos(widest));
    cluster.cosThetaE = 1;
    const double solidAngle = 2 * pi * std::max(1 - std::cos(widest), 1e-9);
    intensity = 4 * energy / solidAngle;
    // Uniform intensity within the cone; a short mean normal only preserves the direction of the cone.
    constexpr float little = 1e-2f;
    if (widest < pi) cluster.meanNormal = little * cluster.axis;
  } else {
    // ∫ cosθ dω up to the angle thetaE is π sin²(thetaE).
    const double sine2 = std::max(1 - std::pow(static_cast<double>(cluster.cosThetaE), 2), 1e-9);
    intensity = energy / (pi * sine2);
    // Mean of normals that fill the cone evenly.
    cluster.meanNormal = 0.5f * (1 + cluster.cosThetaO) * cluster.axis;
  }
  cluster.intensity = static_cast<float>(std::min(intensity, static_cast<double>(std::numeric_limits<float>::max())));
  return cluster;
}

}  // namespace lampyr
