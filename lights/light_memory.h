// Memory of lights. Next-event estimation reads one light at a time, at random, out of up to a million: contiguous on
// large pages, this takes half the time.
#pragma once

#include <cstddef>

namespace lampyr {

// Allocates `bytes`, aligned to a cache line. May be called from any thread. Throws std::bad_alloc.
void* TakeLightMemory(size_t bytes);
void ReturnLightMemory(void* memory, size_t bytes) noexcept;

}  // namespace lampyr
