// Software prefetch by a read.
#pragma once

namespace lampyr {

// Reads *p and discards the value, so that the processor fetches its cache line while other work goes on. Unlike a
// prefetch instruction the read is not dropped on a TLB miss, which is the usual case for tables of many megabytes. `p`
// must be readable.
inline void Touch(const float* p) {
  const volatile float* watched = p;
  (void)*watched;
}

}  // namespace lampyr
