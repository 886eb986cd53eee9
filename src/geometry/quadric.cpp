// Intersection in double and in the quadric's own space: the discriminant from the distance between centre and ray, the
// roots without cancellation ([Haines19], [Hearn04]), so that a radius of 1e-6 seen from 1e6 away is still round.
#include "geometry/quadric.h"

#include <limits>

#include <glm/matrix.hpp>

#include "geometry/rounding.h"

namespace lampyr {

namespace {

// Both roots of a t² - 2 b t + c = 0, ordered, when the discriminant b² - a c = a·`reduced` is known not to cancel.
int StableRoots(double a, double b, double c, double reduced, double roots[2]) {
  if (!(reduced >= 0) || !(a > 0)) return 0;
  const double root = std::sqrt(a * reduced);
  const double q = b + std::copysign(root, b);
  if (q == 0) {  // b = 0 and a grazing touch: both roots are 0
    roots[0] = roots[1] = 0;
    return 2;
  }
  roots[0] = c / q;
  roots[1] = q / a;
  if (roots[0] > roots[1]) std::swap(roots[0], roots[1]);
  return 2;
}

// Octahedral map of a direction to [-1,1]² ([Meyer10]).
Point2 OctahedralEncode(const Vector3d& d) {
  const double inverse = 1.0 / (std::abs(d.x) + std::abs(d.y) + std::abs(d.z));
  const double x = d.x * inverse, y = d.y * inverse;
  if (d.z >= 0) return {static_cast<float>(x), static_cast<float>(y)};
  return {static_cast<float>(std::copysign(1 - std::abs(y), x)), static_cast<float>(std::copysign(1 - std::abs(x), y))};
}

Vector3 OctahedralDecode(const Point2& e) {
  Vector3 d(e.x, e.y, 1.0f - std::abs(e.x) - std::abs(e.y));
  if (d.z < 0) {
    const float x = d.x;
    d.x = std::copysign(1.0f - std::abs(d.y), x);
    d.y = std::copysign(1.0f - std::abs(x), d.y);
  }
  return glm::normalize(d);
}

// The angle of (x, y) on the square |x| + |y| = 1, in [0,4): monotone in φ and cheap.
float DiamondAngle(double x, double y) {
  const double sum = std::abs(x) + std::abs(y);
  if (sum == 0) return 0;
  const double r = y >= 0 ? (x >= 0 ? y / sum : 1 - x / sum) : (x < 0 ? 2 - y / sum : 3 + x / sum);
  return r < 4 ? static_cast<float>(r) : 0.0f;
}

Vector2 DiamondDirection(float angle) {
  Vector2 d;
  if (angle < 2) {
    d = {1 - angle, angle < 1 ? angle : 2 - angle};
  } else {
    d = {angle - 3, angle < 3 ? 2 - angle : angle - 4};
  }
  return d / glm::length(d);
}

float PositivePhi(float x, float y) {
  const float phi = std::atan2(y, x);
  return phi < 0 ? phi + 2 * kPi : phi;
}

}  // namespace

PreparedQuadric::PreparedQuadric(const Quadric& quadric) : quadric_(quadric), normalSign_(OutsideSign(quadric)) {
  const glm::dmat3 toRender(quadric.toRender.linear);
  toObject_ = glm::inverse(toRender);
  toObjectTranslation_ = -(toObject_ * Vector3d(quadric.toRender.translation));
  quadric_.toObject = {glm::mat3(toObject_), Vector3(toObjectTranslation_)};
  thetaZMin_ = std::acos(std::clamp(quadric.zMin / quadric.radius, -1.0f, 1.0f));
  thetaZMax_ = std::acos(std::clamp(quadric.zMax / quadric.radius, -1.0f, 1.0f));
}

int PreparedQuadric::IntersectSphere(const Point3d& o, const Vector3d& d, double tMax, double roots[2]) const {
  const double r = static_cast<double>(quadric_.radius);
  const double a = glm::dot(d, d), b = -glm::dot(o, d);
  // Most rays that hit the sphere's box miss the sphere, or are shadow rays that end in front of it. Both are rejected
  // without a root or a division if the decision does not depend on rounding.
  constexpr double kBeyondRounding = 1e-12;
  const double outside = glm::dot(o, o) - r * r;
  if (b * b * (1 + kBeyondRounding) < a * outside) return 0;
  if (outside > 0 && b > a * tMax) {
    const Point3d end = o + d * tMax;
    if (glm::dot(end, end) > r * r * (1 + kBeyondRounding) && tMax < std::numeric_limits<double>::max()) return 0;
  }
  // r² minus the squared distance of the nearest point: exact to the rounding of r², as `outside` is to that of o². The
  // factors (r - |o|)(r + |o|) would need roots and be no more exact, because the roots are rounded.
  const Vector3d nearest = o + d * (b / a);
  return StableRoots(a, b, outside, r * r - glm::dot(nearest, nearest), roots);
}

int PreparedQuadric::IntersectCylinder(const Point3d& o, const Vector3d& d, double roots[2]) const {
  const double r = static_cast<double>(quadric_.radius);
  const double a = d.x * d.x + d.y * d.y, b = -(o.x * d.x + o.y * d.y);
  if (a == 0) return 0;
  const double k = b / a;
  const double nearestDistance = std::hypot(o.x + d.x * k, o.y + d.y * k);
  const double distance = std::hypot(o.x, o.y);
  return StableRoots(a, b, (distance - r) * (distance + r), (r - nearestDistance) * (r + nearestDistance), roots);
}

bool PreparedQuadric::Accept(const Point3d& p) const {
  const double r = static_cast<double>(quadric_.radius);
  const double zMin = static_cast<double>(quadric_.zMin), zMax = static_cast<double>(quadric_.zMax);
  switch (quadric_.kind) {
    case Quadric::Kind::Sphere:
      if ((zMin > -r && p.z < zMin) || (zMax < r && p.z > zMax)) return false;
      break;
    case Quadric::Kind::Cylinder:
      if (p.z < zMin || p.z > zMax) return false;
      break;
    case Quadric::Kind::Disk: {
      const double squared = p.x * p.x + p.y * p.y, inner = static_cast<double>(quadric_.innerRadius);
      if (squared > r * r || squared < inner * inner) return false;
      break;
    }
  }
  if (quadric_.phiMax >= 2 * kPi) return true;
  double phi = std::atan2(p.y, p.x);
  if (phi < 0) phi += 2 * static_cast<double>(kPi);
  return phi <= static_cast<double>(quadric_.phiMax);
}

Point2 PreparedQuadric::Encode(const Point3d& p) const {
  const double r = static_cast<double>(quadric_.radius);
  switch (quadric_.kind) {
    case Quadric::Kind::Sphere:
      return OctahedralEncode(p);
    case Quadric::Kind::Disk:
      return {static_cast<float>(p.x / r), static_cast<float>(p.y / r)};
    case Quadric::Kind::Cylinder:
      break;
  }
  const double zMin = static_cast<double>(quadric_.zMin), zMax = static_cast<double>(quadric_.zMax);
  return {DiamondAngle(p.x, p.y), static_cast<float>((p.z - zMin) / (zMax - zMin))};
}

int PreparedQuadric::Intersect(const RayDouble& ray, QuadricHit hits[2], int most) const {
  const Point3d o = toObject_ * ray.origin + toObjectTranslation_;
  const Vector3d d = toObject_ * ray.direction;
  double roots[2];
  int count = 0;
  switch (quadric_.kind) {
    case Quadric::Kind::Sphere:
      count = IntersectSphere(o, d, ray.tMax, roots);
      break;
    case Quadric::Kind::Cylinder:
      count = IntersectCylinder(o, d, roots);
      break;
    case Quadric::Kind::Disk:
      if (d.z == 0) return 0;
      roots[0] = (static_cast<double>(quadric_.zMin) - o.z) / d.z;
      count = 1;
      break;
  }
  int found = 0;
  for (int i = 0; i < count && found < most; ++i) {
    const double t = roots[i];
    if (!(t > ray.tMin && t <= ray.tMax)) continue;
    const Point3d p = o + d * t;
    if (!Accept(p)) continue;
    hits[found].t = t;
    hits[found++].coordinates = Encode(p);
  }
  return found;
}

Point3 PreparedQuadric::Decode(const Point2& c) const {
  const float r = quadric_.radius;
  switch (quadric_.kind) {
    case Quadric::Kind::Sphere:
      return OctahedralDecode(c) * r;
    case Quadric::Kind::Disk:
      return {c.x * r, c.y * r, quadric_.zMin};
    case Quadric::Kind::Cylinder:
      break;
  }
  const Vector2 direction = DiamondDirection(c.x);
  return {direction.x * r, direction.y * r, quadric_.zMin + c.y * (quadric_.zMax - quadric_.zMin)};
}

void PreparedQuadric::Parametrize(const Point3& p, float v, SurfacePoint& point) const {
  const float r = quadric_.radius, phiMax = quadric_.phiMax;
  const float phi = p.x == 0 && p.y == 0 ? 0.0f : PositivePhi(p.x, p.y);
  const float rho = std::sqrt(p.x * p.x + p.y * p.y);
  Vector3 dpdv;
  switch (quadric_.kind) {
    case Quadric::Kind::Sphere: {
      const float thetaRange = thetaZMax_ - thetaZMin_, cosTheta = std::clamp(p.z / r, -1.0f, 1.0f);
      const Vector2 around = rho > 0 ? Vector2(p.x / rho, p.y / rho) : Vector2(1, 0);
      v = thetaRange != 0 ? std::clamp((std::acos(cosTheta) - thetaZMin_) / thetaRange, 0.0f, 1.0f) : 0.0f;
      dpdv = Vector3(p.z * around.x, p.z * around.y, -rho) * thetaRange;
      break;
    }
    case Quadric::Kind::Disk:
      v = (r - rho) / (r - quadric_.innerRadius);
      dpdv = rho > 0 ? Vector3(p.x, p.y, 0.0f) * ((quadric_.innerRadius - r) / rho) : Vector3(0.0f);
      break;
    case Quadric::Kind::Cylinder:
      dpdv = {0, 0, quadric_.zMax - quadric_.zMin};
      break;
  }
  point.uv = {std::min(phi / phiMax, 1.0f), v};
  point.dpdu = quadric_.toRender.Vector(Vector3(-p.y, p.x, 0.0f) * phiMax);
  point.dpdv = quadric_.toRender.Vector(dpdv);
}

void PreparedQuadric::Evaluate(const Point2& coordinates, bool isParametrized, SurfacePoint& point) const {
  const Point3 p = Decode(coordinates);
  const float r = quadric_.radius;
  Vector3 normal, error = Abs(p) * Gamma(5);
  switch (quadric_.kind) {
    case Quadric::Kind::Sphere:
      normal = p / r;
      break;
    case Quadric::Kind::Disk:
      normal = {0, 0, 1};
      error.z = 0;  // p.z is the height itself
      break;
    case Quadric::Kind::Cylinder:
      normal = {p.x / r, p.y / r, 0};
      break;
  }
  point.position = quadric_.toRender.Point(p);
  point.positionError = quadric_.toRender.PointError(p, error);
  point.Ng = SafeNormalize(quadric_.toObject.NormalByInverse(normal) * normalSign_, Normal3(0, 0, 1));
  point.Ns = point.Ng;
  if (isParametrized) Parametrize(p, coordinates.y, point);
}

}  // namespace lampyr
