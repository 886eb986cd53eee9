// Checks that a light depends only on its documented inputs.
//
//   bidirectional   asking for densities of emission changes nothing but them
//   time            the placement is all that a light knows of the time
//   repeat          the same question has the same answer: in another order, on another thread, after all else
#pragma once

#include "suite/answers.h"

namespace lampyr::suite {

class ContractChecker {
 public:
  // Asks the light at once; the checks compare with that.
  ContractChecker(const SuiteSubject& subject, const SuiteOptions& options);

  void CheckBidirectional(SuiteReport& report) const;
  void CheckTime(SuiteReport& report) const;
  // To be called last: what has worn out by then shows.
  void CheckRepeat(SuiteReport& report) const;

 private:
  // Of all questions, asked in contexts that `change` makes of theirs.
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
