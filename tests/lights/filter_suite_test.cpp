// The filter suite over every built-in filter.
#include <gtest/gtest.h>

#include <map>

#include "suite/filter_suite.h"
#include "suite/verdict.h"
#include "support/temporary_folder.h"
#include "support/whole.h"

namespace lampyr::test {
namespace {

std::vector<SuiteResult> RunWith(const std::vector<FilterType>& types, uint64_t seed) {
  const TemporaryFolder folder;
  SuiteOptions options;
  options.seed = seed;
  options.threads = 0;  // all: the results are the same
  return RunFilterSuite(types, folder.Path(), options);
}

TEST(FilterSuite, EveryRegisteredFilterPassesWithManySeeds) {
  size_t cases = 0;
  const uint64_t seeds = IsWhole() ? 20 : 5;
  for (uint64_t seed = 1; seed <= seeds; ++seed) {
    const std::vector<SuiteResult> results = RunWith(FilterRegistry(), seed);
    cases += results.size();
    for (const LightVerdict& verdict : SummariseByProperty(results)) {
      EXPECT_TRUE(verdict.passed) << "seed " << seed << ": " << verdict.light << " " << verdict.property << " by "
                                  << verdict.worst.statistic << " (" << verdict.worst.threshold
                                  << "): " << verdict.worst.caseName;
    }
  }
  std::printf("[   info   ] %zu cases of filters\n", cases);
}

// Each type is looked at, in each property that its table has the parameters for.
TEST(FilterSuite, LooksAtEachTypeInAllItsProperties) {
  std::map<std::string, std::map<std::string, size_t>> seen;  // by type and property
  for (const SuiteResult& result : RunWith(FilterRegistry(), 1)) {
    const size_t begin = std::string("filter ").size();
    ++seen[result.light.substr(begin, result.light.find('[') - begin)][result.property];
    EXPECT_NE(FilterPropertyMeaning(result.property), "") << result.property;
  }
  const std::vector<std::string> ofAll = {"samples", "repeat", "batch",  "threads", "time",     "light-pdf",
                                          "valid",   "light",  "groups", "combine", "placement"};
  const std::vector<std::string> ofCommon = {"identity", "density", "invert", "lobes", "coordsys", "motion"};
  for (const FilterType& type : FilterRegistry()) {
    EXPECT_FALSE(type.samples.empty()) << type.name << " has no sample blocks";
    for (const std::string& property : ofAll) EXPECT_GT(seen[type.name][property], 0u) << type.name << " " << property;
    for (const std::string& property : ofCommon) {
      EXPECT_EQ(seen[type.name][property] > 0, type.name != "combiner") << type.name << " " << property;
    }
  }
  EXPECT_GT(seen["intmult"]["modifier"], 0u);
}

TEST(FilterSuite, GivesTheSameOnAnyNumberOfThreads) {
  const TemporaryFolder folder;
  SuiteOptions options;
  const std::vector<FilterType> types = {*FindFilterType("barn")};
  const std::vector<SuiteResult> one = RunFilterSuite(types, folder.Path(), options);
  options.threads = 3;
  const std::vector<SuiteResult> three = RunFilterSuite(types, folder.Path(), options);
  ASSERT_EQ(one.size(), three.size());
  for (size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].caseName, three[i].caseName);
    EXPECT_EQ(one[i].statistic, three[i].statistic);
  }
}

TEST(FilterSuite, FailsATypeWithoutSamples) {
  FilterType type = *FindFilterType("barn");
  type.samples.clear();
  const std::vector<SuiteResult> results = RunWith({type}, 1);
  ASSERT_EQ(results.size(), 1u);
  EXPECT_FALSE(results[0].passed);
  EXPECT_EQ(results[0].property, "samples");
}

}  // namespace
}  // namespace lampyr::test
