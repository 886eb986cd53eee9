// Progress of long work on stderr: a bar on a terminal, otherwise a plain line every few seconds.
#pragma once

#include <chrono>
#include <string>

namespace lampyr {

class Progress {
 public:
  // `quiet`: prints nothing.
  explicit Progress(bool quiet);
  ~Progress();

  // `fraction` done, in [0,1], followed by `note` ("64 spp, error 2.1 %"). Prints at most every 0.1 s on a terminal,
  // and every 5 s elsewhere.
  void Update(double fraction, const std::string& note);
  // Clears the bar, so that other output can be printed.
  void Clear();

  double Seconds() const;  // since construction

 private:
  using Clock = std::chrono::steady_clock;
  bool quiet_;
  bool terminal_;
  bool barShown_ = false;
  Clock::time_point start_;
  double lastPrinted_ = -1e9;
};

// One line of progress for a terminal with `columns` columns, always shorter than that. If a bar does not fit (at 40
// columns, say) it is omitted ("50 %, 3 min 20 s left, 64 spp"); a line that is still too long is cut off at the end.
std::string ProgressLine(double fraction, const std::string& left, const std::string& note, int columns);

// "1 h 02 min", "3 min 20 s", "4.2 s", "37 ms".
std::string FormatDuration(double seconds);

// A fraction in percent, rounded to two significant digits, without an exponent and without trailing zeros: "0.12 %",
// "5 %", "190 %"; "unknown" if it is not finite.
std::string FormatPercent(double fraction);

}  // namespace lampyr
