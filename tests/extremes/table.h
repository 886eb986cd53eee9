// The table of extremes as a page of the documentation: what the suite found, row by row.
#pragma once

#include <string>
#include <vector>

#include "extremes/measurement.h"

namespace lampyr::test {

// A section: title, count and rows.
std::string SectionOf(const ExtremeGroup& group, const std::vector<Row>& rows);
// The page above and its sections.
std::string PageOf(const std::vector<std::string>& sections);

// The parts of the page that must equal the measurement: for each row of the section with that title, its case, the
// expected value and the verdict; not the noise.
std::vector<std::string> ClaimsOf(const std::string& page, const std::string& title);

}  // namespace lampyr::test
