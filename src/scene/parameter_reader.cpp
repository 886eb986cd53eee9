#include "scene/parameter_reader.h"

#include <algorithm>
#include <optional>

#include "scene/limits.h"

namespace lampyr {

namespace {

const std::vector<std::string>& TypeNames() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> list;
    for (int i = 0; i <= static_cast<int>(ParameterType::Texture); ++i)
      list.push_back(ToString(static_cast<ParameterType>(i)));
    return list;
  }();
  return names;
}

// The pbrt-v4 name of a parameter type as pbrt-v3 and others call it; null if unknown.
const char* ModernName(const std::string& type) {
  constexpr const char* kOld[][2] = {
      {"color", "rgb"},    {"point", "point3"}, {"vector", "vector3"}, {"normal3", "normal"}, {"int", "integer"},
      {"boolean", "bool"}, {"xyz", "rgb"},      {"double", "float"},   {"point4", "point3"},  {"str", "string"}};
  for (const auto& [old, modern] : kOld) {
    if (type == old) return modern;
  }
  return nullptr;
}

ParameterType FindType(const std::string& type, const FileLocation& where) {
  const std::vector<std::string>& names = TypeNames();
  for (size_t i = 0; i < names.size(); ++i) {
    if (names[i] == type) return static_cast<ParameterType>(i);
  }
  const char* modern = ModernName(type);
  throw Error(where, "there is no parameter type \"" + type + "\"" +
                         (modern ? " (did you mean \"" + std::string(modern) + "\"?)" : DidYouMean(type, names)));
}

// Splits "type name".
Parameter ReadDeclaration(const Token& token) {
  constexpr const char* kBlank = " \t";
  const std::string& text = token.text;
  const size_t typeBegin = text.find_first_not_of(kBlank);
  const size_t typeEnd = typeBegin == std::string::npos ? typeBegin : text.find_first_of(kBlank, typeBegin);
  const size_t nameBegin = typeEnd == std::string::npos ? typeEnd : text.find_first_not_of(kBlank, typeEnd);
  if (nameBegin == std::string::npos) {
    throw Error(token.where, "expected a parameter \"type name\", found " + Describe(token));
  }
  const size_t nameEnd = std::min(text.find_first_of(kBlank, nameBegin), text.size());
  if (text.find_first_not_of(kBlank, nameEnd) != std::string::npos) {
    throw Error(token.where, "a parameter is \"type name\", and " + Describe(token) + " has more than that");
  }
  Parameter parameter;
  parameter.name = text.substr(nameBegin, nameEnd - nameBegin);
  parameter.where = token.where;
  parameter.type = FindType(text.substr(typeBegin, typeEnd - typeBegin), token.where);
  return parameter;
}

enum class ValueKind { Number, Integer, Bool, String };

ValueKind KindOf(ParameterType type) {
  switch (type) {
    case ParameterType::Integer:
      return ValueKind::Integer;
    case ParameterType::Bool:
      return ValueKind::Bool;
    case ParameterType::String:
    case ParameterType::Texture:
      return ValueKind::String;
    default:
      return ValueKind::Number;
  }
}

const char* KindName(ValueKind kind) {
  switch (kind) {
    case ValueKind::Number:
      return "a number";
    case ValueKind::Integer:
      return "integer";
    case ValueKind::Bool:
      return "true or false";
    case ValueKind::String:
      return "a string";
  }
  return "";
}

void AddValue(Parameter& parameter, ValueKind kind, Token token) {
  const std::string& text = token.text;
  const bool isWord = token.kind == TokenKind::Word, isString = token.kind == TokenKind::String;
  if (kind == ValueKind::String && isString) {
    parameter.strings.push_back(std::move(token.text));
  } else if (kind == ValueKind::Bool && (isWord || isString) && (text == "true" || text == "false")) {
    parameter.bools.push_back(text == "true");
  } else if (kind == ValueKind::Integer && isWord && LooksLikeNumber(text)) {
    parameter.integers.push_back(ParseInteger(text, token.where));
  } else if (kind == ValueKind::Number && isWord && text != "true" && text != "false") {
    parameter.numbers.push_back(ParseNumber(text, token.where));
  } else {
    throw Error(token.where, "\"" + std::string(ToString(parameter.type)) + " " + parameter.name + "\": expected " +
                                 KindName(kind) + ", found " + Describe(token));
  }
}

// A spectrum is a list of numbers or of names: the first value decides.
ValueKind KindOfValue(const Parameter& parameter, const Token& token) {
  if (parameter.type != ParameterType::Spectrum) return KindOf(parameter.type);
  if (!parameter.strings.empty()) return ValueKind::String;
  if (!parameter.numbers.empty()) return ValueKind::Number;
  return token.kind == TokenKind::String ? ValueKind::String : ValueKind::Number;
}

template <class T>
void GiveBackSpareMemory(std::vector<T>& values) {
  if (values.capacity() > values.size() + values.size() / 4) values.shrink_to_fit();
}

void ReadList(Lexer& lexer, Parameter& parameter, const FileLocation& open) {
  const bool numbers = KindOf(parameter.type) == ValueKind::Number;
  while (true) {
    // Fast paths for numbers, which are most of the text of a large scene.
    if (numbers && parameter.strings.empty()) {
      for (double value = 0; lexer.TryNumber(value);) parameter.numbers.push_back(value);
    } else if (parameter.type == ParameterType::Integer) {
      for (int64_t value = 0; lexer.TryInteger(value);) parameter.integers.push_back(value);
    }
    Token token = lexer.Next();
    if (token.kind == TokenKind::Close) break;
    if (token.kind == TokenKind::End) throw Error(open, "this list has no \"]\" before the end of the file");
    const ValueKind kind = KindOfValue(parameter, token);
    AddValue(parameter, kind, std::move(token));
  }
  GiveBackSpareMemory(parameter.numbers);
  GiveBackSpareMemory(parameter.integers);
}

}  // namespace

namespace {

// Removes an earlier parameter of the same name, as pbrt-v4 does.
void RemoveEarlier(std::vector<Parameter>& parameters, const Parameter& parameter, Diagnostics& diagnostics) {
  const auto earlier = std::find_if(parameters.begin(), parameters.end(),
                                    [&](const Parameter& other) { return other.name == parameter.name; });
  if (earlier == parameters.end()) return;
  if (earlier->type != parameter.type) {
    throw Error(parameter.where, "\"" + parameter.name + "\" is given twice, with two types; the first is at " +
                                     earlier->where.ToString());
  }
  diagnostics.Warn(parameter.where, "\"" + parameter.name + "\" is given twice; the value at " +
                                        earlier->where.ToString() + " is not used");
  parameters.erase(earlier);
}

}  // namespace

std::vector<Parameter> ReadParameters(TokenStream& tokens, RgbColorSpace colorSpace, Diagnostics& diagnostics) {
  std::vector<Parameter> parameters;
  while (true) {
    Token token = tokens.Next();
    if (token.kind != TokenKind::String) {
      tokens.PutBack(std::move(token));
      return parameters;
    }
    Parameter parameter = ReadDeclaration(token);
    if (parameters.size() == limits::kParameters)
      throw Error(parameter.where, "a statement has at most 1000 parameters");
    parameter.colorSpace = colorSpace;
    RemoveEarlier(parameters, parameter, diagnostics);
    Token value = tokens.Next();
    if (value.kind == TokenKind::Open) {
      ReadList(tokens.Current(), parameter, value.where);
    } else {
      const ValueKind kind = KindOfValue(parameter, value);
      AddValue(parameter, kind, std::move(value));
    }
    parameters.push_back(std::move(parameter));
  }
}

}  // namespace lampyr
