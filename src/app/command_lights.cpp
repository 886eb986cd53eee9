#include <cstdio>

#include "app/command_line.h"
#include "app/commands.h"
#include "lights/light_type.h"

namespace lampyr {

namespace {

std::string Statement(const LightType& type) {
  return std::string(type.isAreaLight ? "AreaLightSource" : "LightSource") + " \"" + type.name + "\"";
}

void PrintType(const LightType& type) {
  std::printf("%s\n    %s\n", Statement(type).c_str(), type.help.c_str());
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
  for (const LightType& type : LightRegistry()) {
    names.push_back(type.name);
    if (!name.empty() && type.name != name) continue;
    found = true;
    PrintType(type);
  }
  if (!found) throw UsageError("there is no light \"" + name + "\"" + DidYouMean(name, names));
  return kExitDone;
}

}  // namespace lampyr
