#include "app/scene_builder.h"

#include <algorithm>
#include <set>
#include <string_view>
#include <unordered_map>

#include "app/shape_builder.h"
#include "lights/light_type.h"
#include "textures/alpha.h"
#include "textures/texture_library.h"

namespace lampyr {

namespace {

// Materials by index and by name, made when first asked for: "mix" refers to others in any order.
class MaterialTable {
 public:
  MaterialTable(const SceneDescription& description, const TextureLibrary& textures, Diagnostics& diagnostics)
      : description_(description),
        textures_(textures),
        diagnostics_(diagnostics),
        unnamed_(description.materials.size(), -1) {}

  // Index into Materials() for a shape's material.
  int32_t IndexOf(const MaterialReference& reference) {
    if (!reference.name.empty()) return Named(reference.name, reference.where);
    if (reference.index < 0) return Default();
    int32_t& index = unnamed_[reference.index];
    if (index < 0) index = Add(Make(description_.materials[reference.index]));
    return index;
  }

  // All materials, so that a mistake in one that is not used is found too.
  void MakeAll() {
    for (const NamedMaterialDescription& named : description_.namedMaterials) Named(named.name, named.material.where);
    for (size_t i = 0; i < description_.materials.size(); ++i) IndexOf({static_cast<int>(i), "", {}});
  }

  const std::vector<std::shared_ptr<const Material>>& Materials() const { return materials_; }

 private:
  int32_t Add(std::shared_ptr<const Material> material) {
    materials_.push_back(std::move(material));
    return static_cast<int32_t>(materials_.size()) - 1;
  }

  int32_t Default() {
    if (default_ < 0) {
      const ParameterList none({}, "Material \"diffuse\"", {});
      default_ = Add(MakeMaterial("diffuse", none, textures_, Lookup({}), diagnostics_));
    }
    return default_;
  }

  std::shared_ptr<const Material> Make(const StatementDescription& statement) {
    return MakeMaterial(statement.type, statement.parameters, textures_, Lookup(statement.where), diagnostics_);
  }

  MaterialLookup Lookup(const FileLocation& where) {
    return [this, where](const std::string& name) { return materials_[Named(name, where)]; };
  }

  int32_t Named(const std::string& name, const FileLocation& where) {
    const auto made = named_.find(name);
    if (made != named_.end()) return made->second;
    if (!inProgress_.insert(name).second) throw Error(where, "the material \"" + name + "\" is mixed from itself");
    constexpr size_t deepest = 256;  // each level takes some of the stack
    if (inProgress_.size() > deepest) throw Error(where, "materials are mixed more than 256 deep");
    std::vector<std::string> names;
    for (const NamedMaterialDescription& named : description_.namedMaterials) {
      names.push_back(named.name);
      if (named.name != name) continue;
      const int32_t index = Add(Make(named.material));
      inProgress_.erase(name);
      return named_[name] = index;
    }
    throw Error(where, "there is no material named \"" + name + "\"" + DidYouMean(name, names));
  }

  const SceneDescription& description_;
  const TextureLibrary& textures_;
  Diagnostics& diagnostics_;
  std::vector<std::shared_ptr<const Material>> materials_;
  std::vector<int32_t> unnamed_;
  std::map<std::string, int32_t> named_;
  std::set<std::string> inProgress_;
  int32_t default_ = -1;
};

// A shape that was read, with what it is made of.
struct ReadEntry {
  LocalShape local;
  int32_t material = -1;
};

// An instance of an object with all nesting resolved. World space.
struct FlatInstance {
  size_t object = 0;
  Transform toWorld;
  const InstanceDescription* description = nullptr;
};

LightTransform ToLightTransform(const Transform& toRender) {
  return {toRender.ToAffine(), toRender.Inverse().ToAffine()};
}

class Builder {
 public:
  Builder(const SceneDescription& description, const RenderOverrides& overrides, bool robust, Diagnostics& diagnostics)
      : description_(description), diagnostics_(diagnostics) {
    built_.settings = ReadRenderSettings(description, overrides, diagnostics);
    geometry_.robust = robust;
  }

  BuiltScene Build();

 private:
  std::vector<ReadEntry> ReadShapes(const std::vector<ShapeDescription>& shapes);
  void FlattenInstances();
  Transform ChooseRenderSpace() const;
  void PlaceEntries();
  void PlaceEntry(const ReadEntry& entry, const Transform& toRender, std::vector<GeometryEntry>& entries,
                  std::vector<const ReadEntry*>* lightEntries);
  void AddAreaLight(const ShapeDescription& description, const Shape& shape, const Transform& instanceToRender,
                    const std::shared_ptr<const AlphaSource>& alpha);
  void CheckAreaLights();
  void AddLights();
  LightBuildContext LightContextFor(const Transform& localToRender) const;

  const SceneDescription& description_;
  Diagnostics& diagnostics_;
  BuiltScene built_;
  GeometryDescription geometry_;
  std::vector<PlacedLight> lights_;
  std::unique_ptr<TextureLibrary> textures_;
  std::unique_ptr<MaterialTable> materials_;
  Transform worldToRender_;
  std::vector<ReadEntry> entries_;
  std::vector<std::vector<ReadEntry>> objects_;
  std::vector<FlatInstance> instances_;
};

// Motion is read and not rendered yet: said once for each place.
void WarnIfAnimated(const Placement& placement, const FileLocation& where, const char* what, Diagnostics& diagnostics) {
  if (!placement.IsAnimated()) return;
  diagnostics.Warn(where, std::string("a moving ") + what + " is not supported yet; its place at shutter open is used");
}

std::vector<ReadEntry> Builder::ReadShapes(const std::vector<ShapeDescription>& shapes) {
  std::vector<ReadEntry> entries;
  for (const ShapeDescription& shape : shapes) {
    WarnIfAnimated(shape.placement, shape.shape.where, "shape", diagnostics_);
    std::optional<LocalShape> local = ReadShape(shape, diagnostics_);
    if (local) entries.push_back({std::move(*local), -1});
  }
  return entries;
}

// Without recursion: objects may be nested as deep as a file is long.
void Builder::FlattenInstances() {
  std::unordered_map<std::string_view, size_t> objects;
  for (size_t i = 0; i < description_.objects.size(); ++i) objects.emplace(description_.objects[i].name, i);
  struct Visit {
    const InstanceDescription* instance;
    Transform parent;
  };
  std::vector<Visit> open;
  const auto add = [&open](const std::vector<InstanceDescription>& list, const Transform& parent) {
    for (size_t i = list.size(); i-- > 0;) open.push_back({&list[i], parent});
  };
  add(description_.instances, Transform());
  while (!open.empty()) {
    const Visit visit = open.back();
    open.pop_back();
    const InstanceDescription& instance = *visit.instance;
    WarnIfAnimated(instance.placement, instance.where, "instance", diagnostics_);
    const Transform toWorld = visit.parent * instance.placement.start;
    const size_t object = objects.at(instance.object);
    if (!objects_[object].empty()) instances_.push_back({object, toWorld, &instance});
    add(description_.objects[object].instances, toWorld);
  }
}

// Where the middle of the scene is far from the origin compared with its size, floats around it are sparse: it is
// moved.
Transform Builder::ChooseRenderSpace() const {
  Bounds3d bounds;
  for (const ReadEntry& entry : entries_) {
    bounds.Add(GetBounds(entry.local, entry.local.description->placement.start));
  }
  for (const FlatInstance& instance : instances_) {
    for (const ReadEntry& entry : objects_[instance.object]) {
      bounds.Add(GetBounds(entry.local, instance.toWorld * entry.local.description->placement.start));
    }
  }
  if (bounds.IsEmpty()) return Transform();
  constexpr double farInRadii = 8;
  const Point3d center = bounds.Center();
  if (glm::length(center) <= farInRadii * 0.5 * glm::length(bounds.Diagonal())) return Transform();
  return Transform::Translate(-center);
}

LightBuildContext Builder::LightContextFor(const Transform& localToRender) const {
  LightBuildContext build;
  build.transform = ToLightTransform(localToRender);
  build.placement = localToRender;
  build.worldToRender = worldToRender_;
  build.textures = textures_.get();
  build.diagnostics = &diagnostics_;
  return build;
}

// The type of a light statement. nullptr, with a warning: pbrt-v4 has it and lampyr does not yet.
const LightType* FindType(const StatementDescription& statement, bool isAreaLight, Diagnostics& diagnostics) {
  if (const LightType* type = FindLightType(statement.type, isAreaLight)) return type;
  const std::string owner =
      std::string(isAreaLight ? "AreaLightSource" : "LightSource") + " \"" + statement.type + "\"";
  std::vector<std::string> names;
  if (!isAreaLight) names = {"goniometric", "projection"};
  if (std::find(names.begin(), names.end(), statement.type) != names.end()) {
    diagnostics.Warn(statement.where, owner + " is not supported yet; it is left out");
    return nullptr;
  }
  for (const LightType& known : LightRegistry()) {
    if (known.isAreaLight == isAreaLight) names.push_back(known.name);
  }
  throw Error(statement.where, "there is no " + owner + DidYouMean(statement.type, names));
}

// Area lights are made shape by shape: what is wrong with one that no shape uses is found here.
void Builder::CheckAreaLights() {
  for (const StatementDescription& statement : description_.areaLights) {
    CheckParameters(*FindType(statement, true, diagnostics_), statement.parameters);
  }
}

// A constant opacity of 0 makes a light that shines and is not there, as in pbrt-v4; any other cuts out a part of it.
void Builder::AddAreaLight(const ShapeDescription& description, const Shape& shape, const Transform& instanceToRender,
                           const std::shared_ptr<const AlphaSource>& alpha) {
  const StatementDescription& statement = description_.areaLights[description.areaLight];
  const auto opacity = textures_->FindFloat(description.shape.parameters, "alpha");
  const bool canBeHit = !opacity || !opacity->IsConstant() || opacity->Evaluate({}) > 0;
  const LightType* type = FindType(statement, true, diagnostics_);
  LightBuildContext build = LightContextFor(instanceToRender);
  build.shape = &shape;
  if (canBeHit) build.alpha = alpha;
  lights_.push_back({MakeLight(*type, statement.parameters, build), build.transform, canBeHit});
}

void Builder::PlaceEntry(const ReadEntry& entry, const Transform& toRender, std::vector<GeometryEntry>& entries,
                         std::vector<const ReadEntry*>* lightEntries) {
  const ShapeDescription& shape = *entry.local.description;
  if (materials_->Materials()[entry.material]->IsInterface()) {  // nothing to see: rays would only pass
    if (shape.areaLight >= 0) {
      diagnostics_.Warn(shape.shape.where, "a shape of material \"interface\" emits no light, as in pbrt-v4");
    }
    return;
  }
  std::shared_ptr<const AlphaSource> alpha;
  if (const auto parameter = textures_->FindFloat(shape.shape.parameters, "alpha")) alpha = MakeAlphaSource(*parameter);

  for (Shape& placed : PlaceShape(entry.local, toRender)) {
    GeometryEntry result;
    result.attributes.material = entry.material;
    result.attributes.alpha = alpha;
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
        AddAreaLight(shape, result.shape, Transform(), alpha);
      }
      const bool cameraVisible = description_.areaLights[shape.areaLight].parameters.GetBool("cameraVisible", true);
      if (!cameraVisible) result.attributes.visibility &= ~visibility::kCamera;
    }
    entries.push_back(std::move(result));
  }
}

void Builder::PlaceEntries() {
  for (const ReadEntry& entry : entries_) {
    PlaceEntry(entry, worldToRender_ * entry.local.description->placement.start, geometry_.entries, nullptr);
  }
  std::vector<std::vector<const ReadEntry*>> objectLights(objects_.size());
  for (size_t i = 0; i < objects_.size(); ++i) {
    GeometryObject object;
    for (const ReadEntry& entry : objects_[i]) {
      PlaceEntry(entry, entry.local.description->placement.start, object.entries, &objectLights[i]);
    }
    geometry_.objects.push_back(std::move(object));
  }
  for (const FlatInstance& instance : instances_) {
    const Transform toRender = worldToRender_ * instance.toWorld;
    if (!toRender.IsAffine())
      throw Error(instance.description->where, "an instance cannot have a perspective transform");
    if (geometry_.objects[instance.object].entries.empty()) continue;
    GeometryInstance placed;
    placed.object = static_cast<uint32_t>(instance.object);
    placed.toRender = toRender.ToAffine();
    placed.toObject = toRender.Inverse().ToAffine();
    placed.firstLight = static_cast<int32_t>(lights_.size());
    for (const GeometryEntry& entry : geometry_.objects[instance.object].entries) {
      if (entry.attributes.light < 0) continue;
      const ReadEntry& source = *objectLights[instance.object][entry.attributes.light];
      AddAreaLight(*source.local.description, entry.shape, toRender, entry.attributes.alpha);
    }
    geometry_.instances.push_back(placed);
  }
}

void Builder::AddLights() {
  for (const LightDescription& light : description_.lights) {
    const StatementDescription& statement = light.light;
    WarnIfAnimated(light.placement, statement.where, "light", diagnostics_);
    const LightType* type = FindType(statement, false, diagnostics_);
    if (!type) continue;
    const Transform toRender = worldToRender_ * light.placement.start;
    if (!toRender.IsAffine()) throw Error(statement.where, "a light cannot have a perspective transform");
    const LightBuildContext build = LightContextFor(toRender);
    lights_.push_back({MakeLight(*type, statement.parameters, build), build.transform});
  }
}

BuiltScene Builder::Build() {
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
  AddLights();
  PlaceEntries();

  RenderScene& scene = built_.scene;
  scene.materials = materials_->Materials();
  scene.camera = BuildCamera(description_, built_.settings, worldToRender_, diagnostics_);
  scene.geometry = std::make_unique<GeometryScene>(std::move(geometry_));
  scene.lighting =
      std::make_unique<LightingServices>(*scene.geometry, std::move(lights_), built_.settings.lightSelection);
  if (!scene.lighting->HasLights()) diagnostics_.Warn("the scene has no light: the image will be black");
  return std::move(built_);
}

}  // namespace

BuiltScene BuildScene(const SceneDescription& description, const RenderOverrides& overrides, bool robust,
                      Diagnostics& diagnostics) {
  return Builder(description, overrides, robust, diagnostics).Build();
}

}  // namespace lampyr
