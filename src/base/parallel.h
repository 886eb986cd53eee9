// A parallel loop over independent items. What each item computes must not depend on which thread runs it, or when.
#pragma once

#include <cstdint>
#include <functional>
#include <span>

namespace lampyr {

// Hardware threads of this machine, at least 1.
int HardwareThreads();

// Denormal floats are flushed to zero: rays with denormal components are several times slower otherwise. To be called
// once at the start of main, before anything parallel: worker threads inherit the setting when they start, and never
// later.
void FlushDenormalsToZero();

// Calls body(0) … body(count - 1) on at most `threads` threads. An exception of a body is thrown here.
void ParallelFor(int count, int threads, const std::function<void(int)>& body);

// Sorts by key; equal keys by item. Where no item is twice, there is one order, whatever the threads.
struct SortItem {
  uint64_t key = 0;
  uint32_t item = 0;
};
void ParallelSort(std::span<SortItem> items, int threads);

}  // namespace lampyr
