// The factor of shaping.h as a function of direction: cone, focus and IES profile. Internal to shaping.cpp and
// shaped_table.cpp.
//
// A direction is given by its AxisAngle: 1 - cos of the angle from -z and from +z, in double, to avoid cancellation for
// narrow beams around either pole.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "math/vec.h"
#include "scene/ies_profile.h"

namespace lampyr {

// Values below this count as 0, relative to a maximum of 1: tables of floats can represent all larger ones.
inline constexpr float kDark = 1e-30f;
inline constexpr double kPiExact = 3.14159265358979323846;

struct AxisAngle {
  double fromAxis = 0;    // 1 - cosθ, θ from -z
  double fromZenith = 2;  // 1 + cosθ

  static AxisAngle Of(const Vector3d& d) {
    const double across = d.x * d.x + d.y * d.y;
    if (d.z <= 0) {
      const double w = 0.5 * (across + (1 + d.z) * (1 + d.z));
      return {w, 2 - w};
    }
    const double w = 0.5 * (across + (1 - d.z) * (1 - d.z));
    return {2 - w, w};
  }
  static AxisAngle Of(double theta) {
    const double s = std::sin(0.5 * theta), c = std::cos(0.5 * theta);
    return {2 * s * s, 2 * c * c};
  }
  double Cos() const { return fromAxis <= 1 ? 1 - fromAxis : fromZenith - 1; }
};

// φ in turns, [0, 1].
inline float TurnsOf(const Vector3& d) {
  const float turns = std::atan2(d.y, d.x) * (0.5f * kInvPi);
  return turns < 0 ? turns + 1 : turns;
}

// Knots with a guide table for the search among them.
class KnotFinder {
 public:
  KnotFinder() = default;
  explicit KnotFinder(std::vector<float> knots);

  struct Place {
    size_t index;
    float t;  // [0, 1]
  };
  Place Find(float x) const {
    const float bin = (x - knots_.front()) * binsPerUnit_;
    size_t i = first_[static_cast<size_t>(std::clamp(bin, 0.0f, lastBin_))];
    while (i + 2 < knots_.size() && x >= knots_[i + 1]) ++i;
    const float width = std::max(knots_[i + 1] - knots_[i], 1e-30f);
    return {i, std::clamp((x - knots_[i]) / width, 0.0f, 1.0f)};
  }
  const std::vector<float>& Knots() const { return knots_; }

 private:
  std::vector<float> knots_;
  std::vector<uint32_t> first_;  // for each bin: an interval that begins at or before it
  float binsPerUnit_ = 0, lastBin_ = 0;
};

// A profile, prepared for evaluation.
class ShapedProfile {
 public:
  ShapedProfile(const IesProfile& profile, double angleScale, bool normalize);

  // θ from both poles. Requires θ within the ends of LightThetas.
  float Value(float fromAxis, float fromZenith, float turns) const {
    float theta = fromAxis;
    if (scale_ > 0) theta = fromAxis / scale_;
    if (scale_ < 0) theta = kPi - fromZenith / -scale_;
    theta = std::clamp(theta, 0.0f, kPi);
    const KnotFinder::Place row = thetas_.Find(theta);
    const float* v = &values_[row.index];
    const float low = v[0] + row.t * (v[1] - v[0]);
    if (IsSymmetric()) return low;
    const KnotFinder::Place column = turns_.Find(turns);
    const size_t stride = thetas_.Knots().size();
    const float* a = v + column.index * stride;
    const float here = a[0] + row.t * (a[1] - a[0]), next = a[stride] + row.t * (a[stride + 1] - a[stride]);
    return here + column.t * (next - here);
  }
  bool IsSymmetric() const { return symmetric_; }
  float Largest() const { return largest_; }
  const std::vector<float>& TurnsKnots() const { return turns_.Knots(); }
  // Knots of the profile in the light's θ; the first and last are its ends.
  const std::vector<double>& LightThetas() const { return lightThetas_; }

 private:
  KnotFinder thetas_, turns_;
  std::vector<float> values_;  // thetas fastest
  std::vector<double> lightThetas_;
  float scale_ = 0, largest_ = 0;
  bool symmetric_ = false;

  void SetLightThetas(const std::vector<double>& thetas);
};

struct ConeSetting {
  bool inForce = false;
  double angle = kPiExact, softness = 0;  // radians; [0, 1]
};
struct FocusSetting {
  bool inForce = false;
  float exponent = 0;
  Color tint{0.0f};
};

class ShapedFactor {
 public:
  ShapedFactor(const ConeSetting& cone, const FocusSetting& focus, std::unique_ptr<const ShapedProfile> profile);

  // `turns()`: returns φ; called only if needed.
  template <class Turns>
  Color At(const AxisAngle& angle, const Turns& turns) const {
    if (angle.fromAxis < first_ || angle.fromAxis > last_) return Color(0.0f);
    float scalar = 1;
    if (angle.fromAxis > coneStart_ || profile_) {
      const bool near = angle.fromAxis <= 1;
      const float half = std::sqrt(static_cast<float>(0.5 * (near ? angle.fromAxis : angle.fromZenith)));
      const float theta = 2 * std::asin(std::min(half, 1.0f));
      const float fromAxis = near ? theta : kPi - theta, fromZenith = near ? kPi - theta : theta;
      if (angle.fromAxis > coneStart_) scalar = Edge(fromAxis);
      if (profile_) scalar *= profile_->Value(fromAxis, fromZenith, profile_->IsSymmetric() ? 0.0f : turns());
    }
    if (!focus_.inForce) return Color(scalar);
    float f = std::pow(std::abs(static_cast<float>(angle.Cos())), focus_.exponent);
    if (f < kDark) f = 0;
    return Lerp(focus_.tint, Color(1.0f), f) * scalar;
  }

  float Largest() const;
  const ShapedProfile* Profile() const { return profile_.get(); }
  bool HasFocus() const { return focus_.inForce; }
  // Kinks and ends of the factor, θ ascending: at least the first and the last angle of emission; empty if it is 0
  // everywhere.
  std::vector<double> ThetaKnots() const;

 private:
  float Edge(float theta) const {
    const float t = std::clamp((coneEnd_ - theta) * inverseWidth_, 0.0f, 1.0f);
    return t * t * (3 - 2 * t);
  }

  void AddFocusKnots(std::vector<double>& knots) const;

  FocusSetting focus_;
  std::unique_ptr<const ShapedProfile> profile_;
  double firstTheta_ = 0, startTheta_ = kPiExact, lastTheta_ = kPiExact;
  double first_ = 0, coneStart_ = 2, last_ = 2;  // 1 - cos of them
  float coneEnd_ = kPi, inverseWidth_ = 0;
};

}  // namespace lampyr
