#include "fuzz/target_support.h"

#include <stdexcept>

#include "support/temporary_folder.h"

namespace lampyr::fuzz {

std::filesystem::path AsFile(std::string_view bytes, const char* extension) {
  static const TemporaryFolder folder;
  const std::filesystem::path file = folder / (std::string("input") + extension);
  WriteBytes(file, std::string(bytes));
  return file;
}

std::filesystem::path SceneName() {
  return LAMPYR_SOURCE_DIR "/tests/fuzz/files/scene.pbrt";
}

void Fail(const std::string& what) {
  throw std::logic_error(what);
}

}  // namespace lampyr::fuzz
