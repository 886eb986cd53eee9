#include <cstdio>

#include "app/command_line.h"
#include "app/commands.h"
#include "render/build/plugins.h"

namespace lampyr {

namespace {

// `plugin`: that it is from; null for built-in types.
void PrintType(const char* statement, const TypeDescription& type, const Plugin* plugin) {
  std::printf("%s \"%s\"\n    %s\n", statement, type.name.c_str(), type.help.c_str());
  if (plugin) std::printf("    from the plugin \"%s\"\n", plugin->file.c_str());
  for (const ParameterInfo& parameter : type.parameters) {
    const std::string name = std::string(ToString(parameter.type)) + " " + parameter.name;
    const std::string value = parameter.defaultValue + (parameter.unit.empty() ? "" : " " + parameter.unit);
    std::printf("    %-32s %-14s %-10s %s\n", name.c_str(), value.c_str(), parameter.range.c_str(),
                parameter.help.c_str());
  }
  std::printf("\n");
}

}  // namespace

int RunLights(const LightsOptions& options) {
  const TypeRegistry types = LoadTypes(options.plugins, nullptr);
  const std::string& name = options.type;
  bool found = false;
  std::vector<std::string> names;
  const auto print = [&](const char* statement, const TypeDescription& type, const Plugin* plugin) {
    names.push_back(type.name);
    if (!name.empty() && type.name != name) return;
    found = true;
    PrintType(statement, type, plugin);
  };
  const auto printAll = [&](const auto& lights, const auto& filters, const Plugin* plugin) {
    for (const LightType& type : lights) print(type.Statement(), type, plugin);
    for (const FilterType& type : filters) print("LightFilter", type, plugin);
  };
  printAll(LightRegistry(), FilterRegistry(), nullptr);
  for (const Plugin& plugin : types.Plugins()) printAll(plugin.lights, plugin.filters, &plugin);
  if (!found) throw UsageError("there is no light or filter \"" + name + "\"" + DidYouMean(name, names));
  return kExitDone;
}

}  // namespace lampyr
