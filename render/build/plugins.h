// Which plugins a command loads, and from where.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "lights/types/type_registry.h"
#include "scene/scene_description.h"

namespace lampyr {

// Plugin options of the command line.
struct PluginOptions {
  std::vector<std::string> files;  // --plugin
  bool allowsScenePlugins = false;
};

// Loads the built-in types and those of plugins: of the files in `options`, of those that the scene names (null: no
// scene), and of all *.so in the folders of the environment variable LAMPYR_PLUGIN_PATH, separated by colons.
//
// A plugin is native code, and a scene may come from anywhere. A plugin that the scene names is loaded only if
// `allowsScenePlugins` is set, `options` asks for the file, or it lies in one of those folders; otherwise a UsageError
// with the location in the scene.
//
// A name without a folder that does not exist beside the scene (of --plugin: in the working folder) is looked for in
// those folders. Throws a UsageError for a plugin of `options` or of the scene that cannot be used. One in those
// folders is left out with a warning, unless it leaves the system's loader broken (LoaderBroken), which is a
// UsageError. Each file is loaded once.
TypeRegistry LoadTypes(const PluginOptions& options, const SceneDescription* scene);

// The types of `types` that come from the files of --plugin.
std::vector<const LightType*> LightsOf(const TypeRegistry& types, const PluginOptions& options);
std::vector<const FilterType*> FiltersOf(const TypeRegistry& types, const PluginOptions& options);

// Runs `work`, which may call code of plugins. Exceptions other than Error and std::bad_alloc are replaced by an Error
// that names the plugins. Without plugins all exceptions pass unchanged.
void RunForeignCode(const TypeRegistry& types, const std::function<void()>& work);

}  // namespace lampyr
