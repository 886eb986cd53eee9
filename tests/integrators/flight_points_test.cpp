// Points of flights of light paths that are sampled for the camera: their density, and where they are.
#include "integrators/walk/flight_points.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "integrators/bidirectional/bidirectional_integrator.h"
#include "support/replicas.h"

namespace lampyr::test {
namespace {

const char* const kView = "LookAt 0 0 -6  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 30\n";

std::string Fog(double scattering) {
  const std::string s = std::to_string(scattering);
  return "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" \"rgb sigma_s\" [" + s + " " + s + " " + s +
         "] \"rgb sigma_a\" [0 0 0]\n";
}
const char* const kBall = "Material \"interface\" MediumInterface \"fog\" \"\" Shape \"sphere\" \"float radius\" 1.5\n";

BuiltScene Build(const std::string& camera, const std::string& world) {
  Diagnostics diagnostics(Diagnostics::Mode::Collect);
  const std::string text = "Film \"rgb\" \"integer xresolution\" 8 \"integer yresolution\" 8\n" + camera +
                           "WorldBegin\nLightSource \"point\" \"point3 from\" [2 1 0] \"rgb I\" [9 9 9]\n" + world;
  return BuildScene(ParseScene(text, "flights.pbrt", diagnostics), {}, true, diagnostics);
}

// Directions are those of rays: of float, and not quite unit. `away`: distance of the start, where that is not near.
FineLine RandomLine(Rng& rng, double away = 0) {
  const auto point = [&](double size) {
    const double x = static_cast<double>(rng.NextFloat()), y = static_cast<double>(rng.NextFloat());
    return Vector3d(2 * x - 1, 2 * y - 1, 2 * static_cast<double>(rng.NextFloat()) - 1) * size;
  };
  FineLine line;
  line.start = point(3);
  if (away > 0) line.start *= away / glm::length(line.start);
  line.direction = Vector3d(glm::normalize(Vector3(point(1) - line.start)));
  return line;
}

class FlightPointsOf : public ::testing::TestWithParam<const char*> {};

// The density that other techniques compute from a vertex and the way to the start of its flight.
TEST_P(FlightPointsOf, SamplesFollowTheDensity) {
  const BuiltScene built = Build(GetParam(), Fog(0.3) + kBall);
  const auto points = FlightPoints::Of(built.scene);
  ASSERT_NE(points, nullptr);
  ASSERT_EQ(points->ShareAt(Point3d(0.0), 0), 1);
  Rng rng(3);
  int seen = 0;
  for (int i = 0; i < 300; ++i) {
    const double away = i % 4 == 0 ? 1e4 : i % 4 == 1 ? 1e6 : 0.0;
    const FineLine line = RandomLine(rng, away);
    const bool startsAnywhere = i % 3 == 0;
    double worst = 0, sum = 0;
    constexpr int kSamples = 64;
    double last = 0;
    for (int k = 0; k < kSamples; ++k) {
      const auto sample = points->Generate(line, startsAnywhere, (k + 0.5) / kSamples);
      if (!sample) continue;
      EXPECT_GE(sample->t, last);
      last = sample->t;
      const Point3d at = line.start + sample->t * line.direction;
      const double distance = startsAnywhere ? std::numeric_limits<double>::infinity() : sample->t;
      const double again = points->Density(at, -line.direction, distance, 0);
      worst = std::max(worst, std::abs(again / sample->density - 1));
      sum += 1;
    }
    EXPECT_LT(worst, 1e-8 * (1 + away)) << i;
    if (away > 1e5) {
      EXPECT_EQ(sum, kSamples) << i;
    }
    if (sum < kSamples) continue;
    ++seen;
    // The integral of the density between the first and the last sample.
    constexpr int kSteps = 20000;
    double integral = 0;
    const double end = points->Generate(line, startsAnywhere, 1 - 1e-12)->t;
    const double start = points->Generate(line, startsAnywhere, 1e-12)->t;
    if (end - start < 1e-6) continue;  // the line is nearly tangent to the sphere of the medium
    for (int k = 0; k < kSteps; ++k) {
      const double t = start + (end - start) * (k + 0.5) / kSteps;
      const double distance = startsAnywhere ? std::numeric_limits<double>::infinity() : t;
      integral += points->Density(line.start + t * line.direction, -line.direction, distance, 0);
    }
    EXPECT_NEAR(integral * (end - start) / kSteps, 1, 1e-3) << i;
  }
  EXPECT_GT(seen, 20);
}
INSTANTIATE_TEST_SUITE_P(
    OfCameras, FlightPointsOf,
    ::testing::Values(kView,
                      "LookAt 0 0 -6  0 0 0  0 1 0\nCamera \"perspective\" \"float lensradius\" 0.2 \"float "
                      "focaldistance\" 6\n",
                      "Scale -1 1 1 LookAt 1 0 -3  0 0 0  0 1 0\nCamera \"spherical\"\n"),
    [](const auto& info) {
      return std::string(info.index == 0 ? "Pinhole" : info.index == 1 ? "Lens" : "Spherical");
    });

TEST(FlightPoints, AreWhereTheImageIs) {
  const BuiltScene built = Build(kView, Fog(0.3) + kBall);
  const auto points = FlightPoints::Of(built.scene);
  ASSERT_NE(points, nullptr);
  Rng rng(5);
  int seen = 0;
  for (int i = 0; i < 2000; ++i) {
    const FineLine line = RandomLine(rng);
    const auto sample = points->Generate(line, false, static_cast<double>(rng.NextFloat()));
    if (!sample) continue;
    ++seen;
    const Point3d at = line.start + sample->t * line.direction;
    EXPECT_LT(glm::length(Vector3d(at)), 1.5 * std::sqrt(3.0) + 1e-6);  // the sphere around the medium's box
    const auto film = built.scene.camera->Connect(Point3(at), Point2(0.5f));
    ASSERT_TRUE(film.has_value());
    for (const float x : {film->film.x, film->film.y}) {
      EXPECT_GT(x, -1e-3f);
      EXPECT_LT(x, 8 + 1e-3f);
    }
  }
  EXPECT_GT(seen, 500);
}

TEST(FlightPoints, AreFewerInDenseMedia) {
  const auto shareIn = [](const char* camera, double scattering, const Point3d& position) {
    return FlightPoints::Of(Build(camera, Fog(scattering) + kBall).scene)->ShareAt(position, 0);
  };
  const double across = 2 * 1.5 * std::sqrt(3.0);  // the sphere around the ball's box, which is nearer than the camera
  EXPECT_EQ(shareIn(kView, 0.5, Point3d(0.0)), 1);
  EXPECT_NEAR(shareIn(kView, 20, Point3d(0.0)), 4 / (20 * across), 1e-5);
  const char* const within = "LookAt 0 0 -1  0 0 0  0 1 0\nCamera \"perspective\"\n";
  EXPECT_NEAR(shareIn(within, 20, Point3d(0.0)), 4.0 / 20, 1e-5);
  EXPECT_EQ(shareIn(within, 20, Point3d(0, 0, -0.9)), 1);
}

TEST(FlightPoints, AreNotWhereTheCameraSeesNoneStraight) {
  const std::string inGlass =
      "Material \"dielectric\" MediumInterface \"fog\" \"\" Shape \"sphere\" \"float radius\" 1.5\n";
  EXPECT_EQ(FlightPoints::Of(Build(kView, Fog(0.3) + inGlass).scene), nullptr);
  EXPECT_EQ(FlightPoints::Of(Build(kView, Fog(0) + kBall).scene), nullptr);
  EXPECT_EQ(FlightPoints::Of(Build(kView, "Shape \"sphere\"\n").scene), nullptr);
  EXPECT_EQ(FlightPoints::Of(Build("Camera \"orthographic\"\n", Fog(0.3) + kBall).scene), nullptr);
  const BuiltScene within = Build("LookAt 0 0 -1  0 0 0  0 1 0\nCamera \"perspective\"\n", Fog(0.3) + inGlass);
  EXPECT_NE(FlightPoints::Of(within.scene), nullptr);
}

// The light of a picture, by many samples of bdpt: mean and variance of a sample.
struct Light {
  double mean = 0, variance = 0;
};
Light LightOf(const BuiltScene& built, bool hasFlights, int samples) {
  BidirectionalSettings settings;
  settings.maxDepth = 3;
  settings.filmPixels = 64;
  if (hasFlights) settings.flightPoints = FlightPoints::Of(built.scene);
  const auto integrator = MakeBidirectionalIntegrator(settings);
  Sampler sampler(SamplerKind::Independent, 11);
  RenderCounts counts;
  SplatList splats({0, 0}, {8, 8}, 1);
  double sum = 0, squares = 0;
  for (int i = 0; i < samples; ++i) {
    sampler.StartPixelSample(0, 0, static_cast<uint32_t>(i));
    splats.Clear();
    splats.StartPath();
    sampler.SetDimension(dimensions::kFilm);
    const Point2 film = sampler.Get2D() * 8.0f;
    SampleContext context{built.scene, sampler, 0, counts};
    context.film = film;
    context.splats = &splats;
    const CameraRay ray = built.scene.camera->GenerateRay(film, Point2(0.5f), 0);
    double value = static_cast<double>(integrator->Sample(&ray.ray, context).Average());
    for (const auto& splat : splats.Splats()) value += static_cast<double>(splat.value.Average()) / 64;
    sum += value;
    squares += value * value;
  }
  const double mean = sum / samples;
  return {mean, squares / samples - mean * mean};
}

// Thin fog beside a lamp that points away from the camera: camera paths rarely find the beam.
TEST(FlightPoints, MakeThinFogLessNoisyAndNotBrighter) {
  const std::string world = Fog(0.02) +
                            "LightSource \"spot\" \"point3 from\" [-3 0.2 0] \"point3 to\" [0 0 0] \"float "
                            "coneangle\" 4 \"rgb I\" [500 500 500]\n" +
                            kBall;
  const BuiltScene built = Build(kView, world);
  constexpr int kSamples = 100000;
  const Light without = LightOf(built, false, kSamples), with = LightOf(built, true, kSamples);
  const double error = std::sqrt((without.variance + with.variance) / kSamples);
  EXPECT_LT(std::abs(without.mean - with.mean), 4 * error) << without.mean << " " << with.mean;
  EXPECT_LT(error, 0.1 * with.mean);
  EXPECT_GT(without.variance, 3 * with.variance) << without.variance << " " << with.variance;
}

}  // namespace
}  // namespace lampyr::test
