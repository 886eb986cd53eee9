// Vertices of subpaths, from the camera or from a light.
#pragma once

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
  // What arrives: flux on light subpaths, in LightingServices::FluxUnit, importance on the camera's. In two parts at
  // the first vertex of a light subpath, because a light may show diffuse and specular lobes different radiance.
  Color diffuse, specular;
  Receiver receiver;
  // Probability that a ray meets the surface here: less than 1 on cut-outs. It is in the density of whoever came here,
  // once.
  float coverage = 1;
  bool isDelta = false;          // only deltas: nothing can be connected to it
  bool storesPhotons = true;     // of its material, whatever was drawn of a mix: who gathers draws anew
  bool isSeenByCamera = true;    // camera rays meet it
  bool isSeenByIndirect = true;  // rays of light subpaths meet it
  // Of the event that led on from here; only on subpaths that go on.
  bool scatteredDelta = false;
  double eventForward = 0, eventReverse = 0;  // 1/sr (DensitiesOf)

  // Photons can be merged here.
  bool CanMerge() const { return !isDelta && isSeenByIndirect; }
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

}  // namespace lampyr
