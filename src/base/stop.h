// A request to end a rendering pass early, which the loops that trace paths poll.
//
// The request is global to the process: a path may have any length, and is traced many levels below the code that
// decides to end the pass.
#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>

namespace lampyr {

// Thrown by CheckStop. The interrupted work is incomplete: the code that catches this restores the state from before.
struct Stopped {};

namespace stop {
extern std::atomic<bool> requested;
[[noreturn]] void Throw();
}  // namespace stop

// Both may be called from any thread.
void RequestStop();
void WithdrawStop();

// Throws Stopped if a stop is requested. To be called in each iteration of a loop that may take long.
inline void CheckStop() {
  if (stop::requested.load(std::memory_order_relaxed)) [[unlikely]]
    stop::Throw();
}

// Runs `work` on a separate thread and waits for it. Rethrows its exceptions other than Stopped.
// - Done: `work` has returned.
// - Stopped: `work` has thrown Stopped.
// - GivenUp: `work` has not ended within `kPatience` of the request, since it may be in code that does not poll (a
//   library, a plugin, the system). It keeps running: everything it refers to must stay alive until the process ends,
//   and the request stays set.
enum class WorkEnd { Done, Stopped, GivenUp };
WorkEnd RunUntilStopped(std::function<void()> work);
bool HasGivenUpWork();
inline constexpr double kPatience = 0.5;  // seconds

// Requests a stop, from a separate thread, if the work is still running `kGrace` after an interrupt or after its time
// has run out. The destructor withdraws the request unless work was given up.
class StopWatch {
 public:
  // Seconds. A pass that is about to end gets the time to do so.
  static constexpr double kGrace = 0.5;

  // `interrupted`: set by a signal handler; null: no interrupts. `seconds`: the time from now on; absent: unlimited.
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
