// A plugin with one fault, which the build chooses.
#include <stdexcept>

#include "lights/plugin/plugin_api.h"

using namespace lampyr;

namespace lampyr {
LightType NotInAnyLampyr(int);
}

namespace {

[[maybe_unused]] LightType Named(const std::string& name) {
  LightType type;
  type.name = name;
  type.create = [](const ParameterList&, const LightBuildContext&) -> std::unique_ptr<Light> { return nullptr; };
  return type;
}

}  // namespace

LAMPYR_PLUGIN_STAMP

#if !defined(FAULT_no_entry)

LAMPYR_PLUGIN_EXPORT const PluginTypes* lampyr_plugin() {
  static PluginTypes types;
#if defined(FAULT_unresolved)
  types.lights = {NotInAnyLampyr(1)};
#elif defined(FAULT_throws_exception)
  throw std::runtime_error("no licence for this light");
#elif defined(FAULT_throws_number)
  throw 42;
#elif defined(FAULT_returns_null)
  return nullptr;
#elif defined(FAULT_null_factory)
  types.lights = {Named("unmade")};
  types.lights[0].create = nullptr;
#elif defined(FAULT_no_name)
  types.lights = {Named("")};
#elif defined(FAULT_taken_name)
  types.lights = {Named("fresh"), Named("rect")};
#endif
  return &types;
}

#endif

#if defined(FAULT_static_throws)
[[maybe_unused]] const int beforeAnythingElse = []() -> int { throw std::runtime_error("thrown while loading"); }();
#endif
