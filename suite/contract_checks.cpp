#include "suite/contract_checks.h"

#include <future>
#include <latch>

namespace lampyr::suite {

ContractChecker::ContractChecker(const SuiteSubject& subject, const SuiteOptions& options)
    : subject_(subject), light_(*subject.light) {
  Rng rng = MakeRng(subject, options);
  constexpr int kQuestions = 64;
  questions_ = MakeQuestions(subject, light_, kQuestions, rng);
  for (const Question& question : questions_) answers_.push_back(Ask(light_, question));
  whole_ = AskWhole(light_, subject.context);
}

std::string ContractChecker::FirstDifference(const Change& change, Compare compare) const {
  for (size_t i = 0; i < questions_.size(); ++i) {
    LightContext context = questions_[i].context;
    change(context);
    const std::string difference = Difference(answers_[i], Ask(light_, questions_[i], context), compare);
    if (!difference.empty()) return difference;
  }
  LightContext context = subject_.context;
  change(context);
  return Difference(whole_, AskWhole(light_, context));
}

// Questions in reverse order, each several times in a row.
std::string ContractChecker::FirstDifferenceBackwards() const {
  for (size_t i = questions_.size(); i-- > 0;) {
    for (const CallOrder order : {CallOrder::Backwards, CallOrder::Forwards, CallOrder::Forwards}) {
      const Answer again = Ask(light_, questions_[i], questions_[i].context, order);
      const std::string difference = Difference(answers_[i], again);
      if (!difference.empty()) return difference;
    }
  }
  return Difference(whole_, AskWhole(light_, subject_.context));
}

void ContractChecker::Add(const char* property, const std::string& suffix, const std::string& difference,
                          SuiteReport& report) const {
  report.AddError(subject_.name, property, subject_.caseName + suffix, difference.empty() ? 0 : 1, 0.5, difference);
}

// Uses many questions, because a light may be wrong in few places only.
void ContractChecker::CheckValid(const SuiteOptions& options, SuiteReport& report) const {
  constexpr int kManyQuestions = 2048;
  constexpr uint64_t kOther = 0x76616c6964;  // than those whose answers are compared
  SuiteOptions own = options;
  own.seed = Hash(options.seed, kOther);
  Rng rng = MakeRng(subject_, own);
  std::string invalid;
  for (const Question& question : MakeQuestions(subject_, light_, kManyQuestions, rng)) {
    invalid = Invalid(Ask(light_, question));
    if (!invalid.empty()) break;
  }
  Add("valid", "", invalid, report);
}

void ContractChecker::CheckBidirectional(SuiteReport& report) const {
  const auto without = [](LightContext& context) { context.bidirectional = false; };
  Add("bidirectional", "", FirstDifference(without, Compare::AllButBidirectional), report);
}

void ContractChecker::CheckTime(SuiteReport& report) const {
  for (const float time : {0.0f, 0.37f, 0.74f, 1.0f}) {
    const std::string difference = FirstDifference([&](LightContext& c) { c.time = time; }, Compare::Everything);
    char when[32];
    std::snprintf(when, sizeof(when), " time %g", static_cast<double>(time));
    Add("time", when, difference, report);
  }
}

void ContractChecker::CheckRepeat(SuiteReport& report) const {
  const auto nothing = [](LightContext&) {};
  Add("repeat", " asked again", FirstDifference(nothing, Compare::Everything), report);
  Add("repeat", " in another order", FirstDifferenceBackwards(), report);
  auto elsewhere = std::async(std::launch::async, [&] { return FirstDifference(nothing, Compare::Everything); });
  Add("repeat", " on another thread", elsewhere.get(), report);
  // Both threads ask different questions at the same time: state that a light keeps of one of them shows in the other's
  // answer.
  std::string together;
  constexpr int kRounds = 3;
  for (int round = 0; round < kRounds && together.empty(); ++round) {
    std::latch start(2);
    auto forwards = std::async(std::launch::async, [&] {
      start.arrive_and_wait();
      return FirstDifference(nothing, Compare::Everything);
    });
    start.arrive_and_wait();
    const std::string other = FirstDifferenceBackwards();
    together = forwards.get();
    if (together.empty()) together = other;
  }
  Add("repeat", " on two threads at once", together, report);
}

}  // namespace lampyr::suite
