// ImportanceAlong() of eight lobes at a time, without branches. A test checks that both agree.
//
// As importance_lanes.h: a caller that needs the same bits again must go through one function that is not inlined.
#pragma once

#include "lights/selection/importance_lanes.h"
#include "lights/selection/segment_importance.h"

namespace lampyr {

struct LaneSegmentImportances {
  Lanes importance;
  Lanes spread;      // as SegmentImportance
  Lanes unevenness;  // variance of normals, up to rounding
};

namespace importance {

// Angle of the vector (x, y) with the x axis, for y >= 0, to 2e-5 ([Abramowitz64 eq. 4.4.49]).
inline Lanes UpperAngles(const Lanes& x, const Lanes& y) {
  const Lanes across = simd::abs(x);
  const Lanes z = simd::min(across, y) / simd::max(simd::max(across, y), Lanes(1e-37f)), z2 = z * z;
  Lanes angle = z * (0.9998660f + z2 * (-0.3302995f + z2 * (0.1801410f + z2 * (-0.0851330f + z2 * 0.0208351f))));
  where(y > across, angle) = 0.5f * kPi - angle;
  where(x < 0.0f, angle) = kPi - angle;
  return angle;
}

}  // namespace importance

inline LaneSegmentImportances EvaluateAlong(const LobeBlock& block, const TreeSegment& segment) {
  using namespace importance;
  const Vector3 d(segment.direction);
  const Lanes x = segment.base.x - Load(block.meanX), y = segment.base.y - Load(block.meanY),
              z = segment.base.z - Load(block.meanZ);
  const Lanes foot = x * d.x + y * d.y + z * d.z;
  const Lanes acrossX = x - foot * d.x, acrossY = y - foot * d.y, acrossZ = z - foot * d.z;
  // The coordinates of both ends, relative to the feet of the means. Their squares fit in a float.
  constexpr double kFarthest = 1e15;
  const auto first = static_cast<float>(std::clamp(segment.start, -kFarthest, kFarthest));
  const auto last = static_cast<float>(std::clamp(segment.start + segment.length, -kFarthest, kFarthest));
  const auto length = static_cast<float>(std::min(segment.length, kFarthest));
  const Lanes start = foot + first, end = foot + last;
  const Lanes distance2 = acrossX * acrossX + acrossY * acrossY + acrossZ * acrossZ;
  const Lanes nearest = simd::min(simd::max(Lanes(0.0f), start), end);
  const Lanes least2 = distance2 + nearest * nearest;
  const Lanes variance = Load(block.variance), radius = LoadBfloat16(block.radius);
  const Lanes floor = simd::max(kInside * variance, Lanes(kNearest2));
  const Lanes spread = simd::min(variance / simd::max(least2, floor), Lanes(1.0f));

  // The largest cosine: (a + b x)/√(D² + x²) at one of both ends, or at its extremum x = b D²/a.
  const Lanes nx = LoadFraction(block.normalX), ny = LoadFraction(block.normalY), nz = LoadFraction(block.normalZ);
  const Lanes oneSided(block.oneSided, simd::element_aligned);
  const Lanes a = nx * acrossX + ny * acrossY + nz * acrossZ, b = nx * d.x + ny * d.y + nz * d.z;
  const auto cosineAt = [&](const Lanes& at) {
    const Lanes cosine = (a + b * at) / simd::sqrt(simd::max(distance2 + at * at, Lanes(kNearest2)));
    Lanes either = cosine;
    where(oneSided == 0.0f, either) = simd::abs(cosine);
    return either;
  };
  Lanes cosine = simd::max(cosineAt(start), cosineAt(end));
  const Lanes scaled = b * distance2, sided = simd::abs(a);
  const Lanes extremum = scaled / simd::max(sided, Lanes(1e-30f));  // of the side that a is on
  where(a > 0.0f && extremum > start && extremum < end, cosine) = cosineAt(extremum);
  where(a < 0.0f && oneSided == 0.0f && -extremum > start && -extremum < end, cosine) = cosineAt(-extremum);

  const Lanes least = simd::sqrt(least2);
  const auto isDark = least > radius && cosine * least < (LoadFraction(block.coneCosine) - 2 * kSlack) * least -
                                                             LoadBfloat16(block.coneReach);
  where(least2 < floor, cosine) = simd::max(cosine, Lanes(0.0f));
  const Lanes unevenness = 1.0f - (nx * nx + ny * ny + nz * nz);
  const Lanes root =
      simd::sqrt(cosine * cosine + kSpread * simd::min(simd::max(unevenness, Lanes(0.0f)) + spread, Lanes(1.0f)));
  const Lanes emitted = 0.5f * (root + oneSided * cosine);
  const Lanes distance = simd::sqrt(simd::max(simd::max(distance2, floor - nearest * nearest), Lanes(kNearest2)));
  const Lanes angle = UpperAngles(distance * distance + start * end, distance * length);
  Lanes importance = Load(block.intensity) * simd::max(emitted, Lanes(kLeast)) * angle / distance;
  where(isDark, importance) = 0.0f;
  return {importance, spread, unevenness};
}

}  // namespace lampyr
