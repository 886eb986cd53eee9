// Ray origins and shadow-ray ends that clear their surfaces ([Pharr23 §6.8.6]); see robust.h.
#include "geometry/robust.h"

#include <bit>
#include <cstdint>

#include "geometry/rounding.h"

namespace lampyr {

namespace {

// The next representable value away from `value` in the direction of `offset`; `value` itself if the offset is 0 or the
// value is not finite. Bitwise and branchless: the signs of coordinates are not predictable, and a call of
// std::nextafter would cost more than all the rest of spawning a ray.
float RoundAway(float value, float offset) {
  constexpr uint32_t kSign = 0x80000000u, kExponent = 0x7f800000u, kSmallest = 0x00800000u;  // denormals are flushed
  const auto bits = std::bit_cast<uint32_t>(value), direction = std::bit_cast<uint32_t>(offset);
  const uint32_t step = (bits ^ direction) & kSign ? ~0u : 1u;
  const uint32_t away = (bits & ~kSign) == 0 ? (direction & kSign) | kSmallest : bits + step;
  const bool stays = (direction & ~kSign) == 0 || (bits & kExponent) == kExponent;
  return std::bit_cast<float>(stays ? bits : away);
}

}  // namespace

Point3 OffsetRayOrigin(const Point3& position, const Vector3& positionError, const Normal3& Ng,
                       const Vector3& direction) {
  const float distance = glm::dot(Abs(Ng), positionError);
  const Vector3 offset = Ng * (glm::dot(direction, Ng) < 0 ? -distance : distance);
  const Point3 moved = position + offset;
  return {RoundAway(moved.x, offset.x), RoundAway(moved.y, offset.y), RoundAway(moved.z, offset.z)};
}

Vector3 InstanceRayError(const Affine& toRender, const Affine& toObject, const Point3& origin) {
  const auto absolute = [](const glm::mat3& m) { return glm::mat3(Abs(m[0]), Abs(m[1]), Abs(m[2])); };
  const Vector3 inObject = Gamma(4) * (absolute(toObject.linear) * Abs(origin) + Abs(toObject.translation));
  return absolute(toRender.linear) * inObject;
}

Ray SpawnRayTo(const SurfacePoint& from, const Point3& target, const Vector3& targetError, const Normal3& targetNg,
               float time) {
  const Vector3 straight = target - from.position;
  const Point3 origin = OffsetRayOrigin(from.position, from.positionError, from.Ng, straight);
  // The rounding of a unit direction makes the ray miss the target by up to 1.5e-7 of the distance, enough at a grazing
  // angle to make it end behind the target's surface.
  constexpr float kDirectionError = 0x1p-22f;
  const Vector3 endError = targetError + Vector3(kDirectionError * MaxAbsComponent(straight));
  const Point3 end = OffsetRayOrigin(target, endError, targetNg, -straight);
  Vector3 between = end - origin;
  float distance = glm::length(between);
  constexpr float kSmallest = 1e-15f, kLargest = 1e15f;
  if (distance > kSmallest && distance < kLargest) {
    between /= distance;
  } else {  // the squared length leaves the range of float
    const Vector3d precise = Vector3d(end) - Vector3d(origin);
    const double length = glm::length(precise);
    if (!(length > 0)) return {origin, from.Ng, 0, time};
    between = Vector3(precise / length);
    distance = static_cast<float>(length);
  }
  // A few ulps: t is compared after rounding of its own.
  constexpr float kShorten = 1 - 6 * 0x1p-23f;
  return {origin, between, distance * kShorten, time};
}

}  // namespace lampyr
