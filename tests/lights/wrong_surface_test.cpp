// Lights that are their own surface: unusual ones that are right pass the suite, and each fault is caught by the
// property that names it.
#include <gtest/gtest.h>

#include <map>
#include <set>

#include "suite/pdf_suite.h"
#include "support/whole.h"
#include "tiles_light.h"

namespace lampyr {
namespace {

using test::Tile;
using test::TileFault;
using test::TilesLight;
using test::TilesSetup;

Tile Square(const Point3& middle, const Vector3& a, const Vector3& b) {
  return {middle - 0.5f * a - 0.5f * b, a, b};
}

// Not square, so that u and v differ.
TilesSetup OneTile() {
  TilesSetup setup;
  setup.tiles = {Square({0, 0, 0}, {2, 0, 0}, {0, 1.4f, 0})};
  return setup;
}

TilesSetup TwoPieces() {
  TilesSetup setup;
  setup.tiles = {Square({-1, 0, 0}, {0.8f, 0, 0}, {0, 1, 0.3f}),
                 Square({0.9f, 0.2f, 0.4f}, {0, 0.9f, 0}, {0, 0, 0.7f})};
  setup.twoSided = true;
  return setup;
}

// Six tiles that shine inwards.
TilesSetup ClosedBox() {
  TilesSetup setup;
  setup.tiles = {Square({0, 0, -1}, {2, 0, 0}, {0, 2, 0}), Square({0, 0, 1}, {0, 2, 0}, {2, 0, 0}),
                 Square({-1, 0, 0}, {0, 2, 0}, {0, 0, 2}), Square({1, 0, 0}, {0, 0, 2}, {0, 2, 0}),
                 Square({0, -1, 0}, {0, 0, 2}, {2, 0, 0}), Square({0, 1, 0}, {2, 0, 0}, {0, 0, 2})};
  return setup;
}

// A frame of four tiles around a hole.
TilesSetup WithHole() {
  TilesSetup setup;
  setup.tiles = {Square({0, -0.8f, 0}, {2, 0, 0}, {0, 0.4f, 0}), Square({0, 0.8f, 0}, {2, 0, 0}, {0, 0.4f, 0}),
                 Square({-0.8f, 0, 0}, {0.4f, 0, 0}, {0, 1.2f, 0}), Square({0.8f, 0, 0}, {0.4f, 0, 0}, {0, 1.2f, 0})};
  return setup;
}

TilesSetup NarrowBeam() {
  TilesSetup setup = OneTile();
  setup.cosCone = 0.996f;  // 5°
  return setup;
}

TilesSetup Uneven() {
  TilesSetup setup = OneTile();
  setup.pattern = {0, 0.01f, 5, 1, 2, 0, 0, 0.3f, 100, 0.02f, 1, 1, 0, 0, 7, 0.5f};
  setup.diffuse = 0.5f;
  setup.specular = 2;
  return setup;
}

std::map<std::string, std::string> Failures(const TilesSetup& setup, const Transform& transform,
                                            bool isThorough = false) {
  const TilesLight light(setup);
  const LightTransform placed{transform.ToAffine(), transform.Inverse().ToAffine()};
  SuiteSubject subject;
  subject.light = &light;
  subject.isThorough = isThorough;
  subject.context.transform = &placed;
  subject.context.scene = {placed.toRender.translation, 10};
  subject.context.bidirectional = true;
  subject.diffuseMultiplier = static_cast<double>(setup.diffuse);
  subject.specularMultiplier = static_cast<double>(setup.specular);
  subject.name = "tiles";
  subject.caseName = "test";
  SuiteReport report;
  CheckLight(subject, {}, report);
  std::map<std::string, std::string> failed;
  for (const SuiteResult& result : report.Finish(1e-3)) {
    if (!result.passed) failed[result.property] = result.caseName + " " + result.words;
  }
  return failed;
}

const Transform kTurned = Transform::Translate({0.4, -1, 2}) * Transform::Rotate(40, {1, 0.5, 0.2});
const Transform kStretched = kTurned * Transform::Scale({1.6, 0.5, 1.2}) * Transform::Rotate(30, {0.3, 1, 0});
const Transform kMirrored = kTurned * Transform::Scale({-1, 1, 1});

TEST(SurfaceLights, UnusualOnesPass) {
  const std::map<std::string, TilesSetup> lights = {{"one tile", OneTile()},       {"two pieces", TwoPieces()},
                                                    {"closed box", ClosedBox()},   {"with a hole", WithHole()},
                                                    {"narrow beam", NarrowBeam()}, {"uneven", Uneven()}};
  // Unless all are wanted, each light has one of the transforms, in turn.
  size_t turn = 0;
  for (const auto& [name, setup] : lights) {
    const std::vector<const Transform*> all = {&kTurned, &kStretched, &kMirrored};
    for (const Transform* transform : test::IsWhole() ? all : std::vector{all[turn++ % 3]}) {
      for (const auto& [property, why] : Failures(setup, *transform, transform == &kStretched))
        ADD_FAILURE() << name << ": " << property << " " << why;
    }
  }
}

TEST(SurfaceLights, EveryFaultIsFoundAndNamed) {
  const std::map<TileFault, std::string> faults = {
      {TileFault::NormalWrong, "surface"},
      {TileFault::UvMirrored, "surface"},
      {TileFault::HitTooFar, "surface"},
      {TileFault::StretchForgotten, "integral"},
      {TileFault::PdfOffByOnePercent, "integral"},
      {TileFault::CosineForgotten, "integral"},
      {TileFault::LeaksBehind, "one-sided"},
      {TileFault::ZeroWhereItEmits, "irradiance"},
      {TileFault::PhotonsWithoutTint, "emission-edge"},
      {TileFault::AllPhotonsWithoutTint, "power"},
      {TileFault::SpecularForgotten, "consistency"},
      {TileFault::MultipliersSwapped, "multipliers"},
      {TileFault::CameraSeesMultiplier, "camera"},
      {TileFault::PowerOffByTwo, "power-estimate"},
      {TileFault::PhotonsUnevenly, "emission-positions"},
      {TileFault::PhotonsUniform, "emission-directions"},
      {TileFault::EmitDensityOff, "emission-integral"},
      {TileFault::DirectionDensityOff, "emission-integral"},
      {TileFault::BoundsTooSmall, "bounds"},
      {TileFault::EmissionBoundsTooSmall, "bounds"},
      {TileFault::EstimateIsZero, "estimate"},
      {TileFault::SegmentEndsEarly, "estimate"},
  };
  for (const auto& [fault, property] : faults) {
    TilesSetup setup = Uneven();
    setup.pattern = {0, 0.2f, 1, 1, 2, 0, 0, 0.3f, 3, 0.5f, 1, 1, 0, 0, 2, 0.5f};
    setup.fault = fault;
    const auto failed = Failures(setup, kStretched);
    EXPECT_TRUE(failed.count(property)) << "fault " << static_cast<int>(fault) << " should fail " << property
                                        << "; fails " << failed.size();
    if (failed.count(property)) continue;
    for (const auto& [other, why] : failed) std::cout << "  fails " << other << ": " << why << "\n";
  }
}

}  // namespace
}  // namespace lampyr
