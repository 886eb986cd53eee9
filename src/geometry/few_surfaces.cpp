// See few_surfaces.h. Compiled without contraction of products and sums: the two triangles at an edge must find the
// same point on the same side of it.
#include "geometry/few_surfaces.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <span>

#include "geometry/meeting.h"
#include "math/bounds.h"

#if defined(__AVX__)
#include <immintrin.h>
#endif

namespace lampyr {

namespace {

constexpr uint32_t kLanes = 8;
// Largest numbers of surfaces that are tested one by one. Measured in a room of 14 triangles and a sphere, with boxes
// and spheres in it, path, the whole render, relative to Embree: 1.45 times as fast in the empty room, 1.2 times with
// 38 and with 62 triangles, no significant difference with 110; 1.3 times with 16 spheres, 1.1 times with 64.
constexpr size_t kMostTriangles = 64, kMostOthers = 32;
// Up to this number, blocks of triangles are tested without testing their bounds first.
constexpr size_t kBlocksWithoutBounds = 3;
constexpr float kLargest = std::numeric_limits<float>::max();

using Floats = float __attribute__((vector_size(kLanes * sizeof(float))));
using Lanes = int32_t __attribute__((vector_size(kLanes * sizeof(int32_t))));  // -1: true

inline Floats All(float x) {
  return x - Floats{};
}

// The lesser argument; the second one where either is NaN.
inline Floats Min(const Floats& a, const Floats& b) {
#if defined(__AVX__)
  return _mm256_min_ps(a, b);
#else
  return a < b ? a : b;
#endif
}

inline Floats Max(const Floats& a, const Floats& b) {
#if defined(__AVX__)
  return _mm256_max_ps(a, b);
#else
  return a > b ? a : b;
#endif
}

inline Floats MultiplyAdd(const Floats& a, const Floats& b, const Floats& c) {
#if defined(__FMA__)
  return _mm256_fmadd_ps(a, b, c);
#else
  return a * b + c;
#endif
}

// The lanes that are true, as bits.
inline uint32_t Bits(const Lanes& lanes) {
#if defined(__AVX__)
  return static_cast<uint32_t>(_mm256_movemask_ps(reinterpret_cast<const __m256&>(lanes)));
#else
  uint32_t bits = 0;
  for (uint32_t i = 0; i < kLanes; ++i) bits |= lanes[i] ? 1u << i : 0u;
  return bits;
#endif
}

inline float Least(const Floats& x) {
  const Floats two = Min(x, __builtin_shufflevector(x, x, 4, 5, 6, 7, 0, 1, 2, 3));
  const Floats four = Min(two, __builtin_shufflevector(two, two, 2, 3, 0, 1, 6, 7, 4, 5));
  return std::min(four[0], four[1]);
}

// Removes the lowest bit and returns its index.
inline uint32_t TakeLowest(uint32_t& bits) {
  const auto lowest = static_cast<uint32_t>(std::countr_zero(bits));
  bits &= bits - 1;
  return lowest;
}

// Origin of a triangle. Whole: a triangle of a mesh. RightHalf: p00, p10, p11 of a bilinear patch that is a
// parallelogram; LeftHalf: its p00, p11, p01.
enum class Part : uint8_t { Whole, RightHalf, LeftHalf };

// Eight triangles. Lanes without one are visible to no ray.
struct TriangleBlock {
  Floats corners[3][3] = {};  // by corner and axis
  Floats normals[3] = {};     // by axis; unit, or 0 without an area
  Lanes visible = {};         // kinds of rays
  uint32_t primitives[kLanes] = {}, patches[kLanes] = {};
  Part parts[kLanes] = {};
  bool letsPass = false;  // for at least one lane

  // The hit's coordinates (RayHit) for barycentric coordinates of a triangle.
  Point2 Coordinates(uint32_t lane, float b1, float b2) const {
    if (parts[lane] == Part::Whole) return {b1, b2};
    const float both = std::min(b1 + b2, 1.0f);
    return parts[lane] == Part::RightHalf ? Point2(both, b2) : Point2(b1, both);
  }
};

// Slightly enlarged bounds of eight objects.
struct BoxBlock {
  Floats planes[2][3] = {};  // least and largest coordinates, by axis
  Lanes visible = {};
};

// A quadric, a patch of a bilinear mesh or a custom surface.
struct OtherSurface {
  uint32_t primitive, patch;
};

// A ray, prepared for both tests. The edge test of triangles works in a space in which the ray starts at 0 and runs
// along the z axis.
struct FewRay {
  float origin[3], direction[3], inverse[3];
  bool isNegative[3];
  uint32_t x, y, z;  // axes: z is the one along which the direction is longest
  float shearX, shearY;
  int32_t kinds;

  explicit FewRay(const RTCRay& ray)
      : origin{ray.org_x, ray.org_y, ray.org_z},
        direction{ray.dir_x, ray.dir_y, ray.dir_z},
        kinds(static_cast<int32_t>(ray.mask)) {
    for (int i = 0; i < 3; ++i) {
      inverse[i] = 1 / (direction[i] + 0.0f);  // -0 counts as 0
      isNegative[i] = direction[i] < 0;
    }
    // Without branches, which would be mispredicted.
    constexpr uint32_t kNext[3] = {1, 2, 0};
    const float size[3] = {std::abs(direction[0]), std::abs(direction[1]), std::abs(direction[2])};
    const auto longer = static_cast<uint32_t>(size[1] > size[0]);
    z = longer + (2 - longer) * static_cast<uint32_t>(size[2] > size[longer]);
    x = kNext[z];
    y = kNext[x];
    shearX = direction[x] / direction[z];
    shearY = direction[y] / direction[z];
  }
};

struct TriangleHits {
  Lanes isHit;         // with t in (tnear, farthest]
  Floats t;            // along the ray
  Floats along;        // of the direction along the normal
  Floats u, v, whole;  // barycentric coordinates are u / whole, v / whole
};

inline TriangleHits IntersectBlock(const TriangleBlock& block, const FewRay& ray, const Floats& tnear,
                                   const Floats& farthest) {
  Floats x[3], y[3];
  for (int i = 0; i < 3; ++i) {
    const Floats z = block.corners[i][ray.z] - ray.origin[ray.z];
    x[i] = MultiplyAdd(All(-ray.shearX), z, block.corners[i][ray.x] - ray.origin[ray.x]);
    y[i] = MultiplyAdd(All(-ray.shearY), z, block.corners[i][ray.y] - ray.origin[ray.y]);
  }
  // Twice the signed areas that the axis spans with the edges: their signs are the sides of the edges on which the ray
  // passes. The other triangle at an edge gets exactly the negative value, and all triangles at a corner get the same
  // position of that corner.
  TriangleHits hits;
  const Floats rest = x[2] * y[1] - y[2] * x[1];
  hits.u = x[0] * y[2] - y[0] * x[2];
  hits.v = x[1] * y[0] - y[1] * x[0];
  hits.whole = rest + hits.u + hits.v;
  // The distance to the plane is exact to a few roundings of the coordinates, at any angle; the distance to the point
  // with these barycentric coordinates would not be.
  Floats fromPlane = {};
  hits.along = Floats{};
  for (int axis = 0; axis < 3; ++axis) {
    fromPlane = MultiplyAdd(block.corners[0][axis] - ray.origin[axis], block.normals[axis], fromPlane);
    hits.along = MultiplyAdd(All(ray.direction[axis]), block.normals[axis], hits.along);
  }
  hits.t = fromPlane / hits.along;
  hits.isHit = ((Min(Min(rest, hits.u), hits.v) >= 0.0f) | (Max(Max(rest, hits.u), hits.v) <= 0.0f)) &
               (hits.whole != 0.0f) & (hits.t > tnear) & (hits.t <= farthest) & ((block.visible & ray.kinds) != 0);
  return hits;
}

// The boxes that (0, tfar] of the ray passes through. Sets `near` to the entry points.
inline uint32_t IntersectBoxes(const BoxBlock& block, const FewRay& ray, float tfar, Floats& near) {
  constexpr float kWider = 1 + 0x1p-20f;  // more than the products round
  Floats far = All(tfar);
  near = Floats{};
  for (int i = 0; i < 3; ++i) {
    near = Max((block.planes[ray.isNegative[i]][i] - ray.origin[i]) * ray.inverse[i], near);
    far = Min((block.planes[!ray.isNegative[i]][i] - ray.origin[i]) * ray.inverse[i], far);
  }
  far *= kWider;
  return Bits((near <= far) & ((block.visible & ray.kinds) != 0));
}

struct Triangle {
  Point3 corners[3];
  uint32_t primitive, patch;
  Part part = Part::Whole;

  Point3 Center() const { return (corners[0] + corners[1] + corners[2]) / 3.0f; }
};

Vector3 NormalOf(const Triangle& triangle) {
  const Point3d corner(triangle.corners[0]);
  const Vector3d normal = glm::cross(Point3d(triangle.corners[1]) - corner, Point3d(triangle.corners[2]) - corner);
  const double length = glm::length(normal);
  return length > 0 ? Vector3(normal / length) : Vector3(0.0f);
}

// Half of the surface of a box.
float HalfArea(const Bounds3& bounds) {
  const Vector3 size = bounds.max - bounds.min;
  return size.x * size.y + size.y * size.z + size.z * size.x;
}

void SortAlong(int axis, std::span<Triangle> triangles) {
  std::stable_sort(triangles.begin(), triangles.end(),
                   [&](const Triangle& a, const Triangle& b) { return a.Center()[axis] < b.Center()[axis]; });
}

struct Split {
  float cost = kInfinity;
  size_t first = 0;  // triangles of the first part
};

// The split of sorted triangles into two groups of blocks with the least cost: the expected number of blocks that a ray
// hits, in proportion to the surface area of their bounds.
Split BestSplit(std::span<const Triangle> sorted) {
  std::vector<float> before(sorted.size() + 1);
  Bounds3 bounds;
  for (size_t i = 0; i < sorted.size(); ++i) {
    before[i] = HalfArea(bounds);
    for (const Point3& corner : sorted[i].corners) bounds.Add(corner);
  }
  Split best;
  bounds = {};
  for (size_t i = sorted.size() - 1; i > 0; --i) {
    for (const Point3& corner : sorted[i].corners) bounds.Add(corner);
    if (i % kLanes != 0) continue;
    const auto blocksBefore = static_cast<float>(i / kLanes),
               blocksAfter = static_cast<float>((sorted.size() - i + kLanes - 1) / kLanes);
    const float cost = before[i] * blocksBefore + HalfArea(bounds) * blocksAfter;
    if (cost < best.cost) best = {cost, i};
  }
  return best;
}

// Sorts triangles such that few rays hit the bounds of each group of eight.
void Cluster(std::span<Triangle> triangles) {
  if (triangles.size() <= kLanes) return;
  Split best;
  int axis = 0;
  for (int i = 0; i < 3; ++i) {
    SortAlong(i, triangles);
    const Split split = BestSplit(triangles);
    if (split.cost < best.cost) {
      best = split;
      axis = i;
    }
  }
  if (best.first == 0) best.first = kLanes;  // areas beyond the range of float
  SortAlong(axis, triangles);
  Cluster(triangles.first(best.first));
  Cluster(triangles.subspan(best.first));
}

// Enlarges the box: rounding must not make a ray miss it where the ray hits the contents.
void SetBox(const Bounds3& bounds, uint32_t visible, uint32_t lane, BoxBlock& block) {
  const float wider = 0x1p-20f * std::max(MaxAbsComponent(bounds.min), MaxAbsComponent(bounds.max));
  for (int i = 0; i < 3; ++i) {
    block.planes[0][i][lane] = bounds.min[i] - wider;
    block.planes[1][i][lane] = bounds.max[i] + wider;
  }
  block.visible[lane] = static_cast<int32_t>(visible);
}

}  // namespace

struct FewSurfaces::Blocks {
  const SceneTables& tables;
  std::vector<TriangleBlock> triangles;
  std::vector<BoxBlock> triangleBoxes;  // of the blocks; none if there are few
  std::vector<OtherSurface> others;
  std::vector<BoxBlock> otherBoxes;
  bool letsPass = false;  // some triangle may

  void AddTriangles(std::span<const Triangle> added);
  void AddOther(const OtherSurface& other);
  Meeting MeetingWith(uint32_t primitive, uint32_t patch) const {
    return {tables.primitives[primitive], primitive, patch, RTC_INVALID_GEOMETRY_ID};
  }
  Meeting OtherAt(size_t i) const { return MeetingWith(others[i].primitive, others[i].patch); }
  // The lanes of `hits` in which the ray is stopped.
  Lanes Stopped(const TriangleBlock& block, const TriangleHits& hits, const RTCRay& ray, TraceContext& trace,
                bool isShadow) const;
  // `kLetsPass`: some triangle may let rays pass. Without it no function is called, and vectors stay in registers.
  template <bool kLetsPass>
  void IntersectTriangles(const FewRay& ray, RTCRayHit& rayHit, TraceContext& trace) const;
  template <bool kLetsPass>
  bool OccludeTriangles(const FewRay& ray, const RTCRay& shadowRay, TraceContext& trace) const;
};

void FewSurfaces::Blocks::AddTriangles(std::span<const Triangle> added) {
  TriangleBlock& block = triangles.emplace_back();
  Bounds3 bounds;
  uint32_t allVisible = 0;
  for (uint32_t lane = 0; lane < added.size(); ++lane) {
    const Triangle& triangle = added[lane];
    const Vector3 normal = NormalOf(triangle);
    for (int axis = 0; axis < 3; ++axis) block.normals[axis][lane] = normal[axis];
    for (int corner = 0; corner < 3; ++corner) {
      bounds.Add(triangle.corners[corner]);
      for (int axis = 0; axis < 3; ++axis) block.corners[corner][axis][lane] = triangle.corners[corner][axis];
    }
    const PrimitiveRecord& record = tables.primitives[triangle.primitive];
    const uint32_t visible = VisibleTo(record, tables.attributes[triangle.primitive]);
    block.visible[lane] = static_cast<int32_t>(visible);
    allVisible |= visible;
    block.primitives[lane] = triangle.primitive;
    block.patches[lane] = triangle.patch;
    block.parts[lane] = triangle.part;
    block.letsPass = block.letsPass || record.LetsPass();
    letsPass = letsPass || record.LetsPass();
  }
  const auto lane = static_cast<uint32_t>((triangles.size() - 1) % kLanes);
  if (lane == 0) triangleBoxes.emplace_back();
  SetBox(bounds, allVisible, lane, triangleBoxes.back());
}

void FewSurfaces::Blocks::AddOther(const OtherSurface& other) {
  const auto lane = static_cast<uint32_t>(others.size() % kLanes);
  if (lane == 0) otherBoxes.emplace_back();
  others.push_back(other);
  const PrimitiveRecord& record = tables.primitives[other.primitive];
  SetBox(OwnBounds(record, other.patch), VisibleTo(record, tables.attributes[other.primitive]), lane,
         otherBoxes.back());
}

inline Lanes FewSurfaces::Blocks::Stopped(const TriangleBlock& block, const TriangleHits& hits, const RTCRay& ray,
                                          TraceContext& trace, bool isShadow) const {
  if (!block.letsPass) return hits.isHit;
  Lanes stopped = hits.isHit;
  for (uint32_t bits = Bits(hits.isHit); bits != 0;) {
    const uint32_t lane = TakeLowest(bits);
    Meeting at = MeetingWith(block.primitives[lane], block.patches[lane]);
    // The sides that Embree's callbacks set, so that the random numbers of cut-outs, and with them the picture, do not
    // depend on the tracer.
    at.side = block.parts[lane] == Part::Whole && hits.along[lane] > 0;
    const Point2 uv = block.Coordinates(lane, hits.u[lane] / hits.whole[lane], hits.v[lane] / hits.whole[lane]);
    const RayHit hit{hits.t[lane], at.geometryId, at.patch, at.instanceId, uv.x, uv.y};
    if (at.record.LetsPass() && PassesThrough(at, ray, hit, trace, isShadow)) stopped[lane] = 0;
  }
  return stopped;
}

namespace {

// True for a patch whose parameters are affine on it, up to the rounding of its corners.
bool IsParallelogram(const BilinearMesh& mesh, uint32_t patch) {
  const auto& p = mesh.patches[patch];
  Vector3d difference(0.0);
  Vector3 largest(0.0f);
  for (size_t i = 0; i < 4; ++i) {
    difference += (i == 0 || i == 3 ? 1.0 : -1.0) * Vector3d(mesh.positions[p[i]]);
    largest = glm::max(largest, Abs(mesh.positions[p[i]]));
  }
  for (int axis = 0; axis < 3; ++axis)
    if (!(std::abs(difference[axis]) <= 0x1p-22 * static_cast<double>(largest[axis]))) return false;
  return true;
}

// Collects the surfaces outside of instances, until there are too many.
struct Surfaces {
  std::vector<Triangle> triangles;
  std::vector<OtherSurface> others;
  bool hasCurves = false;

  explicit Surfaces(std::span<const PrimitiveRecord> records) {
    for (uint32_t i = 0; i < records.size() && !AreTooMany(); ++i) Add(records[i], i);
  }
  // Also true for kinds that only Embree intersects.
  bool AreTooMany() const { return hasCurves || triangles.size() > kMostTriangles || others.size() > kMostOthers; }

 private:
  void Add(const PrimitiveRecord& record, uint32_t primitive) {
    if (const auto* mesh = record.As<TriangleMesh>()) {
      const size_t enough = std::min<size_t>(mesh->triangles.size(), kMostTriangles + 1);
      for (uint32_t k = 0; k < enough; ++k) {
        const auto corners = mesh->Corners(k);
        triangles.push_back({{corners[0], corners[1], corners[2]}, primitive, k});
      }
    } else if (const auto* patches = record.As<BilinearMesh>()) {
      const size_t enough = std::min<size_t>(patches->patches.size(), kMostTriangles + 1);
      for (uint32_t k = 0; k < enough; ++k) AddPatch(*patches, primitive, k);
    } else if (record.As<CurveSet>()) {
      hasCurves = true;
    } else {
      others.push_back({primitive, 0});
    }
  }

  void AddPatch(const BilinearMesh& mesh, uint32_t primitive, uint32_t patch) {
    if (!IsParallelogram(mesh, patch)) return others.push_back({primitive, patch});
    const auto& i = mesh.patches[patch];
    const Point3 &p00 = mesh.positions[i[0]], &p10 = mesh.positions[i[1]], &p01 = mesh.positions[i[2]],
                 &p11 = mesh.positions[i[3]];
    triangles.push_back({{p00, p10, p11}, primitive, patch, Part::RightHalf});
    triangles.push_back({{p00, p11, p01}, primitive, patch, Part::LeftHalf});
  }
};

}  // namespace

std::unique_ptr<const FewSurfaces> FewSurfaces::Of(const SceneTables& tables) {
  if (!tables.instances.empty()) return nullptr;
  Surfaces surfaces({tables.primitives.data(), tables.firstInstanceId});
  if (surfaces.AreTooMany()) return nullptr;
  auto blocks = std::make_unique<Blocks>(Blocks{tables, {}, {}, {}, {}, false});
  const std::span all(surfaces.triangles);
  Cluster(all);
  for (size_t first = 0; first < all.size(); first += kLanes)
    blocks->AddTriangles(all.subspan(first, std::min<size_t>(kLanes, all.size() - first)));
  if (blocks->triangles.size() <= kBlocksWithoutBounds) blocks->triangleBoxes.clear();
  for (const OtherSurface& other : surfaces.others) blocks->AddOther(other);
  return std::unique_ptr<const FewSurfaces>(new FewSurfaces(std::move(blocks)));
}

FewSurfaces::FewSurfaces(std::unique_ptr<const Blocks> blocks) : blocks_(std::move(blocks)) {}
FewSurfaces::~FewSurfaces() = default;

template <bool kLetsPass>
void FewSurfaces::Blocks::IntersectTriangles(const FewRay& ray, RTCRayHit& rayHit, TraceContext& trace) const {
  // The nearest hit of each lane.
  Floats t = All(std::min(rayHit.ray.tfar, kLargest)), u = {}, v = {}, whole = {};
  Lanes block = Lanes{} - 1;
  const Floats tnear = All(rayHit.ray.tnear);
  const auto intersect = [&](size_t i) __attribute__((always_inline)) {
    const TriangleHits hits = IntersectBlock(triangles[i], ray, tnear, t);
    const Lanes isHit = kLetsPass ? Stopped(triangles[i], hits, rayHit.ray, trace, false) : hits.isHit;
    t = isHit ? hits.t : t;
    u = isHit ? hits.u : u;
    v = isHit ? hits.v : v;
    whole = isHit ? hits.whole : whole;
    block = isHit ? Lanes{} + static_cast<int32_t>(i) : block;
    return isHit;
  };
  if (triangleBoxes.empty()) {
    for (size_t i = 0; i < triangles.size(); ++i) intersect(i);
  }
  float nearest = rayHit.ray.tfar;
  for (size_t first = 0; first < triangleBoxes.size(); ++first) {
    Floats near;
    for (uint32_t bits = IntersectBoxes(triangleBoxes[first], ray, nearest, near); bits != 0;) {
      const uint32_t lane = TakeLowest(bits);
      if (near[lane] <= nearest && Bits(intersect(kLanes * first + lane)) != 0) nearest = Least(t);
    }
  }
  const Lanes isHit = block >= 0;
  if (Bits(isHit) == 0) return;
  rayHit.ray.tfar = Least(t);
  uint32_t bits = Bits(isHit & (t == rayHit.ray.tfar));
  const uint32_t lane = TakeLowest(bits);
  const TriangleBlock& found = triangles[static_cast<size_t>(block[lane])];
  const Point2 uv = found.Coordinates(lane, u[lane] / whole[lane], v[lane] / whole[lane]);
  rayHit.hit.u = uv.x;
  rayHit.hit.v = uv.y;
  rayHit.hit.primID = found.patches[lane];
  rayHit.hit.geomID = found.primitives[lane];
  rayHit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
}

template <bool kLetsPass>
bool FewSurfaces::Blocks::OccludeTriangles(const FewRay& ray, const RTCRay& shadowRay, TraceContext& trace) const {
  const Floats tnear = All(shadowRay.tnear), tfar = All(std::min(shadowRay.tfar, kLargest));
  const auto isStopped = [&](size_t i) __attribute__((always_inline)) {
    const TriangleHits hits = IntersectBlock(triangles[i], ray, tnear, tfar);
    return Bits(kLetsPass ? Stopped(triangles[i], hits, shadowRay, trace, true) : hits.isHit) != 0;
  };
  if (triangleBoxes.empty()) {
    for (size_t i = 0; i < triangles.size(); ++i)
      if (isStopped(i)) return true;
  }
  for (size_t first = 0; first < triangleBoxes.size(); ++first) {
    Floats near;
    for (uint32_t bits = IntersectBoxes(triangleBoxes[first], ray, shadowRay.tfar, near); bits != 0;)
      if (isStopped(kLanes * first + TakeLowest(bits))) return true;
  }
  return false;
}

void FewSurfaces::Intersect(RTCRayHit& rayHit, TraceContext& trace) const {
  const Blocks& blocks = *blocks_;
  const FewRay ray(rayHit.ray);
  if (!blocks.triangles.empty()) {
    if (blocks.letsPass) [[unlikely]]
      blocks.IntersectTriangles<true>(ray, rayHit, trace);
    else
      blocks.IntersectTriangles<false>(ray, rayHit, trace);
  }
  for (size_t first = 0; first < blocks.otherBoxes.size(); ++first) {
    Floats near;
    for (uint32_t bits = IntersectBoxes(blocks.otherBoxes[first], ray, rayHit.ray.tfar, near); bits != 0;) {
      const uint32_t lane = TakeLowest(bits);
      if (near[lane] <= rayHit.ray.tfar) IntersectOwn(blocks.OtherAt(kLanes * first + lane), rayHit, trace);
    }
  }
}

void FewSurfaces::Occlude(RTCRay& shadowRay, TraceContext& trace) const {
  const Blocks& blocks = *blocks_;
  const FewRay ray(shadowRay);
  bool isStopped =
      !blocks.triangles.empty() && (blocks.letsPass ? blocks.OccludeTriangles<true>(ray, shadowRay, trace)
                                                    : blocks.OccludeTriangles<false>(ray, shadowRay, trace));
  for (size_t first = 0; first < blocks.otherBoxes.size() && !isStopped; ++first) {
    Floats near;
    for (uint32_t bits = IntersectBoxes(blocks.otherBoxes[first], ray, shadowRay.tfar, near); bits != 0 && !isStopped;)
      isStopped = OccludesOwn(blocks.OtherAt(kLanes * first + TakeLowest(bits)), shadowRay, trace);
  }
  if (isStopped) shadowRay.tfar = -kInfinity;
}

}  // namespace lampyr
