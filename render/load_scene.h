// From a scene file to a scene that can be rendered: read, with the plugins it may use, and built.
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
  std::string hash;                // of its text
  std::vector<std::string> files;  // that it names, and those of plugins, if they are asked for
  double parseSeconds = 0, buildSeconds = 0;
};
// Reads and builds, with the plugins that are asked for and those that the scene names, where it may. All that goes
// wrong here is the scene's fault, or that of a plugin: a UsageError. `check`, if given, is called last.
using SceneCheck = std::function<void(const SceneDescription&, const RenderSettings&)>;
LoadedScene LoadScene(const std::filesystem::path& scene, const PluginOptions& plugins,
                      const RenderOverrides& overrides, bool strict, bool robust, bool namesFiles = false,
                      const SceneCheck& check = {});

}  // namespace lampyr
