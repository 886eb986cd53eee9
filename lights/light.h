// The light interface, as used by integrators, light selection and authors of plugins.
//
// Three methods sample or evaluate the same function, the emitted radiance L(position, direction):
//   GenerateSamples      samples the light as seen from P           (next-event estimation)
//   EvaluateSamples      evaluates a direction that hit the light   (BSDF sampling, camera paths)
//   GenerateEmission     samples a photon                           (light subpaths)
// Their densities must agree with each other, because bidirectional weights are ratios of them. The pdf suite checks
// this for every registered light.
//
// Measures of the densities ([Veach97 §8.3.2], with the conventions of this project)
//
//   kind            pdfEmit                          pdfEmitDirection   pdfDirect at P   solidAngleToArea
//   Area            1/m², world-space surface        1/sr given position    1/sr         cosθ_light / d²
//   DeltaPosition   1 (discrete)                     1/sr                   1 (discrete)     1
//   DeltaDirection  1/m² on the scene's disk         1 (discrete)           1 (discrete)     1
//   Infinite        1/m² on the scene's disk         1/sr                   1/sr             1
//
// "The scene's disk": the disk of the scene's bounding sphere that touches the sphere and is perpendicular to the
// direction. RenderMan reports FLT_MAX and 1 for lights at infinity; here the densities are the true ones, which can be
// integrated and checked.
//
// - Densities do not include the probability of selecting the light: the caller multiplies.
// - A density of 0 means that the technique cannot generate the sample. Delta lights are identified by Kind(), not by a
//   value.
// - Each density is computed in one private function, which every method that reports it calls.
// - Everything but GetBounds and Intersect is in render space. Radiance in W/(m² sr) per channel, intensity of delta
//   lights in W/sr (divided by d² by the light), irradiance of delta directions in W/m².
// - A light is immutable and is used by many threads at once.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "geometry/ray.h"
#include "math/bounds.h"
#include "math/density.h"
#include "math/transform.h"
#include "math/vec.h"
#include "spectral/spectral_curve.h"

namespace lampyr {

class ParameterList;
struct LightBuildContext;

enum class LightKind {
  Area,            // has a surface that rays can hit
  DeltaPosition,   // a point: point, spot, goniometric, projection
  DeltaDirection,  // one direction: distant without an angle
  Infinite,        // a distribution of directions: dome, distant with an angle
};

constexpr bool IsDelta(LightKind kind) {
  return kind == LightKind::DeltaPosition || kind == LightKind::DeltaDirection;
}
constexpr bool IsAtInfinity(LightKind kind) {
  return kind == LightKind::Infinite || kind == LightKind::DeltaDirection;
}

// Placement of a light at one instant of the shutter.
struct LightTransform {
  Affine toRender;  // the light's local space to render space
  Affine toLocal;   // its inverse
};

inline constexpr int kAnyPatch = -1;

// Arguments of each call. Cheap to construct on the stack.
struct LightContext {
  const LightTransform* transform = nullptr;
  BoundingSphere scene;     // of everything that can be hit
  float time = 0;           // in [0,1]
  Point2 u{0.0f};           // position on the light (or direction, for lights without a surface), [0,1)²
  Point2 uDirection{0.0f};  // GenerateEmission: direction (or position on the scene's disk)
  // The patch to sample, if the caller has selected one; densities are then conditional on it. kAnyPatch: the light
  // samples a patch, and densities include its probability.
  int patch = kAnyPatch;
  // The receiver of GenerateSamples and EvaluateSamples: its unit shading normal, on the side from which light counts,
  // or 0 if light counts from all directions alike; and whether light from the other side counts, too. pdfDirect of
  // lights at infinity may depend on them, and so may GetIncidentRadianceEstimate at a point: an estimate of the
  // irradiance of that receiver then. Nothing else may.
  Normal3 receiverNormal{0.0f};
  bool receiverIsTransmissive = false;
  // True if pdfEmit, pdfEmitDirection and solidAngleToArea are wanted, too; otherwise they are 0.
  bool bidirectional = false;
};

// A sample of the light seen from P.
struct LightSample {
  Vector3 direction{0.0f};      // unit, from P towards the light
  float distance = kInfinity;   // to `position`; infinite for lights at infinity
  Point3 position{0.0f};        // on the light; unset for lights at infinity
  Vector3 positionError{0.0f};  // bound on its rounding error, by which rays are offset from the surface
  Normal3 normal{0.0f};         // unit, of the light at `position`; 0 for points; -direction at infinity
  Point3 uvw{0.0f};             // as of a hit at `position`; may stay 0 if the light does not use it
  int patchIndex = 0;
  Color diffuse, specular;  // incident radiance for diffuse and specular lobes; deltas: intensity/d² or irradiance
  PdfSolidAngle pdfDirect;
  PdfArea pdfEmit;
  PdfSolidAngle pdfEmitDirection;
  float solidAngleToArea = 0;
};

// A point of a light that a ray from P hit. For lights at infinity only `direction` and `position` are set.
struct LightHit {
  Vector3 direction{0.0f};  // unit, from P towards the light
  float distance = kInfinity;
  Point3 position{0.0f};  // on the light; at infinity, where the ray started
  Normal3 normal{0.0f};   // geometric, unit, on the light's outer side
  Point2 uv{0.0f};
  int patchIndex = 0;
};

// The quantities of LightSample, for a direction that was not sampled by the light.
struct LightEvaluation {
  Normal3 normal{0.0f};
  Color diffuse, specular;
  PdfSolidAngle pdfDirect;
  PdfArea pdfEmit;
  PdfSolidAngle pdfEmitDirection;
  float solidAngleToArea = 0;
};

// A photon. Its flux is radiance · |cosθ| / (pdfEmit · pdfEmitDirection) for area lights, and radiance over the same
// densities without the cosine for all other kinds: `emissionCosine` is 1 there.
struct EmissionSample {
  Point3 position{0.0f};  // origin: on the light, or on the scene's disk
  Vector3 positionError{0.0f};
  Normal3 normal{0.0f};      // of the light; the direction itself for the other kinds
  Vector3 direction{0.0f};   // unit, away from the light
  float emissionCosine = 1;  // |cosθ| between normal and direction for area lights, 1 otherwise
  // Distance along `direction` within which a surface blocks the emission without being lit by it, such as the outer
  // side of a portal. 0 if CanBeAimed.
  float shinesFrom = 0;
  Point3 uvw{0.0f};
  int patchIndex = 0;
  Color diffuse, specular;  // radiance (area, infinite), intensity (points), irradiance (delta directions)
  PdfArea pdfEmit;
  PdfSolidAngle pdfEmitDirection;
};

// Bounds of an emitter for light selection ([Conty18 §4.1]). Render space.
struct EmissionBounds {
  Bounds3 box;            // of the emitting points
  Vector3 axis{0, 0, 1};  // mean direction of emission (the normal, for surfaces)
  float cosThetaO = -1;   // normals lie within this angle of the axis
  float cosThetaE = 0;    // and emit within that angle of the normal
  float energy = 0;       // W, mean of the channels, including importanceMultiplier
  bool twoSided = false;
};

// The part of a ray segment that a light can reach, with an estimate of its irradiance there.
struct SegmentEstimate {
  float radiance = 0;
  float minT = 0, maxT = 0;
};

// A ray in the light's local space; the direction has the length that the transform gives it. In double, so that a
// light of size 1e-3 at a distance of 1e5 is hit accurately.
struct LocalRay {
  Point3d origin{0.0};
  Vector3d direction{0.0};
  double tMin = 0, tMax = 0;
};
struct LocalHit {
  double t = 0;
  Point3d position{0.0};
  Vector3d normal{0.0};  // unit, local space, outer side
  Point2 uv{0.0f};
};

// The surface of a light that rays hit. Absent for mesh lights, whose triangles are part of the geometry, and for
// lights without a surface.
class IntersectableLight {
 public:
  virtual ~IntersectableLight() = default;
  // Points whose convex hull contains the light, local space.
  virtual std::vector<Point3> GetBounds() const = 0;
  // Nearest hit with t in (ray.tMin, ray.tMax], local space.
  virtual std::optional<LocalHit> Intersect(const LocalRay& ray) const = 0;
};

// A spectrum of a light and the colour that it is in Rec. 709. The curve is relative to D65, and at luminance 1.
struct LightSpectrum {
  std::shared_ptr<const SpectralCurve> curve;
  Color color;
};

// Settings that every light has, read by integrators and light selection.
struct LightSettings {
  bool cameraVisible = true;
  bool traceLightPaths = true;     // may emit photons
  float importanceMultiplier = 1;  // > 0, scales the light's selection probability
  int fixedSampleCount = 0;        // by next-event estimation at each receiver; 0: as light selection decides
  std::string lightGroup;
  std::string name;
  // The spectra among its colours. Where light is carried by wavelength, each takes the place of its colour.
  std::vector<LightSpectrum> spectra;
};

class Light {
 public:
  virtual ~Light() = default;

  virtual LightKind Kind() const = 0;
  virtual const LightSettings& Settings() const = 0;

  // Number of patches that can be selected independently (triangles of a mesh); at least 1, and 1 for lights with a
  // Surface(), because a hit of it does not identify a patch.
  virtual int PatchCount() const { return 1; }
  // Probability with which the light samples this patch: the density of the whole light over the density given the
  // patch.
  virtual PdfDiscrete PatchProbability(int) const { return PdfDiscrete(1); }

  // The light's own surface, or null.
  virtual const IntersectableLight* Surface() const { return nullptr; }

  // Estimated irradiance at P on a surface that faces the light, or has the normal context.receiverNormal if the light
  // makes use of that; mean of the channels. Cheap; positive wherever the light can contribute.
  virtual float GetIncidentRadianceEstimate(const LightContext& context, const Point3& P) const = 0;

  // Estimated irradiance along the ray segment from `origin` along the unit `direction`, and the part of [0, length]
  // that the light can reach. nullopt: none.
  virtual std::optional<SegmentEstimate> GetIncidentRadianceEstimate(const LightContext& context, const Point3& origin,
                                                                     const Vector3& direction, float length) const = 0;

  // Emitted power in W per channel. Within 0.1 % for area lights without an image or shaping, and for others where the
  // transform keeps angles; within a factor of ten elsewhere. check-lights asks for that.
  virtual Color GetPowerEstimate(const LightContext& context) const = 0;

  // Emission bounds of context.patch, or of the whole light if that is kAnyPatch. nullopt for lights at infinity.
  virtual std::optional<EmissionBounds> GetEmissionBounds(const LightContext& context) const = 0;

  // Samples the light from P by context.u. nullopt: the sample contributes nothing.
  virtual std::optional<LightSample> GenerateSamples(const LightContext& context, const Point3& P) const = 0;

  // Evaluates a direction from P that hit the light. Densities are 0 if GenerateSamples cannot generate the sample.
  // nullopt for delta lights, which are never hit. For infinite lights any direction is a hit.
  virtual std::optional<LightEvaluation> EvaluateSamples(const LightContext& context, const LightHit& hit,
                                                         const Point3& P) const = 0;

  // True if photons may be importance-sampled towards a target: in any direction from a position on the light or, for a
  // light at infinity, along any line parallel to the sampled direction, which then has the same radiance and the same
  // pdfEmit and pdfEmitDirection. False for a light that emits through an opening of its own (a portal), which the
  // emitted ray has to pass, and for one at infinity whose radiance or densities depend on the line (a sun behind
  // clouds that throw shadows).
  virtual bool CanBeAimed() const { return true; }

  // Opacity of the surface at a point of it, in [0,1]; cut-outs transmit the rest of the rays. EvaluateSamples leaves
  // this factor out, because a ray that hit has met the surface; GenerateSamples and GenerateEmission have it in their
  // radiance.
  virtual float Opacity(const LightHit& /*hit*/) const { return 1; }

  // Samples a photon by context.u and context.uDirection. nullopt: these numbers emit nothing. An area light samples
  // the position by u alone, and then the direction by uDirection. It returns nullopt only without a position, because
  // light tracing connects the position to the camera, independent of the direction and of the diffuse and specular
  // multipliers. A dark direction gives a black sample, with a pdfEmitDirection of 0 if that direction cannot be
  // sampled; its emissionCosine may be 0.
  virtual std::optional<EmissionSample> GenerateEmission(const LightContext& context) const = 0;

  // Radiance seen by a camera ray that hit the light, or escaped to it.
  virtual Color EvaluateEmissionForCamera(const LightContext& context, const LightHit& hit) const = 0;

  // A light like this one with some parameters replaced by `changes`; all tables are rebuilt. Throws an Error as the
  // factory does.
  virtual std::unique_ptr<Light> Edit(const ParameterList& changes, const LightBuildContext& build) const = 0;
};

}  // namespace lampyr
