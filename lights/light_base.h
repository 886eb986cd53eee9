// Base of lights: common settings and editing. A light keeps its parameters; an edited light is created from these and
// the changes, so that no table is stale.
#pragma once

#include <memory>
#include <vector>

#include "lights/light.h"
#include "lights/light_memory.h"
#include "lights/light_type.h"

namespace lampyr {

// The function that describes a type: name, parameter table, factory.
using LightTypeFunction = LightType (*)();

// The multipliers of UsdLux's LightAPI, which apply to the radiance, intensity or irradiance of every type.
struct LightTint {
  Color color{1.0f};                // intensity · 2^exposure · color · blackbody(colorTemperature)
  float diffuse = 1, specular = 1;  // multipliers for diffuse and specular lobes; not for what the camera sees
  bool normalize = false;           // divide by the world-space area (areas) or by the projected solid angle (distant)

  // Sets both parts of a sample, evaluation or photon from the emission. False: both are black.
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
  // Rarely read while rendering; a separate allocation keeps the light small.
  struct Made {
    LightTypeFunction type;
    ParameterList parameters;
    LightSettings settings;
  };
  std::unique_ptr<const Made> made_;
};

// Common last rows of every light's parameter table: name, lightGroup, cameraVisible, …
std::vector<ParameterInfo> WithCommonParameters(std::vector<ParameterInfo> parameters);
LightSettings ReadLightSettings(const ParameterList& parameters);

// `base` with parameters replaced by those of the same name in `changes`, or added.
ParameterList MergeParameters(const ParameterList& base, const ParameterList& changes);

// A colour of light. "L" and "I" are the white of the statement's colour space by default. Throws an Error if a channel
// is negative.
Color ReadEmissionColor(const ParameterList& parameters, const std::string& name,
                        const Color& defaultValue = Color(1.0f));

}  // namespace lampyr
