// The parameter table of a type that scenes name: what the parser checks against, error messages quote and `lampyr
// lights` prints.
#pragma once

#include <string>
#include <vector>

#include "scene/parameters.h"

namespace lampyr {

// One row.
struct ParameterInfo {
  std::string name;
  ParameterType type;
  std::string unit;          // "W/sr", "m", "°", "" for none
  std::string defaultValue;  // as a scene file would write it
  std::string range;         // "> 0", ">= 0", "[0,1]", "(0,180]", "" for any
  std::string help;          // one line
  bool isCommon = false;     // of all lights, or of all light filters
};

// Name, help, parameters and samples of a type that scenes can name.
struct TypeDescription {
  std::string name;
  std::string help;  // one line
  std::vector<ParameterInfo> parameters;
  // Parameter blocks in scene syntax for the suites: each is one variant that has to pass.
  std::vector<std::string> samples;
};

// The first mistake in a table: a range in another notation than those above, or two rows of one name. "": none.
std::string MistakeIn(const TypeDescription& type);

// Throws a located Error for a parameter whose name (with the nearest known one), type or range is not in the table.
// Marks all parameters as used. `statement`: "LightSource", "LightFilter", …
void CheckParameters(const TypeDescription& type, const std::string& statement, const ParameterList& parameters);

}  // namespace lampyr
