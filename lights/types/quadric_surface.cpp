#include "lights/types/quadric_surface.h"

#include "geometry/rounding.h"
#include "math/upper_angle.h"
#include "sampling/warp.h"

namespace lampyr {

QuadricSurface::QuadricSurface(const Quadric& quadric, bool planarUv)
    : quadric_(quadric), planarUv_(planarUv), isFullSphere_(quadric.IsFullSphere()), normalSign_(OutsideSign(quadric)) {
  const bool isSphere = quadric.kind == Quadric::Kind::Sphere;
  low_ = isSphere ? std::max(quadric.zMin, -quadric.radius) : quadric.zMin;
  high_ = isSphere ? std::min(quadric.zMax, quadric.radius) : quadric.zMax;
  ownDensity_ = ComputeOwnDensity();
  const bool isWholeCylinder = quadric.kind == Quadric::Kind::Cylinder && quadric.phiMax >= 2 * kPi;
  if (!IsFlat() && !isFullSphere_ && !isWholeCylinder) mappedArea_ = MakeMappedArea();
}

PlacedSurface QuadricSurface::Place(const LightTransform& transform) const {
  PlacedSurface placed = PlacedSurface::From(quadric_.toRender, quadric_.toObject, transform);
  if (IsFlat()) placed.SetFlat({0, 0, normalSign_});
  return placed;
}

Quadric QuadricSurface::In(const PlacedSurface& placed) const {
  Quadric result = quadric_;
  result.toRender = placed.toRender;
  result.toObject = placed.toOwn;
  return result;
}

double QuadricSurface::ComputeOwnDensity() const {
  const Quadric& q = quadric_;
  // In double: intermediate products of floats may leave the range of float.
  const double wide = static_cast<double>(IsFlat() ? 0.5f * (q.radius - q.innerRadius) : q.radius);
  const double long_ = static_cast<double>(IsFlat() ? q.radius + q.innerRadius : high_ - low_);
  const double area = static_cast<double>(q.phiMax) * wide * long_;
  return area > 0 ? 1 / area : 0.0;
}

std::shared_ptr<const MappedArea> QuadricSurface::MakeMappedArea() const {
  if (!(ownDensity_ > 0)) return nullptr;
  constexpr int n = 128;
  auto area = std::make_shared<MappedArea>();
  for (int i = 0; i < n * n; ++i) {
    const Point2 square((static_cast<float>(i % n) + 0.5f) / n, (static_cast<float>(i / n) + 0.5f) / n);
    area->Add(1.0 / (n * n * ownDensity_), Vector3d(OutwardNormal(At(square))));
  }
  area->Finish();
  return area;
}

Point3 QuadricSurface::At(const Point2& square) const {
  const Quadric& q = quadric_;
  const float r = q.radius;
  if (IsConcentric()) {
    const Point2 disk = SampleConcentricDisk(square);
    return {r * disk.x, r * disk.y, q.zMin};
  }
  const Vector2 around = CosSinTurns(square.y * q.phiMax * (0.5f * kInvPi));
  switch (q.kind) {
    case Quadric::Kind::Disk: {
      const float rho = std::sqrt(glm::mix(Sqr(q.innerRadius), Sqr(r), square.x));
      return {rho * around.x, rho * around.y, q.zMin};
    }
    case Quadric::Kind::Cylinder:
      return {r * around.x, r * around.y, glm::mix(low_, high_, square.x)};
    case Quadric::Kind::Sphere:
      break;
  }
  const float z = glm::mix(low_, high_, square.x);
  const float rho = SafeSqrt((r - z) * (r + z));
  return {rho * around.x, rho * around.y, z};
}

Normal3 QuadricSurface::OutwardNormal(const Point3& p) const {
  const float scale = normalSign_ / quadric_.radius;
  switch (quadric_.kind) {
    case Quadric::Kind::Disk:
      return {0, 0, normalSign_};
    case Quadric::Kind::Cylinder:
      return {p.x * scale, p.y * scale, 0};
    case Quadric::Kind::Sphere:
      break;
  }
  return p * scale;
}

Point2 QuadricSurface::UvAt(const Point2& square, const Point3& p) const {
  const Quadric& q = quadric_;
  if (IsConcentric() || q.kind == Quadric::Kind::Sphere) {
    Point2 uv = UvOf(p);
    if (!IsConcentric()) uv.x = square.y;
    return uv;
  }
  if (q.kind == Quadric::Kind::Cylinder) return {square.y, square.x};
  return {square.y, (q.radius - std::sqrt(Sqr(p.x) + Sqr(p.y))) / (q.radius - q.innerRadius)};
}

Point2 QuadricSurface::UvOf(const Point3& p) const {
  const Quadric& q = quadric_;
  if (planarUv_) return {0.5f - 0.5f * p.x / q.radius, 0.5f + 0.5f * p.y / q.radius};
  float phi = std::atan2(p.y, p.x);
  if (phi < 0) phi += 2 * kPi;
  const float u = std::min(phi / q.phiMax, 1.0f);
  switch (q.kind) {
    case Quadric::Kind::Disk:
      return {u, (q.radius - std::hypot(p.x, p.y)) / (q.radius - q.innerRadius)};
    case Quadric::Kind::Cylinder:
      return {u, (p.z - q.zMin) / (q.zMax - q.zMin)};
    case Quadric::Kind::Sphere:
      break;
  }
  const float bottom = std::acos(std::clamp(q.zMin / q.radius, -1.0f, 1.0f));
  const float top = std::acos(std::clamp(q.zMax / q.radius, -1.0f, 1.0f));
  const float theta = std::acos(std::clamp(p.z / q.radius, -1.0f, 1.0f));
  return {u, bottom != top ? std::clamp((theta - bottom) / (top - bottom), 0.0f, 1.0f) : 0.0f};
}

Point2 QuadricSurface::SquareAt(const Point2& uv) const {
  const Quadric& q = quadric_;
  if (planarUv_) return InvertConcentricDisk({1 - 2 * uv.x, 2 * uv.y - 1});
  switch (q.kind) {
    case Quadric::Kind::Disk: {
      const float rho = glm::mix(q.radius, q.innerRadius, uv.y);
      const float span = (q.radius - q.innerRadius) * (q.radius + q.innerRadius);
      return {(rho - q.innerRadius) * (rho + q.innerRadius) / span, uv.x};
    }
    case Quadric::Kind::Cylinder:
      return {uv.y, uv.x};
    case Quadric::Kind::Sphere:
      break;
  }
  const float bottom = std::acos(std::clamp(q.zMin / q.radius, -1.0f, 1.0f));
  const float top = std::acos(std::clamp(q.zMax / q.radius, -1.0f, 1.0f));
  return {(q.radius * std::cos(glm::mix(bottom, top, uv.y)) - low_) / (high_ - low_), uv.x};
}

QuadricSurface::Arc QuadricSurface::ArcFrom(const PlacedSurface& placed, const Point3& P, bool twoSided) const {
  Arc arc;
  if (twoSided || normalSign_ < 0 || quadric_.phiMax < 2 * kPi) return arc;
  // The normal at φ faces P where cos(φ - φP) > r / |P|, whatever the transform: it keeps the sides of planes.
  const Point3 p = placed.ToOwn(P);
  const float squared = Sqr(p.x) + Sqr(p.y), r = quadric_.radius, distance = std::sqrt(squared);
  if (!(distance > r * 1.000001f) || !(distance < kInfinity)) return arc;
  arc.isThere = true;
  arc.towards = Vector2(p.x, p.y) / distance;
  arc.distance = distance;
  arc.along = p.z;
  arc.turns = std::copysign(UpperAngle(std::abs(p.y), p.x), p.y) * (0.5f * kInvPi);
  arc.halfTurns = UpperAngle(std::sqrt((distance - r) * (distance + r)), r) * (0.5f * kInvPi);
  return arc;
}

// Over the arc the density falls off like a cosine towards its ends, as the projected size of the arc does when seen
// from afar. Along the axis it is uniform in the angle at P, so that a long cylinder is sampled mostly where it is
// near.
PdfSolidAngle QuadricSurface::ArcDensity(Arc arc, SeenPoint seen) const {
  float turns = seen.uv.x - arc.turns;
  turns = std::abs(turns - std::round(turns));
  const float part = turns / arc.halfTurns;  // 1 at the ends
  if (!(part < 1)) return PdfSolidAngle(0);
  const LineView line = LineOf(arc, CosSinTurns(turns).x);
  const float density = 0.25f * kPi / arc.halfTurns * CosSinTurns(0.25f * part).x * (high_ - low_) *
                        line.Density(glm::mix(low_, high_, seen.uv.y));
  const PdfSolidAngle pdf = ToSolidAngle(seen.evenDensity * density, seen.distanceSquared, seen.outwardCosine);
  return pdf.value < kInfinity ? pdf : PdfSolidAngle(0);
}

void QuadricSurface::SampleArc(Arc arc, const PlacedSurface& placed, const Point3& P, const Point2& u,
                               LightSample& sample) const {
  // asin(2u - 1)
  const float across = 2 * u.y - 1;
  const float angle = std::copysign(UpperAngle(std::abs(across), 2 * SafeSqrt(u.y * (1 - u.y))), across);
  const float turns = 2 * kInvPi * arc.halfTurns * angle;
  const Vector2 turn = CosSinTurns(turns);
  const Vector2 around(arc.towards.x * turn.x - arc.towards.y * turn.y,
                       arc.towards.x * turn.y + arc.towards.y * turn.x);
  const Point3 p(quadric_.radius * around.x, quadric_.radius * around.y, LineOf(arc, turn.x).Sample(u.x));
  sample.position = placed.toRender.Point(p);
  sample.positionError = placed.toRender.PointError(p, Gamma(8) * Abs(p));
  sample.normal = placed.NormalAt(OutwardNormal(p));
  const float phi = arc.turns + turns;
  sample.uvw = {warp_internal::ClampUnit(phi - std::floor(phi)), (p.z - low_) / (high_ - low_), 0};
  const Vector3 toLight = sample.position - P;
  sample.distance = glm::length(toLight);
  sample.direction = sample.distance > 0 ? toLight / sample.distance : Vector3(0.0f);
}

}  // namespace lampyr
