#include "lights/light_base.h"

#include <algorithm>

namespace lampyr {

LightBase::LightBase(LightTypeFunction type, const ParameterList& parameters)
    : type_(type), parameters_(parameters), settings_(ReadLightSettings(parameters)) {}

std::unique_ptr<Light> LightBase::Edit(const ParameterList& changes, const LightBuildContext& build) const {
  return MakeLight(type_(), MergeParameters(parameters_, changes), build);
}

std::vector<ParameterInfo> WithCommonParameters(std::vector<ParameterInfo> parameters) {
  const ParameterInfo common[] = {
      {"name", ParameterType::String, "", "\"\"", "", "what messages and statistics call this light"},
      {"lightGroup", ParameterType::String, "", "\"\"", "", "the light group this light is summed up in"},
      {"cameraVisible", ParameterType::Bool, "", "true", "", "whether the camera sees the light itself"},
      {"traceLightPaths", ParameterType::Bool, "", "true", "", "whether the light may emit photons"},
      {"importanceMultiplier", ParameterType::Float, "", "1", "> 0", "scales the light's chance of being selected"},
      {"fixedSampleCount", ParameterType::Integer, "", "0", ">= 0",
       "samples per shading point; 0: as the integrator does"},
  };
  parameters.insert(parameters.end(), std::begin(common), std::end(common));
  return parameters;
}

LightSettings ReadLightSettings(const ParameterList& parameters) {
  LightSettings settings;
  settings.name = parameters.GetString("name", "");
  settings.lightGroup = parameters.GetString("lightGroup", "");
  settings.cameraVisible = parameters.GetBool("cameraVisible", true);
  settings.traceLightPaths = parameters.GetBool("traceLightPaths", true);
  settings.importanceMultiplier = static_cast<float>(parameters.GetFloat("importanceMultiplier", 1));
  settings.fixedSampleCount = parameters.GetInteger("fixedSampleCount", 0);
  return settings;
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
  return {base.Where(), base.Owner(), std::move(merged)};
}

Color ReadEmissionColor(const ParameterList& parameters, const std::string& name) {
  const Color color = parameters.GetColor(name, Color(1.0f), SpectrumRole::Illuminant);
  if (!color.IsValid()) {
    throw Error(parameters.WhereOf(name), parameters.Owner() + ": \"" + name + "\" must not be negative or infinite");
  }
  return color;
}

}  // namespace lampyr
