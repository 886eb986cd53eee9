// Directions of photons, as a light draws them and as it says that they are distributed.
#pragma once

#include "suite/checks.h"

namespace lampyr::suite {

struct DirectionSource {
  // A direction by four random numbers; nullopt: none is drawn by them.
  std::function<std::optional<Vector3>(const float (&x)[4])> draw;
  std::function<double(const Vector3d&)> density;  // pdfEmitDirection of a unit direction
};

// For photons that start at one place of a light with a surface, `distance` long.
DirectionSource DirectionsFrom(const SuiteSubject& subject, const FixedStart& start, float distance);
DirectionSource DirectionsOfPoint(const SuiteSubject& subject, const Point3& position);
// Towards the light. What is emitted in a direction is asked for at the end of a line on which photons do travel: one
// through the point that is nearest to all photons' lines, or through one of those where each comes nearest to it.
DirectionSource DirectionsFromInfinity(const SuiteSubject& subject, int photons, Rng& rng);

struct DirectionEffort {
  int draws = 4000, cells = 48, points = 32;  // of χ²; of each of 128 lattices
  int budget = DirectionQuadrature::kBudget;
  bool moments = false;  // tilts and ripples, which a χ² of few cells cannot see
};

// emission-integral and emission-directions.
void CheckDirectionsOf(const SuiteSubject& subject, const DirectionSource& source, const std::string& where,
                       const DirectionEffort& effort, Rng& rng, SuiteReport& report);

// With so many photons that a tilt of a hundredth shows.
void CheckDirectionsFinely(const SuiteSubject& subject, const SuiteOptions& options, SuiteReport& report);

}  // namespace lampyr::suite
