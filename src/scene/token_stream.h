// The tokens of a scene file and of the files that it includes, as one stream. Internal to scene/.
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

  // Opens a text; its tokens come before what is left of the file that is read now.
  void OpenText(const std::filesystem::path& file, std::string text);
  // The same for a file that the string `name` asks for: looked for beside the scene's file, then beside the one that
  // asks. Throws when it cannot be read or is being read already. Gives its canonical path.
  std::filesystem::path OpenFile(const Token& name);

  // End: the bottom of the stack is reached; an included file's end is passed over.
  Token Next();
  void PutBack(Token token) { waiting_ = std::move(token); }

  // Below this nothing is read until the mark is lifted: an imported file stands for itself.
  size_t SetBottom();
  void RestoreBottom(size_t bottom);

  // The lexer of the file that is read now, for lists of numbers. Nothing may have been put back.
  Lexer& Current() { return files_.back().lexer; }

  const std::shared_ptr<const std::string>& SceneFile() const { return sceneFile_; }
  std::string HashOfAll() const { return hash_.Hex(); }
  // The scene's file and those that it included or imported, each once.
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
  size_t named_ = 0;                      // files, by Include and Import
  std::set<std::filesystem::path> seen_;  // of those, canonical
  uint64_t repeated_ = 0;                 // bytes of files that were seen before

  void CheckNotOpen(const std::filesystem::path& file, const std::filesystem::path& canonical,
                    const FileLocation& where) const;
};

}  // namespace lampyr
