// The participating medium at a point, found by rays along which the medium changes.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "geometry/geometry_scene.h"

namespace lampyr {

// A surface that separates media, met along a ray.
struct MediumChange {
  uint32_t primitive = kNoIndex;
  int32_t before = kSameMedium, behind = kSameMedium;  // kSameMedium: the surface does not say
  bool isBoundary = false;                             // all rays pass it
  bool isOpaque = false;                               // GeometryAttributes
};

// All changes of the medium along a ray, in order, also behind what stops rays of other kinds.
std::vector<MediumChange> MediumChanges(const GeometryScene& geometry, const Ray& ray);

// A primitive that does not begin in the medium in which the change before it has ended, kNoIndex for none. Behind
// what stops light media need not continue: the foot of a rock in the sand is neither in water nor in air. `start`: the
// medium that the first change should begin in, if that does not stop light; kSameMedium: not known.
uint32_t BrokenLink(const std::vector<MediumChange>& changes, int32_t start = kSameMedium);

struct FoundMedium {
  std::optional<int32_t> medium;  // nullopt: no ray from the point meets a surface that says it
  bool isUnanimous = false;       // all rays say the same, what stops light included
  bool isOfBoundary = false;      // a boundary says it, not only what stops light
  bool isOfOpaque = false;        // nothing but opaque surfaces says it
  // The medium in which all rays end that nothing stops; if each ray is stopped, in which all rays end. A ray that
  // meets no change ends in `medium`. nullopt: rays end in several media, or none meets a change.
  std::optional<int32_t> exterior;
  // A primitive whose side contradicts another one, kNoIndex for none: boundaries overlap or are open.
  uint32_t disputed = kNoIndex;
};

// The medium at a point of render space at a shutter time, by three rays in fixed directions. Each ray votes for the
// medium on the near side of the first surface on it that separates media; a ray that meets none does not vote. The
// majority decides; if all votes differ, the first one does. Surfaces that stop light count only where no ray meets a
// boundary before them.
//
// With a `normal` other than 0 the rays leave to its side, for points on a surface.
FoundMedium FindMedium(const GeometryScene& geometry, const Point3& position, float time,
                       const Normal3& normal = Normal3(0.0f));

// The same, for a point from which boundaries may be few and far, such as the camera. Where no ray meets one, rays
// towards points all over the scene are traced until one does, 256 at most.
FoundMedium FindMediumAround(const GeometryScene& geometry, const Point3& position, float time,
                             const Normal3& normal = Normal3(0.0f));

// The medium in which a ray starts: what the first surface on it that separates media says; `otherwise` if it meets
// none.
int32_t MediumAlong(const GeometryScene& geometry, const Ray& ray, int32_t otherwise);

// The same, but for a ray that an opaque surface stops: what is found around its start, or `stopped` if nothing but
// opaque surfaces says it there.
int32_t MediumAlong(const GeometryScene& geometry, const Ray& ray, int32_t otherwise, int32_t stopped);

// The medium at a point, by one ray: `otherwise` if it meets no surface that says it.
int32_t MediumAt(const GeometryScene& geometry, const Point3& position, float time, int32_t otherwise);

}  // namespace lampyr
