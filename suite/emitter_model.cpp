#include "suite/emitter_model.h"

#include <glm/matrix.hpp>

#include "base/error.h"

namespace lampyr {

namespace {

constexpr double kPiDouble = 3.14159265358979323846;

template <class T>
T Mix4(const T& a00, const T& a10, const T& a01, const T& a11, double u, double v) {
  using S = typename T::value_type;
  const auto s = static_cast<S>(u), t = static_cast<S>(v);
  return (a00 * (1 - s) + a10 * s) * (1 - t) + (a01 * (1 - s) + a11 * s) * t;
}

// Unit normal in render space of a normal in the shape's space; 0 if that has no length.
Vector3d PlacedNormal(const Transform& placement, const Vector3d& local) {
  const Vector3d n = placement.Normal(local);
  const double length = glm::length(n);
  return length > 0 ? n / length : Vector3d(0.0);
}

class TriangleModel final : public EmitterModel {
 public:
  TriangleModel(std::shared_ptr<const TriangleMesh> mesh, const Transform& placement)
      : mesh_(std::move(mesh)), placement_(placement) {}

  int PatchCount() const override { return static_cast<int>(mesh_->triangles.size()); }

  // b0 = 1 - √u, b2 = √u v: uniform over the triangle.
  SurfaceElement At(int patch, double u, double v) const override {
    const auto& t = mesh_->triangles[static_cast<size_t>(patch)];
    const double s = std::sqrt(u), b0 = 1 - s, b1 = s * (1 - v), b2 = s * v;
    Point3d p[3];
    for (size_t i = 0; i < 3; ++i) p[i] = placement_.Point(Point3d(mesh_->positions[t[i]]));
    SurfaceElement element;
    element.position = b0 * p[0] + b1 * p[1] + b2 * p[2];
    element.area = 0.5 * glm::length(glm::cross(p[1] - p[0], p[2] - p[0]));
    element.normal = Outside(t, b0, b1, b2);
    const Point2d uv[3] = {Uv(t, 0), Uv(t, 1), Uv(t, 2)};
    element.uv = Point2(b0 * uv[0] + b1 * uv[1] + b2 * uv[2]);
    return element;
  }

  Point2d Invert(int patch, const Point3d& position) const override {
    const auto& t = mesh_->triangles[static_cast<size_t>(patch)];
    Point3d p[3];
    for (size_t i = 0; i < 3; ++i) p[i] = placement_.Point(Point3d(mesh_->positions[t[i]]));
    const Vector3d a = p[1] - p[0], b = p[2] - p[0], n = glm::cross(a, b), x = position - p[0];
    const double squared = glm::dot(n, n);
    if (squared == 0) return Point2d(0.5);
    const double b1 = glm::dot(glm::cross(x, b), n) / squared, b2 = glm::dot(glm::cross(a, x), n) / squared;
    const double s = std::clamp(b1 + b2, 0.0, 1.0);
    return {s * s, s > 0 ? std::clamp(b2 / s, 0.0, 1.0) : 0.5};
  }

 private:
  Vector3d Outside(const std::array<uint32_t, 3>& t, double b0, double b1, double b2) const {
    const Point3d p0(mesh_->positions[t[0]]), p1(mesh_->positions[t[1]]), p2(mesh_->positions[t[2]]);
    Vector3d n = glm::cross(p1 - p0, p2 - p0);
    if (mesh_->flipNormals) n = -n;
    if (!mesh_->normals.empty()) {
      const Vector3d shading = b0 * Vector3d(mesh_->normals[t[0]]) + b1 * Vector3d(mesh_->normals[t[1]]) +
                               b2 * Vector3d(mesh_->normals[t[2]]);
      if (glm::dot(n, shading) < 0) n = -n;
    }
    return PlacedNormal(placement_, n);
  }
  Point2d Uv(const std::array<uint32_t, 3>& t, size_t corner) const {
    constexpr double u[3] = {0, 1, 1}, v[3] = {0, 0, 1};
    return mesh_->uvs.empty() ? Point2d(u[corner], v[corner]) : Point2d(mesh_->uvs[t[corner]]);
  }

  std::shared_ptr<const TriangleMesh> mesh_;
  Transform placement_;
};

class BilinearModel final : public EmitterModel {
 public:
  BilinearModel(std::shared_ptr<const BilinearMesh> mesh, const Transform& placement)
      : mesh_(std::move(mesh)), placement_(placement) {}

  int PatchCount() const override { return static_cast<int>(mesh_->patches.size()); }

  SurfaceElement At(int patch, double u, double v) const override {
    const auto& q = mesh_->patches[static_cast<size_t>(patch)];
    Point3d p[4];
    for (size_t i = 0; i < 4; ++i) p[i] = Point3d(mesh_->positions[q[i]]);
    const Vector3d du = (p[1] - p[0]) * (1 - v) + (p[3] - p[2]) * v, dv = (p[2] - p[0]) * (1 - u) + (p[3] - p[1]) * u;
    SurfaceElement element;
    element.position = placement_.Point(Mix4(p[0], p[1], p[2], p[3], u, v));
    element.area = glm::length(glm::cross(placement_.Vector(du), placement_.Vector(dv)));
    Vector3d n = glm::cross(du, dv);
    if (mesh_->flipNormals) n = -n;
    if (!mesh_->normals.empty()) {
      const auto& m = mesh_->normals;
      if (glm::dot(n, Vector3d(Mix4(m[q[0]], m[q[1]], m[q[2]], m[q[3]], u, v))) < 0) n = -n;
    }
    element.normal = PlacedNormal(placement_, n);
    const auto& t = mesh_->uvs;
    element.uv = t.empty() ? Point2(u, v) : Mix4(t[q[0]], t[q[1]], t[q[2]], t[q[3]], u, v);
    return element;
  }

  // Newton's method with numeric tangents, in render space.
  Point2d Invert(int patch, const Point3d& position) const override {
    Point2d p(0.5);
    for (int i = 0; i < 50; ++i) {
      const Point3d here = At(patch, p.x, p.y).position;
      const Vector3d a = (At(patch, p.x + 1e-5, p.y).position - here) * 1e5;
      const Vector3d b = (At(patch, p.x, p.y + 1e-5).position - here) * 1e5;
      const Vector3d r = position - here;
      const double aa = glm::dot(a, a), ab = glm::dot(a, b), bb = glm::dot(b, b), determinant = aa * bb - ab * ab;
      if (determinant == 0) break;
      const double ar = glm::dot(a, r), br = glm::dot(b, r);
      const Point2d before = p;
      p = glm::clamp(p + Point2d(bb * ar - ab * br, aa * br - ab * ar) / determinant, Point2d(0.0), Point2d(1.0));
      if (glm::length(p - before) < 1e-13) break;
    }
    return p;
  }

 private:
  std::shared_ptr<const BilinearMesh> mesh_;
  Transform placement_;
};

class QuadricModel final : public EmitterModel {
 public:
  QuadricModel(const Quadric& quadric, const Transform& placement) : q_(quadric) {
    glm::dmat4 m(1.0);
    for (int c = 0; c < 3; ++c) m[c] = glm::dvec4(Vector3d(quadric.toRender.linear[c]), 0.0);
    m[3] = glm::dvec4(Vector3d(quadric.toRender.translation), 1.0);
    const Transform own(m);
    placement_ = placement * own;
    // flipNormals is ReverseOrientation xor mirrored; only the former flips the outer side.
    reversed_ = quadric.flipNormals != own.SwapsHandedness();
    radius_ = static_cast<double>(q_.radius);
    phiMax_ = std::min(static_cast<double>(q_.phiMax), 2 * kPiDouble);
    low_ = static_cast<double>(q_.zMin);
    high_ = static_cast<double>(q_.zMax);
    if (q_.kind == Quadric::Kind::Sphere) {
      low_ = std::max(low_, -radius_);
      high_ = std::min(high_, radius_);
    }
  }

  int PatchCount() const override { return 1; }
  bool IsClosedConvex() const override { return q_.IsFullSphere(); }

  // u along φ; v uniform in local area: z, or the squared radius of the disk.
  SurfaceElement At(int, double u, double v) const override {
    const double phi = u * phiMax_, c = std::cos(phi), s = std::sin(phi);
    Point3d p;
    Vector3d normal, du, dv;
    if (q_.kind == Quadric::Kind::Disk) {
      const double inner = static_cast<double>(q_.innerRadius), span = radius_ * radius_ - inner * inner;
      const double rho = std::sqrt(inner * inner + v * span);
      p = {rho * c, rho * s, low_};
      normal = {0, 0, 1};
      du = Vector3d(-rho * s, rho * c, 0) * phiMax_;
      dv = Vector3d(c, s, 0) * (span / (2 * rho));
    } else {
      const double z = low_ + v * (high_ - low_);
      const bool isSphere = q_.kind == Quadric::Kind::Sphere;
      const double rho = isSphere ? std::sqrt(std::max((radius_ - z) * (radius_ + z), 0.0)) : radius_;
      p = {rho * c, rho * s, z};
      normal = isSphere ? p / radius_ : Vector3d(c, s, 0);
      du = Vector3d(-rho * s, rho * c, 0) * phiMax_;
      dv = Vector3d(isSphere ? -z / rho * c : 0.0, isSphere ? -z / rho * s : 0.0, 1) * (high_ - low_);
    }
    SurfaceElement element;
    element.position = placement_.Point(p);
    element.area = glm::length(glm::cross(placement_.Vector(du), placement_.Vector(dv)));
    element.normal = PlacedNormal(placement_, reversed_ ? -normal : normal);
    element.uv = Point2(u, TextureV(p));
    return element;
  }

  Point2d Invert(int, const Point3d& position) const override {
    const Point3d p = placement_.Inverse().Point(position);
    double phi = std::atan2(p.y, p.x);
    if (phi < 0) phi += 2 * kPiDouble;
    const double u = std::clamp(phi / phiMax_, 0.0, 1.0);
    if (q_.kind != Quadric::Kind::Disk) return {u, std::clamp((p.z - low_) / (high_ - low_), 0.0, 1.0)};
    const double inner = static_cast<double>(q_.innerRadius);
    const double squared = p.x * p.x + p.y * p.y;
    return {u, std::clamp((squared - inner * inner) / (radius_ * radius_ - inner * inner), 0.0, 1.0)};
  }

 private:
  double TextureV(const Point3d& p) const {
    if (q_.kind == Quadric::Kind::Cylinder) return (p.z - low_) / (high_ - low_);
    if (q_.kind == Quadric::Kind::Disk) {
      return (radius_ - std::hypot(p.x, p.y)) / (radius_ - static_cast<double>(q_.innerRadius));
    }
    const double from = std::acos(low_ / radius_), to = std::acos(high_ / radius_);
    return (std::acos(std::clamp(p.z / radius_, -1.0, 1.0)) - from) / (to - from);
  }

  Quadric q_;
  Transform placement_;
  bool reversed_ = false;
  double radius_, phiMax_, low_, high_;
};

}  // namespace

EmitterModel::Extent EmitterModel::Measure() const {
  constexpr int n = 32;
  Bounds3d box;
  Extent extent;
  for (int patch = 0; patch < PatchCount(); ++patch) {
    for (int i = 0; i < n * n; ++i) {
      const SurfaceElement element = At(patch, (i % n + 0.5) / n, (i / n + 0.5) / n);
      box.Add(element.position);
      extent.area += element.area / (n * n);
    }
  }
  extent.middle = box.Center();
  extent.radius = 0.52 * glm::length(box.Diagonal());
  return extent;
}

LightHit EmitterModel::HitFrom(int patch, const SurfaceElement& element, const Point3& P) const {
  const Vector3d way = element.position - Point3d(P);
  const double distance = glm::length(way);
  LightHit hit;
  hit.direction = Vector3(way / distance);
  hit.distance = static_cast<float>(distance);
  hit.position = Point3(element.position);
  hit.normal = Normal3(element.normal);
  hit.uv = element.uv;
  hit.patchIndex = patch;
  return hit;
}

std::unique_ptr<EmitterModel> MakeEmitterModel(const Shape& shape, const Transform& placement) {
  if (const auto* mesh = std::get_if<std::shared_ptr<const TriangleMesh>>(&shape)) {
    return std::make_unique<TriangleModel>(*mesh, placement);
  }
  if (const auto* patches = std::get_if<std::shared_ptr<const BilinearMesh>>(&shape)) {
    return std::make_unique<BilinearModel>(*patches, placement);
  }
  if (const auto* quadric = std::get_if<Quadric>(&shape)) return std::make_unique<QuadricModel>(*quadric, placement);
  throw Error("curves do not emit");
}

}  // namespace lampyr
