// The checks of the filter suite. Private to it.
#pragma once

#include <cmath>
#include <string>

#include "suite/filter_edges.h"
#include "suite/filter_maker.h"
#include "suite/pdf_suite.h"

namespace lampyr::suite {

// One sample block at one place.
struct FilterCase {
  const FilterMaker* maker = nullptr;
  std::string name;      // of the results
  std::string caseName;  // the place, and what is changed in the block
  std::string changes;   // parameters that override those of the block
  Transform placement;
  uint64_t seed = 1;

  Rng MakeRng() const { return Rng(seed); }
  // Test edges, transformed by the filter's placement.
  EdgeBatch Edges(Rng& rng) const;
};

// Every filter is queried for a receiver that subscribes to group 1.
inline constexpr uint8_t kEnabled[] = {1, 1};
inline FilterContext ContextAt(float time) {
  return {time, kEnabled};
}

// Error value for results that are not finite numbers.
inline constexpr double kNoNumber = 1e9;

// The largest channel difference relative to max(1, |a|, |b|); 0 for equal values.
double Difference(const Color& a, const Color& b);
double Difference(const Filtered& a, const Filtered& b);

// Keeps the largest error of a check and its location.
class WorstEdge {
 public:
  explicit WorstEdge(double tolerance) : tolerance_(tolerance) {}

  // `words()` describes the location; it is called only if the error exceeds all earlier ones.
  template <class Words>
  void Note(double error, const Words& words) {
    if (!(error < kNoNumber)) error = kNoNumber;
    if (error <= error_) return;
    error_ = error;
    words_ = words();
  }
  void Report(const FilterCase& filterCase, const std::string& property, SuiteReport& report) const;

 private:
  double tolerance_;
  double error_ = 0;
  std::string words_;
};

// Description such as "diffuse light is (…), right is (…)", for the lobe type with the larger difference.
std::string SayDifference(const Filtered& found, const Filtered& right);

// Properties repeat, batch, threads, time, light-pdf, valid, light, identity, modifier of any filter.
void CheckFilterFunction(const FilterCase& filterCase, SuiteReport& report);
// Property samples of an unchanged block.
void CheckFilterChanges(const FilterCase& filterCase, SuiteReport& report);
// Properties density, invert, lobes, groups.
void CheckFilterSettings(const FilterCase& filterCase, SuiteReport& report);
// Property combine.
void CheckFilterCombined(const FilterCase& filterCase, SuiteReport& report);
// Properties placement, coordsys, motion.
void CheckFilterPlace(const FilterCase& filterCase, SuiteReport& report);

}  // namespace lampyr::suite
