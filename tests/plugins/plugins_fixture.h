// The plugins that were built outside of the tree, and the command that loads them.
#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdio>
#include <filesystem>
#include <string>

#include "support/temporary_folder.h"

namespace lampyr::test {

inline std::filesystem::path RingPlugin() {
  return LAMPYR_PLUGINS "/example/ring.so";
}
inline std::filesystem::path FaultyPlugin(const std::string& name) {
  return LAMPYR_PLUGINS "/faulty/" + name + ".so";
}

struct Outcome {
  int exitCode = -1;   // 128 and the signal where one has ended it, as the shell says it
  std::string output;  // standard output and error together
};

class Plugins : public testing::Test {
 protected:
  // Runs lampyr in the test's folder, with LAMPYR_PLUGIN_PATH set to `path`.
  Outcome Run(const std::string& arguments, const std::string& path = "") {
    Outcome outcome;
    const std::string command = "cd '" + folder_.Path().string() + "' && LAMPYR_PLUGIN_PATH='" + path +
                                "' '" LAMPYR_BINARY "' " + arguments + " 2>&1";
    FILE* pipe = popen(command.c_str(), "r");
    char buffer[4096];
    for (size_t n; (n = fread(buffer, 1, sizeof buffer, pipe)) > 0;) outcome.output.append(buffer, n);
    const int status = pclose(pipe);
    outcome.exitCode = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    return outcome;
  }

  // That the command ends with `exitCode`, and says each of `texts`.
  void ExpectSays(const Outcome& outcome, int exitCode, const std::vector<std::string>& texts) {
    EXPECT_EQ(outcome.exitCode, exitCode) << outcome.output;
    for (const std::string& text : texts) {
      EXPECT_NE(outcome.output.find(text), std::string::npos) << "\"" << text << "\" is not in: " << outcome.output;
    }
  }

  void Write(const std::string& name, const std::string& bytes) { WriteBytes(folder_ / name, bytes); }
  std::string Read(const std::string& name) { return ReadBytes(folder_ / name); }
  bool Exists(const std::string& name) { return std::filesystem::exists(folder_ / name); }

  // A ground under a light that shines down; `options` come before the world.
  static std::string SceneWith(const std::string& light, const std::string& options = "") {
    return R"(Film "rgb" "integer xresolution" 32 "integer yresolution" 20
LookAt 0 1 3  0 0 0  0 1 0
Camera "perspective" "float fov" 40
Sampler "sobol" "integer pixelsamples" 4
)" + options +
           R"(
WorldBegin
AttributeBegin
Translate 0 2 0 Rotate -90 1 0 0
)" + light +
           R"(
AttributeEnd
Shape "trianglemesh" "point3 P" [-5 0 -5 -5 0 5 5 0 5 5 0 -5] "integer indices" [0 1 2 0 2 3]
)";
  }
  static constexpr const char* kRing = "LightSource \"ring\" \"float intensity\" 4";

  TemporaryFolder folder_;
};

}  // namespace lampyr::test
