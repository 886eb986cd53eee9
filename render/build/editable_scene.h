// A scene whose lights and light filters may be edited while it is rendered: each edit makes another scene, which
// shares with the one before what has not changed.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "render/build/scene_builder.h"
#include "scene/scene_copy.h"

namespace lampyr {

struct KeptLighting;

// A statement LightSource, AreaLightSource or LightFilter, or several if their file is included several times.
struct EditableStatement {
  enum class Kind { Light, AreaLight, Filter };
  Kind kind = Kind::Light;
  const TypeDescription* type = nullptr;  // the table of its parameters
  FileLocation where;
  std::vector<size_t> descriptions;      // indices into the scene description's list of this kind
  std::vector<ParameterList> originals;  // as the scene has them, by `descriptions`
  std::vector<uint32_t> lights;          // that it makes, none for filters; an area light makes one of each shape
};

// Parameters of a statement to be replaced.
struct StatementEdit {
  size_t statement = 0;  // index into EditableScene::Statements
  std::vector<Parameter> parameters;
};

// Not thread-safe. Scenes that it has made may be rendered meanwhile, and outlive it.
class EditableScene {
 public:
  // `types`: a copy; code of plugins stays loaded. Throws as BuildScene does.
  EditableScene(SceneDescription description, const RenderOverrides& overrides, bool robust, TypeRegistry types,
                Diagnostics& diagnostics);
  ~EditableScene();

  const std::shared_ptr<const BuiltScene>& Built() const { return built_; }
  const TypeRegistry& Types() const { return types_; }
  // The description with all edits.
  const SceneDescription& Description() const { return description_; }
  const std::vector<EditableStatement>& Statements() const { return statements_; }
  // Parameters of the statement's first description: with all edits, and as the scene has them.
  const ParameterList& ParametersOf(size_t statement) const;
  const ParameterList& OriginalOf(size_t statement) const { return statements_[statement].originals.front(); }
  // The colour space of rgb values that are added to the statement.
  RgbColorSpace ColorSpaceOf(size_t statement) const;

  // Replaces parameters of statements, by Light::Edit of each of their lights. The new scene is that of a file with
  // these parameters. It keeps no table of the lights of the scene before: selection, emission, linking and the choice
  // of "auto" are made again. So are the shapes if the edit may change them: cameraVisible of a light with a surface,
  // and any parameter of a light with a surface of its own that not all lights have. Throws a located Error for a
  // mistake, and leaves all as it was.
  void Edit(const std::vector<StatementEdit>& changes);
  // Sets a parameter to what the scene has, its value or none. Builds the scene anew.
  void Reset(size_t statement, const std::string& parameter);

  // All edits so far.
  std::vector<StatementChange> Changes() const;

 private:
  using Edits = std::map<size_t, std::map<std::string, Parameter>>;  // by statement and name

  void FindStatements();
  StatementDescription& DescriptionOf(const EditableStatement& statement, size_t i);
  using Lights = std::vector<std::shared_ptr<const Light>>;

  bool ConcernsShapes(const StatementEdit& change, const Lights& edited) const;
  Lights EditLights(const StatementEdit& change) const;
  void Describe(const Edits& edits);
  void Build();
  void Rebuild(const Edits& edits);
  void Relight(const std::vector<StatementEdit>& changes, const std::vector<Lights>& edited);

  RenderOverrides overrides_;
  bool robust_;
  TypeRegistry types_;
  Diagnostics& diagnostics_;
  SceneDescription description_;
  std::unique_ptr<KeptLighting> kept_;  // refers to description_
  std::shared_ptr<const BuiltScene> built_;
  std::vector<EditableStatement> statements_;
  Edits edits_;
};

}  // namespace lampyr
