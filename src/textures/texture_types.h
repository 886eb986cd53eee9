// Private to the textures room: the table of texture types.
#pragma once

#include <string>
#include <vector>

#include "textures/texture_families.h"

namespace lampyr {

// A row: what makes the type as float and as colour (null: pbrt-v4 has no such texture), and its parameters.
struct TextureType {
  const char* name;
  FloatParameter (*makeFloat)(const TextureRequest&);
  ColorParameter (*makeColor)(const TextureRequest&);
  std::vector<std::string> parameters;  // for suggestions
  std::vector<std::string> alsoInPbrt;  // known there, without effect here
};

const std::vector<TextureType>& TextureTypes();

}  // namespace lampyr
