// Progress of long work: a bar on a terminal, a plain line every few seconds elsewhere.
#pragma once

#include <chrono>
#include <string>

namespace lampyr {

class Progress {
 public:
  // `quiet`: prints nothing at all.
  explicit Progress(bool quiet);
  ~Progress();

  // `fraction` done in [0,1]; `note` follows it ("64 spp, error 2.1 %"). Prints at most a few times a second.
  void Update(double fraction, const std::string& note);
  // Clears the bar, so that other lines can be printed.
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

// The bar of a terminal with `columns` columns, on one line that is shorter than they are: at 40 columns without a bar
// ("50 %, 3 min 20 s left, 64 spp"), the note cut off where it does not fit.
std::string ProgressLine(double fraction, const std::string& left, const std::string& note, int columns);

// "1 h 02 min", "3 min 20 s", "4.2 s", "37 ms".
std::string FormatDuration(double seconds);

// A fraction in percent with two significant digits and without an exponent: "0.12 %", "5 %", "190 %"; "unknown" where
// it is not finite.
std::string FormatPercent(double fraction);

}  // namespace lampyr
