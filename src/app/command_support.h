// What commands that render have in common.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

#include "app/plugins.h"
#include "app/scene_builder.h"

namespace lampyr {

// A reader of the messages who has gone away is no reason to end, and a file that may not grow is an error of writing.
void OutliveSurroundings();
// From now on SIGINT, SIGTERM (batch systems ask with it) and SIGHUP (a connection is lost) set the flag that is
// returned, once: a second SIGINT or SIGTERM ends the process. Until then, each of them ends it. A signal that the
// process was started to ignore (nohup) stays ignored.
const std::atomic<bool>& FinishOnInterrupt();
// Runs `finish`, what is left to do after rendering, and returns its exit code. Where work was given up (base/stop.h),
// ends the process with that code: threads still use what the caller is about to destroy.
int FinishRendering(const std::function<int()>& finish);
// Of a command that has been interrupted so.
int InterruptExitCode();

// A file that cannot be written is told before the work, not after it. Throws UsageError; `option` names the culprit.
void CheckWritable(const std::filesystem::path& path, const std::string& option);
// Makes the folder, before the work that would be lost if it could not be made. Throws UsageError.
void MakeFolder(const std::filesystem::path& folder, const std::string& option);
std::string Joined(const std::vector<std::string>& names, const char* separator);
// Whole or not at all.
void WriteText(const std::filesystem::path& path, const std::string& text);

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

// True if both paths exist and lead to the same file, through links too.
bool IsSameFile(const std::filesystem::path& a, const std::filesystem::path& b);

}  // namespace lampyr
