// The list of all integrators. A new one is a file that defines `IntegratorType …IntegratorType()`, and one row here.
#include "integrators/registry.h"

#include <algorithm>

#include "base/error.h"

namespace lampyr {

const std::vector<IntegratorType>& IntegratorRegistry() {
  static const std::vector<IntegratorType> registry = [] {
    std::vector<IntegratorType> types;
    // clang-format off
    extern IntegratorType PathIntegratorType();  types.push_back(PathIntegratorType());
    extern IntegratorType LightIntegratorType(); types.push_back(LightIntegratorType());
    extern IntegratorType BdptIntegratorType();  types.push_back(BdptIntegratorType());
    extern IntegratorType SppmIntegratorType();  types.push_back(SppmIntegratorType());
    extern IntegratorType VcmIntegratorType();   types.push_back(VcmIntegratorType());
    // clang-format on
    return types;
  }();
  return registry;
}

std::vector<std::string> IntegratorNames() {
  std::vector<std::string> names;
  for (const IntegratorType& type : IntegratorRegistry()) names.push_back(type.name);
  return names;
}

const IntegratorType* FindIntegrator(const std::string& name) {
  for (const IntegratorType& type : IntegratorRegistry()) {
    if (type.name == name) return &type;
  }
  return nullptr;
}

const IntegratorType& IntegratorOf(const std::string& name) {
  if (const IntegratorType* type = FindIntegrator(name)) return *type;
  throw Error("there is no integrator \"" + name + "\"" + DidYouMean(name, IntegratorNames()));
}

Settings IntegratorSettings() {
  std::vector<const Setting*> all;
  for (const IntegratorType& type : IntegratorRegistry()) {
    all.insert(all.end(), type.settings.begin(), type.settings.end());
  }
  return Settings(all);
}

bool GathersPhotons(const std::string& integrator, const Settings& settings) {
  const IntegratorType* type = FindIntegrator(integrator);
  return type && type->gathersPhotons && type->gathersPhotons(settings);
}

CountedTechniques CountedTechniquesOf(const std::string& integrator, const Settings& settings) {
  const IntegratorType* type = FindIntegrator(integrator);
  return type && type->counted ? type->counted(settings) : CountedTechniques();
}

std::vector<std::string> IntegratorHints(const RenderScene& scene, const std::string& integrator) {
  const IntegratorType* type = FindIntegrator(integrator);
  std::vector<std::string> hints = type && type->hints ? type->hints(scene) : std::vector<std::string>();
  if (scene.hasTurningCurves && integrator != "path") {
    hints.push_back(
        "flat curves turn to the ray that meets them, so that paths from lights meet other surfaces than paths from "
        "the camera, and --integrator path shows them otherwise; \"string type\" \"cylinder\" and \"ribbon\" look "
        "the same in all integrators");
  }
  return hints;
}

std::vector<std::string> UnreadBias(const std::string& integrator, const Settings& settings) {
  std::vector<std::string> unread;
  const std::vector<const Setting*>& read = IntegratorOf(integrator).settings;
  for (const auto& [setting, value] : settings.All()) {
    if (setting->isBiased && value != setting->fallback && std::find(read.begin(), read.end(), setting) == read.end())
      unread.push_back(setting->name);
  }
  return unread;
}

std::string IntegratorRefusal(const RenderScene& scene, const std::string& integrator) {
  const IntegratorType* type = FindIntegrator(integrator);
  return type && type->refusal ? type->refusal(scene) : std::string();
}

}  // namespace lampyr
