#include "scene/lexer.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <limits>

namespace lampyr {

namespace {

bool IsSpace(char c) {
  return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\v' || c == '\f';
}
bool EndsWord(char c) {
  return IsSpace(c) || c == '"' || c == '[' || c == ']' || c == '#';
}
bool StartsNumber(char c) {
  return (c >= '0' && c <= '9') || c == '-' || c == '+' || c == '.';
}

// Length of the UTF-8 sequence at the start of `s`; 0 if it is invalid (including overlong forms and surrogates).
size_t Utf8Length(std::string_view s) {
  const auto byte = [&](size_t i) { return i < s.size() ? static_cast<unsigned char>(s[i]) : 0u; };
  const auto continues = [&](size_t i) { return (byte(i) & 0xc0u) == 0x80u; };
  const unsigned first = byte(0);
  if (first < 0x80u) return 1;
  if (first >= 0xc2u && first <= 0xdfu) return continues(1) ? 2 : 0;
  if ((first & 0xf0u) == 0xe0u) {
    const bool bad = (first == 0xe0u && byte(1) < 0xa0u) || (first == 0xedu && byte(1) > 0x9fu);
    return !bad && continues(1) && continues(2) ? 3 : 0;
  }
  if (first >= 0xf0u && first <= 0xf4u) {
    const bool bad = (first == 0xf0u && byte(1) < 0x90u) || (first == 0xf4u && byte(1) > 0x8fu);
    return !bad && continues(1) && continues(2) && continues(3) ? 4 : 0;
  }
  return 0;
}

std::string Quoted(std::string_view text) {
  constexpr size_t kLongest = 60;
  if (text.size() <= kLongest) return "\"" + std::string(text) + "\"";
  return "\"" + std::string(text.substr(0, kLongest)) + "…\"";
}

}  // namespace

bool IsNonFinite(std::string_view word) {
  if (!word.empty() && (word[0] == '-' || word[0] == '+')) word.remove_prefix(1);
  std::string lower;
  for (const char c : word.substr(0, 8)) lower += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return lower == "nan" || lower == "inf" || lower == "infinity";
}

std::string Describe(const Token& token) {
  switch (token.kind) {
    case TokenKind::End:
      return "the end of the file";
    case TokenKind::String:
      return "the string " + Quoted(token.text);
    case TokenKind::Open:
      return "\"[\"";
    case TokenKind::Close:
      return "\"]\"";
    case TokenKind::Word:
      break;
  }
  return (LooksLikeNumber(token.text) ? "the number " : "") + Quoted(token.text);
}

bool LooksLikeNumber(std::string_view word) {
  if (word.empty() || !StartsNumber(word[0])) return false;
  return word.find_first_of("0123456789") != std::string_view::npos;
}

std::string ShownWord(std::string_view word) {
  std::string text(word.substr(0, 32));
  for (char& c : text) {
    if (c < ' ' || c > '~') c = '?';
  }
  return "\"" + text + (word.size() > 32 ? "…\"" : "\"");
}

double ParseNumber(std::string_view word, const FileLocation& where) {
  if (IsNonFinite(word)) throw Error(where, Quoted(word) + " is not a finite number");
  std::string_view digits = word;
  if (!digits.empty() && digits[0] == '+') digits.remove_prefix(1);
  const bool signTwice = digits.size() < word.size() && !digits.empty() && digits[0] == '-';
  double value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (signTwice || error == std::errc::invalid_argument || end != digits.data() + digits.size()) {
    throw Error(where, "expected a number, found " + Quoted(word));
  }
  // from_chars reports underflow and overflow alike; underflow becomes 0.
  if (error == std::errc::result_out_of_range) value = std::strtod(std::string(digits).c_str(), nullptr);
  if (!(std::abs(value) <= static_cast<double>(std::numeric_limits<float>::max()))) {
    throw Error(where, "the number " + std::string(word) + " is too large (at most 3.4e38)");
  }
  return value;
}

int64_t ParseInteger(std::string_view word, const FileLocation& where) {
  if (IsNonFinite(word)) throw Error(where, Quoted(word) + " is not a finite number");
  std::string_view digits = word;
  if (!digits.empty() && digits[0] == '+') digits.remove_prefix(1);
  const bool signTwice = digits.size() < word.size() && !digits.empty() && digits[0] == '-';
  int64_t value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (signTwice || error == std::errc::invalid_argument || end != digits.data() + digits.size()) {
    throw Error(where, "expected integer, found " + Quoted(word));
  }
  const bool fits = value >= std::numeric_limits<int32_t>::min() && value <= std::numeric_limits<int32_t>::max();
  if (error != std::errc() || !fits) {
    throw Error(where, "the integer " + std::string(word) + " does not fit 32 bits");
  }
  return value;
}

Lexer::Lexer(std::shared_ptr<const std::string> name, std::string text)
    : name_(std::move(name)), text_(std::move(text)) {
  const std::string_view view = text_;
  if (view.starts_with("\xff\xfe") || view.starts_with("\xfe\xff")) {
    throw Error(At(0), "the file is UTF-16; it has to be saved as UTF-8");
  }
  if (view.starts_with("\xef\xbb\xbf")) position_ = 3;
}

FileLocation Lexer::At(size_t position) const {
  return {name_, line_, static_cast<int>(position - lineStart_) + 1};
}

void Lexer::SkipSpaceAndComments() {
  while (position_ < text_.size()) {
    const char c = text_[position_];
    if (c == '\n') {
      ++line_;
      lineStart_ = ++position_;
    } else if (IsSpace(c)) {
      ++position_;
    } else if (c == '#') {
      const size_t end = std::min(text_.find_first_of("\r\n", position_), text_.size());
      const size_t nul = std::string_view(text_).substr(position_, end - position_).find('\0');
      if (nul != std::string_view::npos) throw Error(At(position_ + nul), "a NUL byte: this is not a text file");
      position_ = end;
    } else {
      return;
    }
  }
}

std::string_view Lexer::WordAt(size_t begin) const {
  size_t end = begin;
  while (end < text_.size() && !EndsWord(text_[end])) ++end;
  return std::string_view(text_).substr(begin, end - begin);
}

void Lexer::CheckUtf8(size_t begin, size_t end) const {
  const std::string_view view = text_;
  for (size_t i = begin; i < end;) {
    if (view[i] == '\0') throw Error(At(i), "a NUL byte: this is not a text file");
    const size_t length = Utf8Length(view.substr(i, end - i));
    if (length == 0) throw Error(At(i), "a byte that is not UTF-8; the file has to be saved as UTF-8");
    i += length;
  }
}

Token Lexer::Next() {
  SkipSpaceAndComments();
  if (position_ >= text_.size()) return {TokenKind::End, "", At(position_)};
  const char c = text_[position_];
  if (c == '"') return ReadString();
  if (c == '[' || c == ']') {
    Token token{c == '[' ? TokenKind::Open : TokenKind::Close, std::string(1, c), At(position_)};
    ++position_;
    return token;
  }
  const std::string_view word = WordAt(position_);
  CheckUtf8(position_, position_ + word.size());
  Token token{TokenKind::Word, std::string(word), At(position_)};
  position_ += word.size();
  return token;
}

Token Lexer::ReadString() {
  const size_t begin = position_++;
  const FileLocation where = At(begin);
  Token token{TokenKind::String, "", where};
  while (true) {
    const size_t special = std::min(text_.find_first_of("\"\\\n", position_), text_.size());
    CheckUtf8(position_, special);
    token.text.append(text_, position_, special - position_);
    position_ = special;
    if (special == text_.size() || text_[special] == '\n') throw Error(where, "this string does not end on its line");
    ++position_;
    if (text_[special] == '"') return token;
    token.text += ReadEscape(At(special));
  }
}

char Lexer::ReadEscape(const FileLocation& where) {
  const char escaped = position_ < text_.size() ? text_[position_++] : '\0';
  switch (escaped) {
    case 'n':
      return '\n';
    case 't':
      return '\t';
    case 'r':
      return '\r';
    case 'b':
      return '\b';
    case 'f':
      return '\f';
    case '\\':
    case '\'':
    case '"':
      return escaped;
    default:
      throw Error(where, "a backslash that starts no escape; write \\\\ for a backslash itself");
  }
}

bool Lexer::TryNumber(double& number) {
  SkipSpaceAndComments();
  if (position_ >= text_.size() || !StartsNumber(text_[position_])) return false;
  const char* begin = text_.data() + position_;
  const char* last = text_.data() + text_.size();
  const auto [end, error] = std::from_chars(begin, last, number);
  const bool plain = error == std::errc() && (end == last || EndsWord(*end));
  const bool inRange = plain && std::abs(number) <= static_cast<double>(std::numeric_limits<float>::max());
  if (inRange) {
    position_ += static_cast<size_t>(end - begin);
    return true;
  }
  const std::string_view word = WordAt(position_);
  CheckUtf8(position_, position_ + word.size());
  number = ParseNumber(word, At(position_));
  position_ += word.size();
  return true;
}

bool Lexer::TryInteger(int64_t& number) {
  SkipSpaceAndComments();
  if (position_ >= text_.size() || !StartsNumber(text_[position_])) return false;
  const std::string_view word = WordAt(position_);
  CheckUtf8(position_, position_ + word.size());
  number = ParseInteger(word, At(position_));
  position_ += word.size();
  return true;
}

}  // namespace lampyr
