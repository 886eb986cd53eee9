// Random rays, simple meshes and one-shape scenes for the geometry's tests. Fixed seeds.
#pragma once

#include <functional>
#include <random>

#include "geometry/geometry_scene.h"
#include "geometry/robust.h"
#include "math/transform.h"

namespace lampyr::testing {

class Random {
 public:
  explicit Random(uint32_t seed) : engine_(seed) {}
  float Uniform() { return std::uniform_real_distribution<float>(0, 1)(engine_); }
  float Uniform(float a, float b) { return a + (b - a) * Uniform(); }
  Vector3 Direction() {
    const float z = Uniform(-1, 1), phi = Uniform(0, 2 * kPi), r = SafeSqrt(1 - z * z);
    return glm::normalize(Vector3(r * std::cos(phi), r * std::sin(phi), z));
  }
  Point3 InBox(float half) { return {Uniform(-half, half), Uniform(-half, half), Uniform(-half, half)}; }

 private:
  std::mt19937 engine_;
};

inline GeometryEntry Entry(Shape shape, std::shared_ptr<const AlphaSource> alpha = nullptr) {
  GeometryEntry entry{std::move(shape), {}};
  entry.attributes.alpha = std::move(alpha);
  return entry;
}

inline GeometryDescription SceneOf(Shape shape) {
  GeometryDescription description;
  description.entries.push_back(Entry(std::move(shape)));
  return description;
}

// A sphere of latitudes and longitudes, closed, wound outwards, displaced by a fixed noise of relative size `noise`.
inline TriangleMesh NoisySphere(uint32_t rings, float radius, const Point3& center, float noise, uint32_t seed) {
  Random random(seed);
  TriangleMesh mesh;
  const uint32_t around = 2 * rings;
  const auto add = [&](float theta, float phi) {
    const float r = radius * (1 + noise * random.Uniform(-1, 1));
    mesh.positions.push_back(
        center + Vector3(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)) * r);
  };
  add(0, 0);
  for (uint32_t i = 1; i < rings; ++i) {
    for (uint32_t j = 0; j < around; ++j) {
      add(kPi * static_cast<float>(i) / static_cast<float>(rings),
          2 * kPi * static_cast<float>(j) / static_cast<float>(around));
    }
  }
  add(kPi, 0);
  const uint32_t last = static_cast<uint32_t>(mesh.positions.size()) - 1;
  const auto at = [&](uint32_t i, uint32_t j) { return 1 + (i - 1) * around + j % around; };
  for (uint32_t j = 0; j < around; ++j) {
    mesh.triangles.push_back({0, at(1, j), at(1, j + 1)});
    mesh.triangles.push_back({last, at(rings - 1, j + 1), at(rings - 1, j)});
    for (uint32_t i = 1; i + 1 < rings; ++i) {
      mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return mesh;
}

inline Shape MeshShape(TriangleMesh mesh) {
  return std::make_shared<const TriangleMesh>(std::move(mesh));
}

// With both directions of the transform and the flip that the scene builder sets.
inline Quadric Place(Quadric quadric, const Transform& toRender, bool reverseOrientation = false) {
  quadric.toRender = toRender.ToAffine();
  quadric.toObject = toRender.Inverse().ToAffine();
  quadric.flipNormals = reverseOrientation != toRender.SwapsHandedness();
  return quadric;
}

inline Quadric Sphere(float radius) {
  Quadric q;
  q.radius = radius;
  q.zMin = -radius;
  q.zMax = radius;
  return q;
}

}  // namespace lampyr::testing
