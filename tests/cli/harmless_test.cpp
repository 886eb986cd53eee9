// Situations that must do no harm: numbers that are not finite, lack of memory, outputs that are links or inputs, and
// messages that name another cause.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <filesystem>
#include <string>

#include "film/image.h"
#include "support/lampyr_process.h"
#include "support/temporary_folder.h"

namespace lampyr::test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;

class Harmless : public testing::Test {
 protected:
  void SetUp() override { Write("scene.pbrt", SceneWith(kWorld)); }

  void Write(const std::string& name, const std::string& bytes) { WriteBytes(folder_ / name, bytes); }
  std::string Read(const std::string& name) { return ReadBytes(folder_ / name); }
  Outcome Run(const std::string& arguments, const std::string& before = "") {
    return RunLampyr(folder_.Path(), arguments, before);
  }
  // The warning for a scene with this world, which is rendered nevertheless.
  std::string WarningOf(const std::string& world) {
    Write("odd.pbrt", SceneWith(world));
    const Outcome outcome = Run("render odd.pbrt -o odd.exr --quiet --spp 1");
    EXPECT_EQ(outcome.exitCode, 0) << outcome.output;
    return outcome.output;
  }
  std::string ErrorOf(const std::string& world) {
    Write("bad.pbrt", SceneWith(world));
    const Outcome outcome = Run("render bad.pbrt -o bad.exr --quiet --spp 1");
    EXPECT_EQ(outcome.exitCode, 2) << outcome.output;
    return outcome.output;
  }

  // The world begins at line 5.
  static std::string SceneWith(const std::string& world) {
    return R"(Film "rgb" "integer xresolution" 8 "integer yresolution" 8
Camera "perspective" "float fov" 40
Sampler "sobol" "integer pixelsamples" 2
WorldBegin
)" + world +
           "\n";
  }
  static constexpr const char* kWorld = "LightSource \"point\" Translate 0 0 4 Shape \"sphere\"";

  TemporaryFolder folder_;
};

TEST_F(Harmless, NumbersThatAreNoneAreRefusedOnTheCommandLine) {
  const std::string render = "render scene.pbrt -o no.exr --quiet --integrator sppm ";
  for (const std::string option : {"--alpha", "--radius", "--shadow-roulette", "--shadow-threshold", "--target-error",
                                   "--time", "--exposure", "--checkpoint", "--photon-memory", "--spp", "--max-depth",
                                   "--light-samples", "--photons", "--seed", "--threads"}) {
    for (const std::string value : {"nan", "NAN", "-nan", "inf", "-inf", "1e999", "x", "''"}) {
      const Outcome outcome = Run(render + option + "=" + value);
      // An empty text is as none for the options that are texts.
      if (value == "''" && outcome.exitCode == 0 && fs::remove(folder_ / "no.exr")) continue;
      EXPECT_EQ(outcome.exitCode, 2) << option << "=" << value << ": " << outcome.output;
      EXPECT_THAT(outcome.output, HasSubstr(option)) << option << "=" << value;
    }
  }
  for (const std::string option : {"--alpha 1.5", "--alpha -3", "--radius 1e300", "--radius 1e-42", "--radius -1",
                                   "--shadow-threshold 1e39", "--crop nan,1,0,1", "--exposure 1e39"}) {
    EXPECT_EQ(Run(render + option).exitCode, 2) << option;
  }
  EXPECT_THAT(Run(render + "--radius 1e-42").output, HasSubstr("too small"));
  EXPECT_FALSE(fs::exists(folder_ / "no.exr"));
  EXPECT_EQ(Run("compare scene.pbrt --integrators path:shadow-threshold=nan").exitCode, 2);
  EXPECT_EQ(Run("compare scene.pbrt --budget nan").exitCode, 2);
  EXPECT_EQ(Run("compare scene.pbrt --alpha nan").exitCode, 2);
}

TEST_F(Harmless, WhatIsTooSmallOrTooLargeIsSaidSo) {
  EXPECT_THAT(ErrorOf("Shape \"sphere\" \"float radius\" 1e-42"),
              HasSubstr("bad.pbrt:5:16: error: \"radius\" is too small: at least 1.2e-38"));
  EXPECT_THAT(ErrorOf("Shape \"disk\" \"float radius\" 1e-42"),
              HasSubstr("bad.pbrt:5:14: error: \"radius\" is too small"));
  EXPECT_THAT(ErrorOf("LightSource \"sphere\" \"float radius\" 1e-42"),
              HasSubstr("bad.pbrt:5:22: error: LightSource \"sphere\": parameter \"radius\" is too small"));
  const auto ies = [&](const std::string& multiplier, const std::string& ballast, const std::string& value) {
    Write("lamp.ies", "IESNA:LM-63-2002\nTILT=NONE\n1 -1 " + multiplier + " 3 1 1 2 0 0 0\n" + ballast +
                          " 1 1\n0 45 90\n0\n1 " + value + " 1\n");
    return ErrorOf("LightSource \"point\" \"string shaping:ies:file\" \"lamp.ies\"");
  };
  EXPECT_THAT(
      ies("10", "1", "1e38"),
      HasSubstr("lamp.ies:7:3: error: the candela value 1e+38, times the file's multipliers 10, is 1e+39: it has "
                "to be at most 1e30"));
  EXPECT_THAT(ies("1e38", "1", "1"), HasSubstr("the candela multiplier is 1e+38: it has to be between 0 and 1e30"));
  EXPECT_THAT(ies("1e28", "1e6", "1"), HasSubstr("ballast factors make 1e+34 together: it has to be at most 1e30"));
  Image bright(1, 1, {"R", "G", "B"});
  bright.data = {3e38f, 1, 1};
  WriteExr(folder_ / "bright.exr", bright, ExrPrecision::Float);
  EXPECT_THAT(WarningOf("LightSource \"infinite\" \"string filename\" \"bright.exr\" Shape \"sphere\""),
              HasSubstr("1 texels are negative, not a number, or 1e37 and more, and emit nothing"));
}

TEST_F(Harmless, WhatHasNoEffectIsSaid) {
  EXPECT_EQ(WarningOf(kWorld), "");
  const std::string shape = " Translate 0 0 4 Shape \"sphere\"";
  EXPECT_THAT(WarningOf("LightSource \"point\" \"float power\" -100" + shape),
              HasSubstr("odd.pbrt:5:21: warning: LightSource \"point\": \"power\" is -100, which is ignored"));
  EXPECT_THAT(WarningOf("AreaLightSource \"diffuse\" \"float power\" 0" + shape),
              HasSubstr("\"power\" is 0, which is"));
  EXPECT_THAT(WarningOf("LightSource \"distant\" \"float illuminance\" -2" + shape),
              HasSubstr("\"illuminance\" is -2"));
  EXPECT_EQ(WarningOf("LightSource \"point\" \"float power\" -1" + shape), "");
  EXPECT_THAT(WarningOf(kWorld + std::string(" \"float alpha\" -3")),
              HasSubstr("warning: \"alpha\" is an opacity from 0 to 1: what is below is taken as 0"));
  EXPECT_THAT(WarningOf(kWorld + std::string(" \"float alpha\" 3")), HasSubstr("what is above is taken as 1"));
  EXPECT_THAT(
      WarningOf("Texture \"t\" \"float\" \"constant\" \"float value\" -3 LightSource \"point\" Shape \"sphere\" "
                "\"texture alpha\" \"t\""),
      HasSubstr("what is below is taken as 0"));
  EXPECT_EQ(WarningOf(kWorld + std::string(" \"float alpha\" 0.5")), "");
  EXPECT_THAT(
      WarningOf("LightSource \"point\" AreaLightSource \"diffuse\" Shape \"trianglemesh\" \"point3 P\" [ 0 0 4 1 1 "
                "5 2 2 6 ]"),
      HasSubstr("odd.pbrt:5:47: warning: this shape has no area: it emits no light"));
  EXPECT_THAT(WarningOf("LightSource \"point\""), HasSubstr("warning: the scene has no shape"));
  EXPECT_EQ(WarningOf("LightSource \"infinite\""), "");
  Write("odd.pbrt",
        "Camera \"perspective\"\nFilm \"rgb\"\nCamera \"perspective\"\nFilm \"rgb\" \"integer xresolution\" 8 "
        "\"integer yresolution\" 8\nWorldBegin\n" +
            std::string(kWorld));
  const Outcome twice = Run("render odd.pbrt -o odd.exr --quiet --spp 1");
  EXPECT_THAT(twice.output, HasSubstr("odd.pbrt:3:1: warning: a second Camera: it replaces the one at odd.pbrt:1:1"));
  EXPECT_THAT(twice.output, HasSubstr("odd.pbrt:4:1: warning: a second Film: it replaces the one at odd.pbrt:2:1"));
  // A parameter of an integrator of pbrt-v4 that has no effect here.
  Write("own.pbrt",
        "Integrator \"bdpt\" \"bool visualizeweights\" true\nCamera \"perspective\"\nFilm \"rgb\" \"integer "
        "xresolution\" 8 \"integer yresolution\" 8\nWorldBegin\n" +
            std::string(kWorld));
  EXPECT_THAT(Run("render own.pbrt -o own.exr --quiet --spp 1").output,
              HasSubstr("own.pbrt:1:19: warning: \"visualizeweights\" of Integrator \"bdpt\" is not supported yet"));
}

TEST_F(Harmless, LinksStayLinks) {
  fs::create_directory(folder_ / "store");
  fs::create_symlink("store/kept.exr", folder_ / "out.exr");  // leads to nothing yet
  fs::create_symlink("out.exr", folder_ / "chain.exr");
  ASSERT_EQ(Run("render scene.pbrt -o out.exr --quiet --png").exitCode, 0);
  EXPECT_TRUE(fs::is_symlink(folder_ / "out.exr"));
  const std::string first = Read("store/kept.exr");
  EXPECT_FALSE(first.empty());
  EXPECT_TRUE(fs::is_regular_file(folder_ / "out.png"));
  ASSERT_EQ(Run("render scene.pbrt -o chain.exr --quiet --seed 2").exitCode, 0);
  EXPECT_TRUE(fs::is_symlink(folder_ / "out.exr") && fs::is_symlink(folder_ / "chain.exr"));
  EXPECT_NE(Read("store/kept.exr"), first);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_ / "store"), {}), 1) << "something was left behind";
  // The temporary file is beside the target, not beside the link: a rename must stay within a file system.
  fs::create_symlink("nowhere/kept.exr", folder_ / "broken.exr");
  const Outcome broken = Run("render scene.pbrt -o broken.exr --quiet");
  EXPECT_EQ(broken.exitCode, 2);
  EXPECT_THAT(broken.output, HasSubstr("error: --output: there is no folder"));
  fs::create_symlink("b.exr", folder_ / "a.exr");
  fs::create_symlink("a.exr", folder_ / "b.exr");
  const Outcome circle = Run("render scene.pbrt -o a.exr --quiet");
  EXPECT_EQ(circle.exitCode, 2);
  EXPECT_THAT(circle.output, HasSubstr("error: "));
  EXPECT_THAT(circle.output, HasSubstr("a.exr\": Too many levels of symbolic links"));
  // A device is not replaced by a file.
  ASSERT_EQ(mkfifo((folder_ / "pipe.json").c_str(), 0600), 0);
  const Outcome device = Run("render scene.pbrt -o out.exr --quiet --stats pipe.json");
  EXPECT_EQ(device.exitCode, 2);
  EXPECT_THAT(device.output, HasSubstr("pipe.json\": it is a device or a pipe, not a file"));
  EXPECT_TRUE(fs::is_fifo(folder_ / "pipe.json"));
}

TEST_F(Harmless, MergeKeepsItsParts) {
  for (const std::string part : {"1", "2"}) {
    ASSERT_EQ(Run("render scene.pbrt -o p" + part + ".exr --quiet --shard " + part + "/2").exitCode, 0);
  }
  const std::string first = Read("p1.exr"), second = Read("p2.exr");
  fs::create_symlink("p2.exr", folder_ / "link.exr");
  fs::create_hard_link(folder_ / "p2.exr", folder_ / "hard.exr");
  for (const std::string output : {"p1.exr", "./p2.exr", "link.exr", "hard.exr"}) {
    const Outcome outcome = Run("merge p1.exr p2.exr -o " + output);
    EXPECT_EQ(outcome.exitCode, 2) << output;
    EXPECT_THAT(outcome.output, HasSubstr("error: --output: \"" + output + "\" is one of the parts that are merged"));
  }
  fs::copy_file(folder_ / "p1.exr", folder_ / "whole.png");
  EXPECT_THAT(Run("merge whole.png p2.exr -o whole.exr --png").output,
              HasSubstr("error: --png: \"whole.png\" is one of"));
  EXPECT_EQ(Read("p1.exr"), first);
  EXPECT_EQ(Read("p2.exr"), second);
  EXPECT_EQ(Run("merge p1.exr p2.exr -o whole.exr --quiet").exitCode, 0);
}

// Textures, the scene's own text and what it includes.
TEST_F(Harmless, RenderKeepsWhatItsSceneReads) {
  Image sky(4, 4, {"R", "G", "B"});
  WriteExr(folder_ / "sky.exr", sky, ExrPrecision::Float);
  Write("lights.pbrt", "LightSource \"infinite\" \"string filename\" \"sky.exr\"\n");
  Write("reads.pbrt",
        "Film \"rgb\" \"integer xresolution\" 4 \"integer yresolution\" 4 \"string filename\" \"again.exr\"\n"
        "Camera \"perspective\"\nMakeNamedMedium \"ink\" \"string type\" \"homogeneous\" \"spectrum sigma_a\" "
        "\"ink.spd\"\nWorldBegin\nInclude \"lights.pbrt\"\nShape \"sphere\"\n");
  Write("ink.spd", "400 0.5\n700 0.5\n");
  fs::create_symlink("sky.exr", folder_ / "link.exr");
  const std::string before = Read("sky.exr"), text = Read("lights.pbrt");
  for (const auto& [options, file] : {std::pair("-o sky.exr", "--output: \"sky.exr\""),
                                      {"-o link.exr", "--output: \"link.exr\""},
                                      {"--stats lights.pbrt", "--stats: \"lights.pbrt\""},
                                      {"--stats ink.spd", "--stats: \"ink.spd\""},
                                      {"--stats reads.pbrt", "--stats: \"reads.pbrt\""}}) {
    const Outcome outcome = Run(std::string("render reads.pbrt --quiet --spp 1 ") + options);
    EXPECT_EQ(outcome.exitCode, 2) << options;
    EXPECT_THAT(outcome.output, HasSubstr(std::string("error: ") + file + " is a file that the scene reads"));
  }
  EXPECT_EQ(Read("sky.exr"), before);
  EXPECT_EQ(Read("lights.pbrt"), text);
  // A picture of its own is written over, and is no part of what the render is made of.
  EXPECT_EQ(Run("render reads.pbrt --quiet --spp 2 --checkpoint 1000").exitCode, 0);
  EXPECT_EQ(Run("render reads.pbrt --quiet --spp 4 --checkpoint 1000 --resume").exitCode, 0);
}

TEST_F(Harmless, BrokenPngsAreToldOnce) {
  Image image(4, 4, {"R", "G", "B"});
  WritePng(folder_ / "whole.png", image, 0, ToneMap::Clip);
  std::string bytes = Read("whole.png");
  bytes[bytes.size() - 16] ^= 1;  // in the data, or in its checksum
  Write("broken.png", bytes);
  const std::string error = ErrorOf("LightSource \"infinite\" \"string filename\" \"broken.png\"");
  EXPECT_TRUE(error.starts_with("bad.pbrt:5:24: error: cannot read image")) << error;
  EXPECT_EQ(std::count(error.begin(), error.end(), '\n'), 1) << error;
}

// Wherever the memory ends: in the parser, the builder, the library that reads images, the intersector or the threads.
TEST_F(Harmless, MemoryThatEndsIsAnError) {
  std::string points, indices;
  for (int i = 0; i < 60'000; ++i) {
    points += std::to_string(i % 300) + " " + std::to_string(i / 300) + " 9 ";
    if (i % 300 != 299 && i < 59'000)
      indices += std::to_string(i) + " " + std::to_string(i + 1) + " " + std::to_string(i + 300) + " ";
  }
  Image image(1200, 1200, {"R", "G", "B"});
  WriteExr(folder_ / "sky.exr", image, ExrPrecision::Half);
  WritePng(folder_ / "sky.png", image, 0, ToneMap::Clip);
  Write(
      "large.pbrt",
      SceneWith(
          "LightSource \"infinite\" \"string filename\" \"sky.exr\"\nTexture \"t\" \"spectrum\" \"imagemap\" \"string "
          "filename\" \"sky.png\"\nMaterial \"diffuse\" \"texture reflectance\" \"t\"\nShape \"trianglemesh\" "
          "\"point3 P\" [ " +
          points + "]\n\"integer indices\" [ " + indices + "]\n"));
  int refused = 0, rendered = 0;
  for (const int mebibytes : {40, 70, 100, 140, 170, 200, 210, 240, 280, 330, 400, 500, 700, 3000}) {
    const Outcome outcome = Run("render large.pbrt -o large.exr --quiet --threads 4 --resolution 400x300 --spp 1",
                                "ulimit -v " + std::to_string(mebibytes * 1024) + "; ");
    if (outcome.exitCode == 0) {
      ++rendered;
      continue;
    }
    ++refused;
    // The loader itself may have too little to start the program with.
    if (outcome.exitCode == 127) continue;
    EXPECT_TRUE(outcome.exitCode == 1 || outcome.exitCode == 2)
        << mebibytes << " MiB: " << outcome.exitCode << ": " << outcome.output;
    EXPECT_THAT(outcome.output, HasSubstr("error: ")) << mebibytes << " MiB";
    EXPECT_THAT(outcome.output, Not(HasSubstr("bad_alloc"))) << mebibytes << " MiB";
    EXPECT_THAT(outcome.output, Not(HasSubstr("terminate"))) << mebibytes << " MiB";
  }
  EXPECT_GT(refused, 3);
  EXPECT_GT(rendered, 0);
}

}  // namespace
}  // namespace lampyr::test
