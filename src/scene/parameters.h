// Parameters of a scene statement: typed, with their locations in the file. Unused ones are recorded, to find misspelt
// names. Numbers are double, as read.
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
#include "spectral/color_space.h"
#include "spectral/spectral_curve.h"

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
  RgbColorSpace colorSpace = RgbColorSpace::Srgb;  // of `numbers`, for type Rgb; getters of ParameterList convert
  bool mayBeUnused = false;                        // a default from an Attribute statement
  mutable bool used = false;                       // read by a getter; single-threaded, while the scene is built

  size_t ValueCount() const { return numbers.size() + integers.size() + strings.size() + bools.size(); }
};

// The meaning of a colour, which determines how a spectrum becomes RGB ([Pharr23 §4.6]).
enum class SpectrumRole {
  Albedo,      // reflectance: its colour under the white of the colour space
  Unbounded,   // η, k: averaged per channel; a spectrum is constant beyond its samples
  Extinction,  // σ: averaged per channel; 0 beyond the samples of a spectrum, as those of light and albedo
  Illuminant,  // light: the colour at luminance 1 of spectra and blackbodies (pbrt-v4's unit rule); rgb as given
};

class ParameterList {
 public:
  ParameterList() = default;
  // `sceneFile`: the main scene file, if the statement may be in an included one (GetFile).
  ParameterList(FileLocation statement, std::string statementName, std::vector<Parameter> parameters,
                std::shared_ptr<const std::string> sceneFile = nullptr)
      : where_(std::move(statement)),
        owner_(std::move(statementName)),
        parameters_(std::move(parameters)),
        sceneFile_(std::move(sceneFile)) {}

  // Each getter returns the default if there is no such parameter, and throws a located Error if it has another type,
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
  // The curve of a parameter of one spectrum or black body; null if it is given as rgb, or not at all. Throws as
  // FindColor does.
  std::shared_ptr<const SpectralCurve> FindCurve(const std::string& name, SpectrumRole role) const;

  std::vector<double> GetFloats(const std::string& name) const;
  std::vector<int64_t> GetIntegers(const std::string& name) const;
  std::vector<std::string> GetStrings(const std::string& name) const;
  std::vector<bool> GetBools(const std::string& name) const;
  std::vector<Point2d> GetPoint2s(const std::string& name) const;
  std::vector<Point3d> GetPoint3s(const std::string& name) const;  // also accepts vector3 and normal
  std::vector<Color> GetColors(const std::string& name, SpectrumRole role) const;

  // An absolute file name: relative to the folder of the scene (as in pbrt-v4) if the file exists there, otherwise
  // relative to the folder of the file that contains the statement (an included one may be elsewhere). "" if absent.
  std::string GetFile(const std::string& name) const;
  // Resolves a given file name by the rule of GetFile. "" for "".
  std::string ResolveFile(const std::string& name, const FileLocation& writtenAt) const;

  // The name of the texture if the parameter `name` is of type "texture".
  std::optional<std::string> GetTextureName(const std::string& name) const;
  // The parameter of any type, or null. Marks it as used.
  const Parameter* Find(const std::string& name) const;

  // Sets the colour space of the statement; also determines its white as light in Rec. 709, the default colour of
  // lights.
  void SetColorSpace(RgbColorSpace space) { colorSpace_ = space; }
  RgbColorSpace ColorSpace() const { return colorSpace_; }
  Color White() const;

  const FileLocation& Where() const { return where_; }  // of the statement
  FileLocation WhereOf(const std::string& name) const;  // of the parameter; of the statement if absent
  const std::string& Owner() const { return owner_; }   // "Shape \"sphere\"", for messages
  const std::vector<Parameter>& All() const { return parameters_; }

  // For each parameter that was not used: warns if its name is in `alsoInPbrt` (parameters of pbrt-v4 that lampyr does
  // not support) or in `known` (no effect here); otherwise throws an Error that suggests the nearest name.
  void CheckAllUsed(const std::vector<std::string>& alsoInPbrt, const std::vector<std::string>& known,
                    Diagnostics& diagnostics) const;

 private:
  FileLocation where_;
  std::string owner_;
  std::vector<Parameter> parameters_;
  std::shared_ptr<const std::string> sceneFile_;
  RgbColorSpace colorSpace_ = RgbColorSpace::Srgb;

  const Parameter* FindTyped(const std::string& name, std::initializer_list<ParameterType> types) const;
  // The parameter, of one of `types`, with `perItem` numbers per item, or null if absent; exactly one item if `single`.
  const Parameter* FindNumbers(const std::string& name, std::initializer_list<ParameterType> types, size_t perItem,
                               bool single) const;
  std::vector<Color> ColorsOf(const Parameter& parameter, SpectrumRole role) const;
  [[noreturn]] void WrongCount(const Parameter& parameter, size_t needed, size_t found) const;
};

}  // namespace lampyr
