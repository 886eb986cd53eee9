// What this process has used so far.
#pragma once

namespace lampyr {

// Largest resident set, MiB.
double PeakMemoryMiB();
// CPU time, user and system, seconds.
double CpuSeconds();

}  // namespace lampyr
