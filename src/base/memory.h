// How much memory there is, and counting what a scene asks for before it is taken: a file of a few lines can ask for
// more than any machine has, and the system would end the process for it without a word.
#pragma once

#include <cstdint>
#include <string>

#include "base/error.h"

namespace lampyr {

// Of this machine, or less where the process was given less (ulimit -v, a container). Bytes.
uint64_t AvailableMemory();

// "3.2 GiB", "512 MiB": of two digits at least.
std::string FormatBytes(double bytes);

class MemoryBudget {
 public:
  explicit MemoryBudget(uint64_t bytes) : bytes_(static_cast<double>(bytes)) {}

  // Throws an Error at `where` when these bytes are more than what is left. `what`: who takes them, plural.
  void Take(double bytes, const FileLocation& where, const std::string& what);

 private:
  double bytes_, taken_ = 0;
};

}  // namespace lampyr
