// LightSource "ring": a flat ring at z = 0, from innerRadius to outerRadius, that emits along -z, or to both sides
// where it is `twoSided`. Radiance 1 or that of the image, in W/(m² sr), times what all lights have (intensity, color,
// …).
//
// The image is laid around the ring: u counts turns from +x towards +y, v runs from the inner rim to the outer one.
//
// How it is sampled. A point is chosen in the unit square (s, t): s is u, and t is the area between the inner rim and
// the point, as a part of the whole. Equal areas of the square are thus equal areas of the ring, and, the ring being
// flat, stay so under any affine transform: all of them are stretched alike. With an image the square is sampled by a
// table of it; the density over the area is that over the square divided by the ring's area.
//
// Everything but Surface() is in render space, and asks the context where the light is: at another time of the shutter
// it may be somewhere else than where it was built.
#include <cmath>
#include <numbers>

#include "geometry/rounding.h"
#include "lights/emission_image.h"
#include "lights/estimates.h"
#include "lights/light_base.h"
#include "lights/types/area_lights.h"
#include "lights/types/surface_table.h"
#include "math/frame.h"
#include "sampling/warp.h"

using namespace lampyr;

LightType RingLightType();

namespace {

// The ring in its own space: the map between the square, uv and points.
struct Annulus {
  float inner, outer;

  float Span() const { return (outer - inner) * (outer + inner); }
  float Area() const { return kPi * Span(); }
  Point2 UvAt(const Point2& square) const {
    const float radius = std::sqrt(inner * inner + square.y * Span());
    return {square.x, std::clamp((radius - inner) / (outer - inner), 0.0f, 1.0f)};
  }
  Point2 SquareAt(const Point2& uv) const {
    const float radius = inner + uv.y * (outer - inner);
    return {uv.x, (radius - inner) * (radius + inner) / Span()};
  }
  Point3 At(const Point2& uv) const { return Point3(CosSinTurns(uv.x) * (inner + uv.y * (outer - inner)), 0.0f); }
};

// The ring as rays meet it: in double and in its own space. The ray's direction is not unit length.
class RingSurface final : public IntersectableLight {
 public:
  explicit RingSurface(const Annulus& ring) : ring_(ring) {}

  std::vector<Point3> GetBounds() const override {
    const float r = ring_.outer;
    return {{-r, -r, 0}, {-r, r, 0}, {r, -r, 0}, {r, r, 0}};
  }

  std::optional<LocalHit> Intersect(const LocalRay& ray) const override {
    if (ray.direction.z == 0) return std::nullopt;
    LocalHit hit;
    hit.t = -ray.origin.z / ray.direction.z;
    if (!(hit.t > ray.tMin && hit.t <= ray.tMax)) return std::nullopt;
    hit.position = ray.origin + hit.t * ray.direction;
    hit.position.z = 0;
    const double inner = static_cast<double>(ring_.inner), outer = static_cast<double>(ring_.outer);
    const double radius = std::hypot(hit.position.x, hit.position.y);
    if (!(radius >= inner && radius <= outer)) return std::nullopt;
    double turns = std::atan2(hit.position.y, hit.position.x) / (2 * std::numbers::pi);
    if (turns < 0) turns += 1;
    hit.uv = Point2(static_cast<float>(turns), static_cast<float>((radius - inner) / (outer - inner)));
    hit.normal = {0, 0, -1};
    return hit;
  }

 private:
  Annulus ring_;
};

// LightBase brings Settings() and Edit(), which makes the light anew from its parameters and the changes.
class RingLight final : public LightBase {
 public:
  RingLight(const ParameterList& parameters, const LightBuildContext& build, const Annulus& ring);

  LightKind Kind() const override { return LightKind::Area; }
  const IntersectableLight* Surface() const override { return &surface_; }

  float GetIncidentRadianceEstimate(const LightContext& context, const Point3& P) const override;
  std::optional<SegmentEstimate> GetIncidentRadianceEstimate(const LightContext& context, const Point3& origin,
                                                             const Vector3& direction, float length) const override;
  Color GetPowerEstimate(const LightContext& context) const override;
  std::optional<EmissionBounds> GetEmissionBounds(const LightContext& context) const override;

  std::optional<LightSample> GenerateSamples(const LightContext& context, const Point3& P) const override;
  std::optional<LightEvaluation> EvaluateSamples(const LightContext& context, const LightHit& hit,
                                                 const Point3& P) const override;
  std::optional<EmissionSample> GenerateEmission(const LightContext& context) const override;
  Color EvaluateEmissionForCamera(const LightContext& context, const LightHit& hit) const override;

 private:
  // Where the light is: what the ring's plane becomes in render space.
  struct Placed {
    const Affine& toRender;
    Normal3 normal;  // unit, on the side that emits
    float area;      // m², of the whole ring
  };
  Placed PlacedIn(const LightContext& context) const;

  struct ChosenPoint {
    Point3 position;
    Vector3 positionError;
    Point2 uv;
  };
  std::optional<ChosenPoint> SamplePoint(const Placed& placed, const Point2& u) const;

  // The densities, each written once. All that reports one calls these.
  PdfArea AreaDensity(const Placed& placed, const Point2& uv) const;
  PdfSolidAngle DirectDensity(PdfArea density, float distance, float emittedCosine) const;
  PdfSolidAngle DirectionDensity(float emittedCosine) const;

  // The cosine of a side that emits, 0 for one that does not.
  float EmittedCosine(float cosine) const { return twoSided_ ? std::abs(cosine) : std::max(cosine, 0.0f); }
  Color Radiance(const Placed& placed, const Point2& uv) const;

  Annulus ring_;
  RingSurface surface_;
  LightTint tint_;
  bool twoSided_;
  EmissionImage image_;
  std::unique_ptr<const Distribution2D> table_;  // null: no image, or a black one
  Color meanRadiance_;                           // over the ring
};

RingLight::RingLight(const ParameterList& parameters, const LightBuildContext& build, const Annulus& ring)
    : LightBase(RingLightType, parameters),
      ring_(ring),
      surface_(ring),
      tint_(ReadLightTint(parameters)),
      twoSided_(parameters.GetBool("twoSided", false)),
      image_(parameters, "texture:file", build),
      meanRadiance_(tint_.color) {
  if (image_.IsEmpty()) return;
  SurfaceTableInput square;
  square.uv = [this](const Point2& s) { return ring_.UvAt(s); };
  square.element = [](const Point2&) { return 1.0f; };
  table_ = MakeSurfaceTable(image_, square);
  // The mean over the square is that over the ring's area. A few points for each texel.
  const int columns = 2 * image_.Width(), rows = 4 * image_.Height();
  Color sum;
  for (int i = 0; i < columns * rows; ++i) {
    const Point2 s((static_cast<float>(i % columns) + 0.5f) / static_cast<float>(columns),
                   (static_cast<float>(i / columns) + 0.5f) / static_cast<float>(rows));
    sum += image_.OnSurface(ring_.UvAt(s));
  }
  meanRadiance_ = tint_.color * sum / static_cast<float>(columns * rows);
}

RingLight::Placed RingLight::PlacedIn(const LightContext& context) const {
  const LightTransform& transform = *context.transform;
  // Normals go by the inverse of the map, which keeps them on their side also where it mirrors.
  const Normal3 normal = SafeNormalize(transform.toLocal.NormalByInverse({0, 0, -1}), {0, 0, 1});
  return {transform.toRender, normal, ring_.Area() * AreaStretch(transform.toRender, normal)};
}

Color RingLight::Radiance(const Placed& placed, const Point2& uv) const {
  Color radiance = tint_.color;
  if (!image_.IsEmpty()) radiance *= image_.OnSurface(uv);
  return tint_.normalize ? radiance / placed.area : radiance;
}

// 1/m² in render space.
PdfArea RingLight::AreaDensity(const Placed& placed, const Point2& uv) const {
  const PdfArea even(1 / placed.area);
  if (image_.IsEmpty()) return even;
  return table_ ? even * table_->Density(ring_.SquareAt(uv)) : PdfArea(0);
}

// 1/sr at a receiver, of a point with this density over the area.
PdfSolidAngle RingLight::DirectDensity(PdfArea density, float distance, float emittedCosine) const {
  return ToSolidAngle(density, Sqr(distance), emittedCosine);
}

// 1/sr of a photon's direction: the cosine law, on each side that emits.
PdfSolidAngle RingLight::DirectionDensity(float emittedCosine) const {
  return PdfSolidAngle(emittedCosine * kInvPi * (twoSided_ ? 0.5f : 1.0f));
}

// The density is asked for by uv, as a hit there will ask for it: both are told the same number.
std::optional<RingLight::ChosenPoint> RingLight::SamplePoint(const Placed& placed, const Point2& u) const {
  if (!image_.IsEmpty() && !table_) return std::nullopt;
  ChosenPoint point;
  point.uv = ring_.UvAt(table_ ? table_->Sample(u).uv : u);
  const Point3 local = ring_.At(point.uv);
  point.position = placed.toRender.Point(local);
  point.positionError = placed.toRender.PointError(local, Gamma(8) * glm::abs(local));
  return point;
}

// nullopt wherever the light sends nothing to P: there is no sample of density 0, and none that is black.
std::optional<LightSample> RingLight::GenerateSamples(const LightContext& context, const Point3& P) const {
  const Placed placed = PlacedIn(context);
  const auto point = SamplePoint(placed, context.u);
  if (!point) return std::nullopt;
  LightSample sample;
  const Vector3 towards = point->position - P;
  sample.distance = glm::length(towards);
  if (!(sample.distance > 0)) return std::nullopt;
  sample.direction = towards / sample.distance;
  sample.position = point->position;
  sample.positionError = point->positionError;
  sample.normal = placed.normal;
  sample.uvw = Point3(point->uv, 0.0f);
  const float cosine = EmittedCosine(-glm::dot(placed.normal, sample.direction));
  const PdfArea density = AreaDensity(placed, point->uv);
  sample.pdfDirect = DirectDensity(density, sample.distance, cosine);
  if (sample.pdfDirect.IsZero() || !tint_.Split(Radiance(placed, point->uv), sample)) return std::nullopt;
  if (context.bidirectional) {
    sample.pdfEmit = density;
    sample.pdfEmitDirection = DirectionDensity(cosine);
    sample.solidAngleToArea = SolidAngleToArea(Sqr(sample.distance), cosine);
  }
  return sample;
}

std::optional<LightEvaluation> RingLight::EvaluateSamples(const LightContext& context, const LightHit& hit,
                                                          const Point3&) const {
  const float cosine = EmittedCosine(-glm::dot(hit.normal, hit.direction));
  if (!(cosine > 0)) return std::nullopt;  // the dark side
  const Placed placed = PlacedIn(context);
  const PdfArea density = AreaDensity(placed, hit.uv);
  LightEvaluation evaluation;
  evaluation.normal = hit.normal;
  evaluation.pdfDirect = DirectDensity(density, hit.distance, cosine);
  tint_.Split(Radiance(placed, hit.uv), evaluation);
  if (context.bidirectional) {
    evaluation.pdfEmit = density;
    evaluation.pdfEmitDirection = DirectionDensity(cosine);
    evaluation.solidAngleToArea = SolidAngleToArea(Sqr(hit.distance), cosine);
  }
  return evaluation;
}

// The place by context.u alone, then the direction: what is a dark direction leaves the place as it is.
std::optional<EmissionSample> RingLight::GenerateEmission(const LightContext& context) const {
  const Placed placed = PlacedIn(context);
  const auto point = SamplePoint(placed, context.u);
  if (!point) return std::nullopt;
  EmissionSample photon;
  photon.position = point->position;
  photon.positionError = point->positionError;
  photon.normal = placed.normal;
  photon.uvw = Point3(point->uv, 0.0f);
  photon.pdfEmit = AreaDensity(placed, point->uv);
  if (photon.pdfEmit.IsZero()) return std::nullopt;
  Point2 u = context.uDirection;
  float side = 1;
  if (twoSided_) {  // the first number chooses the side, and is stretched again
    side = u.x < 0.5f ? 1.0f : -1.0f;
    u.x = std::min(u.x < 0.5f ? 2 * u.x : 2 * u.x - 1, kOneMinusEpsilon);
  }
  photon.direction = Frame::FromNormal(side * placed.normal).ToWorld(SampleCosineHemisphere(u));
  photon.emissionCosine = EmittedCosine(glm::dot(placed.normal, photon.direction));
  photon.pdfEmitDirection = DirectionDensity(photon.emissionCosine);
  if (!photon.pdfEmitDirection.IsZero()) tint_.Split(Radiance(placed, point->uv), photon);
  return photon;
}

// A camera sees the light without the multipliers of diffuse and specular.
Color RingLight::EvaluateEmissionForCamera(const LightContext& context, const LightHit& hit) const {
  const float cosine = EmittedCosine(-glm::dot(hit.normal, hit.direction));
  return Settings().cameraVisible && cosine > 0 ? Radiance(PlacedIn(context), hit.uv) : Color(0.0f);
}

Color RingLight::GetPowerEstimate(const LightContext& context) const {
  const float area = tint_.normalize ? 1.0f : PlacedIn(context).area;
  return meanRadiance_ * (area * kPi * (twoSided_ ? 2.0f : 1.0f));
}

std::optional<EmissionBounds> RingLight::GetEmissionBounds(const LightContext& context) const {
  const Placed placed = PlacedIn(context);
  EmissionBounds bounds;
  // The circle's reach along each axis of render space.
  const glm::mat3& m = placed.toRender.linear;
  Vector3 reach;
  for (int axis = 0; axis < 3; ++axis) reach[axis] = ring_.outer * std::hypot(m[0][axis], m[1][axis]);
  reach += placed.toRender.PointError(Point3(ring_.outer, ring_.outer, 0), Vector3(0.0f));
  bounds.box.Add(placed.toRender.translation - reach);
  bounds.box.Add(placed.toRender.translation + reach);
  bounds.axis = placed.normal;
  bounds.cosThetaO = 1;  // all normals are the axis
  bounds.cosThetaE = 0;  // and emit up to 90° from it
  bounds.twoSided = twoSided_;
  bounds.energy = GetPowerEstimate(context).Average() * Settings().importanceMultiplier;
  return bounds;
}

float RingLight::GetIncidentRadianceEstimate(const LightContext& context, const Point3& P) const {
  return SurfaceIrradianceEstimate(*GetEmissionBounds(context), GetPowerEstimate(context).Average(), P);
}

std::optional<SegmentEstimate> RingLight::GetIncidentRadianceEstimate(const LightContext& context, const Point3& origin,
                                                                      const Vector3& direction, float length) const {
  return SurfaceSegmentEstimate(*GetEmissionBounds(context), GetPowerEstimate(context).Average(), origin, direction,
                                length);
}

}  // namespace

LightType RingLightType() {
  LightType type;
  type.name = "ring";
  type.help = "a flat ring that emits along -z";
  // The rows that every light has (intensity, color, name, …) come after its own.
  type.parameters = WithCommonParameters({
      {"innerRadius", ParameterType::Float, "m", "0.25", ">= 0", "of the hole"},
      {"outerRadius", ParameterType::Float, "m", "0.5", "> 0", "of the ring"},
      {"twoSided", ParameterType::Bool, "", "false", "", "emit on the other side as well"},
      {"texture:file", ParameterType::String, "", "\"\"", "", "image around the ring, multiplies the radiance"},
  });
  // Names, types and ranges were checked against the table before; what the table cannot say is checked here.
  type.create = [](const ParameterList& parameters, const LightBuildContext& build) -> std::unique_ptr<Light> {
    const Annulus ring{static_cast<float>(parameters.GetFloat("innerRadius", 0.25)),
                       static_cast<float>(parameters.GetFloat("outerRadius", 0.5))};
    if (!(ring.inner < ring.outer)) {
      throw Error(parameters.WhereOf("innerRadius"),
                  parameters.Owner() + ": innerRadius must be less than outerRadius");
    }
    return std::make_unique<RingLight>(parameters, build, ring);
  };
  // Parameter blocks that `lampyr check-lights --plugin ring.so` tests, under all transforms. The suite provides the
  // image.
  type.samples = {
      "\"rgb color\" [ 1 0.5 0.25 ] \"float intensity\" 3 \"float exposure\" 1",
      "\"float innerRadius\" 0 \"bool twoSided\" true \"bool normalize\" true \"float diffuse\" 0.5 "
      "\"float specular\" 2",
      "\"string texture:file\" \"suite-texture.exr\" \"float innerRadius\" 0.4 \"float outerRadius\" 1",
      "\"string texture:file\" \"suite-texture.exr\" \"bool twoSided\" true \"bool normalize\" true",
  };
  return type;
}
