// Some tests look at a part of what they could: at each kind of case, but not at each pair of them.
#pragma once

#include <cstdlib>

namespace lampyr::test {

// True in `tests/run long` and `tests/run matrix-whole`: they look at all.
inline bool IsWhole() {
  return std::getenv("LAMPYR_WHOLE") != nullptr;
}

}  // namespace lampyr::test
