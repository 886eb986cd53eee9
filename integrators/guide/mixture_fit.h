// Fits a mixture of directions, and its share beside the density that a walk has without it, to weighted events.
#pragma once

#include <span>

#include "integrators/guide/direction_mixture.h"

namespace lampyr {

// A scattering event of a walk, with its weight in the fit.
struct GuideEvent {
  Point3 position{0.0f};
  Vector3 direction{0.0f};  // unit, of the walk's next ray
  float distance = 0;       // to the next vertex, scene units; infinite: none
  // Density of the direction without a guide, 1/sr; 0: it was sampled as a delta, which no guide does.
  float unguided = 0;
  float weight = 0;  // radiance that the walk found beyond, over the density of its direction; 0 or more
};

// The density α · guide + (1 - α) · unguided under which the events are most likely, each as often as its weight says:
// by expectation maximisation, in which the unguided density is one component of the mixture. So the guide fits the
// light that scattering alone samples poorly. Lobes are split from one to kLobes. The share is less than the most
// likely α, because variance counts and not likelihood.
struct MixtureFit {
  DirectionMixture mixture;
  float share = 0;  // α in [0, kMostShare]; 0: not guided
};

// Upper bound of the share α of a guide. It bounds the weight of a guided sample by 1 / (1 - kMostShare) times that of
// an unguided one.
inline constexpr float kMostShare = 0.7f;

// `events`: at least one. `center`: of their region, from which distances to targets are taken.
MixtureFit FitMixture(std::span<const GuideEvent> events, const Point3& center);

}  // namespace lampyr
