// The factories behind MakeMedia, one per type, and the parameters that types share. Internal to media/.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "base/memory.h"
#include "media/blackbody_table.h"
#include "media/medium.h"
#include "scene/scene_description.h"

namespace lampyr {

// Input of a factory.
struct MediumInput {
  const MediumDescription& description;
  const Transform& renderFromMedium;  // affine and invertible
  MemoryBudget& memory;
  Diagnostics& diagnostics;

  const ParameterList& Parameters() const { return description.medium.parameters; }
};

std::shared_ptr<const Medium> MakeHomogeneous(const MediumInput& input);
std::shared_ptr<const Medium> MakeUniformGrid(const MediumInput& input);
std::shared_ptr<const Medium> MakeRgbGrid(const MediumInput& input);
std::shared_ptr<const Medium> MakeCloud(const MediumInput& input);
std::shared_ptr<const Medium> MakeNanoVdb(const MediumInput& input);

// A number that must not be negative.
float GetNonNegative(const ParameterList& parameters, const std::string& name, double defaultValue);

// "g", in (-1,1), default 0.
float GetAsymmetry(const ParameterList& parameters);

struct ScatteringParameters {
  Color absorption{1.0f}, scattering{1.0f};  // σ_a, σ_s, both 1 by default as in pbrt-v4
  float asymmetry = 0;

  Color Extinction() const { return absorption + scattering; }
};

// "sigma_a", "sigma_s" and "g"; "preset" and "scale" if the type has them.
ScatteringParameters GetScattering(const ParameterList& parameters, bool hasPreset, bool hasScale);

// "temperaturescale", and "temperatureoffset" or by its older name "temperaturecutoff".
TemperatureScale GetTemperatureScale(const ParameterList& parameters);

// Throws an Error at `where` if the temperature exceeds kHottestGas.
void CheckTemperature(float kelvin, const FileLocation& where);

// "Le", black by default.
Color GetEmittedRadiance(const ParameterList& parameters);

// The box between "p0" and "p1", (0,0,0) and (1,1,1) by default.
Bounds3d GetBox(const ParameterList& parameters);

// Throws an Error at `where` if a component of `color` has left the range of floats.
void CheckRange(const Color& color, const char* what, const FileLocation& where);

// The inverse of `renderFromSpace` in float. Throws an Error at the statement if that leaves the range of floats.
Affine MakeToSpace(const Transform& renderFromSpace, const MediumInput& input);

}  // namespace lampyr
