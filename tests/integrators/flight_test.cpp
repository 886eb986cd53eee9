// Rays through media that cannot be traced, and collisions within the rounding of positions.
#include <gtest/gtest.h>

#include <array>

#include "integrators/walk/flight.h"
#include "integrators/walk/walk.h"
#include "sampling/warp.h"
#include "support/render_scene.h"

namespace lampyr::test {
namespace {

BuiltScene Build(const std::string& world) {
  Diagnostics diagnostics(Diagnostics::Mode::Collect);
  return BuildScene(ParseScene("Camera \"perspective\" WorldBegin\n" + world, "flight.pbrt", diagnostics), {}, true,
                    diagnostics);
}

// A fog of this mean free path in a ball of radius 1 around (1, 2, 3).
BuiltScene Fog(const std::string& scattering) {
  return Build("MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" \"rgb sigma_s\" [" + scattering + " " +
               scattering + " " + scattering +
               "] \"rgb sigma_a\" [0 0 0]\nTranslate 1 2 3 Material \"interface\" MediumInterface \"fog\" \"\" Shape "
               "\"sphere\"\nLightSource \"infinite\"\n");
}

// A lamp on a pendulum is higher in the middle of its swing than at either end.
TEST(Flight, AnEndlessMediumReachesWhereverALightMoves) {
  Diagnostics diagnostics(Diagnostics::Mode::Collect);
  const BuiltScene built = BuildScene(
      ParseScene("MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" MediumInterface \"\" \"fog\"\n"
                 "Camera \"perspective\" WorldBegin MediumInterface \"fog\" Shape \"sphere\"\n"
                 "Translate 0 6 0 ActiveTransform StartTime Rotate -88 0 0 1 ActiveTransform EndTime Rotate 88 0 0 1\n"
                 "ActiveTransform All LightSource \"point\" \"point3 from\" [0 6 0]\n",
                 "flight.pbrt", diagnostics),
      {}, true, diagnostics);
  // The shape, around which render space lies, has the radius 1; the top is 12 away.
  EXPECT_GE(built.scene.lighting->SceneSphere().radius, 11.9f);
}

TEST(Flight, OfARejectedRayCarriesNothing) {
  const BuiltScene fog = Fog("0.01");
  Sampler sampler(SamplerKind::Independent, 1);
  sampler.StartPixelSample(1, 0, 0);
  RenderCounts counts;
  const SampleContext context{fog.scene, sampler, 0, counts};
  const EdgeEnd start{Point3d(1, 2, 3), 0};
  for (const Vector3& direction : {Vector3(0, 0, 0), Vector3(kInfinity, 0, 0), Vector3(0, std::nanf(""), 1)}) {
    Flight flight;
    Fly(context, {Point3(1, 2, 3), direction}, visibility::kIndirect, start, Color(1.0f), 0, false, flight);
    EXPECT_FALSE(flight.isHit || flight.collidesWith);
    EXPECT_TRUE(flight.passed.IsBlack());
    EdgeFactors factors;
    const Ray connection{Point3(1, 2, 3), direction, 2};
    EXPECT_TRUE(TransmittanceOf(context, connection, visibility::kShadow, start, start, 1, factors).IsBlack());
  }
  EXPECT_EQ(fog.scene.geometry->RejectedRays(), 6u);
}

// Notes how far the vertices of a walk are from each other.
class Steps final : public PathVisitor {
 public:
  bool Arrived(Subpath& path, const PathState&) override {
    const PathVertex& last = path.Last();
    if (path.Count() > 1) {
      const double step = glm::length(path[path.Count() - 2].WayTo(last));
      sum += step;
      ++count;
      smallest = std::min(smallest, step);
    }
    return last.IsInMedium();
  }
  double sum = 0, smallest = 1;
  int count = 0;
};

// Steps of a mean free path that is a hundredth of what positions resolve: their mean is right, and no two vertices are
// in one place, where the density of the second would be infinite.
TEST(Flight, StepsMayBeShorterThanRounding) {
  const BuiltScene fog = Fog("4e8");
  Sampler sampler(SamplerKind::Independent, 2);
  RenderCounts counts;
  const SampleContext context{fog.scene, sampler, 0, counts};
  Steps steps;
  Subpath path;
  for (uint32_t i = 0; i < 500; ++i) {
    sampler.StartPixelSample(1, 0, i);
    PathState state;
    state.ray = {Point3(1.25f, 2.125f, 3.375f), SampleUniformSphere({0.3f, 0.01f * static_cast<float>(i % 100)})};
    state.medium = 0;
    state.specular = Color(1.0f);
    path.Clear();
    Walk(context, {TransportMode::Radiance, 100, {}, false}, state, path, steps);
  }
  EXPECT_EQ(steps.count, 500 * 99);
  EXPECT_GT(steps.smallest, 0);
  const double mean = steps.sum / steps.count * 4e8;
  EXPECT_NEAR(mean, 1, 5 / std::sqrt(steps.count));
}

// Second moments after a collision, relative to the squared throughput, of a channel and of the sum of all: by
// integration over distances, for walks that are sampled by the channels' probabilities.
TEST(Flight, ADarkChannelIsNotMuchNoisierThanTheRest) {
  const struct {
    Color throughput, extinction;
    double mostOfChannel, mostOfSum;
  } cases[] = {{{1, 1, 1}, {1, 2, 4}, 1.5, 1.001},
               {{1, 0.01f, 0.01f}, {5, 0.05f, 0.05f}, 20, 1.06},
               {{1e-4f, 1, 0.5f}, {0.01f, 1, 3}, 1500, 1.02},
               {{0, 1, 0}, {1, 2, 3}, 1.001, 1.001}};
  for (const auto& one : cases) {
    const Color chosen = ChannelsOf(one.throughput);
    EXPECT_NEAR(chosen.r + chosen.g + chosen.b, 1, 1e-6f);
    const auto parts = [](const Color& c) {
      return std::array<double, 3>{static_cast<double>(c.r), static_cast<double>(c.g), static_cast<double>(c.b)};
    };
    const std::array<double, 3> channels = parts(chosen), throughput = parts(one.throughput),
                                extinction = parts(one.extinction);
    double moments[3] = {}, ofSum = 0;
    constexpr double kStep = 1e-3;  // of the logarithm of the distance
    for (double logT = -14; logT < 10; logT += kStep) {
      const double t = std::exp(logT), dt = t * kStep;
      double density = 0, carried[3], sum = 0;
      for (size_t c = 0; c < 3; ++c) {
        const double p = extinction[c] * std::exp(-extinction[c] * t);
        density += channels[c] * p;
        carried[c] = throughput[c] * p;
        sum += carried[c];
      }
      if (!(density > 0)) continue;
      for (size_t c = 0; c < 3; ++c) moments[c] += carried[c] * carried[c] / density * dt;
      ofSum += sum * sum / density * dt;
    }
    const double all = throughput[0] + throughput[1] + throughput[2];
    EXPECT_LT(ofSum / (all * all), one.mostOfSum);
    for (size_t c = 0; c < 3; ++c) {
      EXPECT_LE(moments[c], one.mostOfChannel * throughput[c] * throughput[c]) << c;
    }
  }
}

}  // namespace
}  // namespace lampyr::test
