// Private to the geometry: a scene of few surfaces, each of which is tested against every ray, eight at a time.
// Embree's overhead per ray exceeds the cost of these tests: it is twice as large for the walls of a room.
#pragma once

#include <memory>

struct RTCRay;
struct RTCRayHit;

namespace lampyr {

struct SceneTables;
struct TraceContext;

// Immutable after construction; all methods may be called from any thread.
//
// Triangles are intersected watertight ([Woop13]): a ray through an edge or a vertex that triangles share hits one of
// them.
class FewSurfaces {
 public:
  // The surfaces of a scene, of which `tables` outlive this. Null if there are more than a ray should be tested
  // against, or some that only Embree intersects (curves and instances).
  static std::unique_ptr<const FewSurfaces> Of(const SceneTables& tables);

  FewSurfaces(const FewSurfaces&) = delete;
  FewSurfaces& operator=(const FewSurfaces&) = delete;
  ~FewSurfaces();

  // Finds the nearest hit with t in (tnear, tfar]. Input and results are those of rtcIntersect1.
  void Intersect(RTCRayHit& rayHit, TraceContext& trace) const;
  // Sets tfar to a negative number if something stops the ray within (tnear, tfar], as rtcOccluded1 does.
  void Occlude(RTCRay& ray, TraceContext& trace) const;

 private:
  struct Blocks;
  explicit FewSurfaces(std::unique_ptr<const Blocks> blocks);

  std::unique_ptr<const Blocks> blocks_;
};

}  // namespace lampyr
