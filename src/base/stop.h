// A request to end a pass of rendering before it is done, seen within the loops of its paths.
//
// There is one request for the process: a path may have any length, and is followed far below whoever knows why the
// pass has to end.
#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>

namespace lampyr {

// Thrown by CheckStop. The work that it ends is half done: whoever catches it restores what was there before.
struct Stopped {};

namespace stop {
extern std::atomic<bool> requested;
[[noreturn]] void Throw();
}  // namespace stop

// From any thread.
void RequestStop();
void WithdrawStop();

// To be called at each turn of a loop that may take long.
inline void CheckStop() {
  if (stop::requested.load(std::memory_order_relaxed)) [[unlikely]]
    stop::Throw();
}

// Runs `work` on a thread of its own, and waits for its end. Stopped: it has thrown Stopped. GivenUp: it has not ended
// `kPatience` after the request, as it may be in code that does not ask (a library, a plugin, the system). It goes on
// then: what it refers to must stay until the process ends, and the request with it. What else it throws is thrown
// here.
enum class WorkEnd { Done, Stopped, GivenUp };
WorkEnd RunUntilStopped(std::function<void()> work);
bool HasGivenUpWork();
inline constexpr double kPatience = 0.5;  // seconds

// Requests a stop when an interrupt or the end of the time has been there for `kGrace` and the work is still under way,
// from a thread of its own. Withdraws the request when it is destroyed, unless work was given up.
class StopWatch {
 public:
  // Seconds: passes that end soon are worth waiting for.
  static constexpr double kGrace = 0.5;

  // `interrupted`: set by a signal handler; null: nobody interrupts. `seconds` from now on; absent: without end.
  StopWatch(const std::atomic<bool>* interrupted, std::optional<double> seconds);
  ~StopWatch();
  StopWatch(const StopWatch&) = delete;
  StopWatch& operator=(const StopWatch&) = delete;

 private:
  void Watch(const std::atomic<bool>* interrupted, std::optional<double> seconds);

  std::mutex mutex_;
  std::condition_variable ended_;
  bool hasEnded_ = false;
  std::thread thread_;
};

}  // namespace lampyr
