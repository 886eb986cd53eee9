// The photons of one pass, with a search for all photons within a radius. The search is exact, may run in any thread,
// and does not depend on the number of threads that built the map.
//
// Photons are sorted along a space-filling curve: those that a lookup finds lie together in memory. A lookup that finds
// few of them takes a grid over the sorted photons (photon_grid.h), any other FLANN's kd-tree in three dimensions,
// which is built for the first lookup that needs it.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "base/large_array.h"
#include "base/large_pages.h"
#include "integrators/photon/beam_search.h"
#include "integrators/photon/photon.h"
#include "integrators/photon/photon_grid.h"

namespace lampyr {

// Buffers of a thread, reused from lookup to lookup.
struct PhotonLookup {
  std::vector<uint32_t> found;
  std::vector<float> distances;  // squared, of `found`: scene unit²
  std::vector<BeamHit> beamHits;
  std::vector<BeamCrossing> crossings;
  std::vector<uint32_t> boxes;
  std::vector<PhotonUse::Contribution> used;  // of the photons found, for emission guiding
};

class PhotonMap {
 public:
  PhotonMap();
  ~PhotonMap();
  PhotonMap(PhotonMap&&) noexcept;
  PhotonMap& operator=(PhotonMap&&) noexcept;

  // Builds the map of the concatenated lists. Photons whose position or flux is not finite are left out and counted.
  // `origins`, if not null, receives for each photon the index of its path's origin in the concatenated origins of the
  // lists, and after those the same for each start of a flight (FlightStart::kNone: not known).
  // `radius`: of photons in media.
  PhotonMap(std::span<const PhotonList> lists, int threads, std::vector<uint32_t>* origins = nullptr,
            const VolumeRadius& radius = {});

  // Indices of all photons nearer than `radius` (scene units), in an order that depends on the photons alone. Valid
  // until the next lookup. A radius of 0 finds nothing.
  std::span<const uint32_t> Find(const Point3& position, float radius, PhotonLookup& lookup) const;

  // Fetches into the cache what Find reads first, while other work goes on.
  void PrefetchCells(const Point3& position, float radius) const {
    if (search_) grid_.PrefetchCells(position - center_, radius);
  }

  // The photons in media whose balls a ray passes on [0, tMax), in an order that depends on the photons alone. Valid
  // until the next search. [Jensen98]'s photons, seen by beams ([Jarosz08]).
  std::span<const BeamHit> FindAlong(const Ray& ray, float tMax, PhotonLookup& lookup) const;
  bool HasPoints() const { return !volume_.empty(); }
  // The beams that a ray passes on [0, tMax), as FindAlong.
  std::span<const BeamCrossing> FindBeams(const Ray& ray, const FineLine& line, float tMax, PhotonLookup& lookup) const;
  const BeamMap& Beams() const { return beams_; }
  // Densities of the vertices of a light path before its flight from `start`.
  std::span<const SubpathDensities> PathOf(const FlightStart& start) const {
    return start.depth == 1 ? std::span<const SubpathDensities>()
                            : std::span(&densities_[start.path], start.depth - 1u);
  }
  PathEnds EndsOf(const FlightStart& start) const { return PathEnds::Unpacked(densities_[start.path - 1]); }
  // The medium's data of a photon, by an index that FindAlong returned.
  const VolumePhoton& VolumeOf(uint32_t index) const { return volume_[index - firstVolume_]; }

  const Photon& operator[](uint32_t index) const { return photons_[index]; }
  // From `point` to a photon on a surface.
  Vector3 OffsetFrom(const Point3& point, uint32_t index) const {
    return grid_.Positions()[index] - Point3(point - center_);
  }
  // Flux of a photon for specular lobes; a light may send them other radiance than diffuse lobes.
  const Color& SpecularFlux(const Photon& photon) const {
    return photon.specular == Photon::kSame ? photon.flux : specular_[photon.specular];
  }

  // Densities of the vertices of a photon's path, up to its own; empty if they were not kept.
  std::span<const SubpathDensities> PathOf(const Photon& photon) const {
    return densities_.Size() == 0 ? std::span<const SubpathDensities>()
                                  : std::span(&densities_[photon.path], photon.depth);
  }

  // Fetches what PathOf gives into the cache.
  void PrefetchPathOf(const Photon& photon) const {
    if (densities_.Size() == 0) return;
    Prefetch(&densities_[photon.path]);
    Prefetch(&densities_[photon.path + photon.depth - 1u].canMerge);
  }

  // Labels of a photon's path; empty without layers.
  std::span<const PathLabel> LabelsOf(uint32_t index) const {
    if (ranges_.empty()) return {};
    const LabelRange& range = ranges_[index];
    return std::span(labels_).subspan(range.first, range.end - range.first);
  }

  // The light's end of a photon's path, if its densities were kept. Of a path that ends at its first hit `hit` is
  // unknown.
  PathEnds EndsOf(const Photon& photon) const { return PathEnds::Unpacked(densities_[photon.path - 1]); }

  size_t Size() const { return photons_.Size(); }
  // The index for PhotonUse of the photon that flies from `start`.
  uint32_t UseOf(const PhotonBeam& beam) const { return static_cast<uint32_t>(Size()) + beam.start; }
  bool IsEmpty() const { return photons_.Size() == 0; }
  size_t Rejected() const { return rejected_; }
  // Memory of the photons and of the search tree.
  size_t Bytes() const;
  double BuildSeconds() const { return buildSeconds_; }

 private:
  class Search;
  struct Traced;
  Traced Collect(std::span<const PhotonList> lists, bool wantsOrigins);
  void Build(const Traced& traced, int threads, std::vector<uint32_t>* origins, const VolumeRadius& radius);

  Point3 center_{0.0f};  // positions are kept relative to it
  PhotonGrid grid_;
  LargeArray<Photon> photons_;
  std::vector<Color> specular_;
  LargeArray<SubpathDensities> densities_;
  // Photons in media are those from firstVolume_ on.
  uint32_t firstVolume_ = 0;
  std::vector<VolumePhoton> volume_;
  BeamSearch beamSearch_;
  BeamMap beams_;
  std::vector<LabelRange> ranges_;  // by photon; empty without layers
  std::vector<PathLabel> labels_;
  std::unique_ptr<Search> search_;
  size_t rejected_ = 0;
  double buildSeconds_ = 0;
};

}  // namespace lampyr
