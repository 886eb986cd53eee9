// Parts of a render, merged: the bytes of the picture in one piece; and what does not belong together.
#include "film/image.h"
#include "film/metrics.h"
#include "resume/resume_fixture.h"

namespace lampyr::test {
namespace {

class Merge : public Resume {
 protected:
  // p1.exr, p2.exr, …; their names.
  std::string RenderParts(const std::string& options, int count) {
    std::string names;
    for (int i = 1; i <= count; ++i) {
      const std::string name = "p" + std::to_string(i) + ".exr",
                        shard = std::to_string(i) + "/" + std::to_string(count);
      Do("render scene.pbrt --quiet --shard " + shard + " -o " + name + " " + options);
      names = name + " " + names;  // in any order
    }
    return names;
  }
  void ExpectWhole(const std::string& options, int count) {
    Do("render scene.pbrt --quiet -o whole.exr --png " + options);
    Do("merge --quiet -o merged.exr --png " + RenderParts(options, count));
    EXPECT_EQ(Bytes("merged.exr"), Bytes("whole.exr")) << options << ", " << count << " parts";
    EXPECT_EQ(Bytes("merged.png"), Bytes("whole.png")) << options << ", " << count << " parts";
  }
};

TEST_F(Merge, HasTheBytesOfOneRender) {
  int cases = 0;
  for (const char* integrator : {"path", "bdpt", "light"}) {
    for (const int count : {2, 3, 7}) {
      ExpectWhole(std::string("--spp 16 --no-guide-paths --integrator ") + integrator, count);
      ++cases;
    }
  }
  ExpectWhole("--spp 9 --no-guide-paths --crop 5,40,3,20 --threads 3 --seed 4", 4);
  ExpectWhole("--spp 8 --no-guide-paths --sampler independent --integrator bdpt --resolution 100x60", 2);
  std::printf("[   info   ] %d pictures\n", cases + 2);
}

// Passes have the radii that they have in one piece.
TEST_F(Merge, HasTheBytesOfOneRenderWithPhotonsThatAreNotAimed) {
  for (const char* integrator : {"sppm", "vcm"})
    ExpectWhole(std::string("--spp 13 --no-guide-photons --no-guide-paths --integrator ") + integrator, 3);
}

// Each part learns for itself: another estimate of the same picture.
TEST_F(Merge, PartsThatLearnAgreeWithOneRender) {
  for (const char* settings :
       {"--integrator vcm", "--integrator path --guide-always", "--integrator bdpt --guide-always",
        "--integrator path --learn-always", "--integrator path --adaptive", "--integrator bdpt --adaptive",
        "--integrator vcm --adaptive"}) {
    const std::string options = std::string("--spp 192 --resolution 24x16 ") + settings;
    Do("merge --quiet -o merged.exr " + RenderParts(options, 3));
    Do("render scene.pbrt --quiet -o whole.exr --seed 11 " + options);
    const Image merged = ReadImage(folder_ / "merged.exr");
    EXPECT_EQ(merged.metadata.at("lampyr.samplesPerPixel"), "192");
    const ImageDifference difference = CompareImages(merged, ReadImage(folder_ / "whole.exr"));
    ASSERT_TRUE(difference.hasBlockTest);
    EXPECT_LE(difference.blockTest.largestZ, difference.blockTest.threshold) << settings;
  }
}

// The layers of what is seen first are in the parts, in their whole, and in what is resumed.
TEST_F(Merge, LayersOfTheFirstHitAreKept) {
  std::string text = kScene;
  text.replace(text.find("\"rgb\""), 5, "\"gbuffer\"");
  WriteBytes(folder_ / "scene.pbrt", text);
  ExpectWhole("--spp 8 --integrator path --no-guide-paths", 2);
  ExpectWhole("--spp 8 --integrator light", 3);
  EXPECT_GE(ReadImage(folder_ / "merged.exr").ChannelIndex("Ns.X"), 0);
}

// A manifest names all objects: it may be long.
TEST_F(Merge, ManyObjectsAreNamed) {
  std::string text = kScene;
  for (int i = 0; i < 2500; ++i) text += "Shape \"sphere\" \"float radius\" 1e-3\n";
  WriteBytes(folder_ / "scene.pbrt", text);
  ExpectWhole("--spp 2 --integrator path --no-guide-paths --layer \"crypto object\"", 2);
}

TEST_F(Merge, LayersOfWhatWasDecidedAreKept) {
  ExpectWhole("--spp 8 --integrator auto --auto-layers --no-guide-paths --no-guide-photons", 2);
  EXPECT_GE(ReadImage(folder_ / "merged.exr").ChannelIndex("auto.lightPaths"), 0);
}

// Six samples in three parts. Parts 1 and 3 hold samples 0, 1, 4 and 5; samples 0, 4 and 5 are in the half.
TEST_F(Merge, SomePartsKnowTheirHalf) {
  RenderParts("--spp 6 --denoise", 3);
  Do("merge --quiet --partial -o merged.exr p1.exr p3.exr");
  EXPECT_EQ(ReadImage(folder_ / "merged.exr").metadata.at("lampyr.halfShare"), "0.750000");
  EXPECT_EQ(ReadImage(folder_ / "p3.exr").metadata.at("lampyr.halfShare"), "1.000000");
  EXPECT_EQ(ReadImage(folder_ / "p1.exr").metadata.count("lampyr.halfShare"), 0u);
}

TEST_F(Merge, HalvesStayHalves) {
  std::string text = kScene;
  text.replace(text.find("\"rgb\""), 5, "\"rgb\" \"bool savefp16\" true");
  WriteBytes(folder_ / "scene.pbrt", text);
  ExpectWhole("--spp 4 --no-guide-paths", 2);
}

TEST_F(Merge, AMergedPictureIsOneAndAPartCanBeLookedAt) {
  Do("render scene.pbrt --quiet --shard 2/2 --spp 8");
  EXPECT_TRUE(Exists("scene.2-of-2.exr"));
  const Image part = ReadImage(folder_ / "scene.2-of-2.exr");
  EXPECT_EQ(part.metadata.at("lampyr.samplesPerPixel"), "4");
  EXPECT_EQ(part.width, 48);
  EXPECT_GE(part.ChannelIndex("lamp.R"), 0);
}

TEST_F(Merge, WhatDoesNotBelongTogetherIsRefused) {
  const std::string options = "--spp 8 ";
  RenderParts(options, 2);
  const auto other = [&](const std::string& more) {
    Do("render scene.pbrt --quiet -o other.exr --shard 2/2 " + options + more);
  };
  const auto refused = [&](const std::string& parts, const std::string& why) {
    ExpectRefused("merge -o merged.exr " + parts, 1, why);
    EXPECT_FALSE(Exists("merged.exr"));
  };
  other("--seed 5");
  refused("p1.exr other.exr", "\"p1.exr\" and \"other.exr\" do not belong together: the seed is 0 there and 5 here");
  other("--integrator bdpt");
  refused("p1.exr other.exr", "the integrator is path there and bdpt here");
  other("--resolution 32x32");
  refused("p1.exr other.exr", "the resolution is 48x32 there and 32x32 here");
  refused("p1.exr p2.exr p1.exr", "\"p1.exr\" and \"p1.exr\" hold the same samples");
  refused("p2.exr", "the picture is not whole: part 1/2 is missing");
  Do("render scene.pbrt --quiet -o third.exr --shard 1/3 --spp 12");
  refused("p2.exr third.exr", "they are of 8 samples in 2 parts and of 12 samples in 3 parts");
  Do("render scene.pbrt --quiet -o third.exr --shard 1/2 --spp 12");
  refused("p2.exr third.exr", "they are of 8 samples in 2 parts and of 12 samples in 2 parts");
  Do("render scene.pbrt --quiet -o plain.exr --spp 8");
  refused("p1.exr plain.exr", "\"plain.exr\" cannot be used: it holds no sums");
  Do("render scene.pbrt --quiet -o plain.exr --spp 8 --checkpoint 1h");
  refused("p1.exr plain.checkpoint", "it is a checkpoint and not a part of a picture");
  refused("p1.exr none.exr", "cannot read \"none.exr\": No such file or directory");
  refused("p1.exr floor.ply", "\"floor.ply\" cannot be used: it holds no sums");
  WriteBytes(folder_ / "p2.exr", Bytes("p2.exr").substr(0, 4000));
  refused("p1.exr p2.exr", "\"p2.exr\" cannot be used: it holds no sums");
  ExpectRefused("merge p1.exr -o merged.png", 2, "must end in .exr");
  for (const char* shard : {"1/8", "2/8", "8/8"}) {
    ExpectRefused(std::string("render scene.pbrt --spp 4 --shard ") + shard, 2, "4 samples per pixel make no 8 parts");
  }
  for (const char* shard : {"0/2", "3/2", "2", "1/2/3", "a/b", "1/-1"})
    ExpectRefused(std::string("render scene.pbrt --shard ") + shard, 2, "is no part; write 2/8");
}

TEST_F(Merge, MergesWhatThereIsIfAsked) {
  const std::string names = RenderParts("--spp 9", 3);
  std::filesystem::remove(folder_ / "p2.exr");
  const Outcome outcome = Run("merge -o merged.exr --partial p1.exr p3.exr");
  EXPECT_EQ(outcome.exitCode, 0) << outcome.output;
  EXPECT_NE(outcome.output.find("warning: the picture is not whole: without part 2/3"), std::string::npos)
      << outcome.output;
  EXPECT_EQ(ReadImage(folder_ / "merged.exr").metadata.at("lampyr.samplesPerPixel"), "6");
}

TEST_F(Merge, APartThatWasInterruptedIsNotWhole) {
  Do("render scene.pbrt --quiet -o p1.exr --shard 1/2 --spp 400000 --resolution 1x1");
  LampyrProcess render(
      folder_.Path(),
      "render scene.pbrt --quiet -o p2.exr --shard 2/2 --spp 400000 --resolution 1x1 --checkpoint 0.01s");
  for (int i = 0; i < 200 && !Exists("p2.checkpoint"); ++i) usleep(20000);
  render.Kill(SIGTERM);
  ExpectRefused("merge -o merged.exr p1.exr p2.exr", 1, "the rest of part 2/2");
}

TEST_F(Merge, PartsOfATimeAreWholeWhenItIsOver) {
  for (const char* part : {"1", "2"})
    Do(std::string("render scene.pbrt --quiet --time 0.2s --shard ") + part + "/2 -o p" + part + ".exr");
  ExpectRefused("render scene.pbrt --integrator vcm --time 0.2s --shard 2/2", 2, "--shard with vcm needs --spp");
  Do("merge -o merged.exr p1.exr p2.exr");
  EXPECT_GT(std::stoi(ReadImage(folder_ / "merged.exr").metadata.at("lampyr.samplesPerPixel")), 1);
  // Without merging, vcm gathers none.
  Do("render scene.pbrt --quiet --integrator vcm --no-merge --time 0.1s --shard 2/2 -o p3.exr");
}

// A number of samples that is not reached in the time is missing.
TEST_F(Merge, PartsWithFewerSamplesThanWantedAreNotWhole) {
  for (const char* part : {"1", "2"})
    Do(std::string("render scene.pbrt --quiet --spp 100000000 --time 0.2s --shard ") + part + "/2 -o p" + part +
       ".exr");
  ExpectRefused("merge -o merged.exr p1.exr p2.exr", 1, "of 50000000 samples are there)");
  Do("merge --partial -o merged.exr p1.exr p2.exr");
  ExpectRefused("merge --partial -o merged.exr p1.exr p1.exr", 1, "hold the same samples");
}

TEST_F(Merge, PartsCanBeGoneOnWith) {
  Do("render scene.pbrt --quiet -o whole.exr --spp 40 --no-guide-paths");
  for (const char* part : {"1", "2"}) {
    const std::string shard = std::string("render scene.pbrt --quiet --spp 40 --no-guide-paths --shard ") + part +
                              "/2 -o p" + part + ".exr --resume --checkpoint 0.01s";
    LampyrProcess render(folder_.Path(), shard);
    usleep(150000);
    render.Kill(SIGKILL);
    Do(shard);
  }
  Do("merge -o merged.exr p1.exr p2.exr");
  EXPECT_EQ(Bytes("merged.exr"), Bytes("whole.exr"));
}

}  // namespace
}  // namespace lampyr::test
