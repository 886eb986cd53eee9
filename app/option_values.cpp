#include "app/option_values.h"

#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <optional>
#include <utility>

#include "app/command_support.h"
#include "base/error.h"

namespace lampyr {

namespace {

// Parses the whole text as a number; NaN if it is none.
double ParseFinite(const std::string& text) {
  char* end = nullptr;
  const double number = std::strtod(text.c_str(), &end);
  return end != text.c_str() && *end == '\0' && std::isfinite(number) ? number : std::nan("");
}

constexpr double kSmallestFloat = std::numeric_limits<float>::min(), kLargestFloat = std::numeric_limits<float>::max();

}  // namespace

double ParseDuration(const std::string& option, const std::string& text) {
  const double seconds = ParseWithUnit(text, {{"", 1}, {"s", 1}, {"m", 60}, {"min", 60}, {"h", 3600}});
  if (!(seconds > 0) || !(seconds < 1e9)) {
    throw UsageError(option + ": \"" + text + "\" is not a duration; write 90s, 5m or 2h");
  }
  return seconds;
}

namespace {

// Two whole numbers with a character between them, and nothing else.
std::optional<std::pair<int, int>> ParsePair(const std::string& text, char between) {
  std::pair<int, int> numbers;
  const char* const end = text.data() + text.size();
  const auto first = std::from_chars(text.data(), end, numbers.first);
  if (first.ec != std::errc() || first.ptr == end || *first.ptr != between) return std::nullopt;
  const auto second = std::from_chars(first.ptr + 1, end, numbers.second);
  if (second.ec != std::errc() || second.ptr != end) return std::nullopt;
  return numbers;
}

}  // namespace

void ParseResolution(const std::string& text, RenderOverrides& overrides) {
  const auto size = ParsePair(text, 'x');
  if (!size || size->first < 1 || size->second < 1 || size->first > 65536 || size->second > 65536)
    throw UsageError("--resolution: \"" + text + "\" is not a size; write 640x360");
  overrides.width = size->first;
  overrides.height = size->second;
}

std::pair<int, int> ParseShard(const std::string& text) {
  const auto part = ParsePair(text, '/');
  if (!part || part->second < 1 || part->second > 1 << 20 || part->first < 1 || part->first > part->second)
    throw UsageError("--shard: \"" + text + "\" is no part; write 2/8 for the second of eight");
  return *part;
}

std::string CheckPositive(const std::string& text) {
  const double number = ParseFinite(text);
  if (number >= kSmallestFloat && number <= kLargestFloat) return "";
  if (!(number > 0)) return "\"" + text + "\" is not a number above 0";
  return "\"" + text + "\" is too " + (number < 1 ? "small: at least 1.2e-38" : "large: at most 3.4e38");
}

std::string CheckShare(const std::string& text) {
  const double number = ParseFinite(text);
  return number > 0 && number <= 1 ? "" : "\"" + text + "\" is not a share, from 0 to 1";
}

std::string CheckSeed(const std::string& text) {
  uint64_t seed = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seed);
  const bool isWhole = error == std::errc() && end == text.data() + text.size();
  return isWhole ? "" : "\"" + text + "\" is not a whole number from 0 to 18446744073709551615";
}

std::string CheckFinite(const std::string& text) {
  return std::abs(ParseFinite(text)) <= kLargestFloat ? "" : "\"" + text + "\" is not a finite number";
}

}  // namespace lampyr
