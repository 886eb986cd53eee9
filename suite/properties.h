// One-line meaning of each property of the suite, for authors whose light fails it.
#pragma once

#include <string>
#include <vector>

namespace lampyr {

struct PropertyMeaning {
  std::string name, meaning;
};

// All properties of the suite, in the order in which pdf_suite.h lists them.
const std::vector<PropertyMeaning>& PropertyMeanings();
// Meaning of a property; empty if there is none of that name.
std::string MeaningOf(const std::string& property);

}  // namespace lampyr
