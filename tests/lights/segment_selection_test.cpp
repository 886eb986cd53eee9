// Lights for segments of rays: selection is a distribution that knows its own probabilities, leaves out nothing that
// arrives, and with equiangular distances sums up what the lights send to the segment.
#include <gtest/gtest.h>

#include "lights/selection/segment_importance_lanes.h"
#include "lit_scene.h"
#include "random_emitters.h"
#include "suite/statistics.h"
#include "support/chi_squared.h"

namespace lampyr {
namespace {

using test::LitScene;
using testing::ChiSquaredPValue;
using testing::SidakLevel;

constexpr LightSelection kSelections[] = {LightSelection::Uniform, LightSelection::Power, LightSelection::Tree,
                                          LightSelection::Exhaustive};

// Through the lights, around them, far away; short, long and without an end.
RaySegment RandomSegment(Rng& rng, uint32_t link) {
  constexpr float sizes[] = {3, 3, 10, 1e4f};
  RaySegment segment;
  segment.origin = test::RandomPoint(rng, sizes[rng.NextUint32() % 4]);
  segment.direction = test::RandomDirection(rng);
  const float to = glm::length(segment.origin);
  if (rng.NextUint32() % 2) segment.direction = glm::normalize(test::RandomPoint(rng, 3) - segment.origin);
  constexpr float lengths[] = {0.01f, 1, 2, kInfinity};
  segment.length = lengths[rng.NextUint32() % 4] * std::max(to, 0.1f);
  segment.link = link;
  return segment;
}

int PatchesOf(const LightingServices& lighting, uint32_t link, uint32_t light) {
  const bool selectsPatches = lighting.SelectsPatches(Receiver::InMedium(Point3(0.0f), link));
  return selectsPatches ? lighting.Lights()[light].light->PatchCount() : 1;
}

// p-value of the frequencies of the lights that are selected and reach the segment; those that do not are one cell.
double FrequencyPValue(const LightingServices& lighting, const RaySegment& segment, Rng& rng) {
  constexpr int draws = 10000;
  std::vector<double> expected{0}, observed;
  std::vector<size_t> first;
  double sum = 0;
  for (uint32_t i = 0; i < lighting.Lights().size(); ++i) {
    first.push_back(expected.size());
    for (int patch = 0; patch < PatchesOf(lighting, segment.link, i); ++patch) {
      const int own = lighting.Lights()[i].light->PatchCount() > 1 ? patch : kAnyPatch;
      const auto probability = static_cast<double>(lighting.SegmentSelectionProbability(segment, i, own).value);
      const bool reaches = lighting.SampleApex(segment, {i, own, PdfDiscrete(1), 0}, Point2(0.5f)).has_value();
      expected.push_back(reaches ? draws * probability : 0.0);
      if (!reaches) expected[0] += draws * probability;
      sum += probability;
    }
  }
  EXPECT_NEAR(sum, 1, 1e-5);
  observed.resize(expected.size());
  for (int i = 0; i < draws; ++i) {
    const auto sample = lighting.GenerateSamplesForRaySegment(segment, rng.NextFloat(), rng.NextPoint2());
    observed[sample ? first[sample->light] + static_cast<size_t>(std::max(sample->patch, 0)) : 0] += 1;
    if (sample && i % 50 == 0) {
      EXPECT_EQ(sample->selection.value,
                lighting.SegmentSelectionProbability(segment, sample->light, sample->patch).value);
    }
  }
  return ChiSquaredPValue(observed, expected);
}

class SegmentSelection : public ::testing::TestWithParam<LightSelection> {};

TEST_P(SegmentSelection, IsTheDistributionThatItReports) {
  const LitScene scene(GetParam());
  Rng rng(1);
  constexpr int segments = 40;
  for (int s = 0; s < segments; ++s) {
    const RaySegment segment = RandomSegment(rng, s % 2 ? scene.WithoutKeys() : 0);
    EXPECT_GT(FrequencyPValue(scene.Lighting(), segment, rng), SidakLevel(segments)) << s;
  }
}

// A tree of which the cut for a segment holds only a small part.
TEST(SegmentSelectionOfMany, IsTheDistributionThatItReports) {
  const LitScene scene(LightSelection::Tree, 4000);
  Rng rng(6);
  constexpr int segments = 12;
  for (int s = 0; s < segments; ++s) {
    const RaySegment segment = RandomSegment(rng, s % 2 ? scene.WithoutKeys() : 0);
    EXPECT_GT(FrequencyPValue(scene.Lighting(), segment, rng), SidakLevel(segments)) << s;
  }
}

// Light at a random point of a segment: its lamp can be selected, and the point is in the lit range.
TEST_P(SegmentSelection, LeavesOutNothingThatArrives) {
  const LitScene scene(GetParam());
  const LightingServices& lighting = scene.Lighting();
  Rng rng(2);
  int arriving = 0;
  for (int s = 0; s < 2000; ++s) {
    const RaySegment segment = RandomSegment(rng, s % 2 ? scene.WithoutKeys() : 0);
    const float most = std::isinf(segment.length) ? 3 * glm::length(segment.origin) : segment.length;
    const float t = most * rng.NextFloat();
    const Receiver receiver = Receiver::InMedium(segment.origin + t * segment.direction, segment.link);
    for (uint32_t i = 0; i < lighting.Lights().size(); ++i) {
      const SelectedLight selected{i, kAnyPatch, PdfDiscrete(1), 0};
      const DirectSample direct = lighting.GenerateSamples(receiver, selected, rng.NextPoint2(), 0, true);
      if (!direct) continue;
      ++arriving;
      EXPECT_GT(lighting.SegmentSelectionProbability(segment, i, direct.sample->patchIndex).value, 0) << i;
      const auto apex = lighting.SampleApex(segment, selected, rng.NextPoint2());
      ASSERT_TRUE(apex) << i << " " << lighting.Lights()[i].light->Settings().name;
      EXPECT_TRUE(apex->tMin <= t && t <= apex->tMax) << i << " " << apex->tMin << " " << t << " " << apex->tMax;
      EXPECT_EQ(apex->hasApex, !lighting.IsAtInfinity(i));
    }
  }
  EXPECT_GT(arriving, 10000);
}

// Light that reaches the segment, ∫ Σ fluence dt: by selection for the segment and equiangular distances, against even
// distances and lights.
class SegmentLight {
 public:
  SegmentLight(const LightingServices& lighting, const RaySegment& segment, Rng& rng)
      : lighting_(lighting), segment_(segment), rng_(rng) {}

  double BySegment() {
    const auto sample = lighting_.GenerateSamplesForRaySegment(segment_, rng_.NextFloat(), rng_.NextPoint2());
    if (!sample) return 0;
    float t = glm::mix(sample->tMin, sample->tMax, rng_.NextFloat());
    double density = 1 / static_cast<double>(sample->tMax - sample->tMin);
    if (sample->hasApex) {
      const EquiangularDistance distances = sample->Distances(segment_);
      if (distances.IsEmpty()) return 0;
      t = distances.Sample(rng_.NextFloat());
      density = static_cast<double>(distances.Density(t).value);
    }
    return Arriving({sample->light, sample->patch, sample->selection, 0}, t) / density;
  }
  double Evenly() {
    const auto lights = static_cast<uint32_t>(lighting_.Lights().size());
    const uint32_t light = std::min(static_cast<uint32_t>(rng_.NextFloat() * static_cast<float>(lights)), lights - 1);
    const PdfDiscrete selection(1 / static_cast<float>(lights));
    return Arriving({light, kAnyPatch, selection, 0}, segment_.length * rng_.NextFloat()) *
           static_cast<double>(segment_.length);
  }

 private:
  double Arriving(const SelectedLight& selected, float t) {
    const Receiver receiver = Receiver::InMedium(segment_.origin + t * segment_.direction, segment_.link);
    const DirectSample direct = lighting_.GenerateSamples(receiver, selected, rng_.NextPoint2(), 0, false);
    if (!direct) return 0;
    return static_cast<double>(direct.sample->diffuse.Average() / direct.sample->pdfDirect.value) /
           static_cast<double>(selected.probability.value);
  }

  const LightingServices& lighting_;
  const RaySegment& segment_;
  Rng& rng_;
};

TEST_P(SegmentSelection, SumsUpWhatReachesTheSegment) {
  const LitScene scene(GetParam());
  Rng rng(3);
  constexpr int segments = 6, draws = 40000;
  double better = 0;
  for (int s = 0; s < segments; ++s) {
    RaySegment segment;
    segment.origin = test::RandomPoint(rng, 4);
    segment.direction = glm::normalize(test::RandomPoint(rng, 1) - segment.origin);
    segment.length = 1 + 4 * rng.NextFloat();
    segment.link = s % 2 ? scene.WithoutKeys() : 0;
    SegmentLight light(scene.Lighting(), segment, rng);
    RunningMean bySegment, evenly;
    for (int i = 0; i < draws; ++i) {
      bySegment.Add(light.BySegment());
      evenly.Add(light.Evenly());
      evenly.Add(light.Evenly());
    }
    const double error = std::hypot(bySegment.StandardError(), evenly.StandardError());
    EXPECT_LT(std::abs(bySegment.Mean() - evenly.Mean()), 4.5 * error) << s;
    EXPECT_LT(error, 0.15 * evenly.Mean()) << s << ": too noisy";
    better += std::log(2 * std::pow(evenly.StandardError() / bySegment.StandardError(), 2)) / segments;
  }
  std::printf("%s: variance of even sampling over that by segments: %.1f\n", NameOf(GetParam()).c_str(),
              std::exp(better));
  const bool byImportance = GetParam() == LightSelection::Tree || GetParam() == LightSelection::Exhaustive;
  EXPECT_GT(std::exp(better), byImportance ? 5 : 1);
}

INSTANTIATE_TEST_SUITE_P(Selections, SegmentSelection, ::testing::ValuesIn(kSelections),
                         [](const auto& info) { return NameOf(info.param); });

// For point lights the light on the segment is known exactly: I times the angle that the segment subtends, over its
// distance. The selection among them is in proportion to it, except for the share of defensive sampling.
TEST(SegmentSelectionOfPoints, IsExact) {
  Rng rng(4);
  const auto built = test::Build("point", "");
  const std::shared_ptr<const Light> point(std::move(built->light));
  std::vector<PlacedLight> lights(50);
  for (PlacedLight& placed : lights) {
    placed.light = point;
    const Transform to = Transform::Translate(Vector3d(test::RandomPoint(rng, 4)));
    placed.transform = {to.ToAffine(), to.Inverse().ToAffine()};
  }
  GeometryDescription description;
  description.entries.push_back({test::Sphere(4), {}});
  const GeometryScene geometry(std::move(description));
  const LightingServices lighting(geometry, lights, LightSelection::Exhaustive);
  for (int s = 0; s < 100; ++s) {
    const RaySegment segment = RandomSegment(rng, 0);
    std::vector<double> exact, probability;
    double sum = 0;
    for (uint32_t i = 0; i < lights.size(); ++i) {
      const Vector3d to(Point3d(lights[i].transform.toRender.translation) - Point3d(segment.origin));
      const Vector3d along(segment.direction);
      const double foot = glm::dot(to, along), distance = glm::length(to - foot * along);
      const double end = std::isinf(segment.length)
                             ? 0.5 * 3.14159265358979323846
                             : std::atan((static_cast<double>(segment.length) - foot) / distance);
      exact.push_back((end - std::atan(-foot / distance)) / distance);
      probability.push_back(static_cast<double>(lighting.SegmentSelectionProbability(segment, i, kAnyPatch).value));
      sum += exact[i];
    }
    for (size_t i = 0; i < exact.size(); ++i)
      EXPECT_NEAR(probability[i], 0.95 * exact[i] / sum + 0.05 / 50, 2e-3 * probability[i]) << s;
  }
}

// Importance of a cluster for a segment against that for its points.
TEST(SegmentImportances, BoundsWhatItsPointsReceive) {
  Rng rng(5);
  int dark = 0, lit = 0;
  for (int trial = 0; trial < 20000; ++trial) {
    ClusterBounds cluster;
    const auto parts = test::RandomEmitters(1 + rng.NextUint32() % 3, rng);
    for (const ClusterBounds& part : parts) cluster.Add(part);
    const ClusterLobe lobe = LobeOf(cluster);
    constexpr float sizes[] = {1, 3, 100};
    const Point3 origin = test::RandomPoint(rng, sizes[rng.NextUint32() % 3]);
    const float length = rng.NextFloat() * glm::length(origin) * 2;
    TreeSegment segment(Point3d(origin), test::RandomDirection(rng), static_cast<double>(length));
    constexpr int points = 256;
    double integral = 0;
    for (int i = 0; i < points; ++i) {
      const TreeReceiver receiver{
          origin + length * (static_cast<float>(i) + 0.5f) / points * Vector3(segment.direction), Normal3(0.0f), false};
      integral += static_cast<double>(Importance(lobe, receiver)) * segment.length / points;
    }
    const double importance = ImportanceAlong(lobe, segment).value;
    ++(importance > 0 ? lit : dark);
    // The sum over points may miss or hit a narrow peak.
    if (!(cluster.variance > 1e-4f) && glm::length(origin - cluster.mean) < 2) continue;
    EXPECT_GE(importance, 0.49 * integral) << trial;
    segment.length = HUGE_VAL;
    EXPECT_GE(ImportanceAlong(lobe, segment).value, importance * (1 - 1e-6)) << trial;
    EXPECT_TRUE(std::isfinite(ImportanceAlong(lobe, segment).value));
  }
  EXPECT_GT(dark, 300);
  EXPECT_GT(lit, 5000);
}

// Made as by the selector. Not inlined, because GCC 12 merges the conversions of direction between float and double
// where both versions of importance are inlined.
[[gnu::noinline]] TreeSegment SegmentFrom(const Point3& origin, const Vector3& direction, double length) {
  return TreeSegment(Point3d(origin), direction, length);
}

TEST(SegmentImportances, EightAtOnceAreEightOneByOne) {
  Rng rng(7);
  double sum = 0;
  for (int trial = 0; trial < 20000; ++trial) {
    const auto emitters = test::RandomEmitters(LobeBlock::kWidth, rng);
    LobeBlock block;
    for (int i = 0; i < LobeBlock::kWidth; ++i) block.Set(i, LobeOf(emitters[static_cast<size_t>(i)]));
    constexpr double sizes[] = {1, 3, 1000, 1e6};
    const double size = sizes[rng.NextUint32() % 4];
    const Point3 origin = static_cast<float>(size) * test::RandomPoint(rng, 1);
    // Through the emitters, also from far away.
    const Vector3 direction = glm::normalize(test::RandomPoint(rng, 1) - origin);
    const double length = trial % 3 ? 3 * size * static_cast<double>(rng.NextFloat()) : HUGE_VAL;
    const TreeSegment segment = SegmentFrom(origin, direction, length);
    const LaneSegmentImportances lanes = EvaluateAlong(block, segment);
    for (int i = 0; i < LobeBlock::kWidth; ++i) {
      const SegmentImportance one = ImportanceAlong(block.Get(i), segment);
      const auto lane = static_cast<double>(lanes.importance[static_cast<size_t>(i)]);
      EXPECT_NEAR(lane, one.value, 2e-3 * one.value) << trial;
      if (!(one.value > 0)) continue;
      EXPECT_NEAR(static_cast<double>(lanes.spread[static_cast<size_t>(i)]), one.spread, 2e-3 * one.spread) << trial;
      sum += one.value;
    }
  }
  EXPECT_GT(sum, 0);
}

}  // namespace
}  // namespace lampyr
