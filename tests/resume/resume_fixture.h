// A folder with a scene that has something of everything a render's state is made of.
#pragma once

#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "support/lampyr_process.h"
#include "support/temporary_folder.h"

namespace lampyr::test {

class Resume : public testing::Test {
 protected:
  // Light groups, a filter with negative lobes, lights behind a wall, glass.
  static constexpr const char* kScene = R"(Film "rgb" "integer xresolution" 48 "integer yresolution" 32
PixelFilter "mitchell"
LookAt 0 1.2 3  0 0.4 0  0 1 0
Camera "perspective" "float fov" 40
Sampler "sobol" "integer pixelsamples" 16
Integrator "path"
WorldBegin
LightSource "point" "rgb I" [4 4 4] "point3 from" [0 2 1] "string lightGroup" "key"
LightSource "point" "rgb I" [1 4 2] "point3 from" [-2 2 -1]
LightSource "infinite" "rgb L" [0.1 0.1 0.2]
AttributeBegin
  AreaLightSource "diffuse" "rgb L" [9 8 7] "string lightGroup" "lamp"
  Shape "trianglemesh" "point3 P" [1 0.1 -1 1.4 0.1 -1 1.2 0.5 -1] "integer indices" [0 1 2]
AttributeEnd
Material "diffuse" "rgb reflectance" [0.5 0.4 0.3]
Shape "plymesh" "string filename" "floor.ply"
Shape "trianglemesh" "point3 P" [-1 0 -0.5 -1 2 -0.5 0 0 -0.5] "integer indices" [0 1 2]
Material "dielectric" "float eta" 1.5
AttributeBegin Translate 0.3 0.4 0.4 Shape "sphere" "float radius" 0.3 AttributeEnd
)";
  static std::string Floor(float side) {
    const std::string s = std::to_string(side);
    return "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
           "element face 1\nproperty list uchar int vertex_indices\nend_header\n-" +
           s + " 0 -" + s + "\n-" + s + " 0 " + s + "\n" + s + " 0 " + s + "\n" + s + " 0 -" + s + "\n4 0 1 2 3\n";
  }

  Resume() {
    WriteBytes(folder_ / "scene.pbrt", kScene);
    WriteBytes(folder_ / "floor.ply", Floor(5));
  }

  std::string Bytes(const std::string& name) const { return ReadBytes(folder_ / name); }
  bool Exists(const std::string& name) const { return std::filesystem::exists(folder_ / name); }
  Outcome Run(const std::string& arguments) const { return RunLampyr(folder_.Path(), arguments); }
  // Fails the test where the command fails.
  void Do(const std::string& arguments) const {
    const Outcome outcome = Run(arguments);
    ASSERT_EQ(outcome.exitCode, 0) << arguments << "\n" << outcome.output;
  }
  void ExpectRefused(const std::string& arguments, int exitCode, const std::string& why) const {
    const Outcome outcome = Run(arguments);
    EXPECT_EQ(outcome.exitCode, exitCode) << arguments << "\n" << outcome.output;
    EXPECT_NE(outcome.output.find(why), std::string::npos) << arguments << "\n" << outcome.output;
  }

  TemporaryFolder folder_;
};

}  // namespace lampyr::test
