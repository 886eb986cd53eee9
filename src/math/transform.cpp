#include "math/transform.h"

#include <glm/matrix.hpp>

namespace lampyr {

namespace {
constexpr double kPiDouble = 3.14159265358979323846;

bool AllFinite(const glm::dmat4& m) {
  for (int column = 0; column < 4; ++column) {
    for (int row = 0; row < 4; ++row) {
      if (!std::isfinite(m[column][row])) return false;
    }
  }
  return true;
}
}  // namespace

Vector3 Affine::PointError(const Point3& p, const Vector3& error) const {
  // Three products and three sums per component: gamma(3), doubled for the rounding of `linear` itself.
  constexpr float gamma = 6.0f * 0x1p-24f;
  Vector3 bound;
  for (int i = 0; i < 3; ++i) {
    const Vector3 row(std::abs(linear[0][i]), std::abs(linear[1][i]), std::abs(linear[2][i]));
    bound[i] = gamma * (glm::dot(row, Abs(p)) + std::abs(translation[i])) + (1.0f + gamma) * glm::dot(row, error);
  }
  return bound;
}

Affine Affine::Inverse() const {
  const glm::dmat3 inverse = glm::inverse(glm::dmat3(linear));
  return {glm::mat3(inverse), Vector3(-(inverse * Vector3d(translation)))};
}

Transform::Transform(const glm::dmat4& m) : m_(m), inverse_(glm::inverse(m)) {
  // The inverse of an affine map is affine: rounding errors in its last row are removed.
  if (!IsAffine() || !AllFinite(inverse_)) return;
  for (int column = 0; column < 4; ++column) inverse_[column][3] = column == 3 ? 1.0 : 0.0;
}

Transform Transform::Translate(const Vector3d& offset) {
  glm::dmat4 m(1.0), inverse(1.0);
  m[3] = glm::dvec4(offset, 1.0);
  inverse[3] = glm::dvec4(-offset, 1.0);
  return {m, inverse};
}

Transform Transform::Scale(const Vector3d& factors) {
  glm::dmat4 m(1.0), inverse(1.0);
  for (int i = 0; i < 3; ++i) {
    m[i][i] = factors[i];
    inverse[i][i] = 1.0 / factors[i];
  }
  return {m, inverse};
}

Transform Transform::Rotate(double degrees, const Vector3d& axis) {
  const Vector3d a = glm::normalize(axis);
  const double angle = degrees * kPiDouble / 180.0;
  const double c = std::cos(angle), s = std::sin(angle);
  glm::dmat4 m(1.0);
  for (int column = 0; column < 3; ++column) {
    for (int row = 0; row < 3; ++row) m[column][row] = a[row] * a[column] * (1 - c) + (row == column ? c : 0.0);
  }
  m[1][0] -= a.z * s;
  m[2][0] += a.y * s;
  m[0][1] += a.z * s;
  m[2][1] -= a.x * s;
  m[0][2] -= a.y * s;
  m[1][2] += a.x * s;
  return {m, glm::transpose(m)};
}

Transform Transform::LookAt(const Point3d& eye, const Point3d& target, const Vector3d& up) {
  const Vector3d forward = glm::normalize(target - eye);
  const Vector3d right = glm::normalize(glm::cross(glm::normalize(up), forward));
  const Vector3d newUp = glm::cross(forward, right);
  glm::dmat4 cameraToWorld(1.0);
  cameraToWorld[0] = glm::dvec4(right, 0.0);
  cameraToWorld[1] = glm::dvec4(newUp, 0.0);
  cameraToWorld[2] = glm::dvec4(forward, 0.0);
  cameraToWorld[3] = glm::dvec4(eye, 1.0);
  return Transform(cameraToWorld).Inverse();
}

bool Transform::IsSingular() const {
  return !AllFinite(m_) || !AllFinite(inverse_) || glm::determinant(m_) == 0.0;
}

bool Transform::SwapsHandedness() const {
  return glm::determinant(glm::dmat3(m_)) < 0.0;
}

Point3d Transform::Point(const Point3d& p) const {
  const glm::dvec4 q = m_ * glm::dvec4(p, 1.0);
  return q.w == 1.0 ? Point3d(q) : Point3d(q) / q.w;
}

Vector3d Transform::Vector(const Vector3d& v) const {
  return glm::dmat3(m_) * v;
}

Vector3d Transform::Normal(const Vector3d& n) const {
  return n * glm::dmat3(inverse_);
}

Affine Transform::ToAffine() const {
  return {glm::mat3(glm::dmat3(m_)), Vector3(Vector3d(m_[3]))};
}

}  // namespace lampyr
