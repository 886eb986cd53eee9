// Memory on large pages, where the system has them: reads at random places of it hardly ever wait for page tables.
#pragma once

#include <cstddef>

namespace lampyr {

constexpr size_t kLargePage = size_t{2} << 20;

// At least `bytes`, from the beginning of a large page to the end of one; given back with std::free. Throws
// std::bad_alloc. A system without such pages gives ordinary ones.
void* TakeLargePages(size_t bytes);

// `bytes` of zeros that the system provides page by page, when they are first touched: a large table of which little is
// used costs little. Given back with GiveBackPages, of the same size. Throws std::bad_alloc.
void* TakePagesOnDemand(size_t bytes);
void GiveBackPages(void* memory, size_t bytes);

}  // namespace lampyr
