// The tokens of a scene file and of the files that it includes as a single stream. Internal to scene/.
#pragma once

#include <filesystem>
#include <optional>
#include <set>
#include <vector>

#include "scene/lexer.h"
#include "scene/text_file.h"

namespace lampyr {

class TokenStream {
 public:
  explicit TokenStream(const std::filesystem::path& sceneFile);

  // Opens a text, whose tokens come before the rest of the current file.
  void OpenText(const std::filesystem::path& file, std::string text);
  // Opens the file that the string token `name` names: relative to the scene file, or otherwise to the file that
  // contains `name`. Throws an Error if it cannot be read, or is already open (a cycle). Returns its canonical path.
  std::filesystem::path OpenFile(const Token& name);

  // The next token. End only at the bottom of the stack: the end of an included file is skipped.
  Token Next();
  void PutBack(Token token) { waiting_ = std::move(token); }

  // Makes the current file the bottom of the stack until RestoreBottom: an imported file is parsed on its own.
  size_t SetBottom();
  void RestoreBottom(size_t bottom);

  // The lexer of the current file, for lists of numbers. No token may have been put back.
  Lexer& Current() { return files_.back().lexer; }

  const std::shared_ptr<const std::string>& SceneFile() const { return sceneFile_; }
  std::string HashOfAll() const { return hash_.Hex(); }
  // The scene file and those that it included or imported, without duplicates.
  std::vector<std::string> Files() const;

 private:
  struct OpenedFile {
    Lexer lexer;
    std::filesystem::path canonical;
  };
  std::shared_ptr<const std::string> sceneFile_;
  std::vector<OpenedFile> files_;
  size_t bottom_ = 0;
  std::optional<Token> waiting_;
  ContentHash hash_;
  size_t named_ = 0;                      // number of files opened by Include and Import
  std::set<std::filesystem::path> seen_;  // their canonical paths
  uint64_t repeated_ = 0;                 // bytes of files opened repeatedly

  void CheckNotOpen(const std::filesystem::path& file, const std::filesystem::path& canonical,
                    const FileLocation& where) const;
};

}  // namespace lampyr
