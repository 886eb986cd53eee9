// Vertices of paths: points where light scatters, whatever it is that scatters there.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "integrators/walk/partial_weight.h"
#include "integrators/walk/render_scene.h"
#include "materials/bsdf.h"

namespace lampyr {

// A point on a surface, as the path that came there sees it. Directions are unit vectors that point away from it.
struct Vertex {
  SurfacePoint point;
  Bsdf bsdf;
  Vector3 toPrevious{0.0f};
  Receiver receiver;
  // Probability that a ray meets the surface here: less than 1 on cut-outs. It is in the density of whoever came here,
  // once.
  float coverage = 1;
  bool isDelta = false;          // only deltas: nothing can be connected to it
  bool storesPhotons = true;     // of its material, whatever was drawn of a mix: who gathers draws anew
  bool isSeenByCamera = true;    // camera rays meet it
  bool isSeenByIndirect = true;  // rays of light subpaths meet it

  // Light that scatters between the previous vertex and `direction`.
  BsdfEvaluation Evaluate(const Vector3& direction, TransportMode mode) const {
    return bsdf.Evaluate(toPrevious, direction, mode);
  }
  std::optional<BsdfSample> Sample(float uLobe, const Point2& u, TransportMode mode) const {
    return bsdf.Sample(toPrevious, uLobe, u, mode);
  }
  // |cosθ| of the scattering integral, to the shading normal.
  float ScatteringCosine(const Vector3& direction) const { return AbsDot(direction, bsdf.ShadingFrame().z); }
  // What a beam along `direction` is multiplied by where it is spread over this point: |cosθ| to the geometric normal.
  float GeometryTerm(const Vector3& direction) const { return AbsDot(direction, bsdf.Ng()); }

  // Shading normals make the scattering of importance another one than that of radiance ([Veach97 §5.3]). Radiance at a
  // surface is f · |wl·Ns| times what arrives from wl, wl towards the light, wherever the camera looks from. The same
  // number, read from the light's side: flux arrives in proportion to |wl·Ng| and leaves towards wc in proportion to
  // |wc·Ng|, so what arrives is scattered by f · |wl·Ns| |wc·Ng| / |wl·Ng|.
  //
  // |wl·Ns| / |wl·Ng|: the weight of light that arrives from `toLight`.
  float ArrivalCorrection(const Vector3& toLight) const {
    if (bsdf.ShadingFrame().z == bsdf.Ng()) return 1;
    return ScatteringCosine(toLight) / std::max(GeometryTerm(toLight), kSmallestGeometricCosine);
  }
  // |w·Ng| / |w·Ns|: the same for a direction that was sampled with the weight f · |w·Ns| / pdf.
  float DepartureCorrection(const Vector3& direction) const {
    if (bsdf.ShadingFrame().z == bsdf.Ng()) return 1;
    return GeometryTerm(direction) / std::max(ScatteringCosine(direction), kSmallestGeometricCosine);
  }

 private:
  // A grazing cosine is known to rounding only, and a light path that arrives at one weighs 1/cosine: both end here.
  // What is lost is the light from within this of the geometric horizon, less than 1e-5 of what a surface receives.
  static constexpr float kSmallestGeometricCosine = 1e-5f;
};

// The density over the edge that arrives at a point: from solid angle at one end to area at the other, |cosθ| there
// (`geometryTerm`) over the squared distance. A cosine is known to rounding only: the smallest that counts is the same
// for every technique.
inline SolidAnglePerArea EdgeDensity(float geometryTerm, double distanceSquared) {
  constexpr double kSmallestCosine = 1e-6;
  return {std::max(static_cast<double>(geometryTerm), kSmallestCosine) / distanceSquared};
}
inline SolidAnglePerArea EdgeDensity(const Vertex& to, const Vector3& direction, double distanceSquared) {
  return EdgeDensity(to.GeometryTerm(direction), distanceSquared);
}

// A vertex of a subpath from the camera or from a light, with what the path carries there. It is made at its place in
// an array and stays there.
struct PathVertex : Vertex {
  // What arrives: flux on light subpaths, in LightingServices::FluxUnit, importance on the camera's. In two parts,
  // because a light may show diffuse and specular lobes different radiance: at the first vertex of a light subpath for
  // the lobes of that vertex, on camera subpaths by the kind of lobe that the path took at the vertex before.
  Color diffuse, specular;
  // Of the event that led on from here; only on subpaths that go on.
  bool scatteredDelta = false;
  SolidAngleDensity eventForward, eventReverse;  // DensitiesOf
  // Of bidirectional paths:
  SolidAnglePerArea previousSolidAnglePerArea;  // from this vertex to the previous one, or to the light's point
  AreaDensity pdfForward;                       // by its own subpath
  PartialWeight weight;

  Color Throughput() const { return diffuse + specular; }
  // Photons can be merged here.
  bool CanMerge() const { return !isDelta && isSeenByIndirect; }
  // Reverse density of the previous vertex, for an event here whose density towards it is `pdfReverse`.
  AreaDensity PreviousReverse(SolidAngleDensity pdfReverse) const { return pdfReverse * previousSolidAnglePerArea; }
  AreaDensity PreviousReverse(PdfSolidAngle pdfReverse) const { return PreviousReverse(SolidAngleDensity(pdfReverse)); }
};

}  // namespace lampyr
