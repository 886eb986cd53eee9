#include "app/desk/desk_lights.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <set>
#include <sstream>

#include "lights/services/lighting_services.h"

namespace lampyr {

namespace {

bool HasGroup(const StatementDescription& statement) {
  return !statement.parameters.GetString("lightGroup", "").empty();
}

void SetGroup(StatementDescription& statement, const std::string& group,
              const std::shared_ptr<const std::string>& sceneFile) {
  std::vector<Parameter> all = statement.parameters.All();
  std::erase_if(all, [](const Parameter& parameter) { return parameter.name == "lightGroup"; });
  Parameter& added = all.emplace_back();
  added.type = ParameterType::String;
  added.name = "lightGroup";
  added.where = statement.where;
  added.strings = {group};
  const RgbColorSpace space = statement.parameters.ColorSpace();
  statement.parameters = ParameterList(statement.where, statement.parameters.Owner(), std::move(all), sceneFile);
  statement.parameters.SetColorSpace(space);
}

std::string PlaceText(const FileLocation& where) {
  const std::string file = where.file ? std::filesystem::path(*where.file).filename().string() : "";
  return file + ":" + std::to_string(where.line);
}

const ParameterInfo* InfoOf(const EditableStatement& statement, const std::string& name) {
  for (const ParameterInfo& info : statement.type->parameters) {
    if (info.name == name) return &info;
  }
  return nullptr;
}

std::vector<double> NumbersIn(const std::string& text) {
  std::istringstream stream(text);
  std::vector<double> numbers;
  for (double number = 0; stream >> number;) numbers.push_back(number);
  return numbers;
}

bool IsColor(ParameterType type) {
  return type == ParameterType::Rgb || type == ParameterType::Spectrum || type == ParameterType::Blackbody;
}

// True for names by which other statements or layers refer to the light, and names of files: these are edited in the
// scene's file.
bool IsOfTheScene(const std::string& name) {
  static const std::set<std::string> names = {"name", "lightGroup", "coordsys", "filters", "linkingGroups"};
  return names.contains(name) || name.find("file") != std::string::npos;
}

ParameterControl ControlFor(const ParameterInfo& info) {
  if (IsOfTheScene(info.name)) return ParameterControl::None;
  switch (info.type) {
    case ParameterType::Bool:
      return ParameterControl::Switch;
    case ParameterType::Integer:
      return ParameterControl::Integer;
    case ParameterType::String:
      return ParameterControl::Text;
    case ParameterType::Texture:
      return ParameterControl::None;
    default:
      return IsColor(info.type) ? ParameterControl::Color : ParameterControl::Number;
  }
}

// The values of a parameter that is given. A spectrum is shown as the colour that it is to the lights.
void ShowGiven(const ParameterList& list, const Parameter& given, ShownParameter& shown) {
  if (IsColor(given.type) && given.type != ParameterType::Rgb) {
    const Color color = list.FindColor(given.name, SpectrumRole::Illuminant).value_or(Color(1.0f));
    for (const float channel : {color.r, color.g, color.b}) shown.numbers.push_back(static_cast<double>(channel));
    return;
  }
  shown.numbers = given.numbers;
  for (const int64_t number : given.integers) shown.numbers.push_back(static_cast<double>(number));
  for (const bool value : given.bools) shown.numbers.push_back(value ? 1 : 0);
  for (const std::string& text : given.strings) shown.text += (shown.text.empty() ? "" : ", ") + text;
}

void ShowDefault(const ParameterInfo& info, ShownParameter& shown) {
  const std::string& text = info.defaultValue;
  if (shown.control == ParameterControl::Switch) {
    shown.numbers = {text == "true" ? 1.0 : 0.0};
  } else if (shown.control == ParameterControl::Text || shown.control == ParameterControl::None) {
    shown.text = text.size() >= 2 && text.front() == '"' ? text.substr(1, text.size() - 2) : text;
  } else {
    shown.numbers = NumbersIn(text);
    if (shown.control == ParameterControl::Color && shown.numbers.size() == 1)
      shown.numbers.assign(3, shown.numbers.front());
  }
}

// Longer lists are edited in the scene's file.
size_t MostValuesOf(const ParameterInfo& info) {
  switch (info.type) {
    case ParameterType::Point2:
    case ParameterType::Vector2:
      return 2;
    case ParameterType::Point3:
    case ParameterType::Vector3:
    case ParameterType::Normal:
    case ParameterType::Rgb:
    case ParameterType::Spectrum:
    case ParameterType::Blackbody:
      return 3;
    default:
      return 1;
  }
}

}  // namespace

void GroupLights(SceneDescription& scene) {
  std::vector<StatementDescription*> statements;
  for (LightDescription& light : scene.lights) statements.push_back(&light.light);
  for (AreaLightDescription& light : scene.areaLights) statements.push_back(&light);
  if (std::any_of(statements.begin(), statements.end(), [](const auto* each) { return HasGroup(*each); })) return;
  std::map<std::string, std::vector<StatementDescription*>> byPlace;
  std::vector<std::string> order;
  for (StatementDescription* statement : statements) {
    std::vector<StatementDescription*>& same = byPlace[statement->where.ToString()];
    if (same.empty()) order.push_back(statement->where.ToString());
    same.push_back(statement);
  }
  const auto sceneFile = std::make_shared<const std::string>(scene.file.string());
  const size_t alone = order.size() > kMostFaders ? kMostFaders - 1 : order.size();
  for (size_t i = 0; i < alone; ++i) {
    char group[32];
    std::snprintf(group, sizeof group, "light-%03zu", i + 1);
    for (StatementDescription* statement : byPlace[order[i]]) SetGroup(*statement, group, sceneFile);
  }
}

std::vector<Fader> FadersOf(const EditableScene& scene) {
  const LightingServices& lighting = *scene.Built()->scene.lighting;
  const std::vector<std::string>& layers = lighting.Groups().Layers();
  std::vector<Fader> faders;
  for (const std::string& layer : layers) faders.push_back({layer, layer, {}, false});
  if (faders.empty()) faders.push_back({"", "all lights", {}, false});
  std::vector<size_t> firsts(faders.size(), scene.Statements().size());
  for (size_t i = 0; i < scene.Statements().size(); ++i) {
    const EditableStatement& statement = scene.Statements()[i];
    if (statement.lights.empty()) continue;
    const uint32_t group = lighting.Groups().Of(statement.lights.front());
    faders[group].statements.push_back(i);
    firsts[group] = std::min(firsts[group], i);
  }
  for (Fader& fader : faders) {
    if (fader.layer.starts_with("light-") && fader.statements.size() == 1)
      fader.label = LabelOf(scene, fader.statements.front());
  }
  const auto& media = scene.Built()->scene.media;
  const bool glows = std::any_of(media.begin(), media.end(), [](const auto& medium) { return medium->IsEmissive(); });
  faders[lighting.Groups().OfMedia()].hasGlow = glows;
  // In the order of the scene's file.
  std::vector<size_t> order(faders.size());
  for (size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) { return firsts[a] < firsts[b]; });
  std::vector<Fader> sorted;
  for (const size_t i : order) sorted.push_back(std::move(faders[i]));
  return sorted;
}

std::string LabelOf(const EditableScene& scene, size_t statement) {
  const EditableStatement& of = scene.Statements()[statement];
  const std::string name = scene.ParametersOf(statement).GetString("name", "");
  return name.empty() ? of.type->name : name;
}

std::string PlaceOf(const EditableScene& scene, size_t statement) {
  return PlaceText(scene.Statements()[statement].where);
}

std::vector<ShownParameter> ShownParameters(const EditableScene& scene, size_t statement) {
  const EditableStatement& of = scene.Statements()[statement];
  const ParameterList& list = scene.ParametersOf(statement);
  const std::vector<StatementChange> changes = scene.Changes();
  const auto change = std::find_if(changes.begin(), changes.end(), [&](const StatementChange& each) {
    return each.where.ToString() == of.where.ToString();
  });
  std::vector<ShownParameter> all;
  for (const ParameterInfo& info : of.type->parameters) {
    ShownParameter& shown = all.emplace_back();
    shown.info = &info;
    shown.control = ControlFor(info);
    const Parameter* given = list.Find(info.name);
    shown.isGiven = given != nullptr;
    if (given) {
      ShowGiven(list, *given, shown);
    } else {
      ShowDefault(info, shown);
    }
    const bool hasNumbers = shown.control != ParameterControl::None && shown.control != ParameterControl::Text;
    const bool isLong = shown.numbers.size() > MostValuesOf(info);
    if (hasNumbers && (shown.numbers.empty() || isLong)) {
      shown.control = ParameterControl::None;
      if (isLong) shown.text = std::to_string(shown.numbers.size()) + " numbers";
    }
    if (change == changes.end()) continue;
    shown.isEdited = std::any_of(change->parameters.begin(), change->parameters.end(),
                                 [&](const Parameter& parameter) { return parameter.name == info.name; });
  }
  return all;
}

Parameter EditedParameter(const EditableScene& scene, size_t statement, const std::string& name,
                          const std::vector<double>& numbers, const std::string& text) {
  const EditableStatement& of = scene.Statements()[statement];
  const ParameterInfo* info = InfoOf(of, name);
  if (!info) throw Error("\"" + of.type->name + "\" has no parameter \"" + name + "\"");
  const ParameterControl control = ControlFor(*info);
  const bool isList = NumbersIn(info->defaultValue).size() > MostValuesOf(*info);
  if (control == ParameterControl::None || (control != ParameterControl::Text && isList))
    throw Error("\"" + name + "\" is edited in the scene's file");
  const ParameterList& list = scene.ParametersOf(statement);
  Parameter parameter;
  parameter.name = name;
  parameter.type = control == ParameterControl::Color ? ParameterType::Rgb : info->type;
  parameter.where = list.WhereOf(name);
  parameter.colorSpace = scene.ColorSpaceOf(statement);
  if (control == ParameterControl::Text) {
    if (text.size() > 200 ||
        std::any_of(text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < 32; }))
      throw Error("a short word is wanted");
    parameter.strings = {text};
    return parameter;
  }
  const size_t wanted = MostValuesOf(*info);
  if (numbers.size() != wanted)
    throw Error(wanted == 1 ? "one number is wanted" : std::to_string(wanted) + " numbers are wanted");
  for (const double number : numbers) {
    if (!(std::abs(number) <= 3.4e38)) throw Error("a finite number is wanted");
  }
  if (control == ParameterControl::Switch) {
    parameter.bools = {numbers[0] != 0};
  } else if (control == ParameterControl::Integer) {
    if (numbers[0] != std::round(numbers[0]) || std::abs(numbers[0]) > 2147483647.0)
      throw Error("a whole number is wanted");
    parameter.integers = {static_cast<int64_t>(numbers[0])};
  } else {
    parameter.numbers = numbers;
  }
  return parameter;
}

namespace {

// The parameters that scale one light by a factor.
std::vector<Parameter> ScaledBy(const EditableScene& scene, size_t statement, const Color& factor) {
  const EditableStatement& of = scene.Statements()[statement];
  const ParameterList& list = scene.ParametersOf(statement);
  if (!InfoOf(of, "intensity") || !InfoOf(of, "color"))
    throw Error(of.where, "\"" + of.type->name + "\" has no intensity and color that a fader could be set into");
  for (const ParameterList& original : of.originals) {
    const ParameterList& first = of.originals.front();
    const auto colorOf = [](const ParameterList& of) {
      return of.FindColor("color", SpectrumRole::Illuminant).value_or(Color(1.0f));
    };
    if (original.GetFloat("intensity", 1) != first.GetFloat("intensity", 1) || colorOf(original) != colorOf(first))
      throw Error(of.where,
                  "the statement makes lights of several intensities or colors, which one factor cannot be set into");
  }
  const auto make = [&](const char* name, ParameterType type, std::vector<double> numbers) {
    Parameter parameter;
    parameter.name = name;
    parameter.type = type;
    parameter.where = list.WhereOf(name);
    parameter.colorSpace = scene.ColorSpaceOf(statement);
    parameter.numbers = std::move(numbers);
    return parameter;
  };
  const double strength = static_cast<double>(factor.Max());
  std::vector<Parameter> parameters = {
      make("intensity", ParameterType::Float, {list.GetFloat("intensity", 1) * strength})};
  if (strength == 0 || factor == Color(factor.r)) return parameters;
  if (scene.ColorSpaceOf(statement) != RgbColorSpace::Srgb)
    throw Error(of.where,
                "a tint is set into lights whose colours are sRGB; this one is under ColorSpace: edit its color");
  const Color color = list.FindColor("color", SpectrumRole::Illuminant).value_or(Color(1.0f));
  std::vector<double> tinted;
  for (const auto& [own, tint] : {std::pair(color.r, factor.r), {color.g, factor.g}, {color.b, factor.b}})
    tinted.push_back(static_cast<double>(own) * static_cast<double>(tint) / strength);
  parameters.push_back(make("color", ParameterType::Rgb, tinted));
  return parameters;
}

}  // namespace

std::vector<StatementEdit> EditsOf(const EditableScene& scene, const std::vector<Fader>& faders,
                                   const std::vector<Color>& factors) {
  std::vector<StatementEdit> edits;
  for (size_t i = 0; i < faders.size(); ++i) {
    if (factors[i] == Color(1.0f)) continue;
    for (const size_t statement : faders[i].statements)
      edits.push_back({statement, ScaledBy(scene, statement, factors[i])});
  }
  return edits;
}

}  // namespace lampyr
