// Output of `lampyr compare`.
#pragma once

#include <filesystem>
#include <string>

#include "app/compare/results.h"

namespace lampyr {

// results.json: everything but the pictures.
std::string ToJson(const ComparisonResults& results);

// results.csv: a line for each integrator and budget; unknown values are empty fields.
std::string ToCsv(const ComparisonResults& results);

// report.html: the page with results and pictures in it. Empty when this build has no page (npm was not there).
std::string ToPage(const ComparisonResults& results);

// For the terminal: tables of a width of 100 characters.
std::string ToText(const ComparisonResults& results);

}  // namespace lampyr
