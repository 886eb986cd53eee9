// What an image file is by its content, whatever its name says. Private to the film room.
#pragma once

#include <cstdint>
#include <filesystem>

namespace lampyr {

struct ImageKind {
  const char* format = "";  // OpenImageIO's name
  int64_t width = 0,
          height = 0;  // as the header has them, of formats whose readers take memory before they tell; 0: later
};

// Throws an Error that names the formats that are read when the file is of none of them. The rest of what the image
// library knows is not offered: each reader is one more that has to stand damaged files.
ImageKind FindImageKind(const std::filesystem::path& path);

}  // namespace lampyr
