// Points of flights of light paths through participating media, sampled for the camera: in proportion to the inverse of
// the squared distance from it, as [Kulla12] samples camera rays for lights, and only where its image is.
//
// A light path that samples distances by the transmittance alone rarely collides in thin fog, and where it does is
// rarely near. Both techniques make the same paths, which end with a vertex in a medium and the lens (t = 1). They are
// weighted by the density of the one over that of the other, which follows from the vertex and the way to the one
// before: every technique of a path can compute it.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "integrators/walk/light_path.h"

namespace lampyr {

// The sphere around all media that scatter, or around those that the camera may see along straight lines
// (`seenAlone`); that of the scene if one of them is unbounded. nullopt: there is none.
std::optional<BoundingSphere> SphereOfMedia(const RenderScene& scene, bool seenAlone);

class FlightPoints {
 public:
  // Null if the camera sees no medium that scatters along straight lines, or if the camera has no single position
  // (Camera::View).
  static std::shared_ptr<const FlightPoints> Of(const RenderScene& scene);

  struct Sample {
    double t = 0;        // along the line of the flight
    double density = 0;  // 1/scene unit, without the share (ShareAt)
  };
  // nullopt: the camera does not see the flight. `line`: of the flight. `startsAnywhere`: it comes from a light at
  // infinity. `u`: in [0,1).
  std::optional<Sample> Generate(const FineLine& line, bool startsAnywhere, double u) const;

  // Probability of using a point that was sampled in the medium. Less than 1 at great optical depth, where walks
  // collide anyway and little light reaches the camera.
  double ShareAt(const Point3d& position, int32_t medium) const;

  // Density of taking a point of a flight, its share included, 1/scene unit. `toStart`: unit, to where the flight
  // starts, at `distance`, which is infinite for a light at infinity.
  double Density(const Point3d& position, const Vector3d& toStart, double distance, int32_t medium) const;
  // Density of the vertex by its flight for the camera over that of colliding there; 0 on a surface. `collision`:
  // EdgeFactors::forward of a walk that arrives from `toStart`.
  double RatioAt(const Vertex& vertex, const Vector3& toStart, double distance, double collision) const;

 private:
  FlightPoints() = default;

  // The part [from, to] of a line in which points are sampled, and the foot of the camera's place on it. Distances
  // along the line. The same whatever point of the line is its origin, up to rounding.
  struct Range {
    double from = 0, to = 0;
    double foot = 0, height = 0;  // height: of the camera's place above the line
    double angle = 0;             // under which it sees the part; 0: there is none
  };
  Range RangeOf(const Point3d& origin, const Vector3d& direction, double least) const;

  Point3d place_{0.0};            // of the camera
  std::vector<Vector3d> planes_;  // normals of planes through it; the image is on the positive side of each
  Point3d center_{0.0};           // of a sphere around the media
  double radius_ = 0;
  std::vector<double> extinctions_;  // by medium, the largest of it; negative: it is left out
};

// Adds to `path` a vertex at a point of its flight that is sampled for the camera, for the connection to it alone: the
// caller drops it. Its throughput is over the density of the point; its factors are those of a walk that collided
// there. `photon`: emission of a path that starts at a light; null: the path starts in a medium. `dimension`: sampler
// dimension of a pair. False: no point was sampled.
bool AddFlightVertex(const SampleContext& context, const FlightPoints& points, const PathState& state,
                     const Flight& flight, const EmittedPhoton* photon, Sampler& sampler, uint32_t dimension,
                     LightPath& path);

}  // namespace lampyr
