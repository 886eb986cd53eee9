// Where lights are kept. A scene may have a million of them, of which next-event estimation reads one at a time, at
// random places: one after the other on large pages, they are read in half the time.
#pragma once

#include <cstddef>

namespace lampyr {

// Memory of `bytes` that begins at a line of the cache. From any thread. Throws std::bad_alloc.
void* TakeLightMemory(size_t bytes);
void ReturnLightMemory(void* memory, size_t bytes) noexcept;

}  // namespace lampyr
