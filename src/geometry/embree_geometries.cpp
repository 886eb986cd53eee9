#include "geometry/embree_geometries.h"

#include <algorithm>

#include "geometry/embree_callbacks.h"

namespace lampyr {

namespace {

// Embree loads vertices 16 bytes at a time: shared where the vector owns memory past its end, copied otherwise.
void SetVertices(RTCGeometry geometry, const std::vector<Point3>& positions) {
  if (positions.capacity() > positions.size()) {
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, positions.data(), 0,
                               sizeof(Point3), positions.size());
    return;
  }
  void* buffer =
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Point3), positions.size());
  if (buffer) std::copy(positions.begin(), positions.end(), static_cast<Point3*>(buffer));
}

RTCGeometry NewGeometry(RTCDevice device, const TriangleMesh& mesh) {
  if (mesh.triangles.empty()) return nullptr;
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  SetVertices(geometry, mesh.positions);
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, mesh.triangles.data(), 0,
                             sizeof(mesh.triangles[0]), mesh.triangles.size());
  return geometry;
}

RTCGeometry NewUserGeometry(RTCDevice device, size_t count) {
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(count));
  rtcSetGeometryBoundsFunction(geometry, SetOwnBounds, nullptr);
  rtcSetGeometryIntersectFunction(geometry, OwnIntersect);
  rtcSetGeometryOccludedFunction(geometry, OwnOccluded);
  return geometry;
}

RTCGeometry NewGeometry(RTCDevice device, const BilinearMesh& mesh) {
  if (mesh.patches.empty()) return nullptr;
  return NewUserGeometry(device, mesh.patches.size());
}

RTCGeometry NewGeometry(RTCDevice device, const PreparedQuadric&) {
  return NewUserGeometry(device, 1);
}

RTCGeometry NewGeometry(RTCDevice device, const CustomSurface& surface) {
  RTCGeometry geometry = NewUserGeometry(device, 1);
  if (surface.Moves()) rtcSetGeometryTimeStepCount(geometry, kCustomTimeSteps);
  return geometry;
}

RTCGeometryType CurveType(CurveSet::Kind kind) {
  switch (kind) {
    case CurveSet::Kind::Flat:
      return RTC_GEOMETRY_TYPE_FLAT_BEZIER_CURVE;
    case CurveSet::Kind::Cylinder:
      return RTC_GEOMETRY_TYPE_ROUND_BEZIER_CURVE;
    case CurveSet::Kind::Ribbon:
      break;
  }
  return RTC_GEOMETRY_TYPE_NORMAL_ORIENTED_BEZIER_CURVE;
}

RTCGeometry NewGeometry(RTCDevice device, const CurveSet& curves) {
  const size_t count = curves.segments.size();
  if (count == 0) return nullptr;
  RTCGeometry geometry = rtcNewGeometry(device, CurveType(curves.kind));
  auto* vertices = static_cast<glm::vec4*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, sizeof(glm::vec4), 4 * count));
  auto* indices = static_cast<uint32_t*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT, sizeof(uint32_t), count));
  const bool ribbon = curves.kind == CurveSet::Kind::Ribbon;
  auto* normals = ribbon ? static_cast<Normal3*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_NORMAL, 0,
                                                                         RTC_FORMAT_FLOAT3, sizeof(Normal3), 4 * count))
                         : nullptr;
  if (!vertices || !indices || (ribbon && !normals)) return geometry;  // reported by the device as an error
  if (curves.kind == CurveSet::Kind::Flat) rtcSetGeometryTessellationRate(geometry, CurveSet::kLinesPerFlatSegment);
  for (size_t i = 0; i < count; ++i) {
    indices[i] = static_cast<uint32_t>(4 * i);
    for (size_t k = 0; k < 4; ++k) {
      vertices[4 * i + k] = glm::vec4(curves.segments[i][k], curves.radii[i][k]);
      const float along = static_cast<float>(k) / 3.0f;
      if (ribbon) normals[4 * i + k] = glm::mix(curves.segmentNormals[i][0], curves.segmentNormals[i][1], along);
    }
  }
  return geometry;
}

void SetTransforms(RTCGeometry geometry, const InstanceRecord& instance) {
  const auto set = [&](unsigned step, const Affine& m) {
    const Vector3 columns[4] = {m.linear[0], m.linear[1], m.linear[2], m.translation};
    rtcSetGeometryTransform(geometry, step, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, columns);
  };
  const bool comesOrGoes = instance.begin > 0 || instance.end < 1;
  if (!instance.motion && !comesOrGoes) return set(0, instance.placement.toRender);
  const std::vector<Affine> stays(2, instance.placement.toRender);
  const std::vector<Affine>& keys = instance.motion ? instance.motion->Keys() : stays;
  rtcSetGeometryTimeStepCount(geometry, static_cast<unsigned>(keys.size()));
  rtcSetGeometryTimeRange(geometry, instance.begin, instance.end);
  for (size_t i = 0; i < keys.size(); ++i) set(static_cast<unsigned>(i), keys[i]);
}

}  // namespace

RTCGeometry NewGeometry(RTCDevice device, const PrimitiveRecord& record, uint32_t visibleTo) {
  RTCGeometry geometry = std::visit([&](const auto* shape) { return NewGeometry(device, *shape); }, record.shape);
  if (!geometry) return nullptr;
  rtcSetGeometryMask(geometry, visibleTo);
  rtcSetGeometryUserData(geometry, const_cast<PrimitiveRecord*>(&record));
  // User geometry handles cut-outs and thin surfaces in its own callbacks.
  if (record.LetsPass() && (record.As<TriangleMesh>() || record.As<CurveSet>())) {
    rtcSetGeometryIntersectFilterFunction(geometry, PassFilter);
    rtcSetGeometryOccludedFilterFunction(geometry, TransmitFilter);
  }
  return geometry;
}

RTCGeometry NewInstance(RTCDevice device, const InstanceRecord& instance, RTCScene object) {
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
  rtcSetGeometryInstancedScene(geometry, object);
  SetTransforms(geometry, instance);
  rtcSetGeometryMask(geometry, 0xffffffffu);
  return geometry;
}

}  // namespace lampyr
