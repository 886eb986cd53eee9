#include "base/parallel.h"

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <thread>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace lampyr {

int HardwareThreads() {
  return std::max(1u, std::thread::hardware_concurrency());
}

void FlushDenormalsToZero() {
#if defined(__x86_64__)
  constexpr unsigned flushToZero = 0x8000, denormalsAreZero = 0x0040;
  _mm_setcsr(_mm_getcsr() | flushToZero | denormalsAreZero);
#endif
}

// parallel_threads.cpp has the implementation for ThreadSanitizer.
#if !defined(__SANITIZE_THREAD__)

namespace {

// Restores the floating-point control register of the calling thread after a loop.
class KeptFloatSetting {
 public:
#if defined(__x86_64__)
  ~KeptFloatSetting() {
    _mm_setcsr(setting_);
  }

 private:
  unsigned setting_ = _mm_getcsr();
#endif
};

}  // namespace

void ParallelFor(int count, int threads, const std::function<void(int)>& body) {
  if (threads <= 1 || count <= 1) {
    for (int i = 0; i < count; ++i) body(i);
    return;
  }
  // `threads` may exceed the number of hardware threads.
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                  static_cast<size_t>(std::max(threads, HardwareThreads())));
  tbb::task_arena arena(threads);
  [[maybe_unused]] const KeptFloatSetting kept;
  arena.execute([&] {
    // One item at a time: items (tiles) are large and of uneven cost.
    tbb::parallel_for(
        tbb::blocked_range<int>(0, count, 1),
        [&](const tbb::blocked_range<int>& range) {
          FlushDenormalsToZero();  // TBB resets the calling thread's setting
          for (int i = range.begin(); i < range.end(); ++i) body(i);
        },
        tbb::simple_partitioner());
  });
}

#endif

}  // namespace lampyr
