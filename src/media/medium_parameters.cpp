// Parameters that types of media share.
#include <cmath>

#include "media/medium_makers.h"
#include "media/presets.h"

namespace lampyr {

float GetNonNegative(const ParameterList& parameters, const std::string& name, double defaultValue) {
  const double value = parameters.GetFloat(name, defaultValue);
  if (value < 0) throw Error(parameters.WhereOf(name), "\"" + name + "\" must not be negative");
  return static_cast<float>(value);  // in range: numbers of a scene file are floats
}

float GetAsymmetry(const ParameterList& parameters) {
  const auto g = static_cast<float>(parameters.GetFloat("g", 0));
  if (!(std::abs(g) < 1)) throw Error(parameters.WhereOf("g"), "\"g\" must be between -1 and 1, and neither of them");
  return g;
}

void CheckRange(const Color& color, const char* what, const FileLocation& where) {
  if (!color.IsValid()) throw Error(where, std::string(what) + " leaves the range of floats");
}

ScatteringParameters GetScattering(const ParameterList& parameters, bool hasPreset, bool hasScale) {
  ScatteringParameters result;
  const std::string preset = hasPreset ? parameters.GetString("preset", "") : "";
  if (!preset.empty()) {
    const MeasuredScattering* measured = FindScatteringPreset(preset);
    if (!measured) {
      throw Error(parameters.WhereOf("preset"),
                  "there is no preset \"" + preset + "\" of scattering" + DidYouMean(preset, ScatteringPresetNames()));
    }
    result.absorption = measured->absorption;
    result.scattering = measured->scattering;
  } else {
    result.absorption = parameters.GetColor("sigma_a", result.absorption, SpectrumRole::Extinction);
    result.scattering = parameters.GetColor("sigma_s", result.scattering, SpectrumRole::Extinction);
  }
  if (hasScale) {
    const float scale = GetNonNegative(parameters, "scale", 1);
    result.absorption *= scale;
    result.scattering *= scale;
  }
  CheckRange(result.Extinction(), "the extinction of this medium", parameters.Where());
  result.asymmetry = GetAsymmetry(parameters);
  return result;
}

TemperatureScale GetTemperatureScale(const ParameterList& parameters) {
  const double older = parameters.GetFloat("temperaturecutoff", 0);
  return {static_cast<float>(parameters.GetFloat("temperatureoffset", older)),
          GetNonNegative(parameters, "temperaturescale", 1)};
}

void CheckTemperature(float kelvin, const FileLocation& where) {
  if (kelvin <= kHottestGas) return;
  throw Error(where,
              "the temperatures of this medium reach more than 1e6 K: give them in kelvin, or a "
              "\"temperaturescale\"");
}

Bounds3d GetBox(const ParameterList& parameters) {
  Bounds3d box;
  box.Add(parameters.GetPoint3("p0", Point3d(0.0)));
  box.Add(parameters.GetPoint3("p1", Point3d(1.0)));
  for (int axis = 0; axis < 3; ++axis) {
    if (static_cast<float>(box.min[axis]) == static_cast<float>(box.max[axis])) {
      throw Error(parameters.WhereOf("p1"),
                  std::string("\"p0\" and \"p1\" have the same ") + "xyz"[axis] + ": the box of this medium is empty");
    }
  }
  return box;
}

Color GetEmittedRadiance(const ParameterList& parameters) {
  const Color radiance = parameters.GetColor("Le", Color(0.0f), SpectrumRole::Illuminant);
  CheckRange(radiance, "\"Le\"", parameters.WhereOf("Le"));
  return radiance;
}

Affine MakeToSpace(const Transform& renderFromSpace, const MediumInput& input) {
  const Affine toSpace = renderFromSpace.Inverse().ToAffine();
  for (int column = 0; column < 3; ++column) {
    if (!IsFinite(toSpace.linear[column]) || !IsFinite(toSpace.translation)) {
      throw Error(input.description.medium.where, "the transform of this medium leaves the range of floats");
    }
  }
  return toSpace;
}

}  // namespace lampyr
