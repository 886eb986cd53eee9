// Importance: an estimate of the irradiance that a cluster of emitters causes at a receiver. The light tree selects in
// proportion to it.
//
// The estimate is an expectation, not a bound. A cluster is described by the mean and the variance of its positions and
// normals; the cosines at emitter and receiver are replaced by the mean of max(0, cosθ) over that spread. Averaging
// never makes it 0: if a fraction f of the patches faces the receiver and the others face away, it is at least f/4 of
// the value for all. Bounds are needed only to recognise clusters that are certainly dark.
#pragma once

#include <bit>
#include <cstdint>

#include "lights/selection/light_bounds.h"

namespace lampyr {

class LightLearning;

// A receiver in the tree's coordinates.
struct TreeReceiver {
  Point3 position{0.0f};
  Normal3 normal{0.0f};  // 0: no cosine at the receiver (Receiver)
  bool isTransmissive = false;
  const LightLearning* learning = nullptr;  // learned factors of its region; may be null
  uint32_t region = 0;
};

// A cluster, precomputed for the evaluation of importance. A node of the tree holds these numbers for each child.
struct ClusterLobe {
  Point3 mean{0.0f};
  float variance = 0;
  Vector3 meanNormal{0.0f};
  float intensity = 0;
  float radius = 0;  // of a sphere around the mean that contains the cluster
  // Light leaves within a cone around the mean normal: cosine of its angle times the length of the mean normal; -1: in
  // all directions. `coneReach`: margin for the radius of the sphere, times the same length.
  float coneCosine = -1;
  float coneReach = 0;
  bool twoSided = false;
};
ClusterLobe LobeOf(const ClusterBounds& bounds);

// Estimated irradiance at the receiver; 0 only if no part of the cluster contributes. The readable version, for one
// cluster; importance_lanes.h evaluates eight at a time.
float Importance(const ClusterLobe& lobe, const TreeReceiver& receiver);

namespace importance {

constexpr float kNearest2 = 1e-20f;  // lower bound of squared distances
// Lower bound of the squared distance in units of the variance: the mean of 1/d² at the centre of a ball
// is 1.8/variance.
constexpr float kInside = 0.55f;
constexpr float kSlack = 1e-4f;  // tolerance of cosines, for rounding
constexpr float kLeast = 1e-4f;  // lower bound of cosines: grazing light is weak but not 0
// s² of a cluster with normals in all directions: the mean of max(0, cosθ) is then 1/4 = √s²/2.
constexpr float kSpread = 0.25f;

}  // namespace importance

// Eight lobes as a structure of arrays, evaluated together (importance_lanes.h). A selection reads about a dozen of
// these, so bounds and directions take 16 bits, rounded conservatively: no lobe becomes dark by rounding.
struct alignas(64) LobeBlock {
  static constexpr int kWidth = 8;

  float intensity[kWidth];  // 0: the slot is empty
  float meanX[kWidth], meanY[kWidth], meanZ[kWidth], variance[kWidth];
  int16_t normalX[kWidth], normalY[kWidth], normalZ[kWidth];  // in 1/kUnit
  int16_t coneCosine[kWidth];                                 // in 1/kUnit, rounded down
  uint16_t radius[kWidth], coneReach[kWidth];                 // bfloat16, rounded up
  uint16_t oneSided[kWidth];                                  // 1, or 0

  static constexpr float kUnit = 32767;

  void Set(int slot, const ClusterLobe& lobe);
  ClusterLobe Get(int slot) const;
};

// Conversion of a non-negative float to bfloat16, rounded up, and back.
uint16_t RoundUpToBfloat16(float value);
inline float FromBfloat16(uint16_t bits) {
  return std::bit_cast<float>(static_cast<uint32_t>(bits) << 16);
}

}  // namespace lampyr
