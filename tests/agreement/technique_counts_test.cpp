// Counts of techniques (integrators/walk/technique_counts.h) where pixels are few and where the film has a seam: means
// are those of bdpt, or of vcm, with every technique once for each sample.
#include "integrators/walk/technique_counts.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "integrators/photon/photon_pass.h"
#include "render/analysis/pilot_candidates.h"
#include "support/estimate.h"
#include "support/render_scene.h"

namespace lampyr::test {
namespace {

BuiltScene Build(const std::string& text, const RenderOverrides& overrides) {
  Diagnostics diagnostics(Diagnostics::Mode::Collect);
  return BuildScene(ParseScene(text, "test.pbrt", diagnostics), overrides, true, diagnostics);
}

// Means of groups of pixels over independent renders: of the whole film, and of each column without its two upper and
// lower pixels.
struct Means {
  Estimate whole;
  std::vector<Estimate> columns;
};
Means MeansOf(BuiltScene& built, const TechniqueCounts& counts, int renders, int samplesPerPixel, uint64_t firstSeed) {
  built.settings.counts = std::make_shared<TechniqueCounts>(counts);
  Means means;
  for (int i = 0; i < renders; ++i) {
    built.settings.seed = firstSeed + static_cast<uint64_t>(i);
    const Image image = RenderBuilt(built, samplesPerPixel, 1).image;
    means.columns.resize(static_cast<size_t>(image.width));
    double sum = 0;
    for (int x = 0; x < image.width; ++x) {
      double column = 0;
      for (int y = 0; y < image.height; ++y) {
        const auto value = static_cast<double>(image.At(x, y, 1));
        sum += value;
        if (y >= 2 && y < image.height - 2) column += value;
      }
      means.columns[static_cast<size_t>(x)].Add(column);
    }
    means.whole.Add(sum / (image.width * image.height));
  }
  return means;
}

// Standard errors between two means.
double Deviate(const Estimate& a, const Estimate& b) {
  return (a.Mean() - b.Mean()) / std::sqrt(a.Variance() + b.Variance());
}

// A caustic on a floor. Nothing but light paths brings any light: connected to the lens, or as photons.
std::string Caustic(int width, int height, const std::string& film) {
  return "Film \"rgb\" \"integer xresolution\" " + std::to_string(width) + " \"integer yresolution\" " +
         std::to_string(height) + " " + film + R"(
PixelFilter "box"
LookAt 0.9 0.4 0  0 0 0  0 1 0
Camera "perspective" "float fov" 14 "float screenwindow" [ -1 1 -1 1 ]
Integrator "path" "integer maxdepth" 4
WorldBegin
LightSource "spot" "rgb I" [ 9 9 9 ] "point3 from" [ 0 2.5 0 ] "point3 to" [ 0 0 0 ] "float coneangle" 14
AttributeBegin Material "dielectric" "float eta" 1.5
Translate 0 1 0 Shape "sphere" "float radius" 0.4 AttributeEnd
Material "diffuse" "rgb reflectance" [ 0.6 0.6 0.6 ]
Shape "bilinearmesh" "point3 P" [ -2 0 -2  2 0 -2  -2 0 2  2 0 2 ]
)";
}

struct Narrow {
  int width, height;
  std::string film;
};

const std::vector<Narrow>& NarrowFilms() {
  static const std::vector<Narrow> films = {
      {1, 12, ""}, {12, 1, ""}, {3, 11, ""},
      {1, 3, ""},  {5, 5, ""},  {16, 16, "\"float cropwindow\" [ 0.3 0.6 0.35 0.7 ]"},
  };
  return films;
}

std::string NameOf(const Narrow& film, int log2LightPaths) {
  return std::to_string(film.width) + "x" + std::to_string(film.height) + (film.film.empty() ? "" : ", a crop") +
         ", 2^" + std::to_string(log2LightPaths) + " light paths";
}

// Each pixel has its light path in one of n samples, whatever the width of the film.
TEST(TechniqueCounts, AWideStartIsAnotherRender) {
  TechniqueCounts usual, wide;
  wide.startsWide = true;
  EXPECT_TRUE(usual.IsDefault());
  EXPECT_FALSE(wide.IsDefault());
  EXPECT_NE(usual.Fingerprint(), wide.Fingerprint());
  EXPECT_NE(usual.Describe("vcm"), wide.Describe("vcm"));
}

// Twice as wide at first, never narrower than usual, and as usual in the end; the radius shrinks in each pass.
TEST(TechniqueCounts, AWideStartEnds) {
  EXPECT_EQ(RadiusScale(0, 2. / 3, true), 2 * RadiusScale(0, 2. / 3));
  for (uint32_t pass = 0; pass < 1200; ++pass) {
    EXPECT_GE(RadiusScale(pass, 2. / 3, true), RadiusScale(pass, 2. / 3)) << pass;
    EXPECT_LT(RadiusScale(pass + 1, 2. / 3, true), RadiusScale(pass, 2. / 3, true)) << pass;
  }
  EXPECT_EQ(RadiusScale(960, 2. / 3, true), RadiusScale(960, 2. / 3));
  // The mean area over the first 64 passes, which the pilot assumes.
  double wide = 0, usual = 0;
  for (uint32_t pass = 0; pass < 64; ++pass) {
    wide += std::pow(RadiusScale(pass, 2. / 3, true), 2);
    usual += std::pow(RadiusScale(pass, 2. / 3), 2);
  }
  EXPECT_NEAR(wide / usual, pilot::kWiderMerging, 0.1);
}

// A render that starts wide finds four times the photons in its first passes, with a single mean.
TEST(TechniqueCounts, AWideStartFindsMorePhotons) {
  BuiltScene built = Build(
      "Film \"rgb\" \"integer xresolution\" 32 \"integer yresolution\" 32\nIntegrator \"vcm\"\n"
      "LookAt 0.3 1.5 0  0.3 0 0  0 0 1 Camera \"perspective\"\nWorldBegin\n"
      "LightSource \"point\" \"rgb I\" [ 3 2 1 ] \"point3 from\" [ 0 1.8 0 ]\n"
      "Shape \"bilinearmesh\" \"point3 P\" [ -1 0 -1  1 0 -1  -1 0 1  1 0 1 ]\n",
      {});
  double found[2], mean[2];
  for (const bool isWide : {false, true}) {
    TechniqueCounts counts;
    counts.startsWide = isWide;
    built.settings.counts = std::make_shared<TechniqueCounts>(counts);
    const auto rendered = RenderBuilt(built, 8, 1);
    found[isWide] = static_cast<double>(rendered.outcome.counts.foundPhotons);
    const Image& image = rendered.image;
    mean[isWide] = 0;
    for (int y = 4; y < 28; ++y) {
      for (int x = 4; x < 28; ++x) mean[isWide] += static_cast<double>(image.At(x, y, 0));
    }
  }
  EXPECT_GT(found[0], 0);
  EXPECT_NEAR(found[1] / found[0], 3.9, 0.4);
  EXPECT_NEAR(mean[1] / mean[0], 1, 0.02);
}

TEST(TechniqueCounts, NoLightPathIsLostOrDoubledInNarrowFilms) {
  for (const Narrow& film : NarrowFilms()) {
    for (const int log2LightPaths : {-3, -2, -1, 0, 1}) {
      RenderOverrides overrides;
      overrides.integrator = "bdpt";
      BuiltScene built = Build(Caustic(film.width, film.height, film.film), overrides);
      TechniqueCounts counts;
      counts.log2LightPaths = log2LightPaths;
      built.settings.counts = std::make_shared<TechniqueCounts>(counts);
      const auto integrator = MakeIntegrator(built.scene, built.settings);
      for (const uint64_t seed : {0, 1, 77}) {
        built.settings.seed = seed;
        for (const int samples : {8, 24}) {
          Film picture(film.width, film.height, built.settings.crop);
          StopConditions stop;
          stop.samplesPerPixel = samples;
          Render(built.scene, *integrator, built.settings, stop, 1, picture, [](const RenderOutcome&, double) {});
          EXPECT_EQ(static_cast<double>(picture.LightPaths()), counts.LightPaths() * samples * film.width * film.height)
              << NameOf(film, log2LightPaths) << ", " << samples << " spp";
        }
      }
    }
  }
}

// The caustic is as bright with fewer light paths as with one for each camera path. bdpt: it is seen from the lens.
// vcm without connections: as photons, of which passes have none if the pixels do not take turns.
TEST(TechniqueCounts, NarrowFilmsHaveTheMeanOfAll) {
  for (const char* integrator : {"bdpt", "vcm"}) {
    const bool merges = integrator == std::string("vcm");
    for (const Narrow& film : NarrowFilms()) {
      // In an image so small that a pass may have no light path at all, auto traces one for each pixel (pilot.h).
      const bool isTiny = film.width < 8 && film.height < 8;
      RenderOverrides overrides;
      overrides.integrator = integrator;
      overrides.values["radius"] = 0.1;
      overrides.values["alpha"] = 1.0;
      overrides.values["connect"] = !merges;
      overrides.values["guide-photons"] = false;
      BuiltScene built = Build(Caustic(film.width, film.height, film.film), overrides);
      const Means once = MeansOf(built, {}, 200, 16, 1);
      for (const int log2LightPaths : {-3, -1}) {
        if (merges && isTiny && log2LightPaths < 0) continue;
        TechniqueCounts counts;
        counts.log2LightPaths = log2LightPaths;
        for (const int samples : {1, 8}) {
          if (isTiny && samples < 8) continue;
          const Means means = MeansOf(built, counts, 1600 / samples, samples, 10000);
          const double error = std::sqrt(means.whole.Variance() + once.whole.Variance()) / once.whole.Mean();
          std::printf("[   info   ] %-4s %s, %d spp: %+.2f +- %.2f %%\n", integrator,
                      NameOf(film, log2LightPaths).c_str(), samples, 100 * (means.whole.Mean() / once.whole.Mean() - 1),
                      100 * error);
          EXPECT_LT(error, 0.03) << "too much noise to tell: " << NameOf(film, log2LightPaths);
          EXPECT_LT(std::abs(Deviate(means.whole, once.whole)), 4.5)
              << integrator << ", " << NameOf(film, log2LightPaths) << ", " << samples << " spp";
        }
      }
    }
  }
}

// The film of a camera that sees all around, with a mask that is 0 at its left edge and 1 at the right: samples beyond
// either edge are decided on where their point is, beside the other edge, as splats are that fall there. Nearly all
// light on the walls comes by connections, from a bright spot on the ceiling.
TEST(TechniqueCounts, MasksAreReadOnTheRightSideOfTheSeam) {
  const std::string room = R"(Film "rgb" "integer xresolution" 16 "integer yresolution" 8
PixelFilter "box" "float xradius" 2 "float yradius" 0.5
Sampler "independent"
LookAt 0 -0.3 0  0 -0.3 1  0 1 0
Camera "spherical" "string mapping" "equirectangular"
Integrator "bdpt" "integer maxdepth" 2
WorldBegin
LightSource "spot" "rgb I" [ 9 9 9 ] "point3 from" [ 0 0.3 0 ] "point3 to" [ 0 1 0 ] "float coneangle" 25
Material "diffuse" "rgb reflectance" [ 0.7 0.7 0.7 ]
Shape "trianglemesh" "point3 P" [ -1 -1 -1  1 -1 -1  -1 1 -1  1 1 -1  -1 -1 1  1 -1 1  -1 1 1  1 1 1 ]
"integer indices" [ 0 1 2 1 3 2  4 5 6 5 7 6  0 1 4 1 5 4  2 3 6 3 7 6  0 2 4 2 6 4  1 3 5 3 7 5 ]
)";
  BuiltScene built = Build(room, {});
  const Means once = MeansOf(built, {}, 2000, 1, 1);
  TechniqueCounts counts;
  counts.connecting = FilmMask(2, 1, {16, 8}, {0, 1});
  const Means masked = MeansOf(built, counts, 2000, 1, 100000);
  for (const size_t x : {0u, 1u, 2u, 7u, 8u, 13u, 14u, 15u}) {
    const Estimate &a = masked.columns[x], &b = once.columns[x];
    const double error = std::sqrt(a.Variance() + b.Variance()) / b.Mean();
    std::printf("[   info   ] column %2zu: %+.2f +- %.2f %%\n", x, 100 * (a.Mean() / b.Mean() - 1), 100 * error);
    EXPECT_LT(error, 0.03) << "too much noise to tell";
    EXPECT_LT(std::abs(Deviate(a, b)), 4.5) << "column " << x;
  }
}

// Sum over the pixels of the variance of a picture of 256 samples per pixel.
double VarianceOf(const std::string& text, const std::string& integrator, int log2LightPaths, int renders) {
  RenderOverrides overrides;
  overrides.integrator = integrator;
  BuiltScene built = Build(text, overrides);
  TechniqueCounts counts;
  counts.log2LightPaths = log2LightPaths;
  built.settings.counts = std::make_shared<TechniqueCounts>(counts);
  std::vector<Estimate> pixels;
  for (int i = 0; i < renders; ++i) {
    built.settings.seed = static_cast<uint64_t>(i) + 1;
    const Image image = RenderBuilt(built, 256, 1).image;
    pixels.resize(static_cast<size_t>(image.width) * static_cast<size_t>(image.height));
    for (size_t k = 0; k < pixels.size(); ++k)
      pixels[k].Add(static_cast<double>(image.data[k * image.channels.size() + 1]));
  }
  double variance = 0;
  for (const Estimate& pixel : pixels) variance += pixel.Variance();
  return variance;
}

// A thin beam that a mirror sends to one point of the floor, far out of focus: nothing but the point of the lens
// decides where a splat falls. Light paths that are fewer have points of the lens that are as well distributed among
// themselves.
TEST(TechniqueCounts, PointsOfTheLensAreStratifiedAmongLightPaths) {
  const auto scene = [](const std::string& sampler) {
    return R"(Film "rgb" "integer xresolution" 8 "integer yresolution" 8
PixelFilter "box"
Sampler ")" +
           sampler +
           R"("
LookAt 0 1 -1  0 0 0  0 1 0
Camera "perspective" "float fov" 40 "float lensradius" 0.2 "float focaldistance" 0.6
WorldBegin
LightSource "spot" "rgb I" [ 9 9 9 ] "point3 from" [ -1 1 0 ] "point3 to" [ 0 1 0 ] "float coneangle" 0.2
AttributeBegin Material "conductor" "float roughness" 0 Translate 0 1 0 Rotate -45 0 0 1
Shape "bilinearmesh" "point3 P" [ -0.1 0 -0.1  0.1 0 -0.1  -0.1 0 0.1  0.1 0 0.1 ] AttributeEnd
Material "diffuse" "rgb reflectance" [ 0.6 0.6 0.6 ]
Shape "bilinearmesh" "point3 P" [ -2 0 -2  2 0 -2  -2 0 2  2 0 2 ]
)";
  };
  for (const int log2LightPaths : {0, -2, -3}) {
    const double independent = VarianceOf(scene("independent"), "bdpt", log2LightPaths, 40);
    const double sobol = VarianceOf(scene("sobol"), "bdpt", log2LightPaths, 40);
    std::printf("[   info   ] 2^%d light paths: variance %.3g by Sobol points, %.3g by independent ones\n",
                log2LightPaths, sobol, independent);
    ASSERT_GT(independent, 0);
    EXPECT_LT(sobol, 0.6 * independent) << "2^" << log2LightPaths << " light paths";
  }
}

}  // namespace
}  // namespace lampyr::test
