// What the light tree knows of an emitter or of a cluster of them, and the importance of either at a receiver
// ([Conty18 §4]).
//
// Positions are relative to the tree's own centre and size, intensities to the sum of all: numbers of any scene are
// near 1, and a scene that is scaled gives the same ones.
#pragma once

#include "lights/light.h"
#include "lights/selection/light_selector.h"

namespace lampyr {

// A box of emitting points, a cone of directions in which they emit most, and how far beyond it they still do.
struct ClusterBounds {
  Bounds3 box;
  Vector3 axis{0, 0, 1};
  float cosThetaO = 1;  // main directions (normals of surfaces, all of a spot's cone) lie within this angle of the axis
  float cosThetaE = 1;  // light falls with the cosine of the angle to them, and ends at this one, at most 90°
  float intensity = 0;  // W/sr in the main directions, sum over the cluster; of an emitter 0: it emits nothing
  bool twoSided = false;  // as much towards -axis

  bool IsEmpty() const { return box.IsEmpty(); }
  // Becomes the bounds of both.
  void Add(const ClusterBounds& other);
};

// Of an emitter, from what the light says of it. A light that is a point with a cone shines alike in all of the cone;
// a surface as the cosine.
ClusterBounds BoundsOfEmitter(const EmissionBounds& bounds, LightKind kind);

// A receiver as importance needs it, in the tree's coordinates.
struct TreeReceiver {
  Point3 position{0.0f};
  Normal3 normal{0.0f};  // 0 in a volume
  bool isTransmissive = false;
};

// An estimate of the irradiance at the receiver, never 0 where the cluster can contribute: distance to the middle, but
// no less than half of the box's diagonal; angles less those under which the box is seen. For one cluster, written to
// be read: the tree evaluates eight at once (light_tree.cpp), and a test holds the two equal.
float Importance(const ClusterBounds& cluster, const TreeReceiver& receiver);

}  // namespace lampyr
