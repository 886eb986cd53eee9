// A sky seen through a portal: light at infinity that arrives only along directions that pass through a rectangle from
// its outer side. Geometry in front of the portal or behind it occludes as usual; rays cannot hit the portal itself.
//
// Next-event estimation samples, as seen from P,
// - a constant sky: uniformly in the portal's solid angle (spherical_rectangle.h);
// - an image: in proportion to the part that is visible from P (portal_tables.h), and uniformly where that part is
//   negligible;
// - a portal that a shear has made a parallelogram: uniformly in the solid angle of the unsheared portal, with the
//   density transformed accordingly;
// - an image on such a portal, or under a placement that its tables were not built for: as a constant sky.
// Photons start uniformly on the projection of the portal, of area A cosθ, onto the plane that touches the scene's
// bounding sphere on the light's side. Their directions are sampled in proportion to radiance times cosine.
#include "lights/types/portal_light.h"

#include "lights/direction_map.h"
#include "lights/estimates.h"
#include "lights/infinite_frame.h"
#include "lights/types/portal_tables.h"
#include "lights/types/spherical_rectangle.h"

namespace lampyr {

namespace {

// Sampling of the portal from one point, and its density.
class PortalSampler {
 public:
  // `tables` may be null.
  PortalSampler(const PortalView& view, const PortalTables* tables) : view_(view) {
    if (tables && view.place.isRectangle) seen_ = tables->SeenFrom(view);
    if (seen_.share > 0) {
      tables_ = tables;
    } else {
      rectangle_.emplace(view.place.ToUpright(view.toCorner), view.place.lengthX, view.place.lengthY);
    }
  }

  bool IsZero() const { return rectangle_ && !(rectangle_->SolidAngle() > 0); }

  // Samples a point of the portal, in its (u,v).
  Point2d Sample(const Point2& u) const {
    if (!tables_) return rectangle_->Sample(u).uv;
    const Vector3d way = PortalTables::FromAxes(view_.place, tables_->Sample(seen_, u));
    const Vector3d offset = way * (view_.height / glm::dot(way, view_.place.outward)) - view_.toCorner;
    return {glm::dot(offset, view_.place.dualX), glm::dot(offset, view_.place.dualY)};
  }

  // True if Density depends on `uv`.
  bool DependsOnPlace() const { return rectangle_ && !rectangle_->IsUniform(); }
  // Density of `direction`, which passes through `uv`, in 1/sr.
  PdfSolidAngle Density(const Vector3& direction, const Point2d& uv) const {
    if (tables_) return tables_->Density(seen_, PortalTables::ToAxes(view_.place, Vector3d(direction)));
    const PdfSolidAngle density = rectangle_->Density(uv) * view_.place.UprightSolidAngleFactor(Vector3d(direction));
    return density.value < kInfinity ? density : PdfSolidAngle(0);
  }

 private:
  const PortalView& view_;
  PortalTables::Seen seen_;
  const PortalTables* tables_ = nullptr;
  std::optional<SphericalRectangle> rectangle_;  // in upright space
};

class PortalLight final : public LightBase {
 public:
  PortalLight(LightTypeFunction type, const ParameterList& parameters, const LightBuildContext& build,
              PortalDescription description)
      : LightBase(type, parameters),
        description_(std::move(description)),
        tint_(ReadLightTint(parameters)),
        built_(build.transform),
        place_(description_.shape, (description_.portalMoves ? build.transform : description_.worldToRender).toRender),
        isBlack_(description_.sky.Mean().IsBlack()) {
    if (isBlack_ || !description_.sky.image) return;
    tables_ = std::make_unique<PortalTables>(
        place_, [&](const Vector3& direction) { return Radiance(built_, direction); },
        description_.sky.Mean().Average(), description_.sky.image->Height());
  }

  LightKind Kind() const override { return LightKind::Infinite; }

  float GetIncidentRadianceEstimate(const LightContext& context, const Point3& P) const override {
    PortalPlace scratch;
    const PortalPlace& place = Place(context, scratch);
    return SurfaceIrradianceEstimate(Bounds(place), QuickPower(context, place), P);
  }
  std::optional<SegmentEstimate> GetIncidentRadianceEstimate(const LightContext& context, const Point3& origin,
                                                             const Vector3& direction, float length) const override {
    PortalPlace scratch;
    const PortalPlace& place = Place(context, scratch);
    return SurfaceSegmentEstimate(Bounds(place), QuickPower(context, place), origin, direction, length);
  }
  // Power through the portal: exact for a constant sky; for images a sum over the cells of the tables, or over a set of
  // directions without tables.
  Color GetPowerEstimate(const LightContext& context) const override {
    PortalPlace scratch;
    const PortalPlace& place = Place(context, scratch);
    const auto area = static_cast<float>(place.area);
    if (const PortalTables* tables = Tables(context)) return tables->Flux() * area;
    if (isBlack_ || !description_.sky.image) return description_.sky.Mean() * (kPi * area);
    constexpr int n = 256;
    Color sum;
    for (int i = 0; i < n * n; ++i) {
      const Point2 u((static_cast<float>(i % n) + 0.5f) / n, (static_cast<float>(i / n) + 0.5f) / n);
      const Vector3d towards = PortalTables::FromAxes(place, Vector3d(SampleCosineHemisphere(u)));
      sum += Radiance(*context.transform, Vector3(towards));
    }
    return sum * (kPi * area / (n * n));
  }
  std::optional<EmissionBounds> GetEmissionBounds(const LightContext&) const override { return std::nullopt; }

  std::optional<LightSample> GenerateSamples(const LightContext& context, const Point3& P) const override {
    PortalPlace scratch;
    const PortalView view(Place(context, scratch), P);
    if (isBlack_ || !(view.height > 0)) return std::nullopt;
    const PortalSampler sampler(view, Tables(context));
    if (sampler.IsZero()) return std::nullopt;
    Point2d uv = sampler.Sample(context.u);
    std::optional<LightSample> sample(std::in_place);
    sample->direction = view.Through(uv);
    if (!(glm::dot(Vector3d(sample->direction), view.place.outward) > 0))
      return std::nullopt;  // parallel to the portal after rounding
    // uv and density are those of the direction as rounded to float. It misses only a portal narrower than the spacing
    // of directions.
    if (sampler.DependsOnPlace()) uv = view.Meet(Vector3d(sample->direction)).value_or(uv);
    sample->pdfDirect = sampler.Density(sample->direction, uv);
    if (sample->pdfDirect.IsZero()) return std::nullopt;
    if (!tint_.Split(Radiance(*context.transform, sample->direction), *sample)) return std::nullopt;
    sample->normal = -sample->direction;
    if (context.bidirectional) SetEmission(context, view.place, sample->direction, *sample);
    return sample;
  }

  std::optional<LightEvaluation> EvaluateSamples(const LightContext& context, const LightHit& hit,
                                                 const Point3& P) const override {
    std::optional<LightEvaluation> evaluation(std::in_place);
    evaluation->normal = -hit.direction;
    PortalPlace scratch;
    const PortalView view(Place(context, scratch), P);
    const std::optional<Point2d> uv = view.Meet(Vector3d(hit.direction));
    if (isBlack_ || !uv) return evaluation;
    const PortalSampler sampler(view, Tables(context));
    if (sampler.IsZero()) return evaluation;
    evaluation->pdfDirect = sampler.Density(hit.direction, *uv);
    tint_.Split(Radiance(*context.transform, hit.direction), *evaluation);
    if (context.bidirectional) SetEmission(context, view.place, hit.direction, *evaluation);
    return evaluation;
  }

  // Its photons come through the portal.
  bool CanBeAimed() const override { return false; }

  std::optional<EmissionSample> GenerateEmission(const LightContext& context) const override {
    if (isBlack_) return std::nullopt;
    PortalPlace scratch;
    const PortalPlace& place = Place(context, scratch);
    const Vector3 toLight = EmissionDirection(context, place);
    EmissionSample sample;
    SetEmission(context, place, toLight, sample);
    if (sample.pdfEmit.IsZero() || sample.pdfEmitDirection.IsZero()) return std::nullopt;
    if (!tint_.Split(Radiance(*context.transform, toLight), sample)) return std::nullopt;
    const double radius = static_cast<double>(context.scene.radius);
    const Point3d center(context.scene.center), middle = place.At({0.5, 0.5});
    const Vector3d way(toLight);
    // Keeps a margin to the portal's edge, the rounding error of positions along the ray, so that each of them sees the
    // ray pass through the portal.
    const double rounding =
        0x1p-21 * (glm::length(center) + glm::length(middle - center) + 4 * radius + place.lengthX + place.lengthY);
    const Point2d uv = place.Inside(Point2d(context.uDirection), rounding / glm::dot(way, place.outward));
    // Moves from a point of the portal along the ray to the tangent plane of the sphere, in front of the portal or
    // behind it.
    const Vector3d offset = place.At(uv) - center;
    const double back = radius - glm::dot(offset, way);
    const Vector3 start(offset + way * back);
    sample.position = context.scene.center + start;
    sample.positionError = EmissionDiskError(context.scene) + 0x1p-21f * Abs(start);
    sample.direction = sample.normal = -toLight;
    sample.shinesFrom = static_cast<float>(std::max(back, 0.0));
    return sample;
  }

  Color EvaluateEmissionForCamera(const LightContext& context, const LightHit& hit) const override {
    PortalPlace scratch;
    const PortalView view(Place(context, scratch), hit.position);
    if (!Settings().cameraVisible || !view.Meet(Vector3d(hit.direction))) return Color(0.0f);
    return Radiance(*context.transform, hit.direction);
  }

 private:
  const LightTransform& SkyTransform(const LightTransform& light) const {
    return description_.portalMoves ? description_.worldToRender : light;
  }
  Color Radiance(const LightTransform& light, const Vector3& direction) const {
    return description_.sky.Radiance(ToLocalDirection(SkyTransform(light), direction));
  }

  bool IsTurnedAsBuilt(const LightContext& context) const {
    return context.transform->toRender.linear == built_.toRender.linear;
  }
  const PortalTables* Tables(const LightContext& context) const {
    return tables_ && IsTurnedAsBuilt(context) ? tables_.get() : nullptr;
  }
  const PortalPlace& Place(const LightContext& context, PortalPlace& scratch) const {
    if (!description_.portalMoves ||
        (IsTurnedAsBuilt(context) && context.transform->toRender.translation == built_.toRender.translation)) {
      return place_;
    }
    scratch = PortalPlace(description_.shape, context.transform->toRender);
    return scratch;
  }

  // Bounds of a flat surface of the same size that emits the light that passes through.
  static EmissionBounds Bounds(const PortalPlace& place) {
    EmissionBounds bounds;
    for (int i = 0; i < 4; ++i) bounds.box.Add(Point3(place.At({i & 1 ? 1 : 0, i & 2 ? 1 : 0})));
    bounds.axis = -Vector3(place.outward);
    bounds.cosThetaO = 1;
    return bounds;
  }

  float QuickPower(const LightContext& context, const PortalPlace& place) const {
    const PortalTables* tables = Tables(context);
    const float power = tables ? tables->Flux().Average() : kPi * description_.sky.Mean().Average();
    // Positive for any sky that is not black: the tables may have missed light that passes through the portal.
    return (isBlack_ ? 0.0f : std::max(power, 1e-3f * description_.sky.Mean().Average())) *
           static_cast<float>(place.area);
  }

  Vector3 EmissionDirection(const LightContext& context, const PortalPlace& place) const {
    const PortalTables* tables = Tables(context);
    const Vector3d inAxes = tables ? tables->SampleEmission(context.u) : Vector3d(SampleCosineHemisphere(context.u));
    return Vector3(glm::normalize(PortalTables::FromAxes(place, inAxes)));
  }

  // Densities of a photon that arrives from `toLight`. All methods that report them call this.
  template <class Result>
  void SetEmission(const LightContext& context, const PortalPlace& place, const Vector3& toLight,
                   Result& result) const {
    const Vector3d inAxes = PortalTables::ToAxes(place, Vector3d(toLight));
    const PortalTables* tables = Tables(context);
    result.pdfEmit = place.EmissionDensity(inAxes.z);
    result.pdfEmitDirection =
        tables ? tables->EmissionDensity(inAxes) : CosineHemispherePdf(static_cast<float>(inAxes.z));
    if constexpr (requires { result.solidAngleToArea; }) result.solidAngleToArea = 1;
  }

  PortalDescription description_;
  LightTint tint_;
  LightTransform built_;
  PortalPlace place_;  // as built
  bool isBlack_;
  std::unique_ptr<PortalTables> tables_;  // for images
};

}  // namespace

std::unique_ptr<Light> MakePortalLight(LightTypeFunction type, const ParameterList& parameters,
                                       const LightBuildContext& build, PortalDescription description) {
  return std::make_unique<PortalLight>(type, parameters, build, std::move(description));
}

}  // namespace lampyr
