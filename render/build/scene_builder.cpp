#include "render/build/scene_builder.h"

#include <algorithm>
#include <cstdio>

#include "base/memory.h"
#include "geometry/shape_checks.h"
#include "media/make_media.h"
#include "media/medium_emission.h"
#include "render/analysis/unseen_samples.h"
#include "render/build/flat_instances.h"
#include "render/build/light_table.h"
#include "render/build/material_table.h"
#include "render/build/placer.h"
#include "render/build/scene_lighting.h"
#include "render/build/scene_media.h"
#include "render/build/shape_builder.h"
#include "render/settings/integrator_choice.h"
#include "textures/texture_library.h"

namespace lampyr {

namespace {

// A shape that was read, with its material.
struct ReadEntry {
  LocalShape local;
  int32_t material = -1;
  int32_t object = -1;  // BuiltScene::objectNames
};

// Shapes with the same motion, or none, as one object of the geometry.
struct Part {
  std::optional<AnimatedTransform> placement;  // motion from the shapes' own space; nullopt: they do not move
  std::vector<const ReadEntry*> entries;
  uint32_t object = 0;                         // of the geometry
  Bounds3 bounds;                              // of the object, in its own space
  std::vector<const ReadEntry*> lightEntries;  // by the light's index within the object
};

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
  void KeepLightingIn(KeptLighting* kept) { kept_ = kept; }

 private:
  void NameObjects();
  std::vector<ReadEntry> ReadShapes(const std::vector<ShapeDescription>& shapes);
  Transform ChooseRenderSpace() const;
  bool Moves(const ReadEntry& entry) const { return placer_.Moves(entry.local.description->placement); }
  Transform StillPlacement(const ReadEntry& entry) const { return placer_.StillPlacement(*entry.local.description); }
  void PlaceEntries();
  void PlaceLayers();
  Point2 MiddleOfFilm() const {
    return 0.5f * Point2(static_cast<float>(built_.settings.width), static_cast<float>(built_.settings.height));
  }
  void LightBuilt();
  void WarnOfSmallScene(const GeometryScene& geometry) const;
  void WarnOfBlackImage(const RenderScene& scene) const;
  MediaAround MediaAroundLights(const Point3& eye) const;
  std::vector<Part> MovingParts(const std::vector<ReadEntry>& entries);
  void BuildPart(Part& part);
  void PlacePart(const Part& part, const FileLocation& where, const RenderPlacement& placement);
  void PlaceMovingPart(const Part& part, const MotionChain& parentToRender);
  void PlaceInstance(const FlatInstance& instance, const std::vector<Part>& parts);
  std::optional<GeometryAttributes> AttributesOf(const ReadEntry& entry) const;
  void PlaceEntry(const ReadEntry& entry, const Transform& toRender, std::vector<GeometryEntry>& entries,
                  std::vector<const ReadEntry*>* lightEntries);
  void MakeEmissive(const ReadEntry& entry, const Transform& toRender, std::vector<const ReadEntry*>* lightEntries,
                    GeometryEntry& placed);

  const SceneDescription& description_;
  Diagnostics& diagnostics_;
  const TypeRegistry& types_;
  MemoryBudget memory_;
  int threads_;
  BuiltScene built_;
  std::vector<SceneLight>* described_ = nullptr;  // null: not wanted
  KeptLighting* kept_ = nullptr;                  // null: not wanted
  GeometryDescription geometry_;
  MediaAround around_;
  std::unique_ptr<TextureLibrary> textures_;
  std::unique_ptr<MaterialTable> materials_;
  std::unique_ptr<SceneMedia> media_;
  Placer placer_;
  std::unique_ptr<LightTable> lights_;
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

// Shapes of an object have its name, meshes that of their file, and others their type and place.
void Builder::NameObjects() {
  std::vector<std::string>& names = built_.objectNames;
  const auto add = [&](ReadEntry& entry, const std::string& name) {
    entry.object = static_cast<int32_t>(names.size());
    names.push_back(name);
  };
  for (ReadEntry& entry : entries_) {
    const StatementDescription& shape = entry.local.description->shape;
    const std::string file = shape.parameters.GetString("filename", "");
    add(entry, file.empty() ? shape.NameByPlace() : std::filesystem::path(file).stem().string());
  }
  for (size_t i = 0; i < objects_.size(); ++i) {
    for (ReadEntry& entry : objects_[i]) add(entry, description_.objects[i].name);
  }
}

// A scene whose middle is far from the origin, compared with its size, is moved to the origin, because floats are
// sparse where it is. Of what moves, the start and the end of the motion are considered.
Transform Builder::ChooseRenderSpace() const {
  Bounds3d bounds;
  const auto add = [&bounds](const ReadEntry& entry, const Transform& startToWorld, const Transform& endToWorld) {
    const Placement& placement = entry.local.description->placement;
    Bounds3d ofShape = GetBounds(entry.local, startToWorld * placement.start);
    const bool moves = placement.IsAnimated() || !(startToWorld == endToWorld);
    // Reported here: once render space is shifted to this shape, all other things would seem to be far away. Motions
    // are reported later.
    if (const Point3d center = ofShape.Center(); !moves && glm::length(center) > static_cast<double>(kFarthest))
      throw Error(entry.local.description->shape.where, "a shape is placed farther out than 1e18");
    if (moves) ofShape.Add(GetBounds(entry.local, endToWorld * placement.end));
    bounds.Add(ofShape);
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

// The attributes that all parts of a shape have; nullopt: rays only pass it, and it is left out.
std::optional<GeometryAttributes> Builder::AttributesOf(const ReadEntry& entry) const {
  const ShapeDescription& shape = *entry.local.description;
  const std::shared_ptr<const Material>& material = materials_->Materials()[entry.material];
  const bool isInterface = material->IsInterface();
  if (isInterface && shape.areaLight >= 0) {
    diagnostics_.Warn(shape.shape.where, "a shape of material \"interface\" emits no light, as in pbrt-v4");
  }
  GeometryAttributes attributes;
  attributes.material = entry.material;
  const auto opacity = textures_->FindFloat(shape.shape.parameters, "alpha");
  // A shape that is nowhere opaque separates nothing.
  const bool isNowhereOpaque = opacity && opacity->IsConstant() && !(opacity->Evaluate({}) > 0);
  if (!isNowhereOpaque) media_->SetSides(shape, attributes);
  if (SeparatesMedia(attributes) && std::holds_alternative<CurveParameters>(entry.local.shape)) {
    diagnostics_.Warn(shape.shape.where, "curves do not separate participating media: the MediumInterface is ignored");
    attributes.insideMedium = attributes.outsideMedium = kSameMedium;
  }
  attributes.isBoundary = isInterface;
  attributes.isOpaque = !isInterface && !material->MayTransmit();
  if (isInterface && !SeparatesMedia(attributes)) {
    if (!isNowhereOpaque && shape.areaLight < 0 && shape.insideMedium == shape.outsideMedium)
      diagnostics_.Warn(shape.shape.where,
                        "this shape of material \"interface\" has the same medium on both sides: it "
                        "does nothing. MediumInterface \"INSIDE\" \"OUTSIDE\" sets them");
    return std::nullopt;
  }
  if (opacity) {
    WarnOfAlpha(*opacity, shape.shape.parameters, diagnostics_);
    attributes.alpha = MakeAlphaSource(*opacity);
  }
  attributes.isParametrized = attributes.alpha != nullptr;
  if (isInterface) return attributes;
  attributes.link = lights_->LinkOf(shape);
  // Surfaces that emit are never thin: every ray hits them.
  if (shape.areaLight < 0 && material->Thin()) attributes.thin = {material, material->Thin()};
  attributes.isFibrous = material->IsFibrous();
  attributes.object = entry.object;
  attributes.isParametrized |= built_.settings.WantsFirstHit() || attributes.thin || material->NeedsParametrization();
  return attributes;
}

void Builder::PlaceEntry(const ReadEntry& entry, const Transform& toRender, std::vector<GeometryEntry>& entries,
                         std::vector<const ReadEntry*>* lightEntries) {
  const ShapeDescription& shape = *entry.local.description;
  const std::optional<GeometryAttributes> attributes = AttributesOf(entry);
  if (!attributes) return;
  const auto* curve = std::get_if<CurveParameters>(&entry.local.shape);
  if (curve && curve->kind == CurveSet::Kind::Flat && !attributes->isFibrous && !attributes->isBoundary)
    built_.scene.hasTurningCurves = true;
  for (Shape& placed : PlaceShape(entry.local, toRender, memory_)) {
    LocateErrors(shape.shape.where, [&] { CheckShape(placed); });
    GeometryEntry result{std::move(placed), *attributes};
    if (shape.areaLight >= 0 && !attributes->isBoundary) MakeEmissive(entry, toRender, lightEntries, result);
    if (SeparatesMedia(*attributes)) {
      media_->AddPlace(lightEntries ? static_cast<int>(geometry_.objects.size()) : -1, entries.size(),
                       shape.shape.where);
    }
    entries.push_back(std::move(result));
  }
}

// `lightEntries`: of the object that the shape is part of; null: of none.
void Builder::MakeEmissive(const ReadEntry& entry, const Transform& toRender,
                           std::vector<const ReadEntry*>* lightEntries, GeometryEntry& placed) {
  const ShapeDescription& shape = *entry.local.description;
  if (std::holds_alternative<std::shared_ptr<const CurveSet>>(placed.shape)) {
    diagnostics_.Warn(shape.shape.where, "curves cannot emit light; these are rendered dark");
    return;
  }
  if (lightEntries) {
    placed.attributes.light = static_cast<int32_t>(lightEntries->size());
    lightEntries->push_back(&entry);
  } else {
    placed.attributes.light = lights_->NextIndex();
    media_->AddAreaLight(lights_->NextIndex(), placed.attributes, shape);
    lights_->AddAreaLight(shape, placed.shape, {}, toRender, placed.attributes.alpha);
  }
  const bool cameraVisible = description_.areaLights[shape.areaLight].parameters.GetBool("cameraVisible", true);
  if (!cameraVisible) placed.attributes.visibility &= ~visibility::kCamera;
  placed.attributes.isParametrized = true;
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

void Builder::PlacePart(const Part& part, const FileLocation& where, const RenderPlacement& placement) {
  const std::vector<GeometryEntry>& entries = geometry_.objects[part.object].entries;
  if (entries.empty()) return;
  GeometryInstance placed;
  placed.object = part.object;
  placed.toRender = placement.toRender.ToAffine();
  placed.toObject = placement.toRender.Inverse().ToAffine();
  placed.motion = placement.motion;
  LocateErrors(where, [&] { CheckInstance(placed); });
  placed.firstLight = lights_->NextIndex();
  for (const GeometryEntry& entry : entries) {
    if (entry.attributes.light < 0) continue;
    const ReadEntry& source = *part.lightEntries[entry.attributes.light];
    media_->AddAreaLight(lights_->NextIndex(), entry.attributes, *source.local.description);
    lights_->AddAreaLight(*source.local.description, entry.shape, placement,
                          part.placement ? Transform() : StillPlacement(source), entry.attributes.alpha);
    lights_->MarkLastAsInstance();
  }
  geometry_.instances.push_back(placed);
}

void Builder::PlaceMovingPart(const Part& part, const MotionChain& parentToRender) {
  const FileLocation& where = part.entries.front()->local.description->shape.where;
  PlacePart(part, where, placer_.PlaceMoving(parentToRender * *part.placement, part.bounds, "a shape", where));
}

// The first part has the object's shapes that do not move within it.
void Builder::PlaceInstance(const FlatInstance& instance, const std::vector<Part>& parts) {
  const FileLocation& where = instance.description->where;
  if (!instance.motion) {
    const Transform toRender = placer_.WorldToRender() * instance.toWorld;
    if (!toRender.IsAffine())
      throw Error(where, "an instance cannot have a perspective transform, or one that is not finite");
    PlacePart(parts.front(), where, {toRender, nullptr});
    for (size_t i = 1; i < parts.size(); ++i) PlaceMovingPart(parts[i], MotionChain(toRender));
    return;
  }
  const MotionChain toRender = MotionChain(placer_.WorldToRender()) * *instance.motion;
  PlacePart(parts.front(), where, placer_.PlaceMoving(toRender, parts.front().bounds, "an instance", where));
  for (size_t i = 1; i < parts.size(); ++i) PlaceMovingPart(parts[i], toRender);
}

void Builder::PlaceEntries() {
  for (const ReadEntry& entry : entries_) {
    if (!Moves(entry)) PlaceEntry(entry, placer_.WorldToRender() * StillPlacement(entry), geometry_.entries, nullptr);
  }
  for (Part& part : MovingParts(entries_)) {
    BuildPart(part);
    PlaceMovingPart(part, MotionChain(placer_.WorldToRender()));
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

// To be called when camera and media are made.
MediaAround Builder::MediaAroundLights(const Point3& eye) const {
  MediaAround around;
  const std::vector<std::shared_ptr<const Medium>>& media = built_.scene.media;
  for (size_t i = 0; i < media.size(); ++i) {
    if (!media[i]->IsEmissive()) continue;
    around.glow = true;
    around.glowPower += RoughPowerOf(*media[i], static_cast<int32_t>(i), *built_.scene.geometry);
  }
  if (description_.cameraMedium.empty() && media_->Exterior() == kVacuum) return around;
  around.unboundedHolds = {eye};
  for (const int32_t medium : media_->Unbounded()) {
    const std::vector<Point3> corners = media[static_cast<size_t>(medium)]->Corners();
    around.unboundedHolds.insert(around.unboundedHolds.end(), corners.begin(), corners.end());
  }
  return around;
}

// Embree misses triangles with edges of less than some 1e-10 units.
void Builder::WarnOfSmallScene(const GeometryScene& geometry) const {
  constexpr float kSmallest = 1e-7f;
  const float radius = geometry.GetBoundingSphere().radius;
  if (!geometry.IsTracedByEmbree() || geometry.PrimitiveCount() == 0 || !(radius < kSmallest)) return;
  char text[160];
  std::snprintf(text, sizeof text,
                "the scene is only %.2g units large: surfaces of less than 1e-9 units are missed by rays; scale it up",
                2 * static_cast<double>(radius));
  diagnostics_.Warn(text);
}

void Builder::WarnOfBlackImage(const RenderScene& scene) const {
  const auto& lights = scene.lighting->Lights();
  const bool hasSky = std::any_of(lights.begin(), lights.end(), [](const PlacedLight& placed) {
    return placed.light->Kind() == LightKind::Infinite;
  });
  const bool hasGlow =
      std::any_of(scene.media.begin(), scene.media.end(), [](const auto& medium) { return medium->IsEmissive(); });
  if (scene.geometry->PrimitiveCount() == 0 && !hasSky && scene.lighting->HasLights() && scene.media.empty())
    diagnostics_.Warn("the scene has no shape for light to fall on: the image will be black");
  if (!scene.lighting->HasLights() && !hasGlow) diagnostics_.Warn("the scene has no light: the image will be black");
}

void Builder::LightBuilt() {
  if (kept_) {
    kept_->settings = built_.settings;
    kept_->lights = lights_->Lights();
    kept_->contexts = std::move(lights_->Contexts());
    kept_->linking = lights_->Linking();
    kept_->around = around_;
    kept_->middleOfFilm = MiddleOfFilm();
    kept_->threads = threads_;
  }
  LightScene({std::move(lights_->Lights()), std::move(lights_->Linking()), around_, MiddleOfFilm(), threads_}, *media_,
             diagnostics_, built_);
  if (!kept_) return;
  kept_->textures = std::move(textures_);
  kept_->media = std::move(media_);
}

// The space of the layers of the first hit.
void Builder::PlaceLayers() {
  const bool isWorld = built_.settings.firstHit.value_or(FirstHitSpace::World) == FirstHitSpace::World;
  const Transform toRender =
      isWorld ? placer_.WorldToRender() : placer_.WorldToRender() * description_.cameraToWorld.start;
  built_.renderToLayers = toRender.Inverse().ToAffine();
  built_.layersToCamera = (isWorld ? description_.cameraToWorld.start.Inverse() : Transform()).ToAffine();
}

BuiltScene Builder::Build() {
  placer_.ReadTimes(description_);
  entries_ = ReadShapes(description_.shapes);
  for (const ObjectDescription& object : description_.objects) objects_.push_back(ReadShapes(object.shapes));
  if (built_.settings.Wants(kObjectMatte)) NameObjects();
  std::vector<bool> hasShapes;
  for (const auto& object : objects_) hasShapes.push_back(!object.empty());
  instances_ = FlattenInstances(description_, hasShapes, memory_);
  placer_.SetWorldToRender(ChooseRenderSpace());

  textures_ = std::make_unique<TextureLibrary>(description_.textures, placer_.WorldToRender(), diagnostics_);
  materials_ = std::make_unique<MaterialTable>(description_, *textures_, diagnostics_);
  materials_->MakeAll();
  media_ = std::make_unique<SceneMedia>(description_, diagnostics_);
  const auto resolve = [&](std::vector<ReadEntry>& entries) {
    for (ReadEntry& entry : entries) entry.material = materials_->IndexOf(entry.local.description->material);
  };
  resolve(entries_);
  for (auto& object : objects_) resolve(object);

  lights_ = std::make_unique<LightTable>(description_, types_, *textures_, placer_, memory_, diagnostics_, described_);
  if (kept_) lights_->KeepContexts();
  lights_->CheckAreaLights();
  lights_->AddFilters();
  lights_->AddLights(geometry_.entries);
  PlaceEntries();
  built_.lightPlaces = lights_->LightPlaces();
  built_.filterPlaces = lights_->FilterPlaces();

  RenderScene& scene = built_.scene;
  scene.hasMotion = placer_.HasMotion();
  scene.materials = materials_->Materials();
  // Every material of the file counts, as a shape of it may be seen.
  scene.isSpectral = built_.settings.spectral.value_or(
      std::any_of(scene.materials.begin(), scene.materials.end(),
                  [](const auto& material) { return material && material->Disperses(); }));
  scene.camera = LocateErrors(description_.camera.where, [&] {
    return BuildCamera(description_, built_.settings, placer_.WorldToRender(), diagnostics_);
  });
  if (built_.settings.WantsFirstHit()) PlaceLayers();
  if (built_.settings.Wants(kMaterialMatte)) built_.materialNames = materials_->Names();
  scene.media = MakeMedia(description_, placer_.WorldToRender(), memory_, diagnostics_);
  media_->NumberPlaces(geometry_);
  scene.geometry = std::make_shared<const GeometryScene>(std::move(geometry_));
  WarnOfSmallScene(*scene.geometry);
  const Ray eye = scene.camera->GenerateRay(MiddleOfFilm(), Point2(0.5f), 0).ray;
  media_->LookAround(*scene.geometry, eye);
  around_ = MediaAroundLights(eye.origin);
  LightBuilt();
  for (const std::string& name : UnreadBias(built_.settings.integrator, built_.settings.values)) {
    diagnostics_.Warn("\"" + name + "\" is ignored: " + built_.settings.integrator +
                      " does not support it, and renders the picture without that bias");
  }
  WarnOfBlackImage(scene);
  WarnOfCoarsePlaces(scene, built_.settings, diagnostics_);
  return std::move(built_);
}

}  // namespace

std::vector<std::string> BuiltScene::FilmLayers() const {
  std::vector<std::string> layers = scene.outputs->Names();
  if (settings.strategies) {
    for (std::string& layer : StrategiesOf(settings).Names()) layers.push_back(std::move(layer));
  }
  if (!settings.bands) return layers;
  for (std::string& layer : LayersOfBands(*settings.bands)) layers.push_back(std::move(layer));
  return layers;
}

BuiltScene BuildScene(const SceneDescription& description, const RenderOverrides& overrides, bool robust,
                      Diagnostics& diagnostics, const TypeRegistry& types) {
  return LocateErrors({std::make_shared<const std::string>(description.file.string())},
                      [&] { return Builder(description, overrides, robust, diagnostics, types).Build(); });
}

BuiltScene BuildScene(const SceneDescription& description, const RenderOverrides& overrides, bool robust,
                      Diagnostics& diagnostics, const TypeRegistry& types, KeptLighting& kept) {
  return LocateErrors({std::make_shared<const std::string>(description.file.string())}, [&] {
    Builder builder(description, overrides, robust, diagnostics, types);
    builder.KeepLightingIn(&kept);
    return builder.Build();
  });
}

BuiltScene BuildScene(const SceneDescription& description, bool robust, Diagnostics& diagnostics,
                      std::vector<SceneLight>& lights, const TypeRegistry& types) {
  RenderOverrides overrides;
  overrides.integrator = "path";  // nothing is rendered: no pilot is needed
  Builder builder(description, overrides, robust, diagnostics, types);
  builder.DescribeLightsIn(&lights);
  return builder.Build();
}

}  // namespace lampyr
