// Available memory, and a budget that is checked before allocation: a scene file of a few lines can require more memory
// than any machine has, and the system would then kill the process without a message.
#pragma once

#include <cstdint>
#include <string>

#include "base/error.h"

namespace lampyr {

// Bytes of physical memory of this machine, or the limit of the process if that is lower (ulimit -v, a container).
uint64_t AvailableMemory();

// "3.2 GiB", "512 MiB", "7 bytes": at least two digits from 1 KiB on.
std::string FormatBytes(double bytes);

class MemoryBudget {
 public:
  explicit MemoryBudget(uint64_t bytes) : bytes_(static_cast<double>(bytes)) {}

  // Throws an Error at `where` if `bytes` exceeds the rest of the budget. `what`: the objects that need the memory,
  // plural.
  void Take(double bytes, const FileLocation& where, const std::string& what);

 private:
  double bytes_, taken_ = 0;
};

// Peak resident set size, MiB.
double PeakMemoryMiB();
// CPU time, user and system, seconds.
double CpuSeconds();

}  // namespace lampyr
