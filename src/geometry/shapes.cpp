// Bounds and areas of shapes; see shapes.h.
#include "geometry/shapes.h"

#include <glm/matrix.hpp>

#include "geometry/curves.h"
#include "geometry/mapped_area.h"

namespace lampyr {

namespace {

// Bounds of the faces; vertices that no face uses do not count.
template <size_t kCorners>
Bounds3 BoundsOf(const std::vector<Point3>& positions, const std::vector<std::array<uint32_t, kCorners>>& faces) {
  Bounds3 bounds;
  for (const auto& face : faces) {
    for (const uint32_t vertex : face) bounds.Add(positions[vertex]);
  }
  return bounds;
}

Bounds3 BoundsOf(const Quadric& q) {
  const bool disk = q.kind == Quadric::Kind::Disk;
  Bounds3 local;
  local.min = {-q.radius, -q.radius, q.zMin};
  local.max = {q.radius, q.radius, disk ? q.zMin : q.zMax};
  if (q.kind == Quadric::Kind::Sphere) {
    local.min.z = std::max(q.zMin, -q.radius);
    local.max.z = std::min(q.zMax, q.radius);
  }
  Bounds3 bounds;
  if (q.IsFullSphere()) {
    for (int i = 0; i < 3; ++i) {
      const float extent =
          q.radius * glm::length(Vector3(q.toRender.linear[0][i], q.toRender.linear[1][i], q.toRender.linear[2][i]));
      bounds.min[i] = q.toRender.translation[i] - extent;
      bounds.max[i] = q.toRender.translation[i] + extent;
    }
  } else {
    for (int i = 0; i < 8; ++i) bounds.Add(q.toRender.Point(local.Corner(i)));
  }
  // Padded: the box must contain the points that intersection in double finds, not their rounded positions.
  const Point3 reach = glm::max(Abs(local.min), Abs(local.max));
  const Vector3 error = q.toRender.PointError(reach, Vector3(0.0f)) * 2.0f;
  return {bounds.min - error, bounds.max + error};
}

Bounds3 BoundsOf(const CurveSet& curves) {
  Bounds3 bounds;
  for (size_t i = 0; i < curves.segments.size(); ++i) {
    const float reach = *std::max_element(curves.radii[i].begin(), curves.radii[i].end());
    for (const Point3& p : curves.segments[i]) {
      bounds.Add(p - Vector3(reach));
      bounds.Add(p + Vector3(reach));
    }
  }
  return bounds;
}

// ∫ f over [a,b] by composite Gauss-Legendre quadrature of 5 nodes; intervals are doubled until it converges.
template <class Function>
double Integrate(double a, double b, const Function& f, double tolerance) {
  constexpr double nodes[5] = {-0.9061798459386640, -0.5384693101056831, 0, 0.5384693101056831, 0.9061798459386640};
  constexpr double weights[5] = {0.2369268850561891, 0.4786286704993665, 0.5688888888888889, 0.4786286704993665,
                                 0.2369268850561891};
  double last = 0;
  for (int pieces = 2; pieces <= 2048; pieces *= 2) {
    const double half = (b - a) / (2 * pieces);
    double sum = 0;
    for (int piece = 0; piece < pieces; ++piece) {
      const double middle = a + half * (2 * piece + 1);
      for (int k = 0; k < 5; ++k) sum += weights[k] * f(middle + half * nodes[k]);
    }
    sum *= half;
    if (pieces > 2 && std::abs(sum - last) <= tolerance * std::abs(sum)) return sum;
    last = sum;
  }
  return last;
}

// Factor by which a map stretches area of an object-space normal: |det M| |M⁻ᵀ n|.
struct AreaStretch {
  glm::dmat3 cofactors;
  explicit AreaStretch(const glm::dmat3& m)
      : cofactors(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1])) {}
  double operator()(const Vector3d& normal) const { return glm::length(cofactors * normal); }
  // The factor of a similarity, which is the same for all normals; 0 for any other map.
  double Uniform() const {
    const double x = glm::length(cofactors[0]), y = glm::length(cofactors[1]), z = glm::length(cofactors[2]);
    const double skew = std::abs(glm::dot(cofactors[0], cofactors[1])) +
                        std::abs(glm::dot(cofactors[1], cofactors[2])) + std::abs(glm::dot(cofactors[2], cofactors[0]));
    const double tolerance = 1e-6;
    return std::abs(x - y) + std::abs(x - z) <= tolerance * x && skew <= tolerance * x * x ? x : 0;
  }
};

double SphereArea(const Quadric& q, const AreaStretch& stretch) {
  const double r = static_cast<double>(q.radius), phiMax = static_cast<double>(q.phiMax);
  const double low = std::max(static_cast<double>(q.zMin) / r, -1.0),
               high = std::min(static_cast<double>(q.zMax) / r, 1.0);
  if (const double uniform = stretch.Uniform(); uniform > 0) return r * r * (high - low) * phiMax * uniform;
  if (q.IsFullSphere()) return 4 * static_cast<double>(kPi) * r * r * MeanStretchOverSphere(stretch.cofactors);
  // Integrated over θ rather than z: smooth at the poles.
  return r * r *
         Integrate(
             std::acos(high), std::acos(low),
             [&](double theta) {
               const double sinTheta = std::sin(theta), z = std::cos(theta);
               return sinTheta * Integrate(
                                     0.0, phiMax,
                                     [&](double phi) {
                                       return stretch({sinTheta * std::cos(phi), sinTheta * std::sin(phi), z});
                                     },
                                     1e-8);
             },
             1e-7);
}

double AreaOf(const Quadric& q) {
  const AreaStretch stretch(glm::dmat3(q.toRender.linear));
  const double r = static_cast<double>(q.radius), phiMax = static_cast<double>(q.phiMax);
  switch (q.kind) {
    case Quadric::Kind::Sphere:
      return SphereArea(q, stretch);
    case Quadric::Kind::Disk: {
      const double inner = static_cast<double>(q.innerRadius);
      return 0.5 * phiMax * (r * r - inner * inner) * stretch({0, 0, 1});
    }
    case Quadric::Kind::Cylinder:
      break;
  }
  const double height = static_cast<double>(q.zMax) - static_cast<double>(q.zMin);
  if (q.phiMax >= 2 * kPi) return r * height * phiMax * MeanStretchOverCircle(stretch.cofactors);
  return r * height *
         Integrate(
             0.0, phiMax,
             [&](double phi) {
               return stretch({std::cos(phi), std::sin(phi), 0});
             },
             1e-9);
}

double AreaOf(const TriangleMesh& mesh) {
  double twice = 0;
  for (uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto [p0, p1, p2] = mesh.Corners(i);
    twice += glm::length(glm::cross(Vector3d(p1) - Vector3d(p0), Vector3d(p2) - Vector3d(p0)));
  }
  return 0.5 * twice;
}

double AreaOf(const BilinearMesh& mesh) {
  double sum = 0;
  for (const auto& q : mesh.patches) {
    const Point3d p00(mesh.positions[q[0]]), p10(mesh.positions[q[1]]), p01(mesh.positions[q[2]]),
        p11(mesh.positions[q[3]]);
    sum += Integrate(
        0.0, 1.0,
        [&](double u) {
          return Integrate(
              0.0, 1.0,
              [&](double v) {
                return glm::length(
                    glm::cross((p10 - p00) * (1 - v) + (p11 - p01) * v, (p01 - p00) * (1 - u) + (p11 - p10) * u));
              },
              1e-8);
        },
        1e-7);
  }
  return sum;
}

// Length times width, or times circumference for tubes.
double AreaOf(const CurveSet& curves) {
  const double around = curves.kind == CurveSet::Kind::Cylinder ? 2 * static_cast<double>(kPi) : 2.0;
  double sum = 0;
  for (uint32_t i = 0; i < curves.segments.size(); ++i) {
    sum += around * Integrate(
                        0.0, 1.0,
                        [&](double x) {
                          const float u = static_cast<float>(x);
                          return glm::length(Vector3d(CurveTangent(curves, i, u))) *
                                 static_cast<double>(CurveRadius(curves, i, u));
                        },
                        1e-6);
  }
  return sum;
}

double AreaOf(const CustomSurface&) {
  return 0;
}

// Dereferences the pointer by which all shapes but quadrics are held.
const Quadric& Plain(const Quadric& q) {
  return q;
}
template <class T>
const T& Plain(const std::shared_ptr<const T>& p) {
  return *p;
}

struct ShapeBounds {
  Bounds3 operator()(const std::shared_ptr<const TriangleMesh>& m) const {
    return BoundsOf(m->positions, m->triangles);
  }
  Bounds3 operator()(const std::shared_ptr<const BilinearMesh>& m) const { return BoundsOf(m->positions, m->patches); }
  Bounds3 operator()(const std::shared_ptr<const CurveSet>& c) const { return BoundsOf(*c); }
  Bounds3 operator()(const Quadric& q) const { return BoundsOf(q); }
  Bounds3 operator()(const std::shared_ptr<const CustomSurface>& s) const { return s->GetBounds(0, 1); }
};

}  // namespace

Bounds3 GetBounds(const Shape& shape) {
  return std::visit(ShapeBounds{}, shape);
}

double GetArea(const Shape& shape) {
  return std::visit([](const auto& s) { return AreaOf(Plain(s)); }, shape);
}

}  // namespace lampyr
