// The light interface: everything an integrator, a light selector or a plugin author needs to know of a light.
//
// A light answers three questions about the same function, its emitted radiance L(position, direction):
//   GenerateSamples      "sample yourself as seen from P"       (next-event estimation)
//   EvaluateSamples      "this direction found you: what now?"  (BSDF sampling, camera paths)
//   GenerateEmission     "send out a photon"                    (light subpaths)
// and the densities that the three report must agree with each other: a bidirectional weight divides one by another.
// The pdf consistency suite checks exactly that for every registered light.
//
// What each density means ([Veach97 §8.3.2], conventions of this project)
//
//   kind            pdfEmit                          pdfEmitDirection   pdfDirect at P   solidAngleToArea
//   Area            1/m², world-space surface        1/sr given position    1/sr         cosθ_light / d²
//   DeltaPosition   1 (discrete)                     1/sr                   1 (discrete)     1
//   DeltaDirection  1/m² on the scene's disk         1 (discrete)           1 (discrete)     1
//   Infinite        1/m² on the scene's disk         1/sr                   1/sr             1
//
// "The scene's disk" is the disk of the scene's bounding sphere, at its rim and perpendicular to the direction.
// RenderMan reports FLT_MAX and 1 for lights at infinity; here they are the true densities, which can be integrated and
// checked.
//
// - The probability of having selected this light is never part of these densities: the caller multiplies.
// - A density of 0 means that the technique cannot make that sample. Deltas are told by Kind(), not by a value.
// - Every density is written once, in one private function, and each method that reports it calls that one.
// - Everything but GetBounds and Intersect is in render space. Radiance in W/(m² sr) per channel, intensity of delta
//   lights in W/sr (divided by d² by the light), irradiance of delta directions in W/m².
// - A light is immutable once made and is used by many threads at once.
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

// What a light is given with each call. Cheap to make on the stack.
struct LightContext {
  const LightTransform* transform = nullptr;
  BoundingSphere scene;     // of everything that can be hit
  float time = 0;           // in [0,1]
  Point2 u{0.0f};           // position on the light (or direction, for lights without a surface), [0,1)²
  Point2 uDirection{0.0f};  // GenerateEmission: direction (or position on the scene's disk)
  // Which patch to sample, where the caller has selected it; densities are then given the patch. kAnyPatch: the light
  // chooses, and densities include its choice.
  int patch = kAnyPatch;
  // Whether pdfEmit, pdfEmitDirection and solidAngleToArea are wanted too; they are 0 otherwise.
  bool bidirectional = false;
};

// A sample of the light seen from P.
struct LightSample {
  Vector3 direction{0.0f};      // unit, from P towards the light
  float distance = kInfinity;   // to `position`; infinite for lights at infinity
  Point3 position{0.0f};        // on the light; unset for lights at infinity
  Vector3 positionError{0.0f};  // bound on its rounding error: rays start or end that far off the surface
  Normal3 normal{0.0f};         // unit, of the light at `position`; 0 for points; -direction at infinity
  Point3 uvw{0.0f};             // as a hit there has it; a light that never looks at it may leave it at 0
  int patchIndex = 0;
  Color diffuse, specular;  // incident radiance for diffuse and specular lobes; deltas: intensity/d² or irradiance
  PdfSolidAngle pdfDirect;
  PdfArea pdfEmit;
  PdfSolidAngle pdfEmitDirection;
  float solidAngleToArea = 0;
};

// A point of a light that a ray from P found. Lights at infinity only have `direction` and `position`.
struct LightHit {
  Vector3 direction{0.0f};  // unit, from P towards the light
  float distance = kInfinity;
  Point3 position{0.0f};  // on the light; at infinity, where the ray started
  Normal3 normal{0.0f};   // geometric, unit, on the light's outer side
  Point2 uv{0.0f};
  int patchIndex = 0;
};

// The same quantities as in LightSample, for a direction that the light did not choose itself.
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
  Point3 position{0.0f};  // where it starts: on the light, or on the scene's disk
  Vector3 positionError{0.0f};
  Normal3 normal{0.0f};      // of the light; the direction itself for the other kinds
  Vector3 direction{0.0f};   // unit, away from the light
  float emissionCosine = 1;  // |cosθ| between normal and direction for area lights, 1 otherwise
  // Distance along `direction` within which a surface blocks the emission and is not lit by it: the outer side of a
  // portal. 0 where CanBeAimed.
  float shinesFrom = 0;
  Point3 uvw{0.0f};
  int patchIndex = 0;
  Color diffuse, specular;  // radiance (area, infinite), intensity (points), irradiance (delta directions)
  PdfArea pdfEmit;
  PdfSolidAngle pdfEmitDirection;
};

// What a light selector needs to know of an emitter ([Conty18 §4.1]). Render space.
struct EmissionBounds {
  Bounds3 box;            // of the emitting points
  Vector3 axis{0, 0, 1};  // mean direction of emission (the normal, for surfaces)
  float cosThetaO = -1;   // normals lie within this angle of the axis
  float cosThetaE = 0;    // and emit within that angle of the normal
  float energy = 0;       // W, mean of the channels, including importanceMultiplier
  bool twoSided = false;
};

// The part of a ray segment that a light can reach, and an estimate of what it sends there.
struct SegmentEstimate {
  float radiance = 0;
  float minT = 0, maxT = 0;
};

// A ray in the light's local space; the direction is not unit length when the light's transform scales. In double: a
// light of 1e-3 that is seen from 1e5 away is still met where it is.
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

// A light that is itself the surface a ray hits. Absent for mesh lights (the geometry knows the triangles) and for
// lights without a surface.
class IntersectableLight {
 public:
  virtual ~IntersectableLight() = default;
  // Points that bound the light, local space.
  virtual std::vector<Point3> GetBounds() const = 0;
  // Nearest hit with t in (ray.tMin, ray.tMax], local space.
  virtual std::optional<LocalHit> Intersect(const LocalRay& ray) const = 0;
};

// Settings that every light has and the integrators and selectors look at.
struct LightSettings {
  bool cameraVisible = true;
  bool traceLightPaths = true;     // may emit photons
  float importanceMultiplier = 1;  // > 0, scales the light's chance of being selected
  int fixedSampleCount = 0;        // 0: whatever the integrator does
  std::string lightGroup;
  std::string name;
};

class Light {
 public:
  virtual ~Light() = default;

  virtual LightKind Kind() const = 0;
  virtual const LightSettings& Settings() const = 0;

  // Independently selectable parts (triangles of a mesh); at least 1, and 1 where Surface() is: a ray that hits it does
  // not tell one part from another.
  virtual int PatchCount() const { return 1; }
  // How often the light itself chooses this patch: densities given the patch, times this, are those of the whole light.
  virtual PdfDiscrete PatchProbability(int) const { return PdfDiscrete(1); }

  // The light's own surface, or null.
  virtual const IntersectableLight* Surface() const { return nullptr; }

  // Irradiance at P on a surface that faces the light, mean of the channels: cheap, never 0 where the light can
  // contribute.
  virtual float GetIncidentRadianceEstimate(const LightContext& context, const Point3& P) const = 0;

  // The same for the ray segment from `origin` along the unit `direction`, and the part of [0, length] that the light
  // can reach. nullopt: it reaches none of it.
  virtual std::optional<SegmentEstimate> GetIncidentRadianceEstimate(const LightContext& context, const Point3& origin,
                                                                     const Vector3& direction, float length) const = 0;

  // Emitted power in W per channel: exact where there is a closed form, a good estimate otherwise.
  virtual Color GetPowerEstimate(const LightContext& context) const = 0;

  // nullopt for lights at infinity. For one patch, or the whole light (kAnyPatch in the context).
  virtual std::optional<EmissionBounds> GetEmissionBounds(const LightContext& context) const = 0;

  // A sample towards P by context.u; nullopt when the light sends nothing to P by that sample.
  virtual std::optional<LightSample> GenerateSamples(const LightContext& context, const Point3& P) const = 0;

  // For a direction from P that found the light. Densities 0 where GenerateSamples cannot make the sample. Deltas are
  // never found: they give nullopt. For infinite lights any direction is a hit.
  virtual std::optional<LightEvaluation> EvaluateSamples(const LightContext& context, const LightHit& hit,
                                                         const Point3& P) const = 0;

  // Whether emission may be guided: started from a position on the light in any direction, or, by a light at infinity,
  // along any line that is parallel to the direction it has chosen. False for a light that shines through an opening
  // of its own (a portal), which the emitted ray has to pass.
  virtual bool CanBeAimed() const { return true; }

  // A photon by context.u and context.uDirection; nullopt when this choice of numbers emits nothing. An area light
  // chooses the position by u alone, and then the direction by uDirection. It gives nullopt only where it has no
  // position to give: light tracing joins the position to the camera, whatever direction was tried and whatever the
  // diffuse and specular multipliers are. A direction that turns out dark gives a black sample, whose pdfEmitDirection
  // is 0 where no photon is made that way, and whose emissionCosine may be 0.
  virtual std::optional<EmissionSample> GenerateEmission(const LightContext& context) const = 0;

  // What a camera ray sees that hit the light (or escaped to it).
  virtual Color EvaluateEmissionForCamera(const LightContext& context, const LightHit& hit) const = 0;

  // This light with `changes` laid over the parameters it was made from; all tables are made anew. Throws Error like
  // the factory does.
  virtual std::unique_ptr<Light> Edit(const ParameterList& changes, const LightBuildContext& build) const = 0;
};

}  // namespace lampyr
