// The weights of bidirectional path tracing and of vertex merging, path by path: the recursive ones are those of the
// explicit densities, and those of all techniques of a path sum to 1.
#include <gtest/gtest.h>

#include <cstdio>

#include "agreement/agreement_scenes.h"
#include "agreement/media_scenes.h"
#include "agreement/weight_proof.h"

namespace lampyr::test {
namespace {

void ExpectExact(const char* name, const WeightErrors& errors) {
  EXPECT_EQ(errors.WhatIsWrong(), "") << name;
}

std::string Say(const InputCheck& check) {
  return std::to_string(check.wrong) + "/" + std::to_string(check.asked);
}
void Print(const char* name, const WeightErrors& errors) {
  std::printf(
      "%-20s %d paths, %d merged, %d with beams, sums off by %.1e, recursion %.1e, reported %.1e, groups %.1e of %d; "
      "off by 1 %%: "
      "direct %s, emission "
      "%s, "
      "lens %s, merges %s, refraction %s\n",
      name, errors.paths, errors.merges, errors.beams, errors.sum, errors.recursion, errors.reported, errors.groups,
      errors.sums, Say(errors.direct).c_str(), Say(errors.emission).c_str(), Say(errors.lens).c_str(),
      Say(errors.mergesPerDensity).c_str(), Say(errors.refraction).c_str());
}

TEST(BdptWeights, InEveryAgreementScene) {
  std::map<std::pair<int, int>, int> techniques;
  for (const AgreementScene& scene : AgreementScenes()) {
    const WeightErrors worst = CheckWeights(scene.text, {});
    EXPECT_GE(worst.paths, 4000) << scene.name;
    ExpectExact(scene.name, worst);
    for (const auto& [technique, count] : worst.perTechnique) techniques[technique] += count;
    Print(scene.name, worst);
  }
  for (int events = 0; events <= 3; ++events) {
    for (int s = 0; s <= events + 1; ++s) {
      const std::pair<int, int> technique(s, events + 2 - s);
      EXPECT_GT(techniques[technique], 100) << "(" << s << "," << events + 2 - s << ")";
    }
  }
}

// Through a lens of glass t = 1 does not exist: no path is made by it, and no weight counts it.
TEST(BdptWeights, WithoutConnectionsToTheLens) {
  const std::string scene =
      "Film \"rgb\" \"integer xresolution\" 30 \"integer yresolution\" 20\nIntegrator \"bdpt\" \"integer maxdepth\" 3\n"
      "LookAt 0 0.5 2.5  0 0.2 0  0 1 0\nCamera \"realistic\" \"string lensfile\" \"data/singlet.dat\" \"float "
      "aperturediameter\" 8 \"float focusdistance\" 2.5\nWorldBegin\n"
      "AttributeBegin Translate 0.2 0.9 0 AreaLightSource \"diffuse\" \"rgb L\" [4 3 2] Shape \"sphere\" \"float "
      "radius\" 0.4 AttributeEnd\nLightSource \"point\" \"rgb I\" [1 1 2] \"point3 from\" [-0.6 1 0.5]\n"
      "AttributeBegin Material \"diffuse\" \"rgb reflectance\" [0.6 0.5 0.4] Rotate -90 1 0 0 Shape \"disk\" \"float "
      "radius\" 2 AttributeEnd\nMaterial \"dielectric\" Translate -0.3 0.25 0.3 Shape \"sphere\" \"float radius\" "
      "0.2\n";
  std::map<std::pair<int, int>, int> techniques;
  for (const float radius : {0.0f, 0.01f, 0.1f}) {
    const WeightErrors worst = CheckWeights(scene, {12000, radius});
    EXPECT_GE(worst.paths, 12000);
    EXPECT_EQ(worst.merges > 0, radius > 0);
    ExpectExact("realistic", worst);
    Print("realistic", worst);
    for (const auto& [technique, count] : worst.perTechnique) techniques[technique] += count;
  }
  for (int events = 0; events <= 3; ++events) {
    for (int s = 0; s <= events; ++s) {
      const std::pair<int, int> technique(s, events + 2 - s);
      EXPECT_GT(techniques[technique], 10) << "(" << s << "," << events + 2 - s << ")";
    }
    EXPECT_EQ(techniques.count({events + 1, 1}), 0u) << events;
  }
}

TEST(BdptWeights, WithMergingInEveryAgreementScene) {
  int merges = 0;
  for (const AgreementScene& scene : AgreementScenes()) {
    // Wherever photons are aimed, weights know it.
    for (const bool aimed : {false, true}) {
      const WeightErrors worst = CheckWeights(scene.text, {4000, aimed ? 0.1f : 0.003f, aimed});
      EXPECT_GE(worst.paths, 4000) << scene.name;
      ExpectExact(scene.name, worst);
      merges += worst.merges;
      Print(scene.name, worst);
    }
  }
  EXPECT_GT(merges, 20000);
}

// The radius is a number of pixels as the camera sees them.
TEST(BdptWeights, WithARadiusPerPath) {
  int merges = 0, asked = 0;
  for (const AgreementScene& scene : AgreementScenes()) {
    const WeightErrors worst = CheckWeights(scene.text, {.paths = 4000, .pixels = 2});
    ExpectExact(scene.name, worst);
    asked += worst.mergesPerDensity.asked;
    merges += worst.merges;
    Print(scene.name, worst);
  }
  EXPECT_GT(merges, 10000);
  EXPECT_GT(asked, 100000);
}

// Vertices in media, homogeneous, in grids, and with other coefficients in each channel.
TEST(BdptWeights, InMedia) {
  int merges = 0, beams = 0;
  TechniqueCounts ending;
  ending.continuing = FilmMask(1, 1, {1, 1}, {0.3f});
  std::map<std::pair<int, int>, int> techniques;
  for (const MediaScene& scene : MediaScenes()) {
    if (!scene.hasLights) continue;
    for (const WeightProof& proof :
         {WeightProof{.paths = 10000}, WeightProof{.paths = 4000, .radius = 0.02f},
          WeightProof{.paths = 4000, .pixels = 2}, WeightProof{.paths = 4000, .radius = 0.02f, .beamShare = 1},
          WeightProof{.paths = 4000, .pixels = 2, .beamShare = 0.3f},
          WeightProof{.paths = 4000, .radius = 0.02f, .counts = ending},
          WeightProof{.paths = 4000, .pixels = 2, .counts = ending, .beamShare = 1}}) {
      const WeightErrors worst = CheckWeights(scene.text, proof);
      EXPECT_GE(worst.paths, proof.paths) << scene.name;
      ExpectExact(scene.name, worst);
      merges += worst.merges;
      beams += worst.beams;
      for (const auto& [technique, count] : worst.perTechnique) techniques[technique] += count;
      Print(scene.name, worst);
    }
  }
  EXPECT_GT(merges, 5000);
  EXPECT_GT(beams, 5000);
  for (int events = 1; events <= 3; ++events) {
    for (int s = 0; s <= events + 1; ++s) EXPECT_GT((techniques[{s, events + 2 - s}]), 100) << s << " of " << events;
  }
}

// Both walks guided, each where it likes: the densities of either are known to the other.
TEST(BdptWeights, WithGuides) {
  int merges = 0;
  const auto check = [&](const std::string& name, const std::string& text, WeightProof proof) {
    proof.isGuided = true;
    const WeightErrors worst = CheckWeights(text, proof);
    EXPECT_GE(worst.paths, proof.paths) << name;
    ExpectExact(name.c_str(), worst);
    Print(name.c_str(), worst);
    merges += worst.merges;
  };
  for (const AgreementScene& scene : AgreementScenes()) {
    check(scene.name, scene.text, {.paths = 3000});
    check(scene.name, scene.text, {.paths = 3000, .pixels = 2});
    WeightProof ending{.paths = 3000, .pixels = 2};
    ending.counts.continuing = FilmMask(1, 1, {1, 1}, {0.3f});
    check(scene.name, scene.text, ending);
  }
  for (const MediaScene& scene : MediaScenes())
    if (scene.hasLights) check(scene.name, scene.text, {.paths = 3000, .radius = 0.02f});
  const AgreementScene first = AgreementScenes().front();
  check("many paths", first.text, {.paths = 10000, .radius = 0.01f});
  EXPECT_GT(merges, 10000);
}

// Fewer light paths than camera paths, or more; connections and merging left out, always made, or now and then,
// depending on the place on the film; camera paths that may end early; splats by filters of other widths.
TEST(BdptWeights, WithCounts) {
  const auto maskOf = [](std::vector<float> values) { return FilmMask(2, 2, {30, 20}, std::move(values)); };
  const std::vector<TechniqueCounts> all = {
      {-2, {}, {}},
      {1, {}, {}},
      {0, maskOf({0, 1, 0.3f, 0.8f}), maskOf({1, 0.2f, 0, 0.5f})},
      {-1, maskOf({0.5f, 0.5f, 0.5f, 0.5f}), maskOf({0, 0, 0, 1})},
      {1, maskOf({0, 0, 0, 0}), maskOf({0.3f, 0.3f, 1, 1})},
      {-3, maskOf({1, 0, 1, 0}), maskOf({0, 0, 0, 0})},
      {2, {}, maskOf({0, 1, 0.5f, 0.5f})},
      {0, {}, {}, maskOf({0.2f, 0.2f, 0.2f, 0.2f})},
      {0, {}, {}, maskOf({0.1f, 1, 0.3f, 0.6f})},
      {1, maskOf({1, 0.4f, 1, 1}), maskOf({0, 1, 0, 1}), maskOf({0.25f, 0.25f, 1, 0.01f})},
  };
  int merges = 0;
  for (const AgreementScene& scene : AgreementScenes()) {
    for (size_t i = 0; i < all.size(); ++i) {
      const WeightErrors worst = CheckWeights(scene.text, {.paths = 2000,
                                                           .radius = i % 2 == 0 ? 0.01f : 0.0f,
                                                           .pixels = i % 2 == 0 ? 0.0f : 2.0f,
                                                           .counts = all[i],
                                                           .splatCount = 0.1 * std::pow(3, i)});
      EXPECT_GE(worst.paths, 2000) << scene.name;
      ExpectExact((std::string(scene.name) + " with counts " + std::to_string(i)).c_str(), worst);
      merges += worst.merges;
    }
  }
  EXPECT_GT(merges, 10000);
}

// Mirrors, smooth glass, what only passes through, and mixes that are now matte and now a mirror: deltas in all places
// of a path.
TEST(BdptWeights, WithDeltas) {
  const std::string glass = R"(AttributeBegin
Material "dielectric" "float eta" 1.5
Translate 0 0.6 0 Shape "sphere" "float radius" 0.4
AttributeEnd
AttributeBegin
Material "conductor" "rgb reflectance" [0.9 0.9 0.9]
Translate 0 0.5 -1 Shape "disk" "float radius" 0.8
AttributeEnd
AttributeBegin
Material "thindielectric"
Translate 0.5 0.9 0.2 Rotate 80 1 0 0 Shape "disk" "float radius" 0.5
AttributeEnd
MakeNamedMaterial "white" "string type" "diffuse"
MakeNamedMaterial "mirror" "string type" "conductor"
MakeNamedMaterial "both" "string type" "mix" "string materials" [ "white" "mirror" ]
AttributeBegin
NamedMaterial "both"
Translate -0.3 0.2 0.9 Shape "sphere" "float radius" 0.2
Translate 0.7 0 0 Shape "sphere" "float radius" 0.2
AttributeEnd
)";
  const std::string lamps[] = {"LightSource \"point\" \"rgb I\" [5 4 3] \"point3 from\" [0.4 2 0.4]\n",
                               "LightSource \"distant\" \"rgb L\" [2 2 3] \"point3 from\" [1 2 0.5]\n",
                               "LightSource \"infinite\" \"rgb L\" [0.5 0.6 0.8]\n", Square("\"rgb L\" [9 9 9]", 0.3)};
  for (const std::string& lamp : lamps) {
    const std::string scene = FilmWith("box") + kDown + World(7) + lamp + kThings + glass;
    const WeightErrors worst = CheckWeights(scene, {20000});
    EXPECT_GE(worst.paths, 20000);
    ExpectExact(lamp.c_str(), worst);
    Print("with deltas", worst);
    const WeightErrors merging = CheckWeights(scene, {20000, 0.05f});
    EXPECT_GT(merging.merges, 1000);
    EXPECT_GT(merging.refraction.asked, 100);
    ExpectExact(lamp.c_str(), merging);
    Print("merging", merging);
    TechniqueCounts counts;
    counts.continuing = FilmMask(1, 1, {1, 1}, {0.3f});
    const WeightErrors ending = CheckWeights(scene, {.paths = 20000, .radius = 0.05f, .counts = counts});
    ExpectExact(lamp.c_str(), ending);
    Print("camera paths that may end", ending);
    const WeightErrors perPath = CheckWeights(scene, {.paths = 20000, .pixels = 2});
    EXPECT_GT(perPath.merges, 1000);
    ExpectExact(lamp.c_str(), perPath);
    Print("radius per path", perPath);
  }
}

}  // namespace
}  // namespace lampyr::test
