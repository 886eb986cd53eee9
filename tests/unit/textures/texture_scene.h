// Texture statements made in memory, as the scene reader would make them, and a library of them.
#pragma once

#include <initializer_list>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "textures/texture_library.h"

namespace lampyr {

inline const std::shared_ptr<const std::string> kTestFile = std::make_shared<const std::string>("test.pbrt");

inline Parameter FloatValue(const std::string& name, double value) {
  Parameter p;
  p.type = ParameterType::Float;
  p.name = name;
  p.numbers = {value};
  return p;
}
inline Parameter IntegerValue(const std::string& name, int64_t value) {
  Parameter p;
  p.type = ParameterType::Integer;
  p.name = name;
  p.integers = {value};
  return p;
}
inline Parameter BoolValue(const std::string& name, bool value) {
  Parameter p;
  p.type = ParameterType::Bool;
  p.name = name;
  p.bools = {value};
  return p;
}
inline Parameter Text(ParameterType type, const std::string& name, const std::string& value) {
  Parameter p;
  p.type = type;
  p.name = name;
  p.strings = {value};
  return p;
}
inline Parameter StringValue(const std::string& name, const std::string& value) {
  return Text(ParameterType::String, name, value);
}
inline Parameter TextureName(const std::string& name, const std::string& value) {
  return Text(ParameterType::Texture, name, value);
}
inline Parameter RgbValue(const std::string& name, double r, double g, double b) {
  Parameter p;
  p.type = ParameterType::Rgb;
  p.name = name;
  p.numbers = {r, g, b};
  return p;
}
inline Parameter VectorValue(const std::string& name, double x, double y, double z) {
  Parameter p = RgbValue(name, x, y, z);
  p.type = ParameterType::Vector3;
  return p;
}

// Places: line `line`, columns by parameter, so that messages can be checked.
inline ParameterList MakeParameters(std::vector<Parameter> parameters, int line = 1) {
  for (size_t i = 0; i < parameters.size(); ++i) {
    parameters[i].where = {kTestFile, line, 10 * static_cast<int>(i + 1)};
  }
  return {{kTestFile, line, 1}, "Texture", std::move(parameters)};
}

inline TextureDescription MakeTexture(const std::string& name, bool isSpectrum, const std::string& type,
                                      std::vector<Parameter> parameters, int line = 1,
                                      const Transform& transform = {}) {
  TextureDescription description;
  description.name = name;
  description.isSpectrum = isSpectrum;
  description.texture.type = type;
  description.texture.where = {kTestFile, line, 1};
  description.texture.parameters = MakeParameters(std::move(parameters), line);
  description.placement = {transform, transform};
  return description;
}

// A library, its warnings, and the parameter that the texture "t" gives.
struct TextureScene {
  explicit TextureScene(std::vector<TextureDescription> textures, const Transform& worldToRender = {})
      : descriptions(std::move(textures)), library(descriptions, worldToRender, diagnostics) {}
  TextureScene(const std::string& type, bool isSpectrum, std::vector<Parameter> parameters,
               const Transform& transform = {})
      : TextureScene({MakeTexture("t", isSpectrum, type, std::move(parameters), 1, transform)}) {}

  FloatParameter Float() const { return library.GetFloat(MakeParameters({TextureName("p", "t")}), "p", -1); }
  ColorParameter Spectrum(SpectrumRole role = SpectrumRole::Unbounded) const {
    return library.GetColor(MakeParameters({TextureName("p", "t")}), "p", Color(-1.0f), role);
  }
  float FloatAt(float u, float v, const Point3& position = Point3(0.0f)) const {
    return Float().Evaluate({{u, v}, position});
  }
  Color ColorAt(float u, float v, const Point3& position = Point3(0.0f)) const {
    return Spectrum().Evaluate({{u, v}, position});
  }

  Diagnostics diagnostics{Diagnostics::Mode::Collect};
  std::vector<TextureDescription> descriptions;
  TextureLibrary library;
};

// The message of the Error that making these textures throws, "" when none.
inline std::string ErrorOf(std::vector<TextureDescription> textures) {
  try {
    TextureScene scene(std::move(textures));
  } catch (const Error& e) {
    return e.what();
  }
  return "";
}

}  // namespace lampyr
