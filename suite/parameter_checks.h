// What the parameters that all lights have do to a light, and editing by each parameter of its type. Neither relies on
// what the author's sample blocks happen to set.
#pragma once

#include <filesystem>

#include "suite/checks.h"

namespace lampyr::suite {

// parameters: a light that is made with one common parameter changed differs from the subject by what that parameter
// says, and by nothing else.
void CheckCommonParameters(const SuiteSubject& subject, const SuiteOrigin& origin, SuiteReport& report);

// Texts of parameters that change one parameter of the type each, with others that it needs to have an effect: of the
// values that are tried, the first that the type accepts and that makes another light. `folder` has the suite's inputs.
using ParseParameters = std::function<ParameterList(const std::string& text)>;
std::vector<ParameterList> ChangesOfEach(const SuiteSubject& subject, const SuiteOrigin& origin,
                                         const ParseParameters& parse);

}  // namespace lampyr::suite
