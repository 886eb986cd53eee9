// Statements before WorldBegin, and ColorSpace and Option, which are allowed anywhere.
#include <algorithm>

#include "scene/scene_parser.h"

namespace lampyr {

namespace {

// The options of pbrt-v4 and "plugins" of lampyr, in normalised spelling: lower case, without "-" and "_".
const std::vector<std::string>& OptionNames() {
  static const std::vector<std::string> names = {"disablepixeljitter",
                                                 "disabletexturefiltering",
                                                 "disablewavelengthjitter",
                                                 "displacementedgescale",
                                                 "forcediffuse",
                                                 "msereferenceimage",
                                                 "msereferenceout",
                                                 "pixelstats",
                                                 "plugins",
                                                 "rendercoordsys",
                                                 "seed",
                                                 "wavefront"};
  return names;
}

std::string Normalized(const std::string& name) {
  std::string result;
  for (const char c : name) {
    if (c != '-' && c != '_') result += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  }
  return result;
}

}  // namespace

// A statement that a scene may have only once.
void SceneParser::ReadOnly(const Token& statement, StatementDescription& into) {
  if (into.where.file) {
    diagnostics_.Warn(statement.where,
                      "a second " + statement.text + ": it replaces the one at " + into.where.ToString());
  }
  into = ReadTyped(statement);
}

void SceneParser::Camera(const Token& statement) {
  ReadOnly(statement, scene_.camera);
  const Placement worldToCamera = PlacementOf(statement);
  const TransformPair cameraToWorld = {worldToCamera.start.Inverse(), worldToCamera.end.Inverse()};
  SetCoordinateSystem("camera", cameraToWorld);
  scene_.cameraToWorld = {cameraToWorld[0], cameraToWorld[1]};
  scene_.cameraMedium = state_.outsideMedium;
}

void SceneParser::Film(const Token& statement) {
  ReadOnly(statement, scene_.film);
  if (state_.colorSpace != RgbColorSpace::Srgb) {
    diagnostics_.Warn(statement.where,
                      "images in another colour space than \"srgb\" are not supported yet: the image is linear sRGB");
  }
}

void SceneParser::PixelFilter(const Token& statement) {
  ReadOnly(statement, scene_.pixelFilter);
}
void SceneParser::Sampler(const Token& statement) {
  ReadOnly(statement, scene_.sampler);
}
void SceneParser::Integrator(const Token& statement) {
  ReadOnly(statement, scene_.integrator);
}
void SceneParser::Accelerator(const Token& statement) {
  ReadOnly(statement, scene_.accelerator);
}

// "a.so" or [ "a.so" "b.so" ].
void SceneParser::ReadPlugins() {
  const auto add = [&](Token name) {
    if (name.kind != TokenKind::String || name.text.empty()) {
      throw Error(name.where, "the option \"plugins\" needs names of files in quotes, found " + Describe(name));
    }
    scene_.plugins.push_back({std::move(name.text), name.where});
  };
  Token value = tokens_.Next();
  if (value.kind != TokenKind::Open) return add(std::move(value));
  for (value = tokens_.Next(); value.kind != TokenKind::Close; value = tokens_.Next()) add(std::move(value));
}

// Option "name" value. The type follows from the value: true, false, a number or a string.
void SceneParser::Option(const Token& statement) {
  Token name = tokens_.Next();
  if (name.kind != TokenKind::String) {
    throw Error(name.where, "Option needs a name in quotes, found " + Describe(name));
  }
  const size_t lastBlank = name.text.find_last_of(" \t");  // "bool wavefront" is read as "wavefront"
  Parameter option;
  option.name = Normalized(lastBlank == std::string::npos ? name.text : name.text.substr(lastBlank + 1));
  option.where = name.where;
  const std::vector<std::string>& known = OptionNames();
  if (std::find(known.begin(), known.end(), option.name) == known.end()) {
    throw Error(name.where, "there is no option \"" + name.text + "\"" + DidYouMean(option.name, known));
  }
  if (option.name == "plugins") return ReadPlugins();
  Token value = tokens_.Next();
  if (value.kind == TokenKind::String) {
    option.type = ParameterType::String;
    option.strings.push_back(std::move(value.text));
  } else if (value.kind != TokenKind::Word) {
    throw Error(value.where, "the option \"" + option.name + "\" needs a value, found " + Describe(value));
  } else if (value.text == "true" || value.text == "false") {
    option.type = ParameterType::Bool;
    option.bools.push_back(value.text == "true");
  } else if (value.text.find_first_not_of("+-0123456789") == std::string::npos) {
    option.type = ParameterType::Integer;
    option.integers.push_back(ParseInteger(value.text, value.where));
  } else {
    option.type = ParameterType::Float;
    option.numbers.push_back(ParseNumber(value.text, value.where));
  }
  if (option.name != "seed") {
    diagnostics_.Warn(statement.where, "the option \"" + option.name + "\" is not supported yet: it is ignored");
  }
  scene_.options[option.name] = std::move(option);
}

void SceneParser::ColorSpaceStatement(const Token& statement) {
  const Token name = tokens_.Next();
  if (name.kind != TokenKind::String) {
    throw Error(name.where, statement.text + " needs a name in quotes, found " + Describe(name));
  }
  const auto space = FindColorSpace(name.text);
  if (!space)
    throw Error(name.where,
                "there is no colour space \"" + name.text + "\"" + DidYouMean(name.text, ColorSpaceNames()));
  state_.colorSpace = *space;
}

void SceneParser::WorldBegin(const Token&) {
  inWorld_ = true;
  state_.ctm = {};
  state_.singular = {};
  state_.active = {true, true};
  SetCoordinateSystem("world", state_.ctm);
}

}  // namespace lampyr
