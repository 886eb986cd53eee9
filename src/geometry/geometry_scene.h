// The traceable scene: shapes and instances in, nearest hits and occlusion out. Embree behind a door:
// only geometry_scene.cpp (and its private parts) includes Embree's headers.
#pragma once

#include <memory>
#include <vector>

#include "geometry/ray.h"
#include "geometry/shapes.h"
#include "math/motion.h"

namespace lampyr {

// Opacity of a surface, for cut-outs. Implemented by textures.
class AlphaSource {
 public:
  virtual ~AlphaSource() = default;
  // In [0,1]; 0 lets a ray through. `position` in render space.
  virtual float Alpha(const Point2& uv, const Point3& position) const = 0;
};

// A sheet without thickness, such as thin glass: some of the light that meets it goes straight on, and the rest is up
// to the surface. What goes straight on does not meet the surface at all: it is the same light whether a shadow ray, a
// scattered ray or a photon carries it. Implemented by materials.
class SheetSource {
 public:
  virtual ~SheetSource() = default;
  // The part of rays at the cosine `cosTheta` > 0 to the shading normal that goes on, in [0,1].
  virtual float PassingPart(float cosTheta) const = 0;
  // What those are multiplied by.
  virtual Color Tint(const Point2& uv, const Point3& position) const = 0;
  // Whether that is white everywhere.
  virtual bool IsClear() const = 0;
};

// What a shape carries along. The indices mean nothing to the geometry.
struct GeometryAttributes {
  int32_t material = -1;
  int32_t light = -1;  // index of the area light that this shape is, -1 for none
  uint32_t visibility = visibility::kAll;
  uint32_t link = 0;                         // class of light linking and light filters
  std::shared_ptr<const AlphaSource> alpha;  // null: opaque
  std::shared_ptr<const SheetSource> sheet;  // null: nothing goes straight on where the surface is
};

struct GeometryEntry {
  Shape shape;
  GeometryAttributes attributes;
};

// Objects to be instanced are groups of entries in the object's own space. A CustomSurface cannot be one of them.
struct GeometryObject {
  std::vector<GeometryEntry> entries;
};

struct GeometryInstance {
  uint32_t object = 0;
  Affine toRender;
  Affine toObject;
  // Index of the first light of this instance: entry light indices of the object are relative to it.
  int32_t firstLight = 0;
  std::shared_ptr<const Motion> motion = nullptr;  // null: stays. Otherwise the transforms above are not looked at
};

struct GeometryDescription {
  std::vector<GeometryEntry> entries;
  std::vector<GeometryObject> objects;
  std::vector<GeometryInstance> instances;
  bool robust = true;  // Embree's robust mode: no leaks along shared edges, 20-25 % slower
};

// Throws an Error for a shape that cannot be traced: what is not finite, or too far out.
void CheckShape(const Shape& shape);

// Immutable after construction; all methods may be called from any thread.
//
// A ray that Embree would not survive (NaN, infinite or huge origin or direction, negative or NaN tMax) is counted and
// hits nothing.
class GeometryScene {
 public:
  explicit GeometryScene(GeometryDescription description);
  ~GeometryScene();
  GeometryScene(const GeometryScene&) = delete;
  GeometryScene& operator=(const GeometryScene&) = delete;

  // Nearest hit with t in (0, ray.tMax] on a primitive visible to one of `kinds`. False: nothing, `hit` untouched. By
  // chance, in the right proportion, the ray passes cut-outs and sheets on its way; `passed` becomes what it is
  // multiplied by for that. A ray that is rejected (RejectedRays) hits nothing and carries nothing: `passed` is 0.
  bool Intersect(const Ray& ray, uint32_t kinds, RayHit& hit, Color& passed) const;
  bool Intersect(const Ray& ray, uint32_t kinds, RayHit& hit) const {
    Color passed;
    return Intersect(ray, kinds, hit, passed);
  }

  // What is left of light after (0, ray.tMax): 0 behind something opaque, 1 where nothing is, and behind cut-outs and
  // sheets the product of what they let pass, which is the mean of what Intersect makes of it. 0 for a ray that is
  // rejected.
  Color Transmission(const Ray& ray, uint32_t kinds) const;
  // Whether that is nothing.
  bool Occluded(const Ray& ray, uint32_t kinds) const { return Transmission(ray, kinds).IsBlack(); }

  // Position with error bound, normals, uv and tangents of a hit that `ray` made.
  SurfacePoint GetSurfacePoint(const Ray& ray, const RayHit& hit) const;

  const GeometryAttributes& Attributes(uint32_t primitive) const;
  // Index of the light at a hit, instances resolved; -1 for none.
  int32_t LightAt(uint32_t primitive, uint32_t instance) const;

  size_t PrimitiveCount() const;             // shapes, instanced ones once
  const Bounds3& GetBounds() const;          // empty for an empty scene
  BoundingSphere GetBoundingSphere() const;  // radius 1 around 0 for an empty scene
  // Rays that Embree would not survive: not finite, without a direction, or from beyond all bounds.
  uint64_t RejectedRays() const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace lampyr
