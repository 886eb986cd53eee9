// The checks of the suite by kind of light, and the code they share. Private to the suite.
#pragma once

#include <optional>

#include "suite/direction_quadrature.h"
#include "suite/pdf_suite.h"
#include "suite/statistics.h"

namespace lampyr::suite {

inline constexpr double kPiDouble = 3.14159265358979323846;

void CheckShapeLight(const SuiteSubject& subject, const SuiteOptions& options, SuiteReport& report);    // by its model
void CheckSurfaceLight(const SuiteSubject& subject, const SuiteOptions& options, SuiteReport& report);  // by Surface()
void CheckPointLight(const SuiteSubject& subject, const SuiteOptions& options, SuiteReport& report);
void CheckInfiniteLight(const SuiteSubject& subject, const SuiteOptions& options, SuiteReport& report);  // deltas too

// Properties patches, shines-from, position-error, energy, uvw.
void CheckAttributes(const SuiteSubject& subject, const SuiteOptions& options, SuiteReport& report);

// Property segment.
void CheckSegments(const SuiteSubject& subject, const SuiteOptions& options, SuiteReport& report);

// Checks the densities in strata that few samples reach.
void CheckStrata(const SuiteSubject& subject, const SuiteOptions& options, SuiteReport& report);

// Checks that an edited light equals, bit by bit, the light made afresh.
void CheckEdit(const SuiteSubject& subject, const SuiteOrigin& origin, SuiteReport& report);

struct Receiver {
  std::string name;
  Point3 position;
};

// Calls `check`. A std::exception that it throws is a failure of "exceptions", except for a lack of memory, and for an
// Error with a location, which concerns the parameters.
void WithoutExceptions(const std::string& name, const std::string& caseName, SuiteReport& report,
                       const std::function<void()>& check);

// Checks `count` cases in parallel.
SuiteReport RunCases(size_t count, const SuiteOptions& options,
                     const std::function<void(size_t index, SuiteReport& report)>& check);

// Random number generator of one case: results depend neither on what ran before nor on the thread.
Rng MakeRng(const SuiteSubject& subject, const SuiteOptions& options);
// Second generator of the case, for receivers and fixed starts.
Rng MakeRngOfPlaces(const SuiteSubject& subject, const SuiteOptions& options);
LightContext RandomContext(const SuiteSubject& subject, Rng& rng);

// A uniform direction.
Vector3d RandomDirection(Rng& rng);

// Unit directions of `count` draws; draws without a direction are left out.
inline constexpr int kHints = 2048;
template <class Function>
std::vector<Vector3d> DrawDirections(Rng& rng, int count, const Function& draw) {
  std::vector<Vector3d> directions;
  for (int i = 0; i < count; ++i) {
    if (const std::optional<Vector3> direction = draw(rng)) directions.push_back(glm::normalize(Vector3d(*direction)));
  }
  return directions;
}

// Emission of a sample, an evaluation or a photon: mean of the channels, divided by the sum of the light's diffuse and
// specular multipliers.
template <class Result>
double Emitted(const SuiteSubject& subject, const Result& result) {
  const double multipliers = subject.diffuseMultiplier + subject.specularMultiplier;
  const auto both = static_cast<double>(result.diffuse.Average()) + static_cast<double>(result.specular.Average());
  return multipliers > 0 ? both / multipliers : 0.0;
}
template <class Result>
bool IsBlack(const Result& result) {
  return result.diffuse.IsBlack() && result.specular.IsBlack();
}

inline double Value(PdfSolidAngle pdf) {
  return static_cast<double>(pdf.value);
}
inline double Value(PdfArea pdf) {
  return static_cast<double>(pdf.value);
}

// Relative difference of two densities or colours, 0 for equal ones.
double RelativeDifference(double a, double b);
double RelativeDifference(const Color& a, const Color& b);

// Largest relative difference between the values of a sample, or a photon, and those of EvaluateSamples for it.
// `opacity`: Light::Opacity at the hit.
double Mismatch(const LightSample& sample, const LightEvaluation& evaluation, float opacity = 1);
double Mismatch(const EmissionSample& photon, const LightEvaluation& evaluation, float opacity = 1);
LightHit HitOf(const LightSample& sample, const Point3& P);
LightHit HitOf(const EmissionSample& photon, float distance);

// Relative deviation of a result's diffuse and specular parts from one emission times the light's two multipliers.
template <class Result>
double MultiplierMismatch(const SuiteSubject& subject, const Result& result) {
  return RelativeDifference(result.diffuse * static_cast<float>(subject.specularMultiplier),
                            result.specular * static_cast<float>(subject.diffuseMultiplier));
}
// Relative difference between the radiance that a camera sees at a hit and the evaluation of the hit. nullopt: both
// multipliers are 0, so that nothing can be compared.
std::optional<double> CameraMismatch(const SuiteSubject& subject, const LightHit& hit,
                                     const std::optional<LightEvaluation>& evaluation);

// p-value of two means being equal up to a relative error of `tolerance` plus an absolute error of `absolute`.
double EqualMeans(const Estimate& a, const Estimate& b, double tolerance, double absolute = 0);
inline Estimate EstimateOf(const RunningMean& mean) {
  return {mean.Mean(), mean.StandardError()};
}

// Description of two means, such as "light sampling is 0.51 ± 1e-4; expected 0.5 ± 1e-5".
std::string InWords(const std::string& what, const Estimate& got, const Estimate& expected);

// Flux of a photon. A light's power is the mean flux over all draws; draws without a photon count as 0.
double Flux(const SuiteSubject& subject, const EmissionSample& photon);

void CheckPowerEstimate(const SuiteSubject& subject, const Estimate& emitted, SuiteReport& report);

// A photon of which one part, position or direction, stays fixed: one of context.u and context.uDirection determines
// that part and is kept, the other is redrawn. FindFixedStart returns nullopt if nothing is emitted, or if neither of
// the two alone determines the part.
struct FixedStart {
  LightContext context;
  bool byDirection = false;  // uDirection is fixed, u varies
  EmissionSample photon;

  LightContext Draw(const Point2& v) const {
    LightContext drawn = context;
    (byDirection ? drawn.u : drawn.uDirection) = v;
    return drawn;
  }
};
enum class FixedPart { Position, Direction };
std::optional<FixedStart> FindFixedStart(const SuiteSubject& subject, FixedPart part, double tolerance, Rng& rng);

// Mean of function(x) over the four-dimensional unit cube, from `lattices` randomly shifted lattices of `points` each:
// far less noise than independent numbers, and the spread of the lattices' means is the error.
template <class Function>
Estimate LatticeMean(Rng& rng, int lattices, int points, const Function& function) {
  // Powers of the inverse of the root of x⁵ = x + 1 ([Roberts18]).
  constexpr double steps[4] = {0.8566748838545029, 0.7338918566271260, 0.6287067210378087, 0.5385972572236101};
  RunningMean means;
  for (int lattice = 0; lattice < lattices; ++lattice) {
    double shift[4], sum = 0;
    for (double& s : shift) s = static_cast<double>(rng.NextFloat());
    for (int i = 0; i < points; ++i) {
      float x[4];
      for (int k = 0; k < 4; ++k) {
        const double value = shift[k] + i * steps[k];
        x[k] = std::min(static_cast<float>(value - std::floor(value)), 0x1.fffffep-1f);
      }
      sum += function(x);
    }
    means.Add(sum / points);
  }
  return EstimateOf(means);
}

// LatticeMean with more and more points until the error is below `relative` times the mean.
template <class Function>
Estimate SharpMean(Rng& rng, double relative, const Function& function) {
  constexpr int kLattices = 128, kMost = 4096;
  Estimate estimate;
  for (int points = 64; points <= kMost; points *= 4) {
    estimate = LatticeMean(rng, kLattices, points, function);
    if (estimate.error <= relative * std::abs(estimate.value)) break;
  }
  return estimate;
}
// Adds the check that pdfDirect integrates to at most 1 over all directions of `cap`. `emitting` is its integral over
// the directions from which light comes; `dark(direction)` is the density where none comes, 0 elsewhere.
template <class Function>
void CheckDarkDensity(const SuiteSubject& subject, const std::string& where, const Estimate& emitting, const Cap& cap,
                      const Function& dark, Rng& rng, SuiteReport& report) {
  constexpr int kDirections = 4096;
  RunningMean mean;
  for (int i = 0; i < kDirections; ++i) {
    const auto w = static_cast<double>(rng.NextFloat());
    mean.Add(cap.SolidAngle() * dark(cap.Direction(cap.wMax * w, static_cast<double>(rng.NextFloat()))));
  }
  const Estimate all = emitting + EstimateOf(mean);
  report.AddProbability(subject.name, "integral", where + " with what is dark",
                        all.value <= 1 ? 1.0 : EqualMeans(all, {1, 0}, 1e-3),
                        InWords("the integral of pdfDirect, dark directions included,", all, {1, 0}));
}
// Probability of a rare event and the mean of its values. Draws are taken until the event has been observed some
// hundred times.
struct Counted {
  Estimate share, sum;  // fraction of draws that count; mean of their values over all draws
};
template <class Function>  // std::optional<double>(x): the value of a draw that counts
Counted CountedMean(Rng& rng, const Function& function) {
  constexpr int kLattices = 128, kMost = 1024, kEnough = 200;
  Counted counted;
  for (int points = 32; points <= kMost; points *= 4) {
    RunningMean shares, sums;
    double found = 0;
    for (int lattice = 0; lattice < kLattices; ++lattice) {
      double sum = 0, hits = 0;
      LatticeMean(rng, 1, points, [&](const float(&x)[4]) {
        if (const std::optional<double> value = function(x)) {
          ++hits;
          sum += *value;
        }
        return 0.0;
      });
      shares.Add(hits / points);
      sums.Add(sum / points);
      found += hits;
    }
    counted = {EstimateOf(shares), EstimateOf(sums)};
    if (found >= kEnough) break;
    // An event that was not observed may still have a positive probability: the error is at least that of a count of
    // one.
    const double draws = static_cast<double>(kLattices) * points, least = std::sqrt(std::max(found, 1.0)) / draws;
    counted.share.error = std::max(counted.share.error, least);
    const double each = found > 0 ? counted.sum.value / counted.share.value : 0.0;
    counted.sum.error = std::max(counted.sum.error, each * least);
  }
  return counted;
}

// 1 if the position of a photon, or its existence, depends on the random numbers of its direction; else 0.
double WorstPhotonOrigin(const SuiteSubject& subject, Rng& rng);

}  // namespace lampyr::suite
