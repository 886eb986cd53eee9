// Learned densities of directions, by region of the scene: in proportion to incident radiance for camera paths, and to
// incident importance for light paths. A region is a box of positions whose normals have the same main direction.
//
// A scattering event of either walk has the density α · guide + (1 - α) · scattering, by its region's mixture and
// share. The region depends on the place alone and not on the walk that arrived, so that each walk knows the density
// that the other one would have had: its forward density is of one mixture and its reverse density of the other.
#pragma once

#include <cstdint>
#include <vector>

#include "integrators/guide/direction_mixture.h"
#include "integrators/guide/mixture_fit.h"

namespace lampyr {

class ByteReader;
class ByteWriter;

struct GuideRegion {
  MixtureFit radiance, importance;
};

// Ratios of densities of a sampled event, with a guide to without one: forward and reverse. A delta has ratios of
// probabilities.
struct Guidance {
  float forward = 1, reverse = 1;
};

// Main directions of normals, and one for places without a normal.
inline constexpr uint8_t kGuideSides = 7;
// Index of the main direction of `normal`. The normal of an opaque surface faces the path; that of a transmissive one
// is the surface's own; 0: the place has none.
uint8_t GuideSideOf(const Normal3& normal);

// A scattering event as recorded for the guides.
struct PlacedEvent : GuideEvent {
  uint8_t side = 0;
};

class PathGuide {
 public:
  PathGuide() = default;  // guides nothing
  // Fits all regions, on at most `threads` threads. The events are of camera paths and of light paths; they are
  // reordered.
  PathGuide(std::vector<PlacedEvent>& ofCamera, std::vector<PlacedEvent>& ofLight, int threads);

  // Null: not guided there.
  const GuideRegion* Find(const Point3& position, uint8_t side) const {
    uint32_t at = roots_[side];
    if (at == kNone) return nullptr;
    while (nodes_[at].axis < 3) {
      const Node& node = nodes_[at];
      at = node.next + (position[node.axis] < node.split ? 0 : 1);
    }
    return &regions_[nodes_[at].next];
  }
  size_t Regions() const { return regions_.size(); }
  const GuideRegion& Region(size_t index) const { return regions_[index]; }

  void Save(ByteWriter& bytes) const;
  // Throws an Error if the data is not what Save wrote.
  void Load(ByteReader& bytes);

 private:
  static constexpr uint32_t kNone = 0xffffffffu;
  static constexpr size_t kMostRegions = size_t{1} << 16;
  // An inner node divides along `axis`, and its two children follow each other from `next` on; a leaf has axis 3 and
  // the region `next`.
  struct Node {
    float split = 0;
    uint32_t axis = 3, next = 0;
  };
  struct Part;
  class Builder;

  std::vector<Node> nodes_;
  std::vector<GuideRegion> regions_;
  std::array<uint32_t, kGuideSides> roots_{kNone, kNone, kNone, kNone, kNone, kNone, kNone};
};

}  // namespace lampyr
