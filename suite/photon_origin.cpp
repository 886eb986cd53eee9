// The origin of a photon on a surface must not depend on the direction that is sampled afterwards: light tracing
// connects the origin to the camera for all directions at once.
#include "suite/checks.h"

namespace lampyr::suite {

namespace {

bool SameOrigin(const EmissionSample& a, const EmissionSample& b) {
  return a.position == b.position && a.normal == b.normal && a.patchIndex == b.patchIndex &&
         a.pdfEmit.value == b.pdfEmit.value;
}

bool IsUsable(const EmissionSample& photon) {
  if (!(photon.pdfEmit.value > 0) || std::abs(glm::length(photon.direction) - 1) > 1e-4f) return false;
  // A photon whose direction has no density must be black.
  const bool isBlack = photon.diffuse.IsBlack() && photon.specular.IsBlack();
  return isBlack || (photon.pdfEmitDirection.value > 0 && photon.emissionCosine > 0);
}

}  // namespace

double WorstPhotonOrigin(const SuiteSubject& subject, Rng& rng) {
  constexpr int kPlaces = 64, kDirections = 16;
  for (int i = 0; i < kPlaces; ++i) {
    LightContext context = subject.context;
    context.u = rng.NextPoint2();
    context.uDirection = rng.NextPoint2();
    const auto first = subject.light->GenerateEmission(context);
    if (first && !IsUsable(*first)) return 1;
    for (int k = 1; k < kDirections; ++k) {
      context.uDirection = rng.NextPoint2();
      const auto other = subject.light->GenerateEmission(context);
      if (first.has_value() != other.has_value()) return 1;
      if (first && (!SameOrigin(*first, *other) || !IsUsable(*other))) return 1;
    }
  }
  return 0;
}

}  // namespace lampyr::suite
