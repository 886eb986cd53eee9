// Editing a light: the edited one is, bit by bit, the one that is made afresh from the merged parameters. Whatever was
// computed from the old parameters and not anew shows.
#include "lights/light_base.h"
#include "suite/answers.h"

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

namespace {

std::string NameOf(const ParameterList& changes) {
  return changes.All().empty() ? "nothing" : changes.All()[0].name;
}

// `edit` makes the light that is to be what the merged parameters make afresh.
void CompareEdit(const SuiteSubject& subject, const SuiteOrigin& origin, const ParameterList& merged,
                 const std::string& by, const std::function<std::unique_ptr<Light>()>& edit, SuiteReport& report) {
  std::unique_ptr<Light> fresh, edited;
  try {
    fresh = MakeLight(*origin.type, merged, *origin.build);
  } catch (const Error&) {
    // The two do not go together: editing must say so too.
  }
  try {
    edited = edit();
  } catch (const Error&) {}
  std::string difference = fresh ? "editing fails, where a light can be made afresh"
                                 : "editing makes a light, where none can be made afresh";
  if (!fresh && !edited) difference = "";
  if (fresh && edited) difference = Difference(subject, *fresh, *edited);
  const bool isSame = difference.empty();
  report.AddError(subject.name, "edit", subject.caseName + " by " + by, isSame ? 0 : 1, 0.5,
                  isSame ? "" : "edited by \"" + by + "\": " + difference);
}

}  // namespace

void CheckEdit(const SuiteSubject& subject, const SuiteOrigin& origin, SuiteReport& report) {
  const std::vector<ParameterList>& changes = origin.changes;
  for (const ParameterList& change : changes) {
    CompareEdit(
        subject, origin, MergeParameters(*origin.parameters, change), NameOf(change),
        [&] { return subject.light->Edit(change, *origin.build); }, report);
  }
  if (changes.size() < 2) return;
  // One after the other: an edited light knows all that it was made of.
  const ParameterList both = MergeParameters(MergeParameters(*origin.parameters, changes[0]), changes[1]);
  CompareEdit(
      subject, origin, both, NameOf(changes[0]) + " and then " + NameOf(changes[1]),
      [&] { return subject.light->Edit(changes[0], *origin.build)->Edit(changes[1], *origin.build); }, report);
}

}  // namespace lampyr::suite
