// Things that move while the shutter is open.
//
// A scene file gives two placements, at the start and the end of the transform times; between them translation,
// rotation and scale are interpolated each on its own, as pbrt-v4 does it ([Shoemake92], [Shoemake85]). What rendering
// uses is that motion as keys, linear in the matrix in between: rays (Embree interpolates instances in this way) and
// lights read the very same keys, so that they agree to rounding.
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
  // Throws an Error at `where` that names `what` ("a shape") when there is no motion between the two: one of them
  // mirrors and the other does not, or one has a perspective part.
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

// Animated transforms one within the other, the outermost first: instances of instances of moving shapes.
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
  std::vector<AnimatedTransform> parts_;  // neighbours that stay are multiplied into one
};

// Where in the shutter, which is open during [0,1], the motion begins and ends. It may lie partly or wholly outside.
struct MotionTimes {
  double begin = 0, end = 1;

  // How far the motion has come: 0 before its beginning, 1 after its end.
  double FractionAt(double time) const;
  bool MovesInShutter() const { return begin < 1 && end > 0; }
};

// The placement of something that moves, over the shutter.
class Motion {
 public:
  // At least 2 keys, evenly spaced over [begin, end] within [0,1].
  Motion(float begin, float end, std::vector<Affine> keys);

  // The placement at a shutter time; the first and the last key outside of [begin, end].
  Affine At(float time) const;

  float Begin() const { return begin_; }
  float End() const { return end_; }
  const std::vector<Affine>& Keys() const { return keys_; }

 private:
  float begin_, end_;
  std::vector<Affine> keys_;
};

// Embree's limit.
inline constexpr int kMaxMotionKeys = 129;

// Keys for a chain; null when it does not move while the shutter is open, and chain.At(times.FractionAt(0)) is its
// place. Points of `moved` (local space; a box of ±1 when empty) deviate from the chain's motion by less than 2e-5 of
// the box's size, or by what the most keys allow (4 · 10^-5 … 8 · 10^-5 for rotations of 130° to 180°). Throws an Error
// at `where` for a motion that leaves the range of floats or becomes singular on its way.
std::shared_ptr<const Motion> MakeMotion(const MotionChain& chain, const MotionTimes& times, const Bounds3& moved,
                                         const char* what, const FileLocation& where);

}  // namespace lampyr
