#include "render/build/scene_builder.h"

#include <algorithm>
#include <chrono>
#include <map>
#include <string_view>
#include <unordered_map>

#include "base/memory.h"
#include "lights/filters/filter_base.h"
#include "lights/light_type.h"
#include "lights/services/light_surface.h"
#include "math/motion.h"
#include "render/analysis/plan.h"
#include "render/analysis/unseen_samples.h"
#include "render/build/material_table.h"
#include "render/build/shape_builder.h"
#include "scene/limits.h"
#include "scene/nesting.h"
#include "textures/texture_library.h"

namespace lampyr {

namespace {

// A shape that was read, with its material.
struct ReadEntry {
  LocalShape local;
  int32_t material = -1;
};

// An instance of an object with all nesting resolved. World space.
struct FlatInstance {
  size_t object = 0;
  Transform toWorld;                          // at the start of its motion
  std::shared_ptr<const MotionChain> motion;  // null: stays
  const InstanceDescription* description = nullptr;
};

// Shapes with the same motion, or none, as one object of the geometry.
struct Part {
  std::optional<AnimatedTransform> placement;  // motion from the shapes' own space; nullopt: they do not move
  std::vector<const ReadEntry*> entries;
  uint32_t object = 0;                         // of the geometry
  Bounds3 bounds;                              // of the object, in its own space
  std::vector<const ReadEntry*> lightEntries;  // by the light's index within the object
};

LightTransform ToLightTransform(const Transform& toRender) {
  return {toRender.ToAffine(), toRender.Inverse().ToAffine()};
}

AnimatedTransform ToAnimated(const Placement& placement, const char* what, const FileLocation& where) {
  return AnimatedTransform(placement.start, placement.end, what, where);
}

// Placement in render space: at shutter open, and the motion from there.
struct RenderPlacement {
  Transform toRender;
  std::shared_ptr<const Motion> motion;  // null: stays
};

// Approximate memory of an area light with its tables, bytes.
double BytesOfLight(const Shape& shape) {
  const auto* mesh = std::get_if<std::shared_ptr<const TriangleMesh>>(&shape);
  constexpr double ofLight = 1024, ofTriangle = 32;
  return ofLight + (mesh ? ofTriangle * static_cast<double>((*mesh)->triangles.size()) : 0.0);
}

// Memory of the motion of an instance, with the keys made of it, bytes.
double BytesOfMotion(const MotionChain& chain) {
  return static_cast<double>(chain.Length() * sizeof(AnimatedTransform) + size_t{kMaxMotionKeys} * sizeof(Affine));
}

// The transform times, as fractions of the time that the camera's shutter is open.
MotionTimes ReadMotionTimes(const SceneDescription& description) {
  const StatementDescription& camera = description.camera;
  const double open = camera.parameters.GetFloat("shutteropen", 0),
               close = camera.parameters.GetFloat("shutterclose", 1);
  if (!(close > open)) throw Error(camera.where, "\"shutterclose\" must be after \"shutteropen\"");
  return {(description.shutterOpen - open) / (close - open), (description.shutterClose - open) / (close - open)};
}

void WarnOfAlpha(const FloatParameter& alpha, const ParameterList& parameters, Diagnostics& diagnostics) {
  if (!alpha.IsConstant()) return;
  const float value = alpha.Evaluate({});
  if (value >= 0 && value <= 1) return;
  diagnostics.Warn(parameters.WhereOf("alpha"),
                   "\"alpha\" is an opacity from 0 to 1: what is " +
                       std::string(value < 0 ? "below is taken as 0" : "above is taken as 1"));
}

class Builder {
 public:
  Builder(const SceneDescription& description, const RenderOverrides& overrides, bool robust, Diagnostics& diagnostics,
          const TypeRegistry& types)
      : description_(description),
        diagnostics_(diagnostics),
        types_(types),
        memory_(overrides.memory.value_or(AvailableMemory())),
        threads_(overrides.threads) {
    built_.settings = ReadRenderSettings(description, overrides, diagnostics);
    geometry_.robust = robust;
  }

  BuiltScene Build();
  void DescribeLightsIn(std::vector<SceneLight>* lights) { described_ = lights; }

 private:
  std::vector<ReadEntry> ReadShapes(const std::vector<ShapeDescription>& shapes);
  void FlattenInstances();
  Transform ChooseRenderSpace() const;
  bool Moves(const ReadEntry& entry) const {
    return times_.MovesInShutter() && entry.local.description->placement.IsAnimated();
  }
  Transform StillPlacement(const ReadEntry& entry) const;
  RenderPlacement PlaceMoving(const MotionChain& toRender, const Bounds3& moved, const char* what,
                              const FileLocation& where);
  RenderPlacement PlaceInWorld(const Placement& placement, const char* what, const FileLocation& where);
  void PlaceEntries();
  std::vector<Part> MovingParts(const std::vector<ReadEntry>& entries);
  void BuildPart(Part& part);
  void PlacePart(const Part& part, const RenderPlacement& placement);
  void PlaceMovingPart(const Part& part, const MotionChain& parentToRender);
  void PlaceInstance(const FlatInstance& instance, const std::vector<Part>& parts);
  void PlaceEntry(const ReadEntry& entry, const Transform& toRender, std::vector<GeometryEntry>& entries,
                  std::vector<const ReadEntry*>* lightEntries);
  // `shapePlacement`: from the shape's own axes to the space that `placement` starts from.
  void AddAreaLight(const ShapeDescription& description, const Shape& shape, const RenderPlacement& placement,
                    const Transform& shapePlacement, const std::shared_ptr<const AlphaSource>& alpha);
  const LightType& FindType(const StatementDescription& statement, bool isAreaLight) const;
  const FilterType& FindFilter(const StatementDescription& statement) const;
  void CheckAreaLights();
  void AddFilters();
  void Bind(int filter, PlacedLight& light) const;
  uint32_t LinkOf(const ShapeDescription& shape);
  void AddLights();
  SceneLight Describe(const StatementDescription& statement, const PlacedLight& placed) const;
  void AddLightSurface(const PlacedLight& placed);
  LightBuildContext LightContextFor(const RenderPlacement& placement) const;

  const SceneDescription& description_;
  Diagnostics& diagnostics_;
  const TypeRegistry& types_;
  MemoryBudget memory_;
  int threads_;
  BuiltScene built_;
  std::vector<SceneLight>* described_ = nullptr;  // null: not wanted
  GeometryDescription geometry_;
  std::vector<PlacedLight> lights_;
  LightLinking linking_;
  std::unique_ptr<TextureLibrary> textures_;
  std::unique_ptr<MaterialTable> materials_;
  MotionTimes times_;
  Transform worldToRender_;
  std::vector<ReadEntry> entries_;
  std::vector<std::vector<ReadEntry>> objects_;
  std::vector<FlatInstance> instances_;
};

std::vector<ReadEntry> Builder::ReadShapes(const std::vector<ShapeDescription>& shapes) {
  std::vector<ReadEntry> entries;
  for (const ShapeDescription& shape : shapes) {
    std::optional<LocalShape> local = ReadShape(shape, memory_, diagnostics_);
    if (local) entries.push_back({std::move(*local), -1});
  }
  return entries;
}

// Without recursion, because objects may be nested as deep as a file is long.
void Builder::FlattenInstances() {
  if (!description_.instances.empty()) {
    constexpr double bytesPerInstance = 1024;  // here and in the intersector
    memory_.Take(
        description_.instanceCount * bytesPerInstance, description_.instances.front().where,
        std::to_string(static_cast<uint64_t>(description_.instanceCount)) + " instances, of which this is the first,");
  }
  std::unordered_map<std::string_view, size_t> objects;
  for (size_t i = 0; i < description_.objects.size(); ++i) objects.emplace(description_.objects[i].name, i);
  struct Visit {
    const InstanceDescription* instance;
    Transform parent;
    std::shared_ptr<const MotionChain> parentMotion;
  };
  std::vector<Visit> open;
  const auto add = [&open](const std::vector<InstanceDescription>& list, const Transform& parent,
                           const std::shared_ptr<const MotionChain>& parentMotion) {
    for (size_t i = list.size(); i-- > 0;) open.push_back({&list[i], parent, parentMotion});
  };
  add(description_.instances, Transform(), nullptr);
  while (!open.empty()) {
    const Visit visit = open.back();
    open.pop_back();
    const InstanceDescription& instance = *visit.instance;
    const Transform toWorld = visit.parent * instance.placement.start;
    std::shared_ptr<const MotionChain> motion;
    if (visit.parentMotion || instance.placement.IsAnimated()) {
      const MotionChain parent = visit.parentMotion ? *visit.parentMotion : MotionChain(visit.parent);
      const AnimatedTransform own = ToAnimated(instance.placement, "an instance", instance.where);
      motion = std::make_shared<const MotionChain>(parent * own);
      if (motion->Length() > limits::kNestedNames)
        throw Error(instance.where, "motions are nested more than 256 deep: instances that move within others that do");
      memory_.Take(BytesOfMotion(*motion), instance.where, "the motions of instances within one another");
    }
    const size_t object = objects.at(instance.object);
    if (!objects_[object].empty()) instances_.push_back({object, toWorld, motion, &instance});
    add(description_.objects[object].instances, toWorld, motion);
  }
}

// A scene whose middle is far from the origin, compared with its size, is moved to the origin, because floats are
// sparse where it is. Of what moves, the start and the end of the motion are considered.
Transform Builder::ChooseRenderSpace() const {
  Bounds3d bounds;
  const auto add = [&bounds](const ReadEntry& entry, const Transform& startToWorld, const Transform& endToWorld) {
    const Placement& placement = entry.local.description->placement;
    bounds.Add(GetBounds(entry.local, startToWorld * placement.start));
    if (placement.IsAnimated() || !(startToWorld == endToWorld)) {
      bounds.Add(GetBounds(entry.local, endToWorld * placement.end));
    }
  };
  for (const ReadEntry& entry : entries_) add(entry, Transform(), Transform());
  for (const FlatInstance& instance : instances_) {
    const Transform end = instance.motion ? instance.motion->At(1) : instance.toWorld;
    for (const ReadEntry& entry : objects_[instance.object]) add(entry, instance.toWorld, end);
  }
  // Without shapes, the lights and the camera determine where the scene is.
  if (bounds.IsEmpty() && !description_.lights.empty()) {
    bounds.Add(description_.cameraToWorld.start.Point(Point3d(0.0)));
    for (const LightDescription& light : description_.lights) bounds.Add(light.placement.start.Point(Point3d(0.0)));
  }
  if (bounds.IsEmpty()) return Transform();
  constexpr double farInRadii = 8;
  const Point3d center = bounds.Center();
  if (glm::length(center) <= farInRadii * 0.5 * glm::length(bounds.Diagonal())) return Transform();
  return Transform::Translate(-center);
}

// Placement of a shape that does not move while the shutter is open.
Transform Builder::StillPlacement(const ReadEntry& entry) const {
  const ShapeDescription& shape = *entry.local.description;
  if (!shape.placement.IsAnimated()) return shape.placement.start;
  return ToAnimated(shape.placement, "a shape", shape.shape.where).At(times_.FractionAt(0));
}

// `moved`: bounds of what moves, in its own space.
RenderPlacement Builder::PlaceMoving(const MotionChain& toRender, const Bounds3& moved, const char* what,
                                     const FileLocation& where) {
  RenderPlacement placement{toRender.At(times_.FractionAt(0)), MakeMotion(toRender, times_, moved, what, where)};
  if (!placement.toRender.IsAffine()) throw Error(where, std::string(what) + " cannot have a perspective transform");
  if (placement.motion) built_.scene.hasMotion = true;
  return placement;
}

LightBuildContext Builder::LightContextFor(const RenderPlacement& placement) const {
  LightBuildContext build;
  build.transform = ToLightTransform(placement.toRender);
  build.placement = placement.toRender;
  build.worldToRender = worldToRender_;
  build.textures = textures_.get();
  build.diagnostics = &diagnostics_;
  return build;
}

// The type of a light statement.
const LightType& Builder::FindType(const StatementDescription& statement, bool isAreaLight) const {
  if (const LightType* type = types_.FindLight(statement.type, isAreaLight)) return *type;
  const std::string owner =
      std::string(isAreaLight ? "AreaLightSource" : "LightSource") + " \"" + statement.type + "\"";
  std::vector<std::string> names;
  for (const LightType* known : types_.Lights()) {
    if (known->isAreaLight == isAreaLight) names.push_back(known->name);
  }
  throw Error(statement.where, "there is no " + owner + DidYouMean(statement.type, names));
}

// Area lights are made per shape; mistakes in one that no shape uses are found here.
void Builder::CheckAreaLights() {
  for (const StatementDescription& statement : description_.areaLights) {
    CheckParameters(FindType(statement, true), statement.parameters);
  }
}

// With a constant opacity of 0 the light emits but rays pass its surface, as in pbrt-v4. Any other opacity cuts out a
// part of it.
void Builder::AddAreaLight(const ShapeDescription& description, const Shape& shape, const RenderPlacement& placement,
                           const Transform& shapePlacement, const std::shared_ptr<const AlphaSource>& alpha) {
  const AreaLightDescription& statement = description_.areaLights[description.areaLight];
  const auto opacity = textures_->FindFloat(description.shape.parameters, "alpha");
  const bool canBeHit = !opacity || !opacity->IsConstant() || opacity->Evaluate({}) > 0;
  const LightType& type = FindType(statement, true);
  memory_.Take(BytesOfLight(shape), description.shape.where, "the lights that this shape makes, with their tables,");
  if (!(static_cast<float>(GetArea(shape)) > 0))
    diagnostics_.Warn(description.shape.where, "this shape has no area: it emits no light");
  LightBuildContext build = LightContextFor(placement);
  build.shape = &shape;
  build.shapePlacement = shapePlacement;
  if (canBeHit) build.alpha = alpha;
  lights_.push_back({MakeLight(type, statement.parameters, build), build.transform, canBeHit, placement.motion});
  Bind(statement.filter, lights_.back());
  built_.lightPlaces.push_back(statement.where);
  if (!described_) return;
  SceneLight light = Describe(statement, lights_.back());
  light.shape = shape;
  if (build.alpha) {
    build.alpha = nullptr;
    light.withoutCutOuts = MakeLight(type, statement.parameters, build);
  }
  described_->push_back(std::move(light));
}

SceneLight Builder::Describe(const StatementDescription& statement, const PlacedLight& placed) const {
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

void Builder::PlaceEntry(const ReadEntry& entry, const Transform& toRender, std::vector<GeometryEntry>& entries,
                         std::vector<const ReadEntry*>* lightEntries) {
  const ShapeDescription& shape = *entry.local.description;
  if (materials_->Materials()[entry.material]->IsInterface()) {  // rays would only pass
    if (shape.areaLight >= 0) {
      diagnostics_.Warn(shape.shape.where, "a shape of material \"interface\" emits no light, as in pbrt-v4");
    }
    return;
  }
  std::shared_ptr<const AlphaSource> alpha;
  if (const auto parameter = textures_->FindFloat(shape.shape.parameters, "alpha")) {
    WarnOfAlpha(*parameter, shape.shape.parameters, diagnostics_);
    alpha = MakeAlphaSource(*parameter);
  }

  const uint32_t link = LinkOf(shape);
  // Surfaces that emit are never thin: every ray hits them.
  const std::shared_ptr<const Material>& material = materials_->Materials()[entry.material];
  std::shared_ptr<const ThinSurface> thin;
  if (shape.areaLight < 0 && material->Thin()) thin = {material, material->Thin()};
  for (Shape& placed : PlaceShape(entry.local, toRender)) {
    LocateErrors(shape.shape.where, [&] { CheckShape(placed); });
    GeometryEntry result;
    result.attributes.material = entry.material;
    result.attributes.link = link;
    result.attributes.alpha = alpha;
    result.attributes.thin = thin;
    result.attributes.isFibrous = material->IsFibrous();
    result.shape = std::move(placed);
    const bool isCurve = std::holds_alternative<std::shared_ptr<const CurveSet>>(result.shape);
    if (shape.areaLight >= 0 && isCurve) {
      diagnostics_.Warn(shape.shape.where, "curves cannot emit light; these are rendered dark");
    } else if (shape.areaLight >= 0) {
      if (lightEntries) {
        result.attributes.light = static_cast<int32_t>(lightEntries->size());
        lightEntries->push_back(&entry);
      } else {
        result.attributes.light = static_cast<int32_t>(lights_.size());
        AddAreaLight(shape, result.shape, {}, toRender, alpha);
      }
      const bool cameraVisible = description_.areaLights[shape.areaLight].parameters.GetBool("cameraVisible", true);
      if (!cameraVisible) result.attributes.visibility &= ~visibility::kCamera;
    }
    result.attributes.isParametrized =
        built_.settings.firstHit || alpha || thin || result.attributes.light >= 0 || material->NeedsParametrization();
    entries.push_back(std::move(result));
  }
}

// The shapes that move; consecutive shapes with the same motion are one part.
std::vector<Part> Builder::MovingParts(const std::vector<ReadEntry>& entries) {
  std::vector<Part> parts;
  const Placement* last = nullptr;
  for (const ReadEntry& entry : entries) {
    if (!Moves(entry)) continue;
    const ShapeDescription& shape = *entry.local.description;
    if (!last || !(last->start == shape.placement.start && last->end == shape.placement.end)) {
      parts.emplace_back();
      parts.back().placement = ToAnimated(shape.placement, "a shape", shape.shape.where);
    }
    last = &shape.placement;
    parts.back().entries.push_back(&entry);
  }
  return parts;
}

void Builder::BuildPart(Part& part) {
  GeometryObject object;
  for (const ReadEntry* entry : part.entries) {
    const Transform toObject = part.placement ? Transform() : StillPlacement(*entry);
    PlaceEntry(*entry, toObject, object.entries, &part.lightEntries);
  }
  for (const GeometryEntry& entry : object.entries) part.bounds.Add(GetBounds(entry.shape));
  part.object = static_cast<uint32_t>(geometry_.objects.size());
  geometry_.objects.push_back(std::move(object));
}

void Builder::PlacePart(const Part& part, const RenderPlacement& placement) {
  const std::vector<GeometryEntry>& entries = geometry_.objects[part.object].entries;
  if (entries.empty()) return;
  GeometryInstance placed;
  placed.object = part.object;
  placed.toRender = placement.toRender.ToAffine();
  placed.toObject = placement.toRender.Inverse().ToAffine();
  placed.motion = placement.motion;
  placed.firstLight = static_cast<int32_t>(lights_.size());
  for (const GeometryEntry& entry : entries) {
    if (entry.attributes.light < 0) continue;
    const ReadEntry& source = *part.lightEntries[entry.attributes.light];
    AddAreaLight(*source.local.description, entry.shape, placement,
                 part.placement ? Transform() : StillPlacement(source), entry.attributes.alpha);
    lights_.back().isInstance = true;
  }
  geometry_.instances.push_back(placed);
}

void Builder::PlaceMovingPart(const Part& part, const MotionChain& parentToRender) {
  const FileLocation& where = part.entries.front()->local.description->shape.where;
  PlacePart(part, PlaceMoving(parentToRender * *part.placement, part.bounds, "a shape", where));
}

// The first part has the object's shapes that do not move within it.
void Builder::PlaceInstance(const FlatInstance& instance, const std::vector<Part>& parts) {
  const FileLocation& where = instance.description->where;
  if (!instance.motion) {
    const Transform toRender = worldToRender_ * instance.toWorld;
    if (!toRender.IsAffine()) throw Error(where, "an instance cannot have a perspective transform");
    PlacePart(parts.front(), {toRender, nullptr});
    for (size_t i = 1; i < parts.size(); ++i) PlaceMovingPart(parts[i], MotionChain(toRender));
    return;
  }
  const MotionChain toRender = MotionChain(worldToRender_) * *instance.motion;
  PlacePart(parts.front(), PlaceMoving(toRender, parts.front().bounds, "an instance", where));
  for (size_t i = 1; i < parts.size(); ++i) PlaceMovingPart(parts[i], toRender);
}

void Builder::PlaceEntries() {
  for (const ReadEntry& entry : entries_) {
    if (!Moves(entry)) PlaceEntry(entry, worldToRender_ * StillPlacement(entry), geometry_.entries, nullptr);
  }
  for (Part& part : MovingParts(entries_)) {
    BuildPart(part);
    PlaceMovingPart(part, MotionChain(worldToRender_));
  }
  std::vector<std::vector<Part>> parts;
  for (const std::vector<ReadEntry>& object : objects_) {
    Part still;
    for (const ReadEntry& entry : object) {
      if (!Moves(entry)) still.entries.push_back(&entry);
    }
    std::vector<Part> all = MovingParts(object);
    all.insert(all.begin(), std::move(still));
    for (Part& part : all) BuildPart(part);
    parts.push_back(std::move(all));
  }
  for (const FlatInstance& instance : instances_) PlaceInstance(instance, parts[instance.object]);
}

// The type of a filter statement.
const FilterType& Builder::FindFilter(const StatementDescription& statement) const {
  if (const FilterType* type = types_.FindFilter(statement.type)) return *type;
  std::vector<std::string> names = {"none"};
  for (const FilterType* known : types_.Filters()) names.push_back(known->name);
  throw Error(statement.where,
              "there is no LightFilter \"" + statement.type + "\"" + DidYouMean(statement.type, names));
}

// Placement of something without an extent of its own: a light or a filter.
RenderPlacement Builder::PlaceInWorld(const Placement& placement, const char* what, const FileLocation& where) {
  RenderPlacement placed{worldToRender_ * placement.start, nullptr};
  if (placement.IsAnimated())
    placed = PlaceMoving(MotionChain(worldToRender_) * ToAnimated(placement, what, where), {}, what, where);
  if (!placed.toRender.IsAffine()) throw Error(where, std::string(what) + " cannot have a perspective transform");
  return placed;
}

void Builder::AddFilters() {
  std::map<std::string, size_t> latest;  // index of the last filter of each name
  std::vector<Nesting> nestings;
  for (const LightFilterDescription& description : description_.lightFilters) {
    const StatementDescription& statement = description.filter;
    const FilterType& type = FindFilter(statement);
    const RenderPlacement placement = PlaceInWorld(description.placement, "a light filter", statement.where);
    Nesting nesting;
    FilterBuildContext build;
    build.transform = ToLightTransform(placement.toRender);
    build.motion = placement.motion;
    build.textures = textures_.get();
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
    built_.filterPlaces.push_back(statement.where);
  }
}

void Builder::Bind(int filter, PlacedLight& light) const {
  if (filter < 0) return;
  const FilterInstance& bound = linking_.Filters()[static_cast<size_t>(filter)];
  if (!bound.filter) return;
  light.filter = filter;
  const std::optional<float> modifier = bound.filter->GetRadianceModifier();
  if (!modifier || !(*modifier >= 0 && *modifier < kInfinity)) return;
  // For receivers where linking turns the filter off, light is not reduced: the modifier is at least 1.
  light.radianceModifier = bound.linking == 0 ? *modifier : std::max(*modifier, 1.0f);
}

uint32_t Builder::LinkOf(const ShapeDescription& shape) {
  const auto find = [&](const char* target) -> const ParameterList* {
    const auto found = shape.attributes.find(target);
    return found == shape.attributes.end() ? nullptr : &found->second;
  };
  if (shape.attributes.empty()) return 0;
  return linking_.ClassOf(find("lighting"), find("lightfilter"));
}

// The surface of a light that is its own surface, so that rays can hit it: black, and invisible to the camera if the
// settings say so.
void Builder::AddLightSurface(const PlacedLight& placed) {
  GeometryEntry entry;
  entry.shape = MakeLightSurface(placed);
  entry.attributes.light = static_cast<int32_t>(lights_.size());
  if (!placed.light->Settings().cameraVisible) entry.attributes.visibility &= ~visibility::kCamera;
  geometry_.entries.push_back(std::move(entry));
}

void Builder::AddLights() {
  for (const LightDescription& light : description_.lights) {
    const StatementDescription& statement = light.light;
    const LightType& type = FindType(statement, false);
    const RenderPlacement placement = PlaceInWorld(light.placement, "a light", statement.where);
    const LightBuildContext build = LightContextFor(placement);
    PlacedLight placed{MakeLight(type, statement.parameters, build), build.transform, true, placement.motion};
    Bind(light.filter, placed);
    if (placed.light->Surface()) {
      AddLightSurface(placed);
    } else {
      placed.canBeHit = placed.light->Kind() != LightKind::Area;
    }
    if (described_) described_->push_back(Describe(statement, placed));
    lights_.push_back(std::move(placed));
    built_.lightPlaces.push_back(statement.where);
  }
}

BuiltScene Builder::Build() {
  times_ = ReadMotionTimes(description_);
  entries_ = ReadShapes(description_.shapes);
  for (const ObjectDescription& object : description_.objects) objects_.push_back(ReadShapes(object.shapes));
  FlattenInstances();
  worldToRender_ = ChooseRenderSpace();

  textures_ = std::make_unique<TextureLibrary>(description_.textures, worldToRender_, diagnostics_);
  materials_ = std::make_unique<MaterialTable>(description_, *textures_, diagnostics_);
  materials_->MakeAll();
  const auto resolve = [&](std::vector<ReadEntry>& entries) {
    for (ReadEntry& entry : entries) entry.material = materials_->IndexOf(entry.local.description->material);
  };
  resolve(entries_);
  for (auto& object : objects_) resolve(object);

  CheckAreaLights();
  AddFilters();
  AddLights();
  PlaceEntries();

  RenderScene& scene = built_.scene;
  scene.materials = materials_->Materials();
  scene.camera = LocateErrors(description_.camera.where,
                              [&] { return BuildCamera(description_, built_.settings, worldToRender_, diagnostics_); });
  if (built_.settings.firstHit) {
    const bool isWorld = *built_.settings.firstHit == FirstHitSpace::World;
    const Transform toRender = isWorld ? worldToRender_ : worldToRender_ * description_.cameraToWorld.start;
    built_.renderToLayers = toRender.Inverse().ToAffine();
  }
  scene.geometry = std::make_shared<const GeometryScene>(std::move(geometry_));
  linking_.Finish(lights_, diagnostics_);
  scene.lighting = std::make_shared<const LightingServices>(
      *scene.geometry, std::move(lights_), built_.settings.LightSampler(), std::move(linking_),
      static_cast<int>(built_.settings.values.Integer("light-samples")));
  if (built_.settings.integrator == "auto") {
    const auto start = std::chrono::steady_clock::now();
    ChooseIntegrator(scene, built_.settings, threads_).Apply(built_.settings);
    built_.choiceSeconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }
  for (const std::string& name : UnreadBias(built_.settings.integrator, built_.settings.values)) {
    diagnostics_.Warn("\"" + name + "\" is ignored: " + built_.settings.integrator +
                      " does not support it, and renders the picture without that bias");
  }
  const auto& lights = scene.lighting->Lights();
  const bool hasSky = std::any_of(lights.begin(), lights.end(), [](const PlacedLight& placed) {
    return placed.light->Kind() == LightKind::Infinite;
  });
  if (scene.geometry->PrimitiveCount() == 0 && !hasSky && scene.lighting->HasLights())
    diagnostics_.Warn("the scene has no shape for light to fall on: the image will be black");
  if (!scene.lighting->HasLights()) diagnostics_.Warn("the scene has no light: the image will be black");
  WarnOfCoarsePlaces(scene, built_.settings, diagnostics_);
  return std::move(built_);
}

}  // namespace

BuiltScene BuildScene(const SceneDescription& description, const RenderOverrides& overrides, bool robust,
                      Diagnostics& diagnostics, const TypeRegistry& types) {
  return LocateErrors({std::make_shared<const std::string>(description.file.string())},
                      [&] { return Builder(description, overrides, robust, diagnostics, types).Build(); });
}

BuiltScene BuildScene(const SceneDescription& description, bool robust, Diagnostics& diagnostics,
                      std::vector<SceneLight>& lights, const TypeRegistry& types) {
  RenderOverrides overrides;
  overrides.integrator = "path";  // nothing is rendered: a pilot would be for nothing
  Builder builder(description, overrides, robust, diagnostics, types);
  builder.DescribeLightsIn(&lights);
  return builder.Build();
}

}  // namespace lampyr
