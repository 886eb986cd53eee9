#include "lights/suite/pdf_suite.h"

#include "lights/suite/checks.h"
#include "lights/suite/contract_checks.h"
#include "lights/suite/direction_source.h"
#include "lights/suite/statistics.h"

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
        // A light that no ray can find: nothing of it can be proved.
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

void CheckLight(const SuiteSubject& subject, const SuiteOptions& options, SuiteReport& report) {
  std::optional<suite::ContractChecker> contract;
  if (options.parts & kContractPart) {
    contract.emplace(subject, options);
    contract->CheckBidirectional(report);
    contract->CheckTime(report);
  }
  if (options.parts & kAttributePart) suite::CheckAttributes(subject, options, report);
  if (options.parts & kDensityPart) CheckDensities(subject, options, report);
  if (subject.isThorough && (options.parts & kStrataPart)) suite::CheckStrata(subject, options, report);
  if (subject.isThorough && (options.parts & kDirectionPart)) suite::CheckDirectionsFinely(subject, options, report);
  if (contract) contract->CheckRepeat(report);
}

}  // namespace lampyr
