// Bilinear patches that emit: AreaLightSource on them (patch_light.h). The parameters (u,v) of a point are drawn from a
// bilinear density that follows the area element at the four corners, and the exact density is that over
// |∂p/∂u × ∂p/∂v| ([Pharr23 §6.6.3] has the surface, the choice of density is ours).
#include "geometry/bilinear.h"

#include "geometry/rounding.h"
#include "lights/types/patch_light.h"

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

class BilinearPatches {
 public:
  explicit BilinearPatches(std::shared_ptr<const BilinearMesh> mesh);

  static constexpr bool kParametersNeedPosition = true;

  uint32_t Count() const { return static_cast<uint32_t>(weights_.size()); }
  bool CanBeSampled(uint32_t patch) const { return weights_[patch][0] > 0; }

  Point2 Sample(uint32_t patch, const Point2& u) const;
  void SetPoint(uint32_t patch, const Point2& p, bool needsUv, EmittingPoint& point) const;
  float Density(uint32_t patch, const Point2& p) const;
  Point2 ParametersOf(uint32_t patch, const Point2& uv, const Point3& position) const;

  double Area(uint32_t patch, const glm::dmat3& linear) const {
    double sum = 0;
    ForElements(patch, linear, nullptr, [&](double area, const Point2&, const Normal3&) { sum += area; });
    return sum;
  }
  template <class Function>
  void ForElements(uint32_t patch, const glm::dmat3& linear, const EmissionImage* image, const Function& f) const;
  EmissionBounds Bounds(uint32_t patch, const LightTransform& transform) const;

 private:
  using CornerWeights = std::array<float, 4>;
  std::shared_ptr<const BilinearMesh> mesh_;
  std::vector<CornerWeights> weights_;  // all above 0, or all 0 for a patch without area
};

// |∂p/∂u × ∂p/∂v|, scene units². In double, because squares of areas above 1e19 overflow float.
double ElementAt(const PatchGeometry& geometry, const Point2& p) {
  return glm::length(glm::cross(Vector3d(geometry.AlongU(p)), Vector3d(geometry.AlongV(p))));
}

BilinearPatches::BilinearPatches(std::shared_ptr<const BilinearMesh> mesh)
    : mesh_(std::move(mesh)), weights_(mesh_->patches.size()) {
  for (uint32_t i = 0; i < Count(); ++i) {
    const PatchGeometry geometry(*mesh_, i);
    std::array<double, 4> elements;
    for (size_t c = 0; c < 4; ++c) elements[c] = ElementAt(geometry, kCorners[c]);
    const double largest = *std::max_element(elements.begin(), elements.end());
    // A corner where the patch folds to a point keeps some density: the middle of its edges has area.
    for (size_t c = 0; c < 4; ++c)
      weights_[i][c] = largest > 0 ? std::max(static_cast<float>(elements[c] / largest), 0.01f) : 0.0f;
  }
}

Point2 BilinearPatches::Sample(uint32_t patch, const Point2& u) const {
  const CornerWeights& w = weights_[patch];
  Point2 p;
  p.y = SampleLinear(u.y, w[0] + w[1], w[2] + w[3]);
  p.x = SampleLinear(u.x, glm::mix(w[0], w[2], p.y), glm::mix(w[1], w[3], p.y));
  return p;
}

void BilinearPatches::SetPoint(uint32_t patch, const Point2& p, bool, EmittingPoint& point) const {
  const PatchGeometry geometry(*mesh_, patch);
  point.position = geometry.At(p);
  point.positionError = Gamma(6) * glm::max(glm::max(Abs(geometry.p00), Abs(geometry.p10)),
                                            glm::max(Abs(geometry.p01), Abs(geometry.p11)));
  point.normal = OutwardNormal(*mesh_, patch, p);
  point.uv = PatchUv(*mesh_, patch, p);  // from which a hit recovers its parameters
}

float BilinearPatches::Density(uint32_t patch, const Point2& p) const {
  const CornerWeights& w = weights_[patch];
  const double mean = 0.25 * static_cast<double>(w[0] + w[1] + w[2] + w[3]);
  const double element = ElementAt(PatchGeometry(*mesh_, patch), p);
  if (!(mean > 0) || !(element > 0)) return 0;
  const auto relative = static_cast<double>(glm::mix(glm::mix(w[0], w[1], p.x), glm::mix(w[2], w[3], p.x), p.y));
  const auto density = static_cast<float>(relative / (mean * element));
  return density < kInfinity ? density : 0.0f;
}

// Without texture coordinates of its own the patch's uv are the parameters; otherwise they follow from the position, by
// Gauss-Newton steps on |p(u,v) - position|².
Point2 BilinearPatches::ParametersOf(uint32_t patch, const Point2& uv, const Point3& position) const {
  if (mesh_->uvs.empty()) return glm::clamp(uv, Point2(0.0f), Point2(1.0f));
  const PatchGeometry geometry(*mesh_, patch);
  Point2 p(0.5f);
  for (int step = 0; step < 20; ++step) {
    const Vector3d a(geometry.AlongU(p)), b(geometry.AlongV(p)), r(position - geometry.At(p));
    const double aa = glm::dot(a, a), ab = glm::dot(a, b), bb = glm::dot(b, b), ar = glm::dot(a, r),
                 br = glm::dot(b, r);
    const double determinant = aa * bb - ab * ab;
    if (!(determinant > 1e-12 * aa * bb)) break;
    const Vector2 change((bb * ar - ab * br) / determinant, (aa * br - ab * ar) / determinant);
    p = glm::clamp(p + change, Point2(0.0f), Point2(1.0f));
    if (std::abs(change.x) + std::abs(change.y) < 1e-6f) break;
  }
  return p;
}

// Midpoint rule of 16 × 16 points.
template <class Function>
void BilinearPatches::ForElements(uint32_t patch, const glm::dmat3& linear, const EmissionImage*,
                                  const Function& f) const {
  constexpr int n = 16;
  const PatchGeometry geometry(*mesh_, patch);
  for (int i = 0; i < n * n; ++i) {
    const Point2 p((static_cast<float>(i % n) + 0.5f) / n, (static_cast<float>(i / n) + 0.5f) / n);
    const Vector3d across = linear * Vector3d(geometry.AlongU(p)), along = linear * Vector3d(geometry.AlongV(p));
    f(glm::length(glm::cross(across, along)) / (n * n), PatchUv(*mesh_, patch, p), OutwardNormal(*mesh_, patch, p));
  }
}

// |∂p/∂u × ∂p/∂v| times the normal is linear in u and in v: the four corners bound the normals.
EmissionBounds BilinearPatches::Bounds(uint32_t patch, const LightTransform& transform) const {
  const PatchGeometry geometry(*mesh_, patch);
  EmissionBounds bounds;
  for (const Point3& corner : {geometry.p00, geometry.p10, geometry.p01, geometry.p11}) {
    bounds.box.Add(transform.toRender.Point(corner));
  }
  const Normal3 middle = OutwardNormal(*mesh_, patch, Point2(0.5f));
  bounds.axis = SafeNormalize(transform.toLocal.NormalByInverse(middle), Normal3(0, 0, 1));
  bounds.cosThetaO = 1;
  bounds.cosThetaE = 0;
  for (const Point2& corner : kCorners) {
    const Normal3 local = OutwardNormal(*mesh_, patch, corner);
    if (local == Normal3(0.0f)) continue;
    const Normal3 n = SafeNormalize(transform.toLocal.NormalByInverse(local), bounds.axis);
    bounds.cosThetaO = std::min(bounds.cosThetaO, std::max(glm::dot(n, bounds.axis), -1.0f));
  }
  // Folded patches, or vertex normals that disagree about the outer side: no bound.
  if (bounds.cosThetaO <= 0) bounds.cosThetaO = -1;
  return bounds;
}

}  // namespace

std::unique_ptr<Light> MakeBilinearLight(LightTypeFunction type, const ParameterList& parameters,
                                         const LightBuildContext& build, const EmissionReader& readEmission,
                                         std::shared_ptr<const BilinearMesh> mesh) {
  return std::make_unique<PatchLight<BilinearPatches>>(type, parameters, build, BilinearPatches(std::move(mesh)),
                                                       readEmission);
}

}  // namespace lampyr
