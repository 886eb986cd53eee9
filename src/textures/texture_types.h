// Private to textures/: the table of texture types.
#pragma once

#include <string>
#include <vector>

#include "textures/texture_families.h"

namespace lampyr {

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
