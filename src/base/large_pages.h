// Allocation of large pages (random reads rarely miss the TLB) and of pages on demand.
#pragma once

#include <cstddef>

namespace lampyr {

constexpr size_t kLargePage = size_t{2} << 20;

// Allocates at least `bytes`, aligned to a large page and rounded up to whole ones; to be released with std::free.
// Throws std::bad_alloc. A system without large pages gives ordinary ones.
void* TakeLargePages(size_t bytes);

// Allocates `bytes` of zeros, which the system provides page by page on first access: a large table costs memory only
// where it is used. To be released with GiveBackPages and the same size. Throws std::bad_alloc.
void* TakePagesOnDemand(size_t bytes);
void GiveBackPages(void* memory, size_t bytes);

}  // namespace lampyr
