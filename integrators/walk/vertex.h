// Path vertices: points where light scatters, whatever the scatterer is.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "integrators/guide/path_guide.h"
#include "integrators/walk/flight.h"
#include "integrators/walk/partial_weight.h"
#include "integrators/walk/render_scene.h"
#include "materials/bsdf.h"

namespace lampyr {

// A point where light scatters, as seen by the path that arrived there: on a surface, or in a participating medium.
// Directions are unit vectors that point away from it.
struct Vertex {
  SurfacePoint point;      // in a medium: the position alone; normals are 0
  Vector3 residual{0.0f};  // Position() less that of `point`; set in scenes with media
  Bsdf bsdf;
  Vector3 toPrevious{0.0f};
  Receiver receiver;
  // Probability that a ray meets the surface here: less than 1 on cut-outs. The density of the path that arrived here
  // has it as a factor once.
  float coverage = 1;
  // Participating media on the sides of the surface, the outside being that of Ng; in a medium both are that one.
  int32_t insideMedium = kVacuum, outsideMedium = kVacuum;
  Color extinction{1.0f};              // σ_t in a medium, 1/scene unit; 1 on a surface
  bool isDelta = false;                // only delta lobes: cannot be connected
  bool storesPhotons = true;           // by material, not by the component drawn from a mix: gathering paths draw anew
  bool isSeenByCamera = true;          // camera rays meet it
  bool isSeenByIndirect = true;        // rays of light subpaths meet it
  const GuideRegion* guide = nullptr;  // SetGuide; null: walks scatter as the BSDF does

  // Beyond float: mean free paths may be shorter than its rounding. Where the path met the surface, or collided.
  Point3d Position() const { return Point3d(point.position) + Vector3d(residual); }

  // Scattering between the previous vertex and `direction`.
  BsdfEvaluation Evaluate(const Vector3& direction, TransportMode mode) const {
    BsdfEvaluation f = bsdf.Evaluate(toPrevious, direction, mode);
    if (guide && !f.Sum().IsBlack()) [[unlikely]]
      Guide(direction, mode, ReverseGuide(mode), f);
    return f;
  }
  // The same for a walk that arrives from `from`. The densities are those of walks: guided, where there is a guide.
  BsdfEvaluation EvaluateBetween(const Vector3& from, const Vector3& to, TransportMode mode) const {
    BsdfEvaluation f = bsdf.Evaluate(from, to, mode);
    if (guide && !f.Sum().IsBlack()) [[unlikely]]
      Guide(to, mode, ReverseGuide(from, mode), f);
    return f;
  }
  BsdfSample Sample(float uLobe, const Point2& u, TransportMode mode, Guidance& guidance) const {
    if (guide) [[unlikely]]
      return SampleGuided(uLobe, u, mode, guidance);
    guidance = {};
    return bsdf.Sample(toPrevious, uLobe, u, mode);
  }
  // |cosθ| to the shading normal, as in the scattering integral; of a fibre, to the plane across it.
  float ScatteringCosine(const Vector3& direction) const { return bsdf.ScatteringCosine(direction); }
  // Geometry term of an edge along `direction`: |cosθ| to the geometric normal; of a fibre, as above.
  float GeometryTerm(const Vector3& direction) const { return bsdf.GeometricCosine(direction); }
  // `region`: the guide of this place, or null. To be called when `toPrevious` is set.
  void SetGuide(const GuideRegion* region) {
    guide = region;
    reverseGuide_.fill(kUnknown);
  }
  // In a medium, not on a surface. Scattering and geometry have no cosines there.
  bool IsInMedium() const { return bsdf.IsMedium(); }
  // The medium in which a ray along `direction` starts.
  int32_t MediumTowards(const Vector3& direction) const {
    return glm::dot(direction, point.Ng) > 0 ? outsideMedium : insideMedium;
  }
  EdgeEnd EndTowards(const Vector3& direction) const {
    return {Position(), MediumTowards(direction), extinction,
            IsInMedium() && EdgeEnd::IsFineIn(extinction, point.position)};
  }
  // From here to `other`; beyond float if either is in a medium.
  Vector3d WayTo(const Vertex& other) const {
    if (IsInMedium() || other.IsInMedium()) return other.Position() - Position();
    return Vector3d(other.point.position - point.position);
  }
  // False on hair and in media (Bsdf::GathersPhotons).
  bool GathersPhotons() const { return bsdf.GathersPhotons(); }

  // With shading normals importance scatters differently from radiance ([Veach97 §5.3]). Radiance that arrives from wl,
  // towards the light, is scattered by f · |wl·Ns|, whatever the direction wc towards the camera. From the light's side
  // the same transport is: flux arrives in proportion to |wl·Ng| and leaves in proportion to |wc·Ng|, so it is
  // scattered by f · |wl·Ns| |wc·Ng| / |wl·Ng|.
  //
  // |wl·Ns| / |wl·Ng|: correction of light that arrives from `toLight`.
  float ArrivalCorrection(const Vector3& toLight) const {
    if (bsdf.ShadingFrame().z == bsdf.Ng()) return 1;
    return ScatteringCosine(toLight) / std::max(GeometryTerm(toLight), kSmallestGeometricCosine);
  }
  // ArrivalCorrection of a photon that arrived at a surface with the normal `Ng`. On a mesh that may be another facet
  // than the vertex's: photons are as dense as |wl·Ng| there, so that dividing by that is safe at any angle, and by the
  // vertex's own is not.
  float ArrivalCorrection(const Vector3& toLight, const Normal3& Ng) const {
    if (bsdf.ShadingFrame().z == bsdf.Ng()) return 1;
    return ScatteringCosine(toLight) / std::max(AbsDot(toLight, Ng), kSmallestGeometricCosine);
  }
  // |w·Ng| / |w·Ns|: correction of a sampled direction, whose sample weight is f · |w·Ns| / pdf.
  float DepartureCorrection(const Vector3& direction) const {
    if (bsdf.ShadingFrame().z == bsdf.Ng()) return 1;
    return GeometryTerm(direction) / std::max(ScatteringCosine(direction), kSmallestGeometricCosine);
  }

 private:
  static constexpr PdfSolidAngle kUnknown{-1};

  // Mixes the guides into the densities of `f`. `reverse`: density of the way back by the guide of the other walk.
  void Guide(const Vector3& to, TransportMode mode, PdfSolidAngle reverse, BsdfEvaluation& f) const;
  PdfSolidAngle ReverseGuide(const Vector3& from, TransportMode mode) const;
  // Density of `toPrevious` by the guide; the same for all directions that are evaluated here.
  PdfSolidAngle ReverseGuide(TransportMode mode) const {
    PdfSolidAngle& known = reverseGuide_[static_cast<size_t>(mode)];
    if (known.value < 0) known = ReverseGuide(toPrevious, mode);
    return known;
  }
  BsdfSample SampleGuided(float uLobe, const Point2& u, TransportMode mode, Guidance& guidance) const;

  // Lower bound of the cosines divided by. Grazing cosines have lost their precision to rounding, and the weight
  // 1/cosine of a light path that arrives at one is unbounded. The bound costs the light from within this cosine of the
  // geometric horizon, less than 1e-5 of what a surface receives.
  static constexpr float kSmallestGeometricCosine = 1e-5f;

  mutable std::array<PdfSolidAngle, 2> reverseGuide_{kUnknown, kUnknown};  // by mode
};

// True if a squared length is precise in float: squares of lengths below 1e-19 underflow.
inline bool IsPreciseSquare(float squared) {
  return squared > 1e-30f && squared < 1e30f;
}

// A squared length, of a difference of positions, whatever its size.
inline double SquaredLength(const Vector3& difference) {
  const float squared = LengthSquared(difference);
  if (IsPreciseSquare(squared)) [[likely]]
    return static_cast<double>(squared);
  const Vector3d fine(difference);
  return glm::dot(fine, fine);
}

// A difference of positions as a unit direction and the squared distance; 0: the positions are the same, and there is
// no direction.
struct Way {
  Vector3 direction{0.0f};
  double squared = 0;

  explicit Way(const Vector3& difference) {
    const float rounded = LengthSquared(difference);
    if (IsPreciseSquare(rounded)) [[likely]] {
      squared = static_cast<double>(rounded);
      direction = difference / std::sqrt(rounded);
      return;
    }
    squared = SquaredLength(difference);
    if (squared > 0) direction = Vector3(Vector3d(difference) * (1 / std::sqrt(squared)));
  }
};

// dω/dA of an edge, which turns a density over solid angle at one end into one over area at the other: |cosθ| there
// (`geometryTerm`) over the squared distance. Small cosines have lost their precision to rounding, so they have a lower
// bound, the same for every technique.
inline SolidAnglePerArea EdgeDensity(float geometryTerm, double distanceSquared) {
  constexpr double kSmallestCosine = 1e-6;
  return {std::max(static_cast<double>(geometryTerm), kSmallestCosine) / distanceSquared};
}
inline SolidAnglePerArea EdgeDensity(const Vertex& to, const Vector3& direction, double distanceSquared) {
  return EdgeDensity(to.GeometryTerm(direction), distanceSquared);
}
// The same, through participating media: times the factor of a walk that reaches that end (EdgeFactors).
inline SolidAnglePerArea operator*(double factor, SolidAnglePerArea edge) {
  return {factor * edge.value};
}

// A vertex of a camera or light subpath, with the throughput that arrives there. Constructed in place in an array
// (Subpath).
struct PathVertex : Vertex {
  // Arriving throughput: flux on light subpaths, in LightingServices::FluxUnit; importance on camera subpaths. In two
  // parts, because a light may send different radiance to diffuse and to specular lobes. On light subpaths: by the kind
  // of lobe at this vertex; the parts differ at the first vertex only. On camera subpaths: by the kind of lobe that
  // scattered at the previous vertex; the throughput is their sum.
  Color diffuse, specular;
  bool isDispersed = false;  // of the path that arrives (PathState::isDispersed)
  // The scattering event at this vertex; set only if the subpath continues.
  bool scatteredDelta = false;
  SolidAngleDensity eventForward, eventReverse;  // DensitiesOf
  EdgeFactors factors;  // of the edge from the previous vertex, or from the light's point or the lens
  // Bidirectional paths only:
  SolidAnglePerArea previousSolidAnglePerArea;  // dω/dA from this vertex to the previous one, or to the light's point
  AreaDensity pdfForward;                       // density of this vertex by its own subpath
  PartialWeight weight;

  Color Throughput() const { return diffuse + specular; }
  // True if photons can be merged here.
  bool CanMerge() const { return !isDelta && isSeenByIndirect && (GathersPhotons() || IsInMedium()); }
  // Reverse density of the previous vertex, for an event here whose density towards it is `pdfReverse`.
  AreaDensity PreviousReverse(SolidAngleDensity pdfReverse) const { return pdfReverse * previousSolidAnglePerArea; }
  AreaDensity PreviousReverse(PdfSolidAngle pdfReverse) const { return PreviousReverse(SolidAngleDensity(pdfReverse)); }
};

}  // namespace lampyr
