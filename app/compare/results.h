// Results of `lampyr compare`, as plain data. Times in seconds; errors as in film/metrics.h.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/compare/spectrum.h"
#include "film/film.h"

namespace lampyr {

// A value with its 95 % confidence interval.
struct Estimate {
  double value = 0, low = 0, high = 0;
};

struct SignificantEstimate : Estimate {
  bool significant = false;  // 0 is improbable, p < 0.01
};

// One render at one budget.
struct ComparedRun {
  uint64_t seed = 0;
  double seconds = 0;
  int samplesPerPixel = 0;
  double mse = 0, relMse = 0, flip = 0;  // the reference's noise subtracted from mse and relMse
  double meanBias = 0;                   // of the image's mean, relative to the reference's
  // The error that the render itself states at 95 % confidence, in its parts, if it merges photons.
  std::optional<ErrorParts> stated;
};

// One integrator at one budget: means over the repeats. An error that does not exceed the reference's own noise and
// blur is absent.
struct ComparedSnapshot {
  bool byTime = true;  // kind of the budget: seconds, or samples per pixel
  double budget = 0;
  double seconds = 0;  // actual time: passes are not cut short
  double samplesPerPixel = 0, samplesPerSecond = 0;
  std::optional<Estimate> mse, relMse, efficiency, relEfficiency;  // efficiency: 1/(MSE · seconds)
  Estimate flip;
  // The relative error (root of relMSE) in two parts, whose squares add up to relMSE: one common to all repeats, and
  // one that differs between them. Absent if it is not above 0.
  SignificantEstimate bias;
  std::optional<Estimate> noise;
  std::optional<ErrorParts> stated;   // root mean square over the repeats
  std::vector<ComparedRun> runs;      // a repeat each
  std::string picture, errorPicture;  // keys of ComparisonResults::pictures, "" none
};

// Time at which the root of relMSE reaches `error`.
struct TimeToError {
  // Extrapolated: beyond the measurements, as if relMSE fell as 1/time; blur falls more slowly. Never: the systematic
  // part alone is larger, for an integrator that does not blur. Unresolved: no error was above the reference's own
  // noise and blur.
  enum class Kind { Measured, Extrapolated, Never, Unresolved };
  double error = 0;
  Kind kind = Kind::Never;
  Estimate seconds;
};

struct ComparedIntegrator {
  std::string name;
  std::vector<std::string> hints;
  bool blurs = false;                  // merges photons, or is denoised: its bias falls with more samples
  SignificantEstimate meanBias;        // of the image's mean, relative to the reference's
  SignificantEstimate systematic;      // the part of relMSE that all repeats have in common, at the largest budget
  std::vector<SpectrumRing> spectrum;  // at the largest budget
  std::vector<TimeToError> timeToError;
  std::vector<ComparedSnapshot> snapshots;
};

// Ratio of the efficiencies of two integrators, in MSE or relMSE.
struct EfficiencyRatio {
  std::string integrator, against;
  bool byTime = true;
  double budget = 0;
  bool relative = true;  // relMSE
  Estimate ratio;
};

struct ComparisonReference {
  enum class Origin { Given, Cached, Made } origin = Origin::Made;
  std::string file;
  std::string integrator;   // "" unknown
  int samplesPerPixel = 0;  // of all its parts, 0 unknown
  double seconds = 0;       // 0 unknown
  double mean = 0;          // over pixels and channels
  // Noise of the reference itself: absent for a given image without variance layers, which is taken as exact.
  std::optional<double> relativeError, mse, relMse;
  // The known noise is only an upper bound (renderers that stratify their samples report the variance of independent
  // ones) and is not subtracted from measured errors.
  bool noiseIsLimit = false;
  // Relative error (root of relMSE) by the blur of merged photons; 0 for integrators that merge none, absent if
  // unknown. `biasIsLimit`: it is not significant, and this is its upper bound at 95 % confidence, one-sided.
  std::optional<double> bias;
  bool biasIsLimit = false;
  // Merging radius of most samples of the reference, relative to that of an integrator's first sample; 0 for
  // integrators that merge none, absent if unknown.
  std::optional<double> radius;

  // True if it has blur, so that errors are not resolved below its noise and blur.
  bool IsBlurred() const { return bias.value_or(0) > 0; }
};

// A trial render by an integrator, to choose the one that renders the reference.
struct Pilot {
  std::string integrator;
  double seconds = 0;
  int samplesPerPixel = 0;
  double mean = 0, relMse = 0;  // relMse of `seconds` of rendering, relative to neighbourhoods
  double bias = 0;              // relative error (root of relMSE) by blur, as far as it is above noise
  bool isFlawed = false;        // it misses light, or may: its noise is not all of its error
  bool chosen = false;
  std::string note;  // in words, of any kind
};

struct ComparisonResults {
  std::string scene, sceneHash, command;
  int width = 0, height = 0, maxDepth = 0, threads = 0, repeats = 0;
  bool ofProcessor = false;  // seconds are the processor's, over the threads; otherwise the clock's
  ComparisonReference reference;
  std::vector<Pilot> pilots;
  double lowestError = 0.001, highestError = 10;  // levels 0 and 255 of error pictures; logarithmic between
  std::vector<ComparedIntegrator> integrators;
  std::vector<EfficiencyRatio> ratios;
  std::vector<std::pair<std::string, std::vector<unsigned char>>> pictures;  // PNG by key
};

}  // namespace lampyr
