// Tokens of a scene file: words, quoted strings, brackets and, on a fast path, numbers. Internal to scene/, except for
// the functions that read a number, which readers of other text files use.
//
// Lines end with LF or CR LF; columns count bytes from 1. `#` starts a comment. Strings end on the line on which they
// start and know the escapes
//   \" \\ \' \n \t \r \b \f
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "base/error.h"

namespace lampyr {

enum class TokenKind { End, Word, String, Open, Close };  // Word: a statement, true, false or a number

struct Token {
  TokenKind kind = TokenKind::End;
  std::string text;  // strings: without quotes, escapes resolved
  FileLocation where;
};

// For messages: `the string "x"`, `"Shape"`, `"["`, `the end of the file`.
std::string Describe(const Token& token);

// The number that `word` denotes. Throws an Error if it is not a number, not finite, or beyond the range of a float.
double ParseNumber(std::string_view word, const FileLocation& where);
// The 32-bit integer that `word` denotes. Throws an Error as ParseNumber does.
int64_t ParseInteger(std::string_view word, const FileLocation& where);
bool LooksLikeNumber(std::string_view word);
// True for "nan", "-inf" and similar words.
bool IsNonFinite(std::string_view word);
// A word of a text file for messages: quoted, cut to 32 characters, with a question mark for everything but printable
// ASCII.
std::string ShownWord(std::string_view word);

class Lexer {
 public:
  // `name` stands for the file in messages.
  Lexer(std::shared_ptr<const std::string> name, std::string text);

  Token Next();

  // For lists of numbers: reads a number if one follows. Otherwise returns false, and only white space and comments are
  // consumed.
  bool TryNumber(double& number);
  bool TryInteger(int64_t& number);

  int Line() const { return line_; }  // of what was read last, from 1
  const std::string& Text() const { return text_; }
  const std::shared_ptr<const std::string>& Name() const { return name_; }

 private:
  std::shared_ptr<const std::string> name_;
  std::string text_;
  size_t position_ = 0;
  size_t lineStart_ = 0;
  int line_ = 1;

  FileLocation At(size_t position) const;
  void SkipSpaceAndComments();
  std::string_view WordAt(size_t begin) const;
  Token ReadString();
  char ReadEscape(const FileLocation& where);
  void CheckUtf8(size_t begin, size_t end) const;
};

}  // namespace lampyr
