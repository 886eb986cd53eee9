// What the light tree knows of an emitter or of a cluster of them: where it is and which directions it emits in, as
// bounds that the tree is built by ([Conty18 §4]) and as moments that its importance is estimated from (importance.h).
//
// Positions are relative to the tree's own centre and size, intensities to the sum of all: numbers of any scene are
// near 1, and a scene that is scaled gives the same ones.
#pragma once

#include "lights/light.h"
#include "lights/selection/light_selector.h"

namespace lampyr {

// A box of emitting points, a cone of directions in which they emit most, and how far beyond it they still do.
//
// Everything is counted in patches that emit as the cosine of the angle to their normal: a patch of `intensity` sends
// intensity · cosθ. A point that shines alike everywhere is four times as many patches as its W/sr, of all normals.
struct ClusterBounds {
  Bounds3 box;
  Vector3 axis{0, 0, 1};
  float cosThetaO = 1;  // main directions (normals of surfaces, all of a spot's cone) lie within this angle of the axis
  float cosThetaE = 1;  // light falls with the cosine of the angle to them, and ends at this one, at most 90°
  float intensity = 0;  // W/sr, sum over the cluster and both sides; of an emitter 0: it emits nothing
  bool twoSided = false;  // as much towards -axis

  Point3 mean{0.0f};         // position, weighted by intensity
  float variance = 0;        // of the position: the mean squared distance from `mean`
  Vector3 meanNormal{0.0f};  // length 1: all parallel; 0: in all directions. Of one side, where both shine

  bool IsEmpty() const { return box.IsEmpty(); }
  // Takes the box for filled evenly: mean and variance.
  void FillBox();
  // Becomes the bounds of both.
  void Add(const ClusterBounds& other);
};

// Of an emitter, from what the light says of it. A light that is a point with a cone shines alike in all of the cone;
// a surface as the cosine.
ClusterBounds BoundsOfEmitter(const EmissionBounds& bounds, LightKind kind);

}  // namespace lampyr
