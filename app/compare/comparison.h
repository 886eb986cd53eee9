// Integrators measured side by side: each renders the scene with several seeds, is looked at when it has had so much
// time and so many samples, and what these pictures are off by says how fast it is.
#pragma once

#include "app/compare/compared_scene.h"
#include "app/compare/reference.h"
#include "app/compare/results.h"

namespace lampyr {

struct ComparisonPlan {
  std::vector<std::string> integrators;
  std::vector<double> times;      // seconds, rising
  std::vector<int> sampleCounts;  // per pixel, rising
  int repeats = 5;                // at least 2
  uint64_t seed = 0;              // of the first repeat
  float exposure = 0;             // of the pictures, stops
};

// `fraction` of the renders that is done.
using ComparisonProgress = std::function<void(double fraction, const std::string& note)>;

// Fills integrators, ratios, pictures and repeats of the results. An interrupt ends it after the repeats that are
// whole; throws ComparisonInterrupted when these are fewer than two.
void Compare(const ComparedScene& scene, const ComparisonPlan& plan, const Reference& reference,
             const ComparisonProgress& progress, ComparisonResults& results);

}  // namespace lampyr
