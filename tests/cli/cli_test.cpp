// The binary as a user runs it: exit codes, messages, files.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <thread>

#include "film/image.h"
#include "support/lampyr_process.h"

namespace lampyr {
namespace {

namespace fs = std::filesystem;

using test::LampyrProcess;
using test::Outcome;

class Cli : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("lampyr-cli-" + std::to_string(getpid()));
    fs::create_directories(folder_);
    Write("scene.pbrt", kScene);
  }
  void TearDown() override { fs::remove_all(folder_); }

  void Write(const std::string& name, const std::string& text) { std::ofstream(folder_ / name) << text; }
  std::string Read(const std::string& name) {
    std::ifstream stream(folder_ / name, std::ios::binary);
    std::stringstream text;
    text << stream.rdbuf();
    return text.str();
  }

  // Runs lampyr in the test's folder.
  Outcome Run(const std::string& arguments) { return test::RunLampyr(folder_, arguments); }

  static constexpr const char* kScene = R"(Film "rgb" "integer xresolution" 32 "integer yresolution" 20
LookAt 0 1 3  0 0 0  0 1 0
Camera "perspective" "float fov" 40
Sampler "sobol" "integer pixelsamples" 4
WorldBegin
LightSource "point" "rgb I" [4 4 4] "point3 from" [0 2 1]
Shape "trianglemesh" "point3 P" [-5 0 -5 -5 0 5 5 0 5 5 0 -5] "integer indices" [0 1 2 0 2 3]
)";
  fs::path folder_;
};

TEST_F(Cli, AnIntegratorThatCannotRenderTheSceneIsToldWhereItIsNamed) {
  Write("lens.dat", "40 3 1.5 20\n-40 2 1 20\n0 60 0 8\n");
  Write("lens.pbrt",
        "Camera \"realistic\" \"string lensfile\" \"lens.dat\"\n"
        "Film \"rgb\" \"integer xresolution\" 8 \"integer yresolution\" 8\n"
        "  Integrator \"light\"\nWorldBegin\nShape \"sphere\"\n");
  const Outcome named = Run("render lens.pbrt -o out.exr --spp 1");
  EXPECT_EQ(named.exitCode, 2) << named.output;
  EXPECT_NE(named.output.find("lens.pbrt:3:3: error: integrator light:"), std::string::npos) << named.output;
  const Outcome asked = Run("render lens.pbrt --integrator light -o out.exr --spp 1");
  EXPECT_EQ(asked.exitCode, 2) << asked.output;
}

TEST_F(Cli, RendersAnImageWithMetadataAndStatistics) {
  const Outcome outcome = Run("render scene.pbrt -o out.exr --png --stats stats.json");
  ASSERT_EQ(outcome.exitCode, 0) << outcome.output;
  EXPECT_NE(outcome.output.find("4 spp"), std::string::npos) << outcome.output;
  const Image image = ReadImage(folder_ / "out.exr");
  EXPECT_EQ(image.width, 32);
  EXPECT_EQ(image.height, 20);
  EXPECT_GE(image.ChannelIndex("variance.G"), 0);
  EXPECT_EQ(image.metadata.at("lampyr.samplesPerPixel"), "4");
  EXPECT_EQ(image.metadata.at("lampyr.integrator"), "path");
  EXPECT_TRUE(fs::exists(folder_ / "out.png"));
  const std::string stats = Read("stats.json");
  for (const char* key :
       {"\"rays\"", "\"samplesPerSecond\"", "\"droppedSamples\": 0", "\"peakMemoryMiB\"", "\"build\""}) {
    EXPECT_NE(stats.find(key), std::string::npos) << key << " in " << stats;
  }
}

TEST_F(Cli, LightGroupsAreLayersOfTheImageAndOfNothingElse) {
  const std::string more = "LightSource \"infinite\" \"rgb L\" [0.1 0.2 0.3]";
  Write("plain.pbrt", kScene + more + "\n");
  Write("grouped.pbrt", kScene + more + " \"string lightGroup\" \"sky light\"\n");
  ASSERT_EQ(Run("render plain.pbrt -o plain.exr --png --quiet").exitCode, 0);
  ASSERT_EQ(Run("render grouped.pbrt -o grouped.exr --png --quiet --stats stats.json").exitCode, 0);
  const Image plain = ReadImage(folder_ / "plain.exr"), grouped = ReadImage(folder_ / "grouped.exr");
  EXPECT_EQ(plain.channels, (std::vector<std::string>{"R", "G", "B", "variance.R", "variance.G", "variance.B"}));
  EXPECT_EQ(plain.metadata.count("lampyr.lightGroups"), 0u);
  EXPECT_EQ(grouped.channels,
            (std::vector<std::string>{"R", "G", "B", "rest.R", "rest.G", "rest.B", "sky_light.R", "sky_light.G",
                                      "sky_light.B", "variance.R", "variance.G", "variance.B"}));
  EXPECT_EQ(grouped.metadata.at("lampyr.lightGroups"), "sky_light,rest");
  EXPECT_EQ(Read("plain.png"), Read("grouped.png"));
  const std::string stats = Read("stats.json");
  EXPECT_NE(stats.find("\"lightGroups\": [\n    \"sky_light\",\n    \"rest\"\n  ]"), std::string::npos) << stats;
  const Outcome diff = Run("diff plain.exr grouped.exr --json");
  EXPECT_EQ(diff.exitCode, 0) << diff.output;
  EXPECT_NE(diff.output.find("\"mse\": 0.0"), std::string::npos) << diff.output;
  EXPECT_NE(Run("plan grouped.pbrt").output.find("light groups     2 layers"), std::string::npos);
  ASSERT_EQ(Run("render grouped.pbrt --spp 256 -o reference.exr --quiet").exitCode, 0);
  const Outcome compared =
      Run("compare grouped.pbrt --integrators path,bdpt --spp 2 --repeat 2 --reference reference.exr -o c");
  EXPECT_EQ(compared.exitCode, 0) << compared.output;
  Write("taken.pbrt", std::string(kScene) + "LightSource \"point\" \"string lightGroup\" \"variance\"\n");
  const Outcome taken = Run("render taken.pbrt");
  EXPECT_EQ(taken.exitCode, 2);
  EXPECT_NE(taken.output.find("taken.pbrt:8:21: error: a light group cannot be called"), std::string::npos)
      << taken.output;
}

// Expressions from the command line and the scene, in the picture, its metadata and the statistics; and their errors.
TEST_F(Cli, LayersAreThoseOfTheExpressions) {
  const std::string lights =
      "LightSource \"infinite\" \"rgb L\" [0.1 0.2 0.3] \"string name\" \"sky\"\nLightSource \"point\" \"rgb I\" [1 2 "
      "3] "
      "\"string name\" \"key\"\n";
  std::string scene = kScene + lights;
  Write("layers.pbrt", scene);
  const std::string render = "render layers.pbrt --quiet ";
  const Outcome done = Run(render +
                           "-o o.exr --stats s.json --layer direct-diffuse --layer \"keys = C<RD>[<L.'key'>O]\" "
                           "--layer \"emission<L.'sky'>\"");
  ASSERT_EQ(done.exitCode, 0) << done.output;
  const Image image = ReadImage(folder_ / "o.exr");
  for (const char* layer : {"direct_diffuse", "keys", "emission_sky"})
    EXPECT_GE(image.ChannelIndex(std::string(layer) + ".G"), 0) << layer;
  EXPECT_EQ(image.metadata.at("lampyr.layer.keys"), "C<RD>[<L.'key'>O]");
  EXPECT_NE(Read("s.json").find("\"expression\": \"C<RD>[<L.'key'>O]\""), std::string::npos) << Read("s.json");
  const auto error = [&](const std::string& command) {
    const Outcome outcome = Run(command);
    EXPECT_EQ(outcome.exitCode, 2) << outcome.output;
    return outcome.output;
  };
  const std::pair<const char*, const char*> wrong[] = {
      {"--layer costic", "--layer: there is no layer \"costic\" (did you mean \"caustic\"?)"},
      {"--layer \"x=C<RX>L\"", "--layer: layer \"x\": character 4 of \"C<RX>L\": here is one of these wanted"},
      {"--layer \"C<RD>L\"", "--layer: a layer by an expression has a name: NAME=C<RD>L"},
      {"--layer \"x=C<L.'kex'>\"", "the scene has no light or light group \"kex\" (did you mean \"key\"?)"},
      {"--layer caustic --layer caustic", "two layers have the name \"caustic\""},
      {"--layer \"variance=CL\"", "a layer cannot be called \"variance\""}};
  for (const auto& [option, message] : wrong)
    EXPECT_NE(error(render + option + " -o x.exr").find(message), std::string::npos) << option;
  scene.insert(scene.find("WorldBegin"),
               "Film \"rgb\" \"integer xresolution\" 16 \"integer yresolution\" 12\n  \"string layers\" "
               "[ \"caustic\" \"bad=CQL\" ]\n");
  Write("layers.pbrt", scene);
  const std::string located = error(render + "-o x.exr");
  EXPECT_NE(located.find("error: layer \"bad\": character 2 of \"CQL\": \"Q\" is no event"), std::string::npos)
      << located;
  EXPECT_NE(located.find("layers.pbrt:"), std::string::npos) << located;
}

// Mattes and other layers of what pixels see, and of their samples; and they outlive parts that are merged.
TEST_F(Cli, PixelLayersAreInThePicture) {
  const std::string layers = " --layer N --layer \"crypto object\" --layer samples --layer relative-error";
  ASSERT_EQ(Run("render scene.pbrt --quiet --spp 8 -o o.exr" + layers).exitCode, 0);
  const Image image = ReadImage(folder_ / "o.exr");
  for (const char* channel : {"N.X", "CryptoObject00.R", "CryptoObject02.A", "samples", "relativeError"})
    EXPECT_GE(image.ChannelIndex(channel), 0) << channel;
  EXPECT_EQ(image.At(3, 3, static_cast<size_t>(image.ChannelIndex("samples"))), 8);
  for (const char* part : {"1/2", "2/2"})
    ASSERT_EQ(Run(std::string("render scene.pbrt --quiet --spp 8 --shard ") + part + layers).exitCode, 0);
  const Outcome merged = Run("merge scene.1-of-2.exr scene.2-of-2.exr -o merged.exr --quiet");
  ASSERT_EQ(merged.exitCode, 0) << merged.output;
  const Image whole = ReadImage(folder_ / "merged.exr");
  EXPECT_EQ(whole.data, image.data);
  EXPECT_EQ(whole.metadata, image.metadata);
}

// The bias of merging in the picture, in that of parts, and in the report; integrators that merge nothing have none.
TEST_F(Cli, TheBiasOfMergingIsInThePicture) {
  const std::string vcm = "render scene.pbrt --quiet --integrator vcm --spp 8 --layer bias --layer \"relative error\"";
  ASSERT_EQ(Run(vcm + " -o o.exr --stats o.json").exitCode, 0);
  const Image image = ReadImage(folder_ / "o.exr");
  double sum = 0;
  for (const char* channel : {"bias.R", "bias.G", "bias.B"}) {
    ASSERT_GE(image.ChannelIndex(channel), 0);
    const auto index = static_cast<size_t>(image.ChannelIndex(channel));
    for (int y = 0; y < image.height; ++y) {
      for (int x = 0; x < image.width; ++x) sum += std::abs(static_cast<double>(image.At(x, y, index)));
    }
  }
  EXPECT_GT(sum, 0);
  EXPECT_NE(Read("o.json").find("\"errorParts\": {\n    \"noise\": "), std::string::npos) << Read("o.json");
  for (const char* part : {"1/2", "2/2"}) ASSERT_EQ(Run(vcm + " --shard " + part).exitCode, 0);
  const Outcome merged = Run("merge scene.1-of-2.exr scene.2-of-2.exr -o merged.exr --quiet");
  ASSERT_EQ(merged.exitCode, 0) << merged.output;
  EXPECT_EQ(ReadImage(folder_ / "merged.exr").data, image.data);
  ASSERT_EQ(Run("render scene.pbrt --quiet --integrator path --spp 8 --layer bias -o p.exr --stats p.json").exitCode,
            0);
  const Image none = ReadImage(folder_ / "p.exr");
  EXPECT_EQ(none.At(3, 3, static_cast<size_t>(none.ChannelIndex("bias.G"))), 0);
  EXPECT_EQ(Read("p.json").find("errorParts"), std::string::npos);
}

// The PNG is there before the render ends, and it does not change the picture.
TEST_F(Cli, PreviewShowsThePictureSoFar) {
  ASSERT_EQ(Run("render scene.pbrt --quiet --spp 64 -o plain.exr --png").exitCode, 0);
  const Outcome done = Run("render scene.pbrt --spp 64 -o o.exr --preview 0.001s");
  ASSERT_EQ(done.exitCode, 0) << done.output;
  EXPECT_EQ(done.output.find('\033'), std::string::npos) << "no terminal, no picture";
  EXPECT_EQ(ReadImage(folder_ / "o.exr").data, ReadImage(folder_ / "plain.exr").data);
  EXPECT_EQ(Read("o.png"), Read("plain.png"));
}

// Lights of a finished picture are dimmed, tinted and turned off.
TEST_F(Cli, MixesLayers) {
  Write("groups.pbrt", std::string(kScene) +
                           "LightSource \"infinite\" \"rgb L\" [0.1 0.2 0.3] \"string lightGroup\" \"sky\"\n"
                           "LightSource \"point\" \"rgb I\" [1 2 3] \"string lightGroup\" \"key\"\n");
  ASSERT_EQ(Run("render groups.pbrt -o in.exr --quiet --layer caustic").exitCode, 0);
  const Image in = ReadImage(folder_ / "in.exr");
  const auto mixed = [&](const std::string& factors) {
    const Outcome outcome = Run("mix in.exr " + factors + " -o out.exr --quiet");
    EXPECT_EQ(outcome.exitCode, 0) << outcome.output;
    return ReadImage(folder_ / "out.exr");
  };
  const Image same = mixed("sky=1 key=1 rest=1"), off = mixed("sky=0 key=0 rest=0"), tinted = mixed("key=2,0,0.5"),
              twice = mixed("sky=2 key=2 rest=2");
  const auto at = [](const Image& image, int x, int y, const std::string& channel) {
    return image.At(x, y, static_cast<size_t>(image.ChannelIndex(channel)));
  };
  for (int y = 0; y < in.height; ++y) {
    for (int x = 0; x < in.width; ++x) {
      const float tint[] = {2, 0, 0.5f};
      for (size_t c = 0; c < 3; ++c) {
        const std::string channel(1, "RGB"[c]);
        const float value = at(in, x, y, channel), key = at(in, x, y, "key." + channel);
        EXPECT_NEAR(at(same, x, y, channel), value, 1e-6f * value);
        EXPECT_EQ(at(off, x, y, channel), 0);
        EXPECT_NEAR(at(tinted, x, y, channel), value + (tint[c] - 1) * key, 2e-6f * value);
        EXPECT_EQ(at(tinted, x, y, "key." + channel), tint[c] * key);
        EXPECT_FLOAT_EQ(at(twice, x, y, "variance." + channel), 4 * at(in, x, y, "variance." + channel));
      }
    }
  }
  EXPECT_EQ(tinted.ChannelIndex("variance.R"), -1);
  const auto error = [&](const std::string& command) {
    const Outcome outcome = Run(command);
    EXPECT_EQ(outcome.exitCode, 2) << outcome.output;
    return outcome.output;
  };
  EXPECT_NE(error("mix in.exr kee=2 -o out.exr").find("the picture has no layer \"kee\" (did you mean \"key\"?)"),
            std::string::npos);
  EXPECT_NE(error("mix in.exr key=x -o out.exr").find("\"key=x\": a layer and its factor are wanted"),
            std::string::npos);
  EXPECT_NE(error("mix in.exr key=1,2 -o out.exr").find("a layer and its factor are wanted"), std::string::npos);
  EXPECT_NE(error("mix in.exr key=1 key=2 -o out.exr").find("named twice"), std::string::npos);
  EXPECT_NE(error("mix in.exr key=1 -o in.exr").find("is the picture that is read"), std::string::npos);
}

// A threshold on shadow rays is compared like another integrator, with its cost and its error.
TEST_F(Cli, ComparesSettingsOfAnIntegrator) {
  const std::string compare = "compare scene.pbrt --spp 2,4 --repeat 2 -o c --integrators ";
  const Outcome compared = Run(compare + "path,path:shadow-threshold=0.05,path:shadow-roulette=0");
  ASSERT_EQ(compared.exitCode, 0) << compared.output;
  EXPECT_NE(compared.output.find("path:shadow-threshold=0.05"), std::string::npos) << compared.output;
  const auto error = [&](const std::string& command) {
    const Outcome outcome = Run(command);
    EXPECT_EQ(outcome.exitCode, 2) << outcome.output;
    return outcome.output;
  };
  EXPECT_NE(error(compare + "path:shadow-treshold=1").find("no setting \"shadow-treshold\" (did you mean"),
            std::string::npos);
  EXPECT_NE(error(compare + "path:shadow-threshold=x").find("\"x\" is not a number: it must be 0 or more"),
            std::string::npos);
  EXPECT_NE(error(compare + "pat:shadow-threshold=1").find("no integrator \"pat\" (did you mean \"path\"?)"),
            std::string::npos);
  error("render scene.pbrt --shadow-threshold -1");
  error("render scene.pbrt --shadow-roulette 2");
}

TEST_F(Cli, LightFiltersThatCannotBe) {
  const auto error = [&](const std::string& statements) {
    Write("bad.pbrt", std::string(kScene) + statements);
    const Outcome outcome = Run("render bad.pbrt");
    EXPECT_EQ(outcome.exitCode, 2) << outcome.output;
    return outcome.output;
  };
  EXPECT_NE(error("LightFilter \"goboo\"\n")
                .find("bad.pbrt:8:1: error: there is no LightFilter \"goboo\" (did you mean \"gobo\"?)"),
            std::string::npos);
  EXPECT_NE(
      error("LightFilter \"rod\" \"string name\" \"rod1\"\nLightFilter \"combiner\" \"string filters\" \"rod2\"\n")
          .find("bad.pbrt:9:24: error: there is no LightFilter with the name \"rod2\" before this one (did you "
                "mean \"rod1\"?)"),
      std::string::npos);
  EXPECT_NE(error("LightFilter \"gobo\" \"string filename\" \"nowhere.png\"\n").find("bad.pbrt:8:20: error:"),
            std::string::npos);
  EXPECT_NE(error("LightFilter \"rod\" \"string combineMode\" \"mx\"\n").find("multiply, max, min or screen"),
            std::string::npos);
  Write("warned.pbrt", std::string(kScene) +
                           "LightSource \"point\" \"string lightGroup\" \"keys\"\n"
                           "Attribute \"lighting\" \"string subset\" \"kys\"\nShape \"sphere\"\n");
  const Outcome warned = Run("render warned.pbrt --quiet -o w.exr");
  EXPECT_EQ(warned.exitCode, 0);
  EXPECT_NE(warned.output.find("warned.pbrt:9:22: warning: there is no light or light group \"kys\" (did you mean "
                               "\"keys\"?)"),
            std::string::npos)
      << warned.output;
  EXPECT_EQ(Run("render warned.pbrt --strict").exitCode, 2);
}

TEST_F(Cli, SameFileForAnyNumberOfThreads) {
  ASSERT_EQ(Run("render scene.pbrt -o a.exr --threads 1 --quiet").exitCode, 0);
  ASSERT_EQ(Run("render scene.pbrt -o b.exr --threads 4 --quiet").exitCode, 0);
  EXPECT_EQ(Read("a.exr"), Read("b.exr"));
  ASSERT_EQ(Run("render scene.pbrt -o c.exr --seed 3 --quiet").exitCode, 0);
  EXPECT_NE(Read("a.exr"), Read("c.exr"));
}

TEST_F(Cli, TracesLightByOptionAndByScene) {
  ASSERT_EQ(Run("render scene.pbrt --integrator light -o a.exr --threads 1 --stats stats.json --quiet").exitCode, 0);
  EXPECT_EQ(ReadImage(folder_ / "a.exr").metadata.at("lampyr.integrator"), "light");
  EXPECT_NE(Read("stats.json").find("\"integrator\": \"light\""), std::string::npos);
  for (const char* name : {"light", "lightpath"}) {
    Write("light.pbrt", std::string("Integrator \"") + name + "\"\n" + kScene);
    ASSERT_EQ(Run("render light.pbrt --strict -o b.exr --threads 3 --quiet").exitCode, 0);
    EXPECT_EQ(ReadImage(folder_ / "a.exr").data, ReadImage(folder_ / "b.exr").data);
  }
  ASSERT_EQ(Run("render light.pbrt --integrator path -o c.exr --quiet").exitCode, 0);
  EXPECT_EQ(ReadImage(folder_ / "c.exr").metadata.at("lampyr.integrator"), "path");
  EXPECT_EQ(Run("render light.pbrt --time 1s -o d.exr --quiet").exitCode, 0);
  EXPECT_EQ(Run("render light.pbrt --target-error 0.2 -o d.exr --quiet").exitCode, 0);
  EXPECT_NE(Run("render scene.pbrt --integrator magic").output.find("there are: path, light, bdpt"), std::string::npos);
  EXPECT_NE(Run("render --help").output.find("path | light | bdpt"), std::string::npos);
  Write("light.pbrt", std::string("Integrator \"lihgt\"\n") + kScene);
  const Outcome wrong = Run("render light.pbrt");
  EXPECT_EQ(wrong.exitCode, 2);
  EXPECT_NE(wrong.output.find("light.pbrt:1"), std::string::npos) << wrong.output;
  EXPECT_NE(wrong.output.find("did you mean \"light\""), std::string::npos) << wrong.output;
}

TEST_F(Cli, WritesPicturesOfTechniques) {
  ASSERT_EQ(
      Run("render scene.pbrt --integrator bdpt --max-depth 2 --strategy-images parts --png -o a.exr --quiet").exitCode,
      0);
  ASSERT_EQ(Run("render scene.pbrt --integrator bdpt --max-depth 2 -o b.exr --threads 1 --quiet").exitCode, 0);
  const Image image = ReadImage(folder_ / "a.exr");
  const std::vector<std::string> own = {"R", "G", "B", "variance.R", "variance.G", "variance.B"};
  EXPECT_EQ(ChannelsOf(image, own).data, ChannelsOf(ReadImage(folder_ / "b.exr"), own).data);
  std::vector<double> sum(3 * static_cast<size_t>(image.width) * static_cast<size_t>(image.height));
  for (int events = 0; events <= 2; ++events) {
    for (int s = 0; s <= events + 1; ++s) {
      const std::string name = "s" + std::to_string(s) + "-t" + std::to_string(events + 2 - s);
      EXPECT_TRUE(std::filesystem::exists(folder_ / "parts" / ("unweighted-" + name + ".png"))) << name;
      const Image part = ReadImage(folder_ / "parts" / ("weighted-" + name + ".exr"));
      for (size_t k = 0; k < sum.size(); ++k) sum[k] += static_cast<double>(part.data[k]);
    }
  }
  double difference = 0, total = 0;
  for (size_t k = 0; k < sum.size(); ++k) {
    const double whole = static_cast<double>(
        image.At(static_cast<int>(k / 3) % image.width, static_cast<int>(k / 3) / image.width, k % 3));
    difference += std::abs(sum[k] - whole);
    total += whole;
  }
  EXPECT_GT(total, 0);
  EXPECT_LT(difference, 1e-4 * total);
  // A picture of a technique that cannot be written costs nothing else.
  std::filesystem::create_directories(folder_ / "blocked" / "weighted-s0-t2.exr");
  const Outcome blocked = Run(
      "render scene.pbrt --integrator bdpt --max-depth 1 --strategy-images blocked -o d.exr --stats d.json --quiet");
  EXPECT_EQ(blocked.exitCode, 1);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "d.exr"));
  EXPECT_TRUE(std::filesystem::exists(folder_ / "d.json"));
  const Outcome wrong = Run("render scene.pbrt --integrator path --strategy-images parts -o c.exr");
  EXPECT_EQ(wrong.exitCode, 2);
  EXPECT_NE(wrong.output.find("only bdpt, vcm have strategies"), std::string::npos) << wrong.output;
  const Outcome large =
      Run("render scene.pbrt --integrator bdpt --strategy-images parts --resolution 6000x6000 -o c.exr");
  EXPECT_EQ(large.exitCode, 2);
  EXPECT_NE(large.output.find("of memory"), std::string::npos) << large.output;
}

// A setting of another integrator than the one that is named does nothing; auto may read it.
TEST_F(Cli, HintsAtSettingsWithoutEffect) {
  Write("scene.pbrt", kScene);
  const auto outputOf = [&](const std::string& arguments) {
    const Outcome outcome = Run("render scene.pbrt --resolution 8x8 --spp 1 -o a.exr " + arguments);
    EXPECT_EQ(outcome.exitCode, 0) << outcome.output;
    return outcome.output;
  };
  EXPECT_NE(outputOf("--integrator path --radius 0.1 --max-depth 3")
                .find("hint: --radius has no effect: path does not have this setting, but sppm, vcm\n"),
            std::string::npos);
  EXPECT_EQ(outputOf("--integrator path --max-depth 3 --no-guide-paths").find("no effect"), std::string::npos);
  EXPECT_EQ(outputOf("--integrator vcm --radius 0.1").find("no effect"), std::string::npos);
  EXPECT_EQ(outputOf("--integrator auto --radius 0.1").find("no effect"), std::string::npos);
}

// The hint names the light that the chosen integrator cannot find, and an integrator that can; without such light there
// is no hint.
TEST_F(Cli, HintsAtWhatAnIntegratorCannotFind) {
  const std::string glass = "Material \"dielectric\" \"float eta\" 1.5\nShape \"sphere\" \"float radius\" 0.3\n";
  const auto hintOf = [&](const std::string& scene, const std::string& integrator) {
    Write("glass.pbrt", scene);
    const Outcome outcome = Run("render glass.pbrt --spp 1 -o a.exr --integrator " + integrator);
    EXPECT_EQ(outcome.exitCode, 0) << outcome.output;
    const size_t hint = outcome.output.find("hint: ");
    return hint == std::string::npos ? std::string() : outcome.output.substr(hint);
  };
  EXPECT_NE(hintOf(kScene + glass, "path").find("1 of 1 lights"), std::string::npos);
  EXPECT_NE(hintOf(kScene + glass, "path").find("--integrator bdpt"), std::string::npos);
  EXPECT_NE(hintOf(kScene + glass, "light").find("stay black"), std::string::npos);
  EXPECT_NE(hintOf(kScene + glass, "bdpt").find("--integrator vcm"), std::string::npos);
  EXPECT_EQ(hintOf(kScene + glass, "vcm"), "");
  EXPECT_EQ(hintOf(kScene + glass, "sppm"), "");
  EXPECT_EQ(hintOf(kScene, "path"), "");
  std::string lamp = kScene + glass;
  lamp.replace(lamp.find("LightSource"), lamp.find("Shape") - lamp.find("LightSource"),
               "LightSource \"sphere\" \"float radius\" 0.1\n");
  EXPECT_EQ(hintOf(lamp, "path"), "");
  EXPECT_EQ(hintOf(lamp, "bdpt"), "");
  std::string withoutPaths = kScene;
  withoutPaths.insert(withoutPaths.find('\n', withoutPaths.find("LightSource")), " \"bool traceLightPaths\" false");
  EXPECT_NE(hintOf(withoutPaths, "sppm").find("leave no photons"), std::string::npos);
  EXPECT_NE(hintOf(withoutPaths, "light").find("start no paths"), std::string::npos);
  EXPECT_EQ(hintOf(withoutPaths, "vcm"), "");
  const auto curve = [&](const std::string& type) {
    return std::string(kScene) +
           "Material \"diffuse\"\nShape \"curve\" \"point3 P\" [0 0 0 1 0 0 2 0 0 3 0 0] \"string type\" \"" + type +
           "\"\n";
  };
  EXPECT_NE(hintOf(curve("flat"), "bdpt").find("flat curves turn to the ray"), std::string::npos);
  EXPECT_EQ(hintOf(curve("flat"), "path"), "");
  EXPECT_EQ(hintOf(curve("cylinder"), "bdpt"), "");
}

TEST_F(Cli, StatisticsOfPhotons) {
  for (const std::string integrator : {"sppm", "vcm", "vcm --no-connect", "sppm --direct-photons"}) {
    const Outcome outcome =
        Run("render scene.pbrt --spp 3 -o a.exr --stats a.json --photons 500 --radius 0.1 --integrator " + integrator);
    EXPECT_EQ(outcome.exitCode, 0) << outcome.output;
    const std::string stats = Read("a.json");
    EXPECT_NE(stats.find("\"passes\": 3,"), std::string::npos) << stats;
    EXPECT_NE(stats.find("\"firstRadius\": 0.1"), std::string::npos) << stats;
  }
  Run("render scene.pbrt --spp 1 -o a.exr --stats a.json --integrator bdpt");
  EXPECT_EQ(Read("a.json").find("photons"), std::string::npos);
}

// pbrt-v4 takes any number of photons that is not above 0 for one that is not given.
TEST_F(Cli, PhotonsOfPbrtThatAreNotGiven) {
  for (const char* number : {"-1", "0", "-5"}) {
    Write("photons.pbrt", std::string("Integrator \"sppm\" \"integer photonsperiteration\" ") + number + "\n" + kScene);
    const Outcome outcome = Run("render photons.pbrt --quiet -o photons.exr");
    EXPECT_EQ(outcome.exitCode, 0) << number << ": " << outcome.output;
  }
}

// Typical first attempts of a new user.
TEST_F(Cli, GuessesWhatIsMeant) {
  const auto wrong = [&](const std::string& command, const std::string& what) {
    const Outcome outcome = Run(command);
    EXPECT_EQ(outcome.exitCode, 2) << command;
    EXPECT_NE(outcome.output.find("error: " + what), std::string::npos) << command << ": " << outcome.output;
  };
  wrong("rendr scene.pbrt", "there is no command \"rendr\" (did you mean \"render\"?); there are: help, render,");
  wrong("help rendr", "there is no command \"rendr\" (did you mean \"render\"?)");
  wrong("render scene.pbrt --integrater path",
        "there is no option \"--integrater\" (did you mean \"--integrator\"?); `lampyr render --help`");
  wrong("render scene.pbrt --no-merg=1", "there is no option \"--no-merg\" (did you mean \"--no-merge\"?)");
  wrong("render scene.pbrt other.pbrt", "\"other.pbrt\" is one word too many");
  wrong("render scene.pbrt --integrator pth", "--integrator: there is no integrator \"pth\" (did you mean \"path\"?)");
  wrong("render", "scene is required; `lampyr render --help`");
  for (const char* help : {"help", "", "--help"}) {
    const Outcome outcome = Run(help);
    EXPECT_EQ(outcome.exitCode, 0) << help;
    EXPECT_NE(outcome.output.find("check-lights"), std::string::npos) << help << ": " << outcome.output;
  }
  EXPECT_EQ(Run("help render").output, Run("render --help").output);
  const Outcome rendered = Run("scene.pbrt --spp 1 -o short.exr");
  EXPECT_EQ(rendered.exitCode, 0) << rendered.output;
  EXPECT_TRUE(fs::exists(folder_ / "short.exr"));
}

TEST_F(Cli, PlanSaysWhatIsModelledAndWhy) {
  const std::string mirror = "Material \"conductor\" \"float roughness\" 0\nShape \"sphere\" \"float radius\" 0.3\n";
  const std::string sky = "WorldBegin\nLightSource \"infinite\"\n" + mirror;
  Write("mirror.pbrt", kScene + mirror);
  Write("sky.pbrt", sky);
  Write("dark.pbrt", "WorldBegin\n" + mirror);
  const auto planOf = [&](const std::string& arguments) {
    const Outcome outcome = Run("plan " + arguments);
    EXPECT_EQ(outcome.exitCode, 0) << outcome.output;
    return outcome.output;
  };
  EXPECT_NE(planOf("mirror.pbrt").find("path misses"), std::string::npos) << planOf("mirror.pbrt");
  EXPECT_NE(planOf("scene.pbrt").find("least error in equal time, as a pilot estimates it: bdpt has"),
            std::string::npos)
      << planOf("scene.pbrt");
  for (const char* row : {"\npath ", "\nbdpt ", "\nvcm "})
    EXPECT_NE(planOf("scene.pbrt").find(row), std::string::npos) << planOf("scene.pbrt");
  EXPECT_NE(planOf("scene.pbrt").find("photons          none"), std::string::npos);
  EXPECT_NE(planOf("sky.pbrt").find("a pilot found no light"), std::string::npos) << planOf("sky.pbrt");
  EXPECT_NE(planOf("dark.pbrt").find("nothing emits"), std::string::npos);
  EXPECT_NE(planOf("scene.pbrt --integrator sppm").find("as set; \"auto\" would choose path"), std::string::npos);
  EXPECT_EQ(Run("plan absent.pbrt").exitCode, 2);
}

TEST_F(Cli, AutoIsWhatThePlanSays) {
  const std::string mirror = "Material \"conductor\" \"float roughness\" 0\nShape \"sphere\" \"float radius\" 0.3\n";
  Write("mirror.pbrt", kScene + mirror);
  Write("auto.pbrt", std::string("Integrator \"auto\"\n") + kScene + mirror);
  std::istringstream plan(Run("plan mirror.pbrt").output);
  std::string subject, chosen;
  plan >> subject >> chosen;
  ASSERT_EQ(subject, "integrator");
  Run("render mirror.pbrt --spp 2 -o a.exr --integrator auto --threads 2");
  Run("render mirror.pbrt --spp 2 -o b.exr --integrator auto --stats b.json --threads 1");
  Run("render auto.pbrt --spp 2 -o c.exr --stats c.json --threads 3");
  EXPECT_EQ(Read("a.exr"), Read("b.exr"));
  EXPECT_NE(Read("b.json").find("\"integrator\": \"" + chosen + "\""), std::string::npos);
  EXPECT_NE(Read("c.json").find("\"integrator\": \"" + chosen + "\""), std::string::npos);
}

// No photons, a single one, none to be found, all of them found.
TEST_F(Cli, PhotonsAtTheExtremes) {
  Write("dark.pbrt", "WorldBegin\nShape \"sphere\" \"float radius\" 0.3\n");
  Write("nothing.pbrt", "WorldBegin\nLightSource \"point\"\n");
  for (const char* scene : {"scene.pbrt", "dark.pbrt", "nothing.pbrt"}) {
    for (const char* options : {"", "--photons 1", "--radius 1e-30", "--radius 1e30", "--photon-memory 1"}) {
      for (const char* integrator : {"sppm", "vcm", "sppm --direct-photons", "vcm --no-connect"}) {
        const std::string command = std::string("render ") + scene + " --resolution 24x16 --spp 4 -o a.exr " + options +
                                    " --integrator " + integrator;
        const Outcome outcome = Run(command);
        EXPECT_EQ(outcome.exitCode, 0) << command << "\n" << outcome.output;
        EXPECT_EQ(outcome.output.find("dropped"), std::string::npos) << command << "\n" << outcome.output;
      }
    }
  }
}

// vcm is bdpt and merging.
TEST_F(Cli, WithoutMergingVcmIsBdpt) {
  Run("render scene.pbrt --spp 4 -o a.exr --integrator vcm --no-merge");
  Run("render scene.pbrt --spp 4 -o b.exr --integrator bdpt");
  const Outcome outcome = Run("diff a.exr b.exr");
  EXPECT_EQ(outcome.output.find("MSE      0\n"), 0u) << outcome.output;
}

TEST_F(Cli, QuietIsQuiet) {
  EXPECT_EQ(Run("render scene.pbrt -o a.exr --quiet").output, "");
}

TEST_F(Cli, OptionsOverrideTheScene) {
  ASSERT_EQ(Run("render scene.pbrt -o a.exr --resolution 10x6 --spp 2 --max-depth 1 --sampler independent "
                "--light-sampler uniform --crop 0,0.5,0,1")
                .exitCode,
            0);
  const Image image = ReadImage(folder_ / "a.exr");
  EXPECT_EQ(image.width, 5);
  EXPECT_EQ(image.height, 6);
  EXPECT_EQ(image.fullWidth, 10);
  EXPECT_EQ(image.metadata.at("lampyr.samplesPerPixel"), "2");
}

TEST_F(Cli, StopsByTimeAndByError) {
  const auto start = std::chrono::steady_clock::now();
  ASSERT_EQ(Run("render scene.pbrt -o a.exr --time 1s").exitCode, 0);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  EXPECT_GT(seconds, 0.9);  // that it ends at all is the other half
  Outcome outcome = Run("render scene.pbrt -o a.exr --target-error 0.01");
  EXPECT_EQ(outcome.exitCode, 0) << outcome.output;
  EXPECT_GE(std::stoi(ReadImage(folder_ / "a.exr").metadata.at("lampyr.samplesPerPixel")), 16);
}

TEST_F(Cli, WrongUsageExitsWithTwo) {
  fs::create_directories(folder_ / "folder.exr");
  for (const char* arguments : {"rendr scene.pbrt",
                                "render",
                                "render scene.pbrt --spp 0",
                                "render scene.pbrt --spp x",
                                "render scene.pbrt --time soon",
                                "render scene.pbrt --resolution 0x5",
                                "render scene.pbrt --crop 1,2",
                                "render scene.pbrt --crop 0,0,0,0",
                                "render scene.pbrt --integrator magic",
                                "render scene.pbrt --light-sampler best",
                                "render scene.pbrt --light-samples 0",
                                "render scene.pbrt --light-samples 17",
                                "render scene.pbrt --sampler best",
                                "render scene.pbrt --radius 0",
                                "render scene.pbrt --radius -1",
                                "render scene.pbrt --alpha 1.5",
                                "render scene.pbrt --photons 0",
                                "render scene.pbrt --photon-memory much",
                                "render scene.pbrt --photon-memory 0",
                                "render scene.pbrt --integrator vcm --no-merge --no-connect",
                                "render scene.pbrt -o out.jpg",
                                "render scene.pbrt -o nowhere/out.exr",
                                "render absent.pbrt",
                                "diff absent.exr absent.exr",
                                "lights pont",
                                "render scene.pbrt --target-error nan",
                                "render scene.pbrt --of-pixels 0.9",
                                "render scene.pbrt --target-error 0.1 --of-pixels 1.5",
                                "render scene.pbrt --adaptive --no-adaptive",
                                "render scene.pbrt --adaptive --integrator light",
                                "render scene.pbrt --spp 2 --shard 1/2 --integrator bdpt --strategy-images images",
                                "render scene.pbrt --png --exposure inf",
                                "render scene.pbrt --crop 0,inf,0,1",
                                "render scene.pbrt --resolution 65536x65536",
                                "render scene.pbrt -o folder.exr",
                                "render scene.pbrt --stats folder.exr",
                                "render scene.pbrt -o same.exr --stats same.exr",
                                "render scene.pbrt -o same.exr --stats ./folder.exr/../same.exr",
                                "render scene.pbrt -o same.exr --png --stats same.png",
                                "render scene.pbrt --seed -1",
                                "render scene.pbrt --seed 18446744073709551616",
                                "render scene.pbrt --time ''",
                                "render scene.pbrt --shard ''",
                                "render scene.pbrt --shard 4294967297/4294967298",
                                "render scene.pbrt --resolution 4294967312x9",
                                "render scene.pbrt --resolution +4x4",
                                "render scene.pbrt --layer bias=CL --layer bias",
                                "render scene.pbrt --layer CryptoObject00=CL",
                                "render scene.pbrt --stats nowhere/stats.json"}) {
    const Outcome outcome = Run(arguments);
    EXPECT_EQ(outcome.exitCode, 2) << arguments << "\n" << outcome.output;
    EXPECT_NE(outcome.output, "") << arguments;
  }
}

TEST_F(Cli, BadScenesAreNamedByPlace) {
  std::string billionInstances = "WorldBegin\nObjectBegin \"0\" Shape \"sphere\" ObjectEnd\n";
  for (int i = 1; i <= 9; ++i) {
    billionInstances += "ObjectBegin \"" + std::to_string(i) + "\"\n";
    for (int k = 0; k < 10; ++k) billionInstances += "ObjectInstance \"" + std::to_string(i - 1) + "\"\n";
    billionInstances += "ObjectEnd\n";
  }
  billionInstances += "ObjectInstance \"9\"\n";
  std::string deepMix = "WorldBegin\n";
  for (int i = 20000; i >= 1; --i) {
    const std::string below = "\"" + std::to_string(i - 1) + "\"";
    deepMix += "MakeNamedMaterial \"" + std::to_string(i) + "\" \"string type\" \"mix\" \"string materials\" [" +
               below + below + "]\n";
  }
  deepMix += "MakeNamedMaterial \"0\" \"string type\" \"diffuse\"\n";
  const struct {
    const char *text, *place, *hint;
  } cases[] = {
      {"WorldBegin\nShape \"spehre\"\n", "bad.pbrt:2:1: error:", "did you mean \"sphere\""},
      {"WorldBegin\nShape \"sphere\" \"float raduis\" 2\n", "bad.pbrt:2:16: error:", "did you mean \"radius\""},
      {"WorldBegin\nLightSource \"pont\"\n", "bad.pbrt:2:1: error:", "did you mean \"point\""},
      {"WorldBegin\nMaterial \"difuse\"\n", "bad.pbrt:2:1: error:", "did you mean \"diffuse\""},
      {"WorldBegin\nNamedMaterial \"gold\"\nShape \"sphere\"\n", "bad.pbrt:2:1: error:", "gold"},
      {"WorldBegin\nShape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0] \"integer indices\" [0 1 3]\n",
       "bad.pbrt:2:", "out of range"},
      {"WorldBegin\nShape \"plymesh\" \"string filename\" \"absent.ply\"\n", "bad.pbrt:2:", "absent.ply"},
      {"WorldBegin\nMaterial \"diffuse\" \"texture reflectance\" \"wood\"\nShape \"sphere\"\n", "bad.pbrt:2:", "wood"},
      {"Camera \"perspectiv\"\nWorldBegin\n", "bad.pbrt:1:1: error:", "did you mean \"perspective\""},
      {"Camera \"perspective\" \"float fov\" 190\nWorldBegin\n", "bad.pbrt:1:", "fov"},
      {"Film \"rgb\" \"integer xresolution\" -3\nWorldBegin\n", "bad.pbrt:1:", "xresolution"},
      {"Accelerator \"bhv\"\nWorldBegin\n", "bad.pbrt:1:1: error:", "did you mean \"bvh\""},
      {"Accelerator \"bvh\" \"integer maxnodeprim\" 4\nWorldBegin\n", "bad.pbrt:1:19: error:", "\"maxnodeprims\""},
      {"Option \"seed\" 1.5\nWorldBegin\n", "bad.pbrt:1:8: error:", "integer"},
      {"Sampler \"sobl\"\nWorldBegin\n", "bad.pbrt:1:1: error:", "did you mean \"sobol\""},
      {"Integrator \"paht\"\nWorldBegin\n", "bad.pbrt:1:1: error:", "did you mean \"path\""},
      {"PixelFilter \"gausian\"\nWorldBegin\n", "bad.pbrt:1:1: error:", "did you mean \"gaussian\""},
      {"WorldBegin\nScale 0 1 1\nLightSource \"point\"\n", "bad.pbrt:2:", "singular"},
      {"WorldBegin\nMakeNamedMaterial \"a\" \"string type\" \"mix\" \"string materials\" [\"a\" \"a\"]\nNamedMaterial "
       "\"a\"\nShape \"sphere\"\n",
       "bad.pbrt:2:", "itself"},
      {"Film \"rgb\" \"string sensor\" \"cie1932\"\nWorldBegin\n", "bad.pbrt:1:12: error:", "did you mean \"cie1931\""},
      {"WorldBegin\nShape \"plymesh\" \"string filename\" \"/dev/zero\"\n", "bad.pbrt:2:", "not a regular file"},
      {"WorldBegin\nLightSource \"infinite\" \"string filename\" \"/dev/zero\"\n", "bad.pbrt:2:", "not a regular file"},
      {billionInstances.c_str(), "bad.pbrt:", "multiply to more than"},
      {deepMix.c_str(), "bad.pbrt:", "256 deep"},
  };
  for (const auto& test : cases) {
    Write("bad.pbrt", test.text);
    const Outcome outcome = Run("render bad.pbrt -o out.exr");
    EXPECT_EQ(outcome.exitCode, 2) << test.text << outcome.output;
    EXPECT_NE(outcome.output.find(test.place), std::string::npos) << test.text << outcome.output;
    EXPECT_NE(outcome.output.find(test.hint), std::string::npos) << test.text << outcome.output;
    EXPECT_FALSE(fs::exists(folder_ / "out.exr")) << test.text;
  }
}

TEST_F(Cli, WarnsOnceAndStrictIsStrict) {
  Write("odd.pbrt", std::string(kScene) + "LightSource \"goniometric\"\nLightSource \"point\"\n");
  const Outcome lenient = Run("render odd.pbrt -o out.exr");
  EXPECT_EQ(lenient.exitCode, 0);
  const size_t first = lenient.output.find("odd.pbrt:8:1: warning:");
  EXPECT_NE(first, std::string::npos) << lenient.output;
  EXPECT_EQ(lenient.output.find("odd.pbrt:8:1: warning:", first + 1), std::string::npos);
  const Outcome strict = Run("render odd.pbrt -o out2.exr --strict");
  EXPECT_EQ(strict.exitCode, 2);
  EXPECT_NE(strict.output.find("odd.pbrt:8:1: error:"), std::string::npos) << strict.output;
}

TEST_F(Cli, EmptySceneIsBlackAndSaysSo) {
  Write("empty.pbrt", "Film \"rgb\" \"integer xresolution\" 4 \"integer yresolution\" 4\nWorldBegin\n");
  const Outcome outcome = Run("render empty.pbrt -o out.exr");
  EXPECT_EQ(outcome.exitCode, 0) << outcome.output;
  EXPECT_NE(outcome.output.find("no light"), std::string::npos) << outcome.output;
  const Image image = ReadImage(folder_ / "out.exr");
  for (const float value : image.data) EXPECT_EQ(value, 0.0f);
}

// If all samples of a picture were dropped, nothing is known of it, whichever integrator finds the light; the message
// names the cause.
TEST_F(Cli, APictureWithoutItsSamplesIsAnErrorThatNamesTheCause) {
  const std::string begin =
      "Film \"rgb\" \"integer xresolution\" 16 \"integer yresolution\" 16\nLookAt 0 1 3  0 0 0  0 1 0\n"
      "Camera \"perspective\" \"float fov\" 30\nWorldBegin\n";
  const std::string floor =
      "Shape \"trianglemesh\" \"point3 P\" [-5 0 -5 -5 0 5 5 0 5 5 0 -5] \"integer indices\" [0 1 2 0 2 3]\n";
  Write("filter.pbrt", begin +
                           "LightFilter \"intmult\" \"float intensity\" 1e38\nLightSource \"point\" \"rgb I\" [9000 "
                           "9000 9000] \"point3 from\" [0 2 1]\n" +
                           floor);
  Write("light.pbrt", begin + "LightSource \"point\" \"rgb I\" [1e37 1e37 1e37] \"point3 from\" [0 0.01 0]\n" + floor);
  for (const char* integrator : {"path", "light", "bdpt", "sppm", "vcm"}) {
    for (const char* scene : {"filter", "light"}) {
      const std::string command = std::string("render ") + scene +
                                  ".pbrt --spp 16 -o a.exr --stats a.json --integrator " + integrator +
                                  " --target-error 0.1";
      const Outcome outcome = Run(command);
      SCOPED_TRACE(command + "\n" + outcome.output);
      EXPECT_EQ(outcome.exitCode, 1);
      EXPECT_NE(outcome.output.find("relative error unknown"), std::string::npos);
      EXPECT_NE(Read("a.json").find("\"relativeError\": null"), std::string::npos);
      EXPECT_TRUE(fs::exists(folder_ / "a.exr"));
      const char* const cause = scene == std::string("filter") ? "filter.pbrt:5:1: error: this LightFilter gives values"
                                                               : "light.pbrt:5:1: error: this light gives values";
      EXPECT_NE(outcome.output.find(cause), std::string::npos);
      EXPECT_NE(outcome.output.find("samples were dropped: the picture is wrong"), std::string::npos);
    }
  }
}

TEST_F(Cli, InterruptWritesTheImageAndExitsWithTheSignal) {
  for (const auto& [signal, exitCode] : {std::pair(SIGINT, 130), std::pair(SIGTERM, 143)}) {
    LampyrProcess render(folder_, "render scene.pbrt -o stopped.exr --spp 100000000 --quiet");
    std::this_thread::sleep_for(std::chrono::milliseconds(1500));
    EXPECT_EQ(render.Kill(signal), exitCode);
    EXPECT_GT(std::stoi(ReadImage(folder_ / "stopped.exr").metadata.at("lampyr.samplesPerPixel")), 1);
    fs::remove(folder_ / "stopped.exr");
  }
}

TEST_F(Cli, ComparesIntegrators) {
  const std::string command =
      "compare scene.pbrt --integrators path,bdpt --budget 0.1s,0.2s --spp 2,8 --repeat 2 --reference-time 1s -o "
      "report";
  const Outcome outcome = Run(command);
  ASSERT_EQ(outcome.exitCode, 0) << outcome.output;
  for (const char* text : {"reference: report/reference.exr, made", "chosen", "relMSE (95 %)", "noise (95 %)", "bias\n",
                           "time to an error", "the efficiency of path in relMSE"}) {
    EXPECT_NE(outcome.output.find(text), std::string::npos) << text << " in " << outcome.output;
  }
  const std::string csv = Read("report/results.csv");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 1 + 2 * 4) << csv;
  EXPECT_NE(csv.find("\nscene.pbrt,bdpt,samples,8,2,"), std::string::npos) << csv;
  for (const char* key : {"\"origin\": \"made\"", "\"noise\"", "\"spectrum\"", "\"biasIsLimit\": false",
                          "\"timeToError\"", "\"relEfficiency\"", "\"repeats\": 2"}) {
    EXPECT_NE(Read("report/results.json").find(key), std::string::npos) << key;
  }
  EXPECT_EQ(ReadImage(folder_ / "report/path-0.2s.png").width, 32);
  EXPECT_TRUE(fs::exists(folder_ / "report/bdpt-8spp.png"));
  EXPECT_TRUE(fs::exists(folder_ / "report/reference.png"));
  const std::string page = Read("report/report.html");
  EXPECT_NE(page.find("data:image/png;base64,iVBORw0KGgo"), std::string::npos);
  EXPECT_EQ(page.find("/*LAMPYR-"), std::string::npos);
  // The reference is there already, and becomes one that is given.
  EXPECT_NE(Run(command).output.find("kept from before"), std::string::npos);
  fs::copy(folder_ / "report/reference.exr", folder_ / "given.exr");
  const Outcome given = Run("compare scene.pbrt --integrators bdpt --spp 1 --repeat 2 --reference given.exr -o other");
  EXPECT_EQ(given.exitCode, 0) << given.output;
  EXPECT_NE(given.output.find("given.exr, given"), std::string::npos) << given.output;
  EXPECT_FALSE(fs::exists(folder_ / "other/reference.exr"));
}

// Only merged photons find the caustic in the mirror: the reference says what that blurs, and keeps it.
TEST_F(Cli, TellsTheBlurOfTheReference) {
  Write("mirror.pbrt", R"(LookAt 0 1.2 -1  0 0.2 1.5  0 1 0
Film "rgb" "integer xresolution" 24 "integer yresolution" 24
Camera "perspective" "float fov" 42
Integrator "path" "integer maxdepth" 5
WorldBegin
LightSource "point" "rgb I" [9 9 9] "point3 from" [0.4 2.5 0]
Material "diffuse"
Shape "trianglemesh" "point3 P" [-2.5 0 -2.5  -2.5 0 2.5  2.5 0 2.5  2.5 0 -2.5] "integer indices" [0 1 2 0 2 3]
Material "conductor" "rgb reflectance" [ 0.9 0.9 0.9 ]
Shape "bilinearmesh" "point3 P" [ -2 0 1.5  2 0 1.5  -2 3 1.5  2 3 1.5 ]
Material "dielectric" "float eta" 1.5
Translate 0 0.6 0 Shape "sphere" "float radius" 0.5
)");
  const std::string command =
      "compare mirror.pbrt --integrators path,vcm --budget 0.5s --repeat 2 --reference-time 2s -o mirror";
  for (const char* origin : {"made", "kept from before"}) {
    const Outcome outcome = Run(command);
    ASSERT_EQ(outcome.exitCode, 0) << outcome.output;
    for (const char* text : {origin, "photons are merged within", "the bias of this is an error of", "with blur: vcm"})
      EXPECT_NE(outcome.output.find(text), std::string::npos) << text << " in " << outcome.output;
    EXPECT_EQ(Read("mirror/results.json").find("\"bias\": 0.0,\n    \"biasIsLimit\""), std::string::npos);
  }
}

TEST_F(Cli, RefusesToCompareWhatCannotBe) {
  const auto expect = [&](const std::string& arguments, const std::string& message) {
    const Outcome outcome = Run("compare scene.pbrt -o report " + arguments);
    EXPECT_EQ(outcome.exitCode, 2) << arguments << "\n" << outcome.output;
    EXPECT_NE(outcome.output.find(message), std::string::npos) << outcome.output;
  };
  expect("--integrators path,bdtp", "did you mean \"bdpt\"?");
  expect("--integrators path,path", "path is named twice");
  expect("--integrators path,light:adaptive", "light follows no camera paths");
  expect("--budget 5s,soon", "--budget: \"soon\" is not a duration");
  expect("--repeat 1", "--repeat");
  expect("--spp 0", "--spp");
  expect("--reference none.exr", "none.exr");
  ASSERT_EQ(Run("render scene.pbrt --resolution 16x10 -o small.exr --quiet").exitCode, 0);
  expect("--reference small.exr", "has 16×10 pixels, and the scene is rendered with 32×20");
  ASSERT_EQ(Run("render scene.pbrt --integrator light --spp 2 -o coarse.exr --quiet").exitCode, 0);
  for (const std::string integrators : {"path", "path,vcm"}) {
    expect("--reference coarse.exr --integrators " + integrators + " --budget 1s",
           "noisier than all that would be measured");
  }
  // A list ends at its commas: the scene may follow.
  EXPECT_NE(Run("compare --spp 1,2 none.pbrt").output.find("none.pbrt"), std::string::npos);
  Write("file", "");
  EXPECT_EQ(Run("compare scene.pbrt -o file").exitCode, 2);
}

TEST_F(Cli, AComparisonThatIsInterruptedEarlyLeavesNoResults) {
  LampyrProcess compare(folder_, "compare scene.pbrt -o early --budget 60s --quiet");
  for (int i = 0; i < 300 && !fs::exists(folder_ / "early"); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  std::this_thread::sleep_for(std::chrono::milliseconds(1000));
  EXPECT_EQ(compare.Kill(SIGINT), 130);
  EXPECT_TRUE(fs::is_empty(folder_ / "early"));
}

TEST_F(Cli, AnInterruptedComparisonIsWholeOrAbsent) {
  LampyrProcess compare(folder_,
                        "compare scene.pbrt -o stopped --budget 0.1s --repeat 1000 --reference-time 0.5s --quiet");
  // When the reference is there, repeats are under way; each takes a fifth of a second.
  for (int i = 0; i < 300 && !fs::exists(folder_ / "stopped/reference.exr"); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  std::this_thread::sleep_for(std::chrono::milliseconds(4000));
  EXPECT_EQ(compare.Kill(SIGINT), 130);
  EXPECT_NE(Read("stopped/results.json").find("\"repeats\": "), std::string::npos);
  EXPECT_EQ(Read("stopped/results.json").find("\"repeats\": 1000"), std::string::npos);
}

TEST_F(Cli, RendersWhenNobodyReadsTheMessages) {
  Write("odd.pbrt", std::string(kScene) + "LightSource \"goniometric\"\n");
  Run("render odd.pbrt -o unread.exr 2>&1 | true");
  EXPECT_TRUE(fs::exists(folder_ / "unread.exr"));
}

TEST_F(Cli, ANameThatCannotBeWrittenIsRefusedAndLeavesNothing) {
  // The image's name is as long as names may be, that of the file written aside is longer.
  const std::string name = "busy" + std::string(247, 'x') + ".exr";
  const Outcome outcome = Run("render scene.pbrt -o " + name + " --quiet");
  EXPECT_EQ(outcome.exitCode, 2) << outcome.output;
  EXPECT_NE(outcome.output.find("File name too long"), std::string::npos) << outcome.output;
  for (const auto& entry : fs::directory_iterator(folder_)) {
    EXPECT_EQ(entry.path().filename().string().find("busy"), std::string::npos) << "a part of an image was left behind";
  }
  EXPECT_NE(Run("render scene.pbrt -o .exr").output.find("has no name before its ending"), std::string::npos);
  EXPECT_NE(Run("render scene.pbrt --spp 1 --stats /dev/stdout 2>&1 | cat").output.find("it is a device or a pipe"),
            std::string::npos);
}

// pbrt-v4: "Ignoring area light specification".
TEST_F(Cli, InterfacesEmitNothing) {
  Write("interface.pbrt",
        "Film \"rgb\" \"integer xresolution\" 4 \"integer yresolution\" 4\nWorldBegin\n"
        "AreaLightSource \"diffuse\"\nMaterial \"interface\"\n"
        "Shape \"sphere\" \"float radius\" 5\nReverseOrientation\nShape \"sphere\"\n");
  const Outcome outcome = Run("render interface.pbrt -o out.exr");
  EXPECT_EQ(outcome.exitCode, 0) << outcome.output;
  EXPECT_NE(outcome.output.find("interface.pbrt:5:1: warning:"), std::string::npos) << outcome.output;
  EXPECT_NE(outcome.output.find("1 more like this: a shape of material"), std::string::npos) << outcome.output;
  for (const float value : ReadImage(folder_ / "out.exr").data) EXPECT_EQ(value, 0.0f);
}

// As in pbrt-v4: an Attribute applies to all following statements, some of which have no such parameter.
TEST_F(Cli, AttributesOfLightsMayBeForOthers) {
  Write("lights.pbrt", std::string(kScene) +
                           "Attribute \"light\" \"float illuminance\" 2 \"float power\" 3\n"
                           "LightSource \"point\"\nLightSource \"distant\"\n"
                           "AreaLightSource \"diffuse\"\nShape \"sphere\"\n");
  EXPECT_EQ(Run("render lights.pbrt -o out.exr --quiet --strict").output, "");
}

TEST_F(Cli, TheFilmsDiagonalIsNothingToWarnOf) {
  Write("film.pbrt",
        "Film \"rgb\" \"float diagonal\" 35 \"integer xresolution\" 4 \"integer yresolution\" 4\n"
        "WorldBegin\nLightSource \"infinite\"\n");
  EXPECT_EQ(Run("render film.pbrt -o out.exr --quiet --strict").output, "");
}

TEST_F(Cli, DiffTellsEqualFromDifferent) {
  ASSERT_EQ(Run("render scene.pbrt -o a.exr --spp 64 --sampler independent --quiet").exitCode, 0);
  ASSERT_EQ(Run("render scene.pbrt -o b.exr --spp 64 --sampler independent --seed 5 --quiet").exitCode, 0);
  Outcome outcome = Run("diff a.exr b.exr");
  EXPECT_EQ(outcome.exitCode, 0);
  EXPECT_NE(outcome.output.find("agree"), std::string::npos) << outcome.output;
  Write("brighter.pbrt",
        std::string(kScene) + "LightSource \"point\" \"rgb I\" [0.4 0.4 0.4] \"point3 from\" [0 2 1]\n");
  ASSERT_EQ(Run("render brighter.pbrt -o c.exr --spp 64 --sampler independent --quiet").exitCode, 0);
  outcome = Run("diff c.exr a.exr");
  EXPECT_NE(outcome.output.find("DIFFER"), std::string::npos) << outcome.output;
  outcome = Run("diff a.exr a.exr --json");
  EXPECT_NE(outcome.output.find("\"mse\": 0.0"), std::string::npos) << outcome.output;
  EXPECT_NE(outcome.output.find("\"verdict\": \"equal\""), std::string::npos) << outcome.output;
  EXPECT_EQ(Run("diff a.exr b.exr --fail").exitCode, 0);
  EXPECT_EQ(Run("diff a.exr a.exr --fail").exitCode, 0);
  EXPECT_EQ(Run("diff c.exr a.exr --fail").exitCode, 1);
  EXPECT_EQ(Run("diff c.exr a.exr --fail --json").exitCode, 1);
}

// One sample has no variance, and nothing has none to speak of: neither is an agreement.
TEST_F(Cli, DiffSaysWhereItCannotSay) {
  ASSERT_EQ(Run("render scene.pbrt -o a.exr --spp 1 --quiet").exitCode, 0);
  ASSERT_EQ(Run("render scene.pbrt -o b.exr --spp 1 --seed 5 --quiet").exitCode, 0);
  ASSERT_EQ(Run("render scene.pbrt -o c.exr --spp 16 --quiet").exitCode, 0);
  const auto expect = [&](const std::string& images, const std::string& text) {
    const Outcome outcome = Run("diff --fail " + images);
    EXPECT_EQ(outcome.exitCode, 1) << outcome.output;
    EXPECT_NE(outcome.output.find("z-test   cannot say: " + text), std::string::npos) << outcome.output;
  };
  expect("a.exr b.exr", "both images have one sample per pixel, whose variance is not known");
  expect("c.exr b.exr", "the second image has one sample per pixel");
  Write("dark.pbrt", "Film \"rgb\" \"integer xresolution\" 16 \"integer yresolution\" 16\nWorldBegin\n");
  ASSERT_EQ(Run("render dark.pbrt -o black.exr --spp 4 --quiet").exitCode, 0);
  expect("black.exr black.exr", "both images are black");
}

TEST_F(Cli, DiffWritesTheErrorImage) {
  ASSERT_EQ(Run("render scene.pbrt -o a.exr --spp 4 --quiet").exitCode, 0);
  ASSERT_EQ(Run("render scene.pbrt -o b.exr --spp 4 --seed 5 --quiet").exitCode, 0);
  ASSERT_EQ(Run("diff a.exr b.exr -o error.exr").exitCode, 0);
  const Image a = ReadImage(folder_ / "a.exr"), b = ReadImage(folder_ / "b.exr"),
              error = ReadImage(folder_ / "error.exr");
  double squares = 0;
  for (int y = 0; y < a.height; ++y) {
    for (int x = 0; x < a.width; ++x) {
      const Color d = error.RgbAt(x, y);
      EXPECT_FLOAT_EQ(d.g, std::abs(a.RgbAt(x, y).g - b.RgbAt(x, y).g));
      squares += static_cast<double>(d.r * d.r + d.g * d.g + d.b * d.b);
    }
  }
  EXPECT_GT(squares, 0);
  EXPECT_GE(error.ChannelIndex("relative.Y"), 0);
  EXPECT_EQ(Run("diff a.exr b.exr -o error.png").exitCode, 2);
  EXPECT_EQ(Run("diff a.exr b.exr -o none/error.exr").exitCode, 2);
  const std::string before = Read("a.exr");
  for (const char* output : {"a.exr", "./b.exr"}) {
    const Outcome outcome = Run(std::string("diff a.exr b.exr -o ") + output);
    EXPECT_EQ(outcome.exitCode, 2);
    EXPECT_NE(outcome.output.find("it would be lost"), std::string::npos) << outcome.output;
  }
  EXPECT_EQ(Read("a.exr"), before);
}

// Bands of the spectrum are in the picture, in those of parts that are merged, and after a render goes on.
TEST_F(Cli, BandsOfTheSpectrum) {
  std::string text = kScene;
  text.replace(text.find("\"rgb\""), 5, "\"spectral\" \"float lambdamin\" 400 \"float lambdamax\" 700");
  Write("bands.pbrt", text);
  const auto channelsOf = [&](const std::string& name) {
    std::vector<std::string> bands;
    for (const std::string& channel : ReadImage(folder_ / name).channels) {
      if (channel.starts_with("S0.")) bands.push_back(channel);
    }
    return bands;
  };
  ASSERT_EQ(Run("render bands.pbrt -o a.exr --quiet").exitCode, 0);
  EXPECT_EQ(channelsOf("a.exr").size(), 16u);
  EXPECT_EQ(channelsOf("a.exr").front(), "S0.409,375nm");
  EXPECT_EQ(channelsOf("a.exr").back(), "S0.690,625nm");
  EXPECT_EQ(ReadImage(folder_ / "a.exr").metadata.at("spectralLayoutVersion"), "1.0");
  ASSERT_EQ(Run("render scene.pbrt -o b.exr --quiet --spectral-bands 4").exitCode, 0);
  EXPECT_EQ(channelsOf("b.exr"),
            (std::vector<std::string>{"S0.418,750nm", "S0.536,250nm", "S0.653,750nm", "S0.771,250nm"}));
  ASSERT_EQ(Run("render bands.pbrt -o none.exr --quiet --no-spectral").exitCode, 0);
  EXPECT_TRUE(channelsOf("none.exr").empty());
  EXPECT_EQ(Run("render bands.pbrt -o none.exr --no-spectral --spectral-bands 4").exitCode, 2);
  EXPECT_NE(Run("plan bands.pbrt").output.find("16 bands of the spectrum from 400 to 700 nm"), std::string::npos);
  // Parts, and a render that goes on.
  const std::string options = " --quiet --integrator bdpt --no-guide-paths --spp ";
  ASSERT_EQ(Run("render bands.pbrt -o whole.exr" + options + "8").exitCode, 0);
  for (const char* part : {"1/2", "2/2"})
    ASSERT_EQ(
        Run("render bands.pbrt -o part" + std::string(1, part[0]) + ".exr --shard " + part + options + "8").exitCode,
        0);
  ASSERT_EQ(Run("merge part1.exr part2.exr -o merged.exr --quiet").exitCode, 0);
  EXPECT_EQ(channelsOf("merged.exr"), channelsOf("whole.exr"));
  const Image whole = ReadImage(folder_ / "whole.exr"), merged = ReadImage(folder_ / "merged.exr");
  for (size_t i = 0; i < whole.data.size(); ++i)
    ASSERT_NEAR(merged.data[i], whole.data[i], 1e-5f * (1 + std::abs(whole.data[i])));
  ASSERT_EQ(Run("render bands.pbrt -o on.exr --resume" + options + "3").exitCode, 0);
  ASSERT_EQ(Run("render bands.pbrt -o on.exr --resume" + options + "8").exitCode, 0);
  EXPECT_EQ(ReadImage(folder_ / "on.exr").data, whole.data);
  const Outcome other = Run("render bands.pbrt -o on.exr --resume --spectral-bands 5" + options + "8");
  EXPECT_EQ(other.exitCode, 2);
  EXPECT_NE(other.output.find("bands of the spectrum"), std::string::npos) << other.output;
}

TEST_F(Cli, AnswersThatCannotBeWrittenAreAFailure) {
  EXPECT_EQ(Run("lights > /dev/full").exitCode, 1);
}

TEST_F(Cli, ListsLights) {
  const Outcome all = Run("lights");
  EXPECT_EQ(all.exitCode, 0);
  for (const char* name : {"LightSource \"point\"", "LightSource \"spot\"", "LightSource \"distant\"",
                           "LightSource \"infinite\"", "AreaLightSource \"diffuse\""}) {
    EXPECT_NE(all.output.find(name), std::string::npos) << name;
  }
  const Outcome one = Run("lights spot");
  EXPECT_NE(one.output.find("coneangle"), std::string::npos) << one.output;
  EXPECT_EQ(one.output.find("\"distant\""), std::string::npos);
}

// All types together are the pdf suite's own test, which takes minutes.
// A type's own parameters come first, then those of all lights; nothing is wider than the terminal.
TEST_F(Cli, ListsOneTypeWithinTheTerminal) {
  const Outcome wide = Run("lights spot");
  const size_t own = wide.output.find("coneangle"), common = wide.output.find("common to all lights");
  const size_t exposure = wide.output.find("float exposure");
  ASSERT_NE(own, std::string::npos) << wide.output;
  ASSERT_NE(common, std::string::npos) << wide.output;
  EXPECT_LT(own, common);
  EXPECT_LT(common, exposure);
  for (const std::string arguments : {"lights spot", "lights", "plan scene.pbrt"}) {
    const Outcome narrow = test::RunLampyr(folder_, arguments, "COLUMNS=40");
    EXPECT_EQ(narrow.exitCode, 0);
    std::istringstream lines(narrow.output);
    for (std::string line; std::getline(lines, line);) {
      const bool isOneWord = line.find(' ', line.find_first_not_of(' ')) == std::string::npos;
      EXPECT_TRUE(line.size() <= 52 || isOneWord) << arguments << ": " << line;
    }
  }
}

TEST_F(Cli, MakesAPngOfAnImage) {
  ASSERT_EQ(Run("render scene.pbrt -o out.exr --png --quiet").exitCode, 0);
  const std::string beside = Read("out.png");
  ASSERT_EQ(Run("png out.exr -o a.png").output, "a.png: 32×20\n");
  EXPECT_EQ(Read("a.png"), beside);
  ASSERT_EQ(Run("png out.exr -o b.png --exposure 1 --clip --quiet").output, "");
  EXPECT_NE(Read("b.png"), beside);
  ASSERT_EQ(Run("png out.exr --quiet --exposure 1 --clip").exitCode, 0);
  EXPECT_EQ(Read("out.png"), Read("b.png"));
  EXPECT_EQ(Run("png b.png").exitCode, 2);  // onto itself
  EXPECT_EQ(Run("png scene.pbrt").exitCode, 2);
  EXPECT_EQ(Run("png absent.exr").exitCode, 2);
  EXPECT_EQ(Run("png out.exr -o out.jpg").exitCode, 2);
  EXPECT_EQ(Run("png out.exr -o nowhere/out.png").exitCode, 2);
}

// A scene that names another integrator than suits it is rendered as it says, and said to.
TEST_F(Cli, SaysWhenAnotherIntegratorSuitsTheScene) {
  const std::string mirror = "Material \"conductor\" \"float roughness\" 0\nShape \"sphere\" \"float radius\" 0.3\n";
  Write("named.pbrt", std::string("Integrator \"volpath\"\n") + kScene + mirror);
  Write("open.pbrt", kScene + mirror);
  const std::string plan = Run("plan open.pbrt").output;
  const std::string suits = plan.find("integrator       vcm ") != std::string::npos ? "vcm" : "bdpt";
  Write("suited.pbrt", "Integrator \"" + suits + "\"\n" + kScene + mirror);
  const std::string hint =
      "hint: the scene names path; --integrator auto would render with " + suits + ": least error in";
  EXPECT_NE(Run("render named.pbrt -o a.exr").output.find(hint), std::string::npos);
  for (const std::string arguments : {"named.pbrt --quiet", "named.pbrt --integrator path", "open.pbrt"})
    EXPECT_EQ(Run("render " + arguments + " -o a.exr").output.find("would render with"), std::string::npos)
        << arguments;
  // The integrator suits, and other counts of light paths do better.
  EXPECT_NE(Run("render suited.pbrt -o a.exr").output.find("would render with " + suits + ": "), std::string::npos);
  const std::string note =
      "The scene names path: `lampyr render` renders with path, and with " + suits + " by --integrator auto.";
  EXPECT_NE(Run("plan named.pbrt").output.find(note), std::string::npos) << Run("plan named.pbrt").output;
  EXPECT_EQ(Run("plan suited.pbrt").output.find("The scene names"), std::string::npos);
}

TEST_F(Cli, ChecksTheLightsOfOneType) {
  const Outcome outcome = Run("check-lights --type spot");
  EXPECT_EQ(outcome.exitCode, 0) << outcome.output;
  for (const char* word : {"spot[0]", "directions", "emission-edge", "irradiance", "power", " cases, 0 of "})
    EXPECT_NE(outcome.output.find(word), std::string::npos) << word;
  EXPECT_EQ(outcome.output.find("FAILED"), std::string::npos);
  EXPECT_EQ(outcome.output.find("rect["), std::string::npos);
  EXPECT_EQ(outcome.output.find("filter "), std::string::npos);
}

// The name of the scene is that of the picture, whatever dots it has.
TEST_F(Cli, PicturesOfFramesHaveTheirNumbers) {
  Write("shot.1.pbrt", kScene);
  Write("shot.2.pbrt", kScene);
  for (const char* scene : {"shot.1.pbrt", "shot.2.pbrt"})
    ASSERT_EQ(Run(std::string("render ") + scene + " --quiet --spp 1").exitCode, 0);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "shot.1.exr"));
  EXPECT_TRUE(std::filesystem::exists(folder_ / "shot.2.exr"));
}

// Lights of several patches, of which one is selected, and a light beside them.
TEST_F(Cli, ChecksTheLightsOfAScene) {
  Write("lit.pbrt",
        "WorldBegin\nLightSource \"point\" \"point3 from\" [ 0 3 0 ]\nAreaLightSource \"diffuse\"\nShape "
        "\"trianglemesh\" \"point3 P\" [ -1 0 -1  1 0 -1  1 0 1  -1 0 1 ] \"integer indices\" [ 0 1 2 0 2 3 ]\n");
  const Outcome outcome = Run("check-lights lit.pbrt");
  EXPECT_EQ(outcome.exitCode, 0) << outcome.output;
  EXPECT_NE(outcome.output.find("all lights"), std::string::npos);
  EXPECT_EQ(Run("check-lights lit.pbrt --type spot").exitCode, 2);
  // Several choices at a vertex, by "lightsamples" and by "fixedSampleCount".
  Write("counted.pbrt",
        "Integrator \"path\" \"integer lightsamples\" 2 WorldBegin\nLightSource \"point\" \"point3 from\" [ 0 3 0 ]\n"
        "LightSource \"point\" \"point3 from\" [ 1 3 0 ] \"integer fixedSampleCount\" 2\nLightSource \"point\"\n"
        "AreaLightSource \"diffuse\" \"integer fixedSampleCount\" 1\nShape \"trianglemesh\" \"point3 P\" "
        "[ -1 0 -1  1 0 -1  1 0 1  -1 0 1 ] \"integer indices\" [ 0 1 2 0 2 3 ]\n");
  const Outcome counted = Run("check-lights counted.pbrt");
  EXPECT_EQ(counted.exitCode, 0) << counted.output;
}

// Two seeds of one scene agree, although each splat is in several pixels.
TEST_F(Cli, DiffKnowsThatSplatsShareTheirNoise) {
  Write("splats.pbrt",
        "LookAt 0 2 -3  0 0 0  0 1 0 Camera \"perspective\" \"float fov\" 40\nFilm \"rgb\" \"integer xresolution\" "
        "48 \"integer yresolution\" 48\nWorldBegin\nLightSource \"point\" \"point3 from\" [ 0 3 0 ]\nShape "
        "\"trianglemesh\" \"point3 P\" [ -4 0 -4  4 0 -4  4 0 4  -4 0 4 ] \"integer indices\" [ 0 1 2 0 2 3 ]\n");
  for (int i = 0; i < 8; ++i) {
    const std::string seed = std::to_string(i);
    ASSERT_EQ(
        Run("render splats.pbrt --quiet --integrator light --spp 16 --seed " + seed + " -o " + seed + ".exr").exitCode,
        0);
    if (i % 2 == 0) continue;
    const Outcome outcome = Run("diff " + std::to_string(i - 1) + ".exr " + seed + ".exr --fail");
    EXPECT_EQ(outcome.exitCode, 0) << outcome.output;
  }
}

TEST_F(Cli, ChecksTheFiltersOfOneType) {
  const Outcome outcome = Run("check-lights --type barn");
  EXPECT_EQ(outcome.exitCode, 0) << outcome.output;
  for (const char* word : {"ok     filter barn[0]", "filter barn[1]", "combine", "placement", " cases, 0 of 34 "})
    EXPECT_NE(outcome.output.find(word), std::string::npos) << word;
  EXPECT_EQ(outcome.output.find("gobo["), std::string::npos);
  const Outcome json = Run("check-lights --type barn --json");
  EXPECT_NE(json.output.find("\"light\": \"filter barn[1]\""), std::string::npos) << json.output;
  const Outcome unknown = Run("check-lights --type gobbo");
  EXPECT_EQ(unknown.exitCode, 2);
  EXPECT_NE(unknown.output.find("there is no light or filter \"gobbo\" (did you mean \"gobo\"?)"), std::string::npos)
      << unknown.output;
}

}  // namespace
}  // namespace lampyr
