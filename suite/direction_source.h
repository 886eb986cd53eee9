// Directions of photons: the light's sampling of them and the density it reports.
#pragma once

#include "suite/checks.h"

namespace lampyr::suite {

struct DirectionSource {
  // The direction drawn by four random numbers; nullopt if none is drawn.
  std::function<std::optional<Vector3>(const float (&x)[4])> draw;
  std::function<double(const Vector3d&)> density;  // pdfEmitDirection of a unit direction
};

// For photons from one point of a light with a surface. The density is evaluated on edges of length `distance`.
DirectionSource DirectionsFrom(const SuiteSubject& subject, const FixedStart& start, float distance);
DirectionSource DirectionsOfPoint(const SuiteSubject& subject, const Point3& position);
// Directions toward the light. The density of a direction is evaluated at the far end of a line in that direction that
// photons do take: the line through the point nearest to all photons' lines, or through the point of one of those lines
// that is nearest to it.
DirectionSource DirectionsFromInfinity(const SuiteSubject& subject, int photons, Rng& rng);

struct DirectionEffort {
  int draws = 4000, cells = 48, points = 32;  // of the χ² test: draws, cells; of each of 128 lattices: points
  int budget = DirectionQuadrature::kBudget;
  bool moments = false;  // test moments too: a χ² test of few cells detects no tilts or ripples
};

// Checks emission-integral and emission-directions.
void CheckDirectionsOf(const SuiteSubject& subject, const DirectionSource& source, const std::string& where,
                       const DirectionEffort& effort, Rng& rng, SuiteReport& report);

// Checks the directions with enough photons to detect a tilt of a hundredth.
void CheckDirectionsFinely(const SuiteSubject& subject, const SuiteOptions& options, SuiteReport& report);

}  // namespace lampyr::suite
