// Spheres, disks and cylinders that emit, partial ones included. A whole sphere that is still a sphere in render space
// is sampled by the solid angle it fills, from outside; everything else by area: uniform in the quadric's own space,
// with the density per position divided by the area's stretch there, whatever the transform.
#include "geometry/quadric.h"
#include "geometry/rounding.h"
#include "lights/area_lights.h"
#include "lights/direction_map.h"
#include "lights/estimates.h"
#include "lights/sphere_cone.h"
#include "lights/surface_emission.h"

namespace lampyr {

namespace {

// The quadric as it lies in render space at one instant.
struct PlacedQuadric {
  Affine toRender, toLocal;  // from and to the quadric's own space
  bool isSphere = false;     // whole, and a sphere in render space too
  float radius = 0;          // of that sphere
};

PlacedQuadric Place(const Quadric& quadric, const LightTransform& transform, bool isPlaced) {
  PlacedQuadric placed{quadric.toRender, quadric.toObject, false, 0};
  if (isPlaced) {
    placed.toRender = {transform.toRender.linear * quadric.toRender.linear,
                       transform.toRender.Point(quadric.toRender.translation)};
    placed.toLocal = {quadric.toObject.linear * transform.toLocal.linear,
                      quadric.toObject.Point(transform.toLocal.translation)};
  }
  placed.isSphere = quadric.IsFullSphere() && IsSimilarity(placed.toRender.linear);
  placed.radius = quadric.radius * glm::length(placed.toRender.linear[0]);
  return placed;
}

Quadric InRenderSpace(const Quadric& quadric, const PlacedQuadric& placed) {
  Quadric result = quadric;
  result.toRender = placed.toRender;
  result.toObject = placed.toLocal;
  return result;
}

class QuadricLight final : public LightBase {
 public:
  QuadricLight(LightTypeFunction type, const ParameterList& parameters, const LightBuildContext& build,
               const Quadric& quadric)
      : LightBase(type, parameters),
        quadric_(quadric),
        isPlaced_(!IsIdentity(build.transform.toRender)),
        built_(build.transform),
        placed_(Place(quadric, build.transform, isPlaced_)),
        area_(GetArea(Shape(InRenderSpace(quadric, placed_)))),
        emission_(parameters, build, area_),
        normalSign_(OutsideSign(quadric)),
        localDensity_(LocalDensity()) {
    power_ = PowerOf(placed_);
    bounds_ = BoundsOf(placed_);
  }

  LightKind Kind() const override { return LightKind::Area; }

  float GetIncidentRadianceEstimate(const LightContext& context, const Point3& P) const override {
    return SurfaceIrradianceEstimate(BoundsFor(context), GetPowerEstimate(context).Average(), P);
  }
  std::optional<SegmentEstimate> GetIncidentRadianceEstimate(const LightContext& context, const Point3& origin,
                                                             const Vector3& direction, float length) const override {
    return SurfaceSegmentEstimate(BoundsFor(context), GetPowerEstimate(context).Average(), origin, direction, length);
  }
  Color GetPowerEstimate(const LightContext& context) const override {
    return IsAsBuilt(context) ? power_ : PowerOf(Place(quadric_, *context.transform, true));
  }
  std::optional<EmissionBounds> GetEmissionBounds(const LightContext& context) const override {
    return BoundsFor(context);
  }

  std::optional<LightSample> GenerateSamples(const LightContext& context, const Point3& P) const override {
    PlacedQuadric scratch;
    const PlacedQuadric& placed = PlacedFor(context, scratch);
    if (placed.isSphere) {
      if (const auto cone = SphereCone::From(P, placed.toRender.translation, placed.radius)) {
        return SampleCone(context, placed, *cone);
      }
    }
    return emission_.Sample(context, P, SamplePoint(context, placed));
  }

  std::optional<LightEvaluation> EvaluateSamples(const LightContext& context, const LightHit& hit,
                                                 const Point3& P) const override {
    PlacedQuadric scratch;
    const PlacedQuadric& placed = PlacedFor(context, scratch);
    const PdfArea density = AreaDensity(placed, hit.normal);
    if (placed.isSphere) {
      if (const auto cone = SphereCone::From(P, placed.toRender.translation, placed.radius)) {
        // The cone's samples lie on the near side; the far one is seen through cut-outs only.
        const bool nearSide = -glm::dot(hit.normal, hit.direction) * normalSign_ > 0;
        return emission_.Evaluate(context, hit, density, nearSide ? cone->Density() : PdfSolidAngle(0));
      }
    }
    return emission_.Evaluate(context, hit, density);
  }

  std::optional<EmissionSample> GenerateEmission(const LightContext& context) const override {
    PlacedQuadric scratch;
    return emission_.Emit(context, SamplePoint(context, PlacedFor(context, scratch)));
  }

  Color EvaluateEmissionForCamera(const LightContext&, const LightHit& hit) const override {
    return emission_.ForCamera(hit, Settings().cameraVisible);
  }

 private:
  bool IsAsBuilt(const LightContext& context) const { return !isPlaced_ || SamePlacement(*context.transform, built_); }
  const PlacedQuadric& PlacedFor(const LightContext& context, PlacedQuadric& scratch) const {
    if (IsAsBuilt(context)) return placed_;
    scratch = Place(quadric_, *context.transform, true);
    return scratch;
  }

  // 1/m² in render space where the normal is `normal`: the one place where it is written.
  PdfArea AreaDensity(const PlacedQuadric& placed, const Normal3& normal) const {
    const PdfArea density(localDensity_ / AreaStretch(placed.toRender, normal));
    return density.value < kInfinity ? density : PdfArea(0);
  }

  float LocalDensity() const;
  Point3 SampleLocal(const Point2& u) const;
  Normal3 LocalNormal(const Point3& p) const;
  Point2 UvOf(const Point3& p) const;
  EmittingPoint SamplePoint(const LightContext& context, const PlacedQuadric& placed) const;
  std::optional<LightSample> SampleCone(const LightContext& context, const PlacedQuadric& placed,
                                        const SphereCone& cone) const;
  Color PowerOf(const PlacedQuadric& placed) const;
  EmissionBounds BoundsOf(const PlacedQuadric& placed) const;
  EmissionBounds BoundsFor(const LightContext& context) const {
    return IsAsBuilt(context) ? bounds_ : BoundsOf(Place(quadric_, *context.transform, true));
  }

  Quadric quadric_;
  bool isPlaced_;  // the quadric's `toRender` does not lead to render space
  LightTransform built_;
  PlacedQuadric placed_;
  double area_;  // in render space
  SurfaceEmission emission_;
  float normalSign_;    // of the outer side against the quadric's own normal
  float localDensity_;  // 1/m² in the quadric's own space
  Color power_;
  EmissionBounds bounds_;
};

float QuadricLight::LocalDensity() const {
  const Quadric& q = quadric_;
  const float low = q.kind == Quadric::Kind::Sphere ? std::max(q.zMin, -q.radius) : q.zMin;
  const float high = q.kind == Quadric::Kind::Sphere ? std::min(q.zMax, q.radius) : q.zMax;
  const float area = q.kind == Quadric::Kind::Disk
                         ? 0.5f * q.phiMax * (q.radius - q.innerRadius) * (q.radius + q.innerRadius)
                         : q.radius * q.phiMax * (high - low);
  return area > 0 ? 1 / area : 0.0f;
}

// Uniform over the area in the quadric's own space.
Point3 QuadricLight::SampleLocal(const Point2& u) const {
  const Quadric& q = quadric_;
  const float r = q.radius;
  const Vector2 around = CosSinTurns(u.y * q.phiMax * (0.5f * kInvPi));
  switch (q.kind) {
    case Quadric::Kind::Disk: {
      if (q.innerRadius == 0 && q.phiMax >= 2 * kPi) {
        const Point2 disk = SampleConcentricDisk(u);
        return {r * disk.x, r * disk.y, q.zMin};
      }
      const float rho = std::sqrt(glm::mix(Sqr(q.innerRadius), Sqr(r), u.x));
      return {rho * around.x, rho * around.y, q.zMin};
    }
    case Quadric::Kind::Cylinder:
      return {r * around.x, r * around.y, glm::mix(q.zMin, q.zMax, u.x)};
    case Quadric::Kind::Sphere:
      break;
  }
  const float z = glm::mix(std::max(q.zMin, -r), std::min(q.zMax, r), u.x);
  const float rho = SafeSqrt((r - z) * (r + z));
  return {rho * around.x, rho * around.y, z};
}

Normal3 QuadricLight::LocalNormal(const Point3& p) const {
  switch (quadric_.kind) {
    case Quadric::Kind::Disk:
      return {0, 0, 1};
    case Quadric::Kind::Cylinder:
      return {p.x / quadric_.radius, p.y / quadric_.radius, 0};
    case Quadric::Kind::Sphere:
      break;
  }
  return p / quadric_.radius;
}

// The surface's texture coordinates, as the geometry gives them.
Point2 QuadricLight::UvOf(const Point3& p) const {
  const Quadric& q = quadric_;
  float phi = std::atan2(p.y, p.x);
  if (phi < 0) phi += 2 * kPi;
  const float u = std::min(phi / q.phiMax, 1.0f);
  switch (q.kind) {
    case Quadric::Kind::Disk:
      return {u, (q.radius - std::hypot(p.x, p.y)) / (q.radius - q.innerRadius)};
    case Quadric::Kind::Cylinder:
      return {u, (p.z - q.zMin) / (q.zMax - q.zMin)};
    case Quadric::Kind::Sphere:
      break;
  }
  const float low = std::acos(std::clamp(q.zMin / q.radius, -1.0f, 1.0f));
  const float high = std::acos(std::clamp(q.zMax / q.radius, -1.0f, 1.0f));
  const float theta = std::acos(std::clamp(p.z / q.radius, -1.0f, 1.0f));
  return {u, low != high ? std::clamp((theta - low) / (high - low), 0.0f, 1.0f) : 0.0f};
}

EmittingPoint QuadricLight::SamplePoint(const LightContext& context, const PlacedQuadric& placed) const {
  const Point3 p = SampleLocal(context.u);
  EmittingPoint point;
  point.position = placed.toRender.Point(p);
  point.positionError = placed.toRender.PointError(p, Gamma(8) * glm::abs(p));
  point.normal = SafeNormalize(placed.toLocal.NormalByInverse(LocalNormal(p)) * normalSign_, Normal3(0.0f));
  // Nobody looks at the coordinates of an even light.
  if (emission_.NeedsUv()) point.uv = UvOf(p);
  point.density = AreaDensity(placed, point.normal);
  return point;
}

std::optional<LightSample> QuadricLight::SampleCone(const LightContext& context, const PlacedQuadric& placed,
                                                    const SphereCone& cone) const {
  const SphereCone::Hit hit = cone.Sample(context.u);
  std::optional<LightSample> sample(std::in_place);
  sample->direction = hit.direction;
  sample->distance = hit.distance;
  sample->position = placed.toRender.translation + placed.radius * hit.normal;
  sample->positionError = Gamma(16) * (glm::abs(placed.toRender.translation) + Vector3(placed.radius));
  sample->normal = hit.normal * normalSign_;
  // One-sided and turned inside out: nothing leaves it.
  if (!(emission_.EmittedCosine(-glm::dot(sample->normal, hit.direction)) > 0)) return std::nullopt;
  if (emission_.NeedsUv()) sample->uvw = Point3(UvOf(placed.toLocal.Point(sample->position)), 0.0f);
  sample->pdfDirect = cone.Density();
  const PdfArea density = context.bidirectional ? AreaDensity(placed, sample->normal) : PdfArea(0);  // not wanted else
  if (!emission_.Complete(context, density, *sample)) sample.reset();
  return sample;
}

Color QuadricLight::PowerOf(const PlacedQuadric& placed) const {
  const double area = SamePlacement({placed.toRender, {}}, {placed_.toRender, {}})
                          ? area_
                          : GetArea(Shape(InRenderSpace(quadric_, placed)));
  if (!emission_.HasImage()) return emission_.Power(emission_.MeanRadiance(), area);
  // Uniform points of the quadric's own space, weighted by the stretch.
  constexpr int n = 64;
  Vector3d sum(0.0);
  double stretches = 0;
  for (int i = 0; i < n * n; ++i) {
    const Point3 p = SampleLocal({(static_cast<float>(i % n) + 0.5f) / n, (static_cast<float>(i / n) + 0.5f) / n});
    const Normal3 normal = SafeNormalize(placed.toLocal.NormalByInverse(LocalNormal(p)), Normal3(0, 0, 1));
    const auto stretch = static_cast<double>(AreaStretch(placed.toRender, normal));
    const Color radiance = emission_.Radiance(UvOf(p));
    sum += stretch *
           Vector3d(static_cast<double>(radiance.r), static_cast<double>(radiance.g), static_cast<double>(radiance.b));
    stretches += stretch;
  }
  sum /= stretches;
  return emission_.Power({static_cast<float>(sum.x), static_cast<float>(sum.y), static_cast<float>(sum.z)}, area);
}

EmissionBounds QuadricLight::BoundsOf(const PlacedQuadric& placed) const {
  EmissionBounds bounds;
  bounds.box = GetBounds(Shape(InRenderSpace(quadric_, placed)));
  bounds.twoSided = emission_.IsTwoSided();
  bounds.energy = PowerOf(placed).Average() * Settings().importanceMultiplier;
  if (quadric_.kind == Quadric::Kind::Disk) {
    bounds.axis = SafeNormalize(placed.toLocal.NormalByInverse(Normal3(0, 0, normalSign_)), Normal3(0, 0, 1));
    bounds.cosThetaO = 1;
  }
  return bounds;
}

}  // namespace

std::unique_ptr<Light> MakeQuadricLight(LightTypeFunction type, const ParameterList& parameters,
                                        const LightBuildContext& build, const Quadric& quadric) {
  return std::make_unique<QuadricLight>(type, parameters, build, quadric);
}

}  // namespace lampyr
