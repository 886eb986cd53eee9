#include "base/progress.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "base/terminal.h"

namespace lampyr {

std::string FormatPercent(double fraction) {
  const double percent = 100 * fraction;
  if (!std::isfinite(percent)) return "unknown";
  if (percent == 0) return "0 %";
  constexpr int kDigits = 2, kMostDecimals = 12;
  const int magnitude = static_cast<int>(std::floor(std::log10(std::abs(percent))));
  const double unit = std::pow(10.0, std::max(magnitude - kDigits + 1, 0));
  const int decimals = std::clamp(kDigits - 1 - magnitude, 0, kMostDecimals);
  char text[400];  // the largest double has 309 digits
  std::snprintf(text, sizeof text, "%.*f", decimals, unit > 1 ? std::round(percent / unit) * unit : percent);
  std::string number = text;
  if (number.find('.') != std::string::npos) number.erase(number.find_last_not_of('0') + 1);
  if (number.back() == '.') number.pop_back();
  return number + " %";
}

std::string FormatDuration(double seconds) {
  char text[64];
  if (!(seconds < 1e9)) return "?";
  const long whole = std::lround(seconds);
  if (whole >= 3600) {
    std::snprintf(text, sizeof text, "%ld h %02ld min", whole / 3600, whole / 60 % 60);
  } else if (whole >= 60) {
    std::snprintf(text, sizeof text, "%ld min %02ld s", whole / 60, whole % 60);
  } else if (seconds < 0.0995 && seconds > 0) {
    std::snprintf(text, sizeof text, "%.2g ms", 1000 * seconds);
  } else {
    std::snprintf(text, sizeof text, "%.1f s", seconds);
  }
  return text;
}

std::string ProgressLine(double fraction, const std::string& left, const std::string& note, int columns) {
  constexpr int kWidestBar = 30, kNarrowestBar = 8, kFrame = 3;  // brackets and a space
  char percent[16];
  std::snprintf(percent, sizeof percent, "%3.0f %%", fraction * 100);
  std::string text = std::string(percent) + ", " + left + " left" + (note.empty() ? "" : ", ") + note;
  // The last column stays free: some terminals wrap a full line.
  const int spare = columns - 1 - ColumnsOf(text);
  const int width = std::min(kWidestBar, spare - kFrame);
  if (width >= kNarrowestBar) {
    const int filled = static_cast<int>(fraction * width);
    const auto repeated = [](int count, char c) { return std::string(static_cast<size_t>(count), c); };
    return "[" + repeated(filled, '#') + repeated(width - filled, '.') + "] " + text;
  }
  while (ColumnsOf(text) >= columns) text.pop_back();
  return text;
}

Progress::Progress(bool quiet) : quiet_(quiet), terminal_(isatty(STDERR_FILENO) != 0), start_(Clock::now()) {}

Progress::~Progress() {
  Clear();
}

double Progress::Seconds() const {
  return std::chrono::duration<double>(Clock::now() - start_).count();
}

void Progress::Update(double fraction, const std::string& note) {
  if (quiet_) return;
  const double now = Seconds();
  if (now - lastPrinted_ < (terminal_ ? 0.1 : 5.0)) return;
  if (!terminal_ && (fraction >= 1 || (lastPrinted_ < 0 && now < 2.0)))
    return;  // short or finished work needs no lines
  lastPrinted_ = now;
  fraction = std::clamp(fraction, 0.0, 1.0);
  const std::string left = fraction > 0 ? FormatDuration(now * (1 - fraction) / fraction) : "?";
  if (terminal_) {
    constexpr int kUsualColumns = 80;
    const int columns = TerminalColumns(STDERR_FILENO, kUsualColumns);
    std::fprintf(stderr, "\r\033[K%s", ProgressLine(fraction, left, note, columns).c_str());
    barShown_ = true;
  } else {
    std::fprintf(stderr, "%3.0f %%, %s left%s%s\n", fraction * 100, left.c_str(), note.empty() ? "" : ", ",
                 note.c_str());
  }
  std::fflush(stderr);
}

void Progress::Clear() {
  if (!barShown_) return;
  std::fprintf(stderr, "\r\033[K");
  barShown_ = false;
}

}  // namespace lampyr
