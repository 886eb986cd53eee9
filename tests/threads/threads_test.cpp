// A render gives the same bytes for any number of threads: every scene of scenes/ by every integrator. The same tests
// run under ThreadSanitizer (`tests/run races`), which sees what happens to go well.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "base/parallel.h"
#include "support/render_scene.h"

namespace lampyr::test {
namespace {

namespace fs = std::filesystem;

// Enough that what is learned is used, and that photons are aimed.
constexpr int kSamples = 5;

std::vector<std::string> SceneNames() {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(fs::path(LAMPYR_SOURCE_DIR) / "scenes"))
    if (entry.path().extension() == ".pbrt") names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

class Threads : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Of, Threads, testing::ValuesIn(SceneNames()), [](const auto& info) {
  std::string name = info.param;
  std::replace_if(
      name.begin(), name.end(), [](char c) { return !std::isalnum(static_cast<unsigned char>(c)); }, '_');
  return name;
});

TEST_P(Threads, OneToFourGiveTheSameBytes) {
  FlushDenormalsToZero();  // as the program does, on all of its threads
  Diagnostics diagnostics(Diagnostics::Mode::Collect);
  const SceneDescription description =
      ReadScene(fs::path(LAMPYR_SOURCE_DIR) / "scenes" / (GetParam() + ".pbrt"), diagnostics);
  int pictures = 0;
  for (const char* integrator : {"path", "light", "bdpt", "sppm", "vcm"}) {
    RenderOverrides overrides;
    overrides.integrator = integrator;
    overrides.width = 40;
    overrides.height = 24;
    overrides.values["learn-always"] = true;
    const BuiltScene built = BuildScene(description, overrides, true, diagnostics);
    const Rendered one = RenderBuilt(built, kSamples, 1);
    EXPECT_EQ(one.outcome.counts.droppedSamples, 0u) << integrator;
    for (const int threads : {2, 3, 4}) {
      const Rendered several = RenderBuilt(built, kSamples, threads);
      EXPECT_EQ(several.image.data, one.image.data) << integrator << " with " << threads << " threads";
      EXPECT_EQ(several.outcome.counts.Rays(), one.outcome.counts.Rays()) << integrator;
      ++pictures;
    }
  }
  for (const char* integrator : {"path", "bdpt", "vcm"}) {
    RenderOverrides overrides;
    overrides.integrator = integrator;
    overrides.width = 40;
    overrides.height = 24;
    overrides.values["guide-always"] = true;
    const BuiltScene built = BuildScene(description, overrides, true, diagnostics);
    EXPECT_EQ(RenderBuilt(built, kSamples, 3).image.data, RenderBuilt(built, kSamples, 1).image.data)
        << integrator << ", guided";
    ++pictures;
  }
  // Beyond the first stage, and in the middle of the next.
  for (const char* integrator : {"path", "sppm", "vcm"}) {
    RenderOverrides overrides;
    overrides.integrator = integrator;
    overrides.width = 40;
    overrides.height = 24;
    overrides.adaptive.emplace();
    const BuiltScene built = BuildScene(description, overrides, true, diagnostics);
    EXPECT_EQ(RenderBuilt(built, 7, 3).image.data, RenderBuilt(built, 7, 1).image.data) << integrator << ", adaptive";
    ++pictures;
  }
  std::printf("[   info   ] %s: %d pictures\n", GetParam().c_str(), pictures);
}

}  // namespace
}  // namespace lampyr::test
