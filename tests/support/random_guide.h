// A guide of a scene that was learned from nothing: events in random places, in directions that crowd around a few.
#pragma once

#include <memory>
#include <vector>

#include "integrators/guide/path_guide.h"
#include "math/bounds.h"
#include "sampling/rng.h"
#include "sampling/warp.h"

namespace lampyr::test {

inline std::shared_ptr<const PathGuide> RandomGuide(const BoundingSphere& scene, uint64_t seed = 1) {
  Rng rng(seed);
  const auto events = [&] {
    std::vector<Vector3> favourites;
    for (int i = 0; i < 5; ++i) favourites.push_back(SampleUniformSphere(rng.NextPoint2()));
    std::vector<PlacedEvent> made;
    for (int i = 0; i < 30000; ++i) {
      PlacedEvent event;
      event.side = static_cast<uint8_t>(i % kGuideSides);
      event.position = scene.center + scene.radius * rng.NextFloat() * SampleUniformSphere(rng.NextPoint2());
      const Vector3 spread = SampleUniformSphere(rng.NextPoint2()) * (0.05f + 0.6f * rng.NextFloat());
      const Vector3 way = favourites[static_cast<size_t>(rng.NextFloat() * 5)] + spread;
      event.direction = way / glm::length(way);
      event.distance = i % 3 == 0 ? kInfinity : scene.radius * (0.1f + rng.NextFloat());
      event.unguided = 0.1f;
      event.weight = 0.5f + rng.NextFloat();
      made.push_back(event);
    }
    return made;
  };
  std::vector<PlacedEvent> ofCamera = events(), ofLight = events();
  return std::make_shared<const PathGuide>(ofCamera, ofLight, 2);
}

}  // namespace lampyr::test
