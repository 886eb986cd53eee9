// Arrays for tables of many megabytes with random access.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <new>
#include <type_traits>

#include "base/large_pages.h"

namespace lampyr {

// `count` values, zero-initialized unless they are made ForOverwrite, on large pages if the system has them. Random
// reads then rarely miss the TLB, which saves a tenth of their time. Movable, not copyable.
template <class T>
class LargeArray {
  static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);

 public:
  LargeArray() = default;
  explicit LargeArray(size_t count) : LargeArray(ForOverwrite(count)) {
    if (count > 0) std::memset(static_cast<void*>(data_.get()), 0, count * sizeof(T));
  }
  // Uninitialised values, to be assigned before they are read.
  static LargeArray ForOverwrite(size_t count) {
    LargeArray array;
    array.size_ = count;
    if (count == 0) return array;
    const size_t bytes = count * sizeof(T);
    array.data_.reset(static_cast<T*>(bytes >= kLargePage ? TakeLargePages(bytes) : TakeAligned(bytes)));
    return array;
  }

  size_t Size() const { return size_; }
  T& operator[](size_t i) { return data_[i]; }
  const T& operator[](size_t i) const { return data_[i]; }

 private:
  static void* TakeAligned(size_t bytes) {
    constexpr size_t unit = std::max(alignof(T), alignof(std::max_align_t));
    void* memory = std::aligned_alloc(unit, (bytes + unit - 1) / unit * unit);  // the size must be a multiple of `unit`
    if (!memory) throw std::bad_alloc();
    return memory;
  }
  struct Free {
    void operator()(T* memory) const { std::free(memory); }
  };
  std::unique_ptr<T[], Free> data_;
  size_t size_ = 0;
};

// `count` > 0 values, zero-initialized, whose pages the system allocates on first access. Not copyable.
template <class T>
class SparseArray {
  static_assert(std::is_trivially_destructible_v<T>);

 public:
  explicit SparseArray(size_t count) : data_(static_cast<T*>(TakePagesOnDemand(count * sizeof(T)))), size_(count) {}
  ~SparseArray() { GiveBackPages(data_, size_ * sizeof(T)); }
  SparseArray(const SparseArray&) = delete;
  SparseArray& operator=(const SparseArray&) = delete;

  T& operator[](size_t i) { return data_[i]; }
  const T& operator[](size_t i) const { return data_[i]; }

 private:
  T* data_;
  size_t size_;
};

}  // namespace lampyr
