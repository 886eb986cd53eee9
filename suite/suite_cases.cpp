// Cases of the suite: every sample block of every type, on every shape for area lights, under every transform, and
// moved away from where it was built.
#include <array>
#include <functional>
#include <set>

#include "scene/scene_description.h"
#include "suite/checks.h"
#include "suite/parameter_checks.h"
#include "suite/scene_suite.h"
#include "suite/suite_inputs.h"
#include "suite/suite_shapes.h"
#include "textures/texture_library.h"

namespace lampyr {

namespace {

using suite::NamedShape;
using suite::NamedTransform;

ParameterList ParseSample(const LightType& type, const std::string& sample, const std::filesystem::path& folder,
                          Diagnostics& diagnostics) {
  const std::string statement =
      (type.isAreaLight ? "AreaLightSource \"" : "LightSource \"") + type.name + "\" " + sample;
  const std::string text = "WorldBegin\n" + statement + "\n" + (type.isAreaLight ? "Shape \"sphere\"\n" : "");
  const SceneDescription scene = ParseScene(text, folder / "suite.pbrt", diagnostics);
  return type.isAreaLight ? scene.areaLights.at(0).parameters : scene.lights.at(0).light.parameters;
}

bool HasParameter(const LightType& type, const std::string& name) {
  return std::any_of(type.parameters.begin(), type.parameters.end(),
                     [&](const ParameterInfo& info) { return info.name == name; });
}

// The parameters with each input file of the suite replaced by another of its kind; nullopt if they name none.
std::optional<ParameterList> WithOtherFiles(const ParameterList& parameters) {
  std::vector<Parameter> changed;
  for (Parameter parameter : parameters.All()) {
    bool hasOther = false;
    for (std::string& text : parameter.strings) {
      const std::filesystem::path file(text);
      const std::string other = suite::OtherSuiteInput(file.filename().string());
      if (other.empty()) continue;
      text = (file.parent_path() / other).string();
      hasOther = true;
    }
    if (hasOther) changed.push_back(parameter);
  }
  if (changed.empty()) return std::nullopt;
  return ParameterList(parameters.Where(), parameters.Owner(), changed);
}

// One light at one placement. `parameters` and `type` belong to the run and are shared by cases.
struct SuiteCase {
  const LightType* type = nullptr;
  const ParameterList* parameters = nullptr;
  const std::vector<ParameterList>* changes = nullptr;  // edits to check; null: none in this case
  std::string name, caseName, shapeName;
  std::optional<Shape> shape;
  Transform builtAt, placedAt;
  bool keepsAngles = true;
  bool isSharp = true;  // power to half a per cent; two per cent otherwise
  bool isThorough = false;
  bool looksClosely = false;   // every n-th of the thorough cases, by the options
  bool isOfItsBlock = false;   // one case of each block, which is always checked thoroughly
  bool isEditedByAll = false;  // by each parameter of its type
};

class SuiteRun {
 public:
  SuiteRun(const std::filesystem::path& folder, const SuiteOptions& options) : folder_(folder), options_(options) {}

  void Add(const LightType& type);
  std::vector<SuiteResult> Run();

 private:
  void AddRefusals(const std::vector<std::string>& refusals, SuiteReport& report) const;
  void AddCases(const SuiteCase& light, int which, size_t block);
  SuiteReport Check(const SuiteCase& suiteCase, std::string& refusal) const;
  void CheckParametersOf(const SuiteCase& suiteCase, const SuiteSubject& subject, SuiteOrigin origin,
                         SuiteReport& report) const;
  std::vector<ParameterList> ChangesOf(const LightType& type, size_t index);

  std::filesystem::path folder_;
  SuiteOptions options_;
  Diagnostics diagnostics_{Diagnostics::Mode::Collect};
  std::vector<std::unique_ptr<ParameterList>> parameters_;
  std::vector<std::unique_ptr<std::vector<ParameterList>>> changes_;
  std::vector<SuiteCase> cases_;
  std::set<std::string> blocks_;
  int thorough_ = 0;
};

// Edits to check: an intensity, a colour, a scale, the parameters of the next sample block, and other files.
std::vector<ParameterList> SuiteRun::ChangesOf(const LightType& type, size_t index) {
  std::vector<std::string> texts;
  if (HasParameter(type, "intensity")) texts.push_back("\"float intensity\" 2.5");
  if (HasParameter(type, "color")) texts.push_back("\"rgb color\" [ 0.2 0.5 0.9 ]");
  if (HasParameter(type, "scale")) texts.push_back("\"float scale\" 0.3");
  if (type.samples.size() > 1) texts.push_back(type.samples[(index + 1) % type.samples.size()]);
  std::vector<ParameterList> changes;
  for (const std::string& text : texts) changes.push_back(ParseSample(type, text, folder_, diagnostics_));
  if (auto other = WithOtherFiles(ParseSample(type, type.samples[index], folder_, diagnostics_))) {
    changes.push_back(*other);
  }
  return changes;
}

void SuiteRun::Add(const LightType& type) {
  int which = 0;
  for (size_t index = 0; index < type.samples.size(); ++index) {
    parameters_.push_back(
        std::make_unique<ParameterList>(ParseSample(type, type.samples[index], folder_, diagnostics_)));
    changes_.push_back(std::make_unique<std::vector<ParameterList>>(ChangesOf(type, index)));
    SuiteCase light;
    light.type = &type;
    light.parameters = parameters_.back().get();
    light.changes = changes_.back().get();
    light.name = type.name + "[" + std::to_string(index) + "]";
    if (!type.isAreaLight) {
      AddCases(light, static_cast<int>(index), index);
      continue;
    }
    // The first block on every shape, the others on every third, in turn: together they cover the combinations.
    const std::vector<NamedShape> shapes = suite::Shapes();
    for (size_t i = 0; i < shapes.size(); ++i) {
      const NamedShape& shape = shapes[i];
      if (index > 0 && (i + index) % 3 != 0) continue;
      light.shape = shape.shape;
      light.shapeName = shape.name;
      light.caseName = shape.name + " ";
      AddCases(light, which++, index);
    }
  }
}

// A type's first block under all placements; the others each under four of the ten, in turn.
void SuiteRun::AddCases(const SuiteCase& light, int which, size_t block) {
  const std::vector<NamedTransform> transforms = suite::Transforms();
  int kept = 0;
  const size_t turn = static_cast<size_t>(which) + block;
  auto add = [&, k = size_t{0}](SuiteCase&& placed) mutable {
    const bool isMoved = k >= transforms.size();
    const size_t place = k++;
    if (block > 0 && (place + turn) % 5 > 1) return;
    placed.isSharp = block == 0 ? place == 0 || place == transforms.size() - 1 || isMoved : kept == 0;
    // One placement of each block on each shape, in rotation.
    placed.isThorough = block == 0 ? place == turn % transforms.size() : kept == 0;
    placed.looksClosely = placed.isThorough && thorough_++ % std::max(options_.thoroughEvery, 1) == 0;
    placed.isOfItsBlock = placed.isThorough && blocks_.insert(light.name).second;
    placed.isEditedByAll = placed.isOfItsBlock && block % static_cast<size_t>(std::max(options_.editEvery, 1)) == 0;
    ++kept;
    cases_.push_back(std::move(placed));
  };
  for (const NamedTransform& transform : transforms) {
    // Alternately the shape baked into its placement, and an instance of it.
    const bool isBaked = light.shape && which++ % 2 == 0;
    SuiteCase placed = light;
    placed.caseName += transform.name + (light.shape && !isBaked ? " instance" : "");
    placed.keepsAngles = transform.keepsAngles;
    if (isBaked) {
      placed.shape = suite::Bake(*light.shape, transform.transform);
    } else {
      placed.builtAt = placed.placedAt = transform.transform;
    }
    if (transform.name != "rotated" && block == 0) placed.changes = nullptr;
    add(std::move(placed));
  }
  // Placed elsewhere than where it was built, as at another time of the shutter.
  for (const auto& [from, to] : {std::pair(0, 1), std::pair(1, 4), std::pair(5, 2)}) {
    SuiteCase moved = light;
    moved.caseName += "moved from " + transforms[from].name + " to " + transforms[to].name;
    moved.builtAt = transforms[from].transform;
    moved.placedAt = transforms[to].transform;
    moved.keepsAngles = transforms[to].keepsAngles;
    moved.changes = nullptr;
    add(std::move(moved));
  }
}

LightTransform ToLightTransform(const Transform& toRender) {
  return {toRender.ToAffine(), toRender.Inverse().ToAffine()};
}

void SuiteRun::CheckParametersOf(const SuiteCase& suiteCase, const SuiteSubject& subject, SuiteOrigin origin,
                                 SuiteReport& report) const {
  if (suiteCase.isThorough) suite::CheckCommonParameters(subject, origin, report);
  if (suiteCase.changes) origin.changes = *suiteCase.changes;
  if (suiteCase.isEditedByAll) {
    Diagnostics diagnostics(Diagnostics::Mode::Collect);
    const auto parse = [&](const std::string& text) {
      return ParseSample(*suiteCase.type, text, folder_, diagnostics);
    };
    for (const ParameterList& change : suite::ChangesOfEach(subject, origin, parse)) origin.changes.push_back(change);
  }
  suite::CheckEdit(subject, origin, report);
}

namespace {

// A portal is given in world space: it stays where it was built, in its size, wherever the light is placed.
BoundingSphere SceneAround(const LightTransform& placed, const LightTransform& built, bool hasPortal) {
  const float radius = 3 * MaxAbsComponent(placed.toRender.linear[0]);
  if (hasPortal) return {built.toRender.translation, std::max(radius, 4.0f)};
  return {placed.toRender.translation, radius};
}

}  // namespace

// `refusal`: receives the error of a light that refuses the shape.
SuiteReport SuiteRun::Check(const SuiteCase& suiteCase, std::string& refusal) const {
  // Each case has its own lists, because these record their use and cases run in parallel.
  Diagnostics diagnostics(Diagnostics::Mode::Collect);
  const TextureLibrary textures({}, Transform(), diagnostics);
  const ParameterList parameters = *suiteCase.parameters;
  LightBuildContext build;
  build.placement = suiteCase.builtAt;
  build.transform = ToLightTransform(suiteCase.builtAt);
  build.worldToRender = Transform::Translate(Vector3d(build.transform.toRender.translation));
  build.textures = &textures;
  build.diagnostics = &diagnostics;
  if (suiteCase.shape) build.shape = &*suiteCase.shape;
  const LightTransform placed = ToLightTransform(suiteCase.placedAt);
  std::unique_ptr<EmitterModel> model;
  // The model uses the same numbers as the light: the remaining difference is the light's own rounding.
  if (suiteCase.shape) model = MakeEmitterModel(*suiteCase.shape, suite::ToTransform(placed.toRender));

  SuiteReport report;
  SuiteSubject subject;
  subject.name = suiteCase.name;
  subject.caseName = suiteCase.caseName;
  if (!suiteCase.isSharp) subject.powerError = 2.5e-3;
  subject.isThorough = suiteCase.looksClosely;
  subject.model = model.get();
  subject.context.transform = &placed;
  subject.context.scene = SceneAround(placed, build.transform, parameters.Find("portal"));
  subject.context.bidirectional = true;
  std::unique_ptr<Light> light;
  try {
    light = MakeLight(*suiteCase.type, parameters, build);
  } catch (const Error& error) {
    // A type may support only some shapes.
    if (!suiteCase.shape) throw;
    refusal = error.what();
    return report;
  }
  subject.light = light.get();
  if (IsAtInfinity(light->Kind()) && suiteCase.type->name != "portal") {
    // The scene has another position than the light, and a size that does not follow from it. A portal is a window of
    // the scene.
    constexpr std::array<float, 4> kSizes = {1.0f, 0.4f, 15.0f, 2.2f};
    BoundingSphere& scene = subject.context.scene;
    scene.radius *= kSizes[std::hash<std::string>()(suiteCase.caseName) % kSizes.size()];
    if (parameters.Find("portal")) scene.radius = std::max(scene.radius, 4.0f);
    scene.center += scene.radius * Vector3(0.3f, -0.2f, 0.4f);
  }
  subject.isPowerExact = light->Kind() == LightKind::Area ? !IsUneven(parameters) : suiteCase.keepsAngles;
  if (HasParameter(*suiteCase.type, "diffuse")) {
    subject.diffuseMultiplier = parameters.GetFloat("diffuse", 1);
    subject.specularMultiplier = parameters.GetFloat("specular", 1);
  }
  suite::WithoutExceptions(subject.name, subject.caseName, report, [&] {
    if (options_.parts & kParameterPart)
      CheckParametersOf(suiteCase, subject, {suiteCase.type, &parameters, &build, {}}, report);
    CheckLight(subject, options_, report);
  });
  return report;
}

// A type may support only some shapes: it refuses the others with every sample block. `refusals`: by case; empty:
// accepted.
void SuiteRun::AddRefusals(const std::vector<std::string>& refusals, SuiteReport& report) const {
  const auto exists = [&](const auto& isWanted) {
    for (size_t k = 0; k < cases_.size(); ++k)
      if (isWanted(cases_[k], !refusals[k].empty())) return true;
    return false;
  };
  for (size_t i = 0; i < cases_.size(); ++i) {
    const SuiteCase& refused = cases_[i];
    if (refusals[i].empty()) continue;
    const bool isAcceptedElsewhere =
        exists([&](const SuiteCase& other, bool isRefused) { return other.type == refused.type && !isRefused; });
    const bool isAcceptedOtherwise = exists([&](const SuiteCase& other, bool isRefused) {
      return other.type == refused.type && other.shapeName == refused.shapeName && !isRefused;
    });
    report.AddError(refused.name, "shapes", refused.caseName, isAcceptedElsewhere && !isAcceptedOtherwise ? 0 : 1, 0.5,
                    refusals[i]);
  }
}

std::vector<SuiteResult> SuiteRun::Run() {
  std::vector<SuiteCase> chosen;
  for (size_t i = 0; i < cases_.size(); ++i) {
    if (i % static_cast<size_t>(std::max(options_.caseEvery, 1)) == 0 || cases_[i].isOfItsBlock)
      chosen.push_back(std::move(cases_[i]));
  }
  cases_ = std::move(chosen);
  std::vector<std::string> refusals(cases_.size());
  SuiteReport all = suite::RunCases(cases_.size(), options_, [&](size_t index, SuiteReport& report) {
    report = Check(cases_[index], refusals[index]);
  });
  AddRefusals(refusals, all);
  return all.Finish(options_.familyWise);
}

}  // namespace

std::vector<SuiteResult> RunPdfSuite(const std::vector<LightType>& types, const std::filesystem::path& scratch,
                                     const SuiteOptions& options) {
  suite::WriteSuiteInputs(scratch);
  SuiteRun run(scratch, options);
  for (const LightType& type : types) run.Add(type);
  return run.Run();
}

}  // namespace lampyr
