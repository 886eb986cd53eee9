// Plugins as a user meets them: found by option, by environment and by scene; listed, checked and rendered.
#include "film/image.h"
#include "plugins/plugins_fixture.h"

namespace lampyr::test {
namespace {

namespace fs = std::filesystem;

std::string Option(const fs::path& plugin) {
  return " --plugin '" + plugin.string() + "'";
}

double MeanOf(const fs::path& file) {
  const Image image = ReadImage(file);
  double sum = 0;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) sum += static_cast<double>(image.At(x, y, 1));
  }
  return sum / (image.width * image.height);
}

TEST_F(Plugins, AreFoundByOptionSceneAndEnvironment) {
  fs::create_directory(folder_ / "lib");
  fs::create_directory(folder_ / "beside");
  fs::copy_file(RingPlugin(), folder_ / "lib/ring.so");
  fs::copy_file(RingPlugin(), folder_ / "beside/ring.so");
  Write("plain.pbrt", SceneWith(kRing));
  const Outcome without = Run("render plain.pbrt -o none.exr --quiet");
  ExpectSays(without, 2, {"plain.pbrt:9:1: error: there is no LightSource \"ring\"; if a plugin has it: --plugin FILE"});
  ExpectSays(Run("render plain.pbrt -o a.exr --quiet --plugin lib/ring.so"), 0, {});
  EXPECT_GT(MeanOf(folder_ / "a.exr"), 0.01);
  ExpectSays(Run("render plain.pbrt -o b.exr --quiet", "/nowhere-at-all:lib"), 0,
             {"warning", "LAMPYR_PLUGIN_PATH", "/nowhere-at-all"});
  // A bare name that is not in the working folder is looked for.
  ExpectSays(Run("render plain.pbrt -o c.exr --quiet --plugin ring.so", "lib"), 0, {});
  EXPECT_EQ(Read("a.exr"), Read("b.exr"));
  EXPECT_EQ(Read("a.exr"), Read("c.exr"));
  const double mean = MeanOf(folder_ / "a.exr");

  Write("beside/scene.pbrt", SceneWith(kRing, "Option \"string plugins\" [ \"ring.so\" ]"));
  ExpectSays(Run("render beside/scene.pbrt -o d.exr --quiet --strict --allow-scene-plugins"), 0, {});
  EXPECT_EQ(MeanOf(folder_ / "d.exr"), mean);
  Write("named.pbrt", SceneWith(kRing, "Option \"plugins\" \"ring.so\""));
  ExpectSays(Run("render named.pbrt -o e.exr --quiet", "lib"), 0, {});
  EXPECT_EQ(MeanOf(folder_ / "e.exr"), mean);
  ExpectSays(Run("render named.pbrt -o f.exr --quiet --allow-scene-plugins"), 2,
             {"named.pbrt:5:18: error: the plugin \"ring.so\": expected a shared library, found no such file"});
  Write("number.pbrt", SceneWith(kRing, "Option \"plugins\" [ \"ring.so\" 3 ]"));
  ExpectSays(Run("render number.pbrt -o f.exr --quiet"), 2, {"number.pbrt:5:30", "names of files"});
  EXPECT_FALSE(Exists("none.exr") || Exists("f.exr"));
}

// A scene comes from anywhere: that it names a plugin is no reason to run its code.
TEST_F(Plugins, OfScenesAreLoadedOnlyWhereTheyAreTrusted) {
  fs::create_directory(folder_ / "trusted");
  fs::create_directory(folder_ / "scenes");
  fs::copy_file(RingPlugin(), folder_ / "scenes/ring.so");
  Write("scenes/scene.pbrt", SceneWith(kRing, "Option \"string plugins\" [ \"ring.so\" ]"));
  const std::string small = " --resolution 8x8 ";
  const std::vector<std::string> refused = {"scenes/scene.pbrt:5:27: error: the scene names the plugin \"ring.so\"",
                                            "--plugin '", "scenes/ring.so'", "--allow-scene-plugins",
                                            "LAMPYR_PLUGIN_PATH"};
  const std::string compare =
      "compare scenes/scene.pbrt -o out --quiet --integrators path --spp 1 --repeat 2 "
      "--reference-time 0.2s --resolution 8x8 ";
  for (const std::string& command : {"render scenes/scene.pbrt --quiet" + small, std::string("plan scenes/scene.pbrt "),
                                     compare, std::string("check-lights scenes/scene.pbrt --threads 2 ")}) {
    ExpectSays(Run(command), 2, refused);
    // Neither is one that lies above a trusted folder, or is reached by way of it.
    ExpectSays(Run(command, "trusted"), 2, refused);
    ExpectSays(Run(command + "--allow-scene-plugins"), 0, {});
  }
  ExpectSays(Run("render scenes/scene.pbrt --quiet --plugin scenes/ring.so" + small), 0, {});
  ExpectSays(Run("render scenes/scene.pbrt --quiet" + small, "scenes"), 0, {});
  Write("scenes/around.pbrt", SceneWith(kRing, "Option \"plugins\" \"../trusted/../scenes/ring.so\""));
  ExpectSays(Run("render scenes/around.pbrt --quiet" + small, "trusted"), 2, {"around.pbrt:5:18: error"});
  // A link in the scene's folder to what is trusted, and one in the trusted folder to what its owner has put there.
  fs::rename(folder_ / "scenes/ring.so", folder_ / "trusted/ring.so");
  fs::create_symlink("../trusted/ring.so", folder_ / "scenes/ring.so");
  ExpectSays(Run("render scenes/scene.pbrt --quiet" + small, "trusted"), 0, {});
  fs::remove(folder_ / "scenes/ring.so");
  fs::rename(folder_ / "trusted/ring.so", folder_ / "elsewhere.so");
  fs::create_symlink("../elsewhere.so", folder_ / "trusted/ring.so");
  ExpectSays(Run("render scenes/scene.pbrt --quiet" + small, "trusted"), 0, {});
  EXPECT_EQ(Run("lights --help").output.find("--allow-scene-plugins"), std::string::npos);
  EXPECT_NE(Run("plan --help").output.find("--allow-scene-plugins"), std::string::npos);
}

// A filter of a plugin on a light of the plugin, and on one of lampyr's own.
TEST_F(Plugins, BringFilters) {
  for (const std::string& light : {std::string(kRing), std::string("LightSource \"disk\" \"float intensity\" 4")}) {
    Write("bare.pbrt", SceneWith(light));
    Write("open.pbrt", SceneWith("LightFilter \"iris\" \"float angle\" 180 \"float softness\" 0 " + light));
    Write("narrow.pbrt", SceneWith("LightFilter \"iris\" \"float angle\" 30 " + light));
    for (const std::string name : {"bare", "open", "narrow"}) {
      ExpectSays(
          Run("render " + name + ".pbrt --strict --max-depth 1 --quiet -o " + name + ".exr" + Option(RingPlugin())), 0,
          {});
    }
    EXPECT_EQ(MeanOf(folder_ / "open.exr"), MeanOf(folder_ / "bare.exr"));
    EXPECT_LT(MeanOf(folder_ / "narrow.exr"), 0.8 * MeanOf(folder_ / "bare.exr"));
    EXPECT_GT(MeanOf(folder_ / "narrow.exr"), 0);
  }
  ExpectSays(Run("render narrow.pbrt"), 2, {"narrow.pbrt:9:1: error: there is no LightFilter \"iris\""});
}

TEST_F(Plugins, AreTheSameFileWhoeverNamesIt) {
  Write("scene.pbrt", SceneWith(kRing, "Option \"plugins\" [ \"" + RingPlugin().string() + "\" ]"));
  fs::create_symlink(RingPlugin(), folder_ / "link.so");
  const Outcome outcome = Run("render scene.pbrt -o a.exr --quiet --plugin link.so" + Option(RingPlugin()),
                              RingPlugin().parent_path().string());
  ExpectSays(outcome, 0, {});
  EXPECT_EQ(outcome.output, "");
}

TEST_F(Plugins, AreKnownToEveryCommandThatReadsScenes) {
  Write("scene.pbrt", SceneWith(kRing));
  ExpectSays(Run("plan scene.pbrt" + Option(RingPlugin())), 0, {"integrator"});
  ExpectSays(Run("plan scene.pbrt"), 2, {"there is no LightSource \"ring\""});
  ExpectSays(Run("compare scene.pbrt -o out --quiet --integrators path --spp 1 --repeat 2 --reference-time 0.2s "
                 "--resolution 8x8" +
                 Option(RingPlugin())),
             0, {});
  ExpectSays(Run("compare scene.pbrt -o out --quiet --integrators path --spp 1"), 2,
             {"there is no LightSource \"ring\""});
  ExpectSays(Run("check-lights scene.pbrt --threads 2" + Option(RingPlugin())), 0,
             {"ok     ring (scene.pbrt:9:1)", "0 of"});
}

TEST_F(Plugins, AreListed) {
  const Outcome all = Run("lights" + Option(RingPlugin()));
  ExpectSays(all, 0,
             {"LightSource \"rect\"", "LightSource \"ring\"", "LightFilter \"iris\"", "innerRadius",
              "from the plugin \"" + RingPlugin().string() + "\""});
  const Outcome one = Run("lights iris" + Option(RingPlugin()));
  ExpectSays(one, 0, {"LightFilter \"iris\"", "softness"});
  EXPECT_EQ(one.output.find("ring\n"), std::string::npos);
  ExpectSays(Run("lights rinng" + Option(RingPlugin())), 2, {"did you mean \"ring\""});
  EXPECT_EQ(Run("lights").output.find("ring.so"), std::string::npos);
}

TEST_F(Plugins, HaveTheirParametersChecked) {
  Write("typo.pbrt", SceneWith("LightSource \"ring\" \"float outerRadios\" 1"));
  ExpectSays(Run("render typo.pbrt" + Option(RingPlugin())), 2, {"typo.pbrt:9", "did you mean \"outerRadius\""});
  Write("order.pbrt", SceneWith("LightSource \"ring\" \"float innerRadius\" 1"));
  ExpectSays(Run("render order.pbrt" + Option(RingPlugin())), 2, {"order.pbrt:9", "innerRadius must be less"});
}

// The whole of both suites, on the plugin's types and no others.
TEST_F(Plugins, PassTheSuite) {
  const Outcome outcome = Run("check-lights --threads 2" + Option(RingPlugin()));
  ExpectSays(outcome, 0,
             {"ok     ring[0]", "ok     ring[3]", "emission-edge", "edit", "strata", "parameters",
              "ok     filter iris[0]", "ok     filter iris[1]", "light-pdf", ", 0 of "});
  EXPECT_EQ(outcome.output.find("FAILED"), std::string::npos);
  EXPECT_EQ(outcome.output.find("rect["), std::string::npos);
  EXPECT_EQ(outcome.output.find("sphere["), std::string::npos);
  EXPECT_EQ(outcome.output.find("barn["), std::string::npos);
  const Outcome iris = Run("check-lights --type iris --threads 2" + Option(RingPlugin()));
  ExpectSays(iris, 0, {"ok     filter iris[1]", ", 0 of 34 properties failed"});
  EXPECT_EQ(iris.output.find("ring["), std::string::npos);
  ExpectSays(Run("check-lights --type irsi" + Option(RingPlugin())), 2,
             {"there is no light or filter \"irsi\" (did you mean \"iris\"?)"});
}

// A wrong filter is told by its property, what that means, and its worst case.
TEST_F(Plugins, AreToldByNameWhereAFilterIsNotTheSameTwice) {
  const Outcome outcome = Run("check-lights --threads 2" + Option(FaultyPlugin("wrong_iris")));
  ExpectSays(outcome, 1,
             {"FAILED filter wrong_iris[0]", "repeat: asked again, a filter gives the same bits",
              "asked for the second time, edge", "right is ("});
}

// A type that nothing can be said of does not pass.
TEST_F(Plugins, AreNotCheckedWithoutSamples) {
  ExpectSays(Run("check-lights --type filter-throws" + Option(FaultyPlugin("behaviour"))), 2,
             {"the filter \"filter-throws\" has no sample blocks to check it by"});
}

// The properties that fail.
std::string FailedOf(const std::string& output) {
  std::string failed;
  for (size_t at = 0; (at = output.find("FAILED", at)) != std::string::npos; ++at) {
    const size_t name = output.find("]", at) + 1;
    const size_t begin = output.find_first_not_of(' ', name);
    failed += output.substr(begin, output.find(' ', begin) - begin) + " ";
  }
  return failed;
}

TEST_F(Plugins, AreToldByNameWhereThePhotonsDensityIsOff) {
  const Outcome outcome = Run("check-lights --threads 2" + Option(FaultyPlugin("wrong_photons")));
  ExpectSays(outcome, 1, {"FAILED wrong_photons[0]"});
  EXPECT_EQ(FailedOf(outcome.output), "emission-edge power ");
}

TEST_F(Plugins, AreToldByNameWhereSamplesForgetTheTexture) {
  const Outcome outcome = Run("check-lights --threads 2" + Option(FaultyPlugin("wrong_direct")));
  ExpectSays(outcome, 1, {"FAILED wrong_direct[0]"});
  EXPECT_EQ(FailedOf(outcome.output), "irradiance consistency surface power ");
}

}  // namespace
}  // namespace lampyr::test
