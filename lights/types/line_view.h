// Equi-angular sampling of points on a line segment from a point ([Kulla12]), for a linear lamp or along a ray.
//
// With the line at distance h, z0 the foot of the perpendicular and tanθ = (z - z0) / h, θ is uniform. To avoid
// cancellation for short or distant segments, positions are relative to the lower end,
//   z - z_low = h t (1 + a²) / (1 - a t),  a = tanθ_low, t = tan(θ - θ_low).
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "math/upper_angle.h"

namespace lampyr {

class LineView {
 public:
  // The line from `low` to `high`, at `height` (above 0) from the point, whose own coordinate along it is `foot`.
  LineView(float height, float foot, float low, float high)
      : height_(height), foot_(foot), low_(low), high_(high), tanLow_((low - foot) / height) {
    const float tanHigh = (high - foot) / height;
    angle_ = UpperAngle((high - low) / height, 1 + tanLow_ * tanHigh);
  }

  float Sample(float u) const {
    constexpr float kFew = 0.1f;  // radians
    float z;
    if (angle_ < kFew) {
      const float t = std::tan(u * angle_);
      z = low_ + height_ * t * (1 + tanLow_ * tanLow_) / (1 - tanLow_ * t);
    } else {
      z = foot_ + height_ * std::tan(std::atan(tanLow_) + u * angle_);
    }
    return std::clamp(z, low_, high_);
  }

  // 1/length
  float Density(float z) const {
    const float tangent = (z - foot_) / height_;
    const float density = 1 / (height_ * angle_ * (1 + tangent * tangent));
    return density < std::numeric_limits<float>::max() ? density : 0.0f;
  }

 private:
  float height_, foot_, low_, high_, tanLow_, angle_;
};

}  // namespace lampyr
