// A float parameter as opacity, clamped to [0,1].
#include "textures/alpha.h"

#include <algorithm>

namespace lampyr {

namespace {

class ParameterAlpha : public AlphaSource {
 public:
  explicit ParameterAlpha(FloatParameter parameter) : parameter_(std::move(parameter)) {}

  float Alpha(const Point2& uv, const Point3& position, const Normal3& Ng) const override {
    return std::clamp(parameter_.Evaluate({uv, position, Ng}), 0.0f, 1.0f);
  }

 private:
  FloatParameter parameter_;
};

}  // namespace

std::shared_ptr<const AlphaSource> MakeAlphaSource(const FloatParameter& parameter) {
  if (parameter.IsConstant() && parameter.Evaluate({}) >= 1) return nullptr;
  return std::make_shared<ParameterAlpha>(parameter);
}

}  // namespace lampyr
