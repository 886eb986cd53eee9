// A point that shines alike in all directions: intensity I in W/sr (pbrt-v4's "point").
#include "lights/point_light.h"
#include "sampling/warp.h"

namespace lampyr {

LightType PointLightType();

namespace {

struct EvenProfile {
  float Shape(const LightTransform&, const Vector3&) const { return 1; }
  Vector3 Sample(const LightTransform&, const Point2& u) const { return SampleUniformSphere(u); }
  PdfSolidAngle Density(const LightTransform&, const Vector3&) const { return UniformSpherePdf(); }
  double SolidAngle(const LightTransform&) const { return 4 * static_cast<double>(kPi); }
  void SetCones(const LightTransform&, EmissionBounds& bounds) const {
    bounds.cosThetaO = -1;
    bounds.cosThetaE = 0;
  }
  bool Clip(const LightTransform&, const Point3&, const Point3&, const Vector3&, float&, float&) const { return true; }
};

}  // namespace

LightType PointLightType() {
  LightType type;
  type.name = "point";
  type.help = "a point that shines alike in all directions";
  type.parameters = WithCommonParameters({
      {"I", ParameterType::Spectrum, "W/sr", "1", "", "intensity"},
      {"scale", ParameterType::Float, "", "1", ">= 0", "multiplies the intensity"},
      {"power", ParameterType::Float, "W", "-1", "", "if positive: total power that an intensity of 1 is scaled to"},
      {"from", ParameterType::Point3, "", "0 0 0", "", "position"},
  });
  type.create = [](const ParameterList& parameters, const LightBuildContext&) -> std::unique_ptr<Light> {
    return std::make_unique<PointLightWith<EvenProfile>>(PointLightType, parameters, EvenProfile{});
  };
  type.samples = {
      "\"rgb I\" [ 3 2 1 ]",
      "\"float power\" 10 \"point3 from\" [ 0.5 -1 2 ] \"float scale\" 3",
  };
  return type;
}

}  // namespace lampyr
