// Transforms. Scene construction uses double precision (Transform); rendering uses a float affine map (Affine). Points,
// vectors and normals transform differently: each has its own method.
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>

#include "math/vec.h"

namespace lampyr {

// An affine map p -> linear·p + translation in float, for use while rendering. Scene construction guarantees that it is
// invertible.
struct Affine {
  glm::mat3 linear{1.0f};
  Vector3 translation{0.0f};

  Point3 Point(const Point3& p) const { return linear * p + translation; }
  Vector3 Vector(const Vector3& v) const { return linear * v; }
  // Transforms a normal by the map whose inverse *this is: n·linear, not normalised.
  Normal3 NormalByInverse(const Normal3& n) const { return n * linear; }
  // Bound on the absolute rounding error of Point(p) if p itself is off by at most `error` per component.
  Vector3 PointError(const Point3& p, const Vector3& error) const;
  bool SwapsHandedness() const { return glm::determinant(linear) < 0; }
  // Computed in double and rounded.
  Affine Inverse() const;
};

// An invertible 4×4 matrix with its inverse, double. Applies to column vectors: (A*B)(p) = A(B(p)).
class Transform {
 public:
  Transform() = default;
  explicit Transform(const glm::dmat4& m);  // computes the inverse; IsSingular() if there is none
  Transform(const glm::dmat4& m, const glm::dmat4& inverse) : m_(m), inverse_(inverse) {}

  static Transform Translate(const Vector3d& offset);
  static Transform Scale(const Vector3d& factors);
  static Transform Rotate(double degrees, const Vector3d& axis);  // right-handed; the axis need not be unit
  static Transform LookAt(const Point3d& eye, const Point3d& target,
                          const Vector3d& up);  // world to camera, as in pbrt

  const glm::dmat4& Matrix() const { return m_; }
  const glm::dmat4& InverseMatrix() const { return inverse_; }
  Transform Inverse() const { return {inverse_, m_}; }
  bool IsSingular() const;
  bool IsAffine() const { return m_[0][3] == 0 && m_[1][3] == 0 && m_[2][3] == 0 && m_[3][3] == 1; }
  bool SwapsHandedness() const;
  bool IsIdentity() const { return m_ == glm::dmat4(1.0); }

  Point3d Point(const Point3d& p) const;
  Vector3d Vector(const Vector3d& v) const;
  Vector3d Normal(const Vector3d& n) const;  // by the inverse transpose; not normalised

  Affine ToAffine() const;  // requires IsAffine()

  friend Transform operator*(const Transform& a, const Transform& b) { return {a.m_ * b.m_, b.inverse_ * a.inverse_}; }
  friend bool operator==(const Transform& a, const Transform& b) { return a.m_ == b.m_; }

 private:
  glm::dmat4 m_{1.0};
  glm::dmat4 inverse_{1.0};
};

}  // namespace lampyr
