// Bilinear patches that emit. A patch is chosen in proportion to its area; its parameters (u,v) are drawn from a
// bilinear density that follows the area element at the four corners, and the exact density is that over |∂p/∂u ×
// ∂p/∂v|
// ([Pharr23 §6.6.3] has the surface, the choice of density is ours).
#include "geometry/bilinear.h"
#include "geometry/rounding.h"
#include "lights/area_lights.h"
#include "lights/estimates.h"
#include "lights/surface_emission.h"
#include "sampling/tables.h"

namespace lampyr {

namespace {

struct PatchGeometry {
  Point3 p00, p10, p01, p11;

  PatchGeometry(const BilinearMesh& mesh, uint32_t patch) {
    const auto& q = mesh.patches[patch];
    p00 = mesh.positions[q[0]], p10 = mesh.positions[q[1]], p01 = mesh.positions[q[2]], p11 = mesh.positions[q[3]];
  }
  Point3 At(const Point2& p) const { return glm::mix(glm::mix(p00, p10, p.x), glm::mix(p01, p11, p.x), p.y); }
  Vector3 AlongU(const Point2& p) const { return glm::mix(p10 - p00, p11 - p01, p.y); }
  Vector3 AlongV(const Point2& p) const { return glm::mix(p01 - p00, p11 - p10, p.x); }
  Vector3 Cross(const Point2& p) const { return glm::cross(AlongU(p), AlongV(p)); }
};

// The outer normal at parameters p in the mesh's space, 0 where there is none. The same rule as SurfacePoint::Ng.
Normal3 OutwardNormal(const BilinearMesh& mesh, uint32_t patch, const Point2& p) {
  const Normal3 n = SafeNormalize(PatchGeometry(mesh, patch).Cross(p), Normal3(0.0f));
  if (!mesh.normals.empty()) {
    const auto& q = mesh.patches[patch];
    const Normal3 shading = glm::mix(glm::mix(mesh.normals[q[0]], mesh.normals[q[1]], p.x),
                                     glm::mix(mesh.normals[q[2]], mesh.normals[q[3]], p.x), p.y);
    const float cosine = glm::dot(n, shading);
    if (cosine != 0) return cosine < 0 ? -n : n;
  }
  return mesh.flipNormals ? -n : n;
}

constexpr Point2 kCorners[4] = {{0, 0}, {1, 0}, {0, 1}, {1, 1}};

// x in [0,1) with density proportional to mix(a, b, x).
float SampleLinear(float u, float a, float b) {
  return std::min(u * (a + b) / (a + std::sqrt(glm::mix(a * a, b * b, u))), kOneMinusEpsilon);
}

class BilinearLight final : public LightBase {
 public:
  BilinearLight(LightTypeFunction type, const ParameterList& parameters, const LightBuildContext& build,
                std::shared_ptr<const BilinearMesh> mesh)
      : LightBase(type, parameters),
        mesh_(std::move(mesh)),
        built_(build.transform),
        isPlaced_(!IsIdentity(build.transform.toRender)),
        emission_(parameters, build, TotalArea(build.transform)) {
    BuildTables();
    wholeBounds_ = BoundsOfAll(built_);
  }

  LightKind Kind() const override { return LightKind::Area; }
  int PatchCount() const override { return std::max<int>(1, static_cast<int>(mesh_->patches.size())); }

  float GetIncidentRadianceEstimate(const LightContext& context, const Point3& P) const override {
    return SurfaceIrradianceEstimate(BoundsFor(context), PowerFor(context).Average(), P);
  }
  std::optional<SegmentEstimate> GetIncidentRadianceEstimate(const LightContext& context, const Point3& origin,
                                                             const Vector3& direction, float length) const override {
    return SurfaceSegmentEstimate(BoundsFor(context), PowerFor(context).Average(), origin, direction, length);
  }
  Color GetPowerEstimate(const LightContext& context) const override { return PowerFor(context); }
  std::optional<EmissionBounds> GetEmissionBounds(const LightContext& context) const override {
    return BoundsFor(context);
  }

  std::optional<LightSample> GenerateSamples(const LightContext& context, const Point3& P) const override {
    const std::optional<EmittingPoint> point = SamplePoint(context);
    if (!point) return std::nullopt;
    return emission_.Sample(context, P, *point);
  }
  std::optional<LightEvaluation> EvaluateSamples(const LightContext& context, const LightHit& hit,
                                                 const Point3&) const override {
    const auto patch = static_cast<uint32_t>(hit.patchIndex);
    if (patch >= mesh_->patches.size()) return std::nullopt;
    return emission_.Evaluate(context, hit, AreaDensity(context, patch, ParametersOf(context, hit), hit.normal));
  }
  std::optional<EmissionSample> GenerateEmission(const LightContext& context) const override {
    const std::optional<EmittingPoint> point = SamplePoint(context);
    if (!point) return std::nullopt;
    return emission_.Emit(context, *point);
  }
  Color EvaluateEmissionForCamera(const LightContext&, const LightHit& hit) const override {
    return emission_.ForCamera(hit, Settings().cameraVisible);
  }

 private:
  using CornerWeights = std::array<float, 4>;

  // 1/m² in render space at parameters p, where the normal is `normal`: the one place where it is written.
  PdfArea AreaDensity(const LightContext& context, uint32_t patch, const Point2& p, const Normal3& normal) const {
    if (table_.IsZero() || (context.patch != kAnyPatch && static_cast<uint32_t>(context.patch) != patch))
      return PdfArea(0);
    const CornerWeights& w = weights_[patch];
    const float mean = 0.25f * (w[0] + w[1] + w[2] + w[3]);
    const float element = glm::length(PatchGeometry(*mesh_, patch).Cross(p)) *
                          (isPlaced_ ? AreaStretch(context.transform->toRender, normal) : 1.0f);
    if (!(mean > 0) || !(element > 0)) return PdfArea(0);
    const float choice = context.patch == kAnyPatch ? table_.Probability(patch).value : 1.0f;
    const float density = glm::mix(glm::mix(w[0], w[1], p.x), glm::mix(w[2], w[3], p.x), p.y) / mean;
    const PdfArea result(choice * density / element);
    return result.value < kInfinity ? result : PdfArea(0);
  }

  std::optional<EmittingPoint> SamplePoint(const LightContext& context) const;
  Point2 ParametersOf(const LightContext& context, const LightHit& hit) const;
  void BuildTables();
  // Integrals over one patch in render space by 16×16 midpoints: area, and area times radiance.
  double PatchArea(uint32_t patch, const LightTransform& transform) const;
  Color PatchPower(uint32_t patch, const LightTransform& transform) const;
  double TotalArea(const LightTransform& transform) const;
  Color PowerFor(const LightContext& context) const;
  EmissionBounds BoundsFor(const LightContext& context) const;
  EmissionBounds BoundsOfOne(uint32_t patch, const LightTransform& transform) const;
  EmissionBounds BoundsOfAll(const LightTransform& transform) const;

  std::shared_ptr<const BilinearMesh> mesh_;
  LightTransform built_;
  bool isPlaced_;  // the mesh is not in render space
  SurfaceEmission emission_;
  AliasTable table_;
  std::vector<CornerWeights> weights_;
  Color power_;
  EmissionBounds wholeBounds_;
};

constexpr int kQuadrature = 16;

template <class Function>
void ForQuadraturePoints(const Function& function) {
  for (int i = 0; i < kQuadrature * kQuadrature; ++i) {
    function(Point2((static_cast<float>(i % kQuadrature) + 0.5f) / kQuadrature,
                    (static_cast<float>(i / kQuadrature) + 0.5f) / kQuadrature));
  }
}

double BilinearLight::PatchArea(uint32_t patch, const LightTransform& transform) const {
  const PatchGeometry geometry(*mesh_, patch);
  const glm::mat3& m = transform.toRender.linear;
  double sum = 0;
  ForQuadraturePoints([&](const Point2& p) {
    sum += glm::length(glm::cross(Vector3d(m * geometry.AlongU(p)), Vector3d(m * geometry.AlongV(p))));
  });
  return sum / (kQuadrature * kQuadrature);
}

Color BilinearLight::PatchPower(uint32_t patch, const LightTransform& transform) const {
  const double area = PatchArea(patch, transform);
  if (!emission_.HasImage()) return emission_.Power(emission_.MeanRadiance(), area);
  const PatchGeometry geometry(*mesh_, patch);
  const glm::mat3& m = transform.toRender.linear;
  Color sum;
  float elements = 0;
  ForQuadraturePoints([&](const Point2& p) {
    const float element = glm::length(glm::cross(m * geometry.AlongU(p), m * geometry.AlongV(p)));
    sum += element * emission_.Radiance(PatchUv(*mesh_, patch, p));
    elements += element;
  });
  return elements > 0 ? emission_.Power(sum / elements, area) : Color(0.0f);
}

double BilinearLight::TotalArea(const LightTransform& transform) const {
  double sum = 0;
  for (uint32_t i = 0; i < mesh_->patches.size(); ++i) sum += PatchArea(i, transform);
  return sum;
}

void BilinearLight::BuildTables() {
  const auto count = static_cast<uint32_t>(mesh_->patches.size());
  const float floor = emission_.HasImage() ? 0.01f * emission_.MeanRadiance().Average() : 0.0f;
  std::vector<float> choice(count);
  weights_.resize(count);
  Vector3d power(0.0);
  for (uint32_t i = 0; i < count; ++i) {
    const PatchGeometry geometry(*mesh_, i);
    float largest = 0;
    for (int c = 0; c < 4; ++c) {
      weights_[i][static_cast<size_t>(c)] = glm::length(geometry.Cross(kCorners[c]));
      largest = std::max(largest, weights_[i][static_cast<size_t>(c)]);
    }
    // A corner where the patch folds to a point keeps some density: the middle of its edges has area.
    for (float& w : weights_[i]) w = largest > 0 ? std::max(w / largest, 0.01f) : 0.0f;
    const double area = PatchArea(i, built_);
    const Color patchPower = PatchPower(i, built_);
    const double mean = emission_.HasImage()
                            ? static_cast<double>(patchPower.Average() + emission_.Power(Color(floor), area).Average())
                            : area;
    choice[i] = largest > 0 ? static_cast<float>(mean) : 0.0f;
    power += Vector3d(static_cast<double>(patchPower.r), static_cast<double>(patchPower.g),
                      static_cast<double>(patchPower.b));
  }
  table_ = AliasTable(choice);
  power_ = {static_cast<float>(power.x), static_cast<float>(power.y), static_cast<float>(power.z)};
}

std::optional<EmittingPoint> BilinearLight::SamplePoint(const LightContext& context) const {
  if (table_.IsZero()) return std::nullopt;
  Point2 u = context.u;
  auto patch = static_cast<uint32_t>(context.patch);
  if (context.patch == kAnyPatch) {
    const AliasTable::Result choice = table_.Sample(u.x);
    patch = choice.index;
    u.x = choice.u;
  }
  if (patch >= weights_.size() || weights_[patch][0] == 0) return std::nullopt;
  const CornerWeights& w = weights_[patch];
  Point2 p;
  p.y = SampleLinear(u.y, w[0] + w[1], w[2] + w[3]);
  p.x = SampleLinear(u.x, glm::mix(w[0], w[2], p.y), glm::mix(w[1], w[3], p.y));
  const PatchGeometry geometry(*mesh_, patch);
  std::optional<EmittingPoint> point(std::in_place);
  point->position = geometry.At(p);
  point->positionError = Gamma(6) * glm::max(glm::max(glm::abs(geometry.p00), glm::abs(geometry.p10)),
                                             glm::max(glm::abs(geometry.p01), glm::abs(geometry.p11)));
  point->normal = OutwardNormal(*mesh_, patch, p);
  point->uv = PatchUv(*mesh_, patch, p);
  point->patch = static_cast<int>(patch);
  if (isPlaced_) {
    const LightTransform& transform = *context.transform;
    point->positionError = transform.toRender.PointError(point->position, point->positionError);
    point->position = transform.toRender.Point(point->position);
    point->normal = SafeNormalize(transform.toLocal.NormalByInverse(point->normal), Normal3(0.0f));
  }
  point->density = AreaDensity(context, patch, p, point->normal);
  return point;
}

// The parameters of a hit. Without texture coordinates of its own the patch's uv are the parameters; otherwise they
// follow from the position, by Gauss-Newton steps on |p(u,v) - position|².
Point2 BilinearLight::ParametersOf(const LightContext& context, const LightHit& hit) const {
  if (mesh_->uvs.empty()) return glm::clamp(hit.uv, Point2(0.0f), Point2(1.0f));
  const PatchGeometry geometry(*mesh_, static_cast<uint32_t>(hit.patchIndex));
  const Point3 position = isPlaced_ ? context.transform->toLocal.Point(hit.position) : hit.position;
  Point2 p(0.5f);
  for (int step = 0; step < 20; ++step) {
    const Vector3 a = geometry.AlongU(p), b = geometry.AlongV(p), r = position - geometry.At(p);
    const float aa = glm::dot(a, a), ab = glm::dot(a, b), bb = glm::dot(b, b), ar = glm::dot(a, r), br = glm::dot(b, r);
    const float determinant = aa * bb - ab * ab;
    if (!(determinant > 1e-12f * aa * bb)) break;
    const Vector2 change((bb * ar - ab * br) / determinant, (aa * br - ab * ar) / determinant);
    p = glm::clamp(p + change, Point2(0.0f), Point2(1.0f));
    if (std::abs(change.x) + std::abs(change.y) < 1e-6f) break;
  }
  return p;
}

Color BilinearLight::PowerFor(const LightContext& context) const {
  const LightTransform& transform = isPlaced_ ? *context.transform : built_;
  if (context.patch != kAnyPatch) {
    const auto patch = static_cast<uint32_t>(context.patch);
    return patch < mesh_->patches.size() ? PatchPower(patch, transform) : Color(0.0f);
  }
  if (SamePlacement(transform, built_)) return power_;
  Color sum;
  for (uint32_t i = 0; i < mesh_->patches.size(); ++i) sum += PatchPower(i, transform);
  return sum;
}

// |∂p/∂u × ∂p/∂v| times the normal is linear in u and in v: the four corners bound the normals.
EmissionBounds BilinearLight::BoundsOfOne(uint32_t patch, const LightTransform& transform) const {
  const PatchGeometry geometry(*mesh_, patch);
  EmissionBounds bounds;
  for (const Point3& corner : {geometry.p00, geometry.p10, geometry.p01, geometry.p11}) {
    bounds.box.Add(transform.toRender.Point(corner));
  }
  const Normal3 middle = OutwardNormal(*mesh_, patch, Point2(0.5f));
  bounds.axis = SafeNormalize(transform.toLocal.NormalByInverse(middle), Normal3(0, 0, 1));
  bounds.cosThetaO = 1;
  bounds.cosThetaE = 0;
  bounds.twoSided = emission_.IsTwoSided();
  for (const Point2& corner : kCorners) {
    const Normal3 local = OutwardNormal(*mesh_, patch, corner);
    if (local == Normal3(0.0f)) continue;
    const Normal3 n = SafeNormalize(transform.toLocal.NormalByInverse(local), bounds.axis);
    bounds.cosThetaO = std::min(bounds.cosThetaO, std::max(glm::dot(n, bounds.axis), -1.0f));
  }
  // Folded, or with vertex normals that disagree about the outside.
  if (bounds.cosThetaO <= 0) bounds.cosThetaO = -1;
  return bounds;
}

EmissionBounds BilinearLight::BoundsOfAll(const LightTransform& transform) const {
  EmissionBounds whole;
  Vector3d sum(0.0);
  whole.twoSided = emission_.IsTwoSided();
  for (uint32_t i = 0; i < mesh_->patches.size(); ++i) {
    const EmissionBounds one = BoundsOfOne(i, transform);
    whole.box.Add(one.box);
    sum += PatchArea(i, transform) * Vector3d(one.axis);
  }
  const double length = glm::length(sum);
  whole.cosThetaO = -1;
  if (length > 0) {
    whole.axis = Vector3(sum / length);
    float widest = 0;
    for (uint32_t i = 0; i < mesh_->patches.size(); ++i) {
      const EmissionBounds one = BoundsOfOne(i, transform);
      widest = std::max(widest,
                        std::acos(std::clamp(glm::dot(whole.axis, one.axis), -1.0f, 1.0f)) + std::acos(one.cosThetaO));
    }
    whole.cosThetaO = widest < kPi ? std::cos(widest) : -1.0f;
  }
  whole.energy = power_.Average() * Settings().importanceMultiplier;
  return whole;
}

EmissionBounds BilinearLight::BoundsFor(const LightContext& context) const {
  const LightTransform& transform = isPlaced_ ? *context.transform : built_;
  if (context.patch == kAnyPatch) return SamePlacement(transform, built_) ? wholeBounds_ : BoundsOfAll(transform);
  const auto patch = static_cast<uint32_t>(context.patch);
  if (patch >= mesh_->patches.size()) return EmissionBounds{};
  EmissionBounds bounds = BoundsOfOne(patch, transform);
  bounds.energy = PowerFor(context).Average() * Settings().importanceMultiplier;
  return bounds;
}

}  // namespace

std::unique_ptr<Light> MakeBilinearLight(LightTypeFunction type, const ParameterList& parameters,
                                         const LightBuildContext& build, std::shared_ptr<const BilinearMesh> mesh) {
  return std::make_unique<BilinearLight>(type, parameters, build, std::move(mesh));
}

}  // namespace lampyr
