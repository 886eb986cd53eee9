// Importance() of eight lobes at a time, without branches. A test checks that both agree.
//
// The compiler may round differently in each function that this is inlined into. A caller that needs the same bits
// again must go through one function that is not inlined.
#pragma once

#include <experimental/simd>

#include "lights/selection/importance.h"

namespace lampyr {

namespace simd = std::experimental;

using Lanes = simd::simd<float, simd::simd_abi::deduce_t<float, LobeBlock::kWidth>>;

inline Lanes Load(const float* values) {
  return Lanes(values, simd::vector_aligned);
}

namespace importance {

using LaneBits = simd::rebind_simd_t<uint32_t, Lanes>;

inline Lanes LoadBfloat16(const uint16_t* values) {
  return std::bit_cast<Lanes>(LaneBits(values, simd::element_aligned) << 16);
}
inline Lanes LoadFraction(const int16_t* values) {
  return Lanes(values, simd::element_aligned) * (1 / LobeBlock::kUnit);
}

}  // namespace importance

struct LaneImportances {
  Lanes importance;
  Lanes spread;      // variance of positions over squared distance, at most 1
  Lanes unevenness;  // variance of normals, up to rounding
};

inline LaneImportances Evaluate(const LobeBlock& block, const TreeReceiver& receiver) {
  using namespace importance;
  const Lanes x = receiver.position.x - Load(block.meanX), y = receiver.position.y - Load(block.meanY),
              z = receiver.position.z - Load(block.meanZ);
  const Lanes variance = Load(block.variance), radius = LoadBfloat16(block.radius);
  const Lanes distance2 = x * x + y * y + z * z;
  const Lanes squared = simd::max(simd::max(distance2, kInside * variance), Lanes(kNearest2));
  const Lanes inverse = 1.0f / simd::sqrt(squared);
  const Lanes inverse2 = inverse * inverse;
  const Lanes spread = simd::min(variance * inverse2, Lanes(1.0f));
  const auto isOutside = distance2 > radius * radius;

  const Lanes nx = LoadFraction(block.normalX), ny = LoadFraction(block.normalY), nz = LoadFraction(block.normalZ);
  const Lanes oneSided(block.oneSided, simd::element_aligned);
  Lanes along = nx * x + ny * y + nz * z;
  where(oneSided == 0.0f, along) = simd::abs(along);
  const Lanes distance = distance2 * inverse;
  const auto isDark =
      along < LoadFraction(block.coneCosine) * distance - LoadBfloat16(block.coneReach) - kSlack * distance;
  const Lanes unevenness = 1.0f - (nx * nx + ny * ny + nz * nz);
  const Lanes emittedCosine = along * inverse;
  const Lanes emittedRoot = simd::sqrt(emittedCosine * emittedCosine +
                                       kSpread * simd::min(simd::max(unevenness, Lanes(0.0f)) + spread, Lanes(1.0f)));
  const Lanes emitted = 0.5f * (emittedRoot + oneSided * emittedCosine);

  const Normal3 n = receiver.normal;
  Lanes importance = Load(block.intensity) * inverse2 * simd::max(emitted, Lanes(kLeast));
  where(isOutside && isDark, importance) = 0.0f;
  if (n.x != 0 || n.y != 0 || n.z != 0) {
    Lanes cosine = (n.x * x + n.y * y + n.z * z) * -inverse;
    if (receiver.isTransmissive) cosine = simd::abs(cosine);
    const auto isBehind = cosine + radius * inverse < -kSlack;
    const Lanes root = simd::sqrt(cosine * cosine + kSpread * spread);
    const Lanes received = receiver.isTransmissive ? root : 0.5f * (root + cosine);
    importance *= simd::max(received, Lanes(kLeast));
    where(isOutside && isBehind, importance) = 0.0f;
  }
  return {importance, spread, unevenness};
}

}  // namespace lampyr
