// The loops of parallel.h on plain threads, for ThreadSanitizer: TBB is built without it, so that ThreadSanitizer does
// not see TBB's own synchronization and reports false races.
#if defined(__SANITIZE_THREAD__)

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "base/parallel.h"

namespace lampyr {

void ParallelFor(int count, int threads, const std::function<void(int)>& body) {
  if (threads <= 1 || count <= 1) {
    for (int i = 0; i < count; ++i) body(i);
    return;
  }
  std::atomic<int> next{0};
  std::mutex mutex;
  std::exception_ptr first;
  const auto work = [&] {
    FlushDenormalsToZero();
    try {
      for (int i; (i = next.fetch_add(1, std::memory_order_relaxed)) < count;) body(i);
    } catch (...) {
      const std::lock_guard lock(mutex);
      if (!first) first = std::current_exception();
    }
  };
  {
    std::vector<std::jthread> workers;
    for (int i = 0; i < std::min(threads, count); ++i) workers.emplace_back(work);
  }
  if (first) std::rethrow_exception(first);
}

}  // namespace lampyr

#endif
