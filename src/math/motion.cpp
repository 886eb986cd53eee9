#include "math/motion.h"

#include <string>

#include <glm/gtc/matrix_transform.hpp>

namespace lampyr {

namespace {

double LargestElement(const glm::dmat3& m) {
  double largest = 0;
  for (int column = 0; column < 3; ++column) {
    for (int row = 0; row < 3; ++row) largest = std::max(largest, std::abs(m[column][row]));
  }
  return largest;
}

// The orthogonal factor of the polar decomposition by Newton's iteration ([Higham86]): the matrix is replaced by the
// mean of itself and its inverse transpose until it no longer changes.
glm::dmat3 NearestOrthogonal(const glm::dmat3& m) {
  constexpr int mostSteps = 100;
  constexpr double small = 1e-15;
  glm::dmat3 q = m * (1 / LargestElement(m));
  for (int i = 0; i < mostSteps; ++i) {
    const glm::dmat3 next = (q + glm::transpose(glm::inverse(q))) * 0.5;
    const double change = LargestElement(next - q);
    q = next;
    if (change < small) break;
  }
  return q;
}

// Spherical linear interpolation along the shorter arc.
glm::dquat Slerp(const glm::dquat& a, const glm::dquat& b, double x) {
  const double cosine = glm::dot(a, b);
  const glm::dquat nearer = cosine < 0 ? -b : b;
  const double angle = 2 * std::atan2(glm::length(nearer - a), glm::length(nearer + a));
  constexpr double small = 1e-8;
  if (angle < small) return glm::normalize(a * (1 - x) + nearer * x);
  return glm::normalize(a * std::sin((1 - x) * angle) + nearer * std::sin(x * angle));
}

Affine Mix(const Affine& a, const Affine& b, float x) {
  return {a.linear * (1 - x) + b.linear * x, a.translation * (1 - x) + b.translation * x};
}

double Determinant(const Affine& m) {
  const glm::dmat3 linear(m.linear);
  return glm::determinant(linear * (1 / LargestElement(linear)));
}

// Corner i of the box at which a motion is measured: ±1 if `box` is empty.
Point3d CornerOf(const Bounds3& box, int i) {
  return box.IsEmpty() ? Point3d(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1) : Point3d(box.Corner(i));
}

// Motion of the corners of a box over a part [first, last] of a chain's motion, sampled by the fraction of that part.
class CornerPaths {
 public:
  CornerPaths(const MotionChain& chain, double first, double last, const Bounds3& box)
      : chain_(chain), first_(first), last_(last), box_(box) {
    const Transform middle = Place(0.5);
    for (int i = 0; i < 8; ++i) {
      const Point3d p = middle.Point(CornerOf(box_, i));
      size_ = std::max(size_, glm::length(p - middle.Point(CornerOf(box_, 7 - i))));
    }
  }

  Transform Place(double x) const { return chain_.At(first_ + (last_ - first_) * x); }

  // True if `segments` linear pieces follow the motion, and each is short enough in units of the box: the rounding of
  // its ends then adds little to the rounding at the moment when the box passes the origin.
  bool Follow(int segments) const {
    constexpr double largestDeviation = 2e-5, longestInSizes = 8;
    for (int s = 0; s < segments; ++s) {
      const Transform from = Place(double(s) / segments), to = Place(double(s + 1) / segments);
      for (const double x : {0.25, 0.5, 0.75}) {
        const Transform between = Place((s + x) / segments);
        for (int i = 0; i < 8; ++i) {
          const Point3d corner = CornerOf(box_, i), a = from.Point(corner), b = to.Point(corner);
          if (glm::length(a * (1 - x) + b * x - between.Point(corner)) > largestDeviation * size_) return false;
          if (glm::length(b - a) > longestInSizes * size_) return false;
        }
      }
    }
    return true;
  }

 private:
  const MotionChain& chain_;
  double first_, last_;
  Bounds3 box_;
  double size_ = 0;
};

// Throws an Error unless all keys are within range and invertible, also between the keys unless the motion `jumps` from
// one to the next.
void CheckKeys(const std::vector<Affine>& keys, bool jumps, const char* what, const FileLocation& where) {
  constexpr float largest = 1e18f;
  const bool mirrors = Determinant(keys.front()) < 0;
  for (size_t i = 0; i < keys.size(); ++i) {
    const Affine& key = keys[i];
    for (const Vector3& v : {key.linear[0], key.linear[1], key.linear[2], key.translation}) {
      if (!(MaxAbsComponent(v) <= largest) || !IsFinite(v)) {
        throw Error(where, std::string("the motion of ") + what + " reaches farther than 1e18");
      }
    }
    for (const float x : {0.0f, 0.25f, 0.5f, 0.75f}) {
      const double determinant = Determinant(i + 1 < keys.size() && !jumps ? Mix(key, keys[i + 1], x) : key);
      if (determinant != 0 && (determinant < 0) == mirrors) continue;
      throw Error(where, std::string("the motion of ") + what + " becomes singular on its way: it cannot be inverted");
    }
  }
}

}  // namespace

AnimatedTransform::AnimatedTransform(const Transform& start, const Transform& end, const char* what,
                                     const FileLocation& where)
    : start_(start), end_(end), isAnimated_(!(start == end)) {
  if (!isAnimated_) return;
  if (!start.IsAffine() || !end.IsAffine())
    throw Error(where, std::string(what) + " that moves cannot have a perspective transform");
  if (start.SwapsHandedness() != end.SwapsHandedness()) {
    throw Error(where, std::string(what) +
                           " that moves goes from a placement that mirrors to one that does not, or back: it would be "
                           "flat on its way. Mirror at both times, after ActiveTransform All");
  }
  startParts_ = Decompose(start);
  endParts_ = Decompose(end);
}

AnimatedTransform::Parts AnimatedTransform::Decompose(const Transform& transform) {
  Parts parts;
  const glm::dmat3 linear(transform.Matrix());
  parts.translation = Vector3d(transform.Matrix()[3]);
  glm::dmat3 orthogonal = NearestOrthogonal(linear);
  if (glm::determinant(orthogonal) < 0) orthogonal = -orthogonal;  // a mirroring becomes part of the stretch
  parts.rotation = glm::normalize(glm::quat_cast(orthogonal));
  parts.stretch = glm::transpose(orthogonal) * linear;
  return parts;
}

Transform AnimatedTransform::At(double fraction) const {
  if (!isAnimated_ || fraction <= 0) return start_;
  if (fraction >= 1) return end_;
  const glm::dmat3 rotation = glm::mat3_cast(Slerp(startParts_.rotation, endParts_.rotation, fraction));
  glm::dmat4 m(rotation * (startParts_.stretch * (1 - fraction) + endParts_.stretch * fraction));
  m[3] = glm::dvec4(startParts_.translation * (1 - fraction) + endParts_.translation * fraction, 1);
  return Transform(m);
}

MotionChain MotionChain::operator*(const AnimatedTransform& inner) const {
  MotionChain product = *this;
  AnimatedTransform& last = product.parts_.back();
  if (!last.IsAnimated() && !inner.IsAnimated()) {
    last = AnimatedTransform(last.At(0) * inner.At(0));
  } else {
    product.parts_.push_back(inner);
  }
  return product;
}

MotionChain MotionChain::operator*(const MotionChain& inner) const {
  MotionChain product = *this;
  for (const AnimatedTransform& part : inner.parts_) product = product * part;
  return product;
}

bool MotionChain::IsAnimated() const {
  for (const AnimatedTransform& part : parts_) {
    if (part.IsAnimated()) return true;
  }
  return false;
}

Transform MotionChain::At(double fraction) const {
  Transform product = parts_.front().At(fraction);
  for (size_t i = 1; i < parts_.size(); ++i) product = product * parts_[i].At(fraction);
  return product;
}

double MotionTimes::FractionAt(double time) const {
  if (time >= end && (time > begin || begin == end)) return 1;
  if (time <= begin) return 0;
  return (time - begin) / (end - begin);
}

Motion::Motion(float begin, float end, std::vector<Affine> keys) : begin_(begin), end_(end), keys_(std::move(keys)) {}

Affine Motion::At(float time) const {
  if (time <= begin_) return keys_.front();
  if (time >= end_) return keys_.back();
  // Embree's operations in Embree's order, so that the results are bitwise equal.
  const auto segments = static_cast<float>(keys_.size() - 1);
  const float position = (time - begin_) / (end_ - begin_) * segments;
  const float segment = std::min(std::floor(position), segments - 1);
  const auto i = static_cast<size_t>(segment);
  return Mix(keys_[i], keys_[i + 1], position - segment);
}

std::shared_ptr<const Motion> MakeMotion(const MotionChain& chain, const MotionTimes& times, const Bounds3& moved,
                                         const char* what, const FileLocation& where) {
  if (!chain.IsAnimated() || !times.MovesInShutter()) return nullptr;
  const double begin = std::max(times.begin, 0.0), end = std::min(times.end, 1.0);
  // A motion of no duration is a jump from the placement before to the one after.
  const bool jumps = !(begin < end);
  const CornerPaths paths(chain, jumps ? 0 : times.FractionAt(begin), jumps ? 1 : times.FractionAt(end), moved);
  int segments = 1;
  while (!jumps && segments < kMaxMotionKeys - 1 && !paths.Follow(segments)) segments *= 2;
  std::vector<Affine> keys;
  for (int i = 0; i <= segments; ++i) {
    const Transform key = paths.Place(double(i) / segments);
    if (!key.IsAffine()) throw Error(where, std::string(what) + " cannot have a perspective transform");
    keys.push_back(key.ToAffine());
  }
  CheckKeys(keys, jumps, what, where);
  return std::make_shared<Motion>(static_cast<float>(begin), static_cast<float>(end), std::move(keys));
}

}  // namespace lampyr
