#include "app/command_support.h"

#include <unistd.h>

#include <csignal>

#include "base/progress.h"
#include "film/atomic_file.h"

namespace lampyr {

namespace {

// A signal handler has no argument to be handed this through.
std::atomic<bool> interruptRequested{false};

void OnInterrupt(int signal) {
  interruptRequested.store(true);
  std::signal(signal, SIG_DFL);
}

}  // namespace

void OutliveReaders() {
  std::signal(SIGPIPE, SIG_IGN);
}

const std::atomic<bool>& FinishOnInterrupt() {
  std::signal(SIGINT, OnInterrupt);
  std::signal(SIGTERM, OnInterrupt);
  return interruptRequested;
}

void CheckWritable(const std::filesystem::path& path, const std::string& option) {
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
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

LoadedScene LoadScene(const std::filesystem::path& scene, const std::vector<std::string>& plugins,
                      const RenderOverrides& overrides, bool strict, bool robust) {
  Diagnostics diagnostics(strict ? Diagnostics::Mode::Strict : Diagnostics::Mode::Print);
  try {
    const Progress clock(true);
    LoadedScene loaded;
    const SceneDescription description = ReadScene(scene, diagnostics);
    loaded.parseSeconds = clock.Seconds();
    loaded.hash = description.contentHash;
    loaded.types = LoadTypes(plugins, &description);
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
