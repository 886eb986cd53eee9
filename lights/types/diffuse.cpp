// AreaLightSource "diffuse": a shape that emits the same radiance in all directions, on one side or both. Radiance in
// W/(m² sr); pbrt-v4's parameters and units. The shape decides how it is sampled: mesh.cpp, bilinear.cpp, quadric.cpp.
#include "lights/types/area_lights.h"

namespace lampyr {

std::unique_ptr<Light> MakeShapeLight(LightTypeFunction type, const ParameterList& parameters,
                                      const LightBuildContext& build, const EmissionReader& readEmission) {
  const auto mistake = [&](const std::string& what) {
    return Error(parameters.Where(), "AreaLightSource \"" + type().name + "\"" + what);
  };
  if (!build.shape) throw mistake(" needs a shape");
  const auto& shape = *build.shape;
  if (const auto* mesh = std::get_if<std::shared_ptr<const TriangleMesh>>(&shape)) {
    return MakeMeshLight(type, parameters, build, readEmission, *mesh);
  }
  if (const auto* patches = std::get_if<std::shared_ptr<const BilinearMesh>>(&shape)) {
    return MakeBilinearLight(type, parameters, build, readEmission, *patches);
  }
  if (const auto* quadric = std::get_if<Quadric>(&shape)) {
    return MakeQuadricLight(type, parameters, build, readEmission, *quadric);
  }
  throw mistake(": curves cannot emit light; use a mesh or a cylinder");
}

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
  type.create = [](const ParameterList& parameters, const LightBuildContext& build) {
    return MakeShapeLight(DiffuseAreaLightType, parameters, build, SurfaceEmission::ReadDiffuse);
  };
  type.samples = {
      "\"rgb L\" [ 3 2 1 ]",
      "\"rgb L\" [ 1 1 1 ] \"float scale\" 4 \"bool twosided\" true",
      "\"rgb L\" [ 1 2 1 ] \"float power\" 50",
      "\"string filename\" \"suite-texture.exr\" \"float scale\" 2",
      "\"float intensity\" 2 \"rgb color\" [ 1 0.5 0.2 ] \"bool normalize\" true \"float specular\" 3",
  };
  return type;
}

}  // namespace lampyr
