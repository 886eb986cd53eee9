// Measured scattering of liquids, powders and solids, by the names of pbrt-v4.
#pragma once

#include <string>
#include <vector>

#include "math/vec.h"

namespace lampyr {

struct MeasuredScattering {
  const char* name;
  Color scattering, absorption;  // σ_s' (reduced: equivalent isotropic scattering) and σ_a; 1/mm
};

// Null if there is no preset of that name.
const MeasuredScattering* FindScatteringPreset(const std::string& name);
std::vector<std::string> ScatteringPresetNames();

}  // namespace lampyr
