// A type of light: its name, its parameter table and its factory. The registry is a table of these.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "geometry/shapes.h"
#include "lights/light.h"
#include "scene/parameters.h"

namespace lampyr {

class TextureLibrary;
class AlphaSource;

// One row of a light's parameter table: what the parser checks against, error messages quote and `lampyr lights`
// prints.
struct ParameterInfo {
  std::string name;
  ParameterType type;
  std::string unit;          // "W/sr", "m", "°", "" for none
  std::string defaultValue;  // as a scene file would write it
  std::string range;         // "> 0", "[0,1]", "" for any
  std::string help;          // one line
};

// Everything besides its parameters that a light is made from.
struct LightBuildContext {
  LightTransform transform;      // at shutter open
  Transform placement;           // the same in double, local to render space
  Transform worldToRender;       // for points that pbrt gives in the light's space it is part of `placement`
  const Shape* shape = nullptr;  // area lights: the shape that emits, in render space
  // Area lights: from the shape's own axes to those of the space that its points are given in. Shaping is about them.
  Transform shapePlacement;
  const TextureLibrary* textures = nullptr;  // images; null in tests that use none
  std::shared_ptr<const AlphaSource> alpha;  // cut-outs of the shape
  Diagnostics* diagnostics = nullptr;
};

struct LightType {
  std::string name;          // as in LightSource "name" or AreaLightSource "name"
  bool isAreaLight = false;  // made by AreaLightSource from a shape
  std::string help;          // one line
  std::vector<ParameterInfo> parameters;
  std::function<std::unique_ptr<Light>(const ParameterList&, const LightBuildContext&)> create;
  // Parameter blocks in scene syntax for the suites: each is one variant of the light that has to pass.
  std::vector<std::string> samples;
};

// All built-in types, one row each.
const std::vector<LightType>& LightRegistry();

// The type, or null.
const LightType* FindLightType(const std::string& name, bool isAreaLight);

// Throws a located Error for a parameter whose name (with the nearest known one), type or range is not in the type's
// table. Marks all parameters as used.
void CheckParameters(const LightType& type, const ParameterList& parameters);

// Checks `parameters` against the type's table (unknown names, wrong types, values out of range: a located Error with
// the nearest known name) and makes the light.
std::unique_ptr<Light> MakeLight(const LightType& type, const ParameterList& parameters,
                                 const LightBuildContext& build);

}  // namespace lampyr
