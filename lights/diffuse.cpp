// AreaLightSource "diffuse": a shape that emits the same radiance in all directions, on one side or both. Radiance in
// W/(m² sr); pbrt-v4's parameters and units. The shape decides how it is sampled: mesh.cpp, bilinear.cpp, quadric.cpp.
#include "lights/area_lights.h"

namespace lampyr {

LightType DiffuseAreaLightType();

namespace {

std::unique_ptr<Light> CreateDiffuse(const ParameterList& parameters, const LightBuildContext& build) {
  if (!build.shape) throw Error(parameters.Where(), "AreaLightSource \"diffuse\" needs a shape");
  const auto& shape = *build.shape;
  if (const auto* mesh = std::get_if<std::shared_ptr<const TriangleMesh>>(&shape)) {
    return MakeMeshLight(DiffuseAreaLightType, parameters, build, *mesh);
  }
  if (const auto* patches = std::get_if<std::shared_ptr<const BilinearMesh>>(&shape)) {
    return MakeBilinearLight(DiffuseAreaLightType, parameters, build, *patches);
  }
  if (const auto* quadric = std::get_if<Quadric>(&shape)) {
    return MakeQuadricLight(DiffuseAreaLightType, parameters, build, *quadric);
  }
  throw Error(parameters.Where(), "AreaLightSource \"diffuse\": curves cannot emit light; use a mesh or a cylinder");
}

}  // namespace

LightType DiffuseAreaLightType() {
  LightType type;
  type.name = "diffuse";
  type.isAreaLight = true;
  type.help = "a shape that emits the same radiance in all directions";
  type.parameters = WithCommonParameters({
      {"L", ParameterType::Spectrum, "W/(m² sr)", "1", "", "emitted radiance"},
      {"scale", ParameterType::Float, "", "1", ">= 0", "multiplies the radiance"},
      {"power", ParameterType::Float, "W", "-1", "",
       "if positive: total power that a radiance of 1 (or the image) is scaled to"},
      {"twosided", ParameterType::Bool, "", "false", "", "emit on both sides"},
      {"filename", ParameterType::String, "", "\"\"", "", "image over the surface's uv, instead of L"},
  });
  type.create = CreateDiffuse;
  type.samples = {
      "\"rgb L\" [ 3 2 1 ]",
      "\"rgb L\" [ 1 1 1 ] \"float scale\" 4 \"bool twosided\" true",
      "\"rgb L\" [ 1 2 1 ] \"float power\" 50",
      "\"string filename\" \"suite-texture.exr\" \"float scale\" 2",
  };
  return type;
}

}  // namespace lampyr
