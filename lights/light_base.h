// What all lights share besides their physics: the settings every light has, and editing. A light keeps the parameters
// it was made from; an edited light is made anew from those and the changes, so no table can be stale.
#pragma once

#include <memory>
#include <vector>

#include "lights/light.h"
#include "lights/light_type.h"

namespace lampyr {

// The function that describes a type: name, parameter table, factory.
using LightTypeFunction = LightType (*)();

class LightBase : public Light {
 public:
  LightBase(LightTypeFunction type, const ParameterList& parameters);

  const LightSettings& Settings() const final { return settings_; }
  std::unique_ptr<Light> Edit(const ParameterList& changes, const LightBuildContext& build) const final;

 private:
  LightTypeFunction type_;
  ParameterList parameters_;
  LightSettings settings_;
};

// The rows that every light's parameter table ends with: name, lightGroup, cameraVisible, …
std::vector<ParameterInfo> WithCommonParameters(std::vector<ParameterInfo> parameters);
LightSettings ReadLightSettings(const ParameterList& parameters);

// `base` with the parameters of `changes` in place of those of the same name, or added.
ParameterList MergeParameters(const ParameterList& base, const ParameterList& changes);

// A colour of light, scaled; an Error where a channel is negative.
Color ReadEmissionColor(const ParameterList& parameters, const std::string& name);

}  // namespace lampyr
