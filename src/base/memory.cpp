#include "base/memory.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>

namespace lampyr {

namespace {

// Memory limit of the control group (version 2) of this process in bytes; UINT64_MAX if there is none.
uint64_t GroupMemory() {
  uint64_t least = UINT64_MAX;
  std::ifstream groups("/proc/self/cgroup");
  for (std::string line; std::getline(groups, line);) {
    if (!line.starts_with("0::")) continue;
    // A parent group may have a lower limit.
    for (std::string group = line.substr(3);; group.resize(std::min(group.rfind('/'), group.size()))) {
      uint64_t bytes = 0;
      if (std::ifstream("/sys/fs/cgroup" + group + "/memory.max") >> bytes) least = std::min(least, bytes);
      if (group.empty()) break;
    }
  }
  return least;
}

}  // namespace

uint64_t AvailableMemory() {
  static const uint64_t machine = std::min(
      static_cast<uint64_t>(sysconf(_SC_PHYS_PAGES)) * static_cast<uint64_t>(sysconf(_SC_PAGESIZE)), GroupMemory());
  rlimit space{};
  if (getrlimit(RLIMIT_AS, &space) != 0 || space.rlim_cur == RLIM_INFINITY) return machine;
  return std::min(machine, static_cast<uint64_t>(space.rlim_cur));
}

std::string FormatBytes(double bytes) {
  constexpr const char* units[] = {"bytes", "KiB", "MiB", "GiB", "TiB"};
  size_t unit = 0;
  for (; bytes >= 1024 && unit + 1 < std::size(units); ++unit) bytes /= 1024;
  char text[64];
  std::snprintf(text, sizeof text, unit > 0 && bytes < 10 ? "%.1f %s" : "%.0f %s", bytes, units[unit]);
  return text;
}

void MemoryBudget::Take(double bytes, const FileLocation& where, const std::string& what) {
  if (taken_ + bytes > bytes_) {
    const std::string before = taken_ > 0 ? " besides the " + FormatBytes(taken_) + " of the scene before them" : "";
    throw Error(where, what + " take " + FormatBytes(bytes) + " of memory" + before + ", and there are " +
                           FormatBytes(bytes_) + " in all");
  }
  taken_ += bytes;
}

double PeakMemoryMiB() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

double CpuSeconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

}  // namespace lampyr
