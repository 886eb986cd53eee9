// Area lights as the ray tracer finds them: what uniform rays from a point collect, by the traced surface's own
// position, normal and uv, equals what light sampling estimates; for mirrored and instanced shapes too.
#include <gtest/gtest.h>

#include <cmath>

#include "geometry/geometry_scene.h"
#include "light_fixture.h"
#include "sampling/rng.h"
#include "sampling/warp.h"

namespace lampyr {
namespace {

struct Traced {
  double fluence = 0, fluenceError = 0, integral = 0;
};

GeometryDescription Describe(const Shape& shape, const Transform& instance, bool isInstance) {
  GeometryDescription description;
  GeometryEntry entry{shape, {}};
  entry.attributes.light = 0;
  if (!isInstance) {
    description.entries.push_back(entry);
    return description;
  }
  description.objects.push_back({{entry}});
  description.instances.push_back({0, instance.ToAffine(), instance.Inverse().ToAffine(), 0});
  return description;
}

Traced Trace(const test::BuiltLight& built, const GeometryScene& scene, const Point3& P) {
  constexpr int n = 200000;
  Rng rng(1);
  Traced traced;
  double squares = 0;
  for (int i = 0; i < n; ++i) {
    const Ray ray{P, SampleUniformSphere(rng.NextPoint2()), kInfinity, 0};
    RayHit hit;
    if (!scene.Intersect(ray, visibility::kAll, hit)) continue;
    const SurfacePoint point = scene.GetSurfacePoint(ray, hit);
    LightHit lightHit;
    lightHit.direction = ray.direction;
    lightHit.distance = hit.t;
    lightHit.position = point.position;
    lightHit.normal = point.Ng;
    lightHit.uv = point.uv;
    lightHit.patchIndex = static_cast<int>(point.patch);
    const auto e = built.light->EvaluateSamples(built.context, lightHit, P);
    if (!e) continue;
    const double x = static_cast<double>(e->diffuse.g * 4 * kPi);
    traced.fluence += x / n;
    squares += x * x / n;
    traced.integral += static_cast<double>(e->pdfDirect.value * 4 * kPi) / n;
  }
  traced.fluenceError = std::sqrt(std::max(squares - traced.fluence * traced.fluence, 0.0) / n);
  return traced;
}

void ExpectAgreement(const Shape& shape, const Transform& placement, bool isInstance, bool twoSided, const Point3& P,
                     bool shines, const std::string& what) {
  const auto built =
      test::Build("diffuse", twoSided ? "\"bool twosided\" true" : "", isInstance ? placement : Transform(), &shape);
  const GeometryScene scene(Describe(shape, placement, isInstance));
  const Traced traced = Trace(*built, scene, P);
  Rng rng(2);
  double sum = 0, squares = 0, found = 0;
  constexpr int n = 20000;
  for (int i = 0; i < n; ++i) {
    built->context.u = rng.NextPoint2();
    const auto s = built->light->GenerateSamples(built->context, P);
    if (!s) continue;
    const double x = static_cast<double>(s->diffuse.g / s->pdfDirect.value);
    sum += x / n;
    squares += x * x / n;
    found += 1.0 / n;
  }
  const double error = std::sqrt(std::max(squares - sum * sum, 0.0) / n + traced.fluenceError * traced.fluenceError);
  EXPECT_NEAR(sum, traced.fluence, 5 * error + 1e-3 * sum) << what;
  EXPECT_NEAR(found, traced.integral, 5 * error / std::max(sum, 1e-9) * found + 5e-3) << what;
  EXPECT_EQ(traced.fluence > 0, shines) << what;
}

TEST(TracedLights, QuadricsMirroredAndInstanced) {
  const Transform move = Transform::Translate({0.2, -0.3, 1.5}) * Transform::Rotate(30, {1, 1, 0});
  for (const bool mirrored : {false, true}) {
    const Transform placement = move * Transform::Scale({mirrored ? -1.0 : 1.0, 1, 1});
    for (const bool isInstance : {false, true}) {
      const std::string what = std::string(mirrored ? "mirrored" : "plain") + (isInstance ? " instance" : "");
      Quadric sphere = std::get<Quadric>(test::Sphere(0.8f, isInstance ? Transform() : placement));
      if (mirrored && !isInstance) sphere.flipNormals = true;  // as the scene builder does
      ExpectAgreement(sphere, placement, isInstance, false, Point3(0, 0, -1), true, "sphere " + what);
      Quadric disk = sphere;
      disk.kind = Quadric::Kind::Disk;
      disk.zMin = 0;
      ExpectAgreement(disk, placement, isInstance, false, Point3(0, 0.5f, 4), true, "disk " + what);
      ExpectAgreement(disk, placement, isInstance, false, Point3(0, 0, -1), false, "disk from behind " + what);
    }
  }
}

TEST(TracedLights, MeshesWithNormalsAndTwoSides) {
  const Transform placement = Transform::Translate({0.1, 0.2, 1}) * Transform::Scale({1.4, -0.7, 1.1});
  for (const bool flip : {false, true}) {
    for (const bool withNormals : {false, true}) {
      auto mesh = test::Square(1.5f);
      mesh->flipNormals = flip;
      if (withNormals) mesh->normals.assign(4, Normal3(0, 0.1f, -0.99f));
      const Shape shape = test::AsShape(mesh);
      const bool up = withNormals ? false : !flip;
      const std::string what = std::string(flip ? "flipped" : "plain") + (withNormals ? " normals" : "");
      for (const bool isInstance : {false, true}) {
        const float height = isInstance ? 1.0f : 0.0f;
        ExpectAgreement(shape, placement, isInstance, false, Point3(0.2f, 0.1f, height + 0.8f), up, what + " above");
        ExpectAgreement(shape, placement, isInstance, false, Point3(0.2f, 0.1f, height - 0.8f), !up, what + " below");
        ExpectAgreement(shape, placement, isInstance, true, Point3(0.2f, 0.1f, height - 0.8f), true,
                        what + " two-sided");
      }
    }
  }
}

TEST(TracedLights, BilinearPatchesWithTheirOwnUv) {
  auto mesh = std::make_shared<BilinearMesh>();
  mesh->positions = {{-1, -1, 0}, {1, -0.8f, 0.2f}, {-0.7f, 1, 0.3f}, {1.2f, 1.1f, -0.2f}};
  mesh->patches = {{0, 1, 2, 3}};
  for (const bool withUvs : {false, true}) {
    if (withUvs) mesh->uvs = {{0.2f, 0}, {2, 0.1f}, {0.1f, 1}, {1.6f, 0.9f}};
    const Shape shape = std::shared_ptr<const BilinearMesh>(std::make_shared<BilinearMesh>(*mesh));
    ExpectAgreement(shape, Transform(), false, false, Point3(0.3f, 0.1f, 1.2f), true, "bilinear");
    ExpectAgreement(shape, Transform::Scale({1, 2, -1}), true, true, Point3(0.3f, 0.1f, 1.2f), true,
                    "bilinear instance");
  }
}

}  // namespace
}  // namespace lampyr
