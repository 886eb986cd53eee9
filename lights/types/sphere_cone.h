// The cone of directions that a sphere subtends from outside: uniform solid-angle sampling that stays exact for spheres
// that are tiny, distant or almost touched ([Shirley96], rearranged to avoid cancellation).
#pragma once

#include <optional>

#include "math/frame.h"
#include "sampling/warp.h"

namespace lampyr {

struct SphereCone {
  Vector3 axis;              // unit, from P to the middle
  float distance = 0;        // to the middle
  float tangentSquared = 0;  // distance² - radius²
  float radius = 0;
  float sinSquared = 0;  // of the half angle
  float oneMinusCosMax = 0;

  // nullopt inside the sphere, or so near to it that it subtends a hemisphere up to rounding.
  static std::optional<SphereCone> From(const Point3& P, const Point3& center, float radius) {
    const Vector3 toCenter = center - P;
    const float distance = glm::length(toCenter);
    if (!(distance > radius * 1.00001f)) return std::nullopt;
    SphereCone cone;
    cone.axis = toCenter / distance;
    cone.distance = distance;
    cone.radius = radius;
    cone.tangentSquared = (distance - radius) * (distance + radius);
    cone.sinSquared = Sqr(radius / distance);
    cone.oneMinusCosMax = OneMinusCosFromSinSquared(cone.sinSquared);
    return cone.oneMinusCosMax > 1e-37f ? std::optional(cone) : std::nullopt;
  }

  PdfSolidAngle Density() const { return UniformConePdf(oneMinusCosMax); }

  struct Hit {
    Vector3 direction;  // unit, from P
    float distance;
    Normal3 normal;  // unit, away from the middle
  };
  Hit Sample(const Point2& u) const {
    const Vector3 local = SampleUniformCone(u, oneMinusCosMax);
    const float t = u.x * oneMinusCosMax;
    // sin²θ / sin²θmax, in [0,1]; at θmax the ray touches the sphere.
    const float ratio = std::min(t * (2 - t) / sinSquared, 1.0f);
    const float root = SafeSqrt(1 - ratio);
    const float near = tangentSquared / (distance * local.z + radius * root);
    // The angle at the sphere's middle, by projecting P's triangle on the axis.
    const float cosAlpha = ratio * (radius / distance) + local.z * root;
    const Frame frame = Frame::FromNormal(axis);
    const float sideways = near / radius;
    const Normal3 normal = frame.x * (local.x * sideways) + frame.y * (local.y * sideways) - axis * cosAlpha;
    return {frame.ToWorld(local), near, normal};
  }
};

}  // namespace lampyr
