// The suite of light filters: proof that a filter is a factor on the edge between a light and a receiver, and that its
// parameters mean what they say. It runs over filter types as the pdf suite runs over types of light, and gives results
// of the same kind. None of its properties is statistical: each case is an error against a tolerance, and its name says
// in words where the error is largest.
//
// Properties, by their names in the results. FilterPropertyMeaning says each in one line.
//
//   samples      the type has sample blocks, and each changes some light
//   repeat       asked again, the filter answers with the same bits, whatever it was asked between
//   batch        an edge alone, in batches of any size and in any order gives the same bits
//   threads      so it does on any thread
//   time         a filter that stays gives the same bits at any time of the shutter
//   light-pdf    the density of the light's own sampling changes no bit
//   valid        what is left of light is finite and not negative
//   light        twice the light gives twice what is left; each kind of lobe is changed by itself
//   identity     a filter that says it never changes anything does not
//   modifier     GetRadianceModifier: 0 only where nothing gets through, and no less than a tenth of what does
//   density      what is applied is 1 + density · (factor − 1); a density of 0 is no filter
//   invert       1 less the factor, not below 0
//   lobes        diffuse and specular scale the effect for their kind of lobe, and for no other
//   groups       the filter names the groups that it was given, and does not look at them itself
//   combine      a combiner takes it by its combineMode: as product, maximum, minimum or screen; and leaves it out
//   where
//                it is not enabled
//   placement    a filter and an edge that are moved alike give the same factor
//   coordsys     a filter in a named coordinate system is a filter that is placed there
//   motion       a filter that moves is, at each time, one that stays where it is then
//
// What the common parameters mean (density … motion) is checked for types whose table has them.
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

// What holds of a filter that passes, in one line; "" for what is no property of filters.
std::string FilterPropertyMeaning(const std::string& property);

}  // namespace lampyr
