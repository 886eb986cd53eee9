// A statement's parameters against a type's table: names, types and ranges.
#pragma once

#include "lights/light_type.h"

namespace lampyr {

// Throws a located Error for an unknown name (with the nearest known one), a wrong type or a value out of range. Marks
// all parameters as used.
void CheckParameters(const LightType& type, const ParameterList& parameters);

}  // namespace lampyr
