// An array for tables of many megabytes that are read at random places.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <new>
#include <type_traits>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace lampyr {

// `count` values of all bits 0, on large pages where the system has them: a read at a random place then hardly ever
// waits for page tables, which is a tenth of its time. Movable, not copyable.
template <class T>
class LargeArray {
  static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);

 public:
  LargeArray() = default;
  explicit LargeArray(size_t count) : size_(count) {
    if (count == 0) return;
    constexpr size_t kPage = size_t{2} << 20;
    const size_t bytes = (count * sizeof(T) + kPage - 1) / kPage * kPage;
    const bool isLarge = count * sizeof(T) >= kPage;
    const size_t taken = isLarge ? bytes : count * sizeof(T);
    T* memory = static_cast<T*>(
        std::aligned_alloc(isLarge ? kPage : std::max(alignof(T), alignof(std::max_align_t)), RoundedUp(taken)));
    if (!memory) throw std::bad_alloc();
    data_.reset(memory);
#if defined(__linux__)
    if (isLarge) madvise(memory, bytes, MADV_HUGEPAGE);  // advice only: the array is there without it
#endif
    std::memset(static_cast<void*>(memory), 0, taken);
  }

  size_t Size() const {
    return size_;
  }
  T& operator[](size_t i) {
    return data_[i];
  }
  const T& operator[](size_t i) const {
    return data_[i];
  }

 private:
  // aligned_alloc takes whole multiples of the alignment.
  static size_t RoundedUp(size_t bytes) {
    constexpr size_t unit = std::max(alignof(T), alignof(std::max_align_t));
    return (bytes + unit - 1) / unit * unit;
  }
  struct Free {
    void operator()(T* memory) const { std::free(memory); }
  };
  std::unique_ptr<T[], Free> data_;
  size_t size_ = 0;
};

}  // namespace lampyr
