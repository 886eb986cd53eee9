#include "suite/pdf_suite.h"

#include <algorithm>
#include <map>
#include <tuple>

#include "suite/checks.h"
#include "suite/contract_checks.h"
#include "suite/direction_source.h"
#include "suite/statistics.h"

namespace lampyr {

void SuiteReport::AddProbability(const std::string& light, const std::string& property, const std::string& caseName,
                                 double pValue, const std::string& words) {
  results_.push_back({light, property, caseName, true, pValue, 0, false, words});
}

void SuiteReport::AddError(const std::string& light, const std::string& property, const std::string& caseName,
                           double error, double tolerance, const std::string& words) {
  results_.push_back({light, property, caseName, false, error, tolerance, error <= tolerance, words});
}

void SuiteReport::Add(const SuiteReport& other) {
  results_.insert(results_.end(), other.results_.begin(), other.results_.end());
}

namespace {

bool IsDoubtful(const SuiteResult& result, double p) {
  return result.isProbability ? result.statistic < p : !result.passed;
}

}  // namespace

size_t SuiteReport::CountDoubtful(double p) const {
  return static_cast<size_t>(std::count_if(results_.begin(), results_.end(),
                                           [p](const SuiteResult& result) { return IsDoubtful(result, p); }));
}

void SuiteReport::Confirm(const SuiteReport& again, double doubtful) {
  using Key = std::tuple<std::string, std::string, std::string, bool>;
  const auto keyOf = [](const SuiteResult& result) {
    return Key(result.light, result.property, result.caseName, result.isProbability);
  };
  // Several results may have the same key: the n-th of one run is paired with the n-th of the other.
  std::map<Key, std::vector<const SuiteResult*>> second;
  for (const SuiteResult& result : again.results_) second[keyOf(result)].push_back(&result);
  std::map<Key, size_t> seen;
  for (SuiteResult& result : results_) {
    const size_t index = seen[keyOf(result)]++;
    if (!IsDoubtful(result, doubtful)) continue;
    const auto found = second.find(keyOf(result));
    if (found == second.end() || index >= found->second.size()) continue;
    const SuiteResult& other = *found->second[index];
    if (result.isProbability ? other.statistic > result.statistic : other.passed) result = other;
  }
}

std::vector<SuiteResult> SuiteReport::Finish(double familyWise) {
  int tests = 0;
  for (const SuiteResult& result : results_) tests += result.isProbability ? 1 : 0;
  const double level = SidakLevel(familyWise, tests);
  for (SuiteResult& result : results_) {
    if (!result.isProbability) continue;
    result.threshold = level;
    result.passed = result.statistic >= level;
  }
  return results_;
}

namespace {

void CheckDensities(const SuiteSubject& subject, const SuiteOptions& options, SuiteReport& report) {
  switch (subject.light->Kind()) {
    case LightKind::Area:
      if (subject.model) {
        suite::CheckShapeLight(subject, options, report);
      } else if (subject.light->Surface()) {
        suite::CheckSurfaceLight(subject, options, report);
      } else {
        // No ray can find this light: none of its properties can be checked.
        report.AddError(subject.name, "surface", subject.caseName, 1, 0.5);
      }
      break;
    case LightKind::DeltaPosition:
      suite::CheckPointLight(subject, options, report);
      break;
    case LightKind::DeltaDirection:
    case LightKind::Infinite:
      suite::CheckInfiniteLight(subject, options, report);
      break;
  }
}

}  // namespace

// Checks that depend on receivers and random samples, and that may be repeated.
static void CheckSamples(const SuiteSubject& subject, const SuiteOptions& options, SuiteReport& report) {
  if (options.parts & kAttributePart) suite::CheckAttributes(subject, options, report);
  if (options.parts & kSegmentPart) suite::CheckSegments(subject, options, report);
  if (options.parts & kDensityPart) CheckDensities(subject, options, report);
  if (subject.isThorough && (options.parts & kStrataPart)) suite::CheckStrata(subject, options, report);
  if (subject.isThorough && (options.parts & kDirectionPart)) suite::CheckDirectionsFinely(subject, options, report);
}

static SuiteOptions WithParts(SuiteOptions options, unsigned parts) {
  options.parts = parts;
  return options;
}

// Checks a doubtful light again, at most twice: a correct light has one p-value in ten thousand below the first
// threshold, and one error in some ten thousand above its tolerance. A light with several clearly failed results is
// certainly wrong. Each part has random numbers of its own: parts without a doubtful result would give the same again.
static void CheckSamplesAgain(const SuiteSubject& subject, const SuiteOptions& options, SuiteReport& report) {
  constexpr double kDoubtful = 1e-4, kSure = 1e-9;
  constexpr size_t kMany = 3;
  constexpr int kLooks = 2, kMoreEffort = 4;
  std::vector<std::pair<unsigned, SuiteReport>> byPart;
  for (const unsigned part : {kAttributePart, kSegmentPart, kDensityPart, kStrataPart, kDirectionPart}) {
    if (!(options.parts & part)) continue;
    byPart.emplace_back(part, SuiteReport());
    CheckSamples(subject, WithParts(options, part), byPart.back().second);
  }
  for (uint64_t look = 1; look <= kLooks; ++look) {
    size_t sure = 0;
    for (const auto& [part, first] : byPart) sure += first.CountDoubtful(kSure);
    if (sure >= kMany) break;
    SuiteOptions closer = options;
    closer.seed = Hash(options.seed, look);
    closer.effort *= kMoreEffort;
    for (auto& [part, first] : byPart) {
      if (first.CountDoubtful(kDoubtful) == 0) continue;
      SuiteReport again;
      CheckSamples(subject, WithParts(closer, part), again);
      first.Confirm(again, kDoubtful);
    }
  }
  for (const auto& [part, first] : byPart) report.Add(first);
}

void CheckLight(const SuiteSubject& subject, const SuiteOptions& options, SuiteReport& report) {
  std::optional<suite::ContractChecker> contract;
  if (options.parts & kContractPart) {
    contract.emplace(subject, options);
    contract->CheckBidirectional(report);
    contract->CheckTime(report);
  }
  CheckSamplesAgain(subject, options, report);
  if (!contract) return;
  contract->CheckRepeat(report);
  contract->CheckValid(options, report);
}

}  // namespace lampyr
