// The table of all statements, and shared functions for reading them.
#include <unordered_map>

#include "scene/scene_parser.h"

namespace lampyr {

const std::vector<SceneParser::Statement>& SceneParser::Statements() {
  using P = SceneParser;
  static const std::vector<Statement> table = {
      {"Identity", Block::Anywhere, &P::Identity},
      {"Translate", Block::Anywhere, &P::Translate},
      {"Scale", Block::Anywhere, &P::Scale},
      {"Rotate", Block::Anywhere, &P::Rotate},
      {"LookAt", Block::Anywhere, &P::LookAt},
      {"Transform", Block::Anywhere, &P::TransformStatement},
      {"ConcatTransform", Block::Anywhere, &P::ConcatTransform},
      {"CoordinateSystem", Block::Anywhere, &P::CoordinateSystem},
      {"CoordSysTransform", Block::Anywhere, &P::CoordSysTransform},
      {"ActiveTransform", Block::Anywhere, &P::ActiveTransform},
      {"ColorSpace", Block::Anywhere, &P::ColorSpaceStatement},
      {"Option", Block::Anywhere, &P::Option},
      {"Attribute", Block::Anywhere, &P::Attribute},
      {"MakeNamedMedium", Block::Anywhere, &P::MakeNamedMedium},
      {"MediumInterface", Block::Anywhere, &P::MediumInterface},
      {"Include", Block::Anywhere, &P::Include},
      {"TransformTimes", Block::Options, &P::TransformTimes},
      {"Camera", Block::Options, &P::Camera},
      {"Film", Block::Options, &P::Film},
      {"PixelFilter", Block::Options, &P::PixelFilter},
      {"Sampler", Block::Options, &P::Sampler},
      {"Integrator", Block::Options, &P::Integrator},
      {"Accelerator", Block::Options, &P::Accelerator},
      {"WorldBegin", Block::Options, &P::WorldBegin},
      {"WorldEnd", Block::World, &P::WorldEnd},
      {"AttributeBegin", Block::World, &P::AttributeBegin},
      {"AttributeEnd", Block::World, &P::AttributeEnd},
      {"TransformBegin", Block::World, &P::TransformBegin},
      {"TransformEnd", Block::World, &P::TransformEnd},
      {"ObjectBegin", Block::World, &P::ObjectBegin},
      {"ObjectEnd", Block::World, &P::ObjectEnd},
      {"ObjectInstance", Block::World, &P::ObjectInstance},
      {"Shape", Block::World, &P::Shape},
      {"Material", Block::World, &P::Material},
      {"MakeNamedMaterial", Block::World, &P::MakeNamedMaterial},
      {"NamedMaterial", Block::World, &P::NamedMaterial},
      {"Texture", Block::World, &P::Texture},
      {"AreaLightSource", Block::World, &P::AreaLightSource},
      {"LightSource", Block::World, &P::LightSource},
      {"LightFilter", Block::World, &P::LightFilter},
      {"ReverseOrientation", Block::World, &P::ReverseOrientation},
      {"Import", Block::World, &P::Import},
  };
  return table;
}

SceneParser::SceneParser(const std::filesystem::path& file, Diagnostics& diagnostics)
    : file_(file), diagnostics_(diagnostics), tokens_(file) {}

SceneDescription SceneParser::Parse(std::string text) {
  tokens_.OpenText(file_, std::move(text));
  ParseStatements();
  CheckScopesClosed(0);
  if (!inWorld_) throw Error(tokens_.Next().where, "the scene ends before WorldBegin: it describes no world");
  CheckReferences();
  StopWhatCannotMove();
  CountInstances();
  scene_.file = file_;
  scene_.contentHash = tokens_.HashOfAll();
  scene_.files = tokens_.Files();
  return std::move(scene_);
}

void SceneParser::ParseStatements() {
  while (true) {
    const Token word = tokens_.Next();
    if (word.kind == TokenKind::End) return tokens_.PutBack(word);
    Run(word);
  }
}

void SceneParser::Run(const Token& word) {
  static const std::unordered_map<std::string_view, const Statement*> byName = [] {
    std::unordered_map<std::string_view, const Statement*> map;
    for (const Statement& statement : Statements()) map.emplace(statement.name, &statement);
    return map;
  }();
  const auto found = word.kind == TokenKind::Word ? byName.find(word.text) : byName.end();
  if (found == byName.end()) UnknownStatement(word);
  const Statement& statement = *found->second;
  if (statement.block == Block::World && !inWorld_) {
    throw Error(word.where, word.text + " describes the world: it must come after WorldBegin");
  }
  if (statement.block == Block::Options && inWorld_) {
    throw Error(word.where, word.text + " must come before WorldBegin");
  }
  (this->*statement.run)(word);
  previous_ = word;
}

void SceneParser::UnknownStatement(const Token& word) const {
  if (word.kind != TokenKind::Word || LooksLikeNumber(word.text)) {
    const std::string after = previous_.text.empty() ? "" : "; " + previous_.text + " takes no more";
    throw Error(word.where, "expected a statement, found " + Describe(word) + after);
  }
  // Statements of pbrt-v3 and earlier, with their successors.
  constexpr const char* kFormer[][2] = {{"Filter", "PixelFilter"},          {"SurfaceIntegrator", "Integrator"},
                                        {"VolumeIntegrator", "Integrator"}, {"Renderer", "Integrator"},
                                        {"Volume", "MakeNamedMedium"},      {"Surface", "Material"}};
  for (const auto& [former, now] : kFormer) {
    if (word.text == former)
      throw Error(word.where, "there is no statement \"" + word.text + "\" (did you mean \"" + now + "\"?)");
  }
  std::vector<std::string> names;
  for (const Statement& statement : Statements()) names.push_back(statement.name);
  throw Error(word.where, "there is no statement " + Describe(word) + DidYouMean(word.text, names));
}

void SceneParser::CheckScopesClosed(size_t lowest) const {
  if (scopes_.size() <= lowest) return;
  const Scope& open = scopes_.back();
  const std::string end = open.statement.substr(0, open.statement.size() - std::string_view("Begin").size()) + "End";
  throw Error(open.where, "this " + open.statement + " has no " + end);
}

std::string SceneParser::ReadString(const Token& statement, const char* what) {
  Token token = tokens_.Next();
  if (token.kind == TokenKind::String) return std::move(token.text);
  throw Error(token.where, statement.text + " needs " + what + " in quotes, found " + Describe(token));
}

void SceneParser::ReadNumbersInto(const Token& statement, double* numbers, size_t count) {
  for (size_t i = 0; i < count; ++i) {
    const Token token = tokens_.Next();
    if (token.kind == TokenKind::Open) throw Error(token.where, statement.text + " takes its numbers without brackets");
    const bool isNumber = token.kind == TokenKind::Word && (LooksLikeNumber(token.text) || IsNonFinite(token.text));
    if (!isNumber) {
      throw Error(token.where, statement.text + " needs " + std::to_string(count) + " numbers, has " +
                                   std::to_string(i) + " before " + Describe(token));
    }
    numbers[i] = ParseNumber(token.text, token.where);
  }
}

ParameterList SceneParser::ReadList(const Token& statement, const std::string& owner, const char* attributeTarget) {
  std::vector<Parameter> parameters = ReadParameters(tokens_, state_.colorSpace, diagnostics_);
  if (attributeTarget) {
    const auto defaults = state_.attributes.find(attributeTarget);
    if (defaults != state_.attributes.end()) {
      const size_t own = parameters.size();
      for (const Parameter& parameter : *defaults->second) {
        bool given = false;
        for (size_t i = 0; i < own; ++i) given |= parameters[i].name == parameter.name;
        if (!given) parameters.push_back(parameter);
      }
    }
  }
  ParameterList list(statement.where, owner, std::move(parameters), tokens_.SceneFile());
  list.SetColorSpace(state_.colorSpace);
  return list;
}

StatementDescription SceneParser::ReadTyped(const Token& statement, const char* attributeTarget) {
  std::string type = ReadString(statement, "a type");
  ParameterList list = ReadList(statement, statement.text + " \"" + type + "\"", attributeTarget);
  return {std::move(type), std::move(list), statement.where};
}

SceneDescription ReadScene(const std::filesystem::path& file, Diagnostics& diagnostics) {
  return SceneParser(file, diagnostics).Parse(ReadTextFile(file, {}));
}

SceneDescription ParseScene(const std::string& text, const std::filesystem::path& name, Diagnostics& diagnostics) {
  return SceneParser(name, diagnostics).Parse(text);
}

}  // namespace lampyr
