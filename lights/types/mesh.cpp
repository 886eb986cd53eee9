// Triangle meshes that emit: AreaLightSource on triangles. Each triangle is a patch (patch_light.h), uniform over its
// area given the patch; the parameters of a point are the barycentrics (b1, b2).
#include "geometry/rounding.h"
#include "geometry/triangle_surface.h"
#include "lights/types/patch_light.h"

namespace lampyr {

namespace {

// The outer normal of a triangle at barycentrics b, in the mesh's space: that of the winding, flipped by flipNormals,
// or on the side of the vertex normals. 0 for a triangle without area. The same rule as SurfacePoint::Ng.
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

// True if the whole triangle has the same outer side; vertex normals may disagree about it.
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

class TrianglePatches {
 public:
  static constexpr bool kParametersNeedPosition = false;

  explicit TrianglePatches(std::shared_ptr<const TriangleMesh> mesh);

  uint32_t Count() const { return static_cast<uint32_t>(inverseArea_.size()); }
  bool CanBeSampled(uint32_t triangle) const { return inverseArea_[triangle] > 0; }

  Point2 Sample(uint32_t, const Point2& u) const {
    const Vector3 b = SampleUniformTriangle(u);
    return {b.y, b.z};
  }
  void SetPoint(uint32_t triangle, const Point2& p, bool needsUv, EmittingPoint& point) const;
  float Density(uint32_t triangle, const Point2&) const { return inverseArea_[triangle]; }
  Point2 ParametersOf(uint32_t, const Point2&, const Point3&) const { return Point2(0.0f); }

  double Area(uint32_t triangle, const glm::dmat3& linear) const;
  template <class Function>
  void ForElements(uint32_t triangle, const glm::dmat3& linear, const EmissionImage* image, const Function& f) const;
  EmissionBounds Bounds(uint32_t triangle, const LightTransform& transform) const;

 private:
  std::shared_ptr<const TriangleMesh> mesh_;
  std::vector<float> inverseArea_;  // 1/m² in the mesh's space; 0 for triangles without area
};

TrianglePatches::TrianglePatches(std::shared_ptr<const TriangleMesh> mesh)
    : mesh_(std::move(mesh)), inverseArea_(mesh_->triangles.size()) {
  for (uint32_t i = 0; i < Count(); ++i) {
    const double area = Area(i, glm::dmat3(1.0));
    const bool hasNormal = LengthSquared(OutwardNormal(*mesh_, i, Vector3(1.0f / 3))) > 0.5f;
    const auto inverse = static_cast<float>(1 / area);
    inverseArea_[i] = hasNormal && area > 0 && std::isfinite(inverse) ? inverse : 0.0f;
  }
}

void TrianglePatches::SetPoint(uint32_t triangle, const Point2& p, bool needsUv, EmittingPoint& point) const {
  const Vector3 b(1 - p.x - p.y, p.x, p.y);
  const auto& t = mesh_->triangles[triangle];
  const Vector3 q0 = b.x * mesh_->positions[t[0]], q1 = b.y * mesh_->positions[t[1]], q2 = b.z * mesh_->positions[t[2]];
  point.position = q0 + q1 + q2;
  point.positionError = Gamma(7) * (Abs(q0) + Abs(q1) + Abs(q2));
  point.normal = OutwardNormal(*mesh_, triangle, b);
  if (needsUv) point.uv = TriangleUv(*mesh_, triangle, p);
}

double TrianglePatches::Area(uint32_t triangle, const glm::dmat3& linear) const {
  const auto p = mesh_->Corners(triangle);
  const Vector3d a = linear * (Point3d(p[1]) - Point3d(p[0])), b = linear * (Point3d(p[2]) - Point3d(p[0]));
  return 0.5 * glm::length(glm::cross(a, b));
}

// One element without an image; with one, stratified points about a texel apart.
template <class Function>
void TrianglePatches::ForElements(uint32_t triangle, const glm::dmat3& linear, const EmissionImage* image,
                                  const Function& f) const {
  const double area = Area(triangle, linear);
  const Normal3 normal = OutwardNormal(*mesh_, triangle, Vector3(1.0f / 3));
  const Point2 uv0 = TriangleUv(*mesh_, triangle, {0, 0});
  const Vector2 a = TriangleUv(*mesh_, triangle, {1, 0}) - uv0, b = TriangleUv(*mesh_, triangle, {0, 1}) - uv0;
  if (!image) {
    f(area, uv0 + (a + b) / 3.0f, normal);
    return;
  }
  const float texels =
      0.5f * std::abs(a.x * b.y - a.y * b.x) * static_cast<float>(image->Width()) * static_cast<float>(image->Height());
  const int n = static_cast<int>(std::clamp(2 * std::sqrt(texels), 4.0f, 64.0f));
  for (int i = 0; i < n * n; ++i) {
    const Point2 u((static_cast<float>(i % n) + 0.5f) / static_cast<float>(n),
                   (static_cast<float>(i / n) + 0.5f) / static_cast<float>(n));
    const Vector3 barycentric = SampleUniformTriangle(u);
    f(area / (n * n), uv0 + a * barycentric.y + b * barycentric.z, normal);
  }
}

EmissionBounds TrianglePatches::Bounds(uint32_t triangle, const LightTransform& transform) const {
  EmissionBounds bounds;
  for (const Point3& corner : mesh_->Corners(triangle)) bounds.box.Add(transform.toRender.Point(corner));
  const Normal3 normal = OutwardNormal(*mesh_, triangle, Vector3(1.0f / 3));
  bounds.axis = SafeNormalize(transform.toLocal.NormalByInverse(normal), Normal3(0, 0, 1));
  bounds.cosThetaO = 1;
  bounds.twoSided = !HasOneOutside(*mesh_, triangle);
  return bounds;
}

}  // namespace

std::unique_ptr<Light> MakeMeshLight(LightTypeFunction type, const ParameterList& parameters,
                                     const LightBuildContext& build, const EmissionReader& readEmission,
                                     std::shared_ptr<const TriangleMesh> mesh) {
  return std::make_unique<PatchLight<TrianglePatches>>(type, parameters, build, TrianglePatches(std::move(mesh)),
                                                       readEmission);
}

}  // namespace lampyr
