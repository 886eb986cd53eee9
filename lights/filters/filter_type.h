// A type of light filter: its name, its parameter table and its factory. The registry is a table of these.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "lights/filters/light_filter.h"
#include "lights/light.h"
#include "lights/parameter_table.h"
#include "math/motion.h"

namespace lampyr {

class TextureLibrary;

// Arguments of a filter's factory besides its parameters.
struct FilterBuildContext {
  LightTransform transform;                  // the filter's own space, at shutter open
  std::shared_ptr<const Motion> motion;      // null: static
  const TextureLibrary* textures = nullptr;  // images; null in tests that use none
  // A filter with a name defined before, for combiners. Throws an Error at `where` that suggests the nearest name.
  std::function<FilterInstance(const std::string& name, const FileLocation& where)> find;
  Diagnostics* diagnostics = nullptr;
};

struct FilterType : TypeDescription {
  std::function<std::unique_ptr<LightFilter>(const ParameterList&, const FilterBuildContext&)> create;
};

// All built-in types, one row each.
const std::vector<FilterType>& FilterRegistry();

// The type, or null.
const FilterType* FindFilterType(const std::string& name);

// Checks `parameters` against the type's table and makes the filter. Throws located Errors.
std::unique_ptr<LightFilter> MakeFilter(const FilterType& type, const ParameterList& parameters,
                                        const FilterBuildContext& build);

}  // namespace lampyr
