// A ray, its hit (as compact as the intersector returns it), and the full description of the point that was hit.
#pragma once

#include <cstdint>
#include <span>

#include "math/vec.h"

namespace lampyr {

// Kinds of rays, as bits: a primitive can be invisible to some (GeometryAttributes::visibility).
namespace visibility {
inline constexpr uint32_t kCamera = 1;    // from the camera, or after only passing through
inline constexpr uint32_t kIndirect = 2;  // scattered by a surface, or emitted by a light
inline constexpr uint32_t kShadow = 4;    // between a surface point and a light
inline constexpr uint32_t kAll = 7;
// Rays that find the medium at a point (FindMedium): they hit only surfaces that separate media, and pass all of them.
inline constexpr uint32_t kMedia = 8;
}  // namespace visibility

struct Ray {
  Point3 origin;
  Vector3 direction;  // unit length, unless documented otherwise
  float tMax = kInfinity;
  float time = 0;  // in [0,1] over the shutter
};

// A ray in double precision, in any space; the direction need not be unit length.
struct RayDouble {
  Point3d origin;
  Vector3d direction;
  double tMin = 0, tMax = 0;  // open below, closed above
};

// Embree's interval is closed below: a hit at the origin itself is excluded by this bound.
inline constexpr float kNearestHit = 1e-25f;

inline constexpr uint32_t kNoIndex = 0xffffffffu;

// Special values of an index of participating media (RenderScene::media).
inline constexpr int32_t kVacuum = -1;
inline constexpr int32_t kSameMedium = -2;  // of a surface's side: the medium that the path is in

// The nearest hit along a ray: indices and parametric coordinates.
struct RayHit {
  float t = kInfinity;            // ray parameter
  uint32_t primitive = kNoIndex;  // index of the shape, over all shapes of the scene
  uint32_t patch = 0;             // triangle, bilinear patch or curve within the shape
  uint32_t instance = kNoIndex;   // index of the instance, kNoIndex for shapes outside of instances
  float u = 0, v = 0;             // barycentric (triangles), parametric otherwise
};

// A surface that a ray passed straight through: a thin surface or a boundary between media (GeometryScene::Trace).
struct Crossing {
  double t = 0;                   // ray parameter, or along a FineLine
  uint32_t primitive = kNoIndex;  // as in RayHit
  uint32_t patch = 0;
  uint32_t instance = kNoIndex;
  bool entering = false;  // from the outside, which is the side that Ng points to
  Color transmittance{1.0f};
  int32_t medium = kSameMedium;  // behind the surface; kSameMedium: the same as in front
};

// Product of the crossings' transmittances.
inline Color Transmittance(std::span<const Crossing> crossings) {
  Color product(1.0f);
  for (const Crossing& crossing : crossings) product *= crossing.transmittance;
  return product;
}

// Kind of a point on a curve, where v depends on the arriving ray. A ribbon has a surface; that of a fibre faces the
// ray, or is round.
enum class Strand : uint8_t { None, Ribbon, Fibre };

// A point on a surface. Everything is in render space.
struct SurfacePoint {
  Point3 position{0.0f};
  Vector3 positionError{0.0f};  // bound on the absolute error of each component of `position`
  Normal3 Ng{0, 0, 1};          // geometric, unit, pointing to the shape's outside (emission leaves there)
  Normal3 Ns{0, 0, 1};          // shading, unit, dot(Ng, Ns) >= 0
  Point2 uv{0.0f};
  Vector3 dpdu{0.0f}, dpdv{0.0f};  // not unit; 0 when degenerate
  uint32_t primitive = kNoIndex;
  uint32_t patch = 0;
  uint32_t instance = kNoIndex;
  Strand strand = Strand::None;
  bool isThin = false;  // light that goes straight on is not scattered by the surface (ThinSurface)
};

}  // namespace lampyr
