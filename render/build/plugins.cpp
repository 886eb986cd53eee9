#include "render/build/plugins.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <set>
#include <sstream>

#include "film/atomic_file.h"
#include "lights/plugin/plugin_loader.h"
#include "scene/scene_paths.h"

namespace lampyr {

namespace {

namespace fs = std::filesystem;

constexpr const char* kPathVariable = "LAMPYR_PLUGIN_PATH";

// Absolute path without links: the same for the same file.
fs::path Canonical(const fs::path& file) {
  std::error_code code;
  const fs::path canonical = fs::weakly_canonical(file, code);
  return code ? fs::absolute(file) : canonical;
}

std::vector<fs::path> PluginFolders() {
  std::vector<fs::path> folders;
  const char* value = std::getenv(kPathVariable);
  std::istringstream list(value ? value : "");
  for (std::string folder; std::getline(list, folder, ':');) {
    if (!folder.empty()) folders.emplace_back(folder);
  }
  return folders;
}

void Warn(const std::string& text) {
  std::fprintf(stderr, "warning: %s\n", text.c_str());
}

// Sorted by name, so that the precedence of two files does not depend on the file system.
std::vector<fs::path> PluginsIn(const fs::path& folder) {
  std::vector<fs::path> files;
  try {
    for (const auto& entry : fs::directory_iterator(folder)) {
      if (entry.path().extension() == ".so") files.push_back(entry.path());
    }
  } catch (const fs::filesystem_error& error) {
    Warn(std::string(kPathVariable) + ": the folder \"" + folder.string() + "\" cannot be read (" +
         error.code().message() + "): it is left out");
  }
  std::sort(files.begin(), files.end());
  return files;
}

// `inPlace`: the path without a search.
fs::path FindPlugin(const std::string& name, const fs::path& inPlace) {
  std::error_code code;
  if (fs::path(name).has_parent_path() || fs::exists(inPlace, code)) return inPlace;
  for (const fs::path& folder : PluginFolders()) {
    if (fs::exists(folder / name, code)) return folder / name;
  }
  return inPlace;
}

// True if the file, or the target of a link, lies directly in one of the folders.
bool IsInPluginFolder(const fs::path& file) {
  const fs::path named = Canonical(FolderOf(file)), linked = Canonical(file).parent_path();
  const std::vector<fs::path> folders = PluginFolders();
  return std::any_of(folders.begin(), folders.end(), [&](const fs::path& folder) {
    const fs::path canonical = Canonical(folder);
    return canonical == named || canonical == linked;
  });
}

[[noreturn]] void RefusePlugin(const PluginReference& plugin, const fs::path& file) {
  throw UsageError(plugin.where, "the scene names the plugin \"" + plugin.name +
                                     "\", which is native code and could do anything: if you trust it, add "
                                     "--plugin '" +
                                     file.string() +
                                     "', or --allow-scene-plugins for all that the scene "
                                     "names, or put it into a folder of " +
                                     kPathVariable);
}

class TypeLoader {
 public:
  bool Has(const fs::path& file) const { return seen_.count(Canonical(file)) != 0; }
  // Loads a plugin that must be usable.
  void Require(const fs::path& file, const FileLocation& where) {
    try {
      Add(file);
    } catch (const Error& error) {
      throw UsageError(where, error.Text());
    }
  }
  void AddAllOf(const fs::path& folder) {
    for (const fs::path& file : PluginsIn(folder)) {
      try {
        Add(file);
      } catch (const LoaderBroken& error) {
        throw UsageError(error.Text());
      } catch (const Error& error) {
        Warn(error.Text() + " (it is left out; " + kPathVariable + ")");
      }
    }
  }
  TypeRegistry Take() { return std::move(types_); }

 private:
  void Add(const fs::path& file) {
    if (seen_.insert(Canonical(file)).second) types_.Add(LoadPlugin(file));
  }

  TypeRegistry types_;
  std::set<fs::path> seen_;
};

template <class Type>
std::vector<const Type*> TypesOf(const TypeRegistry& types, const std::vector<std::string>& asked,
                                 std::vector<Type> Plugin::*ofPlugin) {
  std::set<fs::path> files;
  for (const std::string& name : asked) files.insert(Canonical(FindPlugin(name, name)));
  std::vector<const Type*> found;
  for (const Plugin& plugin : types.Plugins()) {
    if (!files.count(Canonical(plugin.file))) continue;
    for (const Type& type : plugin.*ofPlugin) found.push_back(&type);
  }
  return found;
}

}  // namespace

TypeRegistry LoadTypes(const PluginOptions& options, const SceneDescription* scene) {
  TypeLoader loader;
  for (const std::string& name : options.files) loader.Require(FindPlugin(name, name), {});
  if (scene) {
    for (const PluginReference& plugin : scene->plugins) {
      const std::string writer = plugin.where.file ? *plugin.where.file : scene->file.string();
      const fs::path file = FindPlugin(plugin.name, FindSceneFile(plugin.name, writer, scene->file.string()));
      if (!options.allowsScenePlugins && !loader.Has(file) && !IsInPluginFolder(file)) RefusePlugin(plugin, file);
      loader.Require(file, plugin.where);
    }
  }
  for (const fs::path& folder : PluginFolders()) loader.AddAllOf(folder);
  return loader.Take();
}

std::vector<const LightType*> LightsOf(const TypeRegistry& types, const PluginOptions& options) {
  return TypesOf(types, options.files, &Plugin::lights);
}

std::vector<const FilterType*> FiltersOf(const TypeRegistry& types, const PluginOptions& options) {
  return TypesOf(types, options.files, &Plugin::filters);
}

void RunForeignCode(const TypeRegistry& types, const std::function<void()>& work) {
  if (types.Plugins().empty()) return work();
  const auto fail = [&](const std::string& found) {
    std::string files;
    for (const Plugin& plugin : types.Plugins()) {
      files += (files.empty() ? "\"" : ", \"") + plugin.file.string() + "\"";
    }
    throw Error("expected no exception, found " + found + "; the plugins in use: " + files);
  };
  try {
    work();
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    fail(std::string("one: ") + error.what());
  } catch (...) {
    fail("something thrown that is none");
  }
}

}  // namespace lampyr
