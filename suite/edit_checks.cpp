// Editing a light: the edited light must equal, bit by bit, the light made afresh from the merged parameters. Values
// that were computed from the old parameters and not updated show as a difference.
#include "lights/light_base.h"
#include "suite/answers.h"

namespace lampyr::suite {

namespace {

// The first difference between two lights as text; empty if there is none.
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

// `edit` returns the edited light, which must equal the light made afresh from the merged parameters.
void CompareEdit(const SuiteSubject& subject, const SuiteOrigin& origin, const ParameterList& merged,
                 const std::string& by, const std::function<std::unique_ptr<Light>()>& edit, SuiteReport& report) {
  std::unique_ptr<Light> fresh, edited;
  try {
    fresh = MakeLight(*origin.type, merged, *origin.build);
  } catch (const Error&) {
    // The parameters are not compatible: editing must fail too.
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

std::unique_ptr<Light> Edited(const Light& light, const ParameterList& change, const LightBuildContext& build) {
  std::unique_ptr<Light> edited = light.Edit(change, build);
  if (!edited) throw Error("Edit returned null");
  return edited;
}

}  // namespace

void CheckEdit(const SuiteSubject& subject, const SuiteOrigin& origin, SuiteReport& report) {
  const std::vector<ParameterList>& changes = origin.changes;
  for (const ParameterList& change : changes) {
    CompareEdit(
        subject, origin, MergeParameters(*origin.parameters, change), NameOf(change),
        [&] { return Edited(*subject.light, change, *origin.build); }, report);
  }
  if (changes.size() < 2) return;
  // Two edits in sequence: an edited light must keep all parameters from which it was made.
  const ParameterList both = MergeParameters(MergeParameters(*origin.parameters, changes[0]), changes[1]);
  CompareEdit(
      subject, origin, both, NameOf(changes[0]) + " and then " + NameOf(changes[1]),
      [&] { return Edited(*Edited(*subject.light, changes[0], *origin.build), changes[1], *origin.build); }, report);
}

}  // namespace lampyr::suite
