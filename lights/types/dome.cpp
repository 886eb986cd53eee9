// Light from all directions: pbrt-v4's "infinite", and UsdLux's DomeLight, "dome". The radiance in W/(m² sr) is
// constant or an image. The two types differ in their parameters and in the orientation of an image: "infinite" has
// pbrt-v4's +z up, "dome" OpenEXR's +Y up (sky_parameters.cpp).
#include "lights/infinite_light.h"
#include "lights/types/portal_light.h"

namespace lampyr {

LightType InfiniteLightType();
LightType DomeLightType();

namespace {

std::unique_ptr<Light> MakeSkyLight(LightTypeFunction type, const ParameterList& parameters, SkyChoice sky) {
  if (sky.image) return std::make_unique<InfiniteLightWith<ImageSky>>(type, parameters, std::move(*sky.image));
  return std::make_unique<InfiniteLightWith<EvenSky>>(type, parameters, sky.even);
}

// Four corners of a rectangle in world space, in order around it; the sky is on the side that (corner 3 - corner 0) ×
// (corner 1 - corner 0) points to, as in pbrt-v4, so that they go counterclockwise as seen from inside. Tolerances are
// pbrt-v4's; a skew within them is removed.
PortalShape ReadPortalCorners(const ParameterList& parameters) {
  const FileLocation where = parameters.WhereOf("portal");
  const std::vector<Point3d> p = parameters.GetPoint3s("portal");
  const std::string owner = parameters.Owner() + ": \"portal\" ";
  if (p.size() != 4) {
    throw Error(where, owner + "needs the 4 corners of a rectangle, there are " + std::to_string(p.size()));
  }
  const Vector3d sides[] = {p[1] - p[0], p[2] - p[1], p[2] - p[3], p[3] - p[0]};
  for (const Vector3d& side : sides) {
    if (!(glm::length(side) > 0)) throw Error(where, owner + "has two corners at the same point");
  }
  const auto cosine = [&](int a, int b) { return glm::dot(glm::normalize(sides[a]), glm::normalize(sides[b])); };
  if (std::abs(cosine(0, 2) - 1) > 1e-3 || std::abs(cosine(1, 3) - 1) > 1e-3 || std::abs(cosine(0, 1)) > 1e-3 ||
      std::abs(cosine(1, 2)) > 1e-3 || std::abs(cosine(2, 3)) > 1e-3 || std::abs(cosine(3, 0)) > 1e-3) {
    throw Error(where, owner + "is not a rectangle: four corners in order around it are needed");
  }
  const Vector3d along = glm::normalize(sides[3]);
  return {p[0], sides[3], sides[0] - along * glm::dot(sides[0], along)};
}

std::unique_ptr<Light> CreateInfinite(const ParameterList& parameters, const LightBuildContext& build) {
  SkyChoice sky = ReadInfiniteSky(parameters, build);
  if (!parameters.Find("portal")) return MakeSkyLight(InfiniteLightType, parameters, std::move(sky));
  PortalDescription description;
  description.shape = ReadPortalCorners(parameters);
  description.sky = std::move(sky);
  description.portalMoves = false;
  description.worldToRender = {build.worldToRender.ToAffine(), build.worldToRender.Inverse().ToAffine()};
  return MakePortalLight(InfiniteLightType, parameters, build, std::move(description));
}

std::unique_ptr<Light> CreateDome(const ParameterList& parameters, const LightBuildContext& build) {
  return MakeSkyLight(DomeLightType, parameters, ReadDomeSky(parameters, build));
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
      {"portal", ParameterType::Point3, "", "", "",
       "four corners in world space of a window through which alone the sky shines; counterclockwise as seen "
       "from inside"},
  });
  type.create = CreateInfinite;
  type.samples = {
      "\"rgb L\" [ 3 2 1 ]",
      "\"float illuminance\" 5 \"float diffuse\" 0.5 \"float exposure\" 1",
      "\"string filename\" \"suite-square.exr\"",
      "\"string filename\" \"suite-latlong.exr\" \"float scale\" 3 \"float specular\" 0.25 \"rgb color\" [ 1 0.5 2 ]",
      "\"string filename\" \"suite-square.exr\" \"float illuminance\" 5",
      "\"string filename\" \"suite-bright.exr\"",
      "\"string filename\" \"suite-black.exr\"",
      "\"rgb L\" [ 3 2 1 ] \"point3 portal\" [ -1 -0.6 0.3  1 -0.6 0.3  1 0.6 0.3  -1 0.6 0.3 ] \"float specular\" 0.5",
      "\"string filename\" \"suite-latlong.exr\" \"point3 portal\" [ -1 -0.6 0.3  1 -0.6 0.3  1 0.6 0.3  -1 0.6 0.3 ]",
  };
  return type;
}

LightType DomeLightType() {
  LightType type;
  type.name = "dome";
  type.help = "light from all around: a sky with UsdLux's parameters";
  type.parameters = WithCommonParameters(DomeSkyParameters());
  type.create = CreateDome;
  type.samples = {
      "\"float intensity\" 2 \"bool enableColorTemperature\" true \"float colorTemperature\" 4000",
      "\"string texture:file\" \"suite-latlong.exr\" \"float intensity\" 0.5 \"float diffuse\" 2",
      "\"string texture:file\" \"suite-latlong.exr\" \"string texture:format\" \"latlong\" \"string poleAxis\" \"Z\"",
      "\"string texture:file\" \"suite-square.exr\" \"float specular\" 0",
      "\"string texture:file\" \"suite-bright.exr\" \"string poleAxis\" \"Z\"",
      "\"string texture:file\" \"suite-black.exr\"",
  };
  return type;
}

}  // namespace lampyr
