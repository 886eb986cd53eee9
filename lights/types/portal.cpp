// UsdLux's PortalLight as a light of its own: a width × height rectangle in the local xy plane through which the sky
// shines, towards local -z. The sky is fixed in world space, like a dome to which the portal is the window, and does
// not rotate with the portal. For a rotated sky, "infinite" has portals: there the light's transform rotates the sky,
// and the corners are points of world space.
#include "lights/types/portal_light.h"

namespace lampyr {

LightType PortalLightType();

namespace {

std::unique_ptr<Light> CreatePortal(const ParameterList& parameters, const LightBuildContext& build) {
  PortalDescription description;
  const double width = parameters.GetFloat("width", 1), height = parameters.GetFloat("height", 1);
  description.shape = {{-0.5 * width, -0.5 * height, 0}, {width, 0, 0}, {0, height, 0}};
  description.sky = ReadDomeSky(parameters, build);
  description.worldToRender = {build.worldToRender.ToAffine(), build.worldToRender.Inverse().ToAffine()};
  return MakePortalLight(PortalLightType, parameters, build, std::move(description));
}

}  // namespace

LightType PortalLightType() {
  LightType type;
  type.name = "portal";
  type.help = "a window through which the sky shines";
  std::vector<ParameterInfo> parameters = {
      {"width", ParameterType::Float, "m", "1", "> 0", "of the window, along x"},
      {"height", ParameterType::Float, "m", "1", "> 0", "of the window, along y"},
  };
  for (const ParameterInfo& row : DomeSkyParameters()) parameters.push_back(row);
  type.parameters = WithCommonParameters(parameters);
  type.create = CreatePortal;
  type.samples = {
      "\"float intensity\" 3 \"rgb color\" [ 1 0.5 2 ]",
      "\"float width\" 3 \"float height\" 0.5 \"float specular\" 0.5",
      "\"string texture:file\" \"suite-latlong.exr\" \"float width\" 2",
      "\"string texture:file\" \"suite-square.exr\" \"float height\" 2 \"string poleAxis\" \"Z\"",
      "\"string texture:file\" \"suite-bright.exr\"",
      "\"string texture:file\" \"suite-black.exr\"",
  };
  return type;
}

}  // namespace lampyr
