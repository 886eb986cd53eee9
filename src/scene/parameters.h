// Parameters of a scene statement: typed, with the place of each in the file, and a record of which were used, so that
// a misspelt one is found. The numbers are double, as read.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "base/error.h"
#include "math/vec.h"
#include "scene/color_space.h"

namespace lampyr {

enum class ParameterType {
  Float,
  Integer,
  Bool,
  String,
  Point2,
  Vector2,
  Point3,
  Vector3,
  Normal,
  Rgb,
  Spectrum,
  Blackbody,
  Texture
};

// "float", "integer", "point3", …, as scene files write them.
const char* ToString(ParameterType type);

struct Parameter {
  ParameterType type = ParameterType::Float;
  std::string name;
  FileLocation where;
  std::vector<double> numbers;  // float, point, …, rgb, blackbody, numeric spectrum
  std::vector<int64_t> integers;
  std::vector<std::string> strings;  // string, texture name, spectrum name or file (made relative to the scene file)
  std::vector<bool> bools;
  RgbColorSpace colorSpace = RgbColorSpace::Srgb;  // of `numbers` when the type is Rgb; ParameterList's getters convert
  bool mayBeUnused = false;                        // a default that an Attribute statement gave
  mutable bool used = false;  // asked for by whoever reads the list; single-threaded, while the scene is built

  size_t ValueCount() const { return numbers.size() + integers.size() + strings.size() + bools.size(); }
};

// What a colour stands for decides how a spectrum becomes RGB ([Pharr23 §4.6]).
enum class SpectrumRole {
  Albedo,      // a reflectance: seen under the white of the colour space
  Unbounded,   // η, k, σ: averaged per channel
  Illuminant,  // light: the colour at luminance 1 of spectra and blackbodies (pbrt-v4's unit rule); rgb as given
};

class ParameterList {
 public:
  ParameterList() = default;
  // `sceneFile`: the file that the scene was read from, when the statement may be in an included one (GetFile).
  ParameterList(FileLocation statement, std::string statementName, std::vector<Parameter> parameters,
                std::shared_ptr<const std::string> sceneFile = nullptr)
      : where_(std::move(statement)),
        owner_(std::move(statementName)),
        parameters_(std::move(parameters)),
        sceneFile_(std::move(sceneFile)) {}

  // Each getter gives the default when there is no such parameter, and throws a located Error when it has another type,
  // the wrong number of values, or a number that is not finite.
  double GetFloat(const std::string& name, double defaultValue) const;
  int GetInteger(const std::string& name, int defaultValue) const;
  bool GetBool(const std::string& name, bool defaultValue) const;
  std::string GetString(const std::string& name, const std::string& defaultValue) const;
  Point2d GetPoint2(const std::string& name, const Point2d& defaultValue) const;
  Point3d GetPoint3(const std::string& name, const Point3d& defaultValue) const;
  Vector3d GetVector3(const std::string& name, const Vector3d& defaultValue) const;
  Color GetColor(const std::string& name, const Color& defaultValue, SpectrumRole role) const;
  std::optional<Color> FindColor(const std::string& name, SpectrumRole role) const;

  std::vector<double> GetFloats(const std::string& name) const;
  std::vector<int64_t> GetIntegers(const std::string& name) const;
  std::vector<std::string> GetStrings(const std::string& name) const;
  std::vector<bool> GetBools(const std::string& name) const;
  std::vector<Point2d> GetPoint2s(const std::string& name) const;
  std::vector<Point3d> GetPoint3s(const std::string& name) const;  // also accepts vector3 and normal
  std::vector<Color> GetColors(const std::string& name, SpectrumRole role) const;

  // A file name made absolute: against the folder of the scene (as pbrt-v4 does) when it is there, else against the
  // folder of the file that wrote it (an included one may lie elsewhere). "" when absent.
  std::string GetFile(const std::string& name) const;
  // The same for a name that is at hand. "" for "".
  std::string ResolveFile(const std::string& name, const FileLocation& writtenAt) const;

  // The texture's name when the parameter `name` is of type "texture".
  std::optional<std::string> GetTextureName(const std::string& name) const;
  // The parameter whatever its type, or null. Marks it as used.
  const Parameter* Find(const std::string& name) const;

  const FileLocation& Where() const { return where_; }  // of the statement
  FileLocation WhereOf(const std::string& name) const;  // of the parameter, or of the statement when it is absent
  const std::string& Owner() const { return owner_; }   // "Shape \"sphere\"", for messages
  const std::vector<Parameter>& All() const { return parameters_; }

  // Warns about (`alsoInPbrt`) or throws for each parameter that nobody asked for, with the nearest of `known`.
  // `alsoInPbrt`: names that pbrt-v4 has here and lampyr does not use.
  void CheckAllUsed(const std::vector<std::string>& alsoInPbrt, const std::vector<std::string>& known,
                    Diagnostics& diagnostics) const;

 private:
  FileLocation where_;
  std::string owner_;
  std::vector<Parameter> parameters_;
  std::shared_ptr<const std::string> sceneFile_;

  const Parameter* FindTyped(const std::string& name, std::initializer_list<ParameterType> types) const;
  // The values of a parameter of one of `types`, `perItem` numbers each, or null; exactly one item when `single`.
  const Parameter* FindNumbers(const std::string& name, std::initializer_list<ParameterType> types, size_t perItem,
                               bool single) const;
  std::vector<Color> ColorsOf(const Parameter& parameter, SpectrumRole role) const;
  [[noreturn]] void WrongCount(const Parameter& parameter, size_t needed, size_t found) const;
};

}  // namespace lampyr
