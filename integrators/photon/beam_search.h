// Search for the balls that a ray passes: a tree of boxes over balls that are sorted along a space-filling curve.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/ray.h"
#include "integrators/photon/photon.h"

namespace lampyr {

// A ball that a ray passes.
struct BeamHit {
  uint32_t index;  // of the photon
  float t;         // of the point of the ray that is nearest to the photon
};

// Each node has up to eight children, whose boxes it holds side by side. Nodes are complete, level by level: no
// pointers.
class BeamSearch {
 public:
  BeamSearch() = default;
  // `balls`: near each other where they are neighbours in the list.
  explicit BeamSearch(std::span<const VolumePhoton> balls);

  // Adds {first + i, t} for the balls i that the ray passes at its nearest point t in [0, tMax), by increasing i.
  void Find(std::span<const VolumePhoton> balls, const Ray& ray, float tMax, uint32_t first,
            std::vector<BeamHit>& hits) const;
  size_t Bytes() const { return nodes_.size() * sizeof(Node); }

 private:
  static constexpr uint32_t kWidth = 8;
  struct Node {
    std::array<std::array<float, kWidth>, 3> least, most;  // of the children; beyond the last without meaning
  };

  std::vector<Node> nodes_;       // level by level, the leaves first
  std::vector<uint32_t> starts_;  // of each level
  std::vector<uint32_t> counts_;  // of the children of each level
};

}  // namespace lampyr
