// The error that is stated where photons are merged covers the truth: noise and bias together, over 20 seeds in each of
// our scenes. Makes the table of docs/bias.md.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "support/render_scene.h"

namespace lampyr::test {
namespace {

constexpr int kSeeds = 20, kPasses[] = {16, 64};

BuiltScene BuildSmall(const std::string& scene, const std::string& integrator) {
  RenderOverrides overrides;
  overrides.width = 64;
  overrides.height = 36;
  overrides.integrator = integrator;
  Diagnostics diagnostics(Diagnostics::Mode::Collect);
  const std::filesystem::path file = std::filesystem::path(LAMPYR_SOURCE_DIR) / "scenes" / (scene + ".pbrt");
  return BuildScene(ReadScene(file, diagnostics), overrides, true, diagnostics);
}

std::vector<double> LuminancesOf(const Image& image) {
  std::vector<double> luminances;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) luminances.push_back(static_cast<double>(image.RgbAt(x, y).Luminance()));
  }
  return luminances;
}

double MeanOf(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

// By vcm, with the radii of passes from 2^18 on, which are an eighth of the first one.
std::vector<double> ReferenceOf(const std::string& scene) {
  constexpr int kSamples = 2048;
  BuiltScene built = BuildSmall(scene, "vcm");
  built.settings.seed = 1;
  const std::unique_ptr<Integrator> vcm = MakeIntegrator(built.scene, built.settings);
  Film film(built.settings.width, built.settings.height, built.settings.crop);
  ProgressiveRender render(built.scene, *vcm, built.settings, 1, film, 1u << 18);
  render.AddSamples(kSamples);
  return LuminancesOf(film.Develop());
}

// Means over the seeds.
struct Measured {
  double error = 0, noise = 0, bias = 0, stated = 0;  // relative
  double pixels = 0;                                  // share of the pixels whose own interval covers the truth
  int covered = 0, byNoise = 0;                       // seeds
};

void Measure(const Film& film, const std::vector<double>& truth, Measured& sums) {
  const std::vector<double> luminances = LuminancesOf(film.Develop());
  const std::vector<float> halves = film.PixelErrors();
  const double least = 0.01 * MeanOf(luminances);
  double squares = 0, within = 0;
  for (size_t i = 0; i < truth.size(); ++i) {
    const double difference = std::abs(luminances[i] - truth[i]);
    squares += difference * difference;
    within += difference <= static_cast<double>(halves[i]) * std::max(luminances[i], least);
  }
  const auto pixels = static_cast<double>(truth.size());
  const double error = std::sqrt(squares / pixels) / MeanOf(truth);
  const ErrorParts parts = film.PartsOfError();
  sums.error += error / kSeeds;
  sums.noise += parts.noise / kSeeds;
  sums.bias += parts.bias / kSeeds;
  sums.stated += parts.Both() / kSeeds;
  sums.pixels += within / pixels / kSeeds;
  sums.covered += error <= parts.Both();
  sums.byNoise += error <= parts.noise;
}

class StatedError : public testing::TestWithParam<const char*> {};

TEST_P(StatedError, CoversTheTruth) {
  const std::string scene = GetParam();
  const std::vector<double> truth = ReferenceOf(scene);
  for (const char* name : {"sppm", "vcm", "auto"}) {
    BuiltScene built = BuildSmall(scene, name);
    std::map<int, Measured> measured;
    for (int seed = 0; seed < kSeeds; ++seed) {
      built.settings.seed = 100 + static_cast<uint64_t>(seed);
      const std::unique_ptr<Integrator> integrator = MakeIntegrator(built.scene, built.settings);
      if (!integrator->Photons()) break;
      Film film(built.settings.width, built.settings.height, built.settings.crop);
      ProgressiveRender render(built.scene, *integrator, built.settings, 1, film);
      for (const int passes : kPasses) {
        render.AddSamples(passes - render.Outcome().samplesPerPixel);
        Measure(film, truth, measured[passes]);
      }
    }
    for (const auto& [passes, of] : measured) {
      std::printf("| %s | %s | %d | %.2f | %.2f | %.2f | %.2f | %d | %d | %.0f |\n", scene.c_str(), name, passes,
                  100 * of.error, 100 * of.noise, 100 * of.bias, 100 * of.stated, of.byNoise, of.covered,
                  100 * of.pixels);
      EXPECT_GE(of.covered, kSeeds * 95 / 100) << scene << " by " << name << " with " << passes << " passes";
    }
    std::fflush(stdout);
  }
}

INSTANTIATE_TEST_SUITE_P(In, StatedError,
                         testing::Values("caustics", "cloud", "diver", "gallery", "glass-sphere", "lamp", "lighthouse",
                                         "lights-1000", "mirror", "pool", "ring", "rooms", "sky", "spot-lens", "stage",
                                         "still-life", "tea", "underwater", "window"),
                         [](const auto& info) {
                           std::string name = info.param;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

}  // namespace
}  // namespace lampyr::test
