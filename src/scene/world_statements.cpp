// Statements that describe the world: scopes, objects, shapes, materials, textures, lights, media, other files.
#include <algorithm>
#include <utility>

#include "scene/limits.h"
#include "scene/scene_parser.h"

namespace lampyr {

void SceneParser::WorldEnd(const Token& statement) {
  diagnostics_.Warn(statement.where, "WorldEnd is of pbrt-v3: it is ignored");
}

void SceneParser::OpenScope(const Token& statement, bool isObject) {
  if (scopes_.size() == limits::kOpenScopes) {
    throw Error(statement.where, "scopes are nested more than 50000 deep; the innermost is the " +
                                     scopes_.back().statement + " at " + scopes_.back().where.ToString());
  }
  scopes_.push_back({state_, isObject, statement.text, statement.where});
}

void SceneParser::AttributeBegin(const Token& statement) {
  OpenScope(statement, false);
}

void SceneParser::AttributeEnd(const Token& statement) {
  CloseScope(statement, false);
}

void SceneParser::TransformBegin(const Token& statement) {
  diagnostics_.Warn(statement.where, "TransformBegin is deprecated: it is taken as AttributeBegin, as pbrt-v4 does");
  AttributeBegin(statement);
}

void SceneParser::TransformEnd(const Token& statement) {
  diagnostics_.Warn(statement.where, "TransformEnd is deprecated: it is taken as AttributeEnd, as pbrt-v4 does");
  CloseScope(statement, false);
}

void SceneParser::CloseScope(const Token& statement, bool isObject) {
  const std::string begin = statement.text.substr(0, statement.text.size() - std::string_view("End").size()) + "Begin";
  if (scopes_.size() <= lowestScope_) throw Error(statement.where, statement.text + " without " + begin);
  Scope& scope = scopes_.back();
  if (scope.isObject != isObject) {
    throw Error(statement.where, statement.text + " ends the " + scope.statement + " at " + scope.where.ToString());
  }
  state_ = std::move(scope.saved);
  scopes_.pop_back();
}

namespace {

// Checks attributes of the targets "lighting" and "lightfilter". They are not defaults of other statements, so that
// their parameters can be checked here.
void CheckLinking(const std::string& target, const Parameter& parameter) {
  std::vector<std::string> names = {"subset"};
  if (target == "lighting") names.emplace_back("excludesubset");
  if (target != "lighting" && target != "lightfilter") return;
  const std::string owner = "Attribute \"" + target + "\"";
  if (std::find(names.begin(), names.end(), parameter.name) == names.end()) {
    throw Error(parameter.where,
                owner + " has no parameter \"" + parameter.name + "\"" + DidYouMean(parameter.name, names));
  }
  if (parameter.type != ParameterType::String) {
    throw Error(parameter.where, owner + ": parameter \"" + parameter.name + "\" is of type \"" +
                                     ToString(parameter.type) + "\", expected \"string\"");
  }
}

}  // namespace

void SceneParser::Attribute(const Token&) {
  const Token target = tokens_.Next();
  if (target.kind != TokenKind::String) {
    throw Error(target.where, "Attribute needs a target in quotes, found " + Describe(target));
  }
  const std::vector<std::string> targets = {"shape",   "light",    "material",   "medium",
                                            "texture", "lighting", "lightfilter"};
  const auto found = std::find(targets.begin(), targets.end(), target.text);
  if (found == targets.end()) {
    throw Error(target.where,
                "there is no Attribute target \"" + target.text + "\"" + DidYouMean(target.text, targets));
  }
  std::shared_ptr<const std::vector<Parameter>>& kept = state_.attributes[target.text];
  std::vector<Parameter> defaults = kept ? *kept : std::vector<Parameter>();
  for (Parameter& parameter : ReadParameters(tokens_, state_.colorSpace, diagnostics_)) {
    parameter.mayBeUnused = true;
    CheckLinking(target.text, parameter);
    const auto sameName = [&](const Parameter& other) { return other.name == parameter.name; };
    std::erase_if(defaults, sameName);
    defaults.push_back(std::move(parameter));
  }
  size_t values = 0;
  for (const Parameter& parameter : defaults) values += parameter.ValueCount();
  if (defaults.size() > limits::kDefaultParameters || values > limits::kDefaultValues) {
    throw Error(target.where, "Attribute \"" + target.text +
                                  "\" gives more than 64 parameters or 1000 values, of which every statement that "
                                  "follows has a copy; they can be given to the statement itself");
  }
  kept = std::make_shared<const std::vector<Parameter>>(std::move(defaults));
}

void SceneParser::ObjectBegin(const Token& statement) {
  const std::string name = ReadString(statement, "a name");
  if (currentObject_ >= 0) {
    throw Error(statement.where,
                "ObjectBegin within the ObjectBegin at " + scene_.objects[currentObject_].where.ToString());
  }
  const auto [entry, isNew] = objects_.emplace(name, static_cast<int>(scene_.objects.size()));
  if (!isNew) {
    throw Error(statement.where, "the object \"" + name + "\" is defined twice; the first is at " +
                                     scene_.objects[entry->second].where.ToString());
  }
  OpenScope(statement, true);
  currentObject_ = entry->second;
  scene_.objects.push_back({name, statement.where, {}, {}});
}

void SceneParser::ObjectEnd(const Token& statement) {
  CloseScope(statement, true);
  currentObject_ = -1;
}

void SceneParser::ObjectInstance(const Token& statement) {
  const std::string name = ReadString(statement, "an object's name");
  if (LeavesOutSingular(statement)) return;
  InstanceDescription instance{name, statement.where, PlacementOf(statement)};
  auto& list = currentObject_ >= 0 ? scene_.objects[currentObject_].instances : scene_.instances;
  list.push_back(std::move(instance));
}

void SceneParser::Shape(const Token& statement) {
  ShapeDescription shape;
  shape.shape = ReadTyped(statement, "shape");
  if (LeavesOutSingular(statement)) return;
  shape.placement = PlacementOf(statement);
  shape.reverseOrientation = state_.reverseOrientation;
  shape.material = state_.material;
  shape.areaLight = state_.areaLight;
  shape.insideMedium = state_.insideMedium;
  shape.outsideMedium = state_.outsideMedium;
  for (const char* target : {"lighting", "lightfilter"}) {
    const auto found = state_.attributes.find(target);
    if (found == state_.attributes.end() || found->second->empty()) continue;
    const std::string owner = std::string("Attribute \"") + target + "\"";
    shape.attributes[target] = ParameterList(found->second->front().where, owner, *found->second, tokens_.SceneFile());
  }
  auto& list = currentObject_ >= 0 ? scene_.objects[currentObject_].shapes : scene_.shapes;
  list.push_back(std::move(shape));
}

void SceneParser::Material(const Token& statement) {
  scene_.materials.push_back(ReadTyped(statement, "material"));
  state_.material = {static_cast<int>(scene_.materials.size()) - 1, "", statement.where};
}

void SceneParser::MakeNamedMaterial(const Token& statement) {
  const std::string name = ReadString(statement, "a name");
  const auto [entry, isNew] = namedMaterials_.emplace(name, statement.where);
  if (!isNew) {
    throw Error(statement.where,
                "the material \"" + name + "\" is defined twice; the first is at " + entry->second.ToString());
  }
  ParameterList parameters = ReadList(statement, "MakeNamedMaterial \"" + name + "\"", "material");
  std::string type = parameters.GetString("type", "");
  if (type.empty()) throw Error(statement.where, "MakeNamedMaterial \"" + name + "\" needs a \"string type\"");
  scene_.namedMaterials.push_back({name, {std::move(type), std::move(parameters), statement.where}});
}

void SceneParser::NamedMaterial(const Token& statement) {
  const std::string name = ReadString(statement, "a material's name");
  state_.material = {-1, name, statement.where};
  materialUses_.push_back({name, statement.where});
}

void SceneParser::Texture(const Token& statement) {
  TextureDescription texture;
  texture.name = ReadString(statement, "a name");
  const Token value = tokens_.Next();
  if (value.kind != TokenKind::String) {
    throw Error(value.where, "Texture needs \"float\" or \"spectrum\" after its name, found " + Describe(value));
  }
  if (value.text != "float" && value.text != "spectrum") {
    const std::string hint = value.text == "color" || value.text == "rgb"
                                 ? " (did you mean \"spectrum\"?)"
                                 : DidYouMean(value.text, {"float", "spectrum"});
    throw Error(value.where, "a Texture is of \"float\" or \"spectrum\", not \"" + value.text + "\"" + hint);
  }
  texture.isSpectrum = value.text == "spectrum";
  texture.texture = ReadTyped(statement, "texture");
  texture.placement = PlacementOf(statement);
  if (!textureNames_.emplace(texture.name, texture.isSpectrum).second) {
    throw Error(statement.where, "the " + value.text + " texture \"" + texture.name + "\" is defined twice");
  }
  scene_.textures.push_back(std::move(texture));
}

void SceneParser::AreaLightSource(const Token& statement) {
  scene_.areaLights.push_back({ReadTyped(statement, "light"), state_.lightFilter});
  state_.areaLight = static_cast<int>(scene_.areaLights.size()) - 1;
}

void SceneParser::LightSource(const Token& statement) {
  StatementDescription light = ReadTyped(statement, "light");
  scene_.lights.push_back({std::move(light), PlacementOf(statement), state_.outsideMedium, state_.lightFilter});
}

void SceneParser::LightFilter(const Token& statement) {
  StatementDescription filter = ReadTyped(statement);
  if (filter.type == "none") {
    if (!filter.parameters.All().empty())
      throw Error(filter.parameters.All().front().where, "LightFilter \"none\" has no parameters");
    state_.lightFilter = -1;
    return;
  }
  Placement placement = PlacementOf(statement);
  const std::string name = filter.parameters.GetString("coordsys", "");
  if (!name.empty()) {
    const auto found = coordinateSystems_.find(name);
    if (found == coordinateSystems_.end()) {
      std::vector<std::string> names;
      for (const auto& known : coordinateSystems_) names.push_back(known.first);
      throw Error(filter.parameters.WhereOf("coordsys"),
                  "there is no coordinate system \"" + name + "\"" + DidYouMean(name, names));
    }
    placement = {found->second[0], found->second[1]};
  }
  if (currentObject_ >= 0) {
    diagnostics_.Warn(statement.where,
                      "a LightFilter within an object stays where it is written: it does not move "
                      "with the object's instances");
  }
  state_.lightFilter = static_cast<int>(scene_.lightFilters.size());
  scene_.lightFilters.push_back({std::move(filter), placement});
}

void SceneParser::MakeNamedMedium(const Token& statement) {
  const std::string name = ReadString(statement, "a name");
  const auto [entry, isNew] = media_.emplace(name, statement.where);
  if (!isNew) {
    throw Error(statement.where,
                "the medium \"" + name + "\" is defined twice; the first is at " + entry->second.ToString());
  }
  ParameterList parameters = ReadList(statement, "MakeNamedMedium \"" + name + "\"", "medium");
  std::string type = parameters.GetString("type", "");
  if (type.empty()) throw Error(statement.where, "MakeNamedMedium \"" + name + "\" needs a \"string type\"");
  scene_.media.push_back({name, {std::move(type), std::move(parameters), statement.where}, PlacementOf(statement)});
}

void SceneParser::MediumInterface(const Token& statement) {
  state_.insideMedium = ReadString(statement, "a medium's name");
  Token second = tokens_.Next();
  if (second.kind == TokenKind::String) {
    state_.outsideMedium = std::move(second.text);
  } else {
    tokens_.PutBack(std::move(second));
    state_.outsideMedium = state_.insideMedium;
  }
  for (const std::string& name : {state_.insideMedium, state_.outsideMedium}) {
    if (!name.empty()) mediumUses_.push_back({name, statement.where});
  }
}

void SceneParser::ReverseOrientation(const Token&) {
  state_.reverseOrientation = !state_.reverseOrientation;
}

namespace {

bool IsWithin(const std::filesystem::path& file, const std::filesystem::path& folder) {
  return std::mismatch(folder.begin(), folder.end(), file.begin(), file.end()).first == folder.end();
}

}  // namespace

// Scenes share files beside their folder. A file farther away is read as well, but with a warning: it may be
// unintended.
void SceneParser::OpenNamedFile(const Token& statement) {
  const Token name = tokens_.Next();
  if (name.kind != TokenKind::String)
    throw Error(name.where, statement.text + " needs a file's name in quotes, found " + Describe(name));
  const std::filesystem::path file = tokens_.OpenFile(name);
  std::error_code failed;
  const std::filesystem::path folder = std::filesystem::weakly_canonical(std::filesystem::absolute(file_), failed)
                                           .parent_path(),
                              above = folder.parent_path();
  if (failed || IsWithin(file, folder) || (above.has_relative_path() && IsWithin(file, above))) return;
  diagnostics_.Warn(name.where, statement.text + " leaves the folders of the scene: \"" + file.string() + "\" is read");
}

void SceneParser::Include(const Token& statement) {
  OpenNamedFile(statement);
}

// Like Include, but restores the graphics state and the coordinate systems afterwards.
void SceneParser::Import(const Token& statement) {
  const GraphicsState state = state_;
  const size_t changedSystems = changedSystems_.size();
  OpenNamedFile(statement);
  ++imports_;
  const size_t bottom = tokens_.SetBottom();
  const size_t lowestScope = std::exchange(lowestScope_, scopes_.size());
  ParseStatements();
  tokens_.Next();  // the end of the imported file
  CheckScopesClosed(lowestScope_);
  lowestScope_ = lowestScope;
  tokens_.RestoreBottom(bottom);
  state_ = state;
  RestoreCoordinateSystems(changedSystems);
  --imports_;
}

}  // namespace lampyr
