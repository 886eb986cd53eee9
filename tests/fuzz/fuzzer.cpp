// The entry that libFuzzer calls, once for each target: LAMPYR_FUZZ_TARGET is its function.
#include <cstddef>
#include <cstdint>

#include "fuzz/targets.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  lampyr::fuzz::LAMPYR_FUZZ_TARGET({reinterpret_cast<const char*>(data), size});
  return 0;
}
