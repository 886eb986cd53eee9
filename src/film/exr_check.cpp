// OpenEXR allocates the announced size of a header attribute before it notices that the file is shorter. The header is
// therefore walked first: attributes with a name, a type, a size and that many bytes, up to an empty name (OpenEXR File
// Layout; a file of several parts has one header after the other, up to an empty one).
#include <cstdint>
#include <fstream>
#include <string>

#include "base/error.h"
#include "film/image_formats.h"

namespace lampyr {

namespace {

// Little-endian, as everything in the format.
uint32_t ReadNumber(std::istream& file) {
  uint32_t number = 0;
  for (int i = 0; i < 4; ++i) number |= static_cast<uint32_t>(file.get() & 0xff) << (8 * i);
  return number;
}

// Reads up to a NUL. False at the end of the file, or for a text longer than any name, which is left to the library.
bool ReadName(std::istream& file, std::string& name) {
  constexpr size_t longest = 256;
  name.clear();
  for (int c = file.get(); c > 0 && name.size() < longest; c = file.get()) name += static_cast<char>(c);
  return file.good() && name.size() < longest;
}

}  // namespace

void CheckExrHeader(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  file.seekg(0, std::ios::end);
  const auto fileSize = static_cast<uint64_t>(file.tellg());
  file.seekg(4);
  constexpr uint32_t severalParts = 0x1000;
  const bool hasParts = (ReadNumber(file) & severalParts) != 0;
  std::string name, type;
  bool isEmpty = true;  // nothing in this header yet
  while (ReadName(file, name)) {
    if (name.empty() && (!hasParts || isEmpty)) return;
    isEmpty = name.empty();
    if (isEmpty) continue;  // the next header
    if (!ReadName(file, type)) return;
    const uint32_t size = ReadNumber(file);
    if (!file.good()) return;
    const auto position = static_cast<uint64_t>(file.tellg());
    if (size > fileSize - position) {
      throw Error("cannot read image \"" + path.string() + "\": its attribute \"" + name + "\" announces " +
                  std::to_string(size) + " bytes, more than the file holds");
    }
    file.seekg(static_cast<std::streamoff>(position + size));
  }
}

}  // namespace lampyr
