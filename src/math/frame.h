// An orthonormal frame around a normal: local z is the normal.
#pragma once

#include "math/vec.h"

namespace lampyr {

struct Frame {
  Vector3 x, y, z;

  // A frame around the unit normal `n`, without a branch; continuous except across n.z = 0 ([Duff17]).
  static Frame FromNormal(const Normal3& n) {
    const float sign = std::copysign(1.0f, n.z);
    const float a = -1.0f / (sign + n.z);
    const float b = n.x * n.y * a;
    return {{1.0f + sign * n.x * n.x * a, sign * b, -sign * n.x}, {b, sign + n.y * n.y * a, -n.y}, n};
  }

  // The frame around `n` whose x is the direction of `tangent` projected onto the tangent plane; FromNormal(n) if
  // `tangent` is parallel to n or 0.
  static Frame FromNormalAndTangent(const Normal3& n, const Vector3& tangent) {
    const Vector3 projected = tangent - n * glm::dot(n, tangent);
    const float lengthSquared = LengthSquared(projected);
    if (!(lengthSquared > 1e-12f * LengthSquared(tangent)) || !(lengthSquared > 0)) return FromNormal(n);
    const Vector3 x = projected / std::sqrt(lengthSquared);
    return {x, glm::cross(n, x), n};
  }

  Vector3 ToLocal(const Vector3& v) const { return {glm::dot(v, x), glm::dot(v, y), glm::dot(v, z)}; }
  Vector3 ToWorld(const Vector3& v) const { return x * v.x + y * v.y + z * v.z; }
};

}  // namespace lampyr
