// NanoVDB files that are cut off or damaged: each is read, or refused with a text; none crashes.
#include <gtest/gtest.h>

#include <cstring>
#include <random>

#include "base/error.h"
#include "media/make_media.h"
#include "media/nanovdb_file.h"
#include "support/volume_writer.h"
#include "unit/scene/scene_support.h"

namespace lampyr {
namespace {

// One upper node, and a few of the others.
std::string SmallFile(nanovdb::io::Codec codec = nanovdb::io::Codec::NONE) {
  test::Volume volume = test::SmallVolume();
  volume.box = nanovdb::CoordBBox({120, 5, 100}, {140, 19, 117});
  volume.value = [](const nanovdb::Coord& at) { return 0.01f * static_cast<float>(at[0] - at[1]); };
  return test::VolumeFile({volume}, codec);
}

// The error of the file, or "no error" if its grid was read.
std::string VolumeError(const std::string& bytes) {
  return ErrorOf([&] {
    MemoryBudget memory(uint64_t{1} << 28);
    const NanoVdbReader reader(std::as_bytes(std::span(bytes)));
    const auto grid = reader.Read("density", true, memory, {});
    if (!grid) return;
    const IndexBox& box = grid->voxels.Box();
    const Point3 middle(static_cast<float>(box.min[0]), static_cast<float>(box.max[1]), static_cast<float>(box.max[2]));
    if (!std::isfinite(grid->voxels.Interpolate(middle))) throw std::logic_error("a value that is not finite was read");
  });
}

TEST(VolumeErrors, FilesThatAreCutOffAreRefused) {
  for (const auto codec : {nanovdb::io::Codec::NONE, nanovdb::io::Codec::ZIP}) {
    const std::string whole = SmallFile(codec);
    ASSERT_EQ(VolumeError(whole), "no error");
    for (size_t size = 0; size < whole.size(); size += size < 3000 ? 7 : whole.size() / 61) {
      EXPECT_NE(VolumeError(whole.substr(0, size)), "no error") << size << " bytes of " << whole.size();
    }
  }
}

// Bytes of the headers, and of the parts of tables that are not 0, become others.
TEST(VolumeErrors, DamagedFilesAreReadOrRefused) {
  const std::string whole = SmallFile();
  std::vector<size_t> places;
  for (size_t i = 0; i < whole.size(); ++i) {
    if (whole[i] != 0 || i < 1200) places.push_back(i);
  }
  std::mt19937 random(1);
  constexpr int64_t kSpecial[] = {0, 1, -1, 32, 1 << 12, 1 << 30, INT64_MIN, INT64_MAX, 0x7fc00000, int64_t{1} << 40};
  int refused = 0;
  constexpr int kRounds = 4000;
  for (int round = 0; round < kRounds; ++round) {
    std::string bytes = whole;
    for (unsigned i = random() % 3; i < 3; ++i) {
      // Half of them in the headers, of which there are few.
      const size_t at = places[random() % 2 == 0 ? random() % 1200 : random() % places.size()];
      const int64_t value =
          random() % 2 == 0 ? kSpecial[random() % std::size(kSpecial)] : static_cast<int64_t>(random());
      std::memcpy(&bytes[at], &value, std::min(size_t{1} << random() % 4, bytes.size() - at));
    }
    const std::string error = VolumeError(bytes);
    EXPECT_EQ(error.find("logic"), std::string::npos);
    refused += error != "no error";
  }
  EXPECT_GT(refused, kRounds / 10);
  EXPECT_LT(refused, kRounds);
}

TEST(VolumeErrors, AreReportedForScenes) {
  const TemporaryFolder folder;
  folder.Write("broken.nvdb", SmallFile().substr(0, 5000));
  Diagnostics diagnostics(Diagnostics::Mode::Collect);
  const std::string error = ErrorOf([&] {
    MemoryBudget memory(uint64_t{1} << 28);
    MakeMedia(
        ParseScene("WorldBegin\nMakeNamedMedium \"m\" \"string type\" \"nanovdb\"\n\"string filename\" \"broken.nvdb\"",
                   (folder / "s.pbrt").string(), diagnostics),
        Transform(), memory, diagnostics);
  });
  EXPECT_NE(error.find("s.pbrt:3:1: error: \""), std::string::npos) << error;
  EXPECT_NE(error.find("broken.nvdb\" cannot be used as a volume: it ends early"), std::string::npos) << error;
}

}  // namespace
}  // namespace lampyr
