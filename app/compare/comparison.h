// Comparison of integrators: each renders the scene with several seeds; snapshots at given times and sample counts are
// compared with a reference, which gives errors and efficiencies.
#pragma once

#include "app/compare/compared_scene.h"
#include "app/compare/reference.h"
#include "app/compare/results.h"

namespace lampyr {

struct ComparisonPlan {
  std::vector<std::string> integrators;
  std::string autoIntegrator;     // the integrator that "auto" chose
  std::vector<double> times;      // seconds, rising
  std::vector<int> sampleCounts;  // per pixel, rising
  int repeats = 5;                // at least 2
  uint64_t seed = 0;              // of the first repeat
  float exposure = 0;             // of the pictures, stops
};

// `fraction`: of the renders done.
using ComparisonProgress = std::function<void(double fraction, const std::string& note)>;

// Fills integrators, ratios, pictures and repeats of the results. After an interrupt the results are those of the
// complete repeats; throws ComparisonInterrupted if there are fewer than two.
void Compare(const ComparedScene& scene, const ComparisonPlan& plan, const Reference& reference,
             const ComparisonProgress& progress, ComparisonResults& results);

}  // namespace lampyr
