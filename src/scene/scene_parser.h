// The parser of scene files: statements change a graphics state, or add to the scene with the current state. Internal
// to scene/; the semantics are those of pbrt-v4 (file format documentation, [Pharr23 appendix C]).
//
// statements.cpp has the table of all statements; transform_statements.cpp, option_statements.cpp and
// world_statements.cpp execute them; scene_checks.cpp checks references at the end.
#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "scene/parameter_reader.h"
#include "scene/scene_description.h"
#include "scene/token_stream.h"

namespace lampyr {

// Transforms at shutter open and close.
using TransformPair = std::array<Transform, 2>;

// The state that AttributeBegin saves and AttributeEnd restores.
struct GraphicsState {
  TransformPair ctm;  // current transformation matrix: local to world
  std::array<bool, 2> active = {true, true};
  // The statements that made the CTM singular at either time; `ctm` is then the matrix before it. Absent: not singular.
  std::array<std::optional<Token>, 2> singular;

  const std::optional<Token>& Singular() const { return singular[0] ? singular[0] : singular[1]; }
  bool reverseOrientation = false;
  RgbColorSpace colorSpace = RgbColorSpace::Srgb;
  MaterialReference material;
  int areaLight = -1;
  int lightFilter = -1;
  std::string insideMedium, outsideMedium;
  // Keyed by target; shared, so that saving a scope is cheap.
  std::map<std::string, std::shared_ptr<const std::vector<Parameter>>> attributes;
};

// A reference by name, to be checked at the end.
struct NameUse {
  std::string name;
  FileLocation where;
};

class SceneParser {
 public:
  SceneParser(const std::filesystem::path& file, Diagnostics& diagnostics);

  // Parses the whole text of the scene's file.
  SceneDescription Parse(std::string text);

 private:
  using Handler = void (SceneParser::*)(const Token& statement);
  enum class Block { Anywhere, Options, World };
  struct Statement {
    const char* name;
    Block block;
    Handler run;
  };
  struct Scope {
    GraphicsState saved;
    bool isObject = false;
    std::string statement;
    FileLocation where;
  };

  std::filesystem::path file_;
  Diagnostics& diagnostics_;
  TokenStream tokens_;
  SceneDescription scene_;
  GraphicsState state_;
  std::vector<Scope> scopes_;
  size_t lowestScope_ = 0;  // scopes below this belong to the file that imports the current one
  bool inWorld_ = false;
  int currentObject_ = -1;
  std::map<std::string, TransformPair> coordinateSystems_;
  // Coordinate systems to be restored at the end of an Import: the names set since, and their previous values, if any.
  std::vector<std::pair<std::string, std::optional<TransformPair>>> changedSystems_;
  size_t imports_ = 0;  // current nesting depth
  std::set<std::pair<std::string, bool>> textureNames_;
  std::map<std::string, FileLocation> namedMaterials_, media_;
  std::map<std::string, int> objects_;
  std::vector<NameUse> mediumUses_, materialUses_;
  Token previous_;  // the previous statement, for messages

  // statements.cpp
  static const std::vector<Statement>& Statements();
  void ParseStatements();
  void Run(const Token& word);
  [[noreturn]] void UnknownStatement(const Token& word) const;
  void CheckScopesClosed(size_t lowest) const;

  // Reading the arguments of a statement.
  std::string ReadString(const Token& statement, const char* what);
  template <size_t N>
  std::array<double, N> ReadNumbers(const Token& statement);
  void ReadNumbersInto(const Token& statement, double* numbers, size_t count);
  std::array<double, 16> ReadMatrix(const Token& statement);
  StatementDescription ReadTyped(const Token& statement, const char* attributeTarget = nullptr);
  ParameterList ReadList(const Token& statement, const std::string& owner, const char* attributeTarget);
  // Throws an Error if the CTM is singular.
  Placement PlacementOf(const Token& statement) const;
  // True if the CTM is singular. The object that `statement` places then has no extent, and is left out with a warning.
  bool LeavesOutSingular(const Token& statement) const;

  // transform_statements.cpp
  void Concat(const Token& statement, const Transform& transform);
  // False if `transform` is singular. Throws an Error if it leaves the range of floats.
  static bool IsInvertible(const Token& statement, const Transform& transform);
  void Identity(const Token&);
  void Translate(const Token&);
  void Scale(const Token&);
  void Rotate(const Token&);
  void LookAt(const Token&);
  void TransformStatement(const Token&);
  void ConcatTransform(const Token&);
  void SetCoordinateSystem(const std::string& name, const TransformPair& transforms);
  void RestoreCoordinateSystems(size_t changes);
  void CoordinateSystem(const Token&);
  void CoordSysTransform(const Token&);
  void ActiveTransform(const Token&);
  void TransformTimes(const Token&);

  // option_statements.cpp
  void ReadOnly(const Token& statement, StatementDescription& into);
  void Camera(const Token&);
  void Film(const Token&);
  void PixelFilter(const Token&);
  void Sampler(const Token&);
  void Integrator(const Token&);
  void Accelerator(const Token&);
  void Option(const Token&);
  void ReadPlugins();
  void ColorSpaceStatement(const Token&);
  void WorldBegin(const Token&);

  // world_statements.cpp
  void WorldEnd(const Token&);
  void AttributeBegin(const Token&);
  void AttributeEnd(const Token&);
  void TransformBegin(const Token&);
  void TransformEnd(const Token&);
  void Attribute(const Token&);
  void ObjectBegin(const Token&);
  void ObjectEnd(const Token&);
  void ObjectInstance(const Token&);
  void Shape(const Token&);
  void Material(const Token&);
  void MakeNamedMaterial(const Token&);
  void NamedMaterial(const Token&);
  void Texture(const Token&);
  void AreaLightSource(const Token&);
  void LightSource(const Token&);
  void LightFilter(const Token&);
  void MakeNamedMedium(const Token&);
  void MediumInterface(const Token&);
  void ReverseOrientation(const Token&);
  void Include(const Token&);
  void Import(const Token&);
  void OpenNamedFile(const Token& statement);
  void OpenScope(const Token& statement, bool isObject);
  void CloseScope(const Token& statement, bool isObject);

  // scene_checks.cpp
  void CheckReferences() const;
  void StopWhatCannotMove();
  void CountInstances();
};

template <size_t N>
std::array<double, N> SceneParser::ReadNumbers(const Token& statement) {
  std::array<double, N> numbers;
  ReadNumbersInto(statement, numbers.data(), N);
  return numbers;
}

}  // namespace lampyr
