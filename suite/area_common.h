// Code shared by the two ways of checking lights with a surface: by a model of the shape, and by the light's own
// Surface().
#pragma once

#include "suite/checks.h"

namespace lampyr::suite {

struct Enclosure {
  Point3d middle{0.0};
  double radius = 0;
};

// Nine receivers around a surface; `position` and `normal` are those of one point on it.
std::vector<Receiver> ReceiversAround(const Enclosure& enclosure, const Point3d& position, const Vector3d& normal);

// Description of a receiver, such as: receiver "near", 0.3 sizes from the light's middle:
std::string InWords(const Enclosure& enclosure, const Receiver& receiver);

// Checks the directions of photons from fixed positions: the integral of pdfEmitDirection and the χ² test against it.
void CheckAreaEmissionDirections(const SuiteSubject& subject, const SuiteOptions& options, const Enclosure& enclosure,
                                 Rng& rng, SuiteReport& report);

// Checks that the power carried by escaping photons equals the power measured by light sampling on a sphere around the
// light.
struct Visibility {
  std::function<bool(const EmissionSample&)> escapes;             // true if the light itself does not block the photon
  std::function<bool(const LightSample&, const Point3& P)> sees;  // true if it does not block the way from there to P
};
void CheckAreaPower(const SuiteSubject& subject, const Enclosure& enclosure, const Visibility& visibility, Rng& rng,
                    SuiteReport& report);

// Largest relative difference between the densities of the whole light at `hit` and those given its patch times the
// patch's selection probability; 1 if another patch claims the hit. 0 for lights of a single patch.
double PatchMismatch(const SuiteSubject& subject, const LightHit& hit, const Point3& P);

// Relative difference between a sample's solidAngleToArea and cosθ / d² of its own normal, direction and distance. Not
// for samples seen edge-on.
double SolidAngleToAreaMismatch(const LightSample& sample);

// Checks the radiance estimates at a receiver that light reaches, and along segments through it.
void CheckAreaEstimates(const SuiteSubject& subject, const Enclosure& enclosure, const Receiver& receiver, Rng& rng,
                        SuiteReport& report);

// -1 if, by its bounds, a flat light emits to its inner side alone (a two-sided one behind a cone); otherwise 1.
// `normal`: unit, of the outer side.
double EmittingSide(const EmissionBounds& bounds, const Vector3d& normal);

// True if a photon leaves outside the light's emission bounds.
bool LeavesBounds(const EmissionBounds& bounds, const Enclosure& enclosure, const EmissionSample& photon);

}  // namespace lampyr::suite
