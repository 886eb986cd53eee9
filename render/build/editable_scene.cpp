#include "render/build/editable_scene.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <utility>

#include "render/build/plugins.h"
#include "render/build/scene_lighting.h"

namespace lampyr {

namespace {

// Files by one name each, however they are written.
class FileNames {
 public:
  const std::string& Of(const FileLocation& where) {
    const std::string written = where.file ? *where.file : std::string();
    const auto [found, isNew] = names_.emplace(written, written);
    if (isNew) {
      std::error_code ignored;
      const std::filesystem::path canonical = std::filesystem::weakly_canonical(written, ignored);
      if (!ignored) found->second = canonical.string();
    }
    return found->second;
  }
  bool IsSamePlace(const FileLocation& a, const FileLocation& b) {
    return a.line == b.line && a.column == b.column && Of(a) == Of(b);
  }

 private:
  std::map<std::string, std::string> names_;
};

void Put(std::vector<Parameter>& into, const Parameter& parameter) {
  const auto same =
      std::find_if(into.begin(), into.end(), [&](const Parameter& other) { return other.name == parameter.name; });
  if (same != into.end()) {
    *same = parameter;
  } else {
    into.push_back(parameter);
  }
}

// Changes for Light::Edit, which does not know the folder of the scene: the files that the light has been made of, by
// absolute names, and then the changes.
std::vector<Parameter> WithFiles(const ParameterList& made, const std::vector<Parameter>& changes) {
  std::vector<Parameter> all;
  for (const Parameter& parameter : made.All()) {
    const bool isName = parameter.type == ParameterType::String && parameter.strings.size() == 1;
    if (!isName || parameter.name.find("file") == std::string::npos) continue;
    const std::string file = made.ResolveFile(parameter.strings[0], parameter.where);
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(file, ignored)) continue;
    all.push_back(parameter);
    all.back().strings[0] = file;
  }
  for (const Parameter& parameter : changes) Put(all, parameter);
  return all;
}

}  // namespace

EditableScene::EditableScene(SceneDescription description, const RenderOverrides& overrides, bool robust,
                             TypeRegistry types, Diagnostics& diagnostics)
    : overrides_(overrides),
      robust_(robust),
      types_(std::move(types)),
      diagnostics_(diagnostics),
      description_(std::move(description)) {
  Build();
  FindStatements();
}

EditableScene::~EditableScene() = default;

void EditableScene::FindStatements() {
  FileNames names;
  const auto add = [&](EditableStatement::Kind kind, const TypeDescription* type, const FileLocation& where, size_t i) {
    const auto same = std::find_if(statements_.begin(), statements_.end(), [&](const EditableStatement& other) {
      return other.kind == kind && names.IsSamePlace(other.where, where);
    });
    if (same != statements_.end()) {
      same->descriptions.push_back(i);
    } else {
      statements_.push_back({kind, type, where, {i}, {}, {}});
    }
  };
  const auto& [description, types] = std::tie(description_, types_);
  for (size_t i = 0; i < description.lights.size(); ++i) {
    const StatementDescription& light = description.lights[i].light;
    add(EditableStatement::Kind::Light, types.FindLight(light.type, false), light.where, i);
  }
  for (size_t i = 0; i < description.areaLights.size(); ++i) {
    const StatementDescription& light = description.areaLights[i];
    add(EditableStatement::Kind::AreaLight, types.FindLight(light.type, true), light.where, i);
  }
  for (EditableStatement& statement : statements_) {
    for (size_t light = 0; light < built_->lightPlaces.size(); ++light) {
      if (names.IsSamePlace(built_->lightPlaces[light], statement.where))
        statement.lights.push_back(static_cast<uint32_t>(light));
    }
  }
  // Area lights that no shape has.
  std::erase_if(statements_, [](const EditableStatement& statement) { return statement.lights.empty(); });
  for (size_t i = 0; i < description.lightFilters.size(); ++i) {
    const StatementDescription& filter = description.lightFilters[i].filter;
    add(EditableStatement::Kind::Filter, types.FindFilter(filter.type), filter.where, i);
  }
  for (EditableStatement& statement : statements_) {
    for (const size_t i : statement.descriptions) statement.originals.push_back(DescriptionOf(statement, i).parameters);
  }
}

StatementDescription& EditableScene::DescriptionOf(const EditableStatement& statement, size_t i) {
  switch (statement.kind) {
    case EditableStatement::Kind::Light:
      return description_.lights[i].light;
    case EditableStatement::Kind::AreaLight:
      return description_.areaLights[i];
    case EditableStatement::Kind::Filter:
      break;
  }
  return description_.lightFilters[i].filter;
}

const ParameterList& EditableScene::ParametersOf(size_t statement) const {
  const EditableStatement& of = statements_[statement];
  const size_t first = of.descriptions.front();
  switch (of.kind) {
    case EditableStatement::Kind::Light:
      return description_.lights[first].light.parameters;
    case EditableStatement::Kind::AreaLight:
      return description_.areaLights[first].parameters;
    case EditableStatement::Kind::Filter:
      break;
  }
  return description_.lightFilters[first].filter.parameters;
}

RgbColorSpace EditableScene::ColorSpaceOf(size_t statement) const {
  return OriginalOf(statement).ColorSpace();
}

// True if the shapes have to be built again: parameters of a light with a surface of its own, and cameraVisible.
bool EditableScene::ConcernsShapes(const StatementEdit& change, const Lights& edited) const {
  const EditableStatement& statement = statements_[change.statement];
  const auto hasSurface = [](const auto& light) { return light->Surface() != nullptr; };
  const bool hadSurface = std::any_of(statement.lights.begin(), statement.lights.end(),
                                      [&](uint32_t light) { return hasSurface(kept_->lights[light].light); });
  const bool isSurface = hadSurface || std::any_of(edited.begin(), edited.end(), hasSurface);
  const bool isShape = statement.kind == EditableStatement::Kind::AreaLight;
  if (!isSurface && !isShape) return false;
  return std::any_of(change.parameters.begin(), change.parameters.end(), [&](const Parameter& parameter) {
    if (parameter.name == "cameraVisible") return true;
    if (isShape) return false;
    const auto row = std::find_if(statement.type->parameters.begin(), statement.type->parameters.end(),
                                  [&](const ParameterInfo& info) { return info.name == parameter.name; });
    return row == statement.type->parameters.end() || !row->isCommon;
  });
}

EditableScene::Lights EditableScene::EditLights(const StatementEdit& change) const {
  const ParameterList& made = ParametersOf(change.statement);
  const ParameterList changes(made.Where(), made.Owner(), WithFiles(made, change.parameters));
  Lights lights;
  for (const uint32_t light : statements_[change.statement].lights) {
    lights.push_back(kept_->lights[light].light->Edit(changes, kept_->contexts[light].build));
    if (!lights.back())
      throw Error(made.Where(), "\"" + made.Owner() + "\": the edited light is none: Edit returned null");
  }
  return lights;
}

void EditableScene::Describe(const Edits& edits) {
  const auto sceneFile = std::make_shared<const std::string>(description_.file.string());
  for (size_t index = 0; index < statements_.size(); ++index) {
    const EditableStatement& statement = statements_[index];
    const auto edited = edits.find(index);
    for (size_t i = 0; i < statement.descriptions.size(); ++i) {
      const ParameterList& original = statement.originals[i];
      StatementDescription& description = DescriptionOf(statement, statement.descriptions[i]);
      description.parameters = original;
      if (edited == edits.end()) continue;
      std::vector<Parameter> all = original.All();
      for (const auto& [name, parameter] : edited->second) Put(all, parameter);
      description.parameters = ParameterList(original.Where(), original.Owner(), std::move(all), sceneFile);
      description.parameters.SetColorSpace(original.ColorSpace());
    }
  }
}

void EditableScene::Build() {
  auto kept = std::make_unique<KeptLighting>();
  auto built = std::make_shared<BuiltScene>();
  RunForeignCode(types_, [&] { *built = BuildScene(description_, overrides_, robust_, diagnostics_, types_, *kept); });
  kept_ = std::move(kept);
  built_ = std::move(built);
}

void EditableScene::Rebuild(const Edits& edits) {
  Describe(edits);
  try {
    Build();
  } catch (...) {
    Describe(edits_);
    throw;
  }
}

void EditableScene::Relight(const std::vector<StatementEdit>& changes, const std::vector<Lights>& edited) {
  LightsToPlace toPlace{kept_->lights, kept_->linking, kept_->around, kept_->middleOfFilm, kept_->threads};
  for (size_t change = 0; change < changes.size(); ++change) {
    const EditableStatement& statement = statements_[changes[change].statement];
    const bool isShape = statement.kind == EditableStatement::Kind::AreaLight;
    for (size_t i = 0; i < statement.lights.size(); ++i) {
      PlacedLight& placed = toPlace.lights[statement.lights[i]];
      placed.light = edited[change][i];
      if (!isShape && !placed.light->Surface()) placed.canBeHit = placed.light->Kind() != LightKind::Area;
    }
  }
  std::vector<PlacedLight> placed = toPlace.lights;
  auto built = std::make_shared<BuiltScene>(*built_);
  built->settings = kept_->settings;
  LightScene(std::move(toPlace), *kept_->media, diagnostics_, *built);
  kept_->lights = std::move(placed);
  built_ = std::move(built);
}

void EditableScene::Edit(const std::vector<StatementEdit>& changes) {
  Edits edits = edits_;
  for (const StatementEdit& change : changes) {
    for (const Parameter& parameter : change.parameters) edits[change.statement][parameter.name] = parameter;
  }
  RunForeignCode(types_, [&] {
    std::vector<Lights> edited;
    bool mayRelight = true;
    for (const StatementEdit& change : changes) {
      edited.push_back(EditLights(change));
      // A statement that was read several times may have been given other parameters each time.
      const bool isOne = statements_[change.statement].descriptions.size() == 1;
      mayRelight = mayRelight && isOne && !edited.back().empty() && !ConcernsShapes(change, edited.back());
    }
    if (!mayRelight) return Rebuild(edits);
    Relight(changes, edited);
    Describe(edits);
  });
  edits_ = std::move(edits);
}

void EditableScene::Reset(size_t index, const std::string& parameter) {
  Edits edits = edits_;
  const auto edited = edits.find(index);
  if (edited == edits.end() || edited->second.erase(parameter) == 0) return;
  if (edited->second.empty()) edits.erase(edited);
  Rebuild(edits);
  edits_ = std::move(edits);
}

std::vector<StatementChange> EditableScene::Changes() const {
  std::vector<StatementChange> changes;
  for (const auto& [index, parameters] : edits_) {
    StatementChange& change = changes.emplace_back();
    change.where = statements_[index].where;
    for (const auto& [name, parameter] : parameters) change.parameters.push_back(parameter);
  }
  return changes;
}

}  // namespace lampyr
