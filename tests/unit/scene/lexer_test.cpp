// Tokens, their places, and numbers.
#include "scene/lexer.h"

#include "unit/scene/scene_support.h"

namespace lampyr {
namespace {

Lexer MakeLexer(const std::string& text) {
  return {std::make_shared<const std::string>("f"), text};
}

TEST(Lexer, TokensAndPlaces) {
  Lexer lexer = MakeLexer("Shape \"a b\"[1 true]# comment [ \"\r\n\t2e3\n");
  const std::vector<std::tuple<TokenKind, std::string, std::string>> expected = {
      {TokenKind::Word, "Shape", "f:1:1"}, {TokenKind::String, "a b", "f:1:7"}, {TokenKind::Open, "[", "f:1:12"},
      {TokenKind::Word, "1", "f:1:13"},    {TokenKind::Word, "true", "f:1:15"}, {TokenKind::Close, "]", "f:1:19"},
      {TokenKind::Word, "2e3", "f:2:2"},   {TokenKind::End, "", "f:3:1"},       {TokenKind::End, "", "f:3:1"}};
  for (const auto& [kind, text, where] : expected) {
    const Token token = lexer.Next();
    EXPECT_EQ(token.kind, kind);
    EXPECT_EQ(token.text, text);
    EXPECT_EQ(token.where.ToString(), where);
  }
}

TEST(Lexer, CarriageReturnLineFeedCountsOnce) {
  Lexer lexer = MakeLexer("A\r\nB\r\n\r\n  C");
  EXPECT_EQ(lexer.Next().where.ToString(), "f:1:1");
  EXPECT_EQ(lexer.Next().where.ToString(), "f:2:1");
  EXPECT_EQ(lexer.Next().where.ToString(), "f:4:3");
}

TEST(Lexer, ColumnsCountBytes) {
  Lexer lexer = MakeLexer("\"äé\" X");
  EXPECT_EQ(lexer.Next().text, "äé");
  EXPECT_EQ(lexer.Next().where.ToString(), "f:1:8");
}

TEST(Lexer, EscapesAndByteOrderMark) {
  EXPECT_EQ(MakeLexer(R"("a\"b\\c\n\t\'")").Next().text, "a\"b\\c\n\t'");
  EXPECT_EQ(MakeLexer("\xef\xbb\xbfWorldBegin").Next().text, "WorldBegin");
}

TEST(Lexer, NumbersAsPbrtWritesThem) {
  const std::vector<std::pair<std::string, double>> numbers = {
      {"0", 0},       {"-0.5", -0.5},    {"+3", 3},     {".25", 0.25},      {"7.", 7},
      {"1e-3", 1e-3}, {"-2.5E+2", -250}, {"1e-400", 0}, {"3.4e38", 3.4e38}, {"0.1", 0.1}};
  std::string text;
  for (const auto& [word, value] : numbers) {
    EXPECT_EQ(ParseNumber(word, {}), value) << word;
    text += word + "\n";
  }
  Lexer lexer = MakeLexer(text);
  for (const auto& [word, value] : numbers) {
    double read = -1;
    ASSERT_TRUE(lexer.TryNumber(read));
    EXPECT_EQ(read, value) << word;
  }
  double none = 0;
  EXPECT_FALSE(lexer.TryNumber(none));
}

TEST(Lexer, RejectsWhatIsNoNumber) {
  for (const char* word :
       {"nan", "NaN", "inf", "-inf", "Infinity", "1e999", "1e39", "1.2.3", "--1", "+-1", "1x", "-", ".", "0x10"}) {
    EXPECT_NE(ErrorOf([&] { ParseNumber(word, {}); }), "no error") << word;
    Lexer lexer = MakeLexer(word);
    double value = 0;
    const std::string viaList = ErrorOf([&] {
      if (!lexer.TryNumber(value)) throw Error("not taken");
    });
    EXPECT_NE(viaList, "no error") << word;
  }
  for (const char* word : {"3.5", "3.0", "1e3", "2147483648", "-2147483649", "99999999999999999999", "x", "+-1"}) {
    EXPECT_NE(ErrorOf([&] { ParseInteger(word, {}); }), "no error") << word;
  }
  EXPECT_EQ(ParseInteger("-2147483648", {}), -2147483648LL);
  EXPECT_EQ(ParseInteger("+2147483647", {}), 2147483647LL);
}

}  // namespace
}  // namespace lampyr
