// The scenes of scenes/, scaled, moved, turned and mirrored: the same pictures, by every integrator.
//
// The random numbers are the same, so most paths are, too: what is judged is the mean of the differences between
// pictures of the same seed, by its own spread over the seeds (Student's t).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>

#include <glm/mat3x3.hpp>

#include "extremes/scene_transform.h"
#include "support/replicas.h"

namespace lampyr::test {
namespace {

namespace fs = std::filesystem;
const fs::path kScenes = fs::path(LAMPYR_SOURCE_DIR) / "scenes";

constexpr int kWidth = 16, kHeight = 9, kBlock = 8, kReplicas = 16;

struct Change {
  const char* name;
  Transform transform;
};

// `size`: of what the camera looks at.
std::vector<Change> Changes(double size) {
  const auto scale = [](double x, double y, double z) { return Transform::Scale({x, y, z}); };
  return {{"scaled by 1e-3", scale(1e-3, 1e-3, 1e-3)},
          {"scaled by 1e3", scale(1e3, 1e3, 1e3)},
          {"moved by 1e4 sizes", Transform::Translate(Vector3d(1e4, -0.6e4, 0.8e4) * size)},
          {"turned", Transform::Rotate(117, {1, -2, 0.5})},
          {"mirrored", Transform::Rotate(40, {0, 1, 3}) * scale(-1, 1, 1)}};
}

std::vector<std::string> SceneNames() {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(kScenes)) {
    if (entry.path().extension() != ".pbrt") continue;
    // Coefficients of media are per unit of length: a scene with media is another one when it is scaled.
    std::ifstream file(entry.path());
    const std::string text((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
    if (text.find("MakeNamedMedium") == std::string::npos) names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

class Invariance : public testing::TestWithParam<std::string> {};

// Per pixel of each replica. Where all are noisy, the one that is least so takes more.
int SamplesOf(const std::string& scene, const std::string& integrator) {
  struct Sharp {
    const char *scene, *integrator;
    int samples;
  };
  for (const Sharp& sharp : {Sharp{"lamp", "bdpt", 12},
                             {"door", "bdpt", 40},
                             {"pool", "vcm", 8},
                             {"ring", "path", 24},
                             {"still-life", "path", 10},
                             {"window", "path", 64}}) {
    if (scene == sharp.scene && integrator == sharp.integrator) return sharp.samples;
  }
  return integrator == "path" ? 4 : 2;
}

Replicas RenderBy(BuiltScene& built, const std::string& integrator, int samples) {
  built.settings.integrator = integrator;
  built.settings.counts = {};  // those of auto are for what its pilot chose
  Replicas replicas;
  for (int i = 0; i < kReplicas; ++i) {
    built.settings.seed = static_cast<uint64_t>(i);
    const uint64_t rejected = built.scene.geometry->RejectedRays();
    const Rendered rendered = RenderBuilt(built, samples, 1);
    replicas.images.push_back(rendered.image);
    replicas.faults += rendered.outcome.counts.droppedSamples + rendered.rejectedRays - rejected;
  }
  return replicas;
}

// Difference of the changed pictures from the others within a rectangle: Student's t of the mean difference.
struct Difference {
  double mean = 0, standardError = 0, of = 0;  // `of`: the mean of the unchanged ones
};
Difference Compare(const Replicas& changed, const Replicas& unchanged, int x0, int y0, int x1, int y1) {
  using namespace replicas_internal;
  const std::vector<double> a = Means(changed, 1, x0, y0, x1, y1), b = Means(unchanged, 1, x0, y0, x1, y1);
  std::vector<double> differences;
  for (size_t i = 0; i < a.size(); ++i) differences.push_back(a[i] - b[i]);
  const Moments moments = MomentsOf(differences);
  return {moments.mean, std::sqrt(moments.variance), MomentsOf(b).mean};
}

TEST_P(Invariance, OfThePicture) {
  Diagnostics diagnostics(Diagnostics::Mode::Collect);
  const SceneDescription scene = ReadScene(kScenes / (GetParam() + ".pbrt"), diagnostics);
  RenderOverrides overrides;
  overrides.width = kWidth;
  overrides.height = kHeight;
  BuiltScene original = BuildScene(scene, overrides, true, diagnostics);
  const double size = 2 * static_cast<double>(original.scene.lighting->SceneSphere().radius);
  const std::vector<Change> changes = Changes(size);

  std::vector<std::string> integrators = {"path", "bdpt", "sppm", "vcm"};
  if (original.settings.integrator == "light") integrators.push_back("light");
  std::vector<Replicas> unchanged;
  for (const std::string& integrator : integrators) {
    unchanged.push_back(RenderBy(original, integrator, SamplesOf(GetParam(), integrator)));
    EXPECT_EQ(unchanged.back().faults, 0u) << integrator;
  }
  constexpr int kBlocks = 1 + (kWidth / kBlock) * 1;
  const int comparisons = static_cast<int>(changes.size() * integrators.size()) * kBlocks;
  const double rate = SidakRate(SidakRate(1e-3, static_cast<int>(SceneNames().size())), comparisons);
  const double threshold = StudentQuantileTwoSided(rate, kReplicas - 1);
  double largest = 0;
  std::vector<double> noticed(integrators.size(), 0);  // relative errors of the whole that would be
  for (const Change& change : changes) {
    BuiltScene built = BuildScene(Transformed(scene, change.transform), overrides, true, diagnostics);
    for (size_t i = 0; i < integrators.size(); ++i) {
      const Replicas changed = RenderBy(built, integrators[i], SamplesOf(GetParam(), integrators[i]));
      EXPECT_EQ(changed.faults, 0u) << change.name << ", " << integrators[i];
      const auto judge = [&](const Difference& d, const std::string& where) {
        // Sums that are rounded otherwise, and light that a rounded ray just misses.
        const double rounding = 1e-4 * d.of;
        largest = std::max(largest, std::abs(d.mean) / (d.standardError + rounding));
        EXPECT_LE(std::abs(d.mean), threshold * d.standardError + rounding)
            << change.name << ", " << integrators[i] << ", " << where << ": differs by " << 100 * d.mean / d.of
            << " % +- " << 100 * d.standardError / d.of << " %";
      };
      const Difference all = Compare(changed, unchanged[i], 0, 0, kWidth, kHeight);
      judge(all, "the whole");
      noticed[i] = std::max(noticed[i], threshold * all.standardError / all.of);
      for (int x = 0; x < kWidth; x += kBlock)
        judge(Compare(changed, unchanged[i], x, 0, x + kBlock, kHeight), "from column " + std::to_string(x));
    }
  }
  std::string seen;
  for (size_t i = 0; i < integrators.size(); ++i) {
    char text[40];
    std::snprintf(text, sizeof text, " %s %.1f %%", integrators[i].c_str(), 100 * noticed[i]);
    seen += text;
  }
  std::printf("%s: %d comparisons, largest |t| %.2f (threshold %.2f); would notice:%s\n", GetParam().c_str(),
              comparisons, largest, threshold, seen.c_str());
  // Some scenes are beyond some integrators; of each scene one knows enough.
  EXPECT_LT(*std::min_element(noticed.begin(), noticed.end()), 0.15) << "too noisy";
  fs::create_directories(LAMPYR_EXTREMES_FOLDER);
  std::ofstream(fs::path(LAMPYR_EXTREMES_FOLDER) / (GetParam() + ".invariance")) << comparisons << "\n";
}

INSTANTIATE_TEST_SUITE_P(Of, Invariance, testing::ValuesIn(SceneNames()), [](const auto& info) {
  std::string name = info.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

}  // namespace
}  // namespace lampyr::test
