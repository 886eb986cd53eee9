// Photons: what light paths leave behind at their vertices, for camera paths to find.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "integrators/photon/photon_use.h"
#include "integrators/walk/vertex.h"

namespace lampyr {

// A unit vector in four bytes ([Cigolle14], oct16x2): off by 7e-5 at most.
class PackedNormal {
 public:
  PackedNormal() = default;
  explicit PackedNormal(const Normal3& n) {
    const float sum = std::abs(n.x) + std::abs(n.y) + std::abs(n.z);
    float x = n.x / sum, y = n.y / sum;
    if (n.z < 0) {
      const float folded = (1 - std::abs(y)) * (x < 0 ? -1.0f : 1.0f);
      y = (1 - std::abs(x)) * (y < 0 ? -1.0f : 1.0f);
      x = folded;
    }
    x_ = static_cast<int16_t>(std::lround(x * kScale));
    y_ = static_cast<int16_t>(std::lround(y * kScale));
  }
  Normal3 Unpack() const {
    Normal3 n(x_ / kScale, y_ / kScale, 0);
    n.z = 1 - std::abs(n.x) - std::abs(n.y);
    const float t = std::max(-n.z, 0.0f);
    n.x += n.x >= 0 ? -t : t;
    n.y += n.y >= 0 ? -t : t;
    return glm::normalize(n);
  }

 private:
  static constexpr float kScale = 32767;
  int16_t x_ = 0, y_ = 0;
};

// A photon as its path left it: what makes one in a map, once the radius of the pass that gathers it is known.
struct TracedPhoton {
  Point3 position;
  Vector3 toPrevious;
  Color diffuse, specular;  // flux (LightingServices::FluxUnit) over the path's density, for either kind of lobe
  PartialWeight weight;
  float previousSolidAnglePerArea;
  PackedNormal normal;
  uint16_t depth;   // 1: it has come straight from the light
  uint16_t group;   // of the light
  uint32_t origin;  // of its path, in the list
};

// The photons of consecutive light paths. Keeps its memory when it is emptied.
class PhotonList {
 public:
  void Clear() {
    photons_.clear();
    starts_.clear();
    origins_.clear();
  }
  // What is added from now on belongs to the next path.
  void StartPath() { starts_.push_back(static_cast<uint32_t>(photons_.size())); }
  // Where the path comes from, for who wants to know; before its first photon, or never.
  void SetOrigin(const PathOrigin& origin) {
    origins_.resize(KeptOrigins());  // without those of paths that left no photon
    origins_.push_back(origin);
  }
  // `group`: of its light (LightGroups). A depth beyond kDeepest is taken for that. On a cut-out both the photon and
  // who gathers it meet the surface by chance: the photon stands for those that have passed, too.
  void Add(const PathVertex& vertex, size_t depth, uint32_t group = 0) {
    const float passed = vertex.coverage > 0 ? 1 / vertex.coverage : 0.0f;
    const auto origin = static_cast<uint32_t>(origins_.size()) - 1;
    photons_.push_back({vertex.point.position, vertex.toPrevious, vertex.diffuse * passed, vertex.specular * passed,
                        vertex.weight, static_cast<float>(vertex.previousSolidAnglePerArea.value),
                        PackedNormal(vertex.bsdf.Ng()), static_cast<uint16_t>(std::min(depth, kDeepest)),
                        static_cast<uint16_t>(group), origin});
  }
  static constexpr size_t kDeepest = 65535;
  size_t Paths() const { return starts_.size(); }
  // Leaves out whole paths at the end until there are no more than `most` photons; returns the number of paths left.
  size_t KeepPaths(size_t most) {
    while (photons_.size() > most && !starts_.empty()) {
      photons_.resize(starts_.back());
      starts_.pop_back();
    }
    origins_.resize(KeptOrigins());
    return starts_.size();
  }
  const std::vector<TracedPhoton>& Photons() const { return photons_; }
  const std::vector<PathOrigin>& Origins() const { return origins_; }

 private:
  // Of paths that left photons; none where nobody has set any.
  size_t KeptOrigins() const { return photons_.empty() ? 0 : static_cast<size_t>(photons_.back().origin + 1); }

  std::vector<TracedPhoton> photons_;
  std::vector<uint32_t> starts_;  // where each path starts
  std::vector<PathOrigin> origins_;
};

// A photon in a map, without its position.
struct Photon {
  Vector3 toPrevious{0.0f};  // unit
  Color flux;  // LightingServices::FluxUnit over the path's density, for diffuse lobes; for specular ones see PhotonMap
  double connect = 0, earlier = 0;  // PartialWeight, with merging in it
  float previousSolidAnglePerArea = 0;
  PackedNormal normal;  // of the surface
  uint32_t specular = kSame;
  uint16_t depth = 0;
  uint16_t group = 0;  // of the light that it comes from

  static constexpr uint32_t kSame = 0xffffffffu;

  // PartialWeight::BeforeReverse, for the density with which a path from the camera would go on to where the photon
  // came from.
  double BeforeReverse(SolidAngleDensity towardsLight) const {
    const SolidAnglePerArea edge{static_cast<double>(previousSolidAnglePerArea)};
    return connect + Mis(towardsLight * edge) * earlier;
  }
  // Not around a corner. The other side of a thin wall scatters nothing of it: its BSDF says so.
  bool IsOnSurface(const Normal3& Ng) const {
    constexpr float cosine = 0.8f;
    return std::abs(glm::dot(normal.Unpack(), Ng)) > cosine;
  }
};
static_assert(sizeof(Photon) == 56, "photons are counted in millions");

}  // namespace lampyr
