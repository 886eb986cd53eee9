// Parallel loops over independent items. The result of an item must not depend on the thread that computes it, nor on
// the order.
#pragma once

#include <cstdint>
#include <functional>
#include <span>

namespace lampyr {

// Hardware threads of this machine, at least 1.
int HardwareThreads();

// Flushes denormal floats to zero: rays with denormal components are several times slower otherwise. To be called at
// the start of main, before anything parallel: worker threads inherit the setting when they start, and only then.
void FlushDenormalsToZero();

// Calls body(0) … body(count - 1) on at most `threads` threads. Rethrows an exception of a body.
void ParallelFor(int count, int threads, const std::function<void(int)>& body);

// Sorts by key, ties by item. If all items are distinct, the order does not depend on `threads`.
struct SortItem {
  uint64_t key = 0;
  uint32_t item = 0;
};
void ParallelSort(std::span<SortItem> items, int threads);

}  // namespace lampyr
