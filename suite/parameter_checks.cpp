#include "suite/parameter_checks.h"

#include "lights/light_base.h"
#include "scene/spectrum.h"
#include "suite/answers.h"
#include "suite/exact_surface.h"

namespace lampyr::suite {

namespace {

// Expected effect of a change: factors on the emission and on its diffuse and specular parts, and a further factor on
// the bounds' energy.
struct Effect {
  Color emitted{1.0f};
  float diffuse = 1, specular = 1, energy = 1;
  bool isInvisible = false;  // to the camera
  double tolerance = 1e-3;
};

Parameter Make(ParameterType type, const std::string& name) {
  Parameter parameter;
  parameter.type = type;
  parameter.name = name;
  return parameter;
}
Parameter Float(const std::string& name, double value) {
  Parameter parameter = Make(ParameterType::Float, name);
  parameter.numbers = {value};
  return parameter;
}
Parameter Bool(const std::string& name, bool value) {
  Parameter parameter = Make(ParameterType::Bool, name);
  parameter.bools = {value};
  return parameter;
}

class CommonParameters {
 public:
  CommonParameters(const SuiteSubject& subject, const SuiteOrigin& origin, SuiteReport& report)
      : subject_(subject), origin_(origin), given_(*origin.parameters), report_(report), rng_(subject.name.size()) {
    questions_ = MakeQuestions(subject, *subject.light, 48, rng_);
    for (const Question& question : questions_) answers_.push_back(Ask(*subject.light, question));
    whole_ = AskWhole(*subject.light, subject.context);
  }

  void Run();

 private:
  bool Has(const std::string& name, ParameterType type) const {
    for (const ParameterInfo& row : origin_.type->parameters) {
      if (row.name == name && row.type == type) return true;
    }
    return false;
  }
  void Check(const std::vector<Parameter>& changes, const Effect& effect, const LightSettings& settings);
  void CheckColors();
  void CheckNormalize();
  void CheckNormalizeOfLarger(double area);
  void CheckSettings();
  std::string Difference(const Light& changed, const Effect& effect, const LightSettings& settings) const;
  std::string DifferenceOfColors(const char* what, const Color& from, const Color& factor, const Color& got,
                                 double tolerance) const;
  template <class Result>
  std::string DifferenceOfParts(const char* what, const std::optional<Result>& from, const std::optional<Result>& got,
                                const Effect& effect) const;

  const SuiteSubject& subject_;
  const SuiteOrigin& origin_;
  const ParameterList& given_;
  SuiteReport& report_;
  Rng rng_;
  std::vector<Question> questions_;
  std::vector<Answer> answers_;
  Whole whole_;
};

std::string CommonParameters::DifferenceOfColors(const char* what, const Color& from, const Color& factor,
                                                 const Color& got, double tolerance) const {
  const Color wanted = from * factor;
  if (RelativeDifference(wanted, got) <= tolerance) return "";
  char text[240];
  const auto d = [](float value) { return static_cast<double>(value); };
  std::snprintf(text, sizeof(text), "%s: %.5g %.5g %.5g became %.5g %.5g %.5g; expected %.5g %.5g %.5g", what,
                d(from.r), d(from.g), d(from.b), d(got.r), d(got.g), d(got.b), d(wanted.r), d(wanted.g), d(wanted.b));
  return text;
}

template <class Result>
std::string CommonParameters::DifferenceOfParts(const char* what, const std::optional<Result>& from,
                                                const std::optional<Result>& got, const Effect& effect) const {
  if (from.has_value() != got.has_value()) return std::string(what) + (got ? " where there were none" : " are gone");
  if (!from) return "";
  const std::string diffuse = DifferenceOfColors((std::string("diffuse radiance of ") + what).c_str(), from->diffuse,
                                                 effect.emitted * effect.diffuse, got->diffuse, effect.tolerance);
  if (!diffuse.empty()) return diffuse;
  return DifferenceOfColors((std::string("specular radiance of ") + what).c_str(), from->specular,
                            effect.emitted * effect.specular, got->specular, effect.tolerance);
}

// The first difference on the same edges. Samples and photons may differ if the light's sampling depends on its colour;
// they are compared only where they coincide.
std::string CommonParameters::Difference(const Light& changed, const Effect& effect,
                                         const LightSettings& settings) const {
  const LightSettings& s = changed.Settings();
  if (s.name != settings.name || s.lightGroup != settings.lightGroup || s.cameraVisible != settings.cameraVisible ||
      s.traceLightPaths != settings.traceLightPaths || s.fixedSampleCount != settings.fixedSampleCount ||
      s.importanceMultiplier != settings.importanceMultiplier) {
    return "Settings() are not what was set";
  }
  for (size_t i = 0; i < questions_.size(); ++i) {
    const Answer &from = answers_[i], got = Ask(changed, questions_[i]);
    std::string difference = DifferenceOfParts("evaluations", from.evaluation, got.evaluation, effect);
    if (difference.empty()) {
      difference = DifferenceOfParts("evaluations where photons land", from.firstHit, got.firstHit, effect);
    }
    if (difference.empty() && !subject_.light->Settings().cameraVisible) {
      difference = from.camera.IsBlack() ? "" : "the camera sees a light that is invisible";
    } else if (difference.empty()) {
      const Color factor = effect.isInvisible ? Color(0.0f) : effect.emitted;
      difference = DifferenceOfColors("what the camera sees", from.camera, factor, got.camera, effect.tolerance);
    }
    if (difference.empty() && from.sample && got.sample &&
        glm::length(from.sample->direction - got.sample->direction) < 1e-6f) {
      difference = DifferenceOfParts("samples", from.sample, got.sample, effect);
    }
    if (difference.empty() && from.photon && got.photon && from.photon->direction == got.photon->direction &&
        from.photon->position == got.photon->position) {
      difference = DifferenceOfParts("photons", from.photon, got.photon, effect);
    }
    if (!difference.empty()) return difference;
  }
  const Whole whole = AskWhole(changed, subject_.context);
  const std::string power = DifferenceOfColors("power", whole_.power, effect.emitted, whole.power, effect.tolerance);
  if (!power.empty() || !whole.bounds || !whole_.bounds) return power;
  const float emitted = whole_.power.Average() > 0 ? (whole.power.Average() / whole_.power.Average()) : 1.0f;
  return DifferenceOfColors("energy of the bounds", Color(whole_.bounds->energy), Color(emitted * effect.energy),
                            Color(whole.bounds->energy), 2 * effect.tolerance);
}

void CommonParameters::Check(const std::vector<Parameter>& changes, const Effect& effect,
                             const LightSettings& settings) {
  const std::string& name = changes.front().name;
  std::string difference;
  try {
    const ParameterList list(given_.Where(), given_.Owner(), changes);
    const std::unique_ptr<Light> changed = MakeLight(*origin_.type, MergeParameters(given_, list), *origin_.build);
    difference = Difference(*changed, effect, settings);
  } catch (const Error& error) {
    difference = std::string("no light is made: ") + error.Text();
  }
  report_.AddError(subject_.name, "parameters", subject_.caseName + " by " + name, difference.empty() ? 0 : 1, 0.5,
                   difference.empty() ? "" : "\"" + name + "\": " + difference);
}

void CommonParameters::CheckColors() {
  const LightSettings same = subject_.light->Settings();
  Effect effect;
  if (const double intensity = given_.GetFloat("intensity", 1); Has("intensity", ParameterType::Float)) {
    effect.emitted = Color(2.5f);
    Check({Float("intensity", 2.5 * intensity)}, effect, same);
  }
  if (Has("exposure", ParameterType::Float)) {
    effect.emitted = Color(2.0f);
    Check({Float("exposure", given_.GetFloat("exposure", 0) + 1)}, effect, same);
  }
  if (Has("color", ParameterType::Rgb)) {
    effect.emitted = Color(0.2f, 0.5f, 0.9f);
    const Color color = given_.GetColor("color", Color(1.0f), SpectrumRole::Illuminant) * effect.emitted;
    Parameter parameter = Make(ParameterType::Rgb, "color");
    parameter.numbers = {static_cast<double>(color.r), static_cast<double>(color.g), static_cast<double>(color.b)};
    Check({parameter}, effect, same);
  }
  if (Has("colorTemperature", ParameterType::Float) && Has("enableColorTemperature", ParameterType::Bool)) {
    const bool isEnabled = given_.GetBool("enableColorTemperature", false);
    const Color body = BlackbodyToColor(3000, SpectrumRole::Illuminant);
    const Color before = BlackbodyToColor(given_.GetFloat("colorTemperature", 6500), SpectrumRole::Illuminant);
    effect.emitted = isEnabled ? Color(body.r / before.r, body.g / before.g, body.b / before.b) : body;
    Check({Float("colorTemperature", 3000), Bool("enableColorTemperature", true)}, effect, same);
  }
  effect = Effect();
  if (const double diffuse = given_.GetFloat("diffuse", 1); Has("diffuse", ParameterType::Float) && diffuse > 0) {
    effect.diffuse = 0.5f;
    Check({Float("diffuse", 0.5 * diffuse)}, effect, same);
  }
  effect = Effect();
  if (const double specular = given_.GetFloat("specular", 1); Has("specular", ParameterType::Float) && specular > 0) {
    effect.specular = 2;
    Check({Float("specular", 2 * specular)}, effect, same);
  }
}

// Normalisation is by the area in render space, if the light has one; points have no size. At infinity its meaning
// depends on the type.
void CommonParameters::CheckNormalize() {
  const Light& light = *subject_.light;
  if (!Has("normalize", ParameterType::Bool) || IsAtInfinity(light.Kind())) return;
  const bool isNormalized = given_.GetBool("normalize", false);
  Effect effect;
  if (light.Kind() == LightKind::Area) {
    double area = subject_.model ? subject_.model->Measure().area : 0.0;
    if (!subject_.model && light.Surface()) {
      const SurfaceTracer tracer(*light.Surface(), *subject_.context.transform);
      area = tracer
                 .IntegrateOver(
                     1, [](const SurfaceHit&) { return 0; }, [](const SurfaceHit&) { return 1.0; }, rng_)[0]
                 .value;
    }
    if (!(area > 0)) return;
    if (std::abs(area - 1) < 0.05) {
      CheckNormalizeOfLarger(area);
      return;
    }
    effect.emitted = Color(static_cast<float>(isNormalized ? area : 1 / area));
    effect.tolerance = 2e-2;  // of the area
  }
  Check({Bool("normalize", !isNormalized)}, effect, light.Settings());
}

// Normalisation by an area of 1 changes nothing, so the light is made anew, 1.7 times as large.
void CommonParameters::CheckNormalizeOfLarger(double area) {
  if (subject_.context.transform->toRender.linear != origin_.build->transform.toRender.linear) return;
  constexpr double kScale = 1.7;
  LightBuildContext build = *origin_.build;
  build.placement = build.placement * Transform::Scale(Vector3d(kScale));
  build.transform = {build.placement.ToAffine(), build.placement.Inverse().ToAffine()};
  const std::unique_ptr<Light> light = MakeLight(*origin_.type, given_, build);
  SuiteSubject larger = subject_;
  larger.light = light.get();
  larger.context.transform = &build.transform;
  const bool isNormalized = given_.GetBool("normalize", false);
  const double ratio = area * kScale * kScale;
  Effect effect;
  effect.emitted = Color(static_cast<float>(isNormalized ? ratio : 1 / ratio));
  effect.tolerance = 2e-2;
  const SuiteOrigin origin{origin_.type, &given_, &build, {}};
  CommonParameters(larger, origin, report_).Check({Bool("normalize", !isNormalized)}, effect, light->Settings());
}

void CommonParameters::CheckSettings() {
  const LightSettings given = subject_.light->Settings();
  const auto text = [](const char* name) {
    Parameter parameter = Make(ParameterType::String, name);
    parameter.strings = {"suite-other"};
    return parameter;
  };
  LightSettings settings = given;
  Effect effect;
  settings.cameraVisible = !given.cameraVisible;
  effect.isInvisible = true;
  if (given.cameraVisible && Has("cameraVisible", ParameterType::Bool))
    Check({Bool("cameraVisible", false)}, effect, settings);
  settings = given;
  effect = Effect();
  settings.traceLightPaths = !given.traceLightPaths;
  if (Has("traceLightPaths", ParameterType::Bool))
    Check({Bool("traceLightPaths", settings.traceLightPaths)}, effect, settings);
  settings = given;
  settings.name = "suite-other";
  if (Has("name", ParameterType::String)) Check({text("name")}, effect, settings);
  settings = given;
  settings.lightGroup = "suite-other";
  if (Has("lightGroup", ParameterType::String)) Check({text("lightGroup")}, effect, settings);
  settings = given;
  settings.fixedSampleCount = given.fixedSampleCount + 3;
  if (Has("fixedSampleCount", ParameterType::Integer)) {
    Parameter count = Make(ParameterType::Integer, "fixedSampleCount");
    count.integers = {settings.fixedSampleCount};
    Check({count}, effect, settings);
  }
  settings = given;
  settings.importanceMultiplier = 4 * given.importanceMultiplier;
  effect.energy = 4;
  if (Has("importanceMultiplier", ParameterType::Float))
    Check({Float("importanceMultiplier", static_cast<double>(settings.importanceMultiplier))}, effect, settings);
}

void CommonParameters::Run() {
  CheckColors();
  CheckNormalize();
  CheckSettings();
}

// Values to try, in scene syntax.
std::vector<std::string> CandidatesOf(const ParameterInfo& row, const ParameterList& given) {
  const auto one = [&](const char* type, const std::string& value) {
    return std::string("\"") + type + " " + row.name + "\" " + value + " ";
  };
  std::vector<std::string> texts;
  switch (row.type) {
    case ParameterType::Float: {
      const double value = given.GetFloat(row.name, std::strtod(row.defaultValue.c_str(), nullptr));
      for (const double other : {0.7 * value, 1.6 * value + 0.1, value + 5, 30.0, 0.3}) {
        if (other != value) texts.push_back(one("float", std::to_string(other)));
      }
      break;
    }
    case ParameterType::Integer:
      texts.push_back(
          one("integer", std::to_string(given.GetInteger(row.name, std::atoi(row.defaultValue.c_str())) + 3)));
      break;
    case ParameterType::Bool:
      texts.push_back(one("bool", given.GetBool(row.name, row.defaultValue == "true") ? "false" : "true"));
      break;
    case ParameterType::String:
      for (const char* value : {"suite-texture.exr", "suite-texture-2.exr", "suite-square.exr", "suite-latlong.exr",
                                "suite-profile.ies", "suite-profile-2.ies", "Z", "Y", "latlong", "suite-other"}) {
        texts.push_back(one("string", std::string("\"") + value + "\""));
      }
      break;
    case ParameterType::Rgb:
    case ParameterType::Spectrum:
    case ParameterType::Blackbody:
      texts.push_back(one("rgb", "[ 0.2 0.5 0.9 ]"));
      break;
    case ParameterType::Point3:
      texts.push_back(one("point3", "[ 0.3 -0.4 0.6 ]"));
      break;
    case ParameterType::Vector3:
      texts.push_back(one("vector3", "[ 0.3 -0.4 0.6 ]"));
      break;
    default:
      break;
  }
  // Parameters that have an effect only together with another.
  const size_t alone = texts.size();
  for (size_t i = 0; i < alone; ++i) {
    if (row.name == "colorTemperature") texts.push_back(texts[i] + "\"bool enableColorTemperature\" true");
    if (row.name == "enableColorTemperature") texts.push_back(texts[i] + "\"float colorTemperature\" 3000");
    if (row.name.starts_with("shaping:ies:"))
      texts.push_back(texts[i] + "\"string shaping:ies:file\" \"suite-profile.ies\"");
    if (row.name == "shaping:focusTint") texts.push_back(texts[i] + "\"float shaping:focus\" 2");
    if (row.name == "shaping:cone:softness") texts.push_back(texts[i] + "\"float shaping:cone:angle\" 50");
  }
  return texts;
}

bool Differ(const SuiteSubject& subject, const Light& a, const Light& b, const std::vector<Question>& questions) {
  if (!DifferenceAsWhole(subject, a, b).empty()) return true;
  for (const Question& question : questions) {
    if (!Difference(Ask(a, question), Ask(b, question)).empty()) return true;
  }
  return false;
}

}  // namespace

void CheckCommonParameters(const SuiteSubject& subject, const SuiteOrigin& origin, SuiteReport& report) {
  CommonParameters(subject, origin, report).Run();
}

std::vector<ParameterList> ChangesOfEach(const SuiteSubject& subject, const SuiteOrigin& origin,
                                         const ParseParameters& parse) {
  Rng rng(origin.type->name.size());
  const std::vector<Question> questions = MakeQuestions(subject, *subject.light, 64, rng);
  std::vector<ParameterList> changes;
  for (const ParameterInfo& row : origin.type->parameters) {
    for (const std::string& text : CandidatesOf(row, *origin.parameters)) {
      try {
        const ParameterList change = parse(text);
        const auto other = MakeLight(*origin.type, MergeParameters(*origin.parameters, change), *origin.build);
        if (!Differ(subject, *subject.light, *other, questions)) continue;
        changes.push_back(change);
        break;
      } catch (const Error&) {
        // Not a value that this type takes.
      }
    }
  }
  return changes;
}

}  // namespace lampyr::suite
