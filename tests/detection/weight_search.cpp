#include "detection/weight_search.h"

#include <algorithm>

#include "agreement/agreement_scenes.h"
#include "agreement/weight_proof.h"
#include "detection/baseline_render.h"
#include "suite/statistics.h"
#include "support/replicas.h"

namespace lampyr::test {

namespace {

std::string SceneNamed(const std::string& name) {
  for (const AgreementScene& scene : AgreementScenes()) {
    if (name == scene.name) return scene.text;
  }
  throw std::invalid_argument("there is no scene of agreement \"" + name + "\"");
}

// Glass and a mirror under large lights, through a lens: what path tracing sees, too.
std::string SceneWithDeltas() {
  return FilmWith("box") +
         "LookAt 0 3 2.5  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 36 \"float lensradius\" 0.1 \"float "
         "focaldistance\" 3.8\n" +
         World(5) + "LightSource \"infinite\" \"rgb L\" [0.3 0.4 0.5]\n" + Square("\"rgb L\" [2 2 2]", 1.4) + kThings +
         R"(AttributeBegin
Material "dielectric" "float eta" 1.5
Translate 0 0.6 0.3 Shape "sphere" "float radius" 0.3
AttributeEnd
AttributeBegin
Material "conductor" "rgb reflectance" [0.9 0.9 0.9]
Translate 0 0.5 -1 Shape "disk" "float radius" 0.8
AttributeEnd
)";
}

// A light with a filter.
std::string FilteredScene() {
  return FilmWith("box") + kDown + World(3) +
         "AttributeBegin Translate 0 1.6 0 Rotate -90 1 0 0\nLightFilter \"barn\" \"float width\" 1.2 \"float "
         "height\" 1 \"float edge\" 0.4\nLightSource \"rect\" \"float width\" 0.4 \"float height\" 0.3 \"float "
         "intensity\" 20\nAttributeEnd\n" +
         kThings;
}

// Shading normals that differ from the geometry's by much, in a room whose light comes by two events: what the
// correction of importance is for. Light paths make few splats of a small picture.
std::string BentNormals() {
  return "Film \"rgb\" \"integer xresolution\" 16 \"integer yresolution\" 16\nPixelFilter \"box\"\n"
         "Integrator \"path\" \"integer maxdepth\" 2\nLookAt -0.2 -0.15 0  -1 -0.6 0.5  0 1 0\n"
         "Camera \"perspective\" \"float fov\" 80\nWorldBegin\n"
         "AttributeBegin Translate 0.25 0.4 0.1 AreaLightSource \"diffuse\" \"rgb L\" [4 3 2] Material \"diffuse\" "
         "\"rgb reflectance\" [0 0 0] Shape \"sphere\" \"float radius\" 0.25 AttributeEnd\n"
         "Material \"diffuse\" \"rgb reflectance\" [0.7 0.6 0.5] \"string normalmap\" \"" LAMPYR_SOURCE_DIR
         "/scenes/data/paving-normal.png\" Shape \"sphere\" \"float radius\" 1\n";
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

struct AgreementCase {
  std::string scene;
  std::vector<std::string> integrators;
  int samples = 16;  // per pixel and replica
};

// A selection of tests/agreement; and photons, which are compared in tests of their own there.
std::vector<AgreementCase> AgreementCases() {
  return {{SceneNamed("several_kinds"), {"bdpt", "light"}},
          {SceneNamed("smooth_normals"), {"bdpt", "light"}},
          {FilteredScene(), {"bdpt", "light"}},
          {SceneWithDeltas(), {"bdpt", "vcm", "sppm"}},
          {BentNormals(), {"light"}, 400}};
}

RenderOverrides WithPhotons(const std::string& integrator) {
  RenderOverrides overrides;
  overrides.integrator = integrator;
  overrides.values["radius"] = 0.01;
  overrides.values["photons"] = 6000;
  return overrides;
}

Finding FindByAgreement() {
  constexpr int kCount = 12, kComparisons = 10;
  Finding finding;
  const double start = CpuSeconds();
  const double rate = SidakRate(kFamilyWise, kComparisons);
  uint64_t seed = 0;
  const auto render = [&](const std::string& scene, const std::string& integrator, int ofCase) {
    RenderOverrides overrides = WithPhotons(integrator);
    overrides.seed = seed += 1000;
    const int samples = integrator == "light" ? 2 * ofCase : ofCase;
    Replicas replicas = RenderReplicas(scene, integrator, kCount, samples, overrides);
    const Image& image = replicas.images[0];
    finding.samples += static_cast<uint64_t>(image.width) * static_cast<uint64_t>(image.height * kCount * samples);
    return replicas;
  };
  for (const AgreementCase& part : AgreementCases()) {
    const Replicas path = render(part.scene, "path", part.samples);
    for (const std::string& integrator : part.integrators) {
      const Replicas other = render(part.scene, integrator, part.samples);
      finding.found = !CompareReplicas(other, path, 8, rate).Agrees() || other.faults + path.faults > 0;
      if (!finding.found) continue;
      finding.property = "agreement: " + integrator;
      finding.seconds = CpuSeconds() - start;
      return finding;
    }
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

double TrueMeanOfLamp() {
  return RenderMean({Furnace(), "", {}}, "path", 256, 77).mean;
}

Finding FindByProofs() {
  Finding finding = FindByWeights();
  if (finding.found) return finding;
  Finding agreement = FindByAgreement();
  agreement.samples += finding.samples;
  agreement.seconds += finding.seconds;
  return agreement;
}

Finding FindWeightsByFurnace(double truth, double seconds) {
  return FindByFurnace({Furnace(), "", {}}, kFurnaceIntegrators, truth, seconds, Paths);
}

Finding FindWeightsByTiles(double seconds) {
  const std::vector<std::pair<std::string, std::string>> pairs = {{SceneWithDeltas(), "bdpt"},
                                                                  {SceneWithDeltas(), "vcm"},
                                                                  {SceneNamed("smooth_normals"), "bdpt"},
                                                                  {FilteredScene(), "bdpt"}};
  Finding finding;
  for (const auto& [scene, integrator] : pairs) {
    const double part = seconds / static_cast<double>(pairs.size());
    const Finding one = FindByTiles({scene, "", {}}, "path", integrator, part, Paths);
    finding.seconds += one.seconds;
    finding.samples += one.samples;
    finding.property = integrator + ", " + one.property;
    finding.found = one.found;
    if (finding.found) break;
  }
  return finding;
}

}  // namespace lampyr::test
