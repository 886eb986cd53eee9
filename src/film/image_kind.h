// The format of an image file by its content, independent of its name. Private to film/.
#pragma once

#include <cstdint>
#include <filesystem>

namespace lampyr {

struct ImageKind {
  const char* format = "";  // OpenImageIO's name
  int64_t width = 0,
          height = 0;  // from the header, for formats whose readers allocate before they report a size; 0: unknown
};

// Throws an Error that lists the supported formats if the file is of none of them. Other formats of the image library
// are not offered: each further reader would have to withstand damaged files.
ImageKind FindImageKind(const std::filesystem::path& path);

}  // namespace lampyr
