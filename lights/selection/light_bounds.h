// Bounds of an emitter or a cluster of emitters in the light tree: positions and directions of emission, as bounds for
// building the tree ([Conty18 §4]) and as moments for estimating importance (importance.h).
//
// Positions are relative to the tree's centre and size, intensities to the sum of all, so that the tree does not depend
// on the scale of the scene.
#pragma once

#include "lights/light.h"
#include "lights/selection/light_selector.h"

namespace lampyr {

// A box of emitting points, a cone of main directions, and the angle by which emission extends beyond it.
//
// The unit is a Lambertian patch: one of `intensity` I emits I · cosθ (W/sr). An isotropic point of I W/sr is
// represented by patches of all normals with a total intensity of 4 I.
struct ClusterBounds {
  Bounds3 box;
  Vector3 axis{0, 0, 1};
  float cosThetaO = 1;    // main directions (surface normals, or the cone of a spot) are within this angle of the axis
  float cosThetaE = 1;    // emission extends to this angle from the main directions, at most 90°
  float intensity = 0;    // W/sr, sum over the cluster and both sides
  bool twoSided = false;  // emits the same towards -axis

  Point3 mean{0.0f};         // position, weighted by intensity
  float variance = 0;        // mean squared distance of positions from `mean`
  Vector3 meanNormal{0.0f};  // length 1: all parallel; 0: in all directions. Of one side if two-sided

  bool IsEmpty() const { return box.IsEmpty(); }
  // Sets mean and variance to those of an evenly filled box.
  void FillBox();
  // Merges `other` into these bounds.
  void Add(const ClusterBounds& other);
};

// Bounds of an emitter. A point light with a cone emits evenly within the cone, a surface with the cosine.
ClusterBounds BoundsOfEmitter(const EmissionBounds& bounds, LightKind kind);

}  // namespace lampyr
