// What each property of the suite means, in a line: for those whose light fails it.
#pragma once

#include <string>
#include <vector>

namespace lampyr {

struct PropertyMeaning {
  std::string name, meaning;
};

// All of the suite's, in the order in which pdf_suite.h lists them.
const std::vector<PropertyMeaning>& PropertyMeanings();
// "" for what is none.
std::string MeaningOf(const std::string& property);

}  // namespace lampyr
