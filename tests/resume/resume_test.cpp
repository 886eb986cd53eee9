// Going on with a render: more samples, after a signal; and what is refused.
#include <chrono>
#include <cstring>
#include <span>
#include <thread>

#include "base/version.h"
#include "film/image.h"
#include "render/render_part.h"
#include "resume/resume_fixture.h"

namespace lampyr::test {
namespace {

const std::string kRender = "render scene.pbrt --quiet -o out.exr --resume ";

TEST_F(Resume, MoreSamplesAreThoseOfOneRender) {
  for (const char* integrator : {"path", "light", "bdpt", "sppm", "vcm", "path --guide-always", "bdpt --guide-always",
                                 "vcm --guide-always --adaptive", "path --adaptive", "bdpt --adaptive --denoise",
                                 "sppm --adaptive", "vcm --adaptive", "auto --adaptive"}) {
    const std::string chosen = std::string("--integrator ") + integrator;
    Do("render scene.pbrt --quiet -o whole.exr --spp 24 " + chosen);
    for (const char* samples : {"1", "5", "24"}) Do(kRender + chosen + " --spp " + samples);
    EXPECT_EQ(Bytes("out.exr"), Bytes("whole.exr")) << integrator;
    std::filesystem::remove(folder_ / "out.checkpoint");
  }
}

// A render with a target ends at the same sample, however its passes are divided.
TEST_F(Resume, ATargetIsReachedAtTheSameSample) {
  const std::string target = "render scene.pbrt --quiet --integrator path --target-error 0.5 ";
  Do(target + "-o whole.exr");
  Do(target + "-o often.exr --checkpoint 0.005s");
  Do(kRender + "--integrator path --spp 37");
  Do(target + "-o out.exr --resume");
  const std::string samples = ReadImage(folder_ / "whole.exr").metadata.at("lampyr.samplesPerPixel");
  EXPECT_GT(std::stoi(samples), 45) << samples;
  std::printf("[   info   ] %s samples\n", samples.c_str());
  for (const char* name : {"often.exr", "out.exr"}) {
    EXPECT_EQ(ReadImage(folder_ / name).metadata.at("lampyr.samplesPerPixel"), samples) << name;
    EXPECT_EQ(Bytes(name), Bytes("whole.exr")) << name;
  }
}

TEST_F(Resume, WithoutACheckpointItStartsAnew) {
  const Outcome outcome = Run("render scene.pbrt -o out.exr --resume --spp 2");
  EXPECT_EQ(outcome.exitCode, 0);
  EXPECT_NE(outcome.output.find("there is no \"out.checkpoint\" to go on with: starts anew"), std::string::npos)
      << outcome.output;
  EXPECT_TRUE(Exists("out.checkpoint"));
  const Outcome again = Run("render scene.pbrt -o out.exr --resume --spp 4 --stats stats.json");
  EXPECT_NE(again.output.find("out.checkpoint: goes on after 2 spp"), std::string::npos) << again.output;
  EXPECT_NE(Bytes("stats.json").find("\"resumedSamplesPerPixel\": 2"), std::string::npos);
}

TEST_F(Resume, TimeCountsOn) {
  const auto samples = [&] { return std::stod(ReadImage(folder_ / "out.exr").metadata.at("lampyr.samplesPerPixel")); };
  Do(kRender + "--time 2s");
  const double first = samples();
  Do(kRender + "--time 2s");
  EXPECT_LT(samples(), 1.5 * first);  // the time is over already
}

// A render that would take hours on any machine: it continues from where it was, and a little farther.
TEST_F(Resume, GoesOnAfterASignal) {
  const std::string render = "render scene.pbrt --quiet --integrator bdpt ";
  uint64_t samples = 0;
  for (const auto& [signal, exitCode] : {std::pair(SIGTERM, 143), std::pair(SIGINT, 130)}) {
    LampyrProcess process(folder_.Path(), render + "--spp 10000000 -o out.exr --checkpoint 0.2s --resume");
    const std::filesystem::path checkpoint = folder_ / "out.checkpoint";
    std::error_code ignored;
    const auto before = std::filesystem::last_write_time(checkpoint, ignored);
    for (int i = 0; i < 6000 && (!std::filesystem::exists(checkpoint) ||
                                 std::filesystem::last_write_time(checkpoint, ignored) == before);
         ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    EXPECT_EQ(process.Kill(signal), exitCode);
    const PartReader part(folder_ / "out.checkpoint", PartKind::Checkpoint);
    EXPECT_GT(part.Header().samples, samples);
    samples = part.Header().samples;
    EXPECT_EQ(std::to_string(samples), ReadImage(folder_ / "out.exr").metadata.at("lampyr.samplesPerPixel"));
  }
  const std::string all = "--spp " + std::to_string(samples + 10);
  Do(render + all + " -o out.exr --resume");
  Do(render + all + " -o whole.exr");
  EXPECT_EQ(Bytes("out.exr"), Bytes("whole.exr"));
}

// The limit of photons shows in the picture: it is part of what a render is, and the same on all machines.
TEST_F(Resume, TheMemoryForPhotonsIsPartOfTheRender) {
  Do(kRender + "--spp 1 --integrator vcm");
  ExpectRefused(kRender + "--spp 2 --integrator vcm --photon-memory 1M", 2,
                "is of another render: --photon-memory is 4294967296 there and 1048576 here");
  Do(kRender + "--spp 2 --integrator vcm --photon-memory 4G");
  // On a machine of less memory it is the same render.
  const Outcome little =
      RunLampyr(folder_.Path(), kRender + "--spp 3 --integrator vcm --threads 1", "ulimit -v 800000;");
  EXPECT_EQ(little.exitCode, 0) << little.output;
  Do("render scene.pbrt --quiet -o whole.exr --spp 3 --integrator vcm");
  EXPECT_TRUE(Bytes("whole.exr") == Bytes("out.exr"));
}

// The contents of a lens file are part of the identity of a render.
TEST_F(Resume, ALensIsPartOfTheRender) {
  const auto write = [&](const char* thickness) {
    WriteBytes(folder_ / "lens.dat", std::string("0 2 0 10\n50 ") + thickness + " 1.5 20\n-50 40 1 20\n");
  };
  std::string scene = kScene;
  const std::string pinhole = "\"perspective\" \"float fov\" 40";
  scene.replace(scene.find(pinhole), pinhole.size(),
                "\"realistic\" \"string lensfile\" \"lens.dat\" \"float aperturediameter\" 5");
  WriteBytes(folder_ / "scene.pbrt", scene);
  write("4");
  Do(kRender + "--spp 2");
  write("5");
  ExpectRefused(kRender + "--spp 4", 2, "what the files of the scene hold");
  write("4");
  Do(kRender + "--spp 4");
  Do("render scene.pbrt --quiet -o whole.exr --spp 4");
  EXPECT_TRUE(Bytes("whole.exr") == Bytes("out.exr"));
  ExpectRefused("render scene.pbrt --quiet -o other.exr --integrator light", 2, "path, bdpt, vcm and sppm can");
}

TEST_F(Resume, WhatIsOfAnotherRenderIsRefused) {
  Do(kRender + "--spp 4");
  const std::string image = Bytes("out.exr"), checkpoint = Bytes("out.checkpoint");
  const auto refused = [&](const std::string& options, const std::string& why) {
    ExpectRefused(kRender + options, 2, "--resume: \"out.checkpoint\" is of another render: " + why);
  };
  refused("--seed 3", "the seed is 0 there and 3 here");
  refused("--integrator bdpt", "the integrator is path there and bdpt here");
  refused("--resolution 24x16", "the resolution is 48x32 there and 24x16 here");
  refused("--crop 0,24,0,32", "the crop is 0,48,0,32 there and 0,24,0,32 here");
  refused("--max-depth 2", "--max-depth is 5 there and 2 here");
  refused("--sampler independent", "the sampler is sobol there and independent here");
  refused("--light-sampler power", "--light-sampler is tree there and power here");
  refused("--no-learn-lights", "--learn-lights is on there and off here");
  refused("--shadow-roulette 0", "--shadow-roulette is 0.05 there and 0 here");
  refused("--fast-intersection", "watertight intersection is on there and off here");
  refused("--shard 1/2", "the part is 1/1 there and 1/2 here");
  ExpectRefused(kRender + "--spp 2", 2, "holds 4 samples per pixel already, which is more than the 2");
  WriteBytes(folder_ / "floor.ply", Floor(6));
  refused("", "what the files of the scene hold");
  WriteBytes(folder_ / "floor.ply", Floor(5));
  WriteBytes(folder_ / "scene.pbrt", std::string(kScene) + "Shape \"sphere\"\n");
  refused("", "the scene's text");
  WriteBytes(folder_ / "scene.pbrt", kScene);
  // A checkpoint of another version: the same bytes except for the version's name and the checksum.
  constexpr size_t kEnd = 24, kChecksum = 16;
  std::string other = checkpoint;
  const std::string version = kVersion;
  other.replace(other.find(version), version.size(), std::string(version.size(), '9'));
  const uint32_t checksum = ChecksumOf(std::as_bytes(std::span(other).first(other.size() - kEnd)));
  std::memcpy(other.data() + other.size() - kChecksum, &checksum, sizeof checksum);
  WriteBytes(folder_ / "out.checkpoint", other);
  refused("", "the version of lampyr is 99999 there and " + version + " here");
  WriteBytes(folder_ / "out.checkpoint", checkpoint);
  EXPECT_EQ(Bytes("out.exr"), image);
  EXPECT_EQ(Bytes("out.checkpoint"), checkpoint);
  Do(kRender + "--spp 8");
}

TEST_F(Resume, ADamagedCheckpointIsRefusedAndStays) {
  Do(kRender + "--integrator vcm --spp 4");
  const std::string whole = Bytes("out.checkpoint"), image = Bytes("out.exr");
  for (size_t i = 0; i < 40; ++i) {
    std::string damaged = whole;
    const size_t at = i * 7919 % whole.size();
    if (i % 2) {
      damaged.resize(at);
    } else {
      damaged[at] = static_cast<char>(damaged[at] ^ (1 << (i / 2 % 8)));
    }
    WriteBytes(folder_ / "out.checkpoint", damaged);
    ExpectRefused(kRender + "--integrator vcm --spp 5", 1, "\"out.checkpoint\" cannot be used: ");
    EXPECT_EQ(Bytes("out.checkpoint"), damaged);
    EXPECT_EQ(Bytes("out.exr"), image);
  }
  WriteBytes(folder_ / "out.checkpoint", "");
  ExpectRefused(kRender + "--integrator vcm", 1, "it holds no sums");
  std::string later = whole;
  later.back() = '~';
  WriteBytes(folder_ / "out.checkpoint", later);
  ExpectRefused(kRender + "--integrator vcm", 1, "another version of lampyr has written it");
  std::filesystem::remove(folder_ / "out.checkpoint");
  std::filesystem::create_directory(folder_ / "out.checkpoint");
  ExpectRefused(kRender + "--integrator vcm", 2, "\"out.checkpoint\" is a folder");
}

TEST_F(Resume, DurationsAreChecked) {
  ExpectRefused("render scene.pbrt --checkpoint soon", 2, "--checkpoint: \"soon\" is not a duration");
}

}  // namespace
}  // namespace lampyr::test
