#include "suite/verdict.h"

#include <limits>
#include <map>
#include <utility>

#include "suite/filter_suite.h"
#include "suite/properties.h"

namespace lampyr {

namespace {

constexpr double kHopeless = std::numeric_limits<double>::max();

// Measure of failure, comparable among the statistics of one property: above 1 fails.
double Badness(const SuiteResult& result) {
  if (result.isProbability) return result.statistic > 0 ? result.threshold / result.statistic : kHopeless;
  return result.threshold > 0 ? result.statistic / result.threshold : (result.statistic > 0 ? kHopeless : 0.0);
}

}  // namespace

std::string MeaningOfVerdict(const LightVerdict& verdict) {
  const bool isFilter = verdict.light.starts_with("filter ");
  return isFilter ? FilterPropertyMeaning(verdict.property) : MeaningOf(verdict.property);
}

std::vector<LightVerdict> SummariseByProperty(const std::vector<SuiteResult>& results) {
  std::vector<LightVerdict> verdicts;
  std::map<std::pair<std::string, std::string>, size_t> rows;
  for (const SuiteResult& result : results) {
    const auto [row, isNew] = rows.try_emplace({result.light, result.property}, verdicts.size());
    if (isNew) verdicts.push_back({result.light, result.property, 0, true, result});
    LightVerdict& verdict = verdicts[row->second];
    ++verdict.cases;
    verdict.passed = verdict.passed && result.passed;
    if (Badness(result) > Badness(verdict.worst)) verdict.worst = result;
  }
  return verdicts;
}

}  // namespace lampyr
