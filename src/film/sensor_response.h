// The response of the sensor, from radiance to film values: exposure, limit on the brightness of a sample, white
// balance.
#pragma once

#include <glm/mat3x3.hpp>

#include "math/vec.h"

namespace lampyr {

class SensorResponse {
 public:
  // `imagingRatio`: film value of radiance 1, which is exposure time · ISO / 100.
  SensorResponse(float imagingRatio = 1) : imagingRatio_(imagingRatio) {}  // NOLINT: a ratio is a response
  // `balance`: white balance, from linear Rec. 709 to linear Rec. 709. `limited`: Rec. 709 to the channels of the
  // sensor. If `maxComponent` > 0, samples whose largest component in these channels exceeds it are scaled down to it.
  SensorResponse(float imagingRatio, const glm::mat3& balance, const glm::mat3& limited, float maxComponent)
      : imagingRatio_(imagingRatio),
        maxComponent_(maxComponent),
        balances_(balance != glm::mat3(1.0f)),
        balance_(balance),
        limited_(limited) {}

  // The response to radiance in other channels, which `toRgb` brings to linear Rec. 709.
  SensorResponse Of(const glm::mat3& toRgb) const {
    SensorResponse response(imagingRatio_, balance_ * toRgb, limited_ * toRgb, maxComponent_);
    return response;
  }
  // The response with a limit of `factor` times maxComponent.
  SensorResponse WithLimitTimes(float factor) const {
    SensorResponse response = *this;
    response.maxComponent_ *= factor;
    return response;
  }
  float ImagingRatio() const { return imagingRatio_; }
  bool Limits() const { return maxComponent_ < kInfinity; }

  // Factor on a sample of `radiance`: exposure, and the limit if the sample exceeds it.
  float Scale(const Color& radiance) const {
    if (!Limits()) [[likely]]
      return imagingRatio_;
    const Vector3 channels = limited_ * Vector3(radiance.r, radiance.g, radiance.b) * imagingRatio_;
    const float largest = std::max({channels.x, channels.y, channels.z});
    return largest > maxComponent_ ? imagingRatio_ * (maxComponent_ / largest) : imagingRatio_;
  }
  // Applies the white balance. Saturated colours may get negative components.
  Color Balance(const Color& value) const {
    if (!balances_) [[likely]]
      return value;
    const Vector3 balanced = balance_ * Vector3(value.r, value.g, value.b);
    return {balanced.x, balanced.y, balanced.z};
  }
  bool Balances() const { return balances_; }
  const glm::mat3& BalanceMatrix() const { return balance_; }
  float MaxComponent() const { return maxComponent_; }

 private:
  float imagingRatio_;
  float maxComponent_ = kInfinity;
  bool balances_ = false;
  glm::mat3 balance_{1.0f}, limited_{1.0f};
};

}  // namespace lampyr
