// Next-event estimation at receivers without a normal, as in a medium: selection is a distribution that knows its own
// probabilities, leaves out nothing that arrives, and takes no cosine; filters and linking apply.
#include <gtest/gtest.h>

#include "lit_scene.h"
#include "support/chi_squared.h"

namespace lampyr {
namespace {

using test::LitScene;
using testing::ChiSquaredPValue;
using testing::SidakLevel;

constexpr LightSelection kSelections[] = {LightSelection::Uniform, LightSelection::Power, LightSelection::Tree,
                                          LightSelection::Exhaustive};

// Among the lights, around them and far away.
Receiver RandomReceiver(Rng& rng, uint32_t link) {
  constexpr float sizes[] = {3, 3, 10, 1e4f};
  const Point3 cube = Point3(rng.NextFloat(), rng.NextFloat(), rng.NextFloat()) - 0.5f;
  return Receiver::InMedium(sizes[rng.NextUint32() % 4] * cube, link);
}

// The number of patches that selection tells apart.
int PatchesOf(const LightingServices& lighting, const Receiver& receiver, uint32_t light) {
  return lighting.SelectsPatches(receiver) ? lighting.Lights()[light].light->PatchCount() : 1;
}

// p-value of the frequencies with which `lighting` selects lights and patches.
double FrequencyPValue(const LightingServices& lighting, const Receiver& receiver, Rng& rng) {
  constexpr int draws = 20000;
  std::vector<double> expected, observed;
  std::vector<size_t> first;
  double sum = 0;
  for (uint32_t i = 0; i < lighting.Lights().size(); ++i) {
    first.push_back(expected.size());
    for (int patch = 0; patch < PatchesOf(lighting, receiver, i); ++patch) {
      const auto probability = static_cast<double>(lighting.SelectionProbability(receiver, i, patch).value);
      expected.push_back(draws * probability);
      sum += probability;
    }
  }
  EXPECT_NEAR(sum, 1, 1e-5);
  observed.resize(expected.size());
  for (int i = 0; i < draws; ++i) {
    LightChoices choices;
    lighting.SelectLights(receiver, rng.NextFloat(), choices);
    EXPECT_EQ(choices.count, 1);
    const SelectedLight& choice = choices.of[0];
    observed[first[choice.light] + static_cast<size_t>(std::max(choice.patch, 0))] += 1;
    if (i % 50 == 0) {
      EXPECT_EQ(choice.probability.value, lighting.SelectionProbability(receiver, choice.light, choice.patch).value);
    }
  }
  return ChiSquaredPValue(observed, expected);
}

class MediumReceivers : public ::testing::TestWithParam<LightSelection> {};

TEST_P(MediumReceivers, SelectionIsTheDistributionThatItReports) {
  const LitScene scene(GetParam());
  Rng rng(1);
  constexpr int receivers = 24;
  for (int r = 0; r < receivers; ++r) {
    const Receiver receiver = RandomReceiver(rng, r % 2 ? scene.WithoutKeys() : 0);
    EXPECT_GT(FrequencyPValue(scene.Lighting(), receiver, rng), SidakLevel(receivers)) << r;
  }
}

TEST_P(MediumReceivers, WhatArrivesCanBeSelected) {
  const LitScene scene(GetParam());
  const LightingServices& lighting = scene.Lighting();
  Rng rng(2);
  int arriving = 0;
  for (int r = 0; r < 2000; ++r) {
    const Receiver receiver = RandomReceiver(rng, r % 2 ? scene.WithoutKeys() : 0);
    for (uint32_t i = 0; i < lighting.Lights().size(); ++i) {
      SelectedLight selected;
      selected.light = i;
      const DirectSample direct = lighting.GenerateSamples(receiver, selected, rng.NextPoint2(), 0, true);
      if (!direct) continue;
      ++arriving;
      EXPECT_GT(lighting.SelectionProbability(receiver, i, direct.sample->patchIndex).value, 0) << i;
    }
  }
  EXPECT_GT(arriving, 10000);
}

// Learned factors of receivers in media: the distribution stays exact.
TEST(MediumReceiver, LearnedSelectionIsTheDistributionThatItReports) {
  const LitScene scene(LightSelection::Tree);
  LightLearning learning(scene.Lighting().SceneSphere());
  const LightingServices lighting = scene.Lighting().With(&learning, nullptr);
  Rng rng(3);
  const Receiver receiver = Receiver::InMedium({0.2f, 0.1f, -0.3f});
  const float before = lighting.SelectionProbability(receiver, 5, kAnyPatch).value;
  // Nothing arrives from the sphere, everything from all others.
  for (int i = 0; i < 4000; ++i) {
    LightChoices choices;
    lighting.SelectLights(receiver, rng.NextFloat(), choices);
    const DirectSample direct = lighting.GenerateSamples(receiver, choices.of[0], rng.NextPoint2(), 0, false);
    lighting.UpdateWithResults(receiver, direct, Color(direct.light == 5 ? 0.0f : 1.0f));
  }
  learning.Freeze();
  EXPECT_LT(lighting.SelectionProbability(receiver, 5, kAnyPatch).value, 0.7f * before);
  EXPECT_GT(FrequencyPValue(lighting, receiver, rng), 1e-3);
}

// Six equal points around a receiver: each has the same chance, unlike at a receiver on a surface.
TEST(MediumReceiver, TakesNoCosine) {
  const auto built = test::Build("point", "");
  const std::shared_ptr<const Light> point(std::move(built->light));
  std::vector<PlacedLight> lights;
  for (const Vector3d& place : {Vector3d(1, 0, 0), Vector3d(-1, 0, 0), Vector3d(0, 1, 0), Vector3d(0, -1, 0),
                                Vector3d(0, 0, 1), Vector3d(0, 0, -1)}) {
    PlacedLight placed;
    placed.light = point;
    const Transform to = Transform::Translate(place);
    placed.transform = {to.ToAffine(), to.Inverse().ToAffine()};
    lights.push_back(placed);
  }
  for (const LightSelection selection : {LightSelection::Tree, LightSelection::Exhaustive}) {
    const auto selector = MakeLightSelector(selection, lights, {Point3(0.0f), 2});
    const Receiver surface{Point3(0.0f), Normal3(0, 1, 0)};
    for (uint32_t i = 0; i < lights.size(); ++i) {
      const Receiver medium = Receiver::InMedium(Point3(0.0f));
      Receiver transmissive = medium;
      transmissive.isTransmissive = true;
      EXPECT_NEAR(selector->Probability(medium, i, kAnyPatch).value, 1.0f / 6, 1e-5f);
      EXPECT_EQ(selector->Probability(medium, i, kAnyPatch).value,
                selector->Probability(transmissive, i, kAnyPatch).value);
    }
    EXPECT_GT(selector->Probability(surface, 2, kAnyPatch).value, 0.5f);
    EXPECT_LT(selector->Probability(surface, 3, kAnyPatch).value, 0.01f);
  }
}

TEST_P(MediumReceivers, FiltersAndLinkingApply) {
  const LitScene scene(GetParam());
  const LightingServices& lighting = scene.Lighting();
  const Point3 place(-0.4f, 0.2f, 0.1f);
  SelectedLight selected;
  selected.light = scene.IndexOfFiltered();
  const auto radiance = [&](uint32_t link) {
    const DirectSample direct =
        lighting.GenerateSamples(Receiver::InMedium(place, link), selected, Point2(0.5f), 0, false);
    return direct ? direct.sample->diffuse.r : 0.0f;
  };
  EXPECT_GT(radiance(Receiver::kCamera), 0);
  for (const uint32_t link : {0u, scene.WithoutKeys()})
    EXPECT_FLOAT_EQ(radiance(link), test::kFilterFactor * radiance(Receiver::kCamera));
  int excluded = 0;
  for (uint32_t i = 0; i < lighting.Lights().size(); ++i) {
    if (lighting.Lights()[i].light->Settings().lightGroup != "keys") continue;
    ++excluded;
    EXPECT_EQ(lighting.SelectionProbability(Receiver::InMedium(place, scene.WithoutKeys()), i, kAnyPatch).value, 0);
    EXPECT_GT(lighting.SelectionProbability(Receiver::InMedium(place), i, kAnyPatch).value, 0);
    selected.light = i;
    EXPECT_FALSE(
        lighting.GenerateSamples(Receiver::InMedium(place, scene.WithoutKeys()), selected, Point2(0.5f), 0, false));
  }
  EXPECT_EQ(excluded, 2);
}

INSTANTIATE_TEST_SUITE_P(Selections, MediumReceivers, ::testing::ValuesIn(kSelections),
                         [](const auto& info) { return NameOf(info.param); });

}  // namespace
}  // namespace lampyr
