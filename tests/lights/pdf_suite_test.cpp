// The pdf consistency suite over every built-in light: its sample blocks × shapes × transforms × receivers.
#include <gtest/gtest.h>

#include <iostream>
#include <map>

#include "suite/pdf_suite.h"
#include "support/whole.h"

namespace lampyr::test {
namespace {

TEST(PdfSuite, EveryRegisteredLightPasses) {
  const std::filesystem::path folder = std::filesystem::path(::testing::TempDir()) / "lampyr-pdf-suite";
  std::filesystem::create_directories(folder);
  SuiteOptions options;
  // Every block of every type, and of its placements some: each of the ten in turn, as neither number divides ten.
  // `lampyr check-lights` looks at all, in minutes; so does `tests/run seeds`.
  options.caseEvery = IsWhole() ? 3 : 17;
  options.editEvery = IsWhole() ? 1 : 7;
  options.thoroughEvery = 8;
  options.threads = 0;  // all: the results are the same
  const std::vector<SuiteResult> results = RunPdfSuite(LightRegistry(), folder, options);
  std::map<std::string, std::pair<int, int>> byProperty;  // tests, failures
  int reported = 0;
  for (const SuiteResult& result : results) {
    auto& [tests, failures] = byProperty[result.property];
    ++tests;
    if (result.passed) continue;
    ++failures;
    if (reported++ < 100) {
      ADD_FAILURE() << result.light << " | " << result.property << " | " << result.caseName << ": "
                    << (result.isProbability ? "p-value " : "error ") << result.statistic << ", threshold "
                    << result.threshold;
    }
  }
  for (const auto& [property, counts] : byProperty) {
    std::cout << property << ": " << counts.first << " cases, " << counts.second << " failed\n";
  }
  std::cout << results.size() << " cases in all\n";
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace lampyr::test
