#include "base/setting.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "base/error.h"
#include "base/memory.h"

namespace lampyr {

namespace {

constexpr const char* kBytes = "bytes";

std::string FormatNumber(double value, int digits) {
  char text[40];
  std::snprintf(text, sizeof text, "%.*g", digits, value);
  return text;
}

// The finite number that the whole text denotes; NaN for any other text.
double ParseNumber(const std::string& text) {
  char* end = nullptr;
  const double number = std::strtod(text.c_str(), &end);
  return end != text.c_str() && *end == '\0' && std::isfinite(number) ? number : std::nan("");
}

}  // namespace

double ParseWithUnit(const std::string& text, const std::vector<std::pair<std::string, double>>& units) {
  char* end = nullptr;
  const double number = std::strtod(text.c_str(), &end);
  if (end == text.c_str()) return std::nan("");
  for (const auto& [unit, factor] : units) {
    if (unit == end) return number * factor;
  }
  return std::nan("");
}

double ParseBytes(const std::string& text) {
  constexpr double kibi = 1024, mebi = 1024 * kibi, gibi = 1024 * mebi;
  return ParseWithUnit(
      text, {{"", 1}, {"B", 1}, {"K", kibi}, {"KiB", kibi}, {"M", mebi}, {"MiB", mebi}, {"G", gibi}, {"GiB", gibi}});
}

std::string Setting::NameInScenes() const {
  if (!sceneName.empty()) return sceneName;
  std::string plain = name;
  std::erase(plain, '-');
  return plain;
}

std::string Setting::Range() const {
  if (!range.empty()) return range;
  const bool hasLeast = std::isfinite(least), hasMost = std::isfinite(most);
  if (hasLeast && hasMost) return "from " + FormatNumber(least, 10) + " to " + FormatNumber(most, 10);
  if (hasLeast) return FormatNumber(least, 10) + " or more";
  return hasMost ? "at most " + FormatNumber(most, 10) : "";
}

std::string Setting::Format(const SettingValue& value) const {
  if (const bool* isOn = std::get_if<bool>(&value)) return *isOn ? "on" : "off";
  if (const auto* integer = std::get_if<int64_t>(&value))
    return unit == kBytes ? FormatBytes(static_cast<double>(*integer)) : std::to_string(*integer);
  if (const double* number = std::get_if<double>(&value)) return FormatNumber(*number, 3);
  return std::get<std::string>(value);
}

std::string Setting::ToExactString(const SettingValue& value) {
  if (const bool* isOn = std::get_if<bool>(&value)) return *isOn ? "on" : "off";
  if (const auto* integer = std::get_if<int64_t>(&value)) return std::to_string(*integer);
  if (const double* number = std::get_if<double>(&value)) {
    char text[40];
    return {text, std::to_chars(text, text + sizeof text, *number).ptr};
  }
  return std::get<std::string>(value);
}

SettingValue Setting::Parse(const std::string& text) const {
  if (std::holds_alternative<std::string>(fallback)) return Check(text);
  if (std::holds_alternative<bool>(fallback)) {
    if (text == "on" || text == "true") return true;
    if (text == "off" || text == "false") return false;
    throw Error("\"" + text + "\" is neither on nor off");
  }
  if (unit == kBytes) {
    const double bytes = ParseBytes(text);
    if (!(bytes >= 1) || !(bytes < 1e15)) throw Error("\"" + text + "\" is not a size; write 800M or 4G");
    return Check(static_cast<int64_t>(bytes));
  }
  const double number = ParseNumber(text);
  const bool isWhole = std::holds_alternative<int64_t>(fallback);
  if (std::isnan(number) || (isWhole && std::trunc(number) != number)) {
    throw Error("\"" + text + "\" is not a " + (isWhole ? "whole number" : "number") +
                (Range().empty() ? "" : ": it must be " + Range()));
  }
  CheckRange(number);
  if (isWhole) return static_cast<int64_t>(number);
  return number;
}

void Setting::CheckRange(double number) const {
  if (number >= least && number <= most) return;
  const char* wrong = std::isnan(number) ? "not a number" : number < least ? "too small" : "too large";
  throw Error("\"" + FormatNumber(number, 10) + "\" is " + wrong + ": it must be " + Range());
}

SettingValue Setting::Check(const SettingValue& value) const {
  SettingValue given = value;
  const auto* integer = std::get_if<int64_t>(&given);
  if (integer && std::holds_alternative<double>(fallback)) given = static_cast<double>(*integer);
  if (given.index() != fallback.index()) throw Error("\"" + name + "\" is of another type");
  if (const auto* word = std::get_if<std::string>(&given)) {
    if (std::find(choices.begin(), choices.end(), *word) != choices.end()) return given;
    std::string all;
    for (const std::string& choice : choices) all += (all.empty() ? "" : ", ") + choice;
    throw Error("\"" + *word + "\" is not one of: " + all);
  }
  if (std::holds_alternative<bool>(given) || given == fallback) return given;
  CheckRange(std::holds_alternative<double>(given) ? std::get<double>(given)
                                                   : static_cast<double>(std::get<int64_t>(given)));
  return given;
}

Settings::Settings(const std::vector<const Setting*>& declared) {
  for (const Setting* setting : declared) {
    if (!Find(setting->name)) values_.emplace_back(setting, setting->fallback);
  }
}

const Setting* Settings::Find(const std::string& name) const {
  for (const auto& [setting, value] : values_) {
    if (setting->name == name) return setting;
  }
  return nullptr;
}

std::vector<std::string> Settings::Names() const {
  std::vector<std::string> names;
  for (const auto& [setting, value] : values_) names.push_back(setting->name);
  return names;
}

const SettingValue& Settings::Get(const std::string& name) const {
  for (const auto& [setting, value] : values_) {
    if (setting->name == name) return value;
  }
  throw Error("there is no setting \"" + name + "\"" + DidYouMean(name, Names()));
}

void Settings::RemoveBias() {
  for (auto& [setting, value] : values_) {
    if (setting->isBiased) value = setting->fallback;
  }
}

void Settings::Set(const std::string& name, const SettingValue& value) {
  for (auto& [setting, own] : values_) {
    if (setting->name != name) continue;
    own = setting->Check(value);
    return;
  }
  throw Error("there is no setting \"" + name + "\"" + DidYouMean(name, Names()));
}

}  // namespace lampyr
