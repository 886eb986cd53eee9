// `lampyr denoise` and `lampyr render --denoise` as a user runs them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "film/image.h"
#include "support/lampyr_process.h"
#include "support/temporary_folder.h"

namespace lampyr::test {
namespace {

using testing::HasSubstr;
using testing::Not;

class DenoiseCommand : public testing::Test {
 protected:
  void SetUp() override {
    std::ofstream(folder_.Path() / "scene.pbrt") << R"(Film "rgb" "integer xresolution" 32 "integer yresolution" 20
LookAt 0 1 3  0 0 0  0 1 0
Camera "perspective" "float fov" 40
Sampler "sobol" "integer pixelsamples" 4
WorldBegin
AttributeBegin AreaLightSource "diffuse" "rgb L" [ 9 9 9 ]
Translate 0 2 0 Shape "sphere" "float radius" 0.3 AttributeEnd
Shape "bilinearmesh" "point3 P" [ -3 0 -3  3 0 -3  -3 0 3  3 0 3 ]
AttributeBegin Material "dielectric" "float eta" 1.5
Translate 0 0.5 0 Shape "sphere" "float radius" 0.4 AttributeEnd
)";
  }
  Outcome Run(const std::string& arguments) { return RunLampyr(folder_.Path(), arguments); }
  Image Read(const std::string& name) { return ReadImage(folder_.Path() / name); }

  TemporaryFolder folder_;
};

// The pixels of three channels.
std::vector<float> Values(const Image& image, const std::vector<std::string>& channels) {
  return ChannelsOf(image, channels).data;
}

TEST_F(DenoiseCommand, RenderKeepsTheUntouchedPicture) {
  ASSERT_EQ(Run("render scene.pbrt -o plain.exr --integrator vcm").exitCode, 0);
  const Outcome outcome = Run("render scene.pbrt -o denoised.exr --integrator vcm --denoise --png");
  ASSERT_EQ(outcome.exitCode, 0) << outcome.output;
  const Image plain = Read("plain.exr"), denoised = Read("denoised.exr");
  const std::vector<std::string> rgb = {"R", "G", "B"}, noisy = {"noisy.R", "noisy.G", "noisy.B"};
  EXPECT_EQ(Values(plain, rgb), Values(denoised, noisy));
  EXPECT_NE(Values(plain, rgb), Values(denoised, rgb));
  for (const char* channel : {"variance.G", "noisy.variance.G", "half.R", "feature.Albedo.R", "feature.N.X",
                              "feature.inverseDistance.Z", "feature.variance.Albedo.R"})
    EXPECT_GE(denoised.ChannelIndex(channel), 0) << channel;
  EXPECT_TRUE(std::filesystem::exists(folder_.Path() / "denoised.png"));
}

TEST_F(DenoiseCommand, DenoisesAPlainPictureAndSaysWhatItLacks) {
  ASSERT_EQ(Run("render scene.pbrt -o plain.exr").exitCode, 0);
  const Outcome outcome = Run("denoise plain.exr -o out.exr");
  ASSERT_EQ(outcome.exitCode, 0) << outcome.output;
  EXPECT_THAT(outcome.output, HasSubstr("by colour and variance alone"));
  EXPECT_GE(Read("out.exr").ChannelIndex("noisy.R"), 0);
  EXPECT_EQ(Run("denoise plain.exr -o quiet.exr --quiet").output, "");
  const Outcome again = Run("denoise out.exr -o again.exr");
  EXPECT_EQ(again.exitCode, 2);
  EXPECT_THAT(again.output, HasSubstr("denoised already"));
}

TEST_F(DenoiseCommand, MergedPartsAreDenoised) {
  for (const char* part : {"1", "2"}) {
    const std::string name(part);
    ASSERT_EQ(Run("render scene.pbrt --denoise --shard " + name + "/2 -o " + name + ".exr").exitCode, 0);
  }
  ASSERT_EQ(Run("merge 1.exr 2.exr -o merged.exr").exitCode, 0);
  const Outcome outcome = Run("denoise merged.exr -o out.exr");
  ASSERT_EQ(outcome.exitCode, 0) << outcome.output;
  EXPECT_THAT(outcome.output, Not(HasSubstr("note:")));
  ASSERT_EQ(Run("render scene.pbrt --denoise -o whole.exr").exitCode, 0);
  EXPECT_EQ(Read("whole.exr").data, Read("out.exr").data);
}

// Also of splats, and of some parts alone.
TEST_F(DenoiseCommand, HalvesOfAdaptivePartsAreHalves) {
  std::ofstream(folder_.Path() / "splats.pbrt") << R"(Film "rgb" "integer xresolution" 32 "integer yresolution" 20
LookAt 0 1 3  0 0 0  0 1 0
Camera "perspective" "float fov" 40
WorldBegin
LightSource "point" "point3 from" [ 0 1 0 ]
Shape "bilinearmesh" "point3 P" [ -3 0 -3  3 0 -3  -3 0 3  3 0 3 ]
Shape "bilinearmesh" "point3 P" [ -3 0 -1  3 0 -1  -3 3 -1  3 3 -1 ]
)";
  for (const char* part : {"1", "2", "3"}) {
    const std::string name(part);
    ASSERT_EQ(Run("render splats.pbrt --integrator bdpt --adaptive --denoise --spp 12 --shard " + name + "/3 -o " +
                  name + ".exr")
                  .exitCode,
              0);
  }
  for (const char* parts : {"1.exr", "2.exr", "3.exr", "1.exr 3.exr", "1.exr 2.exr 3.exr"}) {
    const Outcome outcome = Run("merge --partial " + std::string(parts) + " -o merged.exr");
    ASSERT_EQ(outcome.exitCode, 0) << outcome.output;
    const Image merged = Read("merged.exr");
    double all = 0, half = 0;
    for (const float value : Values(merged, {"G"})) all += static_cast<double>(value);
    for (const float value : Values(merged, {"half.G"})) half += static_cast<double>(value);
    EXPECT_NEAR(half / all, 0.5, 0.05) << parts;
  }
}

TEST_F(DenoiseCommand, CompareMeasuresWhatItIsWorth) {
  ASSERT_EQ(Run("render scene.pbrt -o reference.exr --seed 9 --spp 1024").exitCode, 0);
  const Outcome outcome =
      Run("compare scene.pbrt --spp 2,4 --repeat 2 -o c --integrators path,path:denoise --reference reference.exr");
  ASSERT_EQ(outcome.exitCode, 0) << outcome.output;
  EXPECT_THAT(outcome.output, HasSubstr("path:denoise has"));
  EXPECT_THAT(outcome.output, HasSubstr("with blur: path:denoise"));
}

TEST_F(DenoiseCommand, RefusesWhatCannotBeDenoised) {
  WriteExr(folder_.Path() / "bare.exr", Image(4, 4, {"R", "G", "B"}), ExrPrecision::Float);
  const Outcome bare = Run("denoise bare.exr -o out.exr");
  EXPECT_EQ(bare.exitCode, 2);
  EXPECT_THAT(bare.output, HasSubstr("\"bare.exr\" cannot be denoised: it has no layers variance.R"));
  EXPECT_EQ(Run("denoise missing.exr -o out.exr").exitCode, 2);
  EXPECT_EQ(Run("denoise bare.exr -o bare.exr").exitCode, 2);
  EXPECT_EQ(Run("denoise bare.exr -o out.png").exitCode, 2);
  EXPECT_THAT(Run("denoize bare.exr").output, HasSubstr("denoise"));
  EXPECT_FALSE(std::filesystem::exists(folder_.Path() / "out.exr"));
}

}  // namespace
}  // namespace lampyr::test
