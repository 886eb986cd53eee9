// Private to textures/: the families of textures, one file each, and the input of their factories.
#pragma once

#include <memory>
#include <string>
#include <type_traits>
#include <vector>

#include "scene/scene_description.h"
#include "textures/mapping.h"
#include "textures/texture.h"
#include "textures/texture_library.h"

namespace lampyr {

// Input of a factory: one Texture statement. `role` determines how spectra among the parameters become RGB.
struct TextureRequest {
  const TextureDescription& description;
  const TextureLibrary& library;  // contains the preceding textures
  Affine renderToTexture;
  SpectrumRole role = SpectrumRole::Albedo;
  Diagnostics& diagnostics;

  const ParameterList& Parameters() const { return description.texture.parameters; }
};

// A parameter of the texture's own value type, possibly a texture itself.
template <class Value>
ParameterOf<Value> GetValue(const TextureRequest& request, const std::string& name, float defaultGray) {
  if constexpr (std::is_same_v<Value, float>) {
    return request.library.GetFloat(request.Parameters(), name, defaultGray);
  } else {
    return request.library.GetColor(request.Parameters(), name, Color(defaultGray), request.role);
  }
}

// Reads a parameter that cannot be a texture in pbrt.
template <class Value>
Value GetConstant(const TextureRequest& request, const std::string& name, float defaultGray) {
  if constexpr (std::is_same_v<Value, float>) {
    return static_cast<float>(request.Parameters().GetFloat(name, static_cast<double>(defaultGray)));
  } else {
    return request.Parameters().GetColor(name, Color(defaultGray), request.role);
  }
}

TextureMapping2D ReadMapping2D(const TextureRequest& request);

// Factories, which throw located Errors. A texture that does not vary becomes a constant.
template <class Value>
ParameterOf<Value> MakeScale(const TextureRequest& request);
template <class Value>
ParameterOf<Value> MakeMix(const TextureRequest& request);
template <class Value>
ParameterOf<Value> MakeDirectionMix(const TextureRequest& request);
template <class Value>
ParameterOf<Value> MakeBilerp(const TextureRequest& request);
template <class Value>
ParameterOf<Value> MakeCheckerboard(const TextureRequest& request);
template <class Value>
ParameterOf<Value> MakeDots(const TextureRequest& request);
template <class Value>
ParameterOf<Value> MakeImageMap(const TextureRequest& request);
FloatParameter MakeFbm(const TextureRequest& request);
FloatParameter MakeWrinkled(const TextureRequest& request);
FloatParameter MakeWindy(const TextureRequest& request);
ColorParameter MakeMarble(const TextureRequest& request);

// A texture type: its factories as float and as colour (null: pbrt-v4 has no such texture), and its parameters.
struct TextureType {
  const char* name;
  FloatParameter (*makeFloat)(const TextureRequest&);
  ColorParameter (*makeColor)(const TextureRequest&);
  std::vector<std::string> parameters;  // for suggestions
  std::vector<std::string> alsoInPbrt;  // accepted for compatibility, without effect
};

const std::vector<TextureType>& TextureTypes();

}  // namespace lampyr
