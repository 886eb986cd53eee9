// The types of lights and of light filters that a scene may name: the built-in ones and those of plugins. Filled before
// a scene is built and read-only from then on; passed as an argument rather than global.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "lights/filters/filter_type.h"
#include "lights/light_type.h"

namespace lampyr {

// The types of a shared library (plugin/plugin_loader.h). Its code stays loaded until the process ends.
struct Plugin {
  std::filesystem::path file;
  std::vector<LightType> lights;
  std::vector<FilterType> filters;
};

class TypeRegistry {
 public:
  // The built-in types alone.
  TypeRegistry() = default;
  static const TypeRegistry& BuiltIn();

  // Adds the types of a plugin. If a name is taken, throws an Error that names both owners, and the registry is
  // unchanged.
  void Add(Plugin plugin);

  // The type, or null.
  const LightType* FindLight(const std::string& name, bool isAreaLight) const;
  const FilterType* FindFilter(const std::string& name) const;

  // All of them, the built-in ones first.
  std::vector<const LightType*> Lights() const;
  std::vector<const FilterType*> Filters() const;

  const std::vector<Plugin>& Plugins() const { return plugins_; }

 private:
  std::vector<Plugin> plugins_;
};

}  // namespace lampyr
