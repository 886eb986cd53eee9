// A surface of local space, placed in render space at one instant.
#pragma once

#include "geometry/rounding.h"
#include "lights/direction_map.h"
#include "lights/light.h"
#include "lights/types/area_lights.h"

namespace lampyr {

struct PlacedSurface {
  Affine toRender, toOwn;
  bool isSimilar = false;  // the map to render space preserves angles
  bool isFlat = false;
  float scale = 1;           // if similar: factor of lengths
  double evenStretch = 0;    // factor of areas if it is constant over the surface; 0 otherwise
  Normal3 flatNormal{0.0f};  // of a flat surface, unit, on the outer side

  // `own` maps the surface's space to the space that `placement` starts from; `ownInverse` is its inverse.
  static PlacedSurface From(const Affine& own, const Affine& ownInverse, const LightTransform& placement) {
    PlacedSurface placed;
    placed.toRender = {placement.toRender.linear * own.linear, placement.toRender.Point(own.translation)};
    placed.toOwn = {ownInverse.linear * placement.toLocal.linear, ownInverse.Point(placement.toLocal.translation)};
    placed.isSimilar = IsSimilarity(placed.toRender.linear);
    placed.scale = glm::length(placed.toRender.linear[0]);
    if (placed.isSimilar) placed.evenStretch = Sqr(static_cast<double>(placed.scale));
    return placed;
  }
  void SetFlat(const Normal3& ownNormal) {
    isFlat = true;
    flatNormal = SafeNormalize(toOwn.NormalByInverse(ownNormal), Normal3(0, 0, 1));
    evenStretch = ExactAreaStretch(toRender, flatNormal);
  }

  // In the surface's space, relative to its origin, to avoid cancellation for small lights far from the origin of
  // render space.
  Point3 ToOwn(const Point3& P) const { return toOwn.linear * (P - toRender.translation); }
  // Ratio of dA in render space to dA in the surface's own space at the normal `normal`.
  double StretchAt(const Normal3& normal) const {
    return evenStretch > 0 ? evenStretch : ExactAreaStretch(toRender, normal);
  }
  Normal3 NormalAt(const Normal3& own) const {
    return isFlat ? flatNormal : SafeNormalize(toOwn.NormalByInverse(own), Normal3(0.0f));
  }
};

// A point of a surface, seen from a receiver.
struct SeenPoint {
  Point2 uv{0.0f};
  float outwardCosine = 0;  // between the normal and the direction to the receiver
  float distanceSquared = 0;
  PdfArea evenDensity;  // 1/m², of uniform sampling of the whole surface
};

}  // namespace lampyr
