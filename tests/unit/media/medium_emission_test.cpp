// Points sampled in proportion to what media emit: integrals over the emission, against their exact values.
#include "media/medium_emission.h"

#include <cmath>
#include <functional>

#include "sampling/rng.h"
#include "unit/geometry/helpers.h"
#include "unit/media/medium_scene.h"

namespace lampyr {
namespace {

using testing::Entry;
using testing::Place;
using testing::Sphere;

constexpr double kPiD = 3.14159265358979323846;

GeometryEntry Boundary(const Transform& placement, float radius, int32_t inside, int32_t outside) {
  GeometryEntry entry = Entry(Place(Sphere(radius), placement));
  entry.attributes.isBoundary = true;
  entry.attributes.insideMedium = inside;
  entry.attributes.outsideMedium = outside;
  return entry;
}

GeometryScene SceneOf(std::vector<GeometryEntry> entries) {
  GeometryDescription description;
  description.entries = std::move(entries);
  return GeometryScene(std::move(description));
}

std::vector<std::shared_ptr<const Medium>> Media(const std::string& text) {
  Diagnostics strict(Diagnostics::Mode::Strict);
  return MediaOf(text, strict);
}

std::string Glowing(const std::string& name, double emission) {
  return "MakeNamedMedium \"" + name + "\" \"string type\" \"homogeneous\" \"rgb sigma_s\" [0 0 0] \"rgb sigma_a\" " +
         "[1 1 1] \"rgb Le\" [" + std::to_string(emission) + " " + std::to_string(2 * emission) + " 0]\n";
}

struct Estimate {
  double mean = 0, error = 0;  // standard error
  double found = 0;            // part of the samples that are worth something
};

// Estimates ∫ f(x, ε(x)) dV.
Estimate Integral(const MediumEmission& emission, const std::function<double(const EmissionPoint&)>& f) {
  constexpr int kSamples = 200000;
  Rng rng(5);
  double sum = 0, squares = 0;
  int found = 0;
  for (int i = 0; i < kSamples; ++i) {
    const double uSelect = static_cast<double>(rng.NextUint64() >> 12) * 0x1p-52;
    const Vector3 u(rng.NextFloat(), rng.NextFloat(), rng.NextFloat());
    const auto point = emission.Sample(uSelect, u, 0);
    if (!point) continue;
    ++found;
    const double value = f(*point) / point->density;
    sum += value;
    squares += value * value;
  }
  const double mean = sum / kSamples;
  return {mean, std::sqrt((squares / kSamples - mean * mean) / kSamples), found / static_cast<double>(kSamples)};
}

void ExpectIntegral(const MediumEmission& emission, double expected,
                    const std::function<double(const EmissionPoint&)>& f) {
  const Estimate estimate = Integral(emission, f);
  EXPECT_LT(std::abs(estimate.mean - expected), 4 * estimate.error) << estimate.mean << " for " << expected;
  EXPECT_LT(estimate.error, 0.01 * std::abs(expected)) << "too noisy to say anything";
}

double Green(const EmissionPoint& point) {
  return static_cast<double>(point.emission.g);
}

// A shell around a ball of another medium, and a small ball aside: the volume, the place and the choice of each.
TEST(MediumEmission, IsWhereTheMediumIs) {
  const Point3d middle(0.5, -0.25, 0.125), aside(3, 1, 0);
  const GeometryScene scene = SceneOf({Boundary(Transform::Translate(middle), 1, 0, kVacuum),
                                       Boundary(Transform::Translate(middle), 0.6f, 1, 0),
                                       Boundary(Transform::Translate(aside), 0.1f, 2, kVacuum), Entry(Sphere(8))});
  const MediumEmission emission(Media(Glowing("shell", 1) + Glowing("core", 0.5) + Glowing("spark", 100)), scene,
                                scene.GetBoundingSphere(), kVacuum);
  const auto ball = [](double r) { return 4 * kPiD / 3 * r * r * r; };
  const double shell = 2 * (ball(1) - ball(0.6)), core = ball(0.6), spark = 200 * ball(0.1);
  ExpectIntegral(emission, shell + core + spark, Green);
  ExpectIntegral(emission, shell, [](const EmissionPoint& p) { return p.medium == 0 ? Green(p) : 0; });
  ExpectIntegral(emission, core, [](const EmissionPoint& p) { return p.medium == 1 ? Green(p) : 0; });
  // ∫ r² dV of a ball is 4π/5 R⁵.
  ExpectIntegral(emission, 2 * 4 * kPiD / 5 * (1 - std::pow(0.6, 5)), [&](const EmissionPoint& p) {
    const Point3d away = Point3d(p.position) - middle;
    return p.medium == 0 ? Green(p) * glm::dot(away, away) : 0;
  });
  ExpectIntegral(emission, spark * aside.x, [&](const EmissionPoint& p) {
    return p.medium == 2 ? Green(p) * static_cast<double>(p.position.x) : 0;
  });
  EXPECT_NEAR(emission.Power() / (4 * kPiD * 0.5 * (shell + core + spark)), 1, 0.05);
  EXPECT_GT(Integral(emission, Green).found, 0.3);
}

TEST(MediumEmission, FillsTheSphereWithoutABoundary) {
  const GeometryScene scene =
      SceneOf({Boundary(Transform::Translate({0.2, 0, 0}), 0.5f, kVacuum, 0), Entry(Sphere(1))});
  const MediumEmission emission(Media(Glowing("everywhere", 1)), scene, {Point3(0.0f), 2}, 0);
  ExpectIntegral(emission, 2 * 4 * kPiD / 3 * (8 - 0.125), Green);
}

// Grids: a turned box with emission that varies, half of which a boundary cuts off; against a sum over a fine grid.
TEST(MediumEmission, FollowsTheVoxelsOfAGrid) {
  const std::string text =
      "Rotate 30 1 2 3 Scale 1 2 0.5\nMakeNamedMedium \"fire\" \"string type\" \"uniformgrid\" \"integer nx\" 3 "
      "\"integer ny\" 2 \"integer nz\" 2 \"float density\" [0 1 2  5 0 0  0 0 0.5  1 0 3] \"float Lescale\" [1 0 3  1 "
      "1 "
      "1  2 2 0  1 4 1] \"rgb Le\" [1 2 0] \"rgb sigma_a\" [1 1 1] \"rgb sigma_s\" [1 1 1]\n";
  const auto media = Media(text);
  const GeometryScene scene = SceneOf({Boundary(Transform::Translate({0.2, 0.6, 0.4}), 0.8f, 0, kVacuum),
                                       Boundary(Transform::Translate({4, 0, 0}), 0.8f, kVacuum, kVacuum)});
  const MediumEmission emission(media, scene, scene.GetBoundingSphere(), kVacuum);
  double sum = 0, sumOfX = 0;
  constexpr int kSteps = 200;
  for (int i = 0; i < kSteps * kSteps * kSteps; ++i) {
    const Point3d offset =
        Point3d(i % kSteps + 0.5, i / kSteps % kSteps + 0.5, i / kSteps / kSteps + 0.5) * (1.6 / kSteps) - Point3d(0.8);
    if (glm::length(offset) >= 0.8) continue;
    const Point3 p(Point3d(0.2, 0.6, 0.4) + offset);
    const auto green = static_cast<double>(media[0]->At(p).emission.g);
    sum += green;
    sumOfX += green * static_cast<double>(p.x);
  }
  const double volume = std::pow(1.6 / kSteps, 3);
  ExpectIntegral(emission, sum * volume, Green);
  ExpectIntegral(emission, sumOfX * volume,
                 [](const EmissionPoint& p) { return Green(p) * static_cast<double>(p.position.x); });
}

TEST(MediumEmission, IsNothingWithoutGlow) {
  const GeometryScene scene = SceneOf({Entry(Sphere(1))});
  const MediumEmission emission(Media("MakeNamedMedium \"fog\" \"string type\" \"homogeneous\"\n"), scene,
                                scene.GetBoundingSphere(), 0);
  EXPECT_EQ(emission.Power(), 0);
}

}  // namespace
}  // namespace lampyr
