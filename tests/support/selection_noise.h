// Noise and cost of a picture by different light selections, for tests and benchmarks.
#pragma once

#include <ctime>
#include <string>
#include <vector>

#include "support/render_scene.h"

namespace lampyr::test {

// Pixels of which no camera ray sees a light: what is left is the noise of gathering.
inline std::vector<bool> SeesNoLight(const SceneDescription& description, RenderOverrides overrides) {
  overrides.integrator = "path";
  overrides.values["max-depth"] = 0;
  const Image image = RenderDescription(description, overrides, 256).image;
  std::vector<bool> mask;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) mask.push_back(!(image.At(x, y, 1) > 0));
  }
  return mask;
}

struct SelectionNoise {
  double meanSquaredError = 0;  // mean over the pixels of the variance between renders, green
  double seconds = 0;           // of CPU for one of them
  double Efficiency() const { return 1 / (meanSquaredError * seconds); }
};

// `selection`: a light sampler; "learned": the tree, which learns; "tree4": the tree with four light samples.
inline SelectionNoise MeasureSelection(const SceneDescription& description, const std::vector<bool>& mask,
                                       const std::string& integrator, const std::string& selection, int samplesPerPixel,
                                       int renders, RenderOverrides overrides = {}) {
  overrides.integrator = integrator;
  overrides.values["learn-lights"] = overrides.values["learn-always"] = selection == "learned";
  if (selection == "tree4") overrides.values["light-samples"] = 4;
  overrides.values["light-sampler"] = selection == "learned" || selection == "tree4" ? "tree" : selection;
  Diagnostics diagnostics(Diagnostics::Mode::Collect);
  BuiltScene built = BuildScene(description, overrides, true, diagnostics);
  std::vector<double> sum(mask.size()), squares(mask.size());
  SelectionNoise noise;
  for (int i = 0; i < renders; ++i) {
    built.settings.seed = static_cast<uint64_t>(i);
    const std::clock_t start = std::clock();
    const Image image = RenderBuilt(built, samplesPerPixel, 1).image;
    noise.seconds += static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC / renders;
    for (size_t p = 0; p < mask.size(); ++p) {
      const auto value =
          static_cast<double>(image.At(static_cast<int>(p) % image.width, static_cast<int>(p) / image.width, 1));
      sum[p] += value;
      squares[p] += value * value;
    }
  }
  double variance = 0, pixels = 0;
  for (size_t p = 0; p < mask.size(); ++p) {
    if (!mask[p]) continue;
    variance += (squares[p] - sum[p] * sum[p] / renders) / (renders - 1);
    ++pixels;
  }
  noise.meanSquaredError = variance / pixels;
  return noise;
}

}  // namespace lampyr::test
