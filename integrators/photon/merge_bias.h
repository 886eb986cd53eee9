// The bias of merging photons within a radius r, estimated from the photons that are merged.
//
// A constant kernel on a disk of radius r blurs the irradiance E: the expectation of the estimate I_r is its mean over
// the disk, E + r² ΔE / 8 + O(r⁴) ([Hachisuka10], for kernels of any second moment; that of a disk is r² / 4 along each
// axis). The same photons gathered within r / √2 have half of that bias, so that 2 (I_r - I_{r/√2}) has the expectation
// of the bias of I_r where E is smooth. A photon within r / √2 has twice the weight in the smaller kernel. So each
// photon adds its contribution to I_r times 2 (1 - 2), or times 2 (1 - 0) if it is farther away.
//
// With weights of multiple importance sampling, which depend on r, both sums have the weights of r: it is the blur of
// what is merged that is looked for.
#pragma once

namespace lampyr {

// Factor on the contribution of a photon found at that squared distance, by a kernel on a disk.
inline float BiasFactor(float distanceSquared, float radius) {
  return distanceSquared < 0.5f * radius * radius ? -2.0f : 2.0f;
}
// The same of a kernel on a line, of half the width `radius`: within r / √2 the smaller kernel is √2 times as high.
inline float BiasFactorOnLine(double distanceSquared, float radius) {
  constexpr float kNear = 2 * (1 - 1.41421356f);
  const auto r = static_cast<double>(radius);
  return distanceSquared < 0.5 * r * r ? kNear : 2.0f;
}

}  // namespace lampyr
