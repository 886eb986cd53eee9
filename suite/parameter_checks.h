// Checks of the parameters common to all lights, and edits by each parameter of a type. Neither relies on what the
// author's sample blocks happen to set.
#pragma once

#include <filesystem>

#include "suite/checks.h"

namespace lampyr::suite {

// Property parameters: a light made with one common parameter changed differs from the subject by the documented effect
// of that parameter, and by nothing else.
void CheckCommonParameters(const SuiteSubject& subject, const SuiteOrigin& origin, SuiteReport& report);

// Parameter lists that each change one parameter of the type, with others that it needs to have an effect. The first of
// the candidate values is taken that the type accepts and that makes a different light. `parse` must find the suite's
// input files.
using ParseParameters = std::function<ParameterList(const std::string& text)>;
std::vector<ParameterList> ChangesOfEach(const SuiteSubject& subject, const SuiteOrigin& origin,
                                         const ParseParameters& parse);

}  // namespace lampyr::suite
