#include <algorithm>

#include "detection/search.h"
#include "lights/light_base.h"
#include "scene/scene_description.h"
#include "suite/checks.h"
#include "suite/filter_suite.h"
#include "suite/scene_suite.h"
#include "suite/statistics.h"
#include "suite/suite_inputs.h"
#include "suite/verdict.h"
#include "textures/texture_library.h"

namespace lampyr::test {

namespace {

constexpr int kLooks = 2;

ParameterList Parse(const LightSubject& subject, const std::string& parameters, const std::filesystem::path& scratch) {
  Diagnostics diagnostics(Diagnostics::Mode::Collect);
  const std::string statement = std::string(subject.isOnShape ? "AreaLightSource" : "LightSource") + " \"planted\" ";
  const std::string shape = subject.isOnShape ? "\nShape \"sphere\"\n" : "\n";
  const SceneDescription scene =
      ParseScene("WorldBegin\n" + statement + parameters + shape, scratch / "detection.pbrt", diagnostics);
  return subject.isOnShape ? scene.areaLights.at(0).parameters : scene.lights.at(0).light.parameters;
}

std::shared_ptr<TriangleMesh> Square() {
  auto mesh = std::make_shared<TriangleMesh>();
  mesh->positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
  mesh->triangles = {{0, 1, 2}, {0, 2, 3}};
  mesh->uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  return mesh;
}

// The light in one place; one on a shape, on one square.
std::vector<SuiteResult> CheckPlaced(const LightSubject& subject, const LightType& type,
                                     const std::filesystem::path& scratch, const SuiteOptions& options) {
  const Transform turned = Transform::Translate({0.2, -0.3, 0.4}) * Transform::Rotate(40, {1, 0.5, 0.2});
  const LightTransform placed{turned.ToAffine(), turned.Inverse().ToAffine()};
  const Shape shape = std::shared_ptr<const TriangleMesh>(Square());
  Diagnostics diagnostics(Diagnostics::Mode::Collect);
  const TextureLibrary textures({}, Transform(), diagnostics);
  LightBuildContext build;
  build.placement = turned;
  build.transform = placed;
  build.textures = &textures;
  build.diagnostics = &diagnostics;
  if (subject.isOnShape) build.shape = &shape;
  const ParameterList parameters = Parse(subject, subject.parameters, scratch);
  const std::unique_ptr<Light> light = MakeLight(type, parameters, build);
  std::unique_ptr<EmitterModel> model;
  if (subject.isOnShape) model = MakeEmitterModel(shape, turned);
  SuiteSubject checked;
  checked.light = light.get();
  checked.model = model.get();
  checked.context.transform = &placed;
  checked.context.scene = {placed.toRender.translation, 3};
  checked.context.bidirectional = true;
  checked.isPowerExact = !IsUneven(parameters);
  checked.diffuseMultiplier = parameters.GetFloat("diffuse", 1);
  checked.specularMultiplier = parameters.GetFloat("specular", 1);
  checked.name = subject.name;
  std::vector<ParameterList> changes;
  for (const char* name : {"scale", "intensity"}) {
    const auto isIt = [&](const ParameterInfo& info) { return info.name == name; };
    if (std::any_of(type.parameters.begin(), type.parameters.end(), isIt))
      changes.push_back(Parse(subject, std::string("\"float ") + name + "\" 0.3", scratch));
  }
  SuiteReport report;
  suite::CheckEdit(checked, {&type, &parameters, &build, changes}, report);
  CheckLight(checked, options, report);
  return report.Finish(options.familyWise);
}

// The property that fails by most; "": none.
std::string WorstProperty(const std::vector<SuiteResult>& results) {
  std::vector<SuiteResult> failed;
  for (const SuiteResult& result : results) {
    if (!result.passed) failed.push_back(result);
  }
  if (failed.empty()) return "";
  // If several properties fail, the fault is attributed to the one that fails in most cases.
  const LightVerdict* most = nullptr;
  const std::vector<LightVerdict> verdicts = SummariseByProperty(failed);
  for (const LightVerdict& verdict : verdicts) {
    if (!most || verdict.cases > most->cases) most = &verdict;
  }
  return most->property;
}

}  // namespace

Finding FindBySuite(const LightSubject& subject, const LightFault* fault, const std::filesystem::path& scratch) {
  const LightType type = PlantedType(subject.name, fault);
  Finding finding;
  const double start = CpuSeconds();
  SuiteOptions options;
  options.familyWise = SidakLevel(kFamilyWise, kLooks);
  for (int look = 0; look < kLooks && !finding.found; ++look) {
    // All of a type on a shape is ten shapes in ten places: minutes.
    if (look > 0 && subject.isOnShape) break;
    const uint64_t before = LightQueries();
    finding.property =
        WorstProperty(look == 0 ? CheckPlaced(subject, type, scratch, options) : RunPdfSuite({type}, scratch, options));
    finding.found = !finding.property.empty();
    finding.samples = LightQueries() - before;
  }
  finding.seconds = CpuSeconds() - start;
  return finding;
}

Finding FindBySuite(const FilterSubject& subject, const FilterFault* fault, const std::filesystem::path& scratch) {
  Finding finding;
  const double start = CpuSeconds();
  const uint64_t before = FilteredEdges();
  SuiteOptions options;
  options.familyWise = kFamilyWise;
  finding.property = WorstProperty(RunFilterSuite({PlantedFilterType(subject.name, fault)}, scratch, options));
  finding.found = !finding.property.empty();
  finding.samples = FilteredEdges() - before;
  finding.seconds = CpuSeconds() - start;
  return finding;
}

}  // namespace lampyr::test
