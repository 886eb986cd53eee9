// Vertices of subpaths, and what is known of a whole path at the moment it is weighed: for the integrator, for its
// proofs and for pictures of single techniques.
#pragma once

#include <span>

#include "integrators/common/camera_connection.h"
#include "integrators/common/partial_weight.h"
#include "lights/services/lighting_services.h"
#include "materials/bsdf.h"

namespace lampyr {

// A surface vertex of a subpath. It is made at its place in an array and stays there.
struct PathVertex {
  SurfacePoint point;
  Bsdf bsdf;
  Vector3 toPrevious{0.0f};  // unit
  double previousPerSolidAngle =
      0;                  // area at the previous vertex per solid angle at this one (solidAngleToArea, a light)
  double pdfForward = 0;  // 1/m², by its own subpath
  PartialWeight weight;
  // What arrives: flux on light subpaths, importance on the camera's. In two parts at the first vertex of a light
  // subpath, because a light may show diffuse and specular lobes different radiance.
  Color diffuse, specular;
  Receiver receiver;
  bool isDelta = false;          // only deltas: nothing can be connected to it
  bool isSeenByCamera = true;    // camera rays meet it
  bool isSeenByIndirect = true;  // rays of light subpaths meet it
  // Of the event that led on from here; only on subpaths that go on.
  bool scatteredDelta = false;
  double eventForward = 0, eventReverse = 0;  // 1/sr (DensitiesOf)
};

// The light's end of a path, as the first surface vertex sees it.
struct LightEnd {
  uint32_t light = 0;
  double emission = 0;       // of the light's point and the first surface vertex, by emission, with the selection
  double position = 0;       // of the light's point alone, by emission, with the selection; 0: not on a surface
  double direct = 0;         // of the light's point by next-event estimation, with the selection
  double perSolidAngle = 1;  // at the light's point per solid angle at the first surface vertex
  bool canBeHit = false;     // by directions that surfaces sample
};

// A path that contributes: `light` subpath (s - 1 surface vertices, from the light on), then `camera` subpath (t - 1
// surface vertices, from the camera on). With s = 0 the light's point follows the camera's last vertex.
struct ConnectedPath {
  int s = 0, t = 0;
  std::span<const PathVertex> light, camera;
  LightEnd end;
  Vector3 toLight{0.0f}, toLens{0.0f};  // unit; from the first surface vertex, and from the one that the camera sees
  double cameraPerArea = 0;             // density of the vertex that the camera sees, as a camera path finds it
  const FilmConnection* connection = nullptr;  // where it lands, for t = 1; null: in the sample's own pixel
  Color value;                                 // unweighted
  double weight = 1;
};

// Told of every path that a sample is made of.
class PathObserver {
 public:
  virtual ~PathObserver() = default;
  virtual void Observe(const ConnectedPath& path) = 0;
};

}  // namespace lampyr
