// The types of light and of light filter that a scene may name: the built-in ones and those of plugins. Filled before a
// scene is built, and read only from then on: an argument, nothing global.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "lights/filters/filter_type.h"
#include "lights/light_type.h"

namespace lampyr {

// What a shared library brings (plugin/plugin_loader.h). Its code stays loaded until the process ends.
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

  // Throws an Error where a name is taken, which names both owners; the registry is then as it was.
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
