// See curves.h.
#include "geometry/curves.h"

#include "geometry/rounding.h"
#include "math/frame.h"

namespace lampyr {

namespace {

using Segment = std::array<Point3d, 4>;

// Degree elevation of a quadratic Bézier segment.
Segment Elevate(const Point3d& a, const Point3d& b, const Point3d& c) {
  return {a, (a + b * 2.0) / 3.0, (b * 2.0 + c) / 3.0, c};
}

Segment BezierSegment(const std::vector<Point3d>& p, size_t i, int degree) {
  if (degree == 2) return Elevate(p[2 * i], p[2 * i + 1], p[2 * i + 2]);
  return {p[3 * i], p[3 * i + 1], p[3 * i + 2], p[3 * i + 3]};
}

// Uniform B-spline to Bézier, by blossoming.
Segment BSplineSegment(const std::vector<Point3d>& p, size_t i, int degree) {
  if (degree == 2) return Elevate((p[i] + p[i + 1]) * 0.5, p[i + 1], (p[i + 1] + p[i + 2]) * 0.5);
  const Point3d &a = p[i], &b = p[i + 1], &c = p[i + 2], &d = p[i + 3];
  return {(a + b * 4.0 + c) / 6.0, (b * 2.0 + c) / 3.0, (b + c * 2.0) / 3.0, (b + c * 4.0 + d) / 6.0};
}

void Check(const CurveParameters& p) {
  if (p.degree != 2 && p.degree != 3) throw Error(p.where, "curve: the degree must be 2 or 3");
  for (const Point3& point : p.points) {
    if (!IsFinite(point)) throw Error(p.where, "curve: a control point is not finite");
  }
  for (const float width : {p.width0, p.width1}) {
    if (!(width >= 0) || !std::isfinite(width)) throw Error(p.where, "curve: a width is negative or not finite");
  }
}

size_t CountSegments(const CurveParameters& p) {
  Check(p);
  const size_t degree = static_cast<size_t>(p.degree), count = p.points.size();
  if (p.basis == CurveParameters::Basis::BSpline) {
    if (count >= degree + 1) return count - degree;
  } else if (count >= degree + 1 && (count - 1) % degree == 0) {
    return (count - 1) / degree;
  }
  throw Error(p.where, "curve: " + std::to_string(count) + " control points do not make " +
                           (p.basis == CurveParameters::Basis::BSpline ? "a B-spline" : "Bézier segments") +
                           " of degree " + std::to_string(p.degree));
}

// The direction across a ribbon in its own plane, unit; 0 where the normal is along the curve.
Vector3 AcrossRibbon(const Vector3& along, const Normal3& normal) {
  constexpr float kLeastSine = 1e-3f;
  const Vector3 across = glm::cross(Vector3(normal), along);
  return LengthSquared(across) < kLeastSine * kLeastSine ? Vector3(0.0f) : glm::normalize(across);
}

// Normals of both ends of each segment. A normal along the curve has no meaning, and Embree would leave out the
// segment: the ribbon is continued then from the nearest end whose normal has one, such that the direction across it
// turns as little as it can. Without such an end that direction is arbitrary at the first one.
std::vector<std::array<Normal3, 2>> NormalsAcross(const std::vector<std::array<Normal3, 2>>& normals,
                                                  const CurveSet& curves) {
  const size_t count = 2 * normals.size();  // ends of segments, in order along the curve
  std::vector<Vector3> along(count), across(count);
  for (size_t i = 0; i < count; ++i) {
    const Vector3 tangent = CurveTangent(curves, static_cast<uint32_t>(i / 2), i % 2 == 0 ? 0.0f : 1.0f);
    along[i] = SafeNormalize(tangent, Vector3(0.0f, 0.0f, 1.0f));
    across[i] = AcrossRibbon(along[i], normals[i / 2][i % 2]);
  }
  const auto isKnown = [&](size_t i) { return LengthSquared(across[i]) > 0; };
  std::vector<Vector3> taken = across;
  if (std::none_of(across.begin(), across.end(), [](const Vector3& a) { return LengthSquared(a) > 0; }))
    taken.assign(count, Frame::FromNormal(Normal3(along[0])).x);
  // From the nearest known end before, and then from that behind if it is nearer.
  std::vector<size_t> distance(count, count);
  for (size_t i = 0; i < count; ++i) {
    if (isKnown(i)) distance[i] = 0;
    if (i > 0 && !isKnown(i) && distance[i - 1] < count) taken[i] = taken[i - 1], distance[i] = distance[i - 1] + 1;
  }
  for (size_t i = count - 1; i-- > 0;) {
    if (distance[i + 1] + 1 < distance[i]) taken[i] = taken[i + 1], distance[i] = distance[i + 1] + 1;
  }
  std::vector<std::array<Normal3, 2>> result(count / 2);
  for (size_t i = 0; i < count; ++i) {
    const Vector3 normal = glm::cross(along[i], taken[i]);
    Normal3& own = result[i / 2][i % 2];
    own = isKnown(i)                      ? normals[i / 2][i % 2]
          : LengthSquared(normal) > 1e-6f ? Normal3(glm::normalize(normal))
                                          : Frame::FromNormal(Normal3(along[i])).x;
  }
  return result;
}

// Normals of a ribbon at both ends of its segments, which are not divided yet, in render space. Throws Error.
std::vector<std::array<Normal3, 2>> PlacedNormals(const CurveParameters& p, const CurveSet& whole) {
  const size_t segments = whole.segments.size();
  if (p.normals.size() != segments + 1) {
    throw Error(p.where, "curve: a ribbon of " + std::to_string(segments) + " segments needs " +
                             std::to_string(segments + 1) + " normals, not " + std::to_string(p.normals.size()));
  }
  std::vector<Normal3> normals;
  for (const Normal3& n : p.normals) {
    const Vector3d transformed = p.toRender.Normal(Vector3d(n));
    const double length = glm::length(transformed);
    if (!(length > 0) || !std::isfinite(length)) throw Error(p.where, "curve: a normal is zero or not finite");
    normals.push_back(Vector3(transformed / length));
  }
  std::vector<std::array<Normal3, 2>> ofEnds;
  for (size_t i = 0; i < segments; ++i) ofEnds.push_back({normals[i], normals[i + 1]});
  return NormalsAcross(ofEnds, whole);
}

// Angle between two vectors in radians; 0 if one of them vanishes.
double AngleBetween(const Vector3d& a, const Vector3d& b) {
  return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

// Number of parts of a ribbon's segment. Embree makes the edges of each from its ends alone: within a part neither the
// tangent nor the normal may turn far.
int PartsOfRibbon(const Segment& b, double turnOfNormal) {
  constexpr double kMostTurn = 0.25;  // radians: the edges then deviate by 1e-5 of the width
  constexpr int kMostParts = 64;
  // The control polygon turns at least as far as the curve. Legs without length have no direction.
  double turn = 0;
  std::optional<Vector3d> before;
  for (size_t k = 0; k < 3; ++k) {
    const Vector3d leg = b[k + 1] - b[k];
    if (!(glm::length(leg) > 0)) continue;
    if (before) turn += AngleBetween(*before, leg);
    before = leg;
  }
  return static_cast<int>(std::clamp(std::ceil(std::max(turn, turnOfNormal) / kMostTurn), 1.0, double(kMostParts)));
}

// Number of parts of a flat segment for which Embree's lines deviate by at most 1 % of `radius`: n lines deviate by at
// most max |B''| / (8 n²).
int PartsOfFlat(const Segment& b, double radius) {
  if (!(radius > 0)) return 1;
  constexpr double kTolerance = 0.01;
  constexpr int kMostParts = 256;
  const double second = 6 * std::max(glm::length(b[0] - 2.0 * b[1] + b[2]), glm::length(b[1] - 2.0 * b[2] + b[3]));
  constexpr double kRounding = 1e-6;  // control points are floats
  if (!(second > kRounding * (glm::length(b[3] - b[0]) + glm::length(b[2] - b[1])))) return 1;
  const double lines = std::sqrt(second / (8 * kTolerance * radius));
  return static_cast<int>(std::clamp(std::ceil(lines / CurveSet::kLinesPerFlatSegment), 1.0, double(kMostParts)));
}

// The radius relative to which a segment has to be accurate: for a pointed one, a tenth of the wide end's.
double ThinnestOf(double a, double b) {
  return std::max(std::min(a, b), 0.1 * std::max(a, b));
}

// The part [u0,u1] of a segment, by blossoming.
Segment PartOf(const Segment& b, double u0, double u1) {
  const auto blossom = [&](double r, double s, double t) {
    const auto mix = [](const Point3d& p, const Point3d& q, double u) { return p * (1 - u) + q * u; };
    const Point3d p01 = mix(b[0], b[1], r), p12 = mix(b[1], b[2], r), p23 = mix(b[2], b[3], r);
    return mix(mix(p01, p12, s), mix(p12, p23, s), t);
  };
  return {blossom(u0, u0, u0), blossom(u0, u0, u1), blossom(u0, u1, u1), blossom(u1, u1, u1)};
}

// The segments of a curve in render space, before they are divided. Throws Error.
class PlacedCurve {
 public:
  explicit PlacedCurve(const CurveParameters& p)
      : parameters_(p),
        count_(CountSegments(p)),
        scale_(std::cbrt(std::abs(glm::determinant(glm::dmat3(p.toRender.Matrix()))))) {
    for (const Point3& point : p.points) points_.push_back(p.toRender.Point(Point3d(point)));
  }

  size_t Count() const { return count_; }
  Segment At(size_t i) const {
    const bool bezier = parameters_.basis == CurveParameters::Basis::Bezier;
    return bezier ? BezierSegment(points_, i, parameters_.degree) : BSplineSegment(points_, i, parameters_.degree);
  }
  // Half width at u of segment i. Control values in equal steps interpolate linearly.
  double RadiusAt(size_t i, double u) const {
    const double along = (static_cast<double>(i) + u) / static_cast<double>(count_);
    return 0.5 * scale_ *
           (static_cast<double>(parameters_.width0) * (1 - along) + static_cast<double>(parameters_.width1) * along);
  }
  // The number of parts that a segment is divided into.
  int PartsOf(size_t i, const Segment& segment) const {
    if (parameters_.kind == CurveSet::Kind::Cylinder) return 1;
    if (parameters_.kind == CurveSet::Kind::Flat)
      return PartsOfFlat(segment, ThinnestOf(RadiusAt(i, 0), RadiusAt(i, 1)));
    if (parameters_.normals.size() != count_ + 1) return 1;  // an error, when the normals are read
    const auto placed = [&](size_t joint) { return parameters_.toRender.Normal(Vector3d(parameters_.normals[joint])); };
    return PartsOfRibbon(segment, AngleBetween(placed(i), placed(i + 1)));
  }

 private:
  const CurveParameters& parameters_;
  const size_t count_;
  const double scale_;  // of widths
  std::vector<Point3d> points_;
};

}  // namespace

size_t CountDividedSegments(const CurveParameters& p) {
  const PlacedCurve curve(p);
  size_t count = 0;
  for (size_t i = 0; i < curve.Count(); ++i) count += static_cast<size_t>(curve.PartsOf(i, curve.At(i)));
  return count;
}

CurveSet MakeCurves(const CurveParameters& p) {
  const PlacedCurve curve(p);
  CurveSet curves;
  curves.kind = p.kind;
  const bool isRibbon = p.kind == CurveSet::Kind::Ribbon;
  std::vector<std::array<Normal3, 2>> given, normals;  // of segments as given, and of their parts
  if (isRibbon) {
    CurveSet whole;
    for (size_t i = 0; i < curve.Count(); ++i) {
      const Segment segment = curve.At(i);
      whole.segments.push_back({Point3(segment[0]), Point3(segment[1]), Point3(segment[2]), Point3(segment[3])});
    }
    given = PlacedNormals(p, whole);
  }
  for (size_t i = 0; i < curve.Count(); ++i) {
    const Segment segment = curve.At(i);
    const int parts = curve.PartsOf(i, segment);
    for (int part = 0; part < parts; ++part) {
      const double u0 = static_cast<double>(part) / parts, u1 = static_cast<double>(part + 1) / parts;
      const Segment controls = parts > 1 ? PartOf(segment, u0, u1) : segment;
      auto& placed = curves.segments.emplace_back();
      auto& radii = curves.radii.emplace_back();
      for (size_t k = 0; k < 4; ++k) {
        placed[k] = Point3(controls[k]);
        radii[k] = static_cast<float>(curve.RadiusAt(i, u0 + (u1 - u0) * static_cast<double>(k) / 3));
      }
      curves.uRange.push_back({static_cast<float>(u0), static_cast<float>(u1)});
      if (!isRibbon) continue;
      const auto at = [&](double u) {
        return SafeNormalize(glm::mix(given[i][0], given[i][1], static_cast<float>(u)), Normal3(0.0f));
      };
      normals.push_back({at(u0), at(u1)});
    }
  }
  if (isRibbon) curves.segmentNormals = NormalsAcross(normals, curves);
  return curves;
}

Point3 CurveAxis(const CurveSet& curves, uint32_t segment, float u) {
  const auto& c = curves.segments[segment];
  const float w = 1 - u;
  return c[0] * (w * w * w) + c[1] * (3 * u * w * w) + c[2] * (3 * u * u * w) + c[3] * (u * u * u);
}

Vector3 CurveTangent(const CurveSet& curves, uint32_t segment, float u) {
  const auto& c = curves.segments[segment];
  const float w = 1 - u;
  const Vector3 tangent = (c[1] - c[0]) * (3 * w * w) + (c[2] - c[1]) * (6 * u * w) + (c[3] - c[2]) * (3 * u * u);
  return LengthSquared(tangent) > 0 ? tangent : c[3] - c[0];
}

float CurveRadius(const CurveSet& curves, uint32_t segment, float u) {
  const auto& r = curves.radii[segment];
  const float w = 1 - u;
  return r[0] * (w * w * w) + r[1] * (3 * u * w * w) + r[2] * (3 * u * u * w) + r[3] * (u * u * u);
}

namespace {

Vector3 Perpendicular(const Vector3& v, const Vector3& axis) {
  return v - axis * glm::dot(v, axis);
}

// The unit normal at a point `offset` from the axis that runs along the unit `along`.
Normal3 CurveNormal(const CurveSet& curves, uint32_t segment, float u, const Vector3& along, const Vector3& offset,
                    const Vector3& direction) {
  const Normal3 fallback = Frame::FromNormal(along).x;
  switch (curves.kind) {
    case CurveSet::Kind::Flat:
      return SafeNormalize(Perpendicular(-direction, along), fallback);
    case CurveSet::Kind::Cylinder:
      return SafeNormalize(Perpendicular(offset, along), fallback);
    case CurveSet::Kind::Ribbon:
      break;
  }
  const auto& n = curves.segmentNormals[segment];
  return SafeNormalize(Perpendicular(n[0] * (1 - u) + n[1] * u, along), fallback);
}

}  // namespace

void EvaluateCurve(const CurveSet& curves, uint32_t segment, float u, const Point3& origin, const Vector3& direction,
                   float t, SurfacePoint& point) {
  const Point3 axis = CurveAxis(curves, segment, u);
  const Vector3 tangent = CurveTangent(curves, segment, u);
  const Vector3 along = SafeNormalize(tangent, Vector3(0, 0, 1));
  const float radius = CurveRadius(curves, segment, u);

  const Vector3 travelled = direction * t;
  point.position = origin + travelled;
  // Embree finds curve hits iteratively, to a few thousandths of the radius.
  point.positionError = (Abs(origin) + Abs(travelled)) * Gamma(4) + Vector3(4e-3f * radius);
  const Vector3 offset = point.position - axis;
  point.Ng = point.Ns = CurveNormal(curves, segment, u, along, offset, direction);

  // v runs as in pbrt-v4: to the side that direction × tangent points to, also on the back of a ribbon.
  const bool isRibbon = curves.kind == CurveSet::Kind::Ribbon;
  const Vector3 view = !isRibbon ? direction : glm::dot(point.Ng, direction) > 0 ? point.Ng : -point.Ng;
  const Vector3 across = SafeNormalize(glm::cross(view, along), Frame::FromNormal(along).x);
  const auto& range = curves.uRange[segment];
  const float side = radius > 0 ? glm::dot(offset, across) / radius : 0.0f;
  point.uv = {range[0] + (range[1] - range[0]) * u, std::clamp(0.5f + 0.5f * side, 0.0f, 1.0f)};
  point.dpdu = tangent / std::max(range[1] - range[0], 1e-6f);
  point.dpdv = across * (2 * radius);
  point.strand = isRibbon ? Strand::Ribbon : Strand::Fibre;
}

}  // namespace lampyr
