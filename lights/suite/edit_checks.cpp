// Editing a light: the edited one is, bit by bit, the one that is made afresh from the merged parameters. Whatever was
// computed from the old parameters and not anew shows.
#include "lights/light_base.h"
#include "lights/suite/answers.h"

namespace lampyr::suite {

namespace {

// What differs between two lights, "" when nothing does.
std::string Difference(const SuiteSubject& subject, const Light& fresh, const Light& edited) {
  const std::string difference = DifferenceAsWhole(subject, fresh, edited);
  if (!difference.empty()) return difference;
  Rng rng(subject.caseName.size());
  for (const Question& question : MakeQuestions(subject, fresh, 256, rng)) {
    const std::string found = Difference(Ask(fresh, question), Ask(edited, question));
    if (!found.empty()) return found;
  }
  return "";
}

}  // namespace

void CheckEdit(const SuiteSubject& subject, const SuiteOrigin& origin, SuiteReport& report) {
  for (size_t i = 0; i < origin.changes.size(); ++i) {
    const ParameterList& changes = origin.changes[i];
    std::unique_ptr<Light> fresh, edited;
    try {
      fresh = MakeLight(*origin.type, MergeParameters(*origin.parameters, changes), *origin.build);
    } catch (const Error&) {
      // The two do not go together: editing must say so too.
    }
    try {
      edited = subject.light->Edit(changes, *origin.build);
    } catch (const Error&) {}
    std::string difference = "error";
    if (!fresh && !edited) difference = "";
    if (fresh && edited) difference = Difference(subject, *fresh, *edited);
    const std::string what = changes.All().empty() ? "nothing" : changes.All()[0].name;
    report.AddError(subject.name, "edit",
                    subject.caseName + " by " + what + (difference.empty() ? "" : ": other " + difference),
                    difference.empty() ? 0 : 1, 0.5);
  }
}

}  // namespace lampyr::suite
