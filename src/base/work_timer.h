// Wall-clock and processor time of work.
#pragma once

#include <chrono>
#include <ctime>

namespace lampyr {

struct WorkTime {
  double clock = 0;      // seconds
  double processor = 0;  // seconds of all threads of the process, user and system
};

class WorkTimer {
 public:
  WorkTime Elapsed() const {  // since construction
    return {std::chrono::duration<double>(std::chrono::steady_clock::now() - clock_).count(),
            static_cast<double>(std::clock() - processor_) / CLOCKS_PER_SEC};
  }

 private:
  std::chrono::steady_clock::time_point clock_ = std::chrono::steady_clock::now();
  std::clock_t processor_ = std::clock();
};

}  // namespace lampyr
