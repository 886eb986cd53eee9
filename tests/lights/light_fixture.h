// Lights from a line of scene text, for the tests of this folder.
#pragma once

#include <memory>
#include <string>

#include "geometry/quadric.h"
#include "lights/light_type.h"
#include "scene/scene_description.h"

namespace lampyr::test {

// A light with all that it needs to live; `context` is ready for calls.
struct BuiltLight {
  LightBuildContext build;
  std::unique_ptr<Shape> shape;
  std::unique_ptr<Light> light;
  LightContext context;
};

inline ParameterList Parse(const std::string& type, const std::string& parameters, bool isArea) {
  Diagnostics diagnostics(Diagnostics::Mode::Collect);
  const std::string statement =
      std::string(isArea ? "AreaLightSource" : "LightSource") + " \"" + type + "\" " + parameters;
  const SceneDescription scene =
      ParseScene("WorldBegin\n" + statement + (isArea ? "\nShape \"sphere\"\n" : "\n"), "test.pbrt", diagnostics);
  return isArea ? scene.areaLights.at(0).parameters : scene.lights.at(0).light.parameters;
}

inline std::unique_ptr<BuiltLight> Build(const LightType& type, const std::string& parameters,
                                         const Transform& placement = Transform(), const Shape* shape = nullptr,
                                         std::shared_ptr<const AlphaSource> alpha = nullptr) {
  auto built = std::make_unique<BuiltLight>();
  built->build.placement = placement;
  built->build.transform = {placement.ToAffine(), placement.Inverse().ToAffine()};
  built->build.alpha = std::move(alpha);
  if (shape) {
    built->shape = std::make_unique<Shape>(*shape);
    built->build.shape = built->shape.get();
  }
  built->light = MakeLight(type, Parse(type.name, parameters, shape != nullptr), built->build);
  built->context.transform = &built->build.transform;
  built->context.scene = {Point3(0.0f), 10};
  built->context.bidirectional = true;
  built->context.u = built->context.uDirection = Point2(0.3f, 0.6f);
  return built;
}

inline std::unique_ptr<BuiltLight> Build(const std::string& type, const std::string& parameters,
                                         const Transform& placement = Transform(), const Shape* shape = nullptr,
                                         std::shared_ptr<const AlphaSource> alpha = nullptr) {
  return Build(*FindLightType(type, shape != nullptr), parameters, placement, shape, std::move(alpha));
}

inline Shape Sphere(float radius, const Transform& transform = Transform()) {
  Quadric q;
  q.radius = radius;
  q.zMin = -radius;
  q.zMax = radius;
  q.toRender = transform.ToAffine();
  q.toObject = transform.Inverse().ToAffine();
  return q;
}

// A square of side `side` at z = 0 that emits towards +z.
inline std::shared_ptr<TriangleMesh> Square(float side) {
  auto mesh = std::make_shared<TriangleMesh>();
  const float h = 0.5f * side;
  mesh->positions = {{-h, -h, 0}, {h, -h, 0}, {h, h, 0}, {-h, h, 0}};
  mesh->triangles = {{0, 1, 2}, {0, 2, 3}};
  mesh->uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  return mesh;
}
inline Shape AsShape(std::shared_ptr<TriangleMesh> mesh) {
  return std::shared_ptr<const TriangleMesh>(std::move(mesh));
}

}  // namespace lampyr::test
