// Resource usage of this process so far.
#pragma once

namespace lampyr {

// Peak resident set size, MiB.
double PeakMemoryMiB();
// CPU time, user and system, seconds.
double CpuSeconds();

}  // namespace lampyr
