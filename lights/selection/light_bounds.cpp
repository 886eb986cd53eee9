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
  if (angle >= pi || !(length > 1e-12)) {  // of opposite axes, the way to turn is open: all directions
    cosine = -1;
    return;
  }
  const double turn = angle - a;
  axis = SafeNormalize(static_cast<float>(std::cos(turn)) * axisA + static_cast<float>(std::sin(turn) / length) * side,
                       axisA);
  constexpr double rounding = 1e-6;
  cosine = static_cast<float>(std::cos(std::min(angle + rounding, pi)));
}

// cos(max(0, a - b)) of two angles in [0, π] by their sines and cosines.
struct Angles {
  float cosine, sine;
};
Angles SubtractClamped(const Angles& a, const Angles& b) {
  if (a.cosine >= b.cosine) return {1, 0};
  return {a.cosine * b.cosine + a.sine * b.sine, a.sine * b.cosine - a.cosine * b.sine};
}
Angles FromCosine(float cosine) {
  return {cosine, std::sqrt(std::max(0.0f, 1 - cosine * cosine))};
}

}  // namespace

void ClusterBounds::Add(const ClusterBounds& other) {
  if (other.IsEmpty()) return;
  if (IsEmpty()) {
    *this = other;
    return;
  }
  box.Add(other.box);
  // The axis of what shines to both sides may as well be the opposite one.
  const bool flip = other.twoSided && glm::dot(axis, other.axis) < 0;
  const Vector3 otherAxis = flip ? -other.axis : other.axis;
  UniteCones(axis, cosThetaO, otherAxis, other.cosThetaO, axis, cosThetaO);
  cosThetaE = std::min(cosThetaE, other.cosThetaE);
  intensity += other.intensity;
  twoSided = twoSided || other.twoSided;
}

ClusterBounds BoundsOfEmitter(const EmissionBounds& bounds, LightKind kind) {
  ClusterBounds cluster;
  if (bounds.box.IsEmpty()) return cluster;
  cluster.box = bounds.box;
  cluster.axis = bounds.axis;
  cluster.twoSided = bounds.twoSided;
  cluster.cosThetaO = bounds.cosThetaO;
  cluster.cosThetaE = std::max(bounds.cosThetaE, 0.0f);
  const float energy = bounds.energy > 0 ? std::min(bounds.energy, std::numeric_limits<float>::max()) : 0.0f;
  if (kind == LightKind::DeltaPosition) {
    // All of its directions are main ones: both angles together, and none beyond.
    const double widest = std::min(Angle(bounds.cosThetaO) + Angle(bounds.cosThetaE), 3.14159265358979323846);
    cluster.cosThetaO = static_cast<float>(std::cos(widest));
    cluster.cosThetaE = 1;
    const double solidAngle = 2 * 3.14159265358979323846 * std::max(1 - std::cos(widest), 1e-9);
    cluster.intensity = static_cast<float>(static_cast<double>(energy) / solidAngle);
  } else {
    // ∫ cosθ dω up to the end is π sin²; of both sides twice as much.
    const double sine2 = std::max(1 - std::pow(static_cast<double>(cluster.cosThetaE), 2), 1e-9);
    cluster.intensity =
        static_cast<float>(static_cast<double>(energy) / (3.14159265358979323846 * sine2 * (bounds.twoSided ? 2 : 1)));
  }
  cluster.intensity = std::min(cluster.intensity, std::numeric_limits<float>::max());
  return cluster;
}

float Importance(const ClusterBounds& cluster, const TreeReceiver& receiver) {
  if (cluster.IsEmpty()) return 0;
  const Vector3 way = receiver.position - 0.5f * (cluster.box.min + cluster.box.max);
  const Vector3 half = 0.5f * (cluster.box.max - cluster.box.min);
  constexpr float nearest = 1e-20f;
  const float distance2 = glm::dot(way, way), radius2 = glm::dot(half, half);
  const float atLeast = std::max({distance2, radius2, nearest});
  if (distance2 <= radius2) return cluster.intensity / atLeast;
  const float inverse = 1 / std::sqrt(std::max(distance2, nearest));
  const float sine2 = radius2 / distance2;
  const Angles seen{std::sqrt(1 - sine2), std::sqrt(sine2)};

  float cosEmitted = glm::dot(cluster.axis, way) * inverse;
  if (cluster.twoSided) cosEmitted = std::abs(cosEmitted);
  const Angles emitted = SubtractClamped(
      SubtractClamped(FromCosine(std::clamp(cosEmitted, -1.0f, 1.0f)), FromCosine(cluster.cosThetaO)), seen);
  constexpr float slack = 1e-4f;  // of rounded angles
  if (emitted.cosine < cluster.cosThetaE - slack) return 0;

  float received = 1;
  if (LengthSquared(receiver.normal) > 0) {
    float cosReceived = -glm::dot(receiver.normal, way) * inverse;
    if (receiver.isTransmissive) cosReceived = std::abs(cosReceived);
    received = SubtractClamped(FromCosine(std::clamp(cosReceived, -1.0f, 1.0f)), seen).cosine;
    if (received < -slack) return 0;
  }
  // Grazing light is little, and not nothing.
  return cluster.intensity * std::max(emitted.cosine, slack) * std::max(received, slack) / atLeast;
}

}  // namespace lampyr
