// The traceable scene: shapes and instances in, nearest hits and occlusion out. Hides Embree, and FewSurfaces, which
// replaces it in small scenes: only geometry_scene.cpp (and its private parts) includes Embree's headers.
#pragma once

#include <memory>
#include <vector>

#include "geometry/fine_line.h"
#include "geometry/ray.h"
#include "geometry/shapes.h"
#include "math/motion.h"

namespace lampyr {

// Opacity of a surface, for cut-outs. Implemented by textures.
class AlphaSource {
 public:
  virtual ~AlphaSource() = default;
  // In [0,1]; 0 lets a ray through. `position` and the geometric normal in render space.
  virtual float Alpha(const Point2& uv, const Point3& position, const Normal3& Ng) const = 0;
};

// A surface without thickness, such as a pane of thin glass: part of the incident light goes straight on, the rest is
// scattered by the surface's material. The straight part is not scattering: shadow rays, scattered rays and photons all
// transport it. Implemented by materials.
class ThinSurface {
 public:
  virtual ~ThinSurface() = default;
  // The fraction of rays that go straight on, in [0,1], at the cosine `cosTheta` > 0 to the shading normal.
  virtual float TransmittedFraction(float cosTheta) const = 0;
  // The shading normal: that of the point, unless a normal or bump map replaces it.
  virtual Normal3 NormalAt(const SurfacePoint& point) const { return point.Ns; }
  // Colour factor on the straight part, in [0,1] per channel.
  virtual Color Tint(const Point2& uv, const Point3& position, const Normal3& Ng) const = 0;
  // True if the tint is white everywhere.
  virtual bool IsClear() const = 0;
};

// Attributes of a shape. The indices are the caller's: the geometry hands them back.
struct GeometryAttributes {
  int32_t material = -1;
  int32_t light = -1;  // index of the area light that this shape is, -1 for none
  uint32_t visibility = visibility::kAll;
  uint32_t link = 0;                         // class of light linking and light filters
  std::shared_ptr<const AlphaSource> alpha;  // null: opaque
  std::shared_ptr<const ThinSurface> thin;   // null: no light goes straight on through the surface
  // Participating media inside and outside (the side of Ng); both are kSameMedium where the surface separates none.
  int32_t insideMedium = kSameMedium, outsideMedium = kSameMedium;
  // Between media alone: rays of all kinds pass straight through. A surface that separates media is a boundary for the
  // kinds of rays to which it is not visible. Where `alpha` is 0 there is no boundary. No curves and no custom
  // surfaces.
  bool isBoundary = false;
  bool isOpaque = false;  // no path goes through: the media of its sides do not bound media
  // False: uv and tangents of its points are not used, and are left at 0 where computing them costs time.
  bool isParametrized = true;
  int32_t object = -1;     // index of its name, where names are wanted
  bool isFibrous = false;  // a curve that is met from outside alone: its inside is a part of its scattering
};

// The surfaces that have a medium on a side.
struct MediumSurfaces {
  Bounds3 box;  // over the shutter, render space
  bool move = false;
  bool passesStraight = false;  // rays may pass straight through one of them
};

inline bool SeparatesMedia(const GeometryAttributes& attributes) {
  return attributes.insideMedium != kSameMedium || attributes.outsideMedium != kSameMedium;
}

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
  // Index of the first light of this instance: light indices of the object's entries are relative to it.
  int32_t firstLight = 0;
  std::shared_ptr<const Motion> motion = nullptr;  // null: static. Otherwise the transforms above are ignored
};

// Choice of the code that intersects rays. BySize: FewSurfaces for small scenes, Embree for all others.
enum class Tracer : uint8_t { BySize, Embree };

struct GeometryDescription {
  std::vector<GeometryEntry> entries;
  std::vector<GeometryObject> objects;
  std::vector<GeometryInstance> instances;
  // Embree's robust mode: no leaks along shared edges, 20-25 % slower. FewSurfaces has no leaks either way.
  bool robust = true;
  Tracer tracer = Tracer::BySize;
};

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

  // Nearest hit with t in (0, ray.tMax] on a primitive visible to one of `kinds`. False: no hit; `hit` is unchanged. A
  // ray passes cut-outs and thin surfaces with the probability of their transmittance, and boundaries between media
  // always. Sets `crossings` to the surfaces passed before the hit, in order: boundaries, and thin surfaces with their
  // tints as transmittances. Empty in scenes whose thin surfaces are all clear and that have no boundaries.
  //
  // The medium changes from crossing to crossing (Crossing::medium), by increasing t. Boundaries at equal t, up to
  // rounding, are ordered such that the ray passes from medium to medium; where several orders do, it leaves one medium
  // before it enters another. Media are set and not nested, because the edge of a thin surface may be reported twice.
  bool Trace(const Ray& ray, uint32_t kinds, RayHit& hit, std::vector<Crossing>& crossings) const;

  // The same along a line in double, which `ray` follows up to rounding: distances of the hit and of the crossings are
  // along the line, and at a start that is fine no surface within rounding behind it is hit. `hit.t` is the distance
  // along the line, rounded. The length of the line is ignored.
  LineHit Trace(const Ray& ray, const FineLine& line, uint32_t kinds, RayHit& hit,
                std::vector<Crossing>& crossings) const;

  // The same for callers that need only the product of the crossings, `tint`. A ray that is rejected (RejectedRays)
  // hits nothing and has transmittance 0.
  bool Intersect(const Ray& ray, uint32_t kinds, RayHit& hit, Color& tint) const;
  bool Intersect(const Ray& ray, uint32_t kinds, RayHit& hit) const {
    Color tint;
    return Intersect(ray, kinds, hit, tint);
  }
  // The same with the crossings that Trace lists, of which `tint` is the product.
  bool Intersect(const Ray& ray, uint32_t kinds, RayHit& hit, Color& tint, std::vector<Crossing>& crossings) const;

  // Transmittance of (0, ray.tMax): 0 behind an opaque surface; otherwise the product over all cut-outs and thin
  // surfaces, by increasing t. This is the expected value of a ray that passes by Intersect. 0 for a ray that is
  // rejected.
  Color Transmittance(const Ray& ray, uint32_t kinds) const;
  // The same with the crossings that Trace lists. Cut-outs are factors of the result, not crossings. Empty if the
  // result is 0.
  Color Transmittance(const Ray& ray, uint32_t kinds, std::vector<Crossing>& crossings) const;
  // The same along a line in double, which `ray` follows up to rounding. Where the line is fine at an end, boundaries
  // within rounding of it are crossed if they are on the line.
  Color Transmittance(const Ray& ray, const FineLine& line, uint32_t kinds, std::vector<Crossing>& crossings) const;
  bool Occluded(const Ray& ray, uint32_t kinds) const { return Transmittance(ray, kinds).IsBlack(); }

  // Position with error bound, normals, uv and tangents of a hit that `ray` made.
  SurfacePoint GetSurfacePoint(const Ray& ray, const RayHit& hit) const;

  const GeometryAttributes& Attributes(uint32_t primitive) const;
  // Index of the light at a hit, instances resolved; -1 for none.
  int32_t LightAt(uint32_t primitive, uint32_t instance) const;

  // True if some surface separates participating media (SeparatesMedia).
  bool HasBoundaries() const;
  // False: surfaces are few, and none is a curve or an instance (FewSurfaces).
  bool IsTracedByEmbree() const;
  MediumSurfaces SurfacesOf(int32_t medium) const;
  // MediumSurfaces of all media, by index, in one pass over the surfaces.
  std::vector<MediumSurfaces> SurfacesOfAll(size_t media) const;
  // Boxes of the surfaces that separate media and are not opaque, over the shutter.
  std::vector<Bounds3> BoundaryBoxes() const;
  size_t PrimitiveCount() const;             // shapes, instanced ones once
  const Bounds3& GetBounds() const;          // empty for an empty scene
  BoundingSphere GetBoundingSphere() const;  // radius 1 around 0 for an empty scene
  // Number of rejected rays: not finite, without a direction, or from beyond all bounds.
  uint64_t RejectedRays() const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace lampyr
