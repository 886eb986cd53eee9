#include "lights/types/type_registry.h"

#include <set>
#include <utility>

namespace lampyr {

namespace {

std::string Quoted(const std::filesystem::path& file) {
  return "the plugin \"" + file.string() + "\"";
}

// Key of a type. A light and an area light with the same name are different types.
using TypeKey = std::pair<std::string, std::string>;
TypeKey KeyOf(const LightType& type) {
  return {type.Statement(), type.name};
}
TypeKey KeyOf(const FilterType& type) {
  return {"LightFilter", type.name};
}

template <class Type>
bool Has(const std::vector<Type>& types, const TypeKey& key) {
  for (const Type& type : types) {
    if (KeyOf(type) == key) return true;
  }
  return false;
}

// Owner of the type, for messages: lampyr itself or the file of a plugin; "" if there is no such type.
std::string OwnerOf(const TypeKey& key, const std::vector<Plugin>& plugins) {
  if (Has(LightRegistry(), key) || Has(FilterRegistry(), key)) return "lampyr itself";
  if (key == TypeKey{"LightFilter", "none"}) return "lampyr itself";  // ends the binding of a filter
  for (const Plugin& plugin : plugins) {
    if (Has(plugin.lights, key) || Has(plugin.filters, key)) return Quoted(plugin.file);
  }
  return "";
}

}  // namespace

const TypeRegistry& TypeRegistry::BuiltIn() {
  static const TypeRegistry registry;
  return registry;
}

void TypeRegistry::Add(Plugin plugin) {
  std::set<TypeKey> own;
  const auto check = [&](const TypeKey& key) {
    const std::string owner = own.insert(key).second ? OwnerOf(key, plugins_) : Quoted(plugin.file) + " itself";
    if (owner.empty()) return;
    throw Error(Quoted(plugin.file) + ": expected types of new names, found " + key.first + " \"" + key.second +
                "\", which " + owner + " has already");
  };
  for (const LightType& type : plugin.lights) check(KeyOf(type));
  for (const FilterType& type : plugin.filters) check(KeyOf(type));
  plugins_.push_back(std::move(plugin));
}

const LightType* TypeRegistry::FindLight(const std::string& name, bool isAreaLight) const {
  if (const LightType* type = FindLightType(name, isAreaLight)) return type;
  for (const Plugin& plugin : plugins_) {
    for (const LightType& type : plugin.lights) {
      if (type.name == name && type.isAreaLight == isAreaLight) return &type;
    }
  }
  return nullptr;
}

const FilterType* TypeRegistry::FindFilter(const std::string& name) const {
  if (const FilterType* type = FindFilterType(name)) return type;
  for (const Plugin& plugin : plugins_) {
    for (const FilterType& type : plugin.filters) {
      if (type.name == name) return &type;
    }
  }
  return nullptr;
}

std::vector<const LightType*> TypeRegistry::Lights() const {
  std::vector<const LightType*> types;
  for (const LightType& type : LightRegistry()) types.push_back(&type);
  for (const Plugin& plugin : plugins_) {
    for (const LightType& type : plugin.lights) types.push_back(&type);
  }
  return types;
}

std::vector<const FilterType*> TypeRegistry::Filters() const {
  std::vector<const FilterType*> types;
  for (const FilterType& type : FilterRegistry()) types.push_back(&type);
  for (const Plugin& plugin : plugins_) {
    for (const FilterType& type : plugin.filters) types.push_back(&type);
  }
  return types;
}

}  // namespace lampyr
