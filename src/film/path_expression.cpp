#include "film/path_expression.h"

#include <algorithm>
#include <iterator>

#include "base/error.h"

namespace lampyr {

namespace {

constexpr uint8_t BitOf(PathEvent event) {
  return static_cast<uint8_t>(1u << static_cast<unsigned>(event));
}
constexpr uint8_t kReflections = 0b0000111, kTransmissions = 0b0111000, kAllEvents = 0b1111111;
constexpr uint8_t kDiffuse = 0b0001001, kGlossy = 0b0010010, kSpecular = 0b0100100;
constexpr uint8_t kVolume = BitOf(PathEvent::Volume);
constexpr uint8_t kScatterings = kReflections | kTransmissions;
constexpr size_t kMostPositions = 4096;
constexpr int kMostRepeats = 255;
// Symbols and parentheses, repeated ones counted as often as they are repeated: empty ones have no positions.
constexpr size_t kMostParts = 8 * kMostPositions;
constexpr const char* kTooLong = "the expression is too long with its repetitions";
constexpr int kDeepest = 100;  // nesting depth of parentheses

using Positions = std::vector<uint32_t>;  // increasing

// Adds `more` to `to`.
void Add(const Positions& more, Positions& to) {
  if (more.empty() || to.empty() || to.back() < more.front()) {
    to.insert(to.end(), more.begin(), more.end());
    return;
  }
  Positions all;
  std::set_union(to.begin(), to.end(), more.begin(), more.end(), std::back_inserter(all));
  to = std::move(all);
}

Positions Union(Positions a, const Positions& b) {
  Add(b, a);
  return a;
}

}  // namespace

bool LightSources::Has(const LightSourceName& source) const {
  const bool isAmong = std::any_of(terms.begin(), terms.end(), [&](const Term& term) {
    switch (term.kind) {
      case Kind::AnyLight:
        return !source.isMedium;
      case Kind::Media:
        return source.isMedium;
      case Kind::Named:
        return !source.isMedium && (source.name == term.name || source.group == term.name);
      case Kind::InGroup:
        return source.group == term.name;
      case Kind::InNoGroup:
        return source.group.empty();
    }
    return false;
  });
  return isAmong != isNegated;
}

class ExpressionParser {
 public:
  explicit ExpressionParser(const std::string& text) : text_(text) {}

  PathExpression Parse() {
    Part all;
    bool isFirst = true;
    do {
      Part one = Camera();
      all = isFirst ? std::move(one) : Either(all, one);
      isFirst = false;
    } while (Takes('|'));
    if (!IsAtEnd()) Fail(Peek() == ')' ? "this parenthesis closes none" : Unexpected());
    expression_.first_ = std::move(all.first);
    expression_.last_ = std::move(all.last);
    CheckEnd();
    return std::move(expression_);
  }

 private:
  struct Part {
    bool isNullable = true;
    Positions first, last;
  };

  [[noreturn]] void Fail(const std::string& what) const {
    throw Error("character " + std::to_string(at_ + 1) + " of \"" + Excerpt() + "\": " + what);
  }
  // The text, or an excerpt around the current character.
  std::string Excerpt() const {
    constexpr size_t most = 120;
    if (text_.size() <= most) return text_;
    const size_t from = std::min(at_ - std::min(at_, most / 2), text_.size() - most);
    return (from > 0 ? "…" : "") + text_.substr(from, most) + (from + most < text_.size() ? "…" : "");
  }
  std::string Unexpected() const {
    if (IsAtEnd()) return "the expression ends here, too early";
    if (Peek() == 'C') return "C is the camera, which stands first alone";
    return "\"" + std::string(1, Peek()) + "\" is no event: R, T, D, G, S, V, L, O, or . for any";
  }
  void SkipSpaces() {
    while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\t')) ++at_;
  }
  bool IsAtEnd() const { return at_ >= text_.size(); }
  char Peek() const { return IsAtEnd() ? '\0' : text_[at_]; }
  bool Takes(char c) {
    SkipSpaces();
    if (Peek() != c) return false;
    ++at_;
    SkipSpaces();
    return true;
  }
  void Expect(char c, const std::string& why) {
    if (!Takes(c)) Fail(why);
  }

  Part Camera() {
    SkipSpaces();
    if (Peek() != 'C') Fail("an expression starts with the camera, C");
    ++at_;
    return Sequence();
  }

  Part Alternatives() {
    Part all = Sequence();
    while (Takes('|')) all = Either(all, Sequence());
    return all;
  }

  Part Sequence() {
    Part all;
    for (;;) {
      SkipSpaces();
      if (IsAtEnd() || Peek() == ')' || Peek() == '|') return all;
      all = Then(all, Repeated());
    }
  }

  Part Repeated() {
    const size_t begin = at_;
    Part part = Single();
    SkipSpaces();
    if (Takes('*')) {
      part = Again(part);
      part.isNullable = true;
    } else if (Takes('+')) {
      part = Again(part);
    } else if (Takes('?')) {
      part.isNullable = true;
    } else if (Peek() == '{') {
      part = Counted(begin, std::move(part));
    }
    if (!IsAtEnd() && std::string("*+?{").find(Peek()) != std::string::npos)
      Fail("a second quantifier: put what the first one repeats in parentheses");
    return part;
  }

  // Repetition of the text between `begin` and the current character: `first` is its first copy; further ones are
  // parsed from the same text.
  Part Counted(size_t begin, Part first) {
    const size_t quantifier = at_;
    ++at_;
    const int least = Number();
    int most = least;
    bool isOpen = false;
    if (Takes(',')) {
      isOpen = Peek() == '}';
      if (!isOpen) most = Number();
    }
    Expect('}', "a repetition is {n}, {n,} or {n,m}");
    const size_t end = at_;
    if (!isOpen && most < least) {
      at_ = quantifier;
      Fail("the largest count is less than the least one");
    }
    Part all;
    const int count = isOpen ? std::max(least, 1) : most;
    for (int i = 0; i < count; ++i) {
      Part one = std::move(first);
      if (i > 0) {
        at_ = begin;
        one = Single();
      }
      if (isOpen && i + 1 == count) one = Again(one);
      if (i >= least) one.isNullable = true;
      all = Then(all, one);
    }
    at_ = end;
    return all;
  }

  int Number() {
    SkipSpaces();
    if (Peek() < '0' || Peek() > '9') Fail("here is a number wanted, how often it repeats");
    int value = 0;
    while (Peek() >= '0' && Peek() <= '9') {
      value = 10 * value + (Peek() - '0');
      if (value > kMostRepeats) Fail("at most " + std::to_string(kMostRepeats) + " repetitions");
      ++at_;
    }
    SkipSpaces();
    return value;
  }

  Part Single() {
    SkipSpaces();
    if (++parts_ > kMostParts) Fail(kTooLong);
    if (Peek() == '(') {
      if (depth_ == kDeepest) Fail("more than " + std::to_string(kDeepest) + " parentheses in each other");
      Takes('(');
      ++depth_;
      Part part = Alternatives();
      --depth_;
      Expect(')', "a parenthesis that is opened is not closed");
      return part;
    }
    PathExpression::Position position;
    if (Peek() == '[') {
      ReadSet(position);
    } else {
      ReadSymbol(position);
    }
    if (expression_.positions_.size() >= kMostPositions) Fail(kTooLong);
    const auto index = static_cast<uint32_t>(expression_.positions_.size());
    expression_.positions_.push_back(std::move(position));
    return {false, {index}, {index}};
  }

  void ReadSet(PathExpression::Position& position) {
    const size_t begin = at_;
    ++at_;
    const bool isNegated = Takes('^');
    SkipSpaces();
    while (!IsAtEnd() && Peek() != ']') {
      ReadSymbol(position);
      SkipSpaces();
    }
    if (IsAtEnd()) {
      at_ = begin;
      Fail("a bracket that is opened is not closed");
    }
    ++at_;
    if (isNegated) {
      position.events = static_cast<uint8_t>(~position.events & kAllEvents);
      position.sources.isNegated = true;
    }
  }

  // Adds the events and sources that a symbol matches.
  void ReadSymbol(PathExpression::Position& position) {
    const auto add = [&](LightSources::Kind kind) { position.sources.terms.push_back({kind, ""}); };
    const char symbol = Peek();
    if (symbol == '<') return ReadPair(position);
    if (symbol == 'L') {
      add(LightSources::Kind::AnyLight);
    } else if (symbol == 'O') {
      add(LightSources::Kind::Media);
    } else if (symbol == '.') {
      position.events = kAllEvents;
      add(LightSources::Kind::AnyLight);
      add(LightSources::Kind::Media);
    } else if (const uint8_t events = DirectionsOf(symbol) | ScatteringsOf(symbol)) {
      position.events |= events;
    } else {
      Fail(Unexpected());
    }
    ++at_;
  }

  static uint8_t DirectionsOf(char symbol) {
    return symbol == 'R' ? kReflections : symbol == 'T' ? kTransmissions : symbol == 'V' ? kVolume : 0;
  }
  static uint8_t ScatteringsOf(char symbol) {
    return symbol == 'D' ? kDiffuse : symbol == 'G' ? kGlossy : symbol == 'S' ? kSpecular : 0;
  }

  // <direction scattering>, or <L.'name'>.
  void ReadPair(PathExpression::Position& position) {
    const size_t begin = at_;
    ++at_;
    SkipSpaces();
    if (Peek() == 'L' || Peek() == 'O') {
      ReadSource(position);
    } else {
      const uint8_t directions = Letters(DirectionsOf, kScatterings, "R, T, V, L, O, or . for R and T");
      uint8_t scatterings = kAllEvents;
      SkipSpaces();
      if (Peek() != '>' && Peek() != '\'' && Peek() != '"')
        scatterings = Letters(ScatteringsOf, kAllEvents, "D, G, S, or . for any");
      if (directions & kVolume) scatterings |= kVolume;
      position.events |= static_cast<uint8_t>(directions & scatterings);
      SkipSpaces();
      if (Peek() == '\'' || Peek() == '"') Fail("only lights have names: <L.'name'>");
    }
    SkipSpaces();
    if (IsAtEnd()) at_ = begin;
    if (Peek() != '>') Fail(at_ == begin ? "this < is not closed by >" : "here is > wanted");
    ++at_;
  }

  // A letter, a set of them, or a dot for `any`.
  uint8_t Letters(uint8_t (*eventsOf)(char), uint8_t any, const std::string& known) {
    SkipSpaces();
    const bool isSet = Takes('[');
    const bool isNegated = isSet && Takes('^');
    uint8_t events = 0;
    do {
      if (Peek() == '.') {
        events |= any;
      } else if (const uint8_t of = eventsOf(Peek())) {
        events |= of;
      } else {
        Fail("here is one of these wanted: " + known);
      }
      ++at_;
      SkipSpaces();
    } while (isSet && Peek() != ']');
    if (isSet) ++at_;
    return isNegated ? static_cast<uint8_t>(any & ~events) : events;
  }

  void ReadSource(PathExpression::Position& position) {
    const bool isMedium = Peek() == 'O';
    ++at_;
    Takes('.');
    SkipSpaces();
    bool hasName = false;
    while (Peek() == '\'' || Peek() == '"' || Peek() == '\\') {
      if (isMedium) Fail("glowing media have no names: O");
      position.sources.terms.push_back({LightSources::Kind::Named, QuotedName()});
      hasName = true;
      SkipSpaces();
    }
    if (!hasName)
      position.sources.terms.push_back({isMedium ? LightSources::Kind::Media : LightSources::Kind::AnyLight, ""});
  }

  // A name in quotes of either kind, each optionally escaped by a backslash, as in shells and scene files.
  std::string QuotedName() {
    const size_t begin = at_;
    if (Peek() == '\\') ++at_;
    const char quote = Peek();
    if (quote != '\'' && quote != '"') Fail("a name is in quotes: <L.'name'>");
    const size_t from = ++at_;
    while (!IsAtEnd() && Peek() != quote) ++at_;
    if (IsAtEnd()) {
      at_ = begin;
      Fail("the name that starts here has no quote at its end");
    }
    size_t length = at_ - from;
    if (length > 0 && text_[at_ - 1] == '\\') --length;
    ++at_;
    if (length == 0) Fail("the name is empty");
    return text_.substr(from, length);
  }

  Part Then(const Part& a, const Part& b) {
    for (const uint32_t last : a.last) {
      Add(b.first, expression_.positions_[last].next);
    }
    return {a.isNullable && b.isNullable, a.isNullable ? Union(a.first, b.first) : a.first,
            b.isNullable ? Union(a.last, b.last) : b.last};
  }
  static Part Either(const Part& a, const Part& b) {
    return {a.isNullable || b.isNullable, Union(a.first, b.first), Union(a.last, b.last)};
  }
  Part Again(const Part& part) {
    for (const uint32_t last : part.last) {
      Add(part.first, expression_.positions_[last].next);
    }
    return part;
  }

  // Requires the light of a path to be at its end and nowhere else.
  void CheckEnd() const {
    const auto isSource = [&](uint32_t i) {
      const LightSources& sources = expression_.positions_[i].sources;
      return !sources.terms.empty() || sources.isNegated;
    };
    if (std::none_of(expression_.last_.begin(), expression_.last_.end(), isSource))
      Fail("the path has no light: it ends with L, O, or [LO]");
  }

  const std::string& text_;
  size_t at_ = 0;
  size_t parts_ = 0;
  int depth_ = 0;
  PathExpression expression_;
};

PathExpression::PathExpression(const std::string& text) : PathExpression(ExpressionParser(text).Parse()) {}

PathExpression::PathExpression(LightSources sources) {
  positions_ = {{kAllEvents, {}, {0, 1}}, {0, std::move(sources), {}}};
  first_ = {0, 1};
  last_ = {1};
}

std::vector<std::string> PathExpression::NamedLights() const {
  std::vector<std::string> names;
  for (const Position& position : positions_) {
    for (const LightSources::Term& term : position.sources.terms) {
      if (term.kind == LightSources::Kind::Named) names.push_back(term.name);
    }
  }
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  return names;
}

PathExpression PathExpression::OnlyFrom(const std::string& light) const {
  PathExpression only = *this;
  for (Position& position : only.positions_) {
    const bool hasLights = position.sources.isNegated ||
                           std::any_of(position.sources.terms.begin(), position.sources.terms.end(),
                                       [](const auto& term) { return term.kind == LightSources::Kind::AnyLight; });
    position.sources = {};
    if (hasLights) position.sources.terms = {{LightSources::Kind::Named, light}};
  }
  return only;
}

const std::vector<NamedExpression>& NamedExpressions() {
  static const std::vector<NamedExpression> named = {
      {"beauty", "C.*[LO]"},
      {"emission", "C[LO]"},
      {"direct diffuse", "C<RD>[LO]"},
      {"indirect diffuse", "C<RD>.+[LO]"},
      {"direct specular", "C<R[GS]>[LO]"},
      {"indirect specular", "C<R[GS]>.+[LO]"},
      {"transmission", "CT.*[LO]"},
      {"volume", "CV.*[LO]"},
      {"caustic", "CD[GS]+.*[LO]"},
  };
  return named;
}

std::string PlainName(const std::string& name) {
  std::string letters;
  for (const char c : name) {
    if (c != ' ' && c != '-' && c != '_') letters += static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
  }
  return letters;
}

const NamedExpression* FindNamedExpression(const std::string& name) {
  for (const NamedExpression& named : NamedExpressions()) {
    if (PlainName(named.name) == PlainName(name)) return &named;
  }
  return nullptr;
}

}  // namespace lampyr
