#include "app/command_support.h"

#include <unistd.h>

#include <csignal>

#include "app/command_line.h"
#include "base/memory.h"
#include "base/progress.h"
#include "film/atomic_file.h"
#include "scene/referenced_files.h"

namespace lampyr {

namespace {

// A signal handler has no argument to be handed this through.
std::atomic<bool> interruptRequested{false};
std::atomic<int> interruptSignal{SIGINT};

void OnInterrupt(int signal) {
  interruptSignal.store(signal);
  interruptRequested.store(true);
  std::signal(signal, SIG_DFL);
}

}  // namespace

void ReportMemoryFailure() {
  constexpr double bytesPerMebibyte = 1 << 20;
  std::fprintf(stderr,
               "error: there is not enough memory: all of the %.0f MiB that lampyr may use are taken; give it more "
               "(ulimit -v, the container, the batch job), or render in parts with --crop\n",
               static_cast<double>(AvailableMemory()) / bytesPerMebibyte);
}

void OutliveSurroundings() {
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
}

const std::atomic<bool>& FinishOnInterrupt() {
  std::signal(SIGINT, OnInterrupt);
  std::signal(SIGTERM, OnInterrupt);
  return interruptRequested;
}

int InterruptExitCode() {
  return kExitSignalled + interruptSignal.load();
}

std::string Joined(const std::vector<std::string>& names, const char* separator) {
  std::string all;
  for (const std::string& name : names) all += (all.empty() ? "" : separator) + name;
  return all;
}

void CheckWritable(const std::filesystem::path& path, const std::string& option) {
  std::filesystem::path folder;
  try {
    folder = FolderOf(WriteTarget(path));
  } catch (const Error& error) {
    throw UsageError(option + ": " + error.Text());
  }
  std::error_code ignored;
  if (!std::filesystem::is_directory(folder, ignored)) {
    throw UsageError(option + ": there is no folder \"" + folder.string() + "\"");
  }
  if (access(folder.c_str(), W_OK) != 0) {
    throw UsageError(option + ": the folder \"" + folder.string() + "\" is not writable");
  }
  if (std::filesystem::is_directory(path, ignored)) {
    throw UsageError(option + ": \"" + path.string() + "\" is a folder");
  }
  // The permissions do not tell everything.
  try {
    const AtomicFile probe(path);
  } catch (const Error& error) {
    throw UsageError(option + ": " + error.Text());
  }
}

void MakeFolder(const std::filesystem::path& folder, const std::string& option) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error || !std::filesystem::is_directory(folder))
    throw UsageError(option + ": cannot make the folder \"" + folder.string() + "\"");
}

void WriteText(const std::filesystem::path& path, const std::string& text) {
  AtomicFile file(path);
  file.Write(text.data(), text.size());
  file.Commit();
}

LoadedScene LoadScene(const std::filesystem::path& scene, const PluginOptions& plugins,
                      const RenderOverrides& overrides, bool strict, bool robust, bool namesFiles) {
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
    return loaded;
  } catch (const UsageError&) {
    throw;
  } catch (const Error& error) {
    throw UsageError(error.Where(), error.Text());
  }
}

}  // namespace lampyr
