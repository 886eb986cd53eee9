#include "scene/parameters.h"

#include <algorithm>
#include <cmath>

#include "scene/scene_paths.h"

namespace lampyr {

namespace {

constexpr const char* kTypeNames[] = {"float",   "integer", "bool", "string",   "point2",    "vector2", "point3",
                                      "vector3", "normal",  "rgb",  "spectrum", "blackbody", "texture"};

std::string CountOf(size_t count) {
  return std::to_string(count) + (count == 1 ? " value" : " values");
}

std::string TypeList(std::initializer_list<ParameterType> types) {
  std::string text;
  size_t i = 0;
  for (const ParameterType type : types) {
    text += (i == 0 ? "" : i + 1 == types.size() ? " or " : ", ") + std::string(ToString(type));
    ++i;
  }
  return text;
}

}  // namespace

const char* ToString(ParameterType type) {
  return kTypeNames[static_cast<int>(type)];
}

const Parameter* ParameterList::Find(const std::string& name) const {
  for (const Parameter& parameter : parameters_) {
    if (parameter.name != name) continue;
    parameter.used = true;
    return &parameter;
  }
  return nullptr;
}

FileLocation ParameterList::WhereOf(const std::string& name) const {
  for (const Parameter& parameter : parameters_) {
    if (parameter.name == name) return parameter.where;
  }
  return where_;
}

const Parameter* ParameterList::FindTyped(const std::string& name, std::initializer_list<ParameterType> types) const {
  const Parameter* parameter = Find(name);
  if (!parameter) return nullptr;
  if (std::find(types.begin(), types.end(), parameter->type) == types.end()) {
    throw Error(parameter->where, "\"" + name + "\" of " + owner_ + ": expected " + TypeList(types) + ", found " +
                                      ToString(parameter->type));
  }
  if (parameter->ValueCount() == 0) throw Error(parameter->where, "\"" + name + "\" of " + owner_ + " has no values");
  return parameter;
}

void ParameterList::WrongCount(const Parameter& parameter, size_t needed, size_t found) const {
  throw Error(parameter.where, "\"" + parameter.name + "\" of " + owner_ + " needs " + CountOf(needed) + ", has " +
                                   std::to_string(found));
}

const Parameter* ParameterList::FindNumbers(const std::string& name, std::initializer_list<ParameterType> types,
                                            size_t perItem, bool single) const {
  const Parameter* parameter = FindTyped(name, types);
  if (!parameter) return nullptr;
  const size_t count = parameter->numbers.size();
  if (single && count != perItem) WrongCount(*parameter, perItem, count);
  if (count % perItem != 0) {
    throw Error(parameter->where, "\"" + name + "\" of " + owner_ + " needs a multiple of " + CountOf(perItem) +
                                      ", has " + std::to_string(count));
  }
  const auto bad =
      std::find_if(parameter->numbers.begin(), parameter->numbers.end(), [](double n) { return !std::isfinite(n); });
  if (bad != parameter->numbers.end()) {
    throw Error(parameter->where, "\"" + name + "\" of " + owner_ + " has a value that is not a finite number");
  }
  return parameter;
}

double ParameterList::GetFloat(const std::string& name, double defaultValue) const {
  const Parameter* parameter = FindNumbers(name, {ParameterType::Float}, 1, true);
  return parameter ? parameter->numbers[0] : defaultValue;
}

int ParameterList::GetInteger(const std::string& name, int defaultValue) const {
  const Parameter* parameter = FindTyped(name, {ParameterType::Integer});
  if (!parameter) return defaultValue;
  if (parameter->integers.size() != 1) WrongCount(*parameter, 1, parameter->integers.size());
  return static_cast<int>(parameter->integers[0]);
}

bool ParameterList::GetBool(const std::string& name, bool defaultValue) const {
  const Parameter* parameter = FindTyped(name, {ParameterType::Bool});
  if (!parameter) return defaultValue;
  if (parameter->bools.size() != 1) WrongCount(*parameter, 1, parameter->bools.size());
  return parameter->bools[0];
}

std::string ParameterList::GetString(const std::string& name, const std::string& defaultValue) const {
  const Parameter* parameter = FindTyped(name, {ParameterType::String});
  if (!parameter) return defaultValue;
  if (parameter->strings.size() != 1) WrongCount(*parameter, 1, parameter->strings.size());
  return parameter->strings[0];
}

Point2d ParameterList::GetPoint2(const std::string& name, const Point2d& defaultValue) const {
  const Parameter* parameter = FindNumbers(name, {ParameterType::Point2}, 2, true);
  return parameter ? Point2d(parameter->numbers[0], parameter->numbers[1]) : defaultValue;
}

Point3d ParameterList::GetPoint3(const std::string& name, const Point3d& defaultValue) const {
  const Parameter* parameter = FindNumbers(name, {ParameterType::Point3}, 3, true);
  return parameter ? Point3d(parameter->numbers[0], parameter->numbers[1], parameter->numbers[2]) : defaultValue;
}

Vector3d ParameterList::GetVector3(const std::string& name, const Vector3d& defaultValue) const {
  const Parameter* parameter = FindNumbers(name, {ParameterType::Vector3}, 3, true);
  return parameter ? Vector3d(parameter->numbers[0], parameter->numbers[1], parameter->numbers[2]) : defaultValue;
}

std::vector<double> ParameterList::GetFloats(const std::string& name) const {
  const Parameter* parameter = FindNumbers(name, {ParameterType::Float}, 1, false);
  return parameter ? parameter->numbers : std::vector<double>();
}

std::vector<int64_t> ParameterList::GetIntegers(const std::string& name) const {
  const Parameter* parameter = FindTyped(name, {ParameterType::Integer});
  return parameter ? parameter->integers : std::vector<int64_t>();
}

std::vector<std::string> ParameterList::GetStrings(const std::string& name) const {
  const Parameter* parameter = FindTyped(name, {ParameterType::String});
  return parameter ? parameter->strings : std::vector<std::string>();
}

std::vector<bool> ParameterList::GetBools(const std::string& name) const {
  const Parameter* parameter = FindTyped(name, {ParameterType::Bool});
  return parameter ? parameter->bools : std::vector<bool>();
}

std::vector<Point2d> ParameterList::GetPoint2s(const std::string& name) const {
  const Parameter* parameter = FindNumbers(name, {ParameterType::Point2, ParameterType::Vector2}, 2, false);
  std::vector<Point2d> points;
  if (!parameter) return points;
  const std::vector<double>& n = parameter->numbers;
  points.reserve(n.size() / 2);
  for (size_t i = 0; i < n.size(); i += 2) points.emplace_back(n[i], n[i + 1]);
  return points;
}

std::vector<Point3d> ParameterList::GetPoint3s(const std::string& name) const {
  const Parameter* parameter =
      FindNumbers(name, {ParameterType::Point3, ParameterType::Vector3, ParameterType::Normal}, 3, false);
  std::vector<Point3d> points;
  if (!parameter) return points;
  const std::vector<double>& n = parameter->numbers;
  points.reserve(n.size() / 3);
  for (size_t i = 0; i < n.size(); i += 3) points.emplace_back(n[i], n[i + 1], n[i + 2]);
  return points;
}

std::string ParameterList::ResolveFile(const std::string& name, const FileLocation& writtenAt) const {
  if (name.empty()) return name;
  const std::string writer = writtenAt.file ? *writtenAt.file : "";
  return std::filesystem::absolute(FindSceneFile(name, writer, sceneFile_ ? *sceneFile_ : writer))
      .lexically_normal()
      .string();
}

std::string ParameterList::GetFile(const std::string& name) const {
  const std::string file = GetString(name, "");
  return ResolveFile(file, WhereOf(name));
}

std::optional<std::string> ParameterList::GetTextureName(const std::string& name) const {
  for (const Parameter& parameter : parameters_) {
    if (parameter.name != name || parameter.type != ParameterType::Texture) continue;
    parameter.used = true;
    if (parameter.strings.size() != 1) WrongCount(parameter, 1, parameter.strings.size());
    return parameter.strings[0];
  }
  return std::nullopt;
}

void ParameterList::CheckAllUsed(const std::vector<std::string>& alsoInPbrt, const std::vector<std::string>& known,
                                 Diagnostics& diagnostics) const {
  const auto contains = [](const std::vector<std::string>& names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  for (const Parameter& parameter : parameters_) {
    if (parameter.used || parameter.mayBeUnused) continue;
    const std::string quoted = "\"" + parameter.name + "\"";
    if (contains(alsoInPbrt, parameter.name)) {
      diagnostics.Warn(parameter.where, quoted + " of " + owner_ + " is not supported yet: it is ignored");
    } else if (contains(known, parameter.name)) {
      diagnostics.Warn(parameter.where, quoted + " of " + owner_ + " has no effect here");
    } else {
      std::vector<std::string> all = known;
      all.insert(all.end(), alsoInPbrt.begin(), alsoInPbrt.end());
      throw Error(parameter.where, owner_ + " has no parameter " + quoted + DidYouMean(parameter.name, all));
    }
  }
}

}  // namespace lampyr
