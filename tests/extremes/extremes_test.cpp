// Every row of the table, and the table of the documentation against what was measured.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <set>

#include "extremes/table.h"

namespace lampyr::test {
namespace {

const std::filesystem::path kPage = std::filesystem::path(LAMPYR_SOURCE_DIR) / "docs" / "extremes.md";
const std::filesystem::path kWritten = LAMPYR_EXTREMES_FOLDER;

void Write(const std::filesystem::path& file, const std::string& text) {
  std::filesystem::create_directories(file.parent_path());
  std::ofstream(file) << text;
}

// Sections in the order of the groups, when all of them are measured by one process.
std::vector<std::string>& Sections() {
  static std::vector<std::string> sections;
  return sections;
}

class ExtremesTable : public testing::TestWithParam<ExtremeGroup> {};

TEST_P(ExtremesTable, EveryRowIsRight) {
  const ExtremeGroup& group = GetParam();
  const std::vector<ExtremeCase> cases = group.cases();
  const char* only = std::getenv("LAMPYR_EXTREME");  // a part of the name of the cases that are wanted
  std::vector<Row> rows;
  std::set<std::string> names;
  size_t values = 0;
  for (const ExtremeCase& extreme : cases) {
    if (only && extreme.name.find(only) == std::string::npos) continue;
    EXPECT_TRUE(names.insert(extreme.name).second) << "two cases are called " << extreme.name;
    const std::clock_t start = std::clock();
    rows.push_back(Measure(extreme));
    const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
    if (seconds > 1) std::printf("%s took %.1f s\n", extreme.name.c_str(), seconds);
    values += rows.back().measured.size();
    for (const std::string& fault : rows.back().faults) ADD_FAILURE() << extreme.name << "\n  " << fault;
  }
  const std::string section = SectionOf(group, rows);
  std::printf("%s: %zu cases, %zu values\n", group.title, rows.size(), values);
  if (only) {
    std::printf("%s", section.c_str());
    return;
  }
  Write(kWritten / (std::string(group.name) + ".md"), section);
  Write(kWritten / (std::string(group.name) + ".count"),
        std::to_string(rows.size()) + " " + std::to_string(values) + "\n");
  if (std::getenv("LAMPYR_WRITE_TABLES")) {
    Sections().push_back(section);
    if (Sections().size() == ExtremeGroups().size()) Write(kPage, PageOf(Sections()));
    return;
  }
  std::ifstream stream(kPage);
  const std::string page{std::istreambuf_iterator<char>(stream), {}};
  EXPECT_THAT(ClaimsOf(page, group.title), testing::ElementsAreArray(ClaimsOf(section, group.title)))
      << kPage << " is not what is measured: write it anew as it says at its top";
}

INSTANTIATE_TEST_SUITE_P(Of, ExtremesTable, testing::ValuesIn(ExtremeGroups()),
                         [](const auto& info) { return info.param.name; });

}  // namespace

void PrintTo(const ExtremeGroup& group, std::ostream* stream) {
  *stream << group.title;
}

}  // namespace lampyr::test
