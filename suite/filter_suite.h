// The suite of light filters: tests that a filter is a factor on the edge between a light and a receiver, and that its
// parameters have their documented meaning. It runs over filter types as the pdf suite runs over types of light, and
// gives results of the same kind. None of its properties is statistical: each case is an error against a tolerance, and
// its name describes where the error is largest.
//
// Properties, by their names in the results. FilterPropertyMeaning describes each in one line.
//
//   samples      the type has sample blocks, and each changes some light
//   repeat       repeated queries give the same bits, whatever was queried in between
//   batch        an edge alone, in batches of any size and in any order gives the same bits
//   threads      an edge gives the same bits on any thread
//   time         a static filter gives the same bits at any time of the shutter
//   light-pdf    the pdf of the light's own sampling changes no bit
//   valid        filtered light is finite and not negative
//   light        twice the light gives twice the filtered light; each lobe type is filtered independently
//   identity     a filter that reports IsIdentity changes nothing
//   modifier     GetRadianceModifier is 0 only if nothing is transmitted, and at least a tenth of what is
//   density      the applied factor is 1 + density · (factor − 1); a density of 0 is no filter
//   invert       1 less the factor, not below 0
//   lobes        diffuse and specular scale the effect for their kind of lobe, and for no other
//   groups       the filter names the groups that it was given, and does not look at them itself
//   combine      a combiner applies it by its combineMode (product, maximum, minimum or screen), and skips it where
//                it is not enabled
//   placement    a filter and an edge transformed alike give the same factor
//   coordsys     a filter in a named coordinate system equals one placed there
//   motion       a moving filter equals, at each time, a static one at the placement of that time
//
// Properties of the common parameters (density … motion) are checked for types whose table has them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "lights/filters/filter_type.h"
#include "suite/pdf_suite.h"

namespace lampyr {

// All sample blocks of the types × variations of the common parameters × placements × edges. `scratch` is an existing
// folder for images. SuiteResult::light is "filter NAME[block]".
std::vector<SuiteResult> RunFilterSuite(const std::vector<FilterType>& types, const std::filesystem::path& scratch,
                                        const SuiteOptions& options);

// Meaning of a property, in one line, as it holds for a filter that passes; empty if it is no property of filters.
std::string FilterPropertyMeaning(const std::string& property);

}  // namespace lampyr
