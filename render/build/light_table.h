// The lights of a scene with their filters and links, made of their statements.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "base/memory.h"
#include "geometry/geometry_scene.h"
#include "lights/scene_light.h"
#include "lights/services/linking.h"
#include "lights/types/type_registry.h"
#include "render/build/placer.h"
#include "scene/scene_description.h"
#include "textures/texture_library.h"

namespace lampyr {

// The data that a light was made from, besides its parameters.
struct KeptContext {
  LightBuildContext build;  // its `shape` is the one below
  std::shared_ptr<const Shape> shape;
};

// Filters have to be added before lights. All methods throw located Errors.
class LightTable {
 public:
  // The arguments have to outlive it. `described`: receives what checking each light requires; null: not wanted.
  LightTable(const SceneDescription& description, const TypeRegistry& types, const TextureLibrary& textures,
             Placer& placer, MemoryBudget& memory, Diagnostics& diagnostics, std::vector<SceneLight>* described)
      : description_(description),
        types_(types),
        textures_(textures),
        placer_(placer),
        memory_(memory),
        diagnostics_(diagnostics),
        described_(described) {}

  // From now on keeps what each light is made of. To be called before lights are added.
  void KeepContexts() { keepsContexts_ = true; }

  void CheckAreaLights();
  void AddFilters();
  // The lights that are no area lights. `entries`: receives the surfaces of those that are their own.
  void AddLights(std::vector<GeometryEntry>& entries);
  // `shapePlacement`: from the shape's own axes to the space that `placement` starts from.
  void AddAreaLight(const ShapeDescription& description, const Shape& shape, const RenderPlacement& placement,
                    const Transform& shapePlacement, const std::shared_ptr<const AlphaSource>& alpha);
  // The light that was added last is one of an instance.
  void MarkLastAsInstance() { lights_.back().isInstance = true; }
  // Index of the light that is added next.
  int32_t NextIndex() const { return static_cast<int32_t>(lights_.size()); }
  // The class of light linking and light filters that the shape is in.
  uint32_t LinkOf(const ShapeDescription& shape);

  // What was added, in the end.
  std::vector<PlacedLight>& Lights() { return lights_; }
  LightLinking& Linking() { return linking_; }
  // What lights were made of, by their indices; their shapes are kept, too. Empty unless that was asked for.
  std::vector<KeptContext>& Contexts() { return contexts_; }
  // Locations of the statements, by the indices of lights and filters.
  const std::vector<FileLocation>& LightPlaces() const { return lightPlaces_; }
  const std::vector<FileLocation>& FilterPlaces() const { return filterPlaces_; }

 private:
  const LightType& FindType(const StatementDescription& statement, bool isAreaLight) const;
  const FilterType& FindFilter(const StatementDescription& statement) const;
  void Bind(int filter, PlacedLight& light) const;
  SceneLight Describe(const StatementDescription& statement, const PlacedLight& placed) const;
  void AddLightSurface(const PlacedLight& placed, std::vector<GeometryEntry>& entries);
  LightBuildContext LightContextFor(const RenderPlacement& placement) const;
  void KeepContext(LightBuildContext build);

  const SceneDescription& description_;
  const TypeRegistry& types_;
  const TextureLibrary& textures_;
  Placer& placer_;
  MemoryBudget& memory_;
  Diagnostics& diagnostics_;
  std::vector<SceneLight>* described_;
  bool keepsContexts_ = false;
  std::vector<KeptContext> contexts_;
  std::vector<PlacedLight> lights_;
  LightLinking linking_;
  std::vector<FileLocation> lightPlaces_, filterPlaces_;
};

}  // namespace lampyr
