// An area light on one surface (QuadricSurface, RectSurface) given in a space of its own. The transform may be any,
// also another than the one that the light was built with.
//
// Points are sampled in the unit square, uniformly or from the table of the image, and transformed to render space; the
// density is that of the square over the stretch of area. Seen from P, the surface's own view of itself (a cone, a
// spherical rectangle, the arc that faces P) is sampled; a textured one is sampled by both techniques, half and half,
// and the density is the sum of the two (a one-sample model with the balance heuristic, [Veach97 §9.2.4]).
#pragma once

#include "lights/estimates.h"
#include "lights/types/area_lights.h"
#include "lights/types/exitance_table.h"
#include "lights/types/placed_surface.h"
#include "lights/types/surface_emission.h"
#include "lights/types/surface_table.h"

namespace lampyr {

template <class Geometry>
class SurfaceLight : public LightBase {
 public:
  SurfaceLight(LightTypeFunction type, const ParameterList& parameters, const LightBuildContext& build,
               Geometry surface, const EmissionReader& readEmission)
      : LightBase(type, parameters),
        surface_(std::move(surface)),
        built_(build.transform),
        placed_(surface_.Place(built_)),
        emission_(
            readEmission(parameters, build, {surface_.AreaOf(placed_), [s = surface_](const LightTransform& transform) {
                                               return s.QuickAreaOf(s.Place(transform));
                                             }})) {
    if (emission_.HasImage()) BuildTable();
    power_ = PowerOf(placed_, built_);
    unshapedPower_ = UnshapedPowerOf(placed_, built_);
    reach_ = ReachOf(placed_, built_);
  }

  LightKind Kind() const final { return LightKind::Area; }

  float GetIncidentRadianceEstimate(const LightContext& context, const Point3& P) const final {
    const EmissionBounds bounds = ReachFor(context);
    return SurfaceIrradianceEstimate(bounds, emission_.ApparentPower(context, bounds, UnshapedPowerFor(context), P), P);
  }
  std::optional<SegmentEstimate> GetIncidentRadianceEstimate(const LightContext& context, const Point3& origin,
                                                             const Vector3& direction, float length) const final {
    return SurfaceSegmentEstimate(ReachFor(context), emission_.LargestPower(UnshapedPowerFor(context)), origin,
                                  direction, length);
  }
  Color GetPowerEstimate(const LightContext& context) const final { return PowerFor(context); }
  std::optional<EmissionBounds> GetEmissionBounds(const LightContext& context) const final {
    EmissionBounds bounds = ReachFor(context);
    bounds.energy = PowerFor(context).Average() * Settings().importanceMultiplier;
    return bounds;
  }

  std::optional<LightSample> GenerateSamples(const LightContext& context, const Point3& P) const final;
  std::optional<LightEvaluation> EvaluateSamples(const LightContext& context, const LightHit& hit,
                                                 const Point3& P) const final;
  std::optional<EmissionSample> GenerateEmission(const LightContext& context) const final {
    Placed scratch;
    return emission_.Emit(context, SamplePoint(context.u, PlacedFor(context, scratch)));
  }
  float Opacity(const LightHit& hit) const final { return emission_.OpacityAt(hit); }
  Color EvaluateEmissionForCamera(const LightContext& context, const LightHit& hit) const final {
    return emission_.ForCamera(context, hit, Settings().cameraVisible);
  }

 protected:
  const Geometry& GetGeometry() const { return surface_; }

 private:
  using View = typename Geometry::View;
  using Placed = typename Geometry::Placed;

  bool IsAsBuilt(const LightContext& context) const { return SamePlacement(*context.transform, built_); }
  const Placed& PlacedFor(const LightContext& context, Placed& scratch) const {
    if (IsAsBuilt(context)) return placed_;
    scratch = surface_.Place(*context.transform);
    return scratch;
  }

  // Density in 1/m², render space, of a photon's origin with the normal `normal`. All methods that report it call this.
  PdfArea AreaDensity(const Placed& placed, const Point2& uv, const Normal3& normal) const {
    if (!emission_.HasImage()) return EvenDensity(placed, normal);
    return table_ ? EvenDensity(placed, normal) * table_->Density(surface_.SquareAt(uv)) : PdfArea(0);
  }
  PdfArea EvenDensity(const Placed& placed, const Normal3& normal) const {
    const PdfArea density(static_cast<float>(surface_.OwnDensity() / placed.StretchAt(normal)));
    return density.value < kInfinity ? density : PdfArea(0);
  }
  // Area in render space of the whole unit square, for a surface whose normal is `normal` everywhere.
  float ElementAt(const Placed& placed, const Normal3& normal) const {
    const double own = surface_.OwnDensity();
    return own > 0 ? static_cast<float>(placed.StretchAt(normal) / own) : 0.0f;
  }
  // Fraction of the samples that are taken by the view.
  float ViewShare(const View& view) const { return emission_.HasImage() ? 0.5f * view.weight : view.weight; }

  // Density in 1/sr at P of a point on the light. All methods that report it call this.
  PdfSolidAngle DirectDensity(const Placed& placed, const View& view, const Vector3& direction, float distance,
                              const Normal3& normal, const Point2& uv) const {
    const float outward = -glm::dot(normal, direction), emitted = emission_.EmittedCosine(outward);
    if (!(emitted > 0)) return PdfSolidAngle(0);
    const float share = ViewShare(view), squared = Sqr(distance);
    PdfSolidAngle density(0);
    if (share > 0) {
      const PdfArea even = Geometry::NeedsEvenDensity(view) ? EvenDensity(placed, normal) : PdfArea(0);
      density = share * surface_.ViewDensity(view, {uv, outward, squared, even});
    }
    if (share < 1) {
      density =
          density + (1 - share) * SurfaceEmission::DirectDensity(AreaDensity(placed, uv, normal), squared, emitted);
    }
    return density.value < kInfinity ? density : PdfSolidAngle(0);
  }

  std::optional<LightSample> SampleWithView(const LightContext& context, const Placed& placed, const Point3& P) const;
  EmittingPoint SamplePoint(const Point2& u, const Placed& placed) const;
  void BuildTable();
  Color PowerOf(const Placed& placed, const LightTransform& transform) const;
  Color MeanOverSurface(const Placed& placed, const LightTransform& transform) const;
  Color PowerFor(const LightContext& context) const;
  // Power without shaping, mean of the channels. Fast under any placement.
  float UnshapedPowerOf(const Placed& placed, const LightTransform& transform) const {
    return emission_.MeanRadiance().Average() * static_cast<float>(surface_.QuickAreaOf(placed)) *
           emission_.Strength(transform) * kPi * emission_.SideCount();
  }
  float UnshapedPowerFor(const LightContext& context) const;
  // Emission bounds without the energy.
  EmissionBounds ReachOf(const Placed& placed, const LightTransform& transform) const;
  EmissionBounds ReachFor(const LightContext& context) const {
    return IsAsBuilt(context) ? reach_ : ReachOf(surface_.Place(*context.transform), *context.transform);
  }

  Geometry surface_;
  LightTransform built_;
  Placed placed_;
  SurfaceEmission emission_;
  std::unique_ptr<const Distribution2D> table_;  // null: no image, or a black one
  Color power_;
  float unshapedPower_ = 0;
  EmissionBounds reach_;
};

template <class Geometry>
void SurfaceLight<Geometry>::BuildTable() {
  surface_.SetTextured();
  SurfaceTableInput input;
  input.uv = [this](const Point2& square) { return surface_.UvAt(square, surface_.At(square)); };
  input.element = [this](const Point2& square) {
    return ElementAt(placed_, placed_.NormalAt(surface_.OutwardNormal(surface_.At(square))));
  };
  input.firstIsV = surface_.FirstIsV();
  table_ = MakeSurfaceTable(emission_.EmittedImage(), input);
}

template <class Geometry>
EmittingPoint SurfaceLight<Geometry>::SamplePoint(const Point2& u, const Placed& placed) const {
  EmittingPoint point;
  if (emission_.HasImage() && !table_) return point;
  const Point2 square = table_ ? table_->Sample(u).uv : u;
  const Point3 p = surface_.At(square);
  point.position = placed.toRender.Point(p);
  point.positionError = placed.toRender.PointError(p, Gamma(8) * Abs(p));
  point.normal = placed.NormalAt(surface_.OutwardNormal(p));
  // uv is only needed for an image, for cut-outs, or by the surface's own view.
  if (emission_.NeedsUv() || surface_.ViewNeedsUv()) point.uv = surface_.UvAt(square, p);
  // Evaluated from uv, so that a hit at this point gets the same density.
  point.density = AreaDensity(placed, point.uv, point.normal);
  return point;
}

template <class Geometry>
std::optional<LightSample> SurfaceLight<Geometry>::GenerateSamples(const LightContext& context, const Point3& P) const {
  Placed scratch;
  const Placed& placed = PlacedFor(context, scratch);
  if (!surface_.HasViews()) return emission_.Sample(context, P, SamplePoint(context.u, placed));
  return SampleWithView(context, placed, P);
}

// A single return variable, so that it is constructed in the caller's storage (NRVO).
template <class Geometry>
std::optional<LightSample> SurfaceLight<Geometry>::SampleWithView(const LightContext& context, const Placed& placed,
                                                                  const Point3& P) const {
  const View view = surface_.ViewFrom(placed, P, emission_.IsTwoSided());
  const float share = ViewShare(view);
  std::optional<LightSample> sample(std::in_place);
  Point2 u = context.u;
  PdfArea density(0);
  if (u.x < share) {
    u.x = std::min(u.x / share, kOneMinusEpsilon);
    surface_.SampleView(view, placed, P, u, emission_.NeedsUv(), *sample);
    const Point2 uv(sample->uvw.x, sample->uvw.y);
    if (context.bidirectional) density = AreaDensity(placed, uv, sample->normal);
  } else {
    u.x = std::min((u.x - share) / (1 - share), kOneMinusEpsilon);
    const EmittingPoint point = SamplePoint(u, placed);
    const Vector3 toLight = point.position - P;
    sample->distance = point.density.IsZero() ? 0.0f : glm::length(toLight);
    sample->direction = sample->distance > 0 ? toLight / sample->distance : Vector3(0.0f);
    sample->position = point.position;
    sample->positionError = point.positionError;
    sample->normal = point.normal;
    sample->uvw = Point3(point.uv, 0.0f);
    density = point.density;
  }
  sample->pdfDirect = DirectDensity(placed, view, sample->direction, sample->distance, sample->normal,
                                    Point2(sample->uvw.x, sample->uvw.y));
  if (!emission_.Complete(context, density, *sample)) sample.reset();
  return sample;
}

template <class Geometry>
std::optional<LightEvaluation> SurfaceLight<Geometry>::EvaluateSamples(const LightContext& context, const LightHit& hit,
                                                                       const Point3& P) const {
  if (!(emission_.EmittedCosine(-glm::dot(hit.normal, hit.direction)) > 0)) return std::nullopt;
  Placed scratch;
  const Placed& placed = PlacedFor(context, scratch);
  const View view = surface_.ViewFrom(placed, P, emission_.IsTwoSided());
  const PdfArea density = context.bidirectional ? AreaDensity(placed, hit.uv, hit.normal) : PdfArea(0);
  return emission_.Evaluate(context, hit, density,
                            DirectDensity(placed, view, hit.direction, hit.distance, hit.normal, hit.uv));
}

// Mean over the area of radiance times exitance.
template <class Geometry>
Color SurfaceLight<Geometry>::MeanOverSurface(const Placed& placed, const LightTransform& transform) const {
  const ShapedDirections* shaped = emission_.Shaped();
  if (!shaped || placed.isFlat) {
    // The exitance is the same at all points. The mean of the image is known where the area is even over uv.
    Color exitance = emission_.Exitance(transform, placed.flatNormal);
    if (shaped && !emission_.IsTwoSided() && shaped->Parts().EmitterKind() == Shaping::Emitter::Flat &&
        shaped->KeepsAngles(transform))
      exitance = shaped->Parts().Integral();
    if (!emission_.HasImage() || surface_.IsEvenOverUv(placed)) return emission_.MeanRadiance() * exitance;
  }
  if (shaped && !emission_.HasImage() && surface_.HasAllNormals(placed) && !placed.isFlat) {
    return emission_.MeanRadiance() * shaped->Parts().Integral() * emission_.SideCount();
  }
  const ExitanceTable exitance(emission_, transform);
  // Evenly distributed points of the surface's own space, weighted by their area.
  const int n = emission_.HasImage() ? std::clamp(2 * emission_.EmittedImage().Height(), 64, 512) : 64;
  Color sum;
  float elements = 0;
  for (int row = 0; row < n; ++row) {
    Color ofRow;
    for (int column = 0; column < n; ++column) {
      const Point2 square((static_cast<float>(column) + 0.5f) / static_cast<float>(n),
                          (static_cast<float>(row) + 0.5f) / static_cast<float>(n));
      const Point3 p = surface_.At(square);
      const Normal3 normal = placed.NormalAt(surface_.OutwardNormal(p));
      const float element = ElementAt(placed, normal);
      ofRow += element * emission_.Radiance(surface_.UvAt(square, p)) * exitance(normal);
      elements += element;
    }
    sum += ofRow;
  }
  return elements > 0 ? sum / elements : Color(0.0f);
}

template <class Geometry>
Color SurfaceLight<Geometry>::PowerOf(const Placed& placed, const LightTransform& transform) const {
  const auto area = static_cast<float>(surface_.AreaOf(placed)) * emission_.Strength(transform);
  return area * MeanOverSurface(placed, transform);
}

template <class Geometry>
Color SurfaceLight<Geometry>::PowerFor(const LightContext& context) const {
  if (IsAsBuilt(context)) return power_;
  if (const auto scaleSquared = RelativeScaleSquared(built_, *context.transform)) {
    return power_ * emission_.PowerScale(*scaleSquared);
  }
  return PowerOf(surface_.Place(*context.transform), *context.transform);
}

template <class Geometry>
float SurfaceLight<Geometry>::UnshapedPowerFor(const LightContext& context) const {
  if (IsAsBuilt(context)) return unshapedPower_;
  if (const auto scaleSquared = RelativeScaleSquared(built_, *context.transform)) {
    return unshapedPower_ * emission_.PowerScale(*scaleSquared);
  }
  return UnshapedPowerOf(surface_.Place(*context.transform), *context.transform);
}

template <class Geometry>
EmissionBounds SurfaceLight<Geometry>::ReachOf(const Placed& placed, const LightTransform& transform) const {
  EmissionBounds bounds;
  bounds.box = surface_.BoundsOf(placed);
  bounds.twoSided = emission_.IsTwoSided();
  if (placed.isFlat) {
    bounds.axis = placed.flatNormal;
    bounds.cosThetaO = 1;
    emission_.NarrowFlat(transform, bounds);
  }
  return bounds;
}

}  // namespace lampyr
