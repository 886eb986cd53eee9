#include "lights/parameter_table.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

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
