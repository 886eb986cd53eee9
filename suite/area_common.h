// What the two ways of checking lights with a surface share: by a model of the shape, and by the light's own Surface().
#pragma once

#include "suite/checks.h"

namespace lampyr::suite {

struct Enclosure {
  Point3d middle{0.0};
  double radius = 0;
};

// Nine places around a surface, of which `position` and `normal` are one point.
std::vector<Receiver> ReceiversAround(const Enclosure& enclosure, const Point3d& position, const Vector3d& normal);

// "receiver "near", 0.3 sizes from the light's middle: "
std::string InWords(const Enclosure& enclosure, const Receiver& receiver);

// Given a position, the directions of photons: integral and χ² of pdfEmitDirection.
void CheckAreaEmissionDirections(const SuiteSubject& subject, const SuiteOptions& options, const Enclosure& enclosure,
                                 Rng& rng, SuiteReport& report);

// What photons carry away = what is measured on a sphere around the light by sampling it there.
struct Visibility {
  std::function<bool(const EmissionSample&)> escapes;             // the light itself does not stop the photon
  std::function<bool(const LightSample&, const Point3& P)> sees;  // nor what comes from there to P
};
void CheckAreaPower(const SuiteSubject& subject, const Enclosure& enclosure, const Visibility& visibility, Rng& rng,
                    SuiteReport& report);

// Of a light of several patches: how far what is found on `hit` given its patch, times the probability that the light
// chooses that patch, is from what is found of the whole light; 1 when another patch claims it.
double PatchMismatch(const SuiteSubject& subject, const LightHit& hit, const Point3& P);

// How far a sample's solidAngleToArea is from the cosθ / d² of what it says of itself. Not for those seen edge-on.
double SolidAngleToAreaMismatch(const LightSample& sample);

// Estimates at P and along segments through it, where light arrives.
void CheckAreaEstimates(const SuiteSubject& subject, const Enclosure& enclosure, const Receiver& receiver, Rng& rng,
                        SuiteReport& report);

// Whether a photon leaves outside of the light's emission bounds.
bool LeavesBounds(const EmissionBounds& bounds, const Enclosure& enclosure, const EmissionSample& photon);

}  // namespace lampyr::suite
