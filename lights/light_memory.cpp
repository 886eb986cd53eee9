#include "lights/light_memory.h"

#include <cstdint>
#include <cstdlib>
#include <mutex>
#include <new>

#include "base/large_pages.h"

namespace lampyr {

namespace {

constexpr size_t kLine = 64;

// Header of a page: bytes taken from it, and number of lights that are still allocated in it.
struct Page {
  size_t taken = kLine;
  size_t lights = 0;
};
static_assert(sizeof(Page) <= kLine);

std::mutex mutex;
Page* open = nullptr;  // the page that lights are put on

size_t Rounded(size_t bytes) {
  return (bytes + kLine - 1) / kLine * kLine;
}
// True for allocations too large to share a page; they are made separately.
bool HasOwn(size_t bytes) {
  return bytes > kLargePage / 16;
}

Page* PageOf(void* memory) {
  return reinterpret_cast<Page*>(reinterpret_cast<uintptr_t>(memory) / kLargePage * kLargePage);
}

}  // namespace

void* TakeLightMemory(size_t bytes) {
  if (HasOwn(bytes)) return ::operator new (bytes, std::align_val_t{kLine});
  const std::lock_guard lock(mutex);
  if (!open || open->taken + bytes > kLargePage) {
    open = new (TakeLargePages(kLargePage)) Page;
  }
  void* memory = reinterpret_cast<std::byte*>(open) + open->taken;
  open->taken += Rounded(bytes);
  ++open->lights;
  return memory;
}

void ReturnLightMemory(void* memory, size_t bytes) noexcept {
  if (!memory) return;
  if (HasOwn(bytes)) return ::operator delete (memory, std::align_val_t{kLine});
  const std::lock_guard lock(mutex);
  Page* page = PageOf(memory);
  if (--page->lights > 0) return;
  if (page == open) {
    page->taken = kLine;
  } else {
    std::free(page);
  }
}

}  // namespace lampyr
