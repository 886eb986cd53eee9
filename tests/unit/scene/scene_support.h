// Support for the tests of scene files: parsing a text, the message of an error, a folder for files.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>
#include <zlib.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "scene/scene_description.h"
#include "support/temporary_folder.h"

namespace lampyr {

// A scene whose world is `world`; the world's first character is at line 2, column 1.
inline std::string InWorld(const std::string& world) {
  return "WorldBegin\n" + world;
}

inline SceneDescription Parse(const std::string& text) {
  Diagnostics strict(Diagnostics::Mode::Strict);
  return ParseScene(text, "scene.pbrt", strict);
}

inline std::vector<std::string> WarningsOf(const std::string& text) {
  Diagnostics diagnostics(Diagnostics::Mode::Collect);
  ParseScene(text, "scene.pbrt", diagnostics);
  return diagnostics.Warnings();
}

// The whole message of the Error that `action` throws, or "no error".
template <class Action>
std::string ErrorOf(const Action& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

inline std::string ParseError(const std::string& text) {
  Diagnostics diagnostics(Diagnostics::Mode::Collect);
  return ErrorOf([&] { ParseScene(text, "scene.pbrt", diagnostics); });
}

inline std::string ReadError(const std::filesystem::path& file) {
  Diagnostics diagnostics(Diagnostics::Mode::Collect);
  return ErrorOf([&] { ReadScene(file, diagnostics); });
}

// A temporary folder for scenes.
class TemporaryFolder : public ::TemporaryFolder {
 public:
  std::filesystem::path Write(const std::string& name, const std::string& text) const {
    std::filesystem::create_directories((*this / name).parent_path());
    std::ofstream(*this / name, std::ios::binary) << text;
    return *this / name;
  }
  std::filesystem::path WriteGzipped(const std::string& name, const std::string& text) const {
    const std::filesystem::path file = *this / name;
    gzFile stream = gzopen(file.c_str(), "wb");
    gzwrite(stream, text.data(), static_cast<unsigned>(text.size()));
    gzclose(stream);
    return file;
  }
};

inline std::string ReadAll(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

}  // namespace lampyr
