#include <cstdio>

#include "app/command_line.h"
#include "app/commands.h"
#include "lights/filters/filter_type.h"
#include "lights/light_type.h"

namespace lampyr {

namespace {

void PrintType(const char* statement, const TypeDescription& type) {
  std::printf("%s \"%s\"\n    %s\n", statement, type.name.c_str(), type.help.c_str());
  for (const ParameterInfo& parameter : type.parameters) {
    const std::string name = std::string(ToString(parameter.type)) + " " + parameter.name;
    const std::string value = parameter.defaultValue + (parameter.unit.empty() ? "" : " " + parameter.unit);
    std::printf("    %-32s %-14s %-10s %s\n", name.c_str(), value.c_str(), parameter.range.c_str(),
                parameter.help.c_str());
  }
  std::printf("\n");
}

}  // namespace

int RunLights(const std::string& name) {
  bool found = false;
  std::vector<std::string> names;
  const auto print = [&](const char* statement, const TypeDescription& type) {
    names.push_back(type.name);
    if (!name.empty() && type.name != name) return;
    found = true;
    PrintType(statement, type);
  };
  for (const LightType& type : LightRegistry()) print(type.Statement(), type);
  for (const FilterType& type : FilterRegistry()) print("LightFilter", type);
  if (!found) throw UsageError("there is no light or filter \"" + name + "\"" + DidYouMean(name, names));
  return kExitDone;
}

}  // namespace lampyr
