// All built-in filters. A filter is its own file, which defines `FilterType …FilterType()`, and one row here.
#include "lights/filters/filter_type.h"

namespace lampyr {

const std::vector<FilterType>& FilterRegistry() {
  static const std::vector<FilterType> registry = [] {
    std::vector<FilterType> types;
    // clang-format off
    extern FilterType BarnFilterType();      types.push_back(BarnFilterType());
    extern FilterType BlockerFilterType();   types.push_back(BlockerFilterType());
    extern FilterType CombinerFilterType();  types.push_back(CombinerFilterType());
    extern FilterType CookieFilterType();    types.push_back(CookieFilterType());
    extern FilterType GoboFilterType();      types.push_back(GoboFilterType());
    extern FilterType IntMultFilterType();   types.push_back(IntMultFilterType());
    extern FilterType RampFilterType();      types.push_back(RampFilterType());
    extern FilterType RodFilterType();       types.push_back(RodFilterType());
    // clang-format on
    return types;
  }();
  return registry;
}

const FilterType* FindFilterType(const std::string& name) {
  for (const FilterType& type : FilterRegistry()) {
    if (type.name == name) return &type;
  }
  return nullptr;
}

std::unique_ptr<LightFilter> MakeFilter(const FilterType& type, const ParameterList& parameters,
                                        const FilterBuildContext& build) {
  CheckParameters(type, "LightFilter", parameters);
  return type.create(parameters, build);
}

}  // namespace lampyr
