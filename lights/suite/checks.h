// The parts of the suite: by kind of light, and what they share. Private to the suite.
#pragma once

#include <optional>

#include "lights/suite/pdf_suite.h"
#include "sampling/rng.h"

namespace lampyr::suite {

// Directions within `wMax` = 1 - cosθ of an axis: uniform in (w, turns) is uniform in solid angle.
struct Cap {
  Vector3d axis{0, 0, 1};
  double wMax = 2;

  double SolidAngle() const;
  Vector3 Direction(double w, double turns) const;
  // (w / wMax, turns), both in [0,1] within the cap.
  Point2d Invert(const Vector3& direction) const;
};

// The smallest cap around the mean of `directions` that holds them all, a little widened; the sphere beyond 60°.
Cap CapAround(const std::vector<Vector3>& directions);

struct DirectionTest {
  std::string integralProperty, chiSquaredProperty;
  std::function<double(const Vector3&)> density;  // 1/sr
  std::function<std::optional<Vector3>(Rng&)> sample;
  int samples = 0;
  int subdivisions = 24;           // of a cell, for quadrature
  double expectationError = 1e-3;  // relative, besides what two quadratures differ by
};
// Integral and χ² of a distribution of directions.
void CheckDirections(const SuiteSubject& subject, const std::string& suffix, const Cap& cap, const DirectionTest& test,
                     Rng& rng, SuiteReport& report);

void CheckAreaLight(const SuiteSubject& subject, const SuiteOptions& options, SuiteReport& report);
void CheckPointLight(const SuiteSubject& subject, const SuiteOptions& options, SuiteReport& report);
void CheckInfiniteLight(const SuiteSubject& subject, const SuiteOptions& options, SuiteReport& report);  // deltas too

// Relative difference of two densities or colours, 0 for equal ones.
double RelativeDifference(double a, double b);
double RelativeDifference(const Color& a, const Color& b);

// p-value of two means being equal up to a relative error of `tolerance`.
double EqualMeans(double a, double errorA, double b, double errorB, double tolerance);

// Power by emission: the mean over photons of their flux, those that were not emitted as 0.
double Flux(const EmissionSample& photon);

}  // namespace lampyr::suite
