// Tokens of a scene file: words, quoted strings, brackets and, on a fast path, numbers. Internal to scene/, but for
// what reads a number, which readers of other text files use.
//
// Lines end with LF or CR LF; columns count bytes from 1. A `#` starts a comment. Strings know the escapes
// \" \\ \' \n \t \r \b \f and end on the line they start on.
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
  std::string text;  // of a string: without quotes, escapes resolved
  FileLocation where;
};

// For messages: `the string "x"`, `"Shape"`, `"["`, `the end of the file`.
std::string Describe(const Token& token);

// The number that `word` is. Throws Errors for what is none, is not finite, or is beyond the range of a float.
double ParseNumber(std::string_view word, const FileLocation& where);
// The same for a whole number that fits 32 bits.
int64_t ParseInteger(std::string_view word, const FileLocation& where);
bool LooksLikeNumber(std::string_view word);
// "nan", "-inf" and the like.
bool IsNonFinite(std::string_view word);
// A word of a text file for messages: quoted, printable, not longer than a line.
std::string ShownWord(std::string_view word);

class Lexer {
 public:
  // `name` stands for the file in messages.
  Lexer(std::shared_ptr<const std::string> name, std::string text);

  Token Next();

  // For lists of numbers: reads one when that is what comes next; otherwise false, and nothing but space is consumed.
  bool TryNumber(double& number);
  bool TryInteger(int64_t& number);

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
