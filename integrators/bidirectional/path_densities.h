// Densities of all surface vertices of a path, and the terms of merging that follow from them.
//
// A path with the surface vertices 1 … n, from the light on, may be merged at any of them, whichever technique made it:
// with a photon of any of N light paths within the radius r. The density is p_(i+1) · B_i · N π r² (walk/
// partial_weight.h). But photons that are gathered together are correlated: where a narrow beginning leads all of their
// paths to the same place, N photons have the variance of one. So the density is multiplied by ([Grittmann21 §5])
//   c_i = max(P_C / (P_C + P_L - P_C P_L), 1/N),   P_L(i) = Π_(k≤i) f_k,   P_C(i) = Π_(k≥i) b_k
// with f_k the probability that another light path has its vertex k within ρ of this path's, and b_k the same for
// another camera path of the pixel; of a vertex in a medium, within the ball of the radius ρ. c is 1 at the vertex that
// the camera sees. It has the same value in the weight of every technique, so that weights sum to 1, and depends on
// both ends of the path, so that no recursion along a subpath can carry it.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "integrators/walk/partial_weight.h"

namespace lampyr {

// Parameters of merging on one path, shared by all of its techniques. They follow from the first vertex from the camera
// whose event is no delta.
struct Merging {
  // N π r² times the probability of merging, for each of the light paths per sample; 0: no merging.
  double perDensity = 0;
  double perVolumeDensity = 0;     // in media: N times the square of the radius's scale, with that probability
  double area = 0;                 // π ρ²
  double radius = 0;               // ρ, scene units
  double lightPaths = 1;           // N
  double lightPathsPerSample = 1;  // LightEnd::emission is this many times that of one light path
  double filmPixels = 1;  // density of the first hit by a ray through its own pixel, over that by a ray through any

  explicit operator bool() const { return perDensity > 0; }
  // `radius`: r. `distance`: path length from the camera; ρ is what a degree spans there.
  // `radiusScale`: of the pass, for photons in media.
  static Merging At(double radius, double distance, double lightPaths, double lightPathsPerSample, double filmPixels,
                    double probability, double radiusScale);
};

// The connection of two subpaths: the last two reverse densities of each, and whether the last vertices can be merged.
struct Joint {
  ReverseDensities light, camera;
  bool mergesAtLight = false, mergesAtCamera = false;
  double lightMergeVolume = 0, cameraMergeVolume = 0;             // SubpathDensities::mergeVolume of the last vertices
  bool lastCameraIsDelta = false, previousCameraIsDelta = false;  // the reverse density is a coefficient
  // The camera's last vertex is a photon's, and `light` holds the photon's path without it: of the light's last vertex
  // only light.last is set.
  bool isMerged = false;
};

// The techniques of a path in groups, each of which an integrator may have or leave out.
enum class TechniqueGroup : uint8_t {
  Hit,      // s = 0
  Next,     // s = 1
  Light,    // t = 1
  Connect,  // connections of two subpaths
  Merge,
  // Techniques of these groups whose camera subpath goes beyond the vertex where it may end
  // (TechniqueCounts::continuing).
  HitBeyond,
  NextBeyond,
  ConnectBeyond,
  MergeBeyond,
};
inline constexpr size_t kTechniqueGroups = 9;
constexpr TechniqueGroup BeyondOf(TechniqueGroup group) {
  switch (group) {
    case TechniqueGroup::Hit:
      return TechniqueGroup::HitBeyond;
    case TechniqueGroup::Next:
      return TechniqueGroup::NextBeyond;
    case TechniqueGroup::Connect:
      return TechniqueGroup::ConnectBeyond;
    case TechniqueGroup::Merge:
      return TechniqueGroup::MergeBeyond;
    default:
      return group;
  }
}

// Σ (n r)^2 and Σ (n r)^4 / r over the techniques of each group: r is a technique's density over that with which the
// path was sampled, n the times that it counts in weights. Of merging r is the density times c, of splats (t = 1) times
// splatCount; n is 1 but for NextEventCount.
struct TechniqueSums {
  struct Group {
    double squares = 0, cubes = 0;
    void Add(double ratio, double count = 1) {
      squares += Mis(count * ratio);
      cubes += Mis(Mis(count)) * Mis(ratio) * ratio;
    }
  };
  std::array<Group, kTechniqueGroups> groups;
  bool isBeyond = false;  // the technique that sampled the path is of a group Beyond
  Group& Of(TechniqueGroup group) { return groups[static_cast<size_t>(group)]; }
  const Group& Of(TechniqueGroup group) const { return groups[static_cast<size_t>(group)]; }
};

class PathDensities {
 public:
  // A path of the vertices of both subpaths, each from its own end on. `end`: of its light.
  void Set(std::span<const SubpathDensities> light, std::span<const SubpathDensities> camera, const Joint& joint,
           double emission, LightEnd::Extent extent, const Merging& merging);

  // Σ (p_i / p)^β over the techniques that merge, for the technique p:
  // - the light's end with s = 0 or 1, of the density `technique`;
  // - a connection of the last vertex of the light subpath, to the camera subpath or to the lens;
  // - merging at vertex `i`, itself left out.
  double ForLight(double technique) const;
  double ForConnection(size_t lightCount) const;
  double ForMerging(size_t i) const;
  // N π r² c at vertex `i`.
  double PerDensityAt(size_t i) const { return WithoutCorrelation(vertices_[i]) * vertices_[i].correlation; }

  // The sums over all techniques, for a path that technique `s` has made, or merging at vertex `mergedAt` if that is
  // not 0. All 0 where the camera could not have made the path. Of camera paths that always continue.
  TechniqueSums Sums(const PathEnds& ends, size_t s, size_t mergedAt) const;

  size_t Count() const { return count_; }

 private:
  bool IsDelta(const PathEnds& ends, size_t i) const {
    return (i == 1 && ends.firstIsDelta) || (i < count_ && vertices_[i + 1].lightIsDelta) ||
           (i > 1 && vertices_[i - 1].cameraIsDelta);
  }
  // The vertex where a camera path may end, the first one from the camera whose event is no delta; 0: none.
  size_t EndOfCamera(const PathEnds& ends) const;
  struct Vertex {
    double fromLight = 0, fromCamera = 0;
    double correlation = 1;  // c
    bool lightIsDelta = false, cameraIsDelta = false, canMerge = false;
    bool isInMedium = false;
    double mergeVolume = 0;  // SubpathDensities::mergeVolume
  };
  // N π r² at a vertex, without c.
  double WithoutCorrelation(const Vertex& vertex) const {
    return vertex.isInMedium ? merging_.perVolumeDensity * vertex.mergeVolume : merging_.perDensity;
  }
  void Correlate();
  // The terms at the vertices from `i` on. `ratio`: p_i / p, without c.
  double TowardsCamera(size_t i, double ratio) const;
  double TowardsLight(size_t i, double ratio) const;

  std::vector<Vertex> vertices_;  // [0] is not used; more than `count_`
  size_t count_ = 0;
  double emission_ = 0;
  LightEnd::Extent extent_ = LightEnd::Extent::Point;
  Merging merging_;
};

}  // namespace lampyr
