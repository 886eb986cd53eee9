#include "scene/scene_copy.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <map>
#include <set>
#include <system_error>

#include "scene/lexer.h"
#include "scene/scene_paths.h"
#include "scene/text_file.h"

namespace lampyr {

namespace {

namespace fs = std::filesystem;

std::string Canonical(const fs::path& file) {
  std::error_code failed;
  const fs::path canonical = fs::weakly_canonical(file, failed);
  return (failed ? file.lexically_normal() : canonical).string();
}

std::string Quoted(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    if (c == '\n') {
      quoted += "\\n";
    } else {
      quoted += c;
    }
  }
  return quoted + "\"";
}

std::string Shortest(double number) {
  std::array<char, 32> buffer{};
  const auto [end, error] = std::to_chars(buffer.data(), buffer.data() + buffer.size(), number);
  return {buffer.data(), end};
}

// The text of one file, and its replacements.
class EditedText {
 public:
  explicit EditedText(const fs::path& file) : text_(ReadTextFile(file, {})) {
    lineStarts_.push_back(0);
    for (size_t i = 0; i < text_.size(); ++i) {
      if (text_[i] == '\n') lineStarts_.push_back(i + 1);
    }
  }

  const std::string& Text() const { return text_; }
  size_t Begin(const Token& token) const {
    return lineStarts_[static_cast<size_t>(token.where.line) - 1] + static_cast<size_t>(token.where.column) - 1;
  }
  size_t End(const Token& token) const {
    const size_t begin = Begin(token);
    if (token.kind == TokenKind::Open || token.kind == TokenKind::Close) return begin + 1;
    if (token.kind == TokenKind::Word) return begin + token.text.size();
    size_t end = begin + 1;
    while (text_[end] != '"') end += text_[end] == '\\' ? 2 : 1;
    return end + 1;
  }
  void Replace(size_t begin, size_t end, std::string by) { parts_.push_back({begin, end, std::move(by)}); }
  bool IsChanged() const { return !parts_.empty(); }

  std::string Result() const {
    std::vector<Part> parts = parts_;
    std::stable_sort(parts.begin(), parts.end(), [](const Part& a, const Part& b) { return a.begin < b.begin; });
    std::string result;
    size_t done = 0;
    for (const Part& part : parts) {
      result += text_.substr(done, part.begin - done) + part.by;
      done = part.end;
    }
    return result + text_.substr(done);
  }

 private:
  struct Part {
    size_t begin, end;
    std::string by;
  };
  std::string text_;
  std::vector<size_t> lineStarts_;
  std::vector<Part> parts_;
};

// The name of a declaration "type name".
std::string NameIn(const std::string& declaration) {
  const size_t last = declaration.find_last_not_of(" \t");
  if (last == std::string::npos) return "";
  const size_t blank = declaration.find_last_of(" \t", last);
  return declaration.substr(blank == std::string::npos ? 0 : blank + 1,
                            last - (blank == std::string::npos ? 0 : blank + 1) + 1);
}

class Copier {
 public:
  Copier(const fs::path& scene, const std::vector<StatementChange>& changes, const std::string& suffix)
      : scene_(scene), suffix_(suffix) {
    for (const StatementChange& change : changes) {
      const std::string file = change.where.file ? *change.where.file : scene.string();
      waiting_[Canonical(file)][{change.where.line, change.where.column}] = &change;
    }
    followsIncludes_ = waiting_.size() > (waiting_.contains(Canonical(scene)) ? 1u : 0u);
  }

  std::vector<CopiedFile> Copy() {
    Visit(scene_, true);
    for (const auto& [file, changes] : waiting_) {
      if (!changes.empty()) throw Error(changes.begin()->second->where, "there is no such statement any more");
    }
    return std::move(copies_);
  }

 private:
  using Place = std::pair<int, int>;

  // Adds the copy of the file, and returns its path; nullopt: no copy is needed.
  std::optional<fs::path> Visit(const fs::path& file, bool isScene) {
    const std::string canonical = Canonical(file);
    const auto [known, isNew] = copyOf_.emplace(canonical, std::nullopt);
    if (!isNew) return known->second;
    EditedText edited(file);
    auto changes = waiting_.find(canonical);
    Lexer lexer(std::make_shared<const std::string>(file.string()), edited.Text());
    for (Token token = lexer.Next(); token.kind != TokenKind::End;) {
      Token next = lexer.Next();
      if (token.kind == TokenKind::Word) {
        if ((token.text == "Include" || token.text == "Import") && next.kind == TokenKind::String && followsIncludes_)
          FollowInclude(edited, next, file);
        if (changes != waiting_.end()) {
          const auto change = changes->second.find({token.where.line, token.where.column});
          if (change != changes->second.end()) {
            next = Change(edited, lexer, next, *change->second);
            changes->second.erase(change);
          }
        }
      }
      token = std::move(next);
    }
    if (!isScene && !edited.IsChanged()) return std::nullopt;
    const fs::path path = PathOfCopy(file, suffix_);
    for (const CopiedFile& other : copies_) {
      if (other.path == path)
        throw Error("\"" + file.string() + "\" and \"" + other.original.string() +
                    "\" would have one copy: give one of them another name");
    }
    copies_.push_back({path, file, edited.Result()});
    return copyOf_[canonical] = path;
  }

  void FollowInclude(EditedText& edited, const Token& name, const fs::path& writer) {
    const fs::path file = FindSceneFile(name.text, writer.string(), scene_.string());
    const std::optional<fs::path> copy = Visit(file, false);
    if (!copy) return;
    // A file that is included under two names has one copy.
    const fs::path written = *copy == PathOfCopy(file, suffix_) ? PathOfCopy(name.text, suffix_) : fs::absolute(*copy);
    edited.Replace(edited.Begin(name), edited.End(name), Quoted(written.string()));
  }

  // Changes the statement whose type is `type`; returns the first token behind it.
  Token Change(EditedText& edited, Lexer& lexer, const Token& type, const StatementChange& change) {
    if (type.kind != TokenKind::String) throw Error(change.where, "there is no such statement any more");
    std::set<std::string> given;
    Token token = lexer.Next();
    while (token.kind == TokenKind::String) {
      const Token declaration = token;
      Token last = lexer.Next();
      if (last.kind == TokenKind::Open) {
        while (last.kind != TokenKind::Close && last.kind != TokenKind::End) last = lexer.Next();
      }
      const std::string name = NameIn(declaration.text);
      given.insert(name);
      for (const Parameter& parameter : change.parameters) {
        if (parameter.name == name) edited.Replace(edited.Begin(declaration), edited.End(last), Written(parameter));
      }
      token = lexer.Next();
    }
    std::string added;
    for (const Parameter& parameter : change.parameters) {
      if (given.contains(parameter.name)) continue;
      added += " " + Written(parameter);
    }
    if (!added.empty()) edited.Replace(edited.End(type), edited.End(type), added);
    return token;
  }

  const fs::path scene_;
  const std::string suffix_;
  std::map<std::string, std::map<Place, const StatementChange*>> waiting_;  // by canonical file
  std::map<std::string, std::optional<fs::path>> copyOf_;
  bool followsIncludes_ = false;  // statements of included files are changed
  std::vector<CopiedFile> copies_;
};

}  // namespace

std::filesystem::path PathOfCopy(const std::filesystem::path& original, const std::string& suffix) {
  std::filesystem::path stem = original.filename();
  if (stem.extension() == ".gz") stem = stem.stem();
  if (stem.extension() == ".pbrt") stem = stem.stem();
  return original.parent_path() / (stem.string() + suffix + ".pbrt");
}

std::string Written(const Parameter& parameter) {
  std::string values;
  for (const double number : parameter.numbers) values += " " + Shortest(number);
  for (const int64_t number : parameter.integers) values += " " + std::to_string(number);
  for (const bool value : parameter.bools) values += value ? " true" : " false";
  for (const std::string& text : parameter.strings) values += " " + Quoted(text);
  const std::string declaration = Quoted(std::string(ToString(parameter.type)) + " " + parameter.name);
  return parameter.ValueCount() == 1 ? declaration + values : declaration + " [" + values + " ]";
}

std::vector<CopiedFile> CopyScene(const std::filesystem::path& scene, const std::vector<StatementChange>& changes,
                                  const std::string& suffix) {
  return Copier(scene, changes, suffix).Copy();
}

}  // namespace lampyr
