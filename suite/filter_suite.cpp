// Cases of the filter suite, and the meanings of its properties.
#include "suite/filter_suite.h"

#include <array>

#include "suite/checks.h"
#include "suite/filter_checks.h"
#include "suite/suite_inputs.h"
#include "suite/suite_shapes.h"

namespace lampyr {

namespace {

struct PropertyMeaning {
  const char *property, *meaning;
};
constexpr PropertyMeaning kMeanings[] = {
    {"samples", "the type has sample blocks, and each of them changes some light"},
    {"repeat", "asked again, a filter gives the same bits, whatever it was asked between"},
    {"batch", "an edge gives the same bits alone and in any batch, in any order"},
    {"threads", "an edge gives the same bits on any thread"},
    {"time", "a filter that stays gives the same bits at any time of the shutter"},
    {"light-pdf", "the density of the light's own sampling changes no bit"},
    {"valid", "what is left of light is finite and not negative"},
    {"light", "twice the light gives twice what is left, and neither kind of lobe looks at the other's light"},
    {"identity", "a filter that says it never changes anything does not"},
    {"modifier", "GetRadianceModifier is 0 only where nothing gets through, and no less than a tenth of what does"},
    {"density", "what is applied is 1 + density * (factor - 1): a density of 0 is no filter"},
    {"invert", "an inverted filter is 1 less its factor, not below 0"},
    {"lobes", "diffuse and specular scale the effect on their own kind of lobe, and on no other"},
    {"groups", "a filter names the linkingGroups that it was given, and its factor does not depend on them"},
    {"combine", "a combiner takes a filter by its combineMode, and leaves it out where it is not enabled"},
    {"placement", "a filter and an edge that are moved alike give the same factor"},
    {"coordsys", "a filter in a named coordinate system is one that is placed there"},
    {"motion", "a filter that moves is, at each time, one that stays where it is then"},
    {"exceptions", "a filter does not throw once it is made"},
};

// Variations of the common parameters. With each of them, a block must still be a function of the edge.
struct Variation {
  const char *name, *needs, *parameters;
};
constexpr Variation kVariations[] = {
    {"", "", ""},
    {"density 0.4", "density", "\"float density\" 0.4"},
    {"density 0", "density", "\"float density\" 0"},
    {"inverted", "invert", "\"bool invert\" true"},
    {"diffuse 0.2", "diffuse", "\"float diffuse\" 0.2"},
    {"specular 0", "specular", "\"float specular\" 0"},
    {"in a group", "linkingGroups", "\"string linkingGroups\" \"suite\""},
    {"as max", "combineMode", "\"string combineMode\" \"max\""},
};

struct BlockCase {
  const FilterType* type = nullptr;
  std::string block, name;
  suite::NamedTransform place;
};

std::vector<suite::NamedTransform> Places() {
  std::vector<suite::NamedTransform> places = suite::Transforms();
  places.push_back({"moved", Transform::Translate({40, -25, 31})});
  return places;
}

void Check(const BlockCase& block, const std::filesystem::path& folder, uint64_t seed, SuiteReport& report) {
  const suite::FilterMaker maker(*block.type, block.block, folder);
  suite::FilterCase filterCase;
  filterCase.maker = &maker;
  filterCase.name = block.name;
  filterCase.placement = block.place.transform;
  filterCase.caseName = block.place.name;
  filterCase.seed = seed;
  suite::CheckFilterChanges(filterCase, report);
  suite::CheckFilterSettings(filterCase, report);
  suite::CheckFilterCombined(filterCase, report);
  suite::CheckFilterPlace(filterCase, report);
  for (const Variation& variation : kVariations) {
    if (*variation.needs && !maker.Has(variation.needs)) continue;
    filterCase.changes = variation.parameters;
    filterCase.caseName = block.place.name + (*variation.name ? std::string(", ") + variation.name : "");
    suite::CheckFilterFunction(filterCase, report);
  }
}

}  // namespace

std::vector<SuiteResult> RunFilterSuite(const std::vector<FilterType>& types, const std::filesystem::path& scratch,
                                        const SuiteOptions& options) {
  suite::WriteSuiteInputs(scratch);
  std::vector<BlockCase> cases;
  SuiteReport missing;
  for (const FilterType& type : types) {
    if (type.samples.empty()) {
      missing.AddError("filter " + type.name, "samples", "it has no sample blocks: nothing of it is proved", 1, 0.5);
    }
    for (size_t i = 0; i < type.samples.size(); ++i) {
      const std::string name = "filter " + type.name + "[" + std::to_string(i) + "]";
      for (const suite::NamedTransform& place : Places()) cases.push_back({&type, type.samples[i], name, place});
    }
  }
  SuiteReport report = suite::RunCases(cases.size(), options, [&](size_t index, SuiteReport& found) {
    const BlockCase& of = cases[index];
    suite::WithoutExceptions(of.name, of.place.name, found,
                             [&] { Check(of, scratch, Hash(options.seed, index), found); });
  });
  report.Add(missing);
  return report.Finish(options.familyWise);
}

std::string FilterPropertyMeaning(const std::string& property) {
  for (const PropertyMeaning& known : kMeanings) {
    if (property == known.property) return known.meaning;
  }
  return "";
}

}  // namespace lampyr
