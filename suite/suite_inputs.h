// The files that sample blocks may name: the suite writes them beside the scene text that it parses.
//
//   suite-texture.exr, suite-texture-2.exr   8×8, for surfaces: uneven, with a black strip
//   suite-square.exr, suite-square-2.exr     8×8, skies over the equal-area square: noise with black texels
//   suite-latlong.exr, suite-latlong-2.exr   16×8, skies over latitude and longitude
//   suite-bright.exr                         4×4: one texel of 1e9, one NaN, one negative
//   suite-black.exr                          4×4, all 0
//   suite-profile.ies, suite-profile-2.ies   LM-63-2002, type C: 0-360°, uneven, dark nowhere but near the zenith
#pragma once

#include <filesystem>

#include "suite/pdf_suite.h"

namespace lampyr::suite {

void WriteSuiteInputs(const std::filesystem::path& folder);

// The input file of the same kind with other content; empty if there is none.
std::string OtherSuiteInput(const std::string& name);

}  // namespace lampyr::suite
