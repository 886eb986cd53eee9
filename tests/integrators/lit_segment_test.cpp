// Distances that are sampled for a light along a ray in media: their density, and where they are.
#include "integrators/path/lit_segment.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "support/replicas.h"

namespace lampyr::test {
namespace {

BuiltScene Build(const std::string& medium, const std::string& lights) {
  Diagnostics diagnostics(Diagnostics::Mode::Collect);
  const std::string text = "Camera \"perspective\" WorldBegin\nMakeNamedMedium \"fog\" " + medium + "\n" + lights +
                           "Translate 1 2 3 Material \"interface\" MediumInterface \"fog\" \"\" Shape \"sphere\"\n";
  return BuildScene(ParseScene(text, "segment.pbrt", diagnostics), {}, true, diagnostics);
}

const char* const kMist = "\"string type\" \"homogeneous\" \"rgb sigma_s\" [0.3 0.2 0.1] \"rgb sigma_a\" [0.1 0.1 0.1]";
const char* const kLights =
    "LightSource \"point\" \"point3 from\" [1.3 2.4 3.1] \"rgb I\" [1 1 1]\n"
    "LightSource \"spot\" \"point3 from\" [1 3.5 3] \"point3 to\" [1.2 2 3] \"float coneangle\" 8 \"rgb I\" [9 9 9]\n"
    "LightSource \"infinite\" \"rgb L\" [0.3 0.3 0.3]\n"
    "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [4 4 4] Translate 0.6 1.8 3.4 Shape \"sphere\" \"float "
    "radius\" "
    "0.2 AttributeEnd\n"
    "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [3 3 3] Shape \"trianglemesh\" \"point3 P\" [0.5 2.5 2.8  1 "
    "2.6 "
    "2.8  0.7 2.5 3.2  1.4 2.7 3.4] \"integer indices\" [0 1 2 1 3 2] AttributeEnd\n";

// A ray through the fog from the empty space in front of it.
struct Flown {
  explicit Flown(const BuiltScene& built, bool isFirst = true) : context{built.scene, sampler, 0, counts} {
    sampler.StartPixelSample(1, 0, 0);
    ray = {Point3(-0.6f, 2.1f, 2.9f), glm::normalize(Vector3(1, 0.05f, 0.1f))};
    Fly(context, ray, visibility::kCamera, {Point3d(ray.origin)}, Color(1.0f), 0, false, flight);
    segment = LitSegment(built.scene, ray, flight, isFirst);
  }
  Sampler sampler{SamplerKind::Independent, 1};
  RenderCounts counts;
  SampleContext context;
  Ray ray;
  Flight flight;
  LitSegment segment;
};

TEST(LitSegment, SamplesFollowTheDensity) {
  const BuiltScene built = Build(kMist, kLights);
  const Flown flown(built);
  ASSERT_EQ(flown.flight.spans.size(), 1u);
  const double start = flown.flight.spans[0].tMin, length = flown.flight.spans[0].tMax - start;
  EXPECT_EQ(flown.segment.Share(), 1);
  constexpr int kBins = 12, kSamples = 400000;
  const auto binOf = [&](double t) { return std::min(static_cast<int>((t - start) / length * kBins), kBins - 1); };
  // By light, patch and bin: samples; and the sum and sum of squares of densities at uniform distances.
  struct Bin {
    double count = 0, sum = 0, squares = 0;
  };
  std::map<std::pair<uint32_t, int>, std::vector<Bin>> bins;
  Rng rng(7);
  for (int i = 0; i < kSamples; ++i) {
    const Point2 choice = rng.NextPoint2(), apex = rng.NextPoint2();
    const auto sample = flown.segment.Generate(*built.scene.lighting, choice, apex);
    if (!sample) continue;
    auto& of = bins[{sample->light.light, sample->light.patch}];
    of.resize(kBins);
    ++of[static_cast<size_t>(binOf(sample->t))].count;
    EXPECT_GE(sample->t, start);
    EXPECT_LE(sample->t, start + length * (1 + 1e-6));
    // The density of a sample is that which another technique computes from the same apex.
    if (i < 2000) {
      const double again =
          flown.segment.Density(*built.scene.lighting, sample->light.light, sample->light.patch, sample->t, apex);
      EXPECT_NEAR(again, flown.segment.Density(*sample), 1e-3 * again);
    }
  }
  EXPECT_EQ(bins.size(), 6u);  // four lights of one patch, and two triangles
  for (auto& [light, of] : bins) {
    for (int i = 0; i < kSamples / 4; ++i) {
      const double t = start + length * static_cast<double>(rng.NextFloat());
      const double p =
          length * flown.segment.Density(*built.scene.lighting, light.first, light.second, t, rng.NextPoint2());
      Bin& bin = of[static_cast<size_t>(binOf(t))];
      bin.sum += p;
      bin.squares += p * p;
    }
    for (int b = 0; b < kBins; ++b) {
      const Bin& bin = of[static_cast<size_t>(b)];
      const double n = kSamples, m = kSamples / 4.0;
      const double sampled = bin.count / n, expected = bin.sum / m;
      const double variance = sampled * (1 - sampled) / n + (bin.squares / m - expected * expected) / m;
      EXPECT_LT(std::abs(sampled - expected), 4.5 * std::sqrt(variance) + 1e-6)
          << "light " << light.first << ", patch " << light.second << ", bin " << b << ": " << sampled << " sampled, "
          << expected << " by the density";
    }
  }
}

TEST(LitSegment, IsTheLessCommonTheSurerAWalkCollides) {
  const std::string thick = "\"string type\" \"homogeneous\" \"rgb sigma_s\" [20 20 20] \"rgb sigma_a\" [0 0 0]";
  const BuiltScene fog = Build(thick, kLights);
  const Flown flown(fog);
  const double depth = 20 * (flown.flight.spans[0].tMax - flown.flight.spans[0].tMin);
  EXPECT_NEAR(flown.segment.Share(), 4 / depth, 1e-5);
  const std::string grid =
      "\"string type\" \"uniformgrid\" \"float density\" [1 1 1 1 1 1 1 1] \"integer nx\" 2 \"integer ny\" 2 \"integer "
      "nz\" 2 \"point3 p0\" [-9 -9 -9] \"point3 p1\" [9 9 9]";
  const BuiltScene smoke = Build(grid, kLights);
  EXPECT_EQ(Flown(smoke).segment.Share(), 1);
  EXPECT_EQ(Flown(smoke, false).segment.Share(), 0.25f);
  const BuiltScene ink = Build("\"string type\" \"homogeneous\" \"rgb sigma_s\" [0 0 0]", kLights);
  EXPECT_EQ(Flown(ink).segment.Share(), 0);
}

// In the fog of a point light. Without these distances the variance has no bound: relMSE × time is 30 times as much.
TEST(LitSegment, TheFogOfALampIsNotNoisy) {
  const std::string scene =
      R"(MakeNamedMedium "mist" "string type" "homogeneous" "rgb sigma_s" [0.2 0.2 0.2] "rgb sigma_a" [0 0 0]
MediumInterface "" "mist"
LookAt 0 1 -5  0 1 0  0 1 0
Camera "perspective" "float fov" 50
Film "rgb" "integer xresolution" 24 "integer yresolution" 24
Integrator "path" "integer maxdepth" 1
WorldBegin
LightSource "point" "rgb I" [9 9 9] "point3 from" [0.4 1.5 0]
)";
  constexpr int kSeeds = 8;
  const std::vector<Image> images = RenderReplicas(scene, "path", kSeeds, 16).images;
  double worst = 0, sum = 0;
  for (int y = 0; y < 24; ++y) {
    for (int x = 0; x < 24; ++x) {
      double mean = 0, squares = 0;
      for (const Image& image : images) {
        const double value = static_cast<double>(image.RgbAt(x, y).Average());
        mean += value / kSeeds;
        squares += value * value / kSeeds;
      }
      const double relative = (squares - mean * mean) / (mean * mean) * kSeeds / (kSeeds - 1.0);
      sum += relative;
      worst = std::max(worst, relative);
    }
  }
  std::printf("relative variance of 16 samples: mean %.2e, worst %.2e\n", sum / (24 * 24), worst);
  EXPECT_LT(sum / (24 * 24), 2e-3);
}

}  // namespace
}  // namespace lampyr::test
