#include <unistd.h>

#include <algorithm>
#include <cstdio>

#include "app/command_line.h"
#include "app/commands.h"
#include "base/terminal.h"
#include "render/build/plugins.h"

namespace lampyr {

namespace {

using Rows = std::vector<ParameterInfo>;

std::string Padded(std::string text, int columns) {
  text.append(static_cast<size_t>(std::max(columns - ColumnsOf(text), 0)), ' ');
  return text + " ";
}

// Prints a parameter: a table row if the terminal is wide enough, otherwise with the help below it.
void PrintParameter(const ParameterInfo& parameter, int columns) {
  constexpr int kWideEnough = 100, kName = 30, kValue = 14, kRange = 12;
  const std::string name = "  " + std::string(ToString(parameter.type)) + " " + parameter.name;
  const std::string value = parameter.defaultValue + (parameter.unit.empty() ? "" : " " + parameter.unit);
  if (columns >= kWideEnough) {
    const std::string row = Padded(name, kName) + Padded(value, kValue) + Padded(parameter.range, kRange);
    std::printf("%s", Indented(row, parameter.help, columns).c_str());
    return;
  }
  std::string facts = value.empty() ? "" : "= " + value;
  if (!parameter.range.empty()) facts += (facts.empty() ? "" : ", ") + parameter.range;
  std::printf("%s", Indented(name + "  ", facts, columns).c_str());
  std::printf("%s", Indented("      ", parameter.help, columns).c_str());
}

void PrintParameters(const Rows& rows, bool areCommon, int columns) {
  for (const ParameterInfo& row : rows) {
    if (row.isCommon == areCommon) PrintParameter(row, columns);
  }
}

// Prints a type and its own parameters. `plugin`: the plugin that defines it; null for built-in types.
void PrintType(const char* statement, const TypeDescription& type, const Plugin* plugin, int columns) {
  std::printf("%s \"%s\"\n%s", statement, type.name.c_str(), Indented("  ", type.help, columns).c_str());
  if (plugin) std::printf("  from the plugin \"%s\"\n", plugin->file.c_str());
  PrintParameters(type.parameters, false, columns);
}

// The parameters that are common to a list of types, each once, from the first type that has it.
Rows CommonRows(const std::vector<const TypeDescription*>& types) {
  Rows common;
  for (const TypeDescription* type : types) {
    for (const ParameterInfo& row : type->parameters) {
      const bool isNew = std::none_of(common.begin(), common.end(),
                                      [&](const ParameterInfo& other) { return other.name == row.name; });
      if (row.isCommon && isNew) common.push_back(row);
    }
  }
  return common;
}

// A type, the statement that names it and the plugin that defines it.
struct Entry {
  std::string statement;
  const TypeDescription* type;
  const Plugin* plugin;
  bool isFilter;
};

std::vector<Entry> AllEntries(const TypeRegistry& types) {
  std::vector<Entry> entries;
  const auto add = [&](const auto& lights, const auto& filters, const Plugin* plugin) {
    for (const LightType& type : lights) entries.push_back({type.Statement(), &type, plugin, false});
    for (const FilterType& type : filters) entries.push_back({"LightFilter", &type, plugin, true});
  };
  add(LightRegistry(), FilterRegistry(), nullptr);
  for (const Plugin& plugin : types.Plugins()) add(plugin.lights, plugin.filters, &plugin);
  return entries;
}

void PrintCommon(const std::vector<Entry>& entries, bool ofFilters, int columns) {
  std::vector<const TypeDescription*> types;
  for (const Entry& entry : entries) {
    if (entry.isFilter == ofFilters) types.push_back(entry.type);
  }
  const Rows common = CommonRows(types);
  if (common.empty()) return;
  std::printf("common to all %s\n", ofFilters ? "light filters" : "lights");
  PrintParameters(common, true, columns);
}

}  // namespace

int RunLights(const LightsOptions& options) {
  const TypeRegistry types = LoadTypes(options.plugins, nullptr);
  constexpr int kUnbounded = 1 << 20;  // in a file or a pipe: one line each
  const int columns = TerminalColumns(STDOUT_FILENO, kUnbounded);
  const std::vector<Entry> entries = AllEntries(types);
  const bool isOne = !options.type.empty();
  bool found = false;
  std::vector<std::string> names;
  for (const Entry& entry : entries) {
    names.push_back(entry.type->name);
    if (isOne && entry.type->name != options.type) continue;
    PrintType(entry.statement.c_str(), *entry.type, entry.plugin, columns);
    if (isOne) PrintCommon({entry}, entry.isFilter, columns);
    std::printf("\n");
    found = true;
  }
  if (!found)
    throw UsageError("there is no light or filter \"" + options.type + "\"" + DidYouMean(options.type, names));
  if (!isOne) {
    PrintCommon(entries, false, columns);
    std::printf("\n");
    PrintCommon(entries, true, columns);
  }
  return kExitDone;
}

}  // namespace lampyr
