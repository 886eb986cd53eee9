// A scene of lights of all kinds with a filter and light linking, for the tests of selection and of LightingServices.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "light_fixture.h"
#include "lights/filters/filter_type.h"
#include "lights/services/lighting_services.h"
#include "sampling/warp.h"
#include "textures/texture_library.h"

namespace lampyr::test {

// Fraction that the filter on the light "filtered" transmits.
inline constexpr float kFilterFactor = 0.25f;

class LitScene {
 public:
  // `small`: the number of small lamps among the others.
  explicit LitScene(LightSelection selection, int small = 24) {
    Rng rng(17);
    Add("point", R"("string name" "filtered")", At({-1.5, 0.5, 0.3}));
    Add("spot", R"("float coneangle" 20 "string lightGroup" "keys")", At({0.4, 1.6, -0.2}));
    Add("rect", R"("string lightGroup" "keys")", At({0.7, -1.2, 0.9}) * Transform::Rotate(70, {1, 0.3, 0}));
    Add("rect", R"("bool twoSided" true)", At({-0.8, 0.3, -1.4}));
    Add("disk", R"("float shaping:cone:angle" 30)", At({1.4, 0.4, -1.0}) * Transform::Rotate(-40, {0, 1, 0.2}));
    Add("sphere", R"("float radius" 0.3)", At({-0.3, -0.8, 1.5}));
    Add("cylinder", R"("float radius" 0.2)", At({0.1, 1.3, 1.2}));
    AddMesh();
    for (int i = 0; i < small; ++i) {
      const Point3 place = 3.0f * (Point3(rng.NextFloat(), rng.NextFloat(), rng.NextFloat()) - 0.5f);
      const Transform to =
          At(Vector3d(place)) * Transform::Rotate(360 * static_cast<double>(rng.NextFloat()), {1, 2, 3});
      Add(i % 2 ? "spot" : "rect", i % 2 ? R"("float coneangle" 35)" : R"("float width" 0.2 "float height" 0.1)", to);
    }
    Add("distant", R"("float intensity" 0.3)", Transform());
    Add("infinite", R"("float scale" 0.05)", Transform());
    Add("portal", "", At({0, 3, 0}) * Transform::Rotate(-90, {1, 0, 0}));
    Link();
    GeometryDescription description;
    description.entries.push_back({Sphere(4), {}});
    geometry_ = std::make_unique<GeometryScene>(std::move(description));
    lighting_.emplace(*geometry_, lights_, selection, linking_);
  }

  const LightingServices& Lighting() const { return *lighting_; }
  // Class of receivers that the lights of the group "keys" do not illuminate.
  uint32_t WithoutKeys() const { return withoutKeys_; }
  uint32_t IndexOfFiltered() const { return 0; }

 private:
  static Transform At(const Vector3d& place) { return Transform::Translate(place); }

  void Add(const std::string& type, const std::string& parameters, const Transform& placement) {
    built_.push_back(Build(type, parameters, placement));
    Place(*built_.back());
  }
  void AddMesh() {
    const Shape square = AsShape(Square(0.6f));
    built_.push_back(Build("mesh", "", At({1.1, 1.1, 0.6}), &square));
    Place(*built_.back());
  }
  void Place(BuiltLight& built) {
    PlacedLight placed;
    placed.light = std::shared_ptr<const Light>(std::move(built.light));
    placed.transform = built.build.transform;
    lights_.push_back(placed);
  }
  void Link() {
    Diagnostics diagnostics(Diagnostics::Mode::Collect);
    const SceneDescription scene =
        ParseScene("WorldBegin\nLightFilter \"intmult\" \"float intensity\" " + std::to_string(kFilterFactor),
                   "test.pbrt", diagnostics);
    const TextureLibrary textures({}, Transform(), diagnostics);
    FilterBuildContext build;
    build.textures = &textures;
    FilterInstance filter;
    filter.filter = MakeFilter(*FindFilterType("intmult"), scene.lightFilters.at(0).filter.parameters, build);
    lights_[IndexOfFiltered()].filter = linking_.Add(filter);
    lights_[IndexOfFiltered()].radianceModifier = kFilterFactor;
    Parameter excluded;
    excluded.type = ParameterType::String;
    excluded.name = "excludesubset";
    excluded.strings = {"keys"};
    const ParameterList lighting({}, "Attribute", {excluded});
    withoutKeys_ = linking_.ClassOf(&lighting, nullptr);
    linking_.Finish(lights_, diagnostics);
  }

  std::vector<std::unique_ptr<BuiltLight>> built_;
  std::vector<PlacedLight> lights_;
  LightLinking linking_;
  uint32_t withoutKeys_ = 0;
  std::unique_ptr<GeometryScene> geometry_;
  std::optional<LightingServices> lighting_;
};

}  // namespace lampyr::test
