#include "detection/weight_search.h"

#include <algorithm>

#include "agreement/agreement_scenes.h"
#include "agreement/weight_proof.h"
#include "detection/baseline_render.h"
#include "lights/suite/statistics.h"
#include "support/replicas.h"

namespace lampyr::test {

namespace {

std::string SceneNamed(const std::string& name) {
  for (const AgreementScene& scene : AgreementScenes()) {
    if (name == scene.name) return scene.text;
  }
  throw std::invalid_argument("there is no scene of agreement \"" + name + "\"");
}

// Glass and a mirror under lights of several kinds.
std::string SceneWithDeltas() {
  return FilmWith("box") + kDown + World(5) +
         "LightSource \"point\" \"rgb I\" [2 2 1] \"point3 from\" [0.8 1.5 0.4]\n" + Square("\"rgb L\" [6 6 6]", 0.5) +
         kThings + R"(AttributeBegin
Material "dielectric" "float eta" 1.5
Translate 0 0.6 0.3 Shape "sphere" "float radius" 0.3
AttributeEnd
AttributeBegin
Material "conductor" "rgb reflectance" [0.9 0.9 0.9]
Translate 0 0.5 -1 Shape "disk" "float radius" 0.8
AttributeEnd
)";
}

// Paths that the weights were proved of, until they were found wrong.
Finding FindByWeights() {
  Finding finding;
  const double start = CpuSeconds();
  const auto check = [&](const std::string& scene, int paths, float radius, bool aimed) {
    if (finding.found) return;
    const WeightErrors errors = CheckWeights(scene, {paths, radius, aimed, true});
    finding.samples += static_cast<uint64_t>(errors.paths);
    finding.property = errors.WhatIsWrong();
    finding.found = !finding.property.empty();
    if (finding.found) finding.property = "weights: " + finding.property;
  };
  for (const AgreementScene& scene : AgreementScenes()) check(scene.text, 4000, 0, false);
  check(SceneWithDeltas(), 20000, 0, false);
  for (const AgreementScene& scene : AgreementScenes()) {
    check(scene.text, 4000, 0.003f, false);
    check(scene.text, 4000, 0.1f, true);
  }
  check(SceneWithDeltas(), 20000, 0.05f, false);
  finding.seconds = CpuSeconds() - start;
  return finding;
}

struct AgreementPair {
  std::string scene, integrator;
  int blockSize = 8;
};

// A selection of tests/agreement, and photons, which are compared in tests of their own there.
std::vector<AgreementPair> AgreementPairs() {
  std::vector<AgreementPair> pairs;
  for (const char* scene : {"several_kinds", "smooth_normals", "rough_glass", "cylinder_lens", "portals"}) {
    for (const char* integrator : {"bdpt", "light"}) pairs.push_back({SceneNamed(scene), integrator});
  }
  for (const char* integrator : {"bdpt", "vcm", "sppm"}) pairs.push_back({SceneWithDeltas(), integrator});
  const std::string filtered =
      FilmWith("box") + kDown + World(3) +
      "AttributeBegin Translate 0 1.6 0 Rotate -90 1 0 0\nLightFilter \"barn\" \"float width\" 1.2 \"float height\" 1 "
      "\"float edge\" 0.4\nLightSource \"rect\" \"float width\" 0.4 \"float height\" 0.3 \"float intensity\" 20\n"
      "AttributeEnd\n" +
      kThings;
  for (const char* integrator : {"bdpt", "light", "vcm"}) pairs.push_back({filtered, integrator});
  return pairs;
}

RenderOverrides WithPhotons(const std::string& integrator) {
  RenderOverrides overrides;
  overrides.integrator = integrator;
  overrides.radius = 0.01;
  overrides.photons = 6000;
  return overrides;
}

Finding FindByAgreement() {
  constexpr int kCount = 12, kSamples = 64;
  Finding finding;
  const double start = CpuSeconds();
  const std::vector<AgreementPair> pairs = AgreementPairs();
  const double rate = SidakRate(kFamilyWise, static_cast<int>(pairs.size()));
  uint64_t seed = 0;
  for (const AgreementPair& pair : pairs) {
    if (finding.found) break;
    RenderOverrides overrides = WithPhotons(pair.integrator);
    overrides.seed = seed += 1000;
    const int own = pair.integrator == "light" ? 2 * kSamples : kSamples;
    const Replicas path = RenderReplicas(pair.scene, "path", kCount, kSamples);
    const Replicas other = RenderReplicas(pair.scene, pair.integrator, kCount, own, overrides);
    const auto pixels = static_cast<uint64_t>(path.images[0].width * path.images[0].height);
    finding.samples += pixels * static_cast<uint64_t>(kCount * (kSamples + own));
    const Agreement result = CompareReplicas(other, path, pair.blockSize, rate);
    finding.found = !result.Agrees() || other.faults + path.faults > 0;
    if (finding.found) finding.property = "agreement: " + pair.integrator;
  }
  finding.seconds = CpuSeconds() - start;
  return finding;
}

std::string Furnace() {
  LightSubject lamp;
  lamp.type = "rect";
  lamp.parameters = "\"float width\" 1.4 \"float height\" 0.8 \"float intensity\" 3 ";
  return FurnaceScene(lamp, "rect");
}

uint64_t Paths() {
  return RenderedPaths();
}

const std::vector<std::string> kFurnaceIntegrators = {"path", "light", "bdpt", "vcm"};

}  // namespace

WeightHelp PrepareWeights() {
  WeightHelp help;
  const double start = CpuSeconds();
  FindByWeights();
  FindByAgreement();
  help.seconds = CpuSeconds() - start;
  help.truth = RenderMean({Furnace(), "", {}}, "path", 512, 77).mean;
  return help;
}

Finding FindByProofs() {
  Finding finding = FindByWeights();
  if (finding.found) return finding;
  Finding agreement = FindByAgreement();
  agreement.samples += finding.samples;
  agreement.seconds += finding.seconds;
  return agreement;
}

Finding FindWeightsByFurnace(const WeightHelp& help) {
  return FindByFurnace({Furnace(), "", {}}, kFurnaceIntegrators, help.truth, help.seconds, Paths);
}

Finding FindWeightsByTiles(const WeightHelp& help) {
  Finding finding;
  for (const char* integrator : {"bdpt", "vcm", "sppm"}) {
    const Finding one = FindByTiles({SceneWithDeltas(), "", {}}, "path", integrator, help.seconds / 3, Paths);
    finding.seconds += one.seconds;
    finding.samples += one.samples;
    finding.property = one.property;
    finding.found = one.found;
    if (finding.found) break;
  }
  return finding;
}

}  // namespace lampyr::test
