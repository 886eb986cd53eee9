// Placements in render space, of what moves while the shutter is open and of what does not.
#pragma once

#include <memory>

#include "math/motion.h"
#include "scene/scene_description.h"

namespace lampyr {

// Placement in render space: at shutter open, and the motion from there.
struct RenderPlacement {
  Transform toRender;
  std::shared_ptr<const Motion> motion;  // null: stays
};

AnimatedTransform ToAnimated(const Placement& placement, const char* what, const FileLocation& where);

class Placer {
 public:
  // Reads the times of the shutter and of the scene's transforms, before anything is placed. Throws an Error.
  void ReadTimes(const SceneDescription& description);
  // World space is render space until it is set.
  void SetWorldToRender(const Transform& worldToRender) { worldToRender_ = worldToRender; }
  const Transform& WorldToRender() const { return worldToRender_; }

  bool Moves(const Placement& placement) const { return times_.MovesInShutter() && placement.IsAnimated(); }
  // Placement of a shape that does not move while the shutter is open.
  Transform StillPlacement(const ShapeDescription& shape) const;
  // `moved`: bounds of what moves, in its own space.
  RenderPlacement PlaceMoving(const MotionChain& toRender, const Bounds3& moved, const char* what,
                              const FileLocation& where);
  // Placement of something without an extent of its own: a light or a filter.
  RenderPlacement PlaceInWorld(const Placement& placement, const char* what, const FileLocation& where);

  // True if something was placed that moves while the shutter is open.
  bool HasMotion() const { return hasMotion_; }

 private:
  MotionTimes times_;
  Transform worldToRender_;
  bool hasMotion_ = false;
};

}  // namespace lampyr
