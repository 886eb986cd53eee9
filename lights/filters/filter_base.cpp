#include "lights/filters/filter_base.h"

#include <array>

namespace lampyr {

namespace {

constexpr std::array<const char*, 4> kCombineModes = {"multiply", "max", "min", "screen"};

}  // namespace

std::vector<std::string> ReadNames(const ParameterList& parameters, const std::string& name) {
  constexpr const char* space = " \t\n";
  std::vector<std::string> names;
  for (const std::string& list : parameters.GetStrings(name)) {
    for (size_t begin = 0; begin <= list.size();) {
      const size_t end = std::min(list.find(',', begin), list.size());
      const size_t first = list.find_first_not_of(space, begin);
      if (first < end) names.push_back(list.substr(first, list.find_last_not_of(space, end - 1) + 1 - first));
      begin = end + 1;
    }
  }
  return names;
}

CombineMode ReadCombineMode(const ParameterList& parameters, const std::string& name) {
  const std::string mode = parameters.GetString(name, kCombineModes[0]);
  const auto at = std::find(kCombineModes.begin(), kCombineModes.end(), mode);
  if (at == kCombineModes.end()) {
    throw Error(parameters.WhereOf(name), parameters.Owner() + ": \"" + name +
                                              "\" is multiply, max, min or screen, not \"" + mode + "\"" +
                                              DidYouMean(mode, {kCombineModes.begin(), kCombineModes.end()}));
  }
  return static_cast<CombineMode>(at - kCombineModes.begin());
}

FilterSettings ReadFilterSettings(const ParameterList& parameters) {
  FilterSettings settings;
  const double density = parameters.GetFloat("density", 1);
  settings.diffuse = static_cast<float>(density * parameters.GetFloat("diffuse", 1));
  settings.specular = static_cast<float>(density * parameters.GetFloat("specular", 1));
  settings.invert = parameters.GetBool("invert", false);
  settings.linkingGroups = ReadNames(parameters, "linkingGroups");
  return settings;
}

std::vector<ParameterInfo> WithCommonFilterParameters(std::vector<ParameterInfo> parameters) {
  const ParameterInfo common[] = {
      {"combineMode", ParameterType::String, "", "\"multiply\"", "",
       "how a combiner takes it: multiply, max, min or screen"},
      {"density", ParameterType::Float, "", "1", "[0,1]", "how much of the effect is applied; 0: none"},
      {"invert", ParameterType::Bool, "", "false", "", "1 less the factor"},
      {"diffuse", ParameterType::Float, "", "1", "[0,1]", "how much of the effect diffuse lobes see"},
      {"specular", ParameterType::Float, "", "1", "[0,1]", "how much of the effect specular lobes see"},
      {"linkingGroups", ParameterType::String, "", "\"\"", "",
       "groups, separated by commas: only what subscribes to one of them by Attribute \"lightfilter\" is filtered"},
      {"coordsys", ParameterType::String, "", "\"\"", "",
       "a named coordinate system to be placed in; otherwise the current one"},
      {"name", ParameterType::String, "", "\"\"", "", "what combiners call this filter"},
  };
  parameters.insert(parameters.end(), std::begin(common), std::end(common));
  return parameters;
}

}  // namespace lampyr
