// Which plugins a command loads, and from where.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "lights/types/type_registry.h"
#include "scene/scene_description.h"

namespace lampyr {

// What the command line says of plugins.
struct PluginOptions {
  std::vector<std::string> files;  // --plugin
  bool allowsScenePlugins = false;
};

// The built-in types, and those of plugins: of the files that the command line asks for, of those that the scene names
// (null: no scene), and of all *.so in the folders of the environment variable LAMPYR_PLUGIN_PATH, which a colon
// separates.
//
// A plugin is native code, and a scene may come from anywhere: what a scene names is loaded only where
// `allowsScenePlugins` is set, or the file is asked for, or lies in one of those folders. A UsageError at its place
// otherwise.
//
// A name without a folder that is not beside the scene (of --plugin: in the working folder) is looked for in those
// folders. Throws a UsageError for a plugin of the first two kinds that cannot be used; one of the folders' is left out
// with a warning. The same file is loaded once, whoever names it.
TypeRegistry LoadTypes(const PluginOptions& options, const SceneDescription* scene);

// The types that the files of --plugin brought, of those that LoadTypes gave.
std::vector<const LightType*> LightsOf(const TypeRegistry& types, const PluginOptions& options);
std::vector<const FilterType*> FiltersOf(const TypeRegistry& types, const PluginOptions& options);

// Runs work that calls lights. What the code of a plugin throws may be anything: all but an Error leaves as one that
// names the plugins. Without plugins nothing is changed.
void RunForeignCode(const TypeRegistry& types, const std::function<void()>& work);

}  // namespace lampyr
