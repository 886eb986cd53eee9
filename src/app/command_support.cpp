#include "app/command_support.h"

#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>

#include "app/command_line.h"
#include "base/memory.h"
#include "base/progress.h"
#include "base/stop.h"
#include "film/atomic_file.h"
#include "scene/referenced_files.h"

namespace lampyr {

namespace {

// A signal handler has no argument to be handed this through.
std::atomic<bool> interruptRequested{false};
std::atomic<int> interruptSignal{SIGINT};

constexpr int kInterrupts[] = {SIGINT, SIGTERM, SIGHUP};

// A second one ends the process, but for SIGHUP: of a connection that is lost, the system and the shell both send one.
void OnInterrupt(int signal) {
  interruptSignal.store(signal);
  interruptRequested.store(true);
  for (const int other : kInterrupts) std::signal(other, other == SIGHUP ? SIG_IGN : SIG_DFL);
}

bool IsIgnored(int signal) {
  struct sigaction action {};
  return sigaction(signal, nullptr, &action) == 0 && action.sa_handler == SIG_IGN;
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
  for (const int signal : kInterrupts) {
    if (!IsIgnored(signal)) std::signal(signal, OnInterrupt);
  }
  return interruptRequested;
}

int FinishRendering(const std::function<int()>& finish) {
  if (!HasGivenUpWork()) return finish();
  int exitCode = kExitFailed;
  try {
    exitCode = finish();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
  }
  std::fflush(stdout);
  std::_Exit(exitCode);
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

bool IsSameFile(const std::filesystem::path& a, const std::filesystem::path& b) {
  std::error_code ignored;
  return std::filesystem::equivalent(a, b, ignored);
}

}  // namespace lampyr
