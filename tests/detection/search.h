// The result of a method for one fault, and the runs of methods: with more and more samples, until they find the fault
// or have used up their time.
#pragma once

#include <cstdint>
#include <ctime>
#include <filesystem>
#include <string>

#include "detection/faults.h"
#include "detection/subjects.h"
#include "suite/pdf_suite.h"

namespace lampyr::test {

// All methods look several times at growing numbers of samples. Each look is at the Šidák level of so many, so that a
// sound light is rejected by one of them with a probability of 1e-3.
inline constexpr double kFamilyWise = 1e-3;

struct Finding {
  bool found = false;
  bool applies = true;   // false: the method has nothing that it could look at
  uint64_t samples = 0;  // of the look that found it, or of the last one
  double seconds = 0;    // of CPU, over all looks
  uint64_t draws = 0;    // of each sampling function in that look, where it is functions that are tested
  std::string property;  // what failed
};

// Least time of each baseline; otherwise it gets the time that our proofs took.
inline constexpr double kLeastSeconds = 1;

inline double CpuSeconds() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

// The suite: on the light in one place first; then over its type, as `check-lights` runs it.
Finding FindBySuite(const LightSubject& subject, const LightFault* fault, const std::filesystem::path& scratch);
// The suite of filters.
Finding FindBySuite(const FilterSubject& subject, const FilterFault* fault, const std::filesystem::path& scratch);

}  // namespace lampyr::test
