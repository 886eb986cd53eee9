// The decisions of `auto` in the user interface: the layers of --auto-layers, --stats, `plan`, hints, and `compare`.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <string>

#include "film/image.h"
#include "support/lampyr_process.h"
#include "support/temporary_folder.h"

namespace lampyr::test {
namespace {

using testing::HasSubstr;
using testing::Not;

// At the right a ball of glass, whose caustic is seen through it; at the left a wall. `head`: before the world.
std::string SceneWith(const std::string& head) {
  return head + R"(
Film "rgb" "integer xresolution" 64 "integer yresolution" 32
LookAt 0 1 3.2  0 0.5 0  0 1 0
Camera "perspective" "float fov" 40
WorldBegin
AttributeBegin AreaLightSource "diffuse" "rgb L" [ 60 60 60 ]
Translate -0.9 2 0 Shape "sphere" "float radius" 0.1 AttributeEnd
AttributeBegin Material "dielectric" "float eta" 1.5
Translate -0.9 0.7 0 Shape "sphere" "float radius" 0.4 AttributeEnd
Material "diffuse" "rgb reflectance" [ 0.5 0.5 0.5 ]
Shape "bilinearmesh" "point3 P" [ -3 0 -3  3 0 -3  -3 0 3  3 0 3 ]
Shape "bilinearmesh" "point3 P" [ 0 0 -1  3 0 -1  0 3 -1  3 3 -1 ]
)";
}

// The number after `"key": `, from `begin` on; NaN if there is none.
double NumberAfter(const std::string& json, const std::string& key, size_t begin = 0) {
  const std::string quoted = "\"" + key + "\": ";
  const size_t found = json.find(quoted, begin);
  return found == std::string::npos ? std::nan("") : std::strtod(json.c_str() + found + quoted.size(), nullptr);
}

class Auto : public testing::Test {
 protected:
  void SetUp() override { WriteBytes(folder_ / "scene.pbrt", SceneWith("")); }

  Outcome Run(const std::string& arguments) { return RunLampyr(folder_.Path(), arguments); }
  Outcome Succeed(const std::string& arguments) {
    Outcome outcome = Run(arguments);
    EXPECT_EQ(outcome.exitCode, 0) << arguments << ": " << outcome.output;
    return outcome;
  }
  std::string Read(const std::string& name) { return ReadBytes(folder_ / name); }

  TemporaryFolder folder_;
};

constexpr const char* kLayers[] = {"auto.lightPaths", "auto.connecting", "auto.merging", "auto.continuing"};

// Caustics seen in a mirror: merging finds the light, and starts wide. The radius follows from the pass alone, not from
// the threads or the part of the render.
TEST_F(Auto, AWideStartIsTheSameForAllThreadsAndResumed) {
  const std::string scene = "'" LAMPYR_SOURCE_DIR "/scenes/mirror.pbrt' --integrator auto --resolution 64x36";
  EXPECT_THAT(Succeed("plan " + scene).output, HasSubstr("wide discs"));
  Succeed("render " + scene + " --spp 6 --threads 1 --quiet -o one.exr");
  Succeed("render " + scene + " --spp 6 --threads 3 --quiet -o three.exr");
  Succeed("render " + scene + " --spp 2 --threads 2 --resume --quiet -o parts.exr");
  Succeed("render " + scene + " --spp 6 --threads 1 --resume --quiet -o parts.exr");
  const Image one = ReadImage(folder_ / "one.exr");
  EXPECT_EQ(one.data, ReadImage(folder_ / "three.exr").data);
  EXPECT_EQ(one.data, ReadImage(folder_ / "parts.exr").data);
}

// A closed room with a point light, a mirror and glass: photons find nearly all of its light.
constexpr const char* kRoom = R"(Film "rgb" "integer xresolution" 48 "integer yresolution" 48
LookAt 0 0 -3.4  0 -0.2 0  0 1 0
Camera "perspective" "float fov" 34
Integrator "auto" "integer maxdepth" 12
WorldBegin
Material "diffuse" "rgb reflectance" [ 0.8 0.8 0.8 ]
Shape "bilinearmesh" "point3 P" [ -1 -1 -1  1 -1 -1  -1 -1 1  1 -1 1 ]
Shape "bilinearmesh" "point3 P" [ -1 1 -1  1 1 -1  -1 1 1  1 1 1 ]
Shape "bilinearmesh" "point3 P" [ -1 -1 1  1 -1 1  -1 1 1  1 1 1 ]
Shape "bilinearmesh" "point3 P" [ -1 -1 -1  -1 -1 1  -1 1 -1  -1 1 1 ]
Shape "bilinearmesh" "point3 P" [ 1 -1 -1  1 -1 1  1 1 -1  1 1 1 ]
LightSource "point" "rgb I" [ 1 1 1 ] "point3 from" [ 0.3 0.7 -0.3 ]
AttributeBegin Material "conductor" "float roughness" 0
Translate -0.4 -0.45 0.3 Shape "sphere" "float radius" 0.5 AttributeEnd
AttributeBegin Material "dielectric" Translate 0.5 -0.6 -0.3 Shape "sphere" "float radius" 0.4 AttributeEnd
)";

TEST_F(Auto, MayBeSppm) {
  WriteBytes(folder_ / "room.pbrt", kRoom);
  EXPECT_THAT(Succeed("plan room.pbrt").output, HasSubstr("integrator       sppm"));
  EXPECT_THAT(Succeed("plan room.pbrt --no-merge").output, Not(HasSubstr("sppm")));
  Succeed("render room.pbrt --spp 4 --quiet --auto-layers --stats stats.json -o auto.exr");
  Succeed("render room.pbrt --spp 2 --resume --quiet --threads 1 -o parts.exr");
  Succeed("render room.pbrt --spp 4 --resume --quiet -o parts.exr");
  Succeed("render room.pbrt --spp 4 --integrator sppm --quiet -o named.exr");
  const Image image = ReadImage(folder_ / "auto.exr"), named = ReadImage(folder_ / "named.exr");
  EXPECT_EQ(named.data, ReadImage(folder_ / "parts.exr").data);
  EXPECT_EQ(ChannelsOf(image, {"R", "G", "B"}).data, ChannelsOf(named, {"R", "G", "B"}).data);
  EXPECT_THAT(Read("stats.json"), HasSubstr("\"integrator\": \"sppm\""));
  const float expected[] = {1, 0, 1, 1};
  for (size_t layer = 0; layer < 4; ++layer) {
    const int channel = image.ChannelIndex(kLayers[layer]);
    ASSERT_GE(channel, 0) << kLayers[layer];
    EXPECT_EQ(image.At(20, 20, static_cast<size_t>(channel)), expected[layer]) << kLayers[layer];
  }
}

TEST_F(Auto, LayersHaveTheDecidedValues) {
  Succeed("render scene.pbrt --integrator auto --spp 1 --quiet --auto-layers --stats stats.json -o layers.exr");
  const Image image = ReadImage(folder_ / "layers.exr");
  const std::string stats = Read("stats.json");
  const size_t decided = stats.find("\"auto\": ");
  ASSERT_NE(decided, std::string::npos) << stats;
  const double expected[] = {NumberAfter(stats, "lightPaths", decided), NumberAfter(stats, "connecting", decided),
                             NumberAfter(stats, "merging", decided), NumberAfter(stats, "continuing", decided)};
  // The test is of parts that differ.
  ASSERT_GT(expected[2], 0.05);
  ASSERT_LT(expected[2], 0.95);
  for (size_t layer = 0; layer < 4; ++layer) {
    const int channel = image.ChannelIndex(kLayers[layer]);
    ASSERT_GE(channel, 0) << kLayers[layer];
    double mean = 0, least = 1e9, most = -1e9;
    for (int y = 0; y < image.height; ++y) {
      for (int x = 0; x < image.width; ++x) {
        const auto value = static_cast<double>(image.At(x, y, static_cast<size_t>(channel)));
        mean += value / (image.width * image.height);
        least = std::min(least, value);
        most = std::max(most, value);
      }
    }
    EXPECT_NEAR(mean, expected[layer], 1e-3) << kLayers[layer];
    if (layer < 2) {
      EXPECT_EQ(least, most) << kLayers[layer];
    } else if (layer == 2) {
      EXPECT_EQ(least, 0);
      EXPECT_EQ(most, 1);
    } else {
      EXPECT_GE(least, 0.25 - 1e-6);
      EXPECT_LE(most, 1);
    }
  }
  // Merging pays where the caustic is, in the right half, more than at the wall.
  const auto merging = static_cast<size_t>(image.ChannelIndex("auto.merging"));
  double right = 0;
  for (int y = 0; y < image.height; ++y) {
    for (int x = image.width / 2; x < image.width; ++x) right += static_cast<double>(image.At(x, y, merging));
  }
  EXPECT_GT(right / (image.width * image.height), 0.6 * expected[2]);

  // A crop has the layers of its part of the whole.
  Succeed("render scene.pbrt --integrator auto --spp 1 --quiet --auto-layers --crop 10,30,4,20 -o crop.exr");
  const Image crop = ReadImage(folder_ / "crop.exr");
  ASSERT_EQ(crop.width, 20);
  ASSERT_EQ(crop.height, 16);
  const auto ofCrop = static_cast<size_t>(crop.ChannelIndex("auto.merging"));
  for (int y = 0; y < crop.height; ++y) {
    for (int x = 0; x < crop.width; ++x)
      ASSERT_EQ(crop.At(x, y, ofCrop), image.At(x + 10, y + 4, merging)) << x << " " << y;
  }
}

TEST_F(Auto, LayersAreThereOnlyIfWanted) {
  const std::string render = "render scene.pbrt --integrator auto --spp 1 --quiet ";
  Succeed(render + "-o plain.exr");
  Succeed(render + "--auto-layers -o layers.exr");
  const Image plain = ReadImage(folder_ / "plain.exr"), layers = ReadImage(folder_ / "layers.exr");
  for (const char* layer : kLayers) {
    EXPECT_LT(plain.ChannelIndex(layer), 0) << layer;
    EXPECT_GE(layers.ChannelIndex(layer), 0) << layer;
  }
  // The picture is the same with them.
  for (const char* name : {"R", "G", "B", "variance.G"}) {
    const auto a = static_cast<size_t>(plain.ChannelIndex(name)), b = static_cast<size_t>(layers.ChannelIndex(name));
    for (int y = 0; y < plain.height; ++y) {
      for (int x = 0; x < plain.width; ++x) ASSERT_EQ(plain.At(x, y, a), layers.At(x, y, b)) << name;
    }
  }
  const Outcome named = Run("render scene.pbrt --integrator vcm --spp 1 --quiet --auto-layers -o named.exr");
  EXPECT_EQ(named.exitCode, 2);
  EXPECT_THAT(named.output, HasSubstr("--auto-layers: the integrator is named, vcm: auto decides nothing"));
}

// An integrator without light paths has none in the layers, and its camera paths always continue.
TEST_F(Auto, LayersOfPathTracing) {
  WriteBytes(folder_ / "sky.pbrt",
             "Film \"rgb\" \"integer xresolution\" 8 \"integer yresolution\" 8 Camera \"perspective\"\nWorldBegin\n"
             "LightSource \"infinite\" Translate 0 0 4 Shape \"sphere\"\n");
  Succeed("render sky.pbrt --integrator auto --spp 1 --quiet --auto-layers --stats stats.json -o sky.exr");
  ASSERT_THAT(Read("stats.json"), HasSubstr("\"integrator\": \"path\""));
  const Image image = ReadImage(folder_ / "sky.exr");
  for (const char* layer : kLayers) {
    const int channel = image.ChannelIndex(layer);
    ASSERT_GE(channel, 0) << layer;
    const float expected = layer == std::string("auto.continuing") ? 1 : 0;
    EXPECT_EQ(image.At(4, 4, static_cast<size_t>(channel)), expected) << layer;
  }
}

// `plan` marks the row of the choice, whose figures are those of --stats.
TEST_F(Auto, ThePlanShowsWhatTheRenderDecides) {
  Succeed("render scene.pbrt --integrator auto --spp 1 --quiet --stats stats.json -o a.exr");
  const std::string stats = Read("stats.json");
  const size_t decided = stats.find("\"auto\": ");
  ASSERT_NE(decided, std::string::npos);
  const std::string plan = Succeed("plan scene.pbrt").output;
  const size_t end = plan.find("  <\n");
  ASSERT_NE(end, std::string::npos) << plan;
  const size_t begin = plan.rfind('\n', end) + 1;
  char integrator[16] = "";
  double paths = -1, merging = -1;
  ASSERT_EQ(std::sscanf(plan.c_str() + begin, "%15s %lf %lf%%", integrator, &paths, &merging), 3) << plan;
  EXPECT_THAT(stats, HasSubstr("\"integrator\": \"" + std::string(integrator) + "\""));
  EXPECT_EQ(paths, NumberAfter(stats, "lightPaths", decided));
  EXPECT_NEAR(merging, 100 * NumberAfter(stats, "merging", decided), 0.5);
}

// A scene that names its integrator: the hint is of another integrator, or of the same with other counts, and tells the
// counts in either case.
TEST_F(Auto, HintsTellTheCounts) {
  for (const std::string named : {"path", "vcm"}) {
    WriteBytes(folder_ / "named.pbrt", SceneWith("Integrator \"" + named + "\""));
    // A wide picture, most of which needs no light paths.
    const std::string output = Succeed("render named.pbrt --resolution 192x32 --spp 1 -o a.exr").output;
    EXPECT_THAT(output, testing::ContainsRegex("hint: the scene names " + named +
                                               "; --integrator auto would render with (bdpt|vcm): "));
    EXPECT_THAT(output, testing::ContainsRegex(
                            "; with (a light path for [0-9]+ camera paths|.*merging in [0-9]+ % of the picture)"));
    EXPECT_THAT(Succeed("render named.pbrt --spp 1 -o a.exr --integrator " + named).output, Not(HasSubstr("auto")));
  }
  // Nothing is gained by other counts where nothing emits.
  WriteBytes(folder_ / "dark.pbrt", "Integrator \"path\"\nWorldBegin\nShape \"sphere\"\n");
  EXPECT_THAT(Succeed("render dark.pbrt --resolution 8x8 --spp 1 -o a.exr").output, Not(HasSubstr("hint")));
}

// In `compare`, "auto" renders the picture of `render --integrator auto`, and its neighbours those of their own names.
TEST_F(Auto, IsComparedAsItRenders) {
  Succeed("render scene.pbrt --integrator vcm --spp 64 --quiet -o reference.exr");
  const Outcome compared = Succeed(
      "compare scene.pbrt --integrators vcm,auto,bdpt --spp 4 --repeat 2 --reference reference.exr -o compared");
  EXPECT_THAT(compared.output, HasSubstr("auto: vcm, "));
  const std::string results = Read("compared/results.json");
  for (const std::string integrator : {"vcm", "auto", "bdpt"}) {
    const size_t own = results.find("\"name\": \"" + integrator + "\"");
    ASSERT_NE(own, std::string::npos) << integrator;
    const size_t runs = results.find("\"runs\": ", own);
    const double seed = NumberAfter(results, "seed", runs);
    Succeed("render scene.pbrt --integrator " + integrator + " --spp 4 --quiet --seed " +
            std::to_string(static_cast<uint64_t>(seed)) + " -o same.exr");
    const Outcome difference = Run("diff same.exr reference.exr --json");
    const double error = NumberAfter(difference.output, "mse");
    ASSERT_GT(error, 0) << difference.output;
    EXPECT_NEAR(NumberAfter(results, "mse", runs), error, 1e-6 * error) << integrator;
  }
}

}  // namespace
}  // namespace lampyr::test
