#include "lights/types/sky_parameters.h"

namespace lampyr {

namespace {

// Throws an Error if the radiance is not finite.
Color CheckedScale(const ParameterList& parameters, double scale) {
  const Color factor = ReadLightTint(parameters).color * static_cast<float>(scale);
  if (!factor.IsValid()) throw Error(parameters.Where(), parameters.Owner() + ": the radiance is not finite");
  return factor;
}

// From the directions of a dome to those of the map. A latitude-longitude image is oriented as OpenEXR defines it (and
// UsdLux by reference: "latitudes -pi/2 and +pi/2 correspond to the negative and positive y direction. Latitude 0,
// longitude 0 points into positive z direction; and latitude 0, longitude pi/2 points into positive x", longitude +pi
// at the image's left edge): top +Y, middle +Z, a quarter from the left +X. Our map has +z at its top, +x at its left
// edge and +y a quarter from it. A square has the pole in its middle, as "infinite" has +z there.
glm::mat3 DomeToImage(SkyMap map, bool poleIsZ) {
  // Columns: where the dome's x, y and z lead. A pole along Z is reached by turning the dome by 90° about X, which
  // brings +Y to +Z and +Z to -Y.
  if (map == SkyMap::LatLong) {
    return poleIsZ ? glm::mat3(Vector3(0, 1, 0), Vector3(1, 0, 0), Vector3(0, 0, 1))
                   : glm::mat3(Vector3(0, 1, 0), Vector3(0, 0, 1), Vector3(-1, 0, 0));
  }
  return poleIsZ ? glm::mat3(1.0f) : glm::mat3(Vector3(1, 0, 0), Vector3(0, 0, 1), Vector3(0, -1, 0));
}

void CheckTextureFormat(const ParameterList& parameters) {
  const std::string format = parameters.GetString("texture:format", "automatic");
  if (format == "automatic" || format == "latlong") return;
  const std::string start = parameters.Owner() + ": \"texture:format\" \"" + format + "\" ";
  if (format == "mirroredBall" || format == "angular" || format == "cubeMapVerticalCross") {
    throw Error(parameters.WhereOf("texture:format"),
                start + "is not supported; convert the image to latitude-longitude (\"latlong\")");
  }
  throw Error(
      parameters.WhereOf("texture:format"),
      start + "is not known" + DidYouMean(format, {"automatic", "latlong"}) + "; \"automatic\" and \"latlong\" are");
}

bool ReadPoleIsZ(const ParameterList& parameters) {
  const std::string axis = parameters.GetString("poleAxis", "Y");
  if (axis != "Y" && axis != "Z") {
    throw Error(parameters.WhereOf("poleAxis"),
                parameters.Owner() + ": \"poleAxis\" is \"Y\" or \"Z\", not \"" + axis + "\"");
  }
  return axis == "Z";
}

}  // namespace

SkyChoice ReadInfiniteSky(const ParameterList& parameters, const LightBuildContext& build) {
  SkyChoice sky;
  double scale = parameters.GetFloat("scale", 1);
  const double illuminance = parameters.GetFloat("illuminance", -1);
  if (parameters.GetFile("filename").empty()) {
    if (illuminance > 0) scale *= illuminance / static_cast<double>(kPi);
    sky.even.radiance = ReadEmissionColor(parameters, "L") * CheckedScale(parameters, scale);
    if (!sky.even.radiance.IsValid())
      throw Error(parameters.Where(), parameters.Owner() + ": the radiance is not finite");
    return sky;
  }
  if (parameters.Find("L")) {
    throw Error(parameters.WhereOf("L"), parameters.Owner() + ": both \"L\" and \"filename\" are given, one is enough");
  }
  sky.image.emplace(parameters, "filename", build);
  if (illuminance > 0) {
    const double measured = sky.image->UpperIlluminance(build.transform);
    scale = measured > 0 ? scale * illuminance / measured : 0.0;
  }
  sky.image->Scale(CheckedScale(parameters, scale));
  return sky;
}

SkyChoice ReadDomeSky(const ParameterList& parameters, const LightBuildContext& build) {
  SkyChoice sky;
  CheckTextureFormat(parameters);
  const bool poleIsZ = ReadPoleIsZ(parameters);
  const Color factor = CheckedScale(parameters, 1);
  if (parameters.GetFile("texture:file").empty()) {
    sky.even.radiance = factor;
    return sky;
  }
  sky.image.emplace(parameters, "texture:file", build);
  if (parameters.GetString("texture:format", "automatic") == "latlong" && sky.image->Map() != SkyMap::LatLong) {
    throw Error(parameters.WhereOf("texture:file"),
                parameters.Owner() + ": a square image is not \"latlong\"; one twice as wide as high is");
  }
  sky.image->Turn(DomeToImage(sky.image->Map(), poleIsZ));
  sky.image->Scale(factor);
  return sky;
}

std::vector<ParameterInfo> DomeSkyParameters() {
  return {
      {"texture:file", ParameterType::String, "", "\"\"", "",
       "radiance of the sky: a 2:1 latitude-longitude image (top +Y, middle +Z), or an equal-area square"},
      {"texture:format", ParameterType::String, "", "\"automatic\"", "",
       "\"automatic\" (by the image's aspect) or \"latlong\""},
      {"poleAxis", ParameterType::String, "", "\"Y\"", "", "where the image's top points to: \"Y\" or \"Z\""},
  };
}

}  // namespace lampyr
