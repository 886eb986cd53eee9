#include "app/option_values.h"

#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <limits>

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

void ParseResolution(const std::string& text, RenderOverrides& overrides) {
  int width = 0, height = 0;
  char rest = 0;
  if (std::sscanf(text.c_str(), "%dx%d%c", &width, &height, &rest) != 2 || width < 1 || height < 1 || width > 65536 ||
      height > 65536) {
    throw UsageError("--resolution: \"" + text + "\" is not a size; write 640x360");
  }
  overrides.width = width;
  overrides.height = height;
}

std::pair<int, int> ParseShard(const std::string& text) {
  int index = 0, count = 0;
  char rest = 0;
  if (std::sscanf(text.c_str(), "%d/%d%c", &index, &count, &rest) != 2 || count < 1 || count > 1 << 20 || index < 1 ||
      index > count) {
    throw UsageError("--shard: \"" + text + "\" is no part; write 2/8 for the second of eight");
  }
  return {index, count};
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
