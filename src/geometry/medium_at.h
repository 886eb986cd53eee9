// The participating medium at a point, found by rays along which the medium changes.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "geometry/geometry_scene.h"

namespace lampyr {

// A surface that separates media, on a ray.
struct MediumChange {
  uint32_t primitive = kNoIndex;
  int32_t before = kSameMedium, behind = kSameMedium;  // kSameMedium: not declared
  bool isBoundary = false;                             // all rays pass it
  bool isOpaque = false;                               // GeometryAttributes
};

// All changes of the medium along a ray, in order, also behind surfaces that stop rays of other kinds.
std::vector<MediumChange> MediumChanges(const GeometryScene& geometry, const Ray& ray);

// A primitive that does not begin in the medium in which the change before it has ended, kNoIndex for none. Media need
// not continue behind surfaces that stop light: the foot of a rock in the sand is neither in water nor in air. `start`:
// the medium in which the first change should begin, unless that surface stops light; kSameMedium: unknown.
uint32_t BrokenLink(const std::vector<MediumChange>& changes, int32_t start = kSameMedium);

struct FoundMedium {
  std::optional<int32_t> medium;  // nullopt: no ray from the point hits a surface with a known medium
  bool isUnanimous = false;       // all rays agree, also those to surfaces that stop light
  bool isOfBoundary = false;      // decided by a boundary, not only by surfaces that stop light
  bool isOfOpaque = false;        // decided by opaque surfaces alone
  // The medium in which all rays end that are not stopped; if all are stopped, in which all end. A ray without a change
  // ends in `medium`. nullopt: rays end in several media, or none has a change.
  std::optional<int32_t> exterior;
  // A primitive whose side contradicts another one, kNoIndex for none: boundaries overlap or are open.
  uint32_t disputed = kNoIndex;
};

// The medium at a point of render space at a shutter time, by three rays in fixed directions. Each ray votes for the
// medium on the near side of the first surface on it that separates media; a ray without one does not vote. The
// majority decides; if all votes differ, the first one does. Surfaces that stop light count only where no ray hits a
// boundary in front of them.
//
// With a `normal` other than 0 the rays leave to its side, for points on a surface.
FoundMedium FindMedium(const GeometryScene& geometry, const Point3& position, float time,
                       const Normal3& normal = Normal3(0.0f));

// The same for a point that may be far from all boundaries, such as the camera. If no ray hits one, rays towards points
// all over the scene are traced until one does, 256 at most.
FoundMedium FindMediumAround(const GeometryScene& geometry, const Point3& position, float time,
                             const Normal3& normal = Normal3(0.0f));

// The medium in which a ray starts, from the first surface on it that separates media; `otherwise` if there is none.
int32_t MediumAlong(const GeometryScene& geometry, const Ray& ray, int32_t otherwise);

// The same, except for a ray that an opaque surface stops: the medium found around its start, or `stopped` if only
// opaque surfaces decide it there.
int32_t MediumAlong(const GeometryScene& geometry, const Ray& ray, int32_t otherwise, int32_t stopped);

// The medium at a point, by one ray; `otherwise` if it hits no surface with a known medium.
int32_t MediumAt(const GeometryScene& geometry, const Point3& position, float time, int32_t otherwise);

}  // namespace lampyr
