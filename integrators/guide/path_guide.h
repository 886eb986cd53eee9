// Learned densities of directions, by region of the scene: in proportion to incident radiance for camera paths, and to
// incident importance for light paths.
//
// A scattering event of either walk has the density α · guide + (1 - α) · scattering, by its region's mixture and
// share. The region depends on the place alone and not on the walk that arrived, so that each walk knows the density
// that the other one would have had: its forward density is of one mixture and its reverse density of the other.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "integrators/guide/direction_mixture.h"
#include "integrators/guide/mixture_fit.h"
#include "integrators/guide/region_tree.h"

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

// A scattering event as recorded for the guides.
struct PlacedEvent : GuideEvent {
  uint8_t side = 0;
};

class PathGuide {
 public:
  PathGuide() = default;  // guides nothing
  // Fits all regions, on at most `threads` threads, to events of camera paths and of light paths.
  PathGuide(std::span<const PlacedEvent> ofCamera, std::span<const PlacedEvent> ofLight, int threads);

  // Null: not guided there.
  const GuideRegion* Find(const Point3& position, uint8_t side) const {
    const uint32_t region = tree_.Find(position, side);
    return region == RegionTree::kNone ? nullptr : &regions_[region];
  }
  size_t Regions() const { return regions_.size(); }
  const GuideRegion& Region(size_t index) const { return regions_[index]; }

  void Save(ByteWriter& bytes) const;
  // Throws an Error if the data is not what Save wrote.
  void Load(ByteReader& bytes);

 private:
  RegionTree tree_;
  std::vector<GuideRegion> regions_;
};

}  // namespace lampyr
