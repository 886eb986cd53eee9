// Light from all around (pbrt-v4's "infinite"): the same radiance L in W/(m² sr) everywhere, or an image
// (dome_image.cpp).
#include "lights/infinite_light.h"
#include "sampling/warp.h"

namespace lampyr {

LightType InfiniteLightType();

namespace {

struct EvenSky {
  Color radiance;

  Color Radiance(const Vector3&) const { return radiance; }
  Vector3 Sample(const Point2& u) const { return SampleUniformSphere(u); }
  PdfSolidAngle Density(const Vector3&) const { return UniformSpherePdf(); }
  Color Mean() const { return radiance; }
};

std::unique_ptr<Light> CreateInfinite(const ParameterList& parameters, const LightBuildContext& build) {
  if (parameters.Find("portal") && build.diagnostics) {
    build.diagnostics->Warn(parameters.WhereOf("portal"),
                            "LightSource \"infinite\": \"portal\" is not supported yet; the whole sky is sampled");
  }
  if (!parameters.GetFile("filename").empty()) return MakeImageInfiniteLight(InfiniteLightType, parameters, build);
  double scale = parameters.GetFloat("scale", 1);
  const double illuminance = parameters.GetFloat("illuminance", -1);
  if (illuminance > 0) scale *= illuminance / static_cast<double>(kPi);
  const EvenSky sky{ReadEmissionColor(parameters, "L") * static_cast<float>(scale)};
  if (!sky.radiance.IsValid()) throw Error(parameters.Where(), "LightSource \"infinite\": the radiance is not finite");
  return std::make_unique<InfiniteLightWith<EvenSky>>(InfiniteLightType, parameters, sky);
}

}  // namespace

LightType InfiniteLightType() {
  LightType type;
  type.name = "infinite";
  type.help = "light from all around, even or from an image";
  type.parameters = WithCommonParameters({
      {"L", ParameterType::Spectrum, "W/(m² sr)", "1", "", "radiance from everywhere"},
      {"filename", ParameterType::String, "", "\"\"", "",
       "image instead of L: equal-area square, or 2:1 latitude-longitude"},
      {"scale", ParameterType::Float, "", "1", ">= 0", "multiplies the radiance"},
      {"illuminance", ParameterType::Float, "W/m²", "-1", "",
       "if positive: irradiance from the upper hemisphere to scale to"},
      {"portal", ParameterType::Point3, "", "", "", "four corners of a window; not supported yet"},
  });
  type.create = CreateInfinite;
  type.samples = {
      "\"rgb L\" [ 3 2 1 ]",
      "\"float illuminance\" 5",
      "\"string filename\" \"suite-square.exr\"",
      "\"string filename\" \"suite-latlong.exr\" \"float scale\" 3",
      "\"string filename\" \"suite-square.exr\" \"float illuminance\" 5",
      "\"string filename\" \"suite-bright.exr\"",
      "\"string filename\" \"suite-black.exr\"",
  };
  return type;
}

}  // namespace lampyr
