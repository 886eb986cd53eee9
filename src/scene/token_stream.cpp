#include "scene/token_stream.h"

#include <system_error>
#include <utility>

#include "scene/limits.h"
#include "scene/scene_paths.h"

namespace lampyr {

namespace {

std::filesystem::path Canonical(const std::filesystem::path& file) {
  std::error_code failed;
  const std::filesystem::path canonical = std::filesystem::weakly_canonical(file, failed);
  return failed ? file.lexically_normal() : canonical;
}

}  // namespace

TokenStream::TokenStream(const std::filesystem::path& sceneFile)
    : sceneFile_(std::make_shared<const std::string>(sceneFile.string())) {}

void TokenStream::OpenText(const std::filesystem::path& file, std::string text) {
  hash_.Add(text);
  auto name = files_.empty() ? sceneFile_ : std::make_shared<const std::string>(file.string());
  files_.push_back({Lexer(std::move(name), std::move(text)), Canonical(file)});
}

std::filesystem::path TokenStream::OpenFile(const Token& name) {
  if (name.text.empty()) throw Error(name.where, "the file's name is empty");
  const std::filesystem::path file = FindSceneFile(name.text, *name.where.file, *sceneFile_);
  const std::filesystem::path canonical = Canonical(file);
  CheckNotOpen(file, canonical, name.where);
  if (++named_ > limits::kNamedFiles) {
    throw Error(name.where,
                "files are included more than 50000 times in all; what repeats can be an object "
                "(ObjectBegin) with instances");
  }
  std::string text = ReadTextFile(file, name.where);
  if (!seen_.insert(canonical).second) repeated_ += text.size();
  if (repeated_ > limits::kRepeatedText) {
    throw Error(name.where,
                "files that are included again make more than 1 GiB of text; what repeats can be an object "
                "(ObjectBegin) with instances");
  }
  OpenText(file, std::move(text));
  return canonical;
}

void TokenStream::CheckNotOpen(const std::filesystem::path& file, const std::filesystem::path& canonical,
                               const FileLocation& where) const {
  if (files_.size() >= limits::kOpenFiles) throw Error(where, "files are nested more than 256 deep");
  std::string chain;
  for (const OpenedFile& open : files_) {
    if (chain.empty() && open.canonical != canonical) continue;
    chain += *open.lexer.Name() + " -> ";
  }
  if (!chain.empty()) throw Error(where, "a file that includes itself: " + chain + file.string());
}

Token TokenStream::Next() {
  if (waiting_) return *std::exchange(waiting_, std::nullopt);
  while (true) {
    Token token = files_.back().lexer.Next();
    if (token.kind != TokenKind::End || files_.size() == bottom_ + 1) return token;
    files_.pop_back();
  }
}

size_t TokenStream::SetBottom() {
  return std::exchange(bottom_, files_.size() - 1);
}

void TokenStream::RestoreBottom(size_t bottom) {
  files_.pop_back();
  bottom_ = bottom;
}

std::vector<std::string> TokenStream::Files() const {
  std::vector<std::string> files = {*sceneFile_};
  for (const std::filesystem::path& file : seen_) files.push_back(file.string());
  return files;
}

}  // namespace lampyr
