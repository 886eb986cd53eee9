// How much a cluster of emitters is estimated to send to a receiver: what the light tree chooses by.
//
// The estimate is an expectation, not a bound: of patches around a mean place, with a mean normal, the cosines at both
// ends are taken as means of max(0, c) over a spread that the variances tell. It never vanishes because of an average
// (a part f of the patches that faces the receiver while the others look away counts f/4 at least), so that bounds are
// needed only for telling what is surely dark.
#pragma once

#include <bit>
#include <cstdint>

#include "lights/selection/light_bounds.h"

namespace lampyr {

class LightLearning;

// A receiver as importance needs it, in the tree's coordinates.
struct TreeReceiver {
  Point3 position{0.0f};
  Normal3 normal{0.0f};  // 0 in a volume
  bool isTransmissive = false;
  const LightLearning* learning = nullptr;  // what is known of its region, where something is to be learned
  uint32_t region = 0;
};

// What importance needs of a cluster, digested. A node of the tree keeps the same numbers for each of its children.
struct ClusterLobe {
  Point3 mean{0.0f};
  float variance = 0;
  Vector3 meanNormal{0.0f};
  float intensity = 0;
  float radius = 0;       // of a sphere about the mean that all of the cluster is in
  float coneCosine = -1;  // all light leaves within this angle of the mean normal, times its length; -1: to all sides
  float coneReach = 0;    // how much nearer to the cone a place may be for the sphere, times that length
  bool twoSided = false;
};
ClusterLobe LobeOf(const ClusterBounds& bounds);

// An estimate of the irradiance at the receiver, 0 only where nothing of the cluster contributes. For one cluster,
// written to be read.
float Importance(const ClusterLobe& lobe, const TreeReceiver& receiver);

namespace importance {

constexpr float kNearest2 = 1e-20f;  // squared distances are no less
// How much of the variance a squared distance is at least: the mean of 1/d² at the middle of a ball is 1.8/variance.
constexpr float kInside = 0.55f;
constexpr float kSlack = 1e-4f;  // of cosines, for rounding
constexpr float kLeast = 1e-4f;  // grazing light is little, and not nothing
// The mean of max(0, c) over normals of all directions is 1/4 = √s²/2: what s² is then.
constexpr float kSpread = 0.25f;

}  // namespace importance

// Eight lobes, number by number: what is evaluated at once (importance_lanes.h). A choice among many reads a dozen of
// these, so what is only a bound, or a direction, is kept in 16 bits, rounded so that nothing more is ruled out.
struct alignas(64) LobeBlock {
  static constexpr int kWidth = 8;

  float intensity[kWidth];  // 0: nothing there
  float meanX[kWidth], meanY[kWidth], meanZ[kWidth], variance[kWidth];
  int16_t normalX[kWidth], normalY[kWidth], normalZ[kWidth];  // in 1/kUnit
  int16_t coneCosine[kWidth];                                 // in 1/kUnit, or a little less
  uint16_t radius[kWidth], coneReach[kWidth];                 // the upper half of a float, or a little more
  uint16_t oneSided[kWidth];                                  // 1, or 0

  static constexpr float kUnit = 32767;

  void Set(int slot, const ClusterLobe& lobe);
  ClusterLobe Get(int slot) const;
};

// A float that is not negative in its upper 16 bits (bfloat16), rounded up; and as a float again.
uint16_t RoundUpToBfloat16(float value);
inline float FromBfloat16(uint16_t bits) {
  return std::bit_cast<float>(static_cast<uint32_t>(bits) << 16);
}

}  // namespace lampyr
