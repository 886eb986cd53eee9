#include "lights/types/shaping.h"

#include "lights/light_base.h"
#include "lights/types/shaped_table.h"

namespace lampyr {

namespace {

bool HasAny(const ParameterList& parameters, std::initializer_list<const char*> names) {
  bool any = false;
  for (const char* name : names) any = parameters.Find(name) || any;
  return any;
}

void Warn(const ParameterList& parameters, const LightBuildContext& build, const std::string& name,
          const std::string& what) {
  if (build.diagnostics)
    build.diagnostics->Warn(parameters.WhereOf(name), parameters.Owner() + ": \"" + name + "\" " + what);
}

ConeSetting ReadCone(const ParameterList& parameters, const LightBuildContext& build) {
  ConeSetting cone;
  cone.inForce = HasAny(parameters, {"shaping:cone:angle", "shaping:cone:softness"});
  const double degrees = parameters.GetFloat("shaping:cone:angle", 90);
  if (!(degrees > 0 && degrees <= 180)) {
    throw Error(parameters.WhereOf("shaping:cone:angle"),
                parameters.Owner() + ": \"shaping:cone:angle\" is out of range: (0,180] degrees are allowed");
  }
  // The density of a narrower beam exceeds the range of float.
  cone.angle = std::max(degrees / 180 * kPiExact, 1e-12);
  const double softness = parameters.GetFloat("shaping:cone:softness", 0);
  cone.softness = std::clamp(softness, 0.0, 1.0);
  if (cone.softness != softness) Warn(parameters, build, "shaping:cone:softness", "is clamped to [0,1]");
  return cone;
}

FocusSetting ReadFocus(const ParameterList& parameters, const LightBuildContext& build) {
  FocusSetting focus;
  const bool given = HasAny(parameters, {"shaping:focus", "shaping:focusTint"});
  focus.exponent = static_cast<float>(parameters.GetFloat("shaping:focus", 0));
  if (parameters.Find("shaping:focusTint")) focus.tint = ReadEmissionColor(parameters, "shaping:focusTint");
  if (focus.exponent > 1e8f) {  // a lobe of 0.01°, which doubles about the zenith still resolve
    throw Error(parameters.WhereOf("shaping:focus"), parameters.Owner() + ": \"shaping:focus\" has to be at most 1e8");
  }
  if (focus.exponent < 0) Warn(parameters, build, "shaping:focus", "is negative and has no effect");
  focus.inForce = given && focus.exponent > 0;
  return focus;
}

std::unique_ptr<const ShapedProfile> ReadProfile(const ParameterList& parameters, const LightBuildContext& build) {
  const std::string file = parameters.GetFile("shaping:ies:file");
  const double scale = parameters.GetFloat("shaping:ies:angleScale", 0);
  const bool normalize = parameters.GetBool("shaping:ies:normalize", false);
  if (file.empty()) {
    for (const char* name : {"shaping:ies:angleScale", "shaping:ies:normalize"}) {
      if (parameters.Find(name)) Warn(parameters, build, name, "has no effect without \"shaping:ies:file\"");
    }
    return nullptr;
  }
  if (scale != 0 && !(std::abs(scale) >= 1e-6 && std::abs(scale) <= 1e6)) {
    throw Error(parameters.WhereOf("shaping:ies:angleScale"),
                parameters.Owner() + ": \"shaping:ies:angleScale\" has to be 0 or between 1e-6 and 1e6 in magnitude");
  }
  const std::shared_ptr<const IesProfile> profile = ReadIes(file, parameters.WhereOf("shaping:ies:file"));
  if (!(profile->Power() > 0)) Warn(parameters, build, "shaping:ies:file", "is dark in all directions");
  return std::make_unique<ShapedProfile>(*profile, scale, normalize);
}

// Cosine of theta, rounded down, so that the bound holds in float.
float CosineBelow(double theta) {
  return theta < kPiExact ? std::max(std::nextafter(static_cast<float>(std::cos(theta)), -2.0f), -1.0f) : -1.0f;
}

}  // namespace

std::shared_ptr<const Shaping> Shaping::Read(const ParameterList& parameters, const LightBuildContext& build,
                                             Emitter emitter) {
  const ConeSetting cone = ReadCone(parameters, build);
  const FocusSetting focus = ReadFocus(parameters, build);
  std::unique_ptr<const ShapedProfile> profile = ReadProfile(parameters, build);
  if (!cone.inForce && !focus.inForce && !profile) return nullptr;
  const auto factor = std::make_shared<const ShapedFactor>(cone, focus, std::move(profile));
  return std::shared_ptr<const Shaping>(new Shaping(factor, emitter));
}

Shaping::Shaping(std::shared_ptr<const ShapedFactor> factor, Emitter emitter)
    : factor_(std::move(factor)),
      table_(std::make_shared<const ShapedTable>(*factor_, emitter == Emitter::Flat)),
      emitter_(emitter),
      largest_(factor_->Largest()),
      cosWidest_(CosineBelow(table_->WidestTheta())),
      guidesEmission_(emitter != Emitter::Round || table_->EffectiveMeasure() <= 2 * kPiExact),
      integral_(table_->Integrate(*factor_, nullptr)) {
  // The mean of max(0, cosθ) over all normals is 1/4 for any direction.
  if (emitter == Emitter::Round) integral_ *= 0.25f;
}

Color Shaping::Factor(const Vector3& local) const {
  return factor_->At(AxisAngle::Of(Vector3d(local)), [&local] { return TurnsOf(local); });
}

Vector3 Shaping::SampleDirection(const Point2& u) const {
  return table_->IsDark() ? Vector3(0, 0, -1) : table_->Sample(u);
}

PdfSolidAngle Shaping::Density(const Vector3& local) const {
  return PdfSolidAngle(table_->Density(local));
}

Color Shaping::Integral(const std::function<double(const Vector3d&)>& weight) const {
  return table_->Integrate(*factor_, &weight);
}

std::vector<ParameterInfo> IesParameters() {
  return {
      {"shaping:ies:file", ParameterType::String, "", "\"\"", "", "an IES (LM-63) file: candela over directions"},
      {"shaping:ies:angleScale", ParameterType::Float, "", "0", "",
       "stretches the profile's angles from -z (> 0) or from +z (< 0); 0: as they are"},
      {"shaping:ies:normalize", ParameterType::Bool, "", "false", "",
       "divide the profile by its mean over all directions, which keeps the light's power"},
  };
}

std::vector<ParameterInfo> ShapingParameters() {
  std::vector<ParameterInfo> rows = {
      {"shaping:cone:angle", ParameterType::Float, "°", "90", "(0,180]", "no light at more than this angle from -z"},
      {"shaping:cone:softness", ParameterType::Float, "", "0", "", "part of that angle with a soft edge, 0 to 1"},
      {"shaping:focus", ParameterType::Float, "", "0", "", "the light falls off by |cos|^focus of the angle from -z"},
      {"shaping:focusTint", ParameterType::Rgb, "", "0 0 0", "", "what it falls off to"},
  };
  const std::vector<ParameterInfo> ies = IesParameters();
  rows.insert(rows.end(), ies.begin(), ies.end());
  return rows;
}

}  // namespace lampyr
