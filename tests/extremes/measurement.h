// Renders a case by one integrator after the other, some times with other seeds, and says whether it is right.
#pragma once

#include "extremes/extreme_case.h"

namespace lampyr::test {

struct Measured {
  std::string integrator;
  double mean = 0, standardError = 0;
  uint64_t dropped = 0;  // samples, and rays that were rejected
  bool isFinite = true;  // every pixel

  double RelativeError(double expected) const;
};

struct Row {
  const ExtremeCase* of = nullptr;
  std::vector<Measured> measured;
  std::vector<std::string> warnings;  // of the scene's build
  std::vector<std::string> faults;    // what is wrong; empty: nothing is

  const Measured& Worst() const;
  // "right", or "limit" where the case has one.
  std::string Verdict() const;
};

Row Measure(const ExtremeCase& extreme);

}  // namespace lampyr::test
