// Output of `lampyr compare`.
#pragma once

#include <filesystem>
#include <string>

#include "app/compare/results.h"

namespace lampyr {

// results.json: all results except the pictures.
std::string ToJson(const ComparisonResults& results);

// results.csv: a line for each integrator and budget; unknown values are empty fields.
std::string ToCsv(const ComparisonResults& results);

// report.html: the page with results and pictures embedded. Empty if this build has no page (npm was not available).
std::string ToPage(const ComparisonResults& results);

// Tables for the terminal, 100 characters wide.
std::string ToText(const ComparisonResults& results);

}  // namespace lampyr
