#include "suite/suite_shapes.h"

#include "geometry/quadric.h"

namespace lampyr::suite {

std::vector<NamedTransform> Transforms() {
  const Transform move = Transform::Translate({0.7, -1.3, 2.1}), turn = Transform::Rotate(50, {1, 2, -1});
  glm::dmat4 shear(1.0);
  shear[1][0] = 0.6;
  shear[2][1] = -0.4;
  return {
      {"identity", Transform()},
      {"rotated", move * turn},
      {"1e-3", turn * Transform::Scale(Vector3d(1e-3)) * move},
      {"1e3", turn * Transform::Scale(Vector3d(1e3)) * move},
      {"non-uniform", turn * Transform::Scale({2, 0.5, 1.3}) * move, false},
      {"mirrored", move * turn * Transform::Scale({-1, 1, 1})},
      {"sheared", move * Transform(shear) * turn, false},
  };
}

namespace {

// Five triangles that are not coplanar, of different sizes, one without area.
std::shared_ptr<const TriangleMesh> SuiteMesh(bool withNormals) {
  auto mesh = std::make_shared<TriangleMesh>();
  mesh->positions = {{-1, -1, 0}, {1, -1, 0.1f}, {1, 1, 0}, {-1, 1, 0.3f}, {2, 0, -0.4f}, {2.5f, 1.5f, -1}};
  mesh->triangles = {{0, 1, 2}, {0, 2, 3}, {1, 4, 2}, {0, 0, 1}, {4, 5, 2}};
  mesh->uvs = {{0, 0}, {0.6f, 0}, {0.6f, 0.8f}, {0, 0.8f}, {0.9f, 0.3f}, {1, 1}};
  // Vertex normals decide the outer side: these flip all of the surface.
  if (withNormals) mesh->normals.assign(6, Normal3(0.1f, 0, -0.9949874f));
  return mesh;
}

std::shared_ptr<const BilinearMesh> SuitePatches(bool withUvs) {
  auto mesh = std::make_shared<BilinearMesh>();
  mesh->positions = {{-1, -1, 0},         {1, -0.8f, 0.2f}, {-0.7f, 1, 0.5f},
                     {1.2f, 1.1f, -0.3f}, {2.5f, -1, 0.4f}, {2.2f, 0.9f, 0}};
  mesh->patches = {{0, 1, 2, 3}, {1, 4, 3, 5}};
  if (withUvs) mesh->uvs = {{0, 0}, {0.5f, 0.1f}, {0.1f, 1}, {0.6f, 0.9f}, {1, 0}, {1, 1}};
  return mesh;
}

Quadric MakeQuadric(Quadric::Kind kind, float radius, float zMin, float zMax, float inner, float phiMaxDegrees) {
  Quadric q;
  q.kind = kind;
  q.radius = radius;
  q.zMin = zMin;
  q.zMax = zMax;
  q.innerRadius = inner;
  q.phiMax = phiMaxDegrees >= 360 ? 2 * kPi : phiMaxDegrees * (kPi / 180);
  return q;
}

}  // namespace

std::vector<NamedShape> Shapes() {
  Quadric reversed = MakeQuadric(Quadric::Kind::Disk, 1, 0.3f, 0, 0, 360);
  reversed.flipNormals = true;
  return {
      {"mesh", SuiteMesh(false)},
      {"mesh-with-normals", SuiteMesh(true)},
      {"bilinear", SuitePatches(false)},
      {"bilinear-with-uv", SuitePatches(true)},
      {"sphere", MakeQuadric(Quadric::Kind::Sphere, 1.3f, -1.3f, 1.3f, 0, 360)},
      {"partial-sphere", MakeQuadric(Quadric::Kind::Sphere, 1, -0.4f, 0.8f, 0, 230)},
      {"disk-reversed", reversed},
      {"partial-disk", MakeQuadric(Quadric::Kind::Disk, 1.5f, 0, 0, 0.5f, 300)},
      {"cylinder", MakeQuadric(Quadric::Kind::Cylinder, 0.7f, -1, 1.5f, 0, 360)},
      {"partial-cylinder", MakeQuadric(Quadric::Kind::Cylinder, 1, 0, 1, 0, 150)},
  };
}

Shape Bake(const Shape& shape, const Transform& transform) {
  const auto points = [&](std::vector<Point3>& positions, std::vector<Normal3>& normals) {
    for (Point3& p : positions) p = Point3(transform.Point(Point3d(p)));
    for (Normal3& n : normals) n = Normal3(glm::normalize(transform.Normal(Vector3d(n))));
  };
  if (const auto* mesh = std::get_if<std::shared_ptr<const TriangleMesh>>(&shape)) {
    auto baked = std::make_shared<TriangleMesh>(**mesh);
    points(baked->positions, baked->normals);
    baked->flipNormals = baked->flipNormals != transform.SwapsHandedness();
    return std::shared_ptr<const TriangleMesh>(baked);
  }
  if (const auto* patches = std::get_if<std::shared_ptr<const BilinearMesh>>(&shape)) {
    auto baked = std::make_shared<BilinearMesh>(**patches);
    points(baked->positions, baked->normals);
    baked->flipNormals = baked->flipNormals != transform.SwapsHandedness();
    return std::shared_ptr<const BilinearMesh>(baked);
  }
  Quadric quadric = std::get<Quadric>(shape);
  quadric.toRender = transform.ToAffine();
  quadric.toObject = transform.Inverse().ToAffine();
  quadric.flipNormals = quadric.flipNormals != transform.SwapsHandedness();
  return quadric;
}

Transform ToTransform(const Affine& affine) {
  glm::dmat4 m(1.0);
  for (int c = 0; c < 3; ++c) m[c] = glm::dvec4(Vector3d(affine.linear[c]), 0.0);
  m[3] = glm::dvec4(Vector3d(affine.translation), 1.0);
  return Transform(m);
}

}  // namespace lampyr::suite
