#include "extremes/light_files.h"

#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "film/image.h"

namespace lampyr::test {

namespace {

// A folder of this process, because tests run in parallel. Removed when the process ends.
struct Folder {
  Folder() : path(std::filesystem::temp_directory_path() / ("lampyr-extremes-" + std::to_string(getpid()))) {
    std::filesystem::create_directories(path);
  }
  ~Folder() { std::filesystem::remove_all(path); }
  std::filesystem::path path;
};

std::filesystem::path PathOf(const std::string& name) {
  static const Folder folder;
  return folder.path / name;
}

}  // namespace

std::string WriteTexels(const std::string& name, int width, int height, const std::function<float(int, int)>& texel) {
  Image image(width, height, {"R", "G", "B"});
  for (int i = 0; i < width * height; ++i) {
    for (size_t c = 0; c < 3; ++c) image.At(i % width, i / width, c) = texel(i % width, i / width);
  }
  const std::filesystem::path file = PathOf(name + ".exr");
  WriteExr(file, image, ExrPrecision::Float);
  return file.string();
}

std::string WriteText(const std::string& name, const std::string& text) {
  const std::filesystem::path file = PathOf(name);
  std::ofstream(file) << text;
  return file.string();
}

}  // namespace lampyr::test
