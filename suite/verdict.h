// Summary of the suite's results: one verdict for each light and property, over all its cases.
#pragma once

#include <string>
#include <vector>

#include "suite/pdf_suite.h"

namespace lampyr {

struct LightVerdict {
  std::string light, property;
  size_t cases = 0;
  bool passed = true;  // in every case
  SuiteResult worst;   // the case that is nearest to failing, or that fails most clearly
};

// One line that explains the property of the verdict.
std::string MeaningOfVerdict(const LightVerdict& verdict);

// One verdict for each light and property, in the order of their first results.
std::vector<LightVerdict> SummariseByProperty(const std::vector<SuiteResult>& results);

}  // namespace lampyr
