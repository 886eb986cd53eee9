// The parts of the filter suite. Private to it.
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
  std::string changes;   // parameters that are laid over the block
  Transform placement;
  uint64_t seed = 1;

  Rng MakeRng() const { return Rng(seed); }
  // Its edges, as they are placed.
  EdgeBatch Edges(Rng& rng) const;
};

// All filters are asked as for a receiver that subscribes to group 1.
inline constexpr uint8_t kEnabled[] = {1, 1};
inline FilterContext ContextAt(float time) {
  return {time, kEnabled};
}

// What an error is where a number is none.
inline constexpr double kNoNumber = 1e9;

// The largest relative difference of a channel, of colours that are not small against 1; 0 for equal bits.
double Difference(const Color& a, const Color& b);
double Difference(const Filtered& a, const Filtered& b);

// The worst of what a check finds: the largest error, and where it is.
class WorstEdge {
 public:
  explicit WorstEdge(double tolerance) : tolerance_(tolerance) {}

  // `words` is a function that says where; it is called for what is worse than all before.
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

// "diffuse is (…), right is (…)", of the kind of lobe that is farther from it.
std::string SayDifference(const Filtered& found, const Filtered& right);

// repeat, batch, threads, time, light-pdf, valid, light, identity, modifier: of any filter.
void CheckFilterFunction(const FilterCase& filterCase, SuiteReport& report);
// samples: of a block as it is written.
void CheckFilterChanges(const FilterCase& filterCase, SuiteReport& report);
// density, invert, lobes, groups.
void CheckFilterSettings(const FilterCase& filterCase, SuiteReport& report);
// combine.
void CheckFilterCombined(const FilterCase& filterCase, SuiteReport& report);
// placement, coordsys, motion.
void CheckFilterPlace(const FilterCase& filterCase, SuiteReport& report);

}  // namespace lampyr::suite
