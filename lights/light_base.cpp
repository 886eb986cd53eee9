#include "lights/light_base.h"

#include <algorithm>
#include <cmath>

#include "lights/light_groups.h"
#include "scene/spectrum.h"

namespace lampyr {

LightBase::LightBase(LightTypeFunction type, const ParameterList& parameters)
    : made_(new const Made{type, parameters, ReadLightSettings(parameters)}) {}

std::unique_ptr<Light> LightBase::Edit(const ParameterList& changes, const LightBuildContext& build) const {
  return MakeLight(made_->type(), MergeParameters(made_->parameters, changes), build);
}

std::vector<ParameterInfo> WithCommonParameters(std::vector<ParameterInfo> parameters) {
  const ParameterInfo common[] = {
      {"intensity", ParameterType::Float, "", "1", ">= 0", "multiplies the light"},
      {"exposure", ParameterType::Float, "stops", "0", "", "multiplies the light by 2^exposure"},
      {"color", ParameterType::Rgb, "", "1 1 1", "", "multiplies the light"},
      {"enableColorTemperature", ParameterType::Bool, "", "false", "", "multiply by a black body's colour as well"},
      {"colorTemperature", ParameterType::Float, "K", "6500", "[1000,40000]",
       "of that black body, brought to luminance 1"},
      {"normalize", ParameterType::Bool, "", "false", "",
       "keep the power when the size changes: divide by the area, or by a distant light's projected solid angle "
       "(points have no size)"},
      {"diffuse", ParameterType::Float, "", "1", ">= 0", "multiplies what diffuse lobes receive"},
      {"specular", ParameterType::Float, "", "1", ">= 0", "multiplies what specular lobes receive"},
      {"name", ParameterType::String, "", "\"\"", "", "what messages and statistics call this light"},
      {"lightGroup", ParameterType::String, "", "\"\"", "",
       "the layer of the image that this light is summed up in as well"},
      {"cameraVisible", ParameterType::Bool, "", "true", "", "whether the camera sees the light itself"},
      {"traceLightPaths", ParameterType::Bool, "", "true", "", "whether the light may emit photons"},
      {"importanceMultiplier", ParameterType::Float, "", "1", "> 0", "scales the light's chance of being selected"},
      {"fixedSampleCount", ParameterType::Integer, "", "0", ">= 0",
       "samples of this light at each point that is lit; 0: as light selection decides"},
  };
  for (const ParameterInfo& row : common) {
    parameters.push_back(row);
    parameters.back().isCommon = true;
  }
  return parameters;
}

namespace {

// The parameters that are colours of light in one type or another; no type has both "L" and "I".
std::vector<LightSpectrum> SpectraOf(const ParameterList& parameters) {
  std::vector<LightSpectrum> spectra;
  for (const char* name : {"L", "I", "color"}) {
    const Parameter* given = parameters.Find(name);
    if (!given || (given->type != ParameterType::Spectrum && given->type != ParameterType::Blackbody)) continue;
    if (auto curve = parameters.FindCurve(name, SpectrumRole::Illuminant))
      spectra.push_back({std::move(curve), parameters.GetColor(name, Color(1.0f), SpectrumRole::Illuminant)});
  }
  if (parameters.GetBool("enableColorTemperature", false)) {
    const double kelvin = parameters.GetFloat("colorTemperature", 6500);
    spectra.push_back({std::make_shared<const SpectralCurve>(BlackbodyCurve(kelvin, SpectrumRole::Illuminant)),
                       BlackbodyToColor(kelvin, SpectrumRole::Illuminant)});
  }
  return spectra;
}

}  // namespace

LightSettings ReadLightSettings(const ParameterList& parameters) {
  LightSettings settings;
  settings.name = parameters.GetString("name", "");
  settings.lightGroup = parameters.GetString("lightGroup", "");
  if (!settings.lightGroup.empty()) {
    try {
      LayerOfLightGroup(settings.lightGroup);
    } catch (const Error& e) {
      throw Error(parameters.WhereOf("lightGroup"), e.Text());
    }
  }
  settings.cameraVisible = parameters.GetBool("cameraVisible", true);
  settings.traceLightPaths = parameters.GetBool("traceLightPaths", true);
  settings.spectra = SpectraOf(parameters);
  settings.importanceMultiplier = static_cast<float>(parameters.GetFloat("importanceMultiplier", 1));
  settings.fixedSampleCount = parameters.GetInteger("fixedSampleCount", 0);
  return settings;
}

LightTint ReadLightTint(const ParameterList& parameters) {
  LightTint tint;
  const double strength = parameters.GetFloat("intensity", 1) * std::exp2(parameters.GetFloat("exposure", 0));
  tint.color = ReadEmissionColor(parameters, "color") * static_cast<float>(strength);
  if (parameters.GetBool("enableColorTemperature", false)) {
    // At luminance 1; a deep red has a blue channel below 0 in Rec. 709.
    const Color body = BlackbodyToColor(parameters.GetFloat("colorTemperature", 6500), SpectrumRole::Illuminant);
    tint.color *= Color(std::max(body.r, 0.0f), std::max(body.g, 0.0f), std::max(body.b, 0.0f));
  }
  if (!tint.color.IsValid()) {
    throw Error(parameters.WhereOf("intensity"),
                parameters.Owner() + ": intensity and exposure leave the range of numbers");
  }
  tint.diffuse = static_cast<float>(parameters.GetFloat("diffuse", 1));
  tint.specular = static_cast<float>(parameters.GetFloat("specular", 1));
  tint.normalize = parameters.GetBool("normalize", false);
  return tint;
}

ParameterList MergeParameters(const ParameterList& base, const ParameterList& changes) {
  std::vector<Parameter> merged = base.All();
  for (const Parameter& change : changes.All()) {
    const auto same =
        std::find_if(merged.begin(), merged.end(), [&](const Parameter& p) { return p.name == change.name; });
    if (same != merged.end()) {
      *same = change;
    } else {
      merged.push_back(change);
    }
  }
  ParameterList list(base.Where(), base.Owner(), std::move(merged));
  list.SetColorSpace(base.ColorSpace());
  return list;
}

Color ReadEmissionColor(const ParameterList& parameters, const std::string& name, const Color& defaultValue) {
  const bool isOfSpace = name == "L" || name == "I";
  const Color color =
      parameters.GetColor(name, isOfSpace ? parameters.White() : defaultValue, SpectrumRole::Illuminant);
  if (!color.IsValid()) {
    throw Error(parameters.WhereOf(name), parameters.Owner() + ": \"" + name + "\" must not be negative or infinite");
  }
  return color;
}

}  // namespace lampyr
