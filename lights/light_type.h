// A type of light: its name, its parameter table and its factory. The registry is a table of these.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "geometry/shapes.h"
#include "lights/light.h"
#include "lights/parameter_table.h"

namespace lampyr {

class TextureLibrary;
class AlphaSource;

// Everything besides its parameters that a light is made from.
struct LightBuildContext {
  LightTransform transform;      // at shutter open
  Transform placement;           // the same in double, local to render space
  Transform worldToRender;       // for points that pbrt gives in the light's space it is part of `placement`
  const Shape* shape = nullptr;  // area lights: the shape that emits, in render space
  // Area lights: maps the shape's own axes, about which shaping is defined, to the space in which its points are given.
  Transform shapePlacement;
  const TextureLibrary* textures = nullptr;  // images; null in tests that use none
  std::shared_ptr<const AlphaSource> alpha;  // cut-outs of the shape
  // Area lights: rays do not hit the surface, which still emits; light may pass through it.
  bool letsRaysPass = false;
  Diagnostics* diagnostics = nullptr;
};

struct LightType : TypeDescription {
  bool isAreaLight = false;  // made by AreaLightSource from a shape; LightSource otherwise
  std::function<std::unique_ptr<Light>(const ParameterList&, const LightBuildContext&)> create;

  const char* Statement() const { return isAreaLight ? "AreaLightSource" : "LightSource"; }
};

// All built-in types, one row each.
const std::vector<LightType>& LightRegistry();

// The type, or null.
const LightType* FindLightType(const std::string& name, bool isAreaLight);

// CheckParameters of parameter_table.h.
void CheckParameters(const LightType& type, const ParameterList& parameters);

// Checks `parameters` against the type's table (unknown names, wrong types, values out of range: a located Error with
// the nearest known name) and makes the light.
std::unique_ptr<Light> MakeLight(const LightType& type, const ParameterList& parameters,
                                 const LightBuildContext& build);

}  // namespace lampyr
