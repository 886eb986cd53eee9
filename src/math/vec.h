// Points, vectors and normals (GLM types under their own names) and linear RGB colours.
//
// Point3, Vector3 and Normal3 are the same GLM type: the name is documentation, and GLM's functions apply. Color is a
// separate type, so that a colour is never added to a direction.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

namespace lampyr {

using Point2 = glm::vec2;
using Vector2 = glm::vec2;
using Point3 = glm::vec3;
using Vector3 = glm::vec3;
using Normal3 = glm::vec3;
// Scene construction is in double, rendering in float (scene/scene_description.h).
using Point2d = glm::dvec2;
using Point3d = glm::dvec3;
using Vector3d = glm::dvec3;

inline constexpr float kPi = 3.14159265358979323846f;
inline constexpr float kInvPi = 0.31830988618379067154f;
inline constexpr float kInfinity = std::numeric_limits<float>::infinity();
// The largest float below 1: random numbers are in [0, kOneMinusEpsilon].
inline constexpr float kOneMinusEpsilon = 0x1.fffffep-1f;

inline float Sqr(float x) {
  return x * x;
}
inline float SafeSqrt(float x) {
  return std::sqrt(std::max(0.0f, x));
}
inline float AbsDot(const Vector3& a, const Vector3& b) {
  return std::abs(glm::dot(a, b));
}
inline float LengthSquared(const Vector3& v) {
  return glm::dot(v, v);
}
inline float MaxComponent(const Vector3& v) {
  return std::max(v.x, std::max(v.y, v.z));
}
inline float MaxAbsComponent(const Vector3& v) {
  return std::max(std::abs(v.x), std::max(std::abs(v.y), std::abs(v.z)));
}
// Absolute values without a branch. glm::abs compares with 0, which the branch predictor cannot guess.
inline Vector3 Abs(const Vector3& v) {
  return {std::abs(v.x), std::abs(v.y), std::abs(v.z)};
}
inline Vector3d Abs(const Vector3d& v) {
  return {std::abs(v.x), std::abs(v.y), std::abs(v.z)};
}
inline Vector2 Abs(const Vector2& v) {
  return {std::abs(v.x), std::abs(v.y)};
}
inline bool IsFinite(const Vector3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

// Linear RGB: Rec. 709 primaries, D65 white. Radiance is in W/(m² sr) per channel.
struct Color {
  float r = 0, g = 0, b = 0;

  Color() = default;
  constexpr explicit Color(float gray) : r(gray), g(gray), b(gray) {}
  constexpr Color(float red, float green, float blue) : r(red), g(green), b(blue) {}

  Color& operator+=(const Color& c) {
    r += c.r;
    g += c.g;
    b += c.b;
    return *this;
  }
  Color& operator*=(const Color& c) {
    r *= c.r;
    g *= c.g;
    b *= c.b;
    return *this;
  }
  Color& operator*=(float s) {
    r *= s;
    g *= s;
    b *= s;
    return *this;
  }
  Color& operator/=(float s) { return *this *= 1.0f / s; }

  bool IsBlack() const { return r == 0 && g == 0 && b == 0; }
  float Max() const { return std::max(r, std::max(g, b)); }
  float Average() const { return (r + g + b) * (1.0f / 3.0f); }
  float Luminance() const { return 0.2126390f * r + 0.7151687f * g + 0.0721923f * b; }
  static constexpr double kLuminance[3] = {0.2126390, 0.7151687, 0.0721923};  // weights for sums in double
  // True if no component is NaN, infinite or negative.
  bool IsValid() const { return r >= 0 && g >= 0 && b >= 0 && r + g + b < kInfinity; }

  friend bool operator==(const Color&, const Color&) = default;
};

inline Color operator+(const Color& a, const Color& b) {
  return {a.r + b.r, a.g + b.g, a.b + b.b};
}
inline Color operator-(const Color& a, const Color& b) {
  return {a.r - b.r, a.g - b.g, a.b - b.b};
}
inline Color operator*(const Color& a, const Color& b) {
  return {a.r * b.r, a.g * b.g, a.b * b.b};
}
// a · b · scale in double: the product of two small throughputs may underflow in float while its product with a large
// unit of flux does not.
inline Color Product(const Color& a, const Color& b, double scale) {
  const auto channel = [scale](float x, float y) {
    return static_cast<float>(static_cast<double>(x) * static_cast<double>(y) * scale);
  };
  return {channel(a.r, b.r), channel(a.g, b.g), channel(a.b, b.b)};
}
inline Color operator*(const Color& a, float s) {
  return {a.r * s, a.g * s, a.b * s};
}
inline Color operator*(float s, const Color& a) {
  return a * s;
}
inline Color operator/(const Color& a, float s) {
  return {a.r / s, a.g / s, a.b / s};
}
inline Color Lerp(const Color& a, const Color& b, float t) {
  return a * (1.0f - t) + b * t;
}
inline Color Sqrt(const Color& c) {
  return {std::sqrt(c.r), std::sqrt(c.g), std::sqrt(c.b)};
}

}  // namespace lampyr
