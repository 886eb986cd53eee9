#include "base/stop.h"

#include <algorithm>
#include <chrono>
#include <exception>
#include <memory>

namespace lampyr {

namespace {

using Clock = std::chrono::steady_clock;

// Polling interval: a signal handler cannot notify a condition variable, and a stop need not be faster.
constexpr std::chrono::milliseconds kLook(50);

std::atomic<bool> hasGivenUp{false};

Clock::time_point After(double seconds) {
  return Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
}

}  // namespace

namespace stop {

// On a cache line of its own: neighbouring writes must not slow down the polling loops.
alignas(64) std::atomic<bool> requested{false};

void Throw() {
  throw Stopped{};
}

}  // namespace stop

void RequestStop() {
  stop::requested.store(true);
}

bool HasGivenUpWork() {
  return hasGivenUp.load();
}

void WithdrawStop() {
  if (!hasGivenUp.load()) stop::requested.store(false);
}

WorkEnd RunUntilStopped(std::function<void()> work) {
  struct Shared {
    std::function<void()> work;
    std::mutex mutex;
    std::condition_variable ended;
    bool hasEnded = false, wasStopped = false;
    std::exception_ptr exception;
  };
  const auto shared = std::make_shared<Shared>();
  shared->work = std::move(work);
  std::thread thread([shared] {
    bool wasStopped = false;
    std::exception_ptr exception;
    try {
      shared->work();
    } catch (const Stopped&) {
      wasStopped = true;
    } catch (...) {
      exception = std::current_exception();
    }
    const std::lock_guard lock(shared->mutex);
    shared->hasEnded = true;
    shared->wasStopped = wasStopped;
    shared->exception = exception;
    shared->ended.notify_one();
  });
  std::optional<Clock::time_point> end;
  std::unique_lock lock(shared->mutex);
  while (!shared->ended.wait_for(lock, kLook, [&] { return shared->hasEnded; })) {
    if (!stop::requested.load()) continue;
    if (!end) end = After(kPatience);
    if (Clock::now() < *end) continue;
    hasGivenUp.store(true);
    thread.detach();
    return WorkEnd::GivenUp;
  }
  lock.unlock();
  thread.join();
  if (shared->exception) std::rethrow_exception(shared->exception);
  return shared->wasStopped ? WorkEnd::Stopped : WorkEnd::Done;
}

StopWatch::StopWatch(const std::atomic<bool>* interrupted, std::optional<double> seconds) {
  if (interrupted || seconds) thread_ = std::thread([=, this] { Watch(interrupted, seconds); });
}

StopWatch::~StopWatch() {
  {
    const std::lock_guard lock(mutex_);
    hasEnded_ = true;
  }
  ended_.notify_one();
  if (thread_.joinable()) thread_.join();
  WithdrawStop();
}

void StopWatch::Watch(const std::atomic<bool>* interrupted, std::optional<double> seconds) {
  constexpr double never = 1e9;
  Clock::time_point end = After(std::min(seconds.value_or(never), never) + kGrace);
  bool wasInterrupted = false;
  std::unique_lock lock(mutex_);
  while (!hasEnded_) {
    if (!wasInterrupted && interrupted && interrupted->load()) {
      wasInterrupted = true;
      end = std::min(end, After(kGrace));
    }
    const Clock::time_point now = Clock::now();
    if (now >= end) return RequestStop();
    ended_.wait_until(lock, interrupted ? std::min(end, now + kLook) : end, [this] { return hasEnded_; });
  }
}

}  // namespace lampyr
