// The plugins that were built outside of the tree, and the command that loads them.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "support/lampyr_process.h"
#include "support/temporary_folder.h"

namespace lampyr::test {

inline std::filesystem::path RingPlugin() {
  return LAMPYR_PLUGINS "/example/ring.so";
}
inline std::filesystem::path FaultyPlugin(const std::string& name) {
  return LAMPYR_PLUGINS "/faulty/" + name + ".so";
}

class Plugins : public testing::Test {
 protected:
  // Runs lampyr in the test's folder, with LAMPYR_PLUGIN_PATH set to `path`.
  Outcome Run(const std::string& arguments, const std::string& path = "") {
    return RunLampyr(folder_.Path(), arguments, "LAMPYR_PLUGIN_PATH='" + path + "'");
  }

  // Expects the command to end with `exitCode`, and its output to contain each of `texts`.
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
