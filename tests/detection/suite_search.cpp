#include "detection/search.h"
#include "lights/light_base.h"
#include "lights/suite/checks.h"
#include "lights/suite/filter_suite.h"
#include "lights/suite/statistics.h"
#include "lights/suite/suite_inputs.h"
#include "lights/suite/verdict.h"
#include "scene/scene_description.h"
#include "textures/texture_library.h"

namespace lampyr::test {

namespace {

constexpr int kLooks = 3;

ParameterList ParseOnShape(const std::string& type, const std::string& parameters) {
  Diagnostics diagnostics(Diagnostics::Mode::Collect);
  const std::string text = "WorldBegin\nAreaLightSource \"" + type + "\" " + parameters + "\nShape \"sphere\"\n";
  return ParseScene(text, "detection.pbrt", diagnostics).areaLights.at(0).parameters;
}

// A light on a shape, on one square in one place: its type runs over ten shapes in ten places.
std::vector<SuiteResult> CheckOnSquare(const LightSubject& subject, const LightType& type,
                                       const SuiteOptions& options) {
  auto mesh = std::make_shared<TriangleMesh>();
  mesh->positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
  mesh->triangles = {{0, 1, 2}, {0, 2, 3}};
  mesh->uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  const Shape shape = std::shared_ptr<const TriangleMesh>(mesh);
  const Transform turned = Transform::Translate({0.2, -0.3, 0.4}) * Transform::Rotate(40, {1, 0.5, 0.2});
  const LightTransform placed{turned.ToAffine(), turned.Inverse().ToAffine()};
  Diagnostics diagnostics(Diagnostics::Mode::Collect);
  const TextureLibrary textures({}, Transform(), diagnostics);
  LightBuildContext build;
  build.placement = turned;
  build.transform = placed;
  build.textures = &textures;
  build.diagnostics = &diagnostics;
  build.shape = &shape;
  const ParameterList parameters = ParseOnShape(type.name, subject.parameters);
  const std::unique_ptr<Light> light = MakeLight(type, parameters, build);
  const std::unique_ptr<EmitterModel> model = MakeEmitterModel(shape, turned);
  SuiteSubject checked;
  checked.light = light.get();
  checked.model = model.get();
  checked.context.transform = &placed;
  checked.context.scene = {placed.toRender.translation, 3};
  checked.context.bidirectional = true;
  checked.diffuseMultiplier = parameters.GetFloat("diffuse", 1);
  checked.specularMultiplier = parameters.GetFloat("specular", 1);
  checked.name = subject.name;
  SuiteReport report;
  suite::CheckEdit(checked, {&type, &parameters, &build, {ParseOnShape(type.name, "\"float scale\" 0.3")}}, report);
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
  // Of several the one that fails in most cases names the fault best.
  const LightVerdict* most = nullptr;
  const std::vector<LightVerdict> verdicts = SummariseByProperty(failed);
  for (const LightVerdict& verdict : verdicts) {
    if (!most || verdict.cases > most->cases) most = &verdict;
  }
  return most->property;
}

}  // namespace

Finding FindBySuite(const LightSubject& subject, const LightFault* fault, const std::filesystem::path& scratch,
                    bool full) {
  const LightType type = PlantedType(subject.name, fault);
  Finding finding;
  const double start = CpuSeconds();
  for (int look = full ? kLooks - 1 : 0; look < kLooks && !finding.found; ++look) {
    SuiteOptions options;
    const int part = 1 << (2 * (kLooks - 1 - look));
    options.samples /= part;
    options.photons /= part;
    options.familyWise = SidakLevel(kFamilyWise, kLooks);
    const uint64_t before = LightQueries();
    finding.property = WorstProperty(subject.isOnShape ? CheckOnSquare(subject, type, options)
                                                       : RunPdfSuite({type}, scratch, options));
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
