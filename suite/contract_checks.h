// Checks that a light returns possible values, and depends only on its documented inputs.
//
//   valid           no radiance or density is negative, or not a number
//   bidirectional   asking for densities of emission changes nothing but them
//   time            the shutter time affects a light only through its placement
//   repeat          the same query gives the same result: in another order, on another thread, after all else
#pragma once

#include "suite/answers.h"

namespace lampyr::suite {

class ContractChecker {
 public:
  // Records the light's answers; the checks compare with them.
  ContractChecker(const SuiteSubject& subject, const SuiteOptions& options);

  void CheckBidirectional(SuiteReport& report) const;
  void CheckTime(SuiteReport& report) const;
  // Must be called after these, so that state changed by the other checks shows.
  void CheckRepeat(SuiteReport& report) const;
  // Calls the light often enough to reveal defects that accumulate. To be called last.
  void CheckValid(const SuiteOptions& options, SuiteReport& report) const;

 private:
  // The first difference over all questions when `change` is applied to their contexts; empty if there is none.
  using Change = std::function<void(LightContext&)>;
  std::string FirstDifference(const Change& change, Compare compare) const;
  std::string FirstDifferenceBackwards() const;
  void Add(const char* property, const std::string& suffix, const std::string& difference, SuiteReport& report) const;

  const SuiteSubject& subject_;
  const Light& light_;
  std::vector<Question> questions_;
  std::vector<Answer> answers_;
  Whole whole_;
};

}  // namespace lampyr::suite
