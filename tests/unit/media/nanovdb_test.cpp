// Media from NanoVDB files, against the library's own reading of them.
#include <gmock/gmock.h>

#include <cstring>

#include "media/nanovdb_file.h"
#include "sampling/rng.h"
#include "scene/spectrum.h"
#include "support/volume_writer.h"
#include "unit/media/medium_scene.h"

namespace lampyr {
namespace {

using test::MakeVolume;
using test::SmallVolume;
using test::Volume;
using test::VolumeFile;
using testing::HasSubstr;

class NanoVdb : public testing::Test {
 protected:
  TemporaryFolder folder_;

  // A medium of the file, in a folder of its own.
  std::shared_ptr<const Medium> MediumOfFile(const std::string& bytes, const std::string& parameters = "",
                                             const std::string& before = "") {
    return MediumOf("\"nanovdb\" \"string filename\" \"" + folder_.Write("a.nvdb", bytes).string() + "\" " + parameters,
                    before);
  }
  std::string ErrorOfFile(const std::string& bytes, const std::string& parameters = "",
                          uint64_t memory = uint64_t{1} << 30) {
    return MediumError(
        "\"nanovdb\" \"string filename\" \"" + folder_.Write("a.nvdb", bytes).string() + "\" " + parameters, memory);
  }
};

TEST_F(NanoVdb, HasTheValuesOfTheLibrary) {
  Volume far = SmallVolume();  // across nodes of all levels
  far.box = nanovdb::CoordBBox({4090, -4100, 120}, {4103, -4090, 136});
  far.value = [](const nanovdb::Coord& at) {
    return 0.001f * static_cast<float>((at[0] * 7 + at[1] * 3 + at[2]) & 255);
  };
  Volume dense = SmallVolume();  // nodes that are one value
  dense.box = nanovdb::CoordBBox({0, 0, 0}, {40, 24, 20});
  dense.value = [](const nanovdb::Coord& at) { return at[0] < 24 ? 0.5f : 0.75f; };
  for (const Volume& volume : {SmallVolume(), far, dense}) {
    for (const auto codec : {nanovdb::io::Codec::NONE, nanovdb::io::Codec::ZIP}) {
      const auto medium = MediumOfFile(VolumeFile({volume}, codec), "\"rgb sigma_a\" [ 1 2 3 ] \"float g\" 0.2");
      EXPECT_FALSE(medium->IsHomogeneous());
      EXPECT_FALSE(medium->IsEmissive());
      EXPECT_EQ(medium->Asymmetry(), 0.2f);
      EXPECT_GT(medium->Bytes(), 2048u);
      const test::VolumeHandle handle = MakeVolume(volume);
      const auto& tree = handle.grid<float>()->tree();
      for (auto at = volume.box.begin(); at; ++at) {
        const MediumCoefficients found = medium->At({(*at)[0], (*at)[1], (*at)[2]});
        ASSERT_EQ(found.absorption.r, tree.getValue(*at));
        ASSERT_EQ(found.absorption.g, 2 * tree.getValue(*at));
        ASSERT_EQ(found.scattering.g, tree.getValue(*at));
      }
      const auto sampler = nanovdb::createSampler<1>(tree);
      Rng rng(1);
      for (int i = 0; i < 5000; ++i) {
        nanovdb::Vec3f p;
        for (int axis = 0; axis < 3; ++axis) {
          const auto low = static_cast<float>(volume.box.min()[axis]);
          p[axis] = low + rng.NextFloat() * (static_cast<float>(volume.box.max()[axis]) + 1 - low);
        }
        ASSERT_NEAR(medium->At({p[0], p[1], p[2]}).absorption.r, sampler(p), 1e-5f);
      }
      const auto& low = volume.box.min();
      EXPECT_TRUE(medium->At({low[0] - 0.01f, low[1], low[2]}).Extinction().IsBlack());
      EXPECT_TRUE(medium->At({volume.box.max()[0] + 1.01f, low[1], low[2]}).Extinction().IsBlack());
    }
  }
}

// The file's transform, that of the scene, and a rotation in the file, which moves the box of voxels with it.
TEST_F(NanoVdb, GoesWhereItIsPlaced) {
  const Transform inFile =
      Transform::Translate({5, 6, 7}) * Transform::Rotate(30, {0, 1, 1}) * Transform::Scale(Vector3d(0.25));
  Volume volume = SmallVolume();
  double matrix[4][4], inverse[4][4];
  for (int column = 0; column < 4; ++column) {
    for (int row = 0; row < 4; ++row) {
      matrix[column][row] = inFile.Matrix()[column][row];
      inverse[column][row] = inFile.InverseMatrix()[column][row];
    }
  }
  volume.map.set(matrix, inverse, 1.0);
  const auto medium = MediumOfFile(VolumeFile({volume}), "", "Translate -3 0 1 Scale 2 2 2");
  const Transform toRender = Transform::Translate({-3, 0, 1}) * Transform::Scale(Vector3d(2.0)) * inFile;
  const auto plain = MediumOfFile(VolumeFile({SmallVolume()}));
  Rng rng(2);
  for (int i = 0; i < 5000; ++i) {
    const Point3 index(-10.9f + 24.8f * rng.NextFloat(), -4.9f + 14.8f * rng.NextFloat(),
                       -8.9f + 17.8f * rng.NextFloat());
    const Point3 p(toRender.Point(Point3d(index)));
    ASSERT_NEAR(medium->At(p).absorption.r, plain->At(index).absorption.r, 1e-4f);
    ASSERT_GE(medium->Majorants()->At(p), medium->At(p).Extinction().Max());
  }
}

TEST_F(NanoVdb, MajorantsBoundIt) {
  Volume rough = SmallVolume();
  rough.box = nanovdb::CoordBBox({-70, 3, 0}, {90, 40, 9});
  rough.value = [](const nanovdb::Coord& at) {
    const uint32_t hash = static_cast<uint32_t>(at[0] * 7919 + at[1] * 104729 + at[2] * 1299709) * 2654435761u >> 24;
    return hash < 40 ? 0.1f * static_cast<float>(hash) : hash == 255 ? 100.0f : 0.0f;
  };
  for (const Volume& volume : {SmallVolume(), rough}) {
    const auto medium = MediumOfFile(VolumeFile({volume}), "\"rgb sigma_s\" [ 0.1 3 0.2 ] \"float scale\" 0.7");
    const auto& low = volume.box.min();
    const auto& high = volume.box.max();
    Rng rng(3);
    int positive = 0;
    for (int i = 0; i < 100000; ++i) {
      Vector3 p;
      for (int axis = 0; axis < 3; ++axis) {
        const auto from = static_cast<float>(low[axis]);
        p[axis] = from + rng.NextFloat() * (static_cast<float>(high[axis]) + 1 - from);
        if (i % 4 == 0) p[axis] = std::round(p[axis]);
      }
      const float extinction = medium->At(p).Extinction().Max();
      ASSERT_GE(medium->Majorants()->At(p), extinction) << p.x << ", " << p.y << ", " << p.z;
      positive += extinction > 0;
    }
    EXPECT_GT(positive, 30000);
  }
}

TEST_F(NanoVdb, TemperaturesGlow) {
  Volume density = SmallVolume(), temperature = SmallVolume();
  density.map = temperature.map = test::ScalingMap(0.5, nanovdb::Vec3d(1.0, 2.0, 3.0));
  temperature.name = "temperature";
  temperature.box = nanovdb::CoordBBox({-8, -5, -9}, {5, 5, 5});
  temperature.value = [](const nanovdb::Coord& at) { return at[0] >= 0 ? 200.0f : 150.0f; };
  const std::string file = VolumeFile({density, temperature}, nanovdb::io::Codec::ZIP);
  const std::string scale = "\"float temperaturescale\" 20 \"float temperatureoffset\" 50 ";
  const auto at = [](int x, int y, int z) { return Point3(1 + 0.5f * x, 2 + 0.5f * y, 3 + 0.5f * z); };
  for (const char* brightness : {"\"float Lescale\" 3 ", "\"float LeScale\" 3 "}) {
    const auto medium = MediumOfFile(file, scale + brightness);
    EXPECT_TRUE(medium->IsEmissive());
    for (const auto& [x, kelvin] : {std::pair(2, 3000.0), std::pair(-2, 2000.0)}) {
      const float absorption = medium->At(at(x, -1, 1)).absorption.g;
      const Color expected = NormalizedBlackbody(kelvin) * (3 * absorption);
      EXPECT_GT(absorption, 0);
      EXPECT_NEAR(medium->At(at(x, -1, 1)).emission.r, expected.r, 2e-3f * expected.r);
      EXPECT_NEAR(medium->At(at(x, -1, 1)).emission.g, expected.g, 2e-3f * expected.g);
    }
    EXPECT_TRUE(medium->At(at(-10, -3, 1)).emission.IsBlack());
    EXPECT_GT(medium->At(at(-10, -3, 1)).absorption.g, 0);
  }
  EXPECT_FALSE(MediumOfFile(file, "\"float temperaturescale\" 0.5")->IsEmissive());
  EXPECT_FALSE(MediumOfFile(file, scale + "\"float Lescale\" 0")->IsEmissive());
  EXPECT_FALSE(
      MediumOfFile(file, "\"string gridname\" \"temperature\" \"string temperaturename\" \"density\"")->IsEmissive());
  EXPECT_THAT(ErrorOfFile(file, "\"float temperaturescale\" 10000"), HasSubstr("more than 1e6 K"));
}

TEST_F(NanoVdb, MayBeEmpty) {
  Volume volume = SmallVolume();
  volume.value = [](const nanovdb::Coord&) { return 0.0f; };
  const auto medium = MediumOfFile(VolumeFile({volume}));
  EXPECT_TRUE(medium->At({0.5f, 0.5f, 0.5f}).Extinction().IsBlack());
  for (const float majorant : medium->Majorants()->Values()) EXPECT_EQ(majorant, 0);
}

TEST_F(NanoVdb, ErrorsSayWhatWouldBeRight) {
  const std::string good = VolumeFile({SmallVolume()});
  EXPECT_EQ(ErrorOfFile(good), "no error");
  EXPECT_EQ(MediumError("\"nanovdb\""), "scene.pbrt:2:1: error: MakeNamedMedium \"m\" needs \"string filename\"");
  EXPECT_THAT(MediumError("\"nanovdb\" \"string filename\" \"absent.nvdb\""), HasSubstr("scene.pbrt:2:45: error: \""));
  EXPECT_THAT(MediumError("\"nanovdb\" \"string filename\" \"absent.nvdb\""), HasSubstr("absent.nvdb"));
  EXPECT_THAT(ErrorOfFile(""), HasSubstr("it ends early"));
  EXPECT_THAT(ErrorOfFile("a text that is no volume at all"), HasSubstr("it is no NanoVDB file"));
  EXPECT_THAT(ErrorOfFile(good, "\"string gridname\" \"densty\""),
              HasSubstr("it has no grid \"densty\" (did you mean \"density\"?); there is: \"density\""));
  EXPECT_THAT(ErrorOfFile(good, "\"string temperaturename\" \"heat\""), HasSubstr("it has no grid \"heat\""));
  const auto patched = [&](size_t offset, auto value) {
    std::string bytes = good;
    std::memcpy(&bytes.at(offset), &value, sizeof value);
    return bytes;
  };
  EXPECT_THAT(ErrorOfFile(patched(14, uint16_t{2})), HasSubstr("it is compressed by BLOSC"));
  EXPECT_THAT(ErrorOfFile(patched(8, uint32_t{29} << 21)), HasSubstr("it is of format 29 of NanoVDB, and not 32"));
  const size_t metadata = 16, grid = metadata + 176 + 8;  // the name is "density" and its 0
  EXPECT_EQ(good.compare(grid, 7, "NanoVDB"), 0);
  EXPECT_THAT(ErrorOfFile(patched(metadata + 32, uint32_t{2})), HasSubstr("is not one of 32-bit floats"));
  EXPECT_THAT(ErrorOfFile(patched(metadata, uint64_t{1} << 60)), HasSubstr("another size than it has"));
  EXPECT_THAT(ErrorOfFile(patched(grid, uint64_t{0})), HasSubstr("has another type inside"));
  EXPECT_THAT(ErrorOfFile(patched(grid + 632, uint32_t{1})), HasSubstr("is no volume of densities"));
  EXPECT_THAT(ErrorOfFile(patched(grid + 672, uint64_t{1} << 40)), HasSubstr("it is damaged: nodes are outside"));
  EXPECT_THAT(ErrorOfFile(patched(grid + 296 + 88, 0.0)),
              HasSubstr("its transform from voxels to space has no inverse"));
  for (const float wrong : {-1.0f, NAN, kInfinity}) {
    Volume volume = SmallVolume();
    volume.value = [wrong](const nanovdb::Coord& at) { return at[0] == 1 ? wrong : 0.5f; };
    EXPECT_THAT(ErrorOfFile(VolumeFile({volume})), HasSubstr("it has a voxel that is negative or not finite"));
  }
  EXPECT_THAT(ErrorOfFile(good, "", good.size() / 2), HasSubstr("the nodes of \"density\" take"));
  EXPECT_THAT(ErrorOfFile(good, "", good.size() + 1000), HasSubstr("the voxels of \"density\" take"));
  EXPECT_THAT(ErrorOfFile(good, "\"rgb sigma_a\" [ 3e38 0 0 ]"),
              HasSubstr("the extinction of this medium leaves the range of floats"));
  EXPECT_THAT(ErrorOfFile(good, "\"float nx\" 3"), HasSubstr("has no parameter \"nx\""));
}

// Two segments, as of files written one after the other; the digit of newer files.
TEST_F(NanoVdb, ReadsSegmentsAndNewerMagic) {
  Volume other = SmallVolume();
  other.name = "other";
  const std::string two = VolumeFile({other}, nanovdb::io::Codec::ZIP) + VolumeFile({SmallVolume()});
  EXPECT_EQ(NanoVdbReader(std::as_bytes(std::span(two))).Names(), (std::vector<std::string>{"other", "density"}));
  EXPECT_GT(MediumOfFile(two)->At({-1, -1, -1}).absorption.g, 0);
  std::string newer = VolumeFile({SmallVolume()});
  newer[7] = '2';
  newer[16 + 176 + 8 + 7] = '1';
  EXPECT_GT(MediumOfFile(newer)->At({-1, -1, -1}).absorption.g, 0);
  newer[7] = 'X';
  EXPECT_THAT(ErrorOfFile(newer), HasSubstr("it is no NanoVDB file"));
}

// A box that says more than the file holds asks for a table of bricks: refused, not taken.
TEST_F(NanoVdb, BoxesBeyondMemoryAreRefused) {
  const std::string good = VolumeFile({SmallVolume()});
  const size_t grid = 16 + 176 + 8;
  uint64_t rootOffset = 0;
  std::memcpy(&rootOffset, &good[grid + 672 + 24], sizeof rootOffset);
  std::string bytes = good;
  const int32_t box[6] = {-(1 << 29), -(1 << 29), -(1 << 29), 1 << 29, 1 << 29, 1 << 29};
  std::memcpy(&bytes[grid + 672 + rootOffset], box, sizeof box);
  EXPECT_THAT(ErrorOfFile(bytes), HasSubstr("the voxels of \"density\" take"));
  const int32_t farther[6] = {0, 0, 0, 0, 0, std::numeric_limits<int32_t>::max()};
  std::memcpy(&bytes[grid + 672 + rootOffset], farther, sizeof farther);
  EXPECT_THAT(ErrorOfFile(bytes), HasSubstr("beyond an index of 2^30"));
  const int32_t insideOut[6] = {0, 5, 0, 9, 4, 9};
  std::memcpy(&bytes[grid + 672 + rootOffset], insideOut, sizeof insideOut);
  EXPECT_THAT(ErrorOfFile(bytes), HasSubstr("inside out"));
}

}  // namespace
}  // namespace lampyr
