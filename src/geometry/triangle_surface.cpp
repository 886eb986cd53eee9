// See triangle_surface.h. Tangents follow the texture coordinates as in pbrt-v4 ([Pharr23 §6.5.3]).
#include "geometry/triangle_surface.h"

#include "geometry/rounding.h"

namespace lampyr {

namespace {

// By reference, here and below: a copy on the stack is stored in smaller pieces than it is loaded in, which stalls
// store forwarding.
struct UvCorners {
  const Point2 &uv0, &uv1, &uv2;
};

UvCorners GetUvs(const TriangleMesh& mesh, const std::array<uint32_t, 3>& t) {
  return {mesh.uvs[t[0]], mesh.uvs[t[1]], mesh.uvs[t[2]]};
}

void SetTangents(const UvCorners& c, const Vector3& edge02, const Vector3& edge12, SurfacePoint& point) {
  const Vector2 uv02 = c.uv0 - c.uv2, uv12 = c.uv1 - c.uv2;
  const float a = uv02.x * uv12.y, b = uv02.y * uv12.x, determinant = a - b;
  // Relative to its terms: dense meshes have tiny but sound texture triangles.
  if (!(std::abs(determinant) > 1e-6f * (std::abs(a) + std::abs(b))) || std::abs(determinant) < 1e-30f) return;
  const float inverse = 1.0f / determinant;
  point.dpdu = (edge02 * uv12.y - edge12 * uv02.y) * inverse;
  point.dpdv = (edge12 * uv02.x - edge02 * uv12.x) * inverse;
}

// Normal of the winding in double, for edges below 1e-7 or above 1e7; `fallback` for a triangle without area.
Normal3 PreciseNormal(const Point3& p0, const Point3& p1, const Point3& p2, const Vector3& fallback) {
  const Vector3d normal = glm::cross(Vector3d(p0) - Vector3d(p2), Vector3d(p1) - Vector3d(p2));
  const double length = glm::length(normal);
  return length > 0 ? Vector3(normal / length) : fallback;
}

}  // namespace

Point2 TriangleUv(const TriangleMesh& mesh, uint32_t triangle, const Point2& b) {
  if (mesh.uvs.empty()) return {b.x + b.y, b.y};
  const UvCorners c = GetUvs(mesh, mesh.triangles[triangle]);
  return c.uv0 * (1.0f - b.x - b.y) + c.uv1 * b.x + c.uv2 * b.y;
}

void EvaluateTriangle(const TriangleMesh& mesh, uint32_t triangle, const Point2& b, const Vector3& towards,
                      bool isParametrized, SurfacePoint& point) {
  const auto& t = mesh.triangles[triangle];
  const Point3 &p0 = mesh.positions[t[0]], &p1 = mesh.positions[t[1]], &p2 = mesh.positions[t[2]];
  const float b0 = 1.0f - b.x - b.y;
  const Vector3 q0 = p0 * b0, q1 = p1 * b.x, q2 = p2 * b.y;
  point.position = q0 + q1 + q2;
  point.positionError = (Abs(q0) + Abs(q1) + Abs(q2)) * Gamma(7);

  const Vector3 edge02 = p0 - p2, edge12 = p1 - p2;
  const Vector3 winding = glm::cross(edge02, edge12);
  const float squared = LengthSquared(winding);
  point.Ng =
      squared > 1e-28f && squared < 1e28f ? winding * (1.0f / std::sqrt(squared)) : PreciseNormal(p0, p1, p2, towards);
  if (mesh.flipNormals) point.Ng = -point.Ng;
  point.Ns = point.Ng;
  if (!mesh.normals.empty()) {
    const Normal3 interpolated = mesh.normals[t[0]] * b0 + mesh.normals[t[1]] * b.x + mesh.normals[t[2]] * b.y;
    point.Ns = SafeNormalize(interpolated, point.Ng);
    if (glm::dot(point.Ng, point.Ns) < 0) point.Ng = -point.Ng;
  }

  if (!isParametrized) return;
  if (mesh.uvs.empty()) {
    point.uv = {b.x + b.y, b.y};
    point.dpdu = edge12 - edge02;
    point.dpdv = -edge12;
  } else {
    const UvCorners c = GetUvs(mesh, t);
    point.uv = c.uv0 * b0 + c.uv1 * b.x + c.uv2 * b.y;
    point.dpdu = point.dpdv = Vector3(0.0f);
    SetTangents(c, edge02, edge12, point);
  }
}

}  // namespace lampyr
