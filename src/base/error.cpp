#include "base/error.h"

#include <algorithm>
#include <cstdio>
#include <functional>

namespace lampyr {

std::string FileLocation::ToString() const {
  if (!file) return "";
  if (line == 0) return *file;
  return *file + ":" + std::to_string(line) + ":" + std::to_string(column);
}

namespace {

std::string Format(const FileLocation& where, const char* severity, const std::string& text) {
  const std::string place = where.ToString();
  return (place.empty() ? "" : place + ": ") + severity + ": " + text;
}

char LowerCase(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

// Edit distance with transpositions of neighbours (optimal string alignment), case ignored.
int EditDistance(std::string_view a, std::string_view b) {
  const size_t columns = b.size() + 1;
  std::vector<int> beforeLast(columns), last(columns), row(columns);
  for (size_t j = 0; j < columns; ++j) last[j] = static_cast<int>(j);
  for (size_t i = 1; i <= a.size(); ++i) {
    row[0] = static_cast<int>(i);
    for (size_t j = 1; j < columns; ++j) {
      const bool same = LowerCase(a[i - 1]) == LowerCase(b[j - 1]);
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (same ? 0 : 1)});
      const bool swapped =
          i > 1 && j > 1 && LowerCase(a[i - 1]) == LowerCase(b[j - 2]) && LowerCase(a[i - 2]) == LowerCase(b[j - 1]);
      if (swapped) row[j] = std::min(row[j], beforeLast[j - 2] + 1);
    }
    std::swap(beforeLast, last);
    std::swap(last, row);
  }
  return last[b.size()];
}

}  // namespace

Error::Error(const std::string& text) : std::runtime_error(Format({}, "error", text)), text_(text) {}

Error::Error(const FileLocation& where, const std::string& text)
    : std::runtime_error(Format(where, "error", text)), where_(where), text_(text) {}

namespace {

// The text without quoted names and digits: equal for warnings of the same kind.
std::string KindOf(const std::string& text) {
  std::string kind;
  bool isQuoted = false;
  for (const char c : text) {
    if (c == '"') isQuoted = !isQuoted;
    const bool isDigit = c >= '0' && c <= '9';
    if (!isQuoted && !isDigit) kind += c;
  }
  return kind;
}

}  // namespace

void Diagnostics::Warn(const FileLocation& where, const std::string& text) {
  if (mode_ == Mode::Strict) throw Error(where, text + " (--strict makes this warning an error)");
  const std::lock_guard lock(mutex_);
  if (mode_ == Mode::Print) return Print(where, text);
  const std::string message = Format(where, "warning", text);
  if (seen_.insert(message).second) warnings_.push_back(message);
}

void Diagnostics::Print(const FileLocation& where, const std::string& text) {
  constexpr size_t kMostOfAKind = 3;
  const std::string message = Format(where, "warning", text);
  if (!seenHashes_.insert(std::hash<std::string>()(message)).second) return;
  Kind& kind = kinds_[KindOf(text)];
  const bool isNew = kind.printed.size() < kMostOfAKind && kind.printed.insert(text).second;
  if (isNew) {
    std::fprintf(stderr, "%s\n", message.c_str());
  } else {
    ++kind.further;
  }
}

Diagnostics::~Diagnostics() {
  for (const auto& [name, kind] : kinds_) {
    if (kind.further == 0) continue;
    std::fprintf(stderr, "warning: %zu more like this: %s\n", kind.further, kind.printed.begin()->c_str());
  }
}

std::vector<std::string> Diagnostics::Warnings() const {
  const std::lock_guard lock(mutex_);
  return warnings_;
}

std::string NearestName(std::string_view given, const std::vector<std::string>& known) {
  // The time of the distance is proportional to the product of both lengths, and real names are shorter.
  constexpr size_t kLongestName = 200;
  if (given.size() > kLongestName) return "";
  const int limit = std::max(1, static_cast<int>(given.size()) / 3);
  int best = limit + 1;
  std::string nearest;
  for (const std::string& name : known) {
    // The difference in length bounds the distance from below; this skips the quadratic algorithm for long names.
    const size_t longer = std::max(given.size(), name.size()), shorter = std::min(given.size(), name.size());
    if (longer - shorter > static_cast<size_t>(limit)) continue;
    const int distance = EditDistance(given, name);
    if (distance < best) {
      best = distance;
      nearest = name;
    }
  }
  return nearest;
}

namespace {

// Names of pbrt-v3, with the current name that is closest in meaning.
constexpr std::pair<std::string_view, std::string_view> kFormerNames[] = {{"matte", "diffuse"},
                                                                          {"plastic", "coateddiffuse"},
                                                                          {"substrate", "coateddiffuse"},
                                                                          {"uber", "coateddiffuse"},
                                                                          {"glass", "dielectric"},
                                                                          {"metal", "conductor"},
                                                                          {"mirror", "conductor"},
                                                                          {"translucent", "diffusetransmission"},
                                                                          {"fourier", "measured"},
                                                                          {"image", "rgb"},
                                                                          {"environment", "spherical"},
                                                                          {"directlighting", "path"},
                                                                          {"random", "independent"},
                                                                          {"02sequence", "paddedsobol"},
                                                                          {"st", "uv"},
                                                                          {"Kd", "reflectance"},
                                                                          {"Kr", "reflectance"}};

std::string ModernName(std::string_view given, const std::vector<std::string>& known) {
  for (const auto& [former, name] : kFormerNames)
    if (given == former && std::find(known.begin(), known.end(), name) != known.end()) return std::string(name);
  return NearestName(given, known);
}

}  // namespace

std::string DidYouMean(std::string_view given, const std::vector<std::string>& known) {
  const std::string nearest = ModernName(given, known);
  return nearest.empty() ? "" : " (did you mean \"" + nearest + "\"?)";
}

}  // namespace lampyr
