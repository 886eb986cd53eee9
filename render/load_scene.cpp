#include "render/load_scene.h"

#include "base/progress.h"
#include "scene/referenced_files.h"

namespace lampyr {

LoadedScene LoadScene(const std::filesystem::path& scene, const PluginOptions& plugins,
                      const RenderOverrides& overrides, bool strict, bool robust, bool namesFiles,
                      const SceneCheck& check) {
  Diagnostics diagnostics(strict ? Diagnostics::Mode::Strict : Diagnostics::Mode::Print);
  try {
    const Progress clock(true);
    LoadedScene loaded;
    const SceneDescription description = ReadScene(scene, diagnostics);
    loaded.parseSeconds = clock.Seconds();
    loaded.hash = description.contentHash;
    loaded.types = LoadTypes(plugins, &description);
    if (namesFiles) {
      loaded.files = ReferencedFiles(description);
      for (const Plugin& plugin : loaded.types.Plugins()) loaded.files.push_back(plugin.file.string());
    }
    RunForeignCode(loaded.types,
                   [&] { loaded.built = BuildScene(description, overrides, robust, diagnostics, loaded.types); });
    loaded.buildSeconds = clock.Seconds() - loaded.parseSeconds;
    if (check) check(description, loaded.built.settings);
    return loaded;
  } catch (const UsageError&) {
    throw;
  } catch (const Error& error) {
    throw UsageError(error.Where(), error.Text());
  }
}

}  // namespace lampyr
