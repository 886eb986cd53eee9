// Russian roulette of camera paths by what they may still find: a path goes on with the probability that makes
// error × cost of the picture smallest ([Rath22]; by expected contribution: [Vorba16]).
//
// A path with the throughput β that arrives in a region goes on with the probability
//   q = β √(M / C) / √(V / C_I),
// where M is the second moment of what paths find beyond an event there, per unit of throughput, C the rays that this
// takes, V the variance of a pixel's samples (of what is found beyond the first event, and of a part of the direct
// light there) and C_I the rays of a sample. β and V are relative to the brightness of the part of the picture. So
// paths are not ended because they are long, but where what they may still find is small against the noise of the
// pixel. The walk raises q where a survivor would carry more than a path that nothing ends.
#pragma once

#include <memory>
#include <vector>

#include "integrators/guide/path_records.h"
#include "integrators/guide/pixel_blocks.h"
#include "integrators/guide/region_tree.h"

namespace lampyr {

class PathRoulette {
 public:
  // √(C_I / V) over the brightness around a pixel. `pixel`: y · width + x.
  double PerNoise(uint32_t pixel) const { return ofBlock_[layout_.Of(pixel)]; }
  // Probability in (0, 1] of going on after an event that is no delta. `throughput`: of the path that arrives, mean of
  // the channels. `side`: GuideSideOf. `perNoise`: of the path's pixel. 0: nothing is known there.
  float Survival(const Point3& position, uint8_t side, float throughput, double perNoise) const {
    const uint32_t region = regions_.Find(position, side);
    if (region == RegionTree::kNone) return 0;
    const double wanted = static_cast<double>(throughput) * perNoise * ofRegion_[region];
    return static_cast<float>(std::min(std::max(wanted, kLeast), 1.0));
  }
  size_t Regions() const { return ofRegion_.size(); }

  void Save(ByteWriter& bytes) const;
  // Throws an Error if the data is not what Save wrote for an image of `layout`.
  static std::shared_ptr<const PathRoulette> Load(const BlockLayout& layout, ByteReader& bytes);

 private:
  friend class RouletteLearning;
  explicit PathRoulette(const BlockLayout& layout) : layout_(layout) {}

  // Bounds the factor on what surviving paths find, also where nothing of that was found while this was learned.
  static constexpr double kLeast = 0.2;

  BlockLayout layout_;
  std::vector<double> ofBlock_;  // √(C_I / V) over the brightness of a block of pixels
  RegionTree regions_;
  std::vector<double> ofRegion_;  // √(M / C)
};

class RouletteLearning {
 public:
  explicit RouletteLearning(const BlockLayout& layout) : layout_(layout) {}

  // Adds recorded paths, and makes a roulette of all so far. `scales`: PixelBlocks::Scales.
  void Learn(const PathRecords& paths, const std::vector<double>& scales);
  // Frees what only Learn needs.
  void End() { events_ = {}; }
  // Null: nothing was found yet.
  const std::shared_ptr<const PathRoulette>& Roulette() const { return roulette_; }

  void Save(ByteWriter& bytes) const;
  // Throws an Error if the data is not what Save wrote.
  void Load(ByteReader& bytes);

 private:
  // An event of a path that went on.
  struct Event {
    Point3 position{0.0f};
    float found = 0;   // radiance found beyond, per unit of throughput
    float rays = 0;    // of the path from there on
    float weight = 1;  // 1 / probability of going on
    uint32_t side = 0;
  };
  void Add(const PathRecords& paths);

  BlockLayout layout_;
  std::vector<Event> events_;
  std::shared_ptr<const PathRoulette> roulette_;
};

}  // namespace lampyr
