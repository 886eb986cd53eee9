// Three common ways to look for a wrong light, a wrong filter or a wrong weight, written as one would write them, and
// given what helps them: the true mean of the furnace, and a number of samples at which the sound light still passes.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "detection/search.h"

namespace lampyr::test {

// A scene, whose lights and filters may be of planted types.
struct BaselineScene {
  std::string text;
  std::filesystem::path folder;  // that its files lie in
  TypeRegistry types;
};
BaselineScene SceneOf(const std::string& text, const std::filesystem::path& folder, const LightType& light);
BaselineScene SceneOf(const std::string& text, const std::filesystem::path& folder, const FilterType& filter);

// Counts what the findings count, so far.
using Counter = std::function<uint64_t()>;

// Mean radiance of the whole image, as `integrator` finds it with so many samples per pixel.
struct MeanRadiance {
  double mean = 0, error = 0;
  uint64_t dropped = 0;  // samples that were not finite
};
MeanRadiance RenderMean(const BaselineScene& scene, const std::string& integrator, int samplesPerPixel, uint64_t seed);

// (1) The closed furnace: found if the mean of the image is off `truth` by more than 2.5 %, beyond its noise, with any
// of the integrators, or if samples are not finite.
Finding FindByFurnace(const BaselineScene& scene, const std::vector<std::string>& integrators, double truth,
                      double seconds, const Counter& counter);

// (2) χ² tests of the light's sampling functions against their densities, as Mitsuba 3 has them (ChiSquareTest): a
// table of directions against the density integrated over each cell. Of next-event estimation at one receiver, and of
// the directions of photons from one place. `mostSamples`: beyond, the sound light is rejected, too.
Finding FindByChiSquared(const BaselineScene& scene, uint64_t mostSamples, double seconds, const Counter& counter);

// (3) Welch's t-test of two integrators' tiles [Jung20]: found if one tile's p-value, or the distribution of all,
// cannot be by chance.
Finding FindByTiles(const BaselineScene& scene, const std::string& reference, const std::string& tested, double seconds,
                    const Counter& counter);

}  // namespace lampyr::test
