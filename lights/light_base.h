// What all lights share besides their physics: the settings every light has, and editing. A light keeps the parameters
// it was made from; an edited light is made anew from those and the changes, so no table can be stale.
#pragma once

#include <memory>
#include <vector>

#include "lights/light.h"
#include "lights/light_memory.h"
#include "lights/light_type.h"

namespace lampyr {

// The function that describes a type: name, parameter table, factory.
using LightTypeFunction = LightType (*)();

// What the parameters of UsdLux's LightAPI make of a light, whatever its type: they multiply its own radiance,
// intensity or irradiance.
struct LightTint {
  Color color{1.0f};                // intensity · 2^exposure · color · blackbody(colorTemperature)
  float diffuse = 1, specular = 1;  // of what diffuse and specular lobes receive; a camera sees the light without them
  bool normalize = false;           // divide by the world-space area (areas) or by the projected solid angle (distant)

  // Sets both parts of a sample, an evaluation or a photon from what the light emits; false when both are black.
  template <class Sample>
  bool Split(const Color& emitted, Sample& sample) const {
    sample.diffuse = emitted * diffuse;
    sample.specular = emitted * specular;
    return !sample.diffuse.IsBlack() || !sample.specular.IsBlack();
  }
};

// Reads intensity, exposure, color, enableColorTemperature, colorTemperature, diffuse, specular, normalize.
LightTint ReadLightTint(const ParameterList& parameters);

class LightBase : public Light {
 public:
  LightBase(LightTypeFunction type, const ParameterList& parameters);

  static void* operator new(size_t bytes) { return TakeLightMemory(bytes); }
  static void operator delete(void* light, size_t bytes) noexcept { ReturnLightMemory(light, bytes); }

  const LightSettings& Settings() const final { return made_->settings; }
  std::unique_ptr<Light> Edit(const ParameterList& changes, const LightBuildContext& build) const final;

 private:
  // Hardly ever read while rendering: kept apart, so that a light itself is small.
  struct Made {
    LightTypeFunction type;
    ParameterList parameters;
    LightSettings settings;
  };
  std::unique_ptr<const Made> made_;
};

// The rows that every light's parameter table ends with: name, lightGroup, cameraVisible, …
std::vector<ParameterInfo> WithCommonParameters(std::vector<ParameterInfo> parameters);
LightSettings ReadLightSettings(const ParameterList& parameters);

// `base` with the parameters of `changes` in place of those of the same name, or added.
ParameterList MergeParameters(const ParameterList& base, const ParameterList& changes);

// A colour of light; an Error where a channel is negative.
Color ReadEmissionColor(const ParameterList& parameters, const std::string& name,
                        const Color& defaultValue = Color(1.0f));

}  // namespace lampyr
