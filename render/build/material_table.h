// The materials of a scene, resolved from the names and indices that its shapes and mixes refer to them by.
#pragma once

#include <algorithm>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "materials/material_makers.h"
#include "scene/limits.h"
#include "scene/scene_description.h"
#include "textures/texture_library.h"

namespace lampyr {

// Materials by index and by name, made when first asked for: "mix" refers to others in any order.
class MaterialTable {
 public:
  MaterialTable(const SceneDescription& description, const TextureLibrary& textures, Diagnostics& diagnostics)
      : description_(description),
        textures_(textures),
        diagnostics_(diagnostics),
        unnamed_(description.materials.size(), -1) {
    for (const NamedMaterialDescription& named : description.namedMaterials) descriptions_.emplace(named.name, &named);
  }

  // Index into Materials() for a shape's material.
  int32_t IndexOf(const MaterialReference& reference) {
    if (!reference.name.empty()) return Named(reference.name, reference.where);
    if (reference.index < 0) return Default();
    int32_t& index = unnamed_[reference.index];
    const StatementDescription& material = description_.materials[static_cast<size_t>(reference.index)];
    if (index < 0) index = Add(Make(material), material.NameByPlace());
    return index;
  }

  // Makes all materials, so that mistakes in unused ones are found, too.
  void MakeAll() {
    for (const NamedMaterialDescription& named : description_.namedMaterials) Named(named.name, named.material.where);
    for (size_t i = 0; i < description_.materials.size(); ++i) IndexOf({static_cast<int>(i), "", {}});
  }

  const std::vector<std::shared_ptr<const Material>>& Materials() const { return materials_; }
  // Their names: of a material without a name its type and its place.
  const std::vector<std::string>& Names() const { return names_; }

 private:
  int32_t Add(std::shared_ptr<const Material> material, std::string name) {
    materials_.push_back(std::move(material));
    names_.push_back(std::move(name));
    return static_cast<int32_t>(materials_.size()) - 1;
  }

  int32_t Default() {
    if (default_ < 0) {
      const ParameterList none({}, "Material \"diffuse\"", {});
      default_ = Add(MakeMaterial("diffuse", none, textures_, Lookup({}), diagnostics_), "default");
    }
    return default_;
  }

  std::shared_ptr<const Material> Make(const StatementDescription& statement) {
    return MakeMaterial(statement.type, statement.parameters, textures_, Lookup(statement.where), diagnostics_);
  }

  MaterialLookup Lookup(const FileLocation& where) {
    return [this, where](const std::string& name) { return materials_[Named(name, where)]; };
  }

  // A mix evaluates only one of its two materials: what is limited is the depth of mixes, not how often each is named.
  int32_t Named(const std::string& name, const FileLocation& where) {
    const auto made = named_.find(name);
    if (made != named_.end()) {
      deepest_ = std::max(deepest_, made->second.depth);
      return made->second.index;
    }
    const auto description = descriptions_.find(name);
    if (description == descriptions_.end()) {
      std::vector<std::string> names;
      for (const auto& entry : descriptions_) names.push_back(entry.first);
      throw Error(where, "there is no material named \"" + name + "\"" + DidYouMean(name, names));
    }
    if (!inProgress_.insert(name).second) throw Error(where, "the material \"" + name + "\" is mixed from itself");
    CheckDepth(inProgress_.size(), where);
    const StatementDescription& material = description->second->material;
    const size_t beside = std::exchange(deepest_, 0);
    const int32_t index = Add(Make(material), name);
    const size_t depth = deepest_ + 1;
    CheckDepth(depth, material.where);
    deepest_ = std::max(beside, depth);
    inProgress_.erase(name);
    named_[name] = {index, depth};
    return index;
  }

  // Each level takes stack memory.
  static void CheckDepth(size_t depth, const FileLocation& where) {
    if (depth > limits::kNestedNames) throw Error(where, "materials are mixed more than 256 deep");
  }

  struct MadeMaterial {
    int32_t index = -1;
    size_t depth = 1;  // levels of mixes within one another, this material included
  };

  const SceneDescription& description_;
  const TextureLibrary& textures_;
  Diagnostics& diagnostics_;
  std::vector<std::shared_ptr<const Material>> materials_;
  std::vector<std::string> names_;  // of each
  std::vector<int32_t> unnamed_;
  std::map<std::string, const NamedMaterialDescription*> descriptions_;
  std::map<std::string, MadeMaterial> named_;
  std::set<std::string> inProgress_;
  size_t deepest_ = 0;  // largest depth of the materials named so far by the one being made
  int32_t default_ = -1;
};

}  // namespace lampyr
