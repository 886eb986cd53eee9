// Mapping parameters common to all 2-D textures.
#include "textures/texture_families.h"

namespace lampyr {

namespace {

float GetFloat(const ParameterList& parameters, const char* name, double defaultValue) {
  return static_cast<float>(parameters.GetFloat(name, defaultValue));
}

}  // namespace

TextureMapping2D ReadMapping2D(const TextureRequest& request) {
  const ParameterList& parameters = request.Parameters();
  const std::string kind = parameters.GetString("mapping", "uv");
  TextureMapping2D mapping;
  mapping.renderToTexture = request.renderToTexture;
  if (kind == "uv") {
    mapping.scale = {GetFloat(parameters, "uscale", 1), GetFloat(parameters, "vscale", 1)};
    mapping.delta = {GetFloat(parameters, "udelta", 0), GetFloat(parameters, "vdelta", 0)};
  } else if (kind == "spherical") {
    mapping.kind = TextureMapping2D::Kind::Spherical;
  } else if (kind == "cylindrical") {
    mapping.kind = TextureMapping2D::Kind::Cylindrical;
  } else if (kind == "planar") {
    mapping.kind = TextureMapping2D::Kind::Planar;
    mapping.axisS = Vector3(parameters.GetVector3("v1", {1, 0, 0}));
    mapping.axisT = Vector3(parameters.GetVector3("v2", {0, 1, 0}));
    mapping.delta = {GetFloat(parameters, "udelta", 0), GetFloat(parameters, "vdelta", 0)};
  } else {
    throw Error(parameters.WhereOf("mapping"), "\"" + kind + "\" is no texture mapping" +
                                                   DidYouMean(kind, {"uv", "spherical", "cylindrical", "planar"}));
  }
  return mapping;
}

}  // namespace lampyr
