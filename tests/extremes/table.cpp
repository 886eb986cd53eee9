#include "extremes/table.h"

#include <cmath>
#include <sstream>

namespace lampyr::test {

namespace {

std::string Text(const char* format, double value) {
  char text[40];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

std::vector<std::string> CellsOf(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream stream(line.substr(1));
  for (std::string cell; std::getline(stream, cell, '|');) {
    const size_t from = cell.find_first_not_of(' '), to = cell.find_last_not_of(' ');
    cells.push_back(from == std::string::npos ? "" : cell.substr(from, to - from + 1));
  }
  return cells;
}

}  // namespace

std::string SectionOf(const ExtremeGroup& group, const std::vector<Row>& rows) {
  size_t values = 0;
  for (const Row& row : rows) values += row.measured.size();
  std::string text = std::string("## ") + group.title + "\n\n" + std::to_string(rows.size()) + " cases, " +
                     std::to_string(values) + " values.\n\n" +
                     "| case | expected | measured | relative error | ± | by | dropped | verdict |\n"
                     "|---|---|---|---|---|---|---|---|\n";
  for (const Row& row : rows) {
    const Measured& worst = row.Worst();
    const double expected = row.of->expected;
    std::string by;
    for (const Measured& measured : row.measured) {
      by += (by.empty() ? "" : " ") + (&measured == &worst ? "**" + measured.integrator + "**" : measured.integrator);
    }
    uint64_t dropped = 0;
    for (const Measured& measured : row.measured) dropped += measured.dropped;
    const double error = worst.RelativeError(expected);
    text += "| " + row.of->name + " | " + Text("%.6g", expected) + " | " + Text("%.6g", worst.mean) + " | " +
            (expected > 0 ? Text("%+.1e", error) : "0") + " | " +
            (expected > 0 ? Text("%.0e", worst.standardError / expected) : "0") + " | " + by + " | " +
            std::to_string(dropped) + " | " + row.Verdict() + " |\n";
  }
  return text;
}

std::string PageOf(const std::vector<std::string>& sections) {
  std::string page = R"(# Extremes

Renders at extreme sizes, distances, intensities and angles, and with extreme materials and photon settings: a value that is known in
closed form, against that of each integrator. Written by the suite (`LAMPYR_WRITE_TABLES=1 build/release/tests/test_extremes --gtest_filter='*Table*'`),
which compares cases, expected values and verdicts with this page whenever it runs.

A row has the integrator that is farthest off (bold), its relative error, and one standard error of it (±, from 16 renders with other
seeds). *right*: all of the integrators named are within their noise (family-wise 1e-3) and 0.1 % of rounding and blur, every pixel is
finite, and nothing was dropped. *limit*: what floats or photons cannot do; the value is the one that is to be expected then, and a warning says so
when the scene is read. Most rows are a patch of floor of reflectance 0.5, as in `tests/extremes/floor_rig.h`; radiance in W/(m² sr).
)";
  for (const std::string& section : sections) page += "\n" + section;
  return page;
}

std::vector<std::string> ClaimsOf(const std::string& page, const std::string& title) {
  std::vector<std::string> claims;
  std::istringstream stream(page);
  bool isInside = false;
  for (std::string line; std::getline(stream, line);) {
    if (line.starts_with("## ")) isInside = line == "## " + title;
    if (!isInside || !line.starts_with("| ") || line.starts_with("| case ")) continue;
    const std::vector<std::string> cells = CellsOf(line);
    if (cells.size() == 8) claims.push_back(cells[0] + " | " + cells[1] + " | " + cells[7]);
  }
  return claims;
}

}  // namespace lampyr::test
