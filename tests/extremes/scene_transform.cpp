#include "extremes/scene_transform.h"

#include <cmath>

#include <glm/matrix.hpp>

namespace lampyr::test {

namespace {

void Move(const Transform& change, Placement& placement) {
  placement.start = change * placement.start;
  placement.end = change * placement.end;
}

ParameterList With(const ParameterList& list, const Parameter& parameter) {
  std::vector<Parameter> parameters;
  for (const Parameter& old : list.All()) {
    if (old.name != parameter.name) parameters.push_back(old);
  }
  parameters.push_back(parameter);
  return {list.Where(), list.Owner(), parameters, list.Where().file};
}

Parameter FloatNamed(const std::string& name, double value) {
  Parameter parameter;
  parameter.name = name;
  parameter.numbers = {value};
  return parameter;
}

// Heights of bumps are lengths: each texture that is one is multiplied.
void ScaleBumps(double scale, StatementDescription& material, std::vector<TextureDescription>& textures) {
  const auto bumps = material.parameters.GetTextureName("displacement");
  if (!bumps) return;
  TextureDescription scaled;
  scaled.name = *bumps + ", scaled for " + std::to_string(textures.size());
  scaled.texture.type = "scale";
  scaled.texture.where = material.where;
  Parameter source;
  source.type = ParameterType::Texture;
  source.name = "tex";
  source.strings = {*bumps};
  scaled.texture.parameters = ParameterList(material.where, "Texture \"scale\"", {source, FloatNamed("scale", scale)});
  textures.push_back(scaled);
  Parameter use = source;
  use.name = "displacement";
  use.strings = {scaled.name};
  material.parameters = With(material.parameters, use);
}

}  // namespace

SceneDescription Transformed(const SceneDescription& scene, const Transform& change) {
  SceneDescription result = scene;
  const double scale = std::cbrt(std::abs(glm::determinant(glm::dmat3(change.Matrix()))));
  Move(change, result.cameraToWorld);
  for (TextureDescription& texture : result.textures) Move(change, texture.placement);
  for (LightFilterDescription& filter : result.lightFilters) Move(change, filter.placement);
  for (ShapeDescription& shape : result.shapes) Move(change, shape.placement);
  for (InstanceDescription& instance : result.instances) Move(change, instance.placement);
  for (LightDescription& light : result.lights) {
    Move(change, light.placement);
    const std::string& type = light.light.type;
    if (type != "point" && type != "spot" && type != "goniometric" && type != "projection") continue;
    const double stops = light.light.parameters.GetFloat("exposure", 0) + 2 * std::log2(scale);
    light.light.parameters = With(light.light.parameters, FloatNamed("exposure", stops));
  }
  if (scale != 1) {
    for (StatementDescription& material : result.materials) ScaleBumps(scale, material, result.textures);
    for (NamedMaterialDescription& named : result.namedMaterials) ScaleBumps(scale, named.material, result.textures);
  }
  return result;
}

}  // namespace lampyr::test
