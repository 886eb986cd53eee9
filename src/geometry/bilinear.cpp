// See bilinear.h. The intersection is in double: planar, concave and needle patches need no cases of their own.
#include "geometry/bilinear.h"

#include <utility>

#include "geometry/rounding.h"

namespace lampyr {

namespace {

// Overlap of neighbouring patches in parameters, so that no ray slips between them.
constexpr double kOverlap = 1e-9;

struct Corners {
  Point3d p00, p10, p01, p11;
};

Corners GetCorners(const BilinearMesh& mesh, uint32_t patch) {
  const auto& q = mesh.patches[patch];
  return {Point3d(mesh.positions[q[0]]), Point3d(mesh.positions[q[1]]), Point3d(mesh.positions[q[2]]),
          Point3d(mesh.positions[q[3]])};
}

template <class T>
T Interpolate(const T& a00, const T& a10, const T& a01, const T& a11, const Point2& p) {
  return (a00 * (1 - p.x) + a10 * p.x) * (1 - p.y) + (a01 * (1 - p.x) + a11 * p.x) * p.y;
}

template <class T>
T Interpolate(const std::vector<T>& values, const std::array<uint32_t, 4>& q, const Point2& p) {
  return Interpolate(values[q[0]], values[q[1]], values[q[2]], values[q[3]], p);
}

// Roots of a u² + b u + c; NaN for those that do not exist or are outside of [0,1].
std::pair<double, double> Roots(double a, double b, double c) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  if (a == 0) return {none, -c / b};  // a parallelogram, or seen along a plane that divides it evenly
  const double discriminant = b * b - 4 * a * c;
  if (!(discriminant >= 0)) return {none, none};
  const double q = -0.5 * (b + std::copysign(std::sqrt(discriminant), b));
  if (q == 0) return {a != 0 ? 0.0 : none, none};
  return {a != 0 ? q / a : none, c / q};
}

bool IsParameter(double x) {
  return x >= -kOverlap && x <= 1 + kOverlap;
}

}  // namespace

int IntersectPatch(const BilinearMesh& mesh, uint32_t patch, const RayDouble& ray, PatchHit hits[2]) {
  const Corners k = GetCorners(mesh, patch);
  const Vector3d& d = ray.direction;
  // The line p(u, ·) intersects the ray where the triple product of their difference and both directions is 0:
  // quadratic in u.
  const double a = glm::dot(glm::cross(k.p10 - k.p00, k.p01 - k.p11), d);
  const double c = glm::dot(glm::cross(k.p00 - ray.origin, d), k.p01 - k.p00);
  const double b = glm::dot(glm::cross(k.p10 - ray.origin, d), k.p11 - k.p10) - (a + c);
  const auto [u0, u1] = Roots(a, b, c);
  int found = 0;
  for (const double u : {u0, u1}) {
    if (!IsParameter(u) || (found == 1 && u1 == u0)) continue;
    const Point3d start = k.p00 + (k.p10 - k.p00) * u;
    const Vector3d along = k.p01 + (k.p11 - k.p01) * u - start;
    const Vector3d toStart = start - ray.origin;
    const Vector3d perpendicular = glm::cross(d, along);
    const double inverse = 1 / glm::dot(perpendicular, perpendicular);
    const double v = glm::dot(glm::cross(toStart, d), perpendicular) * inverse;
    const double t = glm::dot(glm::cross(toStart, along), perpendicular) * inverse;
    if (!IsParameter(v) || !(t > ray.tMin && t <= ray.tMax)) continue;
    hits[found].t = t;
    hits[found++].uv = {static_cast<float>(std::clamp(u, 0.0, 1.0)), static_cast<float>(std::clamp(v, 0.0, 1.0))};
  }
  if (found == 2 && hits[0].t > hits[1].t) std::swap(hits[0], hits[1]);
  return found;
}

Point2 PatchUv(const BilinearMesh& mesh, uint32_t patch, const Point2& parameters) {
  return mesh.uvs.empty() ? parameters : Interpolate(mesh.uvs, mesh.patches[patch], parameters);
}

namespace {

// Tangents with respect to the patch's own uv: the chain rule through the inverse of d(s,t)/d(u,v). Zero where that is
// singular.
void ToTextureTangents(const BilinearMesh& mesh, const std::array<uint32_t, 4>& q, const Point2& p,
                       SurfacePoint& point) {
  const auto& uv = mesh.uvs;
  const Vector2 dsdu = (uv[q[1]] - uv[q[0]]) * (1 - p.y) + (uv[q[3]] - uv[q[2]]) * p.y;
  const Vector2 dsdv = (uv[q[2]] - uv[q[0]]) * (1 - p.x) + (uv[q[3]] - uv[q[1]]) * p.x;
  const float determinant = dsdu.x * dsdv.y - dsdu.y * dsdv.x;
  const float scale = std::abs(dsdu.x * dsdv.y) + std::abs(dsdu.y * dsdv.x);
  const Vector3 dpdu = point.dpdu, dpdv = point.dpdv;
  if (!(std::abs(determinant) > 1e-6f * scale) || std::abs(determinant) < 1e-30f) {
    point.dpdu = point.dpdv = Vector3(0.0f);
    return;
  }
  point.dpdu = (dpdu * dsdv.y - dpdv * dsdu.y) / determinant;
  point.dpdv = (dpdv * dsdu.x - dpdu * dsdv.x) / determinant;
}

}  // namespace

void EvaluatePatch(const BilinearMesh& mesh, uint32_t patch, const Point2& p, const Vector3& towards,
                   SurfacePoint& point) {
  const auto& q = mesh.patches[patch];
  const auto& x = mesh.positions;
  const Point3 &p00 = x[q[0]], &p10 = x[q[1]], &p01 = x[q[2]], &p11 = x[q[3]];
  point.position = Interpolate(p00, p10, p01, p11, p);
  point.positionError = glm::max(glm::max(Abs(p00), Abs(p10)), glm::max(Abs(p01), Abs(p11))) * Gamma(6);
  point.dpdu = (p10 - p00) * (1 - p.y) + (p11 - p01) * p.y;
  point.dpdv = (p01 - p00) * (1 - p.x) + (p11 - p10) * p.x;
  point.Ng = SafeNormalize(glm::cross(point.dpdu, point.dpdv) * (mesh.flipNormals ? -1.0f : 1.0f), towards);
  point.Ns = point.Ng;
  if (!mesh.normals.empty()) {
    point.Ns = SafeNormalize(Interpolate(mesh.normals, q, p), point.Ng);
    if (glm::dot(point.Ng, point.Ns) < 0) point.Ng = -point.Ng;
  }
  point.uv = PatchUv(mesh, patch, p);
  if (!mesh.uvs.empty()) ToTextureTangents(mesh, q, p, point);
}

}  // namespace lampyr
