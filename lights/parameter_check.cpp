#include "lights/parameter_table.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <set>

namespace lampyr {

namespace {

bool IsColorType(ParameterType type) {
  return type == ParameterType::Rgb || type == ParameterType::Spectrum || type == ParameterType::Blackbody;
}

// A colour may be written as rgb, spectrum or blackbody; everything else as the table says.
bool TypeFits(ParameterType wanted, ParameterType given) {
  return wanted == given || (IsColorType(wanted) && IsColorType(given));
}

std::string Expected(ParameterType type) {
  return IsColorType(type) ? "rgb, spectrum or blackbody" : std::string("\"") + ToString(type) + "\"";
}

bool IsNumber(const std::string& text) {
  char* end = nullptr;
  std::strtod(text.c_str(), &end);
  return end != text.c_str() && *end == '\0';
}

// True if InRange understands it.
bool IsRange(const std::string& range) {
  if (range.rfind(">=", 0) == 0) return IsNumber(range.substr(2));
  if (range[0] == '>') return IsNumber(range.substr(1));
  const size_t comma = range.find(',');
  const bool isInterval =
      (range.front() == '[' || range.front() == '(') && (range.back() == ']' || range.back() == ')');
  return isInterval && comma != std::string::npos && IsNumber(range.substr(1, comma - 1)) &&
         IsNumber(range.substr(comma + 1, range.size() - comma - 2));
}

// Ranges as the tables write them: "> 0", ">= 0", "[0,1]", "(0,180]"; "" for any.
bool InRange(double value, const std::string& range) {
  if (range.empty()) return true;
  if (range.rfind(">=", 0) == 0) return value >= std::strtod(range.c_str() + 2, nullptr);
  if (range[0] == '>') return value > std::strtod(range.c_str() + 1, nullptr);
  const size_t comma = range.find(',');
  if (comma == std::string::npos) return true;
  const double low = std::strtod(range.c_str() + 1, nullptr), high = std::strtod(range.c_str() + comma + 1, nullptr);
  const bool aboveLow = range.front() == '[' ? value >= low : value > low;
  const bool belowHigh = range.back() == ']' ? value <= high : value < high;
  return aboveLow && belowHigh;
}

void CheckOne(const ParameterInfo& row, const Parameter& parameter, const std::string& owner) {
  const std::string what = owner + ": parameter \"" + parameter.name + "\"";
  if (!TypeFits(row.type, parameter.type)) {
    throw Error(parameter.where,
                what + " is of type \"" + ToString(parameter.type) + "\", expected " + Expected(row.type));
  }
  bool inside = true;
  for (const double number : parameter.numbers) inside = inside && InRange(number, row.range);
  for (const int64_t number : parameter.integers) inside = inside && InRange(static_cast<double>(number), row.range);
  if (!inside) throw Error(parameter.where, what + " is out of range: " + row.range + " is allowed");
  if (InRange(0, row.range)) return;
  for (const double number : parameter.numbers) {
    // It would be 0 in single precision.
    if (number != 0 && std::abs(number) < static_cast<double>(std::numeric_limits<float>::min()))
      throw Error(parameter.where, what + " is too small: at least 1.2e-38 is needed");
  }
}

}  // namespace

std::string MistakeIn(const TypeDescription& type) {
  std::set<std::string> names;
  for (const ParameterInfo& row : type.parameters) {
    const std::string what = "\"" + type.name + "\", parameter \"" + row.name + "\"";
    if (!names.insert(row.name).second) return what + ": it has two rows";
    if (!row.range.empty() && !IsRange(row.range))
      return what + ": the range \"" + row.range + "\" is none like \"> 0\", \">= 0\", \"[0,1]\" or \"(0,180]\"";
  }
  return "";
}

void CheckParameters(const TypeDescription& type, const std::string& statement, const ParameterList& parameters) {
  std::vector<std::string> names;
  for (const ParameterInfo& row : type.parameters) names.push_back(row.name);
  const std::string owner = statement + " \"" + type.name + "\"";
  for (const Parameter& parameter : parameters.All()) {
    const auto row = std::find_if(type.parameters.begin(), type.parameters.end(),
                                  [&](const ParameterInfo& info) { return info.name == parameter.name; });
    if (row == type.parameters.end()) {
      if (parameter.mayBeUnused) continue;  // of an Attribute, for other types
      throw Error(parameter.where,
                  owner + " has no parameter \"" + parameter.name + "\"" + DidYouMean(parameter.name, names));
    }
    parameters.Find(parameter.name);
    CheckOne(*row, parameter, owner);
  }
}

}  // namespace lampyr
