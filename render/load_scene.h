// Loads a scene: reads its file, loads the plugins it may use, and builds it for rendering.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "render/build/plugins.h"
#include "render/build/scene_builder.h"

namespace lampyr {

struct LoadedScene {
  TypeRegistry types;
  BuiltScene built;
  std::string hash;                // of the scene's text
  std::vector<std::string> files;  // named by the scene, and plugins; empty unless `namesFiles`
  double parseSeconds = 0, buildSeconds = 0;
};
// Reads and builds a scene, with the plugins that `plugins` asks for and, where allowed, those that the scene names.
// `strict`: the first warning is an error. `robust`: watertight intersection. Throws every Error as a UsageError,
// because the cause is the scene or a plugin. `check`, if given, is called last.
using SceneCheck = std::function<void(const SceneDescription&, const RenderSettings&)>;
LoadedScene LoadScene(const std::filesystem::path& scene, const PluginOptions& plugins,
                      const RenderOverrides& overrides, bool strict, bool robust, bool namesFiles = false,
                      const SceneCheck& check = {});

}  // namespace lampyr
