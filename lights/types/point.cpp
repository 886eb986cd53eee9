// A point light of equal intensity in all directions: I in W/sr (pbrt-v4's "point"); optionally shaped about its -z.
#include "lights/types/shaped_point.h"
#include "sampling/warp.h"

namespace lampyr {

LightType PointLightType();

namespace {

struct EvenProfile {
  static constexpr bool kIsEven = true;
  float Shape(const LightTransform&, const Vector3&) const { return 1; }
  Vector3 Sample(const LightTransform&, const Point2& u) const { return SampleUniformSphere(u); }
  PdfSolidAngle Density(const LightTransform&, const Vector3&) const { return UniformSpherePdf(); }
  double SolidAngle(const LightTransform&) const { return 4 * static_cast<double>(kPi); }
  float Largest() const { return 1; }
  void SetCones(const LightTransform&, EmissionBounds& bounds) const {
    bounds.cosThetaO = -1;
    bounds.cosThetaE = 0;
  }
  bool Clip(const LightTransform&, const Point3&, const Point3&, const Vector3&, float&, float&) const { return true; }
};

// One cache line, because a million of these may be read at random.
static_assert(sizeof(PointLightWith<EvenProfile>) == 64);

}  // namespace

LightType PointLightType() {
  LightType type;
  type.name = "point";
  type.help = "a point that shines alike in all directions; shaping is about -z";
  type.parameters = WithShapingParameters({
      {"I", ParameterType::Spectrum, "W/sr", "1", "", "intensity"},
      {"scale", ParameterType::Float, "", "1", ">= 0", "multiplies the intensity"},
      {"power", ParameterType::Float, "W", "-1", "", "if positive: total power that an intensity of 1 is scaled to"},
      {"from", ParameterType::Point3, "", "0 0 0", "", "position"},
  });
  type.create = [](const ParameterList& parameters, const LightBuildContext& build) {
    return MakePointLight(PointLightType, parameters, build, EvenProfile{}, PointSource::Read(parameters), {0, 0, -1});
  };
  type.samples = {
      "\"rgb I\" [ 3 2 1 ]",
      "\"float power\" 10 \"point3 from\" [ 0.5 -1 2 ] \"float scale\" 3",
      "\"float shaping:cone:angle\" 50 \"float shaping:cone:softness\" 0.4 \"float power\" 10",
      "\"string shaping:ies:file\" \"suite-profile.ies\" \"point3 from\" [ 0.5 -1 2 ]",
      "\"string shaping:ies:file\" \"suite-profile.ies\" \"float shaping:ies:angleScale\" 0.5 \"bool "
      "shaping:ies:normalize\" true \"float shaping:focus\" 2 \"rgb shaping:focusTint\" [ 0.5 0.1 0 ]",
  };
  return type;
}

}  // namespace lampyr
