// One row per texture type of pbrt-v4.
#include "textures/texture_families.h"

namespace lampyr {

namespace {

template <class Value>
ParameterOf<Value> MakeConstant(const TextureRequest& request) {
  if constexpr (std::is_same_v<Value, Color>) {
    return ColorParameter(GetConstant<Color>(request, "value", 1),
                          request.Parameters().FindCurve("value", request.role));
  } else {
    return GetConstant<Value>(request, "value", 1);
  }
}

// Middle gray replaces a texture that cannot be read, so that the surface remains visible.
template <class Value>
ParameterOf<Value> MakePtex(const TextureRequest& request) {
  request.diagnostics.Warn(request.description.texture.where,
                           "texture type \"ptex\" is not supported: a constant of 0.5 stands for it");
  for (const char* name : {"filename", "encoding", "scale"}) request.Parameters().Find(name);
  return Value(0.5f);
}

std::vector<std::string> With2DMapping(std::vector<std::string> names) {
  for (const char* name : {"mapping", "uscale", "vscale", "udelta", "vdelta", "v1", "v2"}) names.emplace_back(name);
  return names;
}

}  // namespace

const std::vector<TextureType>& TextureTypes() {
  // Mapping parameters without effect on the chosen mapping are accepted, with a warning.
  static const std::vector<std::string> mapping = With2DMapping({});
  static const std::vector<TextureType> types = {
      {"constant", MakeConstant<float>, MakeConstant<Color>, {"value"}, {}},
      {"scale", MakeScale<float>, MakeScale<Color>, {"tex", "scale"}, {}},
      {"mix", MakeMix<float>, MakeMix<Color>, {"tex1", "tex2", "amount"}, {}},
      {"directionmix", MakeDirectionMix<float>, MakeDirectionMix<Color>, {"tex1", "tex2", "dir"}, {}},
      {"bilerp", MakeBilerp<float>, MakeBilerp<Color>, With2DMapping({"v00", "v01", "v10", "v11"}), mapping},
      {"checkerboard", MakeCheckerboard<float>, MakeCheckerboard<Color>, With2DMapping({"dimension", "tex1", "tex2"}),
       mapping},
      {"dots", MakeDots<float>, MakeDots<Color>, With2DMapping({"inside", "outside"}), mapping},
      {"fbm", MakeFbm, nullptr, {"octaves", "roughness"}, {}},
      {"wrinkled", MakeWrinkled, nullptr, {"octaves", "roughness"}, {}},
      {"windy", MakeWindy, nullptr, {}, {}},
      {"marble", nullptr, MakeMarble, {"octaves", "roughness", "scale", "variation"}, {}},
      {"imagemap", MakeImageMap<float>, MakeImageMap<Color>,
       With2DMapping({"filename", "wrap", "filter", "scale", "invert", "encoding", "maxanisotropy"}),
       With2DMapping({"maxanisotropy"})},
      {"ptex", MakePtex<float>, MakePtex<Color>, {"filename", "encoding", "scale"}, {}},
  };
  return types;
}

}  // namespace lampyr
