// Motion while the shutter is open.
//
// A scene file gives two placements, at the start and the end of the transform times; between them translation,
// rotation and scale are interpolated separately, as in pbrt-v4 ([Shoemake92], [Shoemake85]). Rendering uses keys of
// that motion and interpolates the matrix linearly in between: ray tracing (Embree interpolates instances in this way)
// and lights use the same keys, so that they agree to rounding.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include <glm/gtc/quaternion.hpp>

#include "base/error.h"
#include "math/bounds.h"
#include "math/transform.h"

namespace lampyr {

// A transform that moves from a start (fraction 0) to an end (fraction 1). Both are affine.
class AnimatedTransform {
 public:
  explicit AnimatedTransform(const Transform& fixed) : start_(fixed), end_(fixed) {}
  // Throws an Error at `where` that names `what` ("a shape") if the two cannot be interpolated: exactly one of them
  // mirrors, or one has a perspective part.
  AnimatedTransform(const Transform& start, const Transform& end, const char* what, const FileLocation& where);

  bool IsAnimated() const { return isAnimated_; }
  Transform At(double fraction) const;

 private:
  // linear = rotation · stretch; the stretch is symmetric, negative definite where the transform mirrors.
  struct Parts {
    Vector3d translation{0.0};
    glm::dquat rotation{1, 0, 0, 0};
    glm::dmat3 stretch{1.0};
  };
  static Parts Decompose(const Transform& transform);

  Transform start_, end_;
  bool isAnimated_ = false;
  Parts startParts_, endParts_;
};

// A product of animated transforms, the outermost first: instances of instances of moving shapes.
class MotionChain {
 public:
  MotionChain() : parts_{AnimatedTransform(Transform())} {}
  explicit MotionChain(const Transform& fixed) : parts_{AnimatedTransform(fixed)} {}

  MotionChain operator*(const AnimatedTransform& inner) const;
  MotionChain operator*(const MotionChain& inner) const;

  bool IsAnimated() const;
  Transform At(double fraction) const;
  size_t Length() const { return parts_.size(); }

 private:
  std::vector<AnimatedTransform> parts_;  // adjacent constant transforms are multiplied into one
};

// Begin and end of the motion in shutter time, in which the shutter is open during [0,1]. The interval may lie partly
// or wholly outside.
struct MotionTimes {
  double begin = 0, end = 1;

  // Fraction of the motion that is done: 0 before its beginning, 1 after its end.
  double FractionAt(double time) const;
  bool MovesInShutter() const { return begin < 1 && end > 0; }
};

// A placement that changes over the shutter interval.
class Motion {
 public:
  // At least 2 keys, evenly spaced over [begin, end] within [0,1].
  Motion(float begin, float end, std::vector<Affine> keys);

  // The placement at a shutter time; the first and the last key outside of [begin, end].
  Affine At(float time) const;

  float Begin() const { return begin_; }
  float End() const { return end_; }
  const std::vector<Affine>& Keys() const { return keys_; }
  // Shutter time of a key.
  float TimeOf(size_t key) const {
    return begin_ + (end_ - begin_) * static_cast<float>(key) / static_cast<float>(keys_.size() - 1);
  }

 private:
  float begin_, end_;
  std::vector<Affine> keys_;
};

// Embree's limit.
inline constexpr int kMaxMotionKeys = 129;

// Keys for a chain. Null if it does not move while the shutter is open; its placement is then
// chain.At(times.FractionAt(0)). Points of `moved` (local space; a box of ±1 if empty) deviate from the motion of the
// chain by less than 2e-5 of the size of the box, or by the error that kMaxMotionKeys keys allow (4e-5 to 8e-5 for
// rotations of 130° to 180°). Throws an Error at `where` for a motion that leaves the range of floats or becomes
// singular on its way.
std::shared_ptr<const Motion> MakeMotion(const MotionChain& chain, const MotionTimes& times, const Bounds3& moved,
                                         const char* what, const FileLocation& where);

}  // namespace lampyr
