// Memory that will be read soon: asked for while other work goes on.
#pragma once

namespace lampyr {

// A read whose value nobody waits for. Unlike a prefetch instruction it is not dropped where the address is not in the
// processor's page tables, which for tables of many megabytes is the usual case. `p` has to be readable.
inline void Touch(const float* p) {
  const volatile float* watched = p;
  (void)*watched;
}

}  // namespace lampyr
