// The photons of one pass, found by place: all within a radius. Exact, from any thread, and the same for any number of
// threads that made them.
//
// The search is FLANN's tree of points in three dimensions. Photons are sorted along a space-filling curve first: the
// tree is then built several times faster, and what is found lies together in memory.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "integrators/photon/photon.h"

namespace lampyr {

// What a thread keeps from one lookup to the next.
struct PhotonLookup {
  std::vector<uint32_t> found;
};

class PhotonMap {
 public:
  PhotonMap();
  ~PhotonMap();
  PhotonMap(PhotonMap&&) noexcept;
  PhotonMap& operator=(PhotonMap&&) noexcept;

  // Of the lists one after the other. `merge`: see PartialWeight, of the radius that photons will be gathered with.
  // Photons whose position or flux is not finite are left out and counted. `origins`, if wanted: for each photon, the
  // origin of its path in the lists' origins one after the other.
  PhotonMap(std::span<const PhotonList> lists, double merge, int threads, std::vector<uint32_t>* origins = nullptr);

  // All photons nearer than `radius`, in an order that depends on the photons alone; valid until the next lookup. A
  // radius of 0 finds nothing.
  std::span<const uint32_t> Find(const Point3& position, float radius, PhotonLookup& lookup) const;

  const Photon& operator[](uint32_t index) const { return photons_[index]; }
  // What a photon sends to specular lobes: a light may show them other radiance than diffuse ones.
  const Color& SpecularFlux(const Photon& photon) const {
    return photon.specular == Photon::kSame ? photon.flux : specular_[photon.specular];
  }

  size_t Size() const { return photons_.size(); }
  bool IsEmpty() const { return photons_.empty(); }
  size_t Rejected() const { return rejected_; }
  // Of the photons and the search's own, as it keeps them.
  size_t Bytes() const;
  double BuildSeconds() const { return buildSeconds_; }

 private:
  struct Search;

  Point3 center_{0.0f};  // positions are kept relative to it
  std::vector<Photon> photons_;
  std::vector<Color> specular_;
  std::unique_ptr<Search> search_;
  size_t rejected_ = 0;
  double buildSeconds_ = 0;
};

}  // namespace lampyr
