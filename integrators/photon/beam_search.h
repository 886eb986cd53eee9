// Search for the balls that a ray passes: a tree of boxes over balls that are sorted along a space-filling curve.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "integrators/photon/box_tree.h"
#include "integrators/photon/photon.h"

namespace lampyr {

// A ball that a ray passes.
struct BeamHit {
  uint32_t index;         // of the photon
  float t;                // of the point of the ray that is nearest to the photon
  float distanceSquared;  // between both, scene unit²
};

class BeamSearch {
 public:
  BeamSearch() = default;
  // `balls`: near each other where they are neighbours in the list.
  explicit BeamSearch(std::span<const VolumePhoton> balls);

  // Adds first + i and its place for the balls i that the ray passes at its nearest point t in [0, tMax), by increasing
  // i. `boxes`: storage.
  void Find(std::span<const VolumePhoton> balls, const Ray& ray, float tMax, uint32_t first,
            std::vector<uint32_t>& boxes, std::vector<BeamHit>& hits) const;
  size_t Bytes() const { return tree_.Bytes(); }

 private:
  BoxTree tree_;
};

}  // namespace lampyr
