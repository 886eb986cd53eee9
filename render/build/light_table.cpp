#include "render/build/light_table.h"

#include <algorithm>
#include <map>

#include "geometry/shape_checks.h"
#include "lights/filters/filter_base.h"
#include "lights/light_type.h"
#include "lights/services/light_surface.h"
#include "scene/nesting.h"

namespace lampyr {

namespace {

LightTransform ToLightTransform(const Transform& toRender) {
  return {toRender.ToAffine(), toRender.Inverse().ToAffine()};
}

// Approximate memory of an area light with its tables, bytes.
double BytesOfLight(const Shape& shape) {
  const auto* mesh = std::get_if<std::shared_ptr<const TriangleMesh>>(&shape);
  constexpr double ofLight = 1024, ofTriangle = 32;
  return ofLight + (mesh ? ofTriangle * static_cast<double>((*mesh)->triangles.size()) : 0.0);
}

// The nearest known name; if there is none, where the type may be.
std::string NearestOrPlugin(const std::string& type, const std::vector<std::string>& names) {
  const std::string nearest = DidYouMean(type, names);
  return nearest.empty() ? "; if a plugin has it: --plugin FILE, or LAMPYR_PLUGIN_PATH" : nearest;
}

}  // namespace

LightBuildContext LightTable::LightContextFor(const RenderPlacement& placement) const {
  LightBuildContext build;
  build.transform = ToLightTransform(placement.toRender);
  build.placement = placement.toRender;
  build.worldToRender = placer_.WorldToRender();
  build.textures = &textures_;
  build.diagnostics = &diagnostics_;
  return build;
}

void LightTable::KeepContext(LightBuildContext build) {
  if (!keepsContexts_) return;
  KeptContext kept{std::move(build), nullptr};
  if (kept.build.shape) kept.shape = std::make_shared<const Shape>(*kept.build.shape);
  kept.build.shape = kept.shape.get();
  contexts_.push_back(std::move(kept));
}

// The type of a light statement.
const LightType& LightTable::FindType(const StatementDescription& statement, bool isAreaLight) const {
  if (const LightType* type = types_.FindLight(statement.type, isAreaLight)) return *type;
  const std::string owner =
      std::string(isAreaLight ? "AreaLightSource" : "LightSource") + " \"" + statement.type + "\"";
  std::vector<std::string> names;
  for (const LightType* known : types_.Lights()) {
    if (known->isAreaLight == isAreaLight) names.push_back(known->name);
  }
  throw Error(statement.where, "there is no " + owner + NearestOrPlugin(statement.type, names));
}

// Area lights are made per shape; mistakes in one that no shape uses are found here.
void LightTable::CheckAreaLights() {
  for (const StatementDescription& statement : description_.areaLights) {
    CheckParameters(FindType(statement, true), statement.parameters);
  }
}

// With a constant opacity of 0 the light emits but rays pass its surface, as in pbrt-v4. Any other opacity cuts out a
// part of it.
void LightTable::AddAreaLight(const ShapeDescription& description, const Shape& shape, const RenderPlacement& placement,
                              const Transform& shapePlacement, const std::shared_ptr<const AlphaSource>& alpha) {
  const AreaLightDescription& statement = description_.areaLights[description.areaLight];
  const auto opacity = textures_.FindFloat(description.shape.parameters, "alpha");
  const bool canBeHit = !opacity || !opacity->IsConstant() || opacity->Evaluate({}) > 0;
  const LightType& type = FindType(statement, true);
  memory_.Take(BytesOfLight(shape), description.shape.where, "the lights that this shape makes, with their tables,");
  if (!(static_cast<float>(GetArea(shape)) > 0))
    diagnostics_.Warn(description.shape.where, "this shape has no area: it emits no light");
  LightBuildContext build = LightContextFor(placement);
  build.shape = &shape;
  build.shapePlacement = shapePlacement;
  if (canBeHit) build.alpha = alpha;
  build.letsRaysPass = !canBeHit;
  lights_.push_back({MakeLight(type, statement.parameters, build), build.transform, canBeHit, placement.motion});
  Bind(statement.filter, lights_.back());
  lightPlaces_.push_back(statement.where);
  KeepContext(build);
  if (!described_) return;
  SceneLight light = Describe(statement, lights_.back());
  light.shape = shape;
  if (build.alpha) {
    build.alpha = nullptr;
    light.withoutCutOuts = MakeLight(type, statement.parameters, build);
  }
  described_->push_back(std::move(light));
}

SceneLight LightTable::Describe(const StatementDescription& statement, const PlacedLight& placed) const {
  const std::string& name = placed.light->Settings().name;
  SceneLight light;
  light.name = (name.empty() ? statement.type : name) + " (" + statement.where.ToString() + ")";
  // Several shapes may share a statement.
  size_t same = 1;
  for (const SceneLight& other : *described_) same += other.name.starts_with(light.name) ? 1 : 0;
  if (same > 1) light.name += " #" + std::to_string(same);
  light.parameters = statement.parameters;
  return light;
}

// The type of a filter statement.
const FilterType& LightTable::FindFilter(const StatementDescription& statement) const {
  if (const FilterType* type = types_.FindFilter(statement.type)) return *type;
  std::vector<std::string> names = {"none"};
  for (const FilterType* known : types_.Filters()) names.push_back(known->name);
  throw Error(statement.where,
              "there is no LightFilter \"" + statement.type + "\"" + NearestOrPlugin(statement.type, names));
}

void LightTable::AddFilters() {
  std::map<std::string, size_t> latest;  // index of the last filter of each name
  std::vector<Nesting> nestings;
  for (const LightFilterDescription& description : description_.lightFilters) {
    const StatementDescription& statement = description.filter;
    const FilterType& type = FindFilter(statement);
    const RenderPlacement placement = placer_.PlaceInWorld(description.placement, "a light filter", statement.where);
    Nesting nesting;
    FilterBuildContext build;
    build.transform = ToLightTransform(placement.toRender);
    build.motion = placement.motion;
    build.textures = &textures_;
    build.diagnostics = &diagnostics_;
    build.find = [&](const std::string& name, const FileLocation& where) {
      const auto found = latest.find(name);
      if (found != latest.end()) {
        const FilterInstance& filter = linking_.Filters()[found->second];
        if (filter.filter) nesting.Add(nestings[found->second]);
        return filter;
      }
      std::vector<std::string> names;
      for (const auto& entry : latest) names.push_back(entry.first);
      throw Error(where,
                  "there is no LightFilter with the name \"" + name + "\" before this one" + DidYouMean(name, names));
    };
    FilterInstance filter;
    filter.filter = MakeFilter(type, statement.parameters, build);
    nesting.Check("light filters", description_.lightFilters.size(), statement.where);
    filter.name = statement.parameters.GetString("name", "");
    filter.combineMode = ReadCombineMode(statement.parameters, "combineMode");
    const auto* groups = filter.filter->GetProperty(FilterProperty::LinkingGroups);
    if (groups) filter.linking = linking_.FilterKey(*groups);
    if (filter.filter->IsIdentity()) filter.filter = nullptr;
    if (!filter.name.empty()) latest[filter.name] = nestings.size();
    nestings.push_back(nesting);
    linking_.Add(std::move(filter));
    filterPlaces_.push_back(statement.where);
  }
}

void LightTable::Bind(int filter, PlacedLight& light) const {
  if (filter < 0) return;
  const FilterInstance& bound = linking_.Filters()[static_cast<size_t>(filter)];
  if (!bound.filter) return;
  light.filter = filter;
  const std::optional<float> modifier = bound.filter->GetRadianceModifier();
  if (!modifier || !(*modifier >= 0 && *modifier < kInfinity)) return;
  // For receivers where linking turns the filter off, light is not reduced: the modifier is at least 1.
  light.radianceModifier = bound.linking == 0 ? *modifier : std::max(*modifier, 1.0f);
}

uint32_t LightTable::LinkOf(const ShapeDescription& shape) {
  const auto find = [&](const char* target) -> const ParameterList* {
    const auto found = shape.attributes.find(target);
    return found == shape.attributes.end() ? nullptr : &found->second;
  };
  if (shape.attributes.empty()) return 0;
  return linking_.ClassOf(find("lighting"), find("lightfilter"));
}

// The surface of a light that is its own surface, so that rays can hit it: black, and invisible to the camera if the
// settings say so.
void LightTable::AddLightSurface(const PlacedLight& placed, std::vector<GeometryEntry>& entries) {
  GeometryEntry entry;
  entry.shape = MakeLightSurface(placed);
  entry.attributes.light = static_cast<int32_t>(lights_.size());
  if (!placed.light->Settings().cameraVisible) entry.attributes.visibility &= ~visibility::kCamera;
  entries.push_back(std::move(entry));
}

void LightTable::AddLights(std::vector<GeometryEntry>& entries) {
  for (const LightDescription& light : description_.lights) {
    const StatementDescription& statement = light.light;
    const LightType& type = FindType(statement, false);
    const RenderPlacement placement = placer_.PlaceInWorld(light.placement, "a light", statement.where);
    const LightBuildContext build = LightContextFor(placement);
    PlacedLight placed{MakeLight(type, statement.parameters, build), build.transform, true, placement.motion};
    Bind(light.filter, placed);
    if (placed.light->Surface()) {
      AddLightSurface(placed, entries);
      LocateErrors(statement.where, [&] { CheckShape(entries.back().shape); });
    } else {
      placed.canBeHit = placed.light->Kind() != LightKind::Area;
    }
    if (described_) described_->push_back(Describe(statement, placed));
    lights_.push_back(std::move(placed));
    lightPlaces_.push_back(statement.where);
    KeepContext(build);
  }
}

}  // namespace lampyr
