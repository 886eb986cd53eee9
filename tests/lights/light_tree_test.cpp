// The light tree: it is a distribution at every receiver, it never rules out what contributes, and it knows the
// probability of what it chose to the bit.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>

#include "film/metrics.h"
#include "lights/selection/emitters.h"
#include "lights/selection/light_tree.h"
#include "random_emitters.h"
#include "sampling/rng.h"
#include "sampling/warp.h"

namespace lampyr {
namespace {

using test::RandomDirection;
using test::RandomEmitter;
using test::RandomEmitters;
using test::RandomPoint;

// Within the boxes, around them, far away, in a volume, seen from both sides.
TreeReceiver RandomReceiver(Rng& rng) {
  constexpr float sizes[] = {1, 3, 1000, 1e6f};
  TreeReceiver receiver{RandomPoint(rng, sizes[rng.NextUint32() % 4]), RandomDirection(rng), rng.NextUint32() % 4 == 0};
  if (rng.NextUint32() % 8 == 0) receiver.normal = Normal3(0.0f);
  return receiver;
}

LightTree::Cut Look(const LightTree& tree, const TreeReceiver& receiver) {
  LightTree::Cut cut;
  tree.Look(receiver, cut);
  return cut;
}
EmitterProbability ProbabilityOf(const LightTree& tree, const TreeReceiver& receiver, uint32_t emitter) {
  return tree.ProbabilityOf(receiver, Look(tree, receiver), emitter);
}
EmitterChoice Select(const LightTree& tree, const TreeReceiver& receiver, double u, bool defensive) {
  return tree.Select(receiver, Look(tree, receiver), u, defensive);
}

// The lobe in the tree's compressed form.
ClusterLobe KeptLobeOf(const ClusterBounds& emitter) {
  LobeBlock block;
  block.Set(3, LobeOf(emitter));
  return block.Get(3);
}

TEST(LightTree, WhatIsKeptInFewerBitsRulesOutNoMore) {
  Rng rng(12);
  for (int trial = 0; trial < 20000; ++trial) {
    const ClusterBounds emitter = RandomEmitter(rng, std::exp(10 * rng.NextFloat() - 9));
    const ClusterLobe lobe = LobeOf(emitter), kept = KeptLobeOf(emitter);
    EXPECT_EQ(kept.intensity, lobe.intensity);
    EXPECT_EQ(kept.mean, lobe.mean);
    EXPECT_EQ(kept.variance, lobe.variance);
    EXPECT_EQ(kept.twoSided, lobe.twoSided);
    EXPECT_LT(glm::length(kept.meanNormal - lobe.meanNormal), 3e-5f);
    EXPECT_GE(kept.radius, lobe.radius);
    EXPECT_LE(kept.radius, 1.008f * lobe.radius);
    EXPECT_GE(kept.coneReach, lobe.coneReach);
    EXPECT_LE(kept.coneReach, 1.008f * lobe.coneReach);
    EXPECT_LE(kept.coneCosine, lobe.coneCosine + 1e-7f);
    EXPECT_GE(kept.coneCosine, lobe.coneCosine - 3.2e-5f);
  }
}

TEST(LightTree, EightAtOnceAreEightOneByOne) {
  Rng rng(1);
  for (int trial = 0; trial < 2000; ++trial) {
    const auto emitters = RandomEmitters(1 + rng.NextUint32() % 8, rng);
    const LightTree tree(emitters, 1);
    for (int i = 0; i < 8; ++i) {
      const TreeReceiver receiver = RandomReceiver(rng);
      float sum = 0;
      for (const ClusterBounds& emitter : emitters) sum += Importance(KeptLobeOf(emitter), receiver);
      EXPECT_NEAR(Look(tree, receiver).irradiance, sum, 2e-4f * sum);
    }
  }
}

TEST(LightTree, ProbabilitiesSumToOne) {
  Rng rng(2);
  for (const size_t count : {1, 2, 8, 9, 100, 5000}) {
    const LightTree tree(RandomEmitters(count, rng), 2);
    for (int i = 0; i < 50; ++i) {
      const TreeReceiver receiver = RandomReceiver(rng);
      double seen = 0, blind = 0;
      for (uint32_t e = 0; e < count; ++e) {
        const EmitterProbability probability = ProbabilityOf(tree, receiver, e);
        seen += probability.byImportance;
        blind += probability.defensive;
      }
      EXPECT_NEAR(seen, 1, 1e-5);
      EXPECT_NEAR(blind, 1, 1e-5);
    }
  }
}

TEST(LightTree, ChoosesAsOftenAsItSays) {
  Rng rng(3);
  constexpr size_t count = 40;
  constexpr int draws = 200000, receivers = 12;
  const LightTree tree(RandomEmitters(count, rng), 1);
  for (int r = 0; r < receivers; ++r) {
    const TreeReceiver receiver = RandomReceiver(rng);
    for (const bool defensive : {false, true}) {
      std::vector<int> counts(count, 0);
      for (int i = 0; i < draws; ++i) {
        const double u = (i + static_cast<double>(rng.NextFloat())) / draws;
        const EmitterChoice choice = Select(tree, receiver, u, defensive);
        ++counts[choice.emitter];
        ASSERT_GE(choice.u, 0);
        ASSERT_LT(choice.u, 1);
        if (i % 100 != 0) continue;
        const EmitterProbability again = ProbabilityOf(tree, receiver, choice.emitter);
        ASSERT_EQ(again.byImportance, choice.probability.byImportance);
        ASSERT_EQ(again.defensive, choice.probability.defensive);
      }
      // The draws are stratified: counts are off by no more than the borders of their share.
      for (uint32_t e = 0; e < count; ++e) {
        const EmitterProbability probability = ProbabilityOf(tree, receiver, e);
        EXPECT_NEAR(counts[e], draws * (defensive ? probability.defensive : probability.byImportance), 6) << e;
      }
    }
  }
}

// A cluster promises no less than nothing: where a part of it contributes, it is not ruled out.
TEST(LightTree, AClusterIsNotDarkWhereAPartOfItIsNot) {
  Rng rng(4);
  for (int trial = 0; trial < 20000; ++trial) {
    ClusterBounds cluster;
    const auto parts = RandomEmitters(2 + rng.NextUint32() % 4, rng);
    for (const ClusterBounds& part : parts) cluster.Add(part);
    const TreeReceiver receiver = RandomReceiver(rng);
    const bool contributes = std::any_of(
        parts.begin(), parts.end(), [&](const ClusterBounds& part) { return Importance(LobeOf(part), receiver) > 0; });
    if (contributes) {
      EXPECT_GT(Importance(LobeOf(cluster), receiver), 0) << trial;
    }
  }
}

// Against light itself: from a point of the emitter's box in a direction that it emits in, to a side of the receiver
// that it lights.
TEST(LightTree, NothingThatContributesIsRuledOut) {
  Rng rng(5);
  const auto emitters = RandomEmitters(300, rng);
  const LightTree tree(emitters, 1);
  int contributing = 0;
  for (int trial = 0; trial < 200000; ++trial) {
    const auto e = static_cast<uint32_t>(rng.NextUint32() % emitters.size());
    const ClusterBounds& emitter = emitters[e];
    const TreeReceiver receiver = RandomReceiver(rng);
    const Point3 from = emitter.box.min +
                        Point3(rng.NextFloat(), rng.NextFloat(), rng.NextFloat()) * (emitter.box.max - emitter.box.min);
    const Vector3 way = receiver.position - from;
    const Vector3 direction = way / glm::length(way);
    float emitted = glm::dot(direction, emitter.axis);
    if (emitter.twoSided) emitted = std::abs(emitted);
    const bool isLambertian = emitter.cosThetaE == 0;
    if (isLambertian ? emitted <= 0 : emitted < emitter.cosThetaO) continue;
    float received = -glm::dot(direction, receiver.normal);
    if (receiver.isTransmissive) received = std::abs(received);
    if (LengthSquared(receiver.normal) > 0 && received <= 0) continue;
    ++contributing;
    EXPECT_GT(Importance(LobeOf(emitter), receiver), 0);
    const EmitterProbability probability = ProbabilityOf(tree, receiver, e);
    EXPECT_GT(probability.byImportance, 0) << trial;
    EXPECT_GT(probability.defensive, 0) << trial;
  }
  EXPECT_GT(contributing, 10000);
}

TEST(LightTree, NearerAndFacingEmittersAreLikelier) {
  std::vector<ClusterBounds> emitters(2);
  for (int i = 0; i < 2; ++i) {
    emitters[static_cast<size_t>(i)].box.Add(Point3(static_cast<float>(i), 0, 1));
    emitters[static_cast<size_t>(i)].cosThetaO = -1;
    emitters[static_cast<size_t>(i)].intensity = 1;
    emitters[static_cast<size_t>(i)].FillBox();
  }
  const LightTree tree(emitters, 1);
  const TreeReceiver below{{0, 0, 0}, {0, 0, 1}, false};
  // 1 against cos/d² of 45°.
  const double near = ProbabilityOf(tree, below, 0).byImportance;
  EXPECT_NEAR(near, 1 / (1 + std::sqrt(0.5) / 2), 1e-5);
  const TreeReceiver turned{{0, 0, 0}, {-1, 0, 0}, false};
  EXPECT_LT(ProbabilityOf(tree, turned, 1).byImportance, 1e-3);
}

TEST(LightTree, CoincidentAndEmptyEmitters) {
  std::vector<ClusterBounds> emitters(100000);
  for (size_t i = 0; i < emitters.size(); i += 2) {
    emitters[i].box.Add(Point3(0.3f));
    emitters[i].cosThetaO = -1;
    emitters[i].intensity = 1;
    emitters[i].FillBox();
  }
  const LightTree tree(emitters, 2);
  EXPECT_LE(tree.Depth(), 8);
  const TreeReceiver receiver{Point3(0.0f), Normal3(0, 0, 1), false};
  EXPECT_NEAR(ProbabilityOf(tree, receiver, 4000).byImportance, 2e-5, 1e-9);
  EXPECT_EQ(ProbabilityOf(tree, receiver, 4001).byImportance, 0);
  const TreeReceiver there{Point3(0.3f), Normal3(0, 0, 1), false};  // at the very place
  EXPECT_GT(ProbabilityOf(tree, there, 4000).byImportance, 0);
  EXPECT_TRUE(LightTree(std::vector<ClusterBounds>(3), 1).IsEmpty());
  EXPECT_TRUE(LightTree(std::vector<ClusterBounds>(), 1).IsEmpty());
}

enum class Kind { Points, ParallelSurfaces };

// In a box of size 1, of intensities over five orders of magnitude, all looking up.
std::vector<ClusterBounds> LikeEmitters(Kind kind, size_t count, Rng& rng) {
  std::vector<ClusterBounds> emitters(count);
  for (ClusterBounds& emitter : emitters) {
    emitter.box.Add(RandomPoint(rng, 1));
    emitter.intensity = std::exp(12 * rng.NextFloat());
    const bool isPoint = kind == Kind::Points;
    emitter.cosThetaO = isPoint ? -1.0f : 1.0f;
    emitter.cosThetaE = isPoint ? 1.0f : 0.0f;
    emitter.meanNormal = (isPoint ? 0.0f : 1.0f) * emitter.axis;
    emitter.FillBox();
  }
  return emitters;
}

// Compares Poisson counts: their squared differences in units of their variance.
void ExpectCounts(const std::vector<int>& counts, int draws, const std::vector<double>& probabilities) {
  double sum = 0, cells = 0, fewExpected = 0, fewCounted = 0;
  const auto add = [&](double counted, double expected) {
    sum += (counted - expected) * (counted - expected) / expected;
    ++cells;
  };
  for (size_t e = 0; e < counts.size(); ++e) {
    const double expected = draws * probabilities[e];
    if (expected >= 5) {
      add(counts[e], expected);
    } else {
      fewExpected += expected;
      fewCounted += counts[e];
    }
  }
  if (fewExpected >= 5) add(fewCounted, fewExpected);
  EXPECT_LT(sum, cells + 5 * std::sqrt(2 * cells));
}

// From afar clusters of like emitters are not looked into: what that leaves out is little, whatever the intensities.
TEST(LightTree, LikeEmittersAreChosenByIntensityAndTrendFromAfar) {
  Rng rng(9);
  constexpr size_t count = 3000;
  constexpr int draws = 300000;
  for (const Kind kind : {Kind::Points, Kind::ParallelSurfaces}) {
    const auto emitters = LikeEmitters(kind, count, rng);
    const LightTree tree(emitters, 1);
    for (const float distance : {1.3f, 3.0f, 10.0f, 1000.0f}) {
      const TreeReceiver receiver{distance * glm::normalize(Vector3(0.3f, 0.2f, 1)), Normal3(0, 0.6f, -0.8f), false};
      std::vector<double> importances, seen;
      double sum = 0, squares = 0, sumSeen = 0;
      for (uint32_t e = 0; e < count; ++e) {
        importances.push_back(static_cast<double>(Importance(LobeOf(emitters[e]), receiver)));
        seen.push_back(ProbabilityOf(tree, receiver, e).byImportance);
        sum += importances[e];
        sumSeen += seen[e];
      }
      for (uint32_t e = 0; e < count; ++e) squares += importances[e] * importances[e] / seen[e];
      EXPECT_NEAR(sumSeen, 1, 1e-6);
      // The relative variance of the light of one choice.
      EXPECT_LT(squares / (sum * sum) - 1, 0.01) << distance;
      std::vector<int> counts(count, 0);
      for (int i = 0; i < draws; ++i) {
        const EmitterChoice choice = Select(tree, receiver, (i + static_cast<double>(rng.NextFloat())) / draws, false);
        ++counts[choice.emitter];
        ASSERT_EQ(choice.probability.byImportance, seen[choice.emitter]);
        ASSERT_GE(choice.u, 0);
        ASSERT_LT(choice.u, 1);
      }
      ExpectCounts(counts, draws, seen);
    }
  }
}

// The trend's mean is 1 by the very places of a cluster: also of one that is tiny beside where it is.
TEST(LightTree, ATinyFarClusterHasProbabilitiesThatSumToOne) {
  Rng rng(13);
  for (const float size : {1e-2f, 1e-4f, 1e-6f}) {
    std::vector<ClusterBounds> emitters(400);
    for (size_t i = 0; i < emitters.size(); ++i) {
      emitters[i].box.Add(i == 0 ? Point3(-0.5f) : Point3(0.4f, 0.3f, 0.2f) + RandomPoint(rng, size));
      emitters[i].cosThetaO = -1;
      emitters[i].intensity = std::exp(3 * rng.NextFloat());
      emitters[i].FillBox();
    }
    const LightTree tree(emitters, 1);
    for (const float distance : {3.0f, 6.0f, 30.0f}) {
      const Vector3 direction = RandomDirection(rng);
      const TreeReceiver receiver{Point3(0.4f, 0.3f, 0.2f) + distance * size * direction, -direction, false};
      double sum = 0;
      for (uint32_t e = 0; e < emitters.size(); ++e) sum += ProbabilityOf(tree, receiver, e).byImportance;
      EXPECT_NEAR(sum, 1, 1e-6) << size << " " << distance;
    }
  }
}

// The rescaled random number is used by the light's own sampling: it is uniform over [0,1) for every selected light.
TEST(LightTree, WhatIsLeftOfTheRandomNumberIsEven) {
  Rng rng(14);
  const LightTree tree(LikeEmitters(Kind::Points, 3000, rng), 1);
  const TreeReceiver receiver{2.0f * glm::normalize(Vector3(0.3f, 0.2f, 1)), Normal3(0, 0.6f, -0.8f), false};
  constexpr int draws = 200000, bins = 64;
  std::vector<int> counts(bins, 0);
  for (int i = 0; i < draws; ++i) {
    const double u = static_cast<double>(rng.NextUint64() >> 11) * 0x1p-53;
    ++counts[static_cast<size_t>(bins * Select(tree, receiver, u, false).u)];
  }
  ExpectCounts(counts, draws, std::vector<double>(bins, 1.0 / bins));
}

// A lamp that is weak but near counts as much as strong ones far behind it in the same cluster.
TEST(LightTree, AWeakEmitterNearbyIsNotHiddenByItsCluster) {
  std::vector<ClusterBounds> emitters(1000);
  Rng rng(11);
  for (size_t i = 0; i < emitters.size(); ++i) {
    const bool isNear = i == 0;
    emitters[i].box.Add(isNear ? Point3(0, 0, 10) : RandomPoint(rng, 0.01f));
    emitters[i].cosThetaO = -1;
    emitters[i].intensity = isNear ? 1e-3f : 1.0f;
    emitters[i].FillBox();
  }
  const LightTree tree(emitters, 1);
  const TreeReceiver receiver{Point3(0, 0, 10.01f), Normal3(0, 0, -1), false};
  // 1e-3/0.01² = 10 beside 999/10² = 10.
  EXPECT_NEAR(ProbabilityOf(tree, receiver, 0).byImportance, 0.5, 0.05);
}

TEST(Emitters, AnEmitterIsAPatchOfItsLight) {
  Rng rng(15);
  for (const int most : {1, 3, 100, 10000}) {
    Emitters emitters;
    emitters.hasPatches = true;
    std::vector<Emitters::Patch> patches;
    for (uint32_t light = 0; light < 300; ++light) {
      emitters.first.push_back(static_cast<uint32_t>(patches.size()));
      const int count = 1 + static_cast<int>(static_cast<float>(most) * rng.NextFloat() * rng.NextFloat());
      for (int i = 0; i < count; ++i) patches.push_back({light, count > 1 ? i : kAnyPatch});
    }
    emitters.first.push_back(static_cast<uint32_t>(patches.size()));
    emitters.IndexLights();
    for (uint32_t e = 0; e < patches.size(); ++e) {
      const Emitters::Patch patch = emitters.PatchOf(e);
      ASSERT_EQ(patch.light, patches[e].light) << e;
      ASSERT_EQ(patch.patch, patches[e].patch) << e;
    }
  }
}

TEST(LightTree, IsTheSameForAnyNumberOfThreads) {
  Rng rng(6);
  const auto emitters = RandomEmitters(60000, rng);
  const LightTree one(emitters, 1), four(emitters, 4);
  for (uint32_t e = 0; e < emitters.size(); e += 97) {
    const TreeReceiver receiver = RandomReceiver(rng);
    EXPECT_EQ(ProbabilityOf(one, receiver, e).byImportance, ProbabilityOf(four, receiver, e).byImportance);
  }
}

TEST(LightTree, AMillionEmittersFitAndAreBuiltInSeconds) {
  Rng rng(7);
  const auto emitters = RandomEmitters(1000000, rng);
  const std::clock_t start = std::clock();  // of the processor: others may use the machine
  const LightTree tree(emitters, 2);
  const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  const double bytes = static_cast<double>(tree.Bytes()) / static_cast<double>(emitters.size());
  std::printf("a million emitters: %.2f s, %.0f bytes each, depth %d\n", seconds, bytes, tree.Depth());
  EXPECT_LT(seconds, 30);  // 5 to 10 usually
  EXPECT_LT(bytes, 120);
  EXPECT_LT(tree.Depth(), 24);
}

}  // namespace
}  // namespace lampyr
