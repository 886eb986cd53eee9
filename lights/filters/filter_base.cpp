#include "lights/filters/filter_base.h"

namespace lampyr {

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

int ReadChoice(const ParameterList& parameters, const std::string& name, const std::vector<std::string>& choices,
               int missing) {
  const std::string given = parameters.GetString(name, choices[static_cast<size_t>(missing)]);
  const auto at = std::find(choices.begin(), choices.end(), given);
  if (at != choices.end()) return static_cast<int>(at - choices.begin());
  std::string all = choices.front();
  for (size_t i = 1; i < choices.size(); ++i) all += (i + 1 < choices.size() ? ", " : " or ") + choices[i];
  throw Error(parameters.WhereOf(name), parameters.Owner() + ": \"" + name + "\" is " + all + ", not \"" + given +
                                            "\"" + DidYouMean(given, choices));
}

CombineMode ReadCombineMode(const ParameterList& parameters, const std::string& name) {
  return static_cast<CombineMode>(ReadChoice(parameters, name, {"multiply", "max", "min", "screen"}));
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
  for (const ParameterInfo& row : common) {
    parameters.push_back(row);
    parameters.back().isCommon = true;
  }
  return parameters;
}

}  // namespace lampyr
