#include "render/build/placer.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "geometry/shape_checks.h"

namespace lampyr {

AnimatedTransform ToAnimated(const Placement& placement, const char* what, const FileLocation& where) {
  return AnimatedTransform(placement.start, placement.end, what, where);
}

void Placer::ReadTimes(const SceneDescription& description) {
  times_ = MotionTimesOf(description);
}

Transform Placer::StillPlacement(const ShapeDescription& shape) const {
  if (!shape.placement.IsAnimated()) return shape.placement.start;
  return ToAnimated(shape.placement, "a shape", shape.shape.where).At(times_.FractionAt(0));
}

RenderPlacement Placer::PlaceMoving(const MotionChain& toRender, const Bounds3& moved, const char* what,
                                    const FileLocation& where) {
  RenderPlacement placement{toRender.At(times_.FractionAt(0)), MakeMotion(toRender, times_, moved, what, where)};
  if (!placement.toRender.IsAffine()) throw Error(where, std::string(what) + " cannot have a perspective transform");
  if (placement.motion) hasMotion_ = true;
  return placement;
}

RenderPlacement Placer::PlaceInWorld(const Placement& placement, const char* what, const FileLocation& where) {
  RenderPlacement placed{worldToRender_ * placement.start, nullptr};
  if (placement.IsAnimated())
    placed = PlaceMoving(MotionChain(worldToRender_) * ToAnimated(placement, what, where), {}, what, where);
  if (!placed.toRender.IsAffine()) throw Error(where, std::string(what) + " cannot have a perspective transform");
  const Point3d origin = placed.toRender.Point(Point3d(0.0));
  if (!(std::max({std::abs(origin.x), std::abs(origin.y), std::abs(origin.z)}) <= static_cast<double>(kFarthest)))
    throw Error(where, std::string(what) + " is placed farther out than 1e18");
  return placed;
}

}  // namespace lampyr
