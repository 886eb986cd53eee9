// A triangle mesh that emits (pbrt-v4's "diffuse" on triangles). Each triangle is a patch: chosen in proportion to its
// area, times the mean of the image over it where there is one; uniform over its area given the patch.
//
// The mesh lies in render space, or in an object's space when it is instanced: then the placement is applied on the
// fly, and a density of 1/m² is that of the object's space over the area's stretch at that point.
#include "geometry/rounding.h"
#include "geometry/triangle_surface.h"
#include "lights/area_lights.h"
#include "lights/estimates.h"
#include "lights/surface_emission.h"
#include "sampling/tables.h"

namespace lampyr {

namespace {

// The outer normal of a triangle at barycentrics b, in the mesh's space: the winding's, turned by flipNormals, or the
// side that the vertex normals decide. 0 for a triangle without area. The same rule as SurfacePoint::Ng.
Normal3 OutwardNormal(const TriangleMesh& mesh, uint32_t triangle, const Vector3& b) {
  const auto& t = mesh.triangles[triangle];
  const Point3 &p0 = mesh.positions[t[0]], &p1 = mesh.positions[t[1]], &p2 = mesh.positions[t[2]];
  const Normal3 winding = SafeNormalize(glm::cross(p0 - p2, p1 - p2), Normal3(0.0f));
  if (!mesh.normals.empty()) {
    const Normal3 shading = mesh.normals[t[0]] * b.x + mesh.normals[t[1]] * b.y + mesh.normals[t[2]] * b.z;
    const float cosine = glm::dot(winding, shading);
    if (cosine != 0) return cosine < 0 ? -winding : winding;
  }
  return mesh.flipNormals ? -winding : winding;
}

// Whether all of the triangle has its outside on the same side: vertex normals may disagree.
bool HasOneOutside(const TriangleMesh& mesh, uint32_t triangle) {
  if (mesh.normals.empty()) return true;
  const Normal3 n = OutwardNormal(mesh, triangle, Vector3(1.0f / 3));
  for (int i = 0; i < 3; ++i) {
    Vector3 corner(0.0f);
    corner[i] = 1;
    if (glm::dot(OutwardNormal(mesh, triangle, corner), n) < 0) return false;
  }
  return true;
}

class MeshLight final : public LightBase {
 public:
  MeshLight(LightTypeFunction type, const ParameterList& parameters, const LightBuildContext& build,
            std::shared_ptr<const TriangleMesh> mesh)
      : LightBase(type, parameters),
        mesh_(std::move(mesh)),
        built_(build.transform),
        isPlaced_(!IsIdentity(build.transform.toRender)),
        emission_(parameters, build, TotalArea(build.transform)) {
    BuildTable();
    wholeBounds_ = BoundsOfAll(built_);
  }

  LightKind Kind() const override { return LightKind::Area; }
  int PatchCount() const override { return std::max<int>(1, static_cast<int>(mesh_->triangles.size())); }

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
    EmittingPoint point;
    if (!SamplePoint(context, point)) return std::nullopt;
    return emission_.Sample(context, P, point);
  }
  std::optional<LightEvaluation> EvaluateSamples(const LightContext& context, const LightHit& hit,
                                                 const Point3&) const override {
    return emission_.Evaluate(context, hit, AreaDensity(context, static_cast<uint32_t>(hit.patchIndex), hit.normal));
  }
  std::optional<EmissionSample> GenerateEmission(const LightContext& context) const override {
    EmittingPoint point;
    if (!SamplePoint(context, point)) return std::nullopt;
    return emission_.Emit(context, point);
  }
  Color EvaluateEmissionForCamera(const LightContext&, const LightHit& hit) const override {
    return emission_.ForCamera(hit, Settings().cameraVisible);
  }

 private:
  // 1/m² in render space of a point of the triangle whose normal is `normal`: the one place where it is written.
  PdfArea AreaDensity(const LightContext& context, uint32_t triangle, const Normal3& normal) const {
    if (triangle >= inverseArea_.size() || table_.IsZero()) return PdfArea(0);
    if (context.patch != kAnyPatch && static_cast<uint32_t>(context.patch) != triangle) return PdfArea(0);
    const PdfDiscrete choice = context.patch == kAnyPatch ? table_.Probability(triangle) : PdfDiscrete(1);
    const PdfArea density = choice * PdfArea(inverseArea_[triangle]);
    return isPlaced_ ? PdfArea(density.value / AreaStretch(context.transform->toRender, normal)) : density;
  }

  // False when there is nothing to sample.
  bool SamplePoint(const LightContext& context, EmittingPoint& point) const;
  void BuildTable();
  double TriangleArea(uint32_t triangle, const LightTransform& transform) const;
  double TotalArea(const LightTransform& transform) const;
  Color MeanRadiance(uint32_t triangle) const;
  Color PowerFor(const LightContext& context) const;
  Color PowerOfAll(const LightTransform& transform) const;
  EmissionBounds BoundsFor(const LightContext& context) const;
  EmissionBounds BoundsOfOne(uint32_t triangle, const LightTransform& transform) const;
  EmissionBounds BoundsOfAll(const LightTransform& transform) const;

  std::shared_ptr<const TriangleMesh> mesh_;
  LightTransform built_;
  bool isPlaced_;  // the mesh is not in render space
  SurfaceEmission emission_;
  AliasTable table_;
  std::vector<float> inverseArea_;  // 1/m² in the mesh's space; 0 for triangles without area
  Color power_;                     // with the transform it was built with
  EmissionBounds wholeBounds_;
};

bool MeshLight::SamplePoint(const LightContext& context, EmittingPoint& point) const {
  if (table_.IsZero()) return false;
  Point2 u = context.u;
  auto triangle = static_cast<uint32_t>(context.patch);
  if (context.patch == kAnyPatch) {
    const AliasTable::Result choice = table_.Sample(u.x);
    triangle = choice.index;
    u.x = choice.u;
  }
  if (triangle >= inverseArea_.size() || inverseArea_[triangle] == 0) return false;
  const Vector3 b = SampleUniformTriangle(u);
  const auto& t = mesh_->triangles[triangle];
  const Vector3 q0 = b.x * mesh_->positions[t[0]], q1 = b.y * mesh_->positions[t[1]], q2 = b.z * mesh_->positions[t[2]];
  point.position = q0 + q1 + q2;
  point.positionError = Gamma(6) * (glm::abs(q0) + glm::abs(q1) + glm::abs(q2));
  point.normal = OutwardNormal(*mesh_, triangle, b);
  // Nobody looks at the coordinates of an even light.
  if (emission_.NeedsUv()) point.uv = TriangleUv(*mesh_, triangle, Point2(b.y, b.z));
  point.patch = static_cast<int>(triangle);
  if (isPlaced_) {
    const LightTransform& transform = *context.transform;
    point.positionError = transform.toRender.PointError(point.position, point.positionError);
    point.position = transform.toRender.Point(point.position);
    point.normal = SafeNormalize(transform.toLocal.NormalByInverse(point.normal), Normal3(0.0f));
  }
  point.density = AreaDensity(context, triangle, point.normal);
  return true;
}

double MeshLight::TriangleArea(uint32_t triangle, const LightTransform& transform) const {
  const auto p = mesh_->Corners(triangle);
  const glm::dmat3 m(transform.toRender.linear);
  const Vector3d a = m * (Point3d(p[1]) - Point3d(p[0])), b = m * (Point3d(p[2]) - Point3d(p[0]));
  return 0.5 * glm::length(glm::cross(a, b));
}

double MeshLight::TotalArea(const LightTransform& transform) const {
  double sum = 0;
  for (uint32_t i = 0; i < mesh_->triangles.size(); ++i) sum += TriangleArea(i, transform);
  return sum;
}

// Mean over the triangle, exact without an image, by stratified points about a texel apart with one.
Color MeshLight::MeanRadiance(uint32_t triangle) const {
  if (!emission_.HasImage()) return emission_.MeanRadiance();
  const EmissionImage& image = emission_.EmittedImage();
  const Point2 uv0 = TriangleUv(*mesh_, triangle, {0, 0});
  const Vector2 a = TriangleUv(*mesh_, triangle, {1, 0}) - uv0, b = TriangleUv(*mesh_, triangle, {0, 1}) - uv0;
  const float texels =
      0.5f * std::abs(a.x * b.y - a.y * b.x) * static_cast<float>(image.Width()) * static_cast<float>(image.Height());
  const int n = static_cast<int>(std::clamp(2 * std::sqrt(texels), 4.0f, 64.0f));
  Color sum;
  for (int i = 0; i < n * n; ++i) {
    const Point2 u((static_cast<float>(i % n) + 0.5f) / static_cast<float>(n),
                   (static_cast<float>(i / n) + 0.5f) / static_cast<float>(n));
    const Vector3 barycentric = SampleUniformTriangle(u);
    sum += emission_.Radiance(uv0 + a * barycentric.y + b * barycentric.z);
  }
  return sum / static_cast<float>(n * n);
}

void MeshLight::BuildTable() {
  const auto count = static_cast<uint32_t>(mesh_->triangles.size());
  // The points that estimate a mean may miss a bright texel: a part of the whole image's mean is everywhere.
  const float floor = emission_.HasImage() ? 0.01f * emission_.MeanRadiance().Average() : 0.0f;
  const LightTransform inMeshSpace;
  std::vector<float> weights(count);
  inverseArea_.resize(count);
  for (uint32_t i = 0; i < count; ++i) {
    const double localArea = TriangleArea(i, inMeshSpace);
    const bool hasNormal = LengthSquared(OutwardNormal(*mesh_, i, Vector3(1.0f / 3))) > 0.5f;
    const auto inverse = static_cast<float>(1 / localArea);
    inverseArea_[i] = hasNormal && localArea > 0 && std::isfinite(inverse) ? inverse : 0.0f;
    if (inverseArea_[i] == 0) continue;
    const double area = isPlaced_ ? TriangleArea(i, built_) : localArea;
    // Without an image the area alone: a light that is switched off can be sampled all the same.
    const float mean = emission_.HasImage() ? MeanRadiance(i).Average() + floor : 1.0f;
    weights[i] = static_cast<float>(area * static_cast<double>(mean));
  }
  table_ = AliasTable(weights);
  power_ = PowerOfAll(built_);
}

Color MeshLight::PowerOfAll(const LightTransform& transform) const {
  if (!emission_.HasImage()) return emission_.Power(emission_.MeanRadiance(), TotalArea(transform));
  double sum[3] = {0, 0, 0};
  for (uint32_t i = 0; i < mesh_->triangles.size(); ++i) {
    const Color power = emission_.Power(MeanRadiance(i), TriangleArea(i, transform));
    sum[0] += static_cast<double>(power.r);
    sum[1] += static_cast<double>(power.g);
    sum[2] += static_cast<double>(power.b);
  }
  return {static_cast<float>(sum[0]), static_cast<float>(sum[1]), static_cast<float>(sum[2])};
}

Color MeshLight::PowerFor(const LightContext& context) const {
  const LightTransform& transform = isPlaced_ ? *context.transform : built_;
  if (context.patch != kAnyPatch) {
    const auto triangle = static_cast<uint32_t>(context.patch);
    if (triangle >= mesh_->triangles.size()) return Color(0.0f);
    return emission_.Power(MeanRadiance(triangle), TriangleArea(triangle, transform));
  }
  return isPlaced_ && !SamePlacement(transform, built_) ? PowerOfAll(transform) : power_;
}

EmissionBounds MeshLight::BoundsOfOne(uint32_t triangle, const LightTransform& transform) const {
  EmissionBounds bounds;
  for (const Point3& corner : mesh_->Corners(triangle)) bounds.box.Add(transform.toRender.Point(corner));
  const Normal3 normal = OutwardNormal(*mesh_, triangle, Vector3(1.0f / 3));
  bounds.axis = SafeNormalize(transform.toLocal.NormalByInverse(normal), Normal3(0, 0, 1));
  bounds.cosThetaO = 1;
  bounds.cosThetaE = 0;
  bounds.twoSided = emission_.IsTwoSided() || !HasOneOutside(*mesh_, triangle);
  return bounds;
}

EmissionBounds MeshLight::BoundsOfAll(const LightTransform& transform) const {
  EmissionBounds whole;
  Vector3d sum(0.0);
  bool twoSided = emission_.IsTwoSided();
  for (uint32_t i = 0; i < inverseArea_.size(); ++i) {
    if (inverseArea_[i] == 0) continue;
    const EmissionBounds one = BoundsOfOne(i, transform);
    whole.box.Add(one.box);
    sum += TriangleArea(i, transform) * Vector3d(one.axis);
    twoSided = twoSided || one.twoSided;
  }
  whole.twoSided = twoSided;
  const double length = glm::length(sum);
  whole.cosThetaO = -1;
  if (length > 0) {
    whole.axis = Vector3(sum / length);
    whole.cosThetaO = 1;
    for (uint32_t i = 0; i < inverseArea_.size(); ++i) {
      if (inverseArea_[i] == 0) continue;
      whole.cosThetaO = std::min(whole.cosThetaO, glm::dot(whole.axis, BoundsOfOne(i, transform).axis));
    }
    whole.cosThetaO = std::max(whole.cosThetaO, -1.0f);
  }
  whole.energy = power_.Average() * Settings().importanceMultiplier;
  return whole;
}

EmissionBounds MeshLight::BoundsFor(const LightContext& context) const {
  const LightTransform& transform = isPlaced_ ? *context.transform : built_;
  if (context.patch == kAnyPatch) {
    return isPlaced_ && !SamePlacement(transform, built_) ? BoundsOfAll(transform) : wholeBounds_;
  }
  const auto triangle = static_cast<uint32_t>(context.patch);
  if (triangle >= inverseArea_.size() || inverseArea_[triangle] == 0) return EmissionBounds{};
  EmissionBounds bounds = BoundsOfOne(triangle, transform);
  bounds.energy = PowerFor(context).Average() * Settings().importanceMultiplier;
  return bounds;
}

}  // namespace

std::unique_ptr<Light> MakeMeshLight(LightTypeFunction type, const ParameterList& parameters,
                                     const LightBuildContext& build, std::shared_ptr<const TriangleMesh> mesh) {
  return std::make_unique<MeshLight>(type, parameters, build, std::move(mesh));
}

}  // namespace lampyr
