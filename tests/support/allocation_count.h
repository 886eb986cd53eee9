// How often a test's program has asked for memory, for tests that say that something does not.
#pragma once

#include <cstdint>

namespace lampyr::test {

uint64_t AllocationCount();

}  // namespace lampyr::test
