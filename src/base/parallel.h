// Parallel loops over independent items. The result of an item must not depend on the thread that computes it, nor on
// the order.
#pragma once

#include <functional>

namespace lampyr {

// Hardware threads of this machine, at least 1.
int HardwareThreads();

// Flushes denormal floats to zero: rays with denormal components are several times slower otherwise. To be called at
// the start of main, before anything parallel: worker threads inherit the setting when they start, and only then.
void FlushDenormalsToZero();

// Calls body(0) … body(count - 1) on at most `threads` threads. Rethrows an exception of a body.
void ParallelFor(int count, int threads, const std::function<void(int)>& body);

}  // namespace lampyr
