// The header that a plugin includes. A plugin is a shared library that adds types of lights and of light filters.
//
//   plugin.cpp                                         CMakeLists.txt
//     #include "lights/plugin/plugin_api.h"              find_package(lampyr REQUIRED)
//     lampyr::LightType RingLightType();                 lampyr_plugin(ring SOURCES plugin.cpp ring.cpp)
//     LAMPYR_PLUGIN({.lights = {RingLightType()}})
//
// The macro defines the plugin's stamp (plugin_stamp.h) and its one C entry point. Nothing else is needed besides the
// light itself. tests/plugins/example is a complete plugin.
//
// Symbol resolution: a plugin links no lampyr library. The lampyr that loads it exports all symbols of its core and
// lights, including those it does not use itself, and the dynamic loader resolves the plugin against them. The process
// thus has one copy of each function, type and table: exceptions and allocations can cross the boundary, and no
// registry or cache is duplicated. (A plugin with its own copy of the libraries would have a second image module,
// second tables, and the code of the day on which it was built.) The price is that a plugin belongs to one version of
// lampyr; the stamp turns a mismatch into a message.
#pragma once

#include <vector>

#include "lights/filters/filter_type.h"
#include "lights/light_type.h"
#include "lights/plugin/plugin_stamp.h"

namespace lampyr {

// The types that a plugin adds. Their names must be new. `create` must be set, and returns an object or throws.
struct PluginTypes {
  std::vector<LightType> lights;
  std::vector<FilterType> filters;
};

// The entry point. Called once, after the stamp has been found to match and all symbols are resolved; may throw. What
// it points to is copied.
inline constexpr const char* kPluginEntryPoint = "lampyr_plugin";
using PluginEntryPoint = const PluginTypes* (*)();

}  // namespace lampyr

#define LAMPYR_PLUGIN_EXPORT extern "C" __attribute__((visibility("default")))

// The stamp alone, for a plugin that writes its entry point itself. Once in a plugin.
#define LAMPYR_PLUGIN_STAMP                                                                                        \
  __attribute__((section(".note.lampyr"), used, aligned(4))) static constexpr lampyr::PluginNote lampyrPluginNote{ \
      lampyr::kPluginStamp};

// Both, with a PluginTypes in braces. Once in a plugin, outside of namespaces.
#define LAMPYR_PLUGIN(...)                                          \
  LAMPYR_PLUGIN_STAMP                                               \
  LAMPYR_PLUGIN_EXPORT const lampyr::PluginTypes* lampyr_plugin() { \
    static const lampyr::PluginTypes types = __VA_ARGS__;           \
    return &types;                                                  \
  }
