#include "geometry/fine_distance.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/bilinear.h"

namespace lampyr {

namespace {

constexpr double kInfinityDouble = std::numeric_limits<double>::infinity();

Point3d Transformed(const Affine& map, const Point3d& p) {
  return glm::dmat3(map.linear) * p + Point3d(map.translation);
}

// Distance to the plane of a triangle. NaN or infinite for a line in the plane.
double PlaneDistance(const TriangleMesh& mesh, uint32_t triangle, const RayDouble& ray) {
  const auto& t = mesh.triangles[triangle];
  const Point3d p0(mesh.positions[t[0]]), p1(mesh.positions[t[1]]), p2(mesh.positions[t[2]]);
  const Vector3d normal = glm::cross(p1 - p0, p2 - p0);
  return glm::dot(normal, p0 - ray.origin) / glm::dot(normal, ray.direction);
}

// The one of two hits that is nearer to `about`, or NaN.
template <class Hit>
double Nearest(const Hit* hits, int count, double about) {
  double nearest = std::numeric_limits<double>::quiet_NaN();
  for (int i = 0; i < count; ++i) {
    if (!(std::abs(hits[i].t - about) >= std::abs(nearest - about))) nearest = hits[i].t;
  }
  return nearest;
}

double DistanceTo(const PrimitiveRecord& record, uint32_t patch, const RayDouble& ray, double about) {
  if (const TriangleMesh* mesh = record.As<TriangleMesh>()) return PlaneDistance(*mesh, patch, ray);
  if (const PreparedQuadric* quadric = record.As<PreparedQuadric>()) {
    QuadricHit hits[2];
    return Nearest(hits, quadric->Intersect(ray, hits), about);
  }
  if (const BilinearMesh* mesh = record.As<BilinearMesh>()) {
    PatchHit hits[2];
    return Nearest(hits, IntersectPatch(*mesh, patch, ray, hits), about);
  }
  return about;
}

}  // namespace

double FineDistance(const SceneTables& tables, const FineLine& line, float time, const RayHit& hit, double about) {
  RayDouble ray{line.start, line.direction, -kInfinityDouble, kInfinityDouble};
  if (hit.instance != kNoIndex) {
    const InstanceRecord& instance = tables.instances[hit.instance];
    const Affine toObject =
        instance.motion ? PlacementAt(*instance.motion, time).toObject : instance.placement.toObject;
    ray.origin = Transformed(toObject, line.start);
    ray.direction = glm::dmat3(toObject.linear) * line.direction;
  }
  const double fine = DistanceTo(tables.primitives[hit.primitive], hit.patch, ray, about);
  // The distance to the plane is useless for a line that grazes the triangle.
  constexpr double kMost = 1e-4;
  const double size = std::max({std::abs(line.start.x), std::abs(line.start.y), std::abs(line.start.z)});
  return std::abs(fine - about) <= kMost * (std::abs(about) + size) ? fine : about;
}

void RefineCrossings(const SceneTables& tables, const FineLine& line, float time, double ahead,
                     std::vector<Crossing>& crossings) {
  for (Crossing& crossing : crossings) {
    const RayHit hit{0, crossing.primitive, crossing.patch, crossing.instance};
    crossing.t = FineDistance(tables, line, time, hit, crossing.t - ahead);
  }
  std::erase_if(crossings, [&](const Crossing& crossing) {
    return (line.isFineAtStart && !(crossing.t > 0)) || (line.isFineAtEnd && !(crossing.t < line.length));
  });
  for (Crossing& crossing : crossings) crossing.t = std::clamp(crossing.t, 0.0, line.length);
}

}  // namespace lampyr
