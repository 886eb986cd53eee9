// Memory of large tables that are read at random: large pages, so that reads rarely miss the TLB; pages on demand; and
// a prefetch that a TLB miss does not drop.
#pragma once

#include <cstddef>
#include <cstdlib>
#include <new>
#include <vector>

namespace lampyr {

constexpr size_t kLargePage = size_t{2} << 20;

// Allocates at least `bytes`, aligned to a large page and rounded up to whole ones; to be released with std::free.
// Throws std::bad_alloc. A system without large pages gives ordinary ones.
void* TakeLargePages(size_t bytes);

// Memory of a std::vector: large pages where it fills one, so that filling it takes few page faults.
template <typename T>
struct LargePageAllocator {
  using value_type = T;
  LargePageAllocator() = default;
  template <typename U>
  LargePageAllocator(const LargePageAllocator<U>&) {}
  T* allocate(size_t count) {
    if (count > static_cast<size_t>(-1) / 2 / sizeof(T)) throw std::bad_alloc();
    const size_t bytes = count * sizeof(T);
    void* memory = bytes >= kLargePage ? TakeLargePages(bytes) : std::malloc(bytes);
    if (!memory) throw std::bad_alloc();
    return static_cast<T*>(memory);
  }
  void deallocate(T* memory, size_t) { std::free(memory); }
  bool operator==(const LargePageAllocator&) const = default;
};

template <typename T>
using LargePageVector = std::vector<T, LargePageAllocator<T>>;

// Allocates `bytes` of zeros, which the system provides page by page on first access: a large table costs memory only
// where it is used. To be released with GiveBackPages and the same size. Throws std::bad_alloc.
void* TakePagesOnDemand(size_t bytes);
void GiveBackPages(void* memory, size_t bytes);

// Reads *p and discards the value, so that the processor fetches its cache line during other work. Unlike a prefetch
// instruction the read is not dropped on a TLB miss, which is the usual case for tables of many megabytes. `p` must be
// readable.
inline void Touch(const float* p) {
  const volatile float* watched = p;
  (void)*watched;
}

// Fetches the cache line at `p` by a prefetch instruction, which is dropped on a TLB miss at worst, and never stalls.
// The empty asm counts as an effect: without it GCC considers a function that only prefetches to have no effect, and
// removes the calls that it does not inline early.
inline void Prefetch(const void* p) {
  __builtin_prefetch(p);
  asm volatile("");
}

}  // namespace lampyr
