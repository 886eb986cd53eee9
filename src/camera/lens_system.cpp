#include "camera/lens_system.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

namespace lampyr {

namespace {

constexpr double kTouch = 1e-9;     // mm that a ray may step backwards between touching surfaces
constexpr double kNoPower = 1e-12;  // 1/mm: a focal length longer than any scene

std::string Millimetres(double value) {
  std::ostringstream text;
  text << value << " mm";
  return text.str();
}

double HeightSquared(const Point3d& p) {
  return p.x * p.x + p.y * p.y;
}

}  // namespace

LensSystem::LensSystem(const LensPrescription& lens, double stopRadius, Aperture aperture)
    : lens_(lens), aperture_(std::move(aperture)), inverseStopRadius_(1 / stopRadius) {
  for (size_t i = lens_.surfaces.size(); i-- > 0;) {
    const LensSurface& from = lens_.surfaces[i];
    Surface surface;
    surface.isStop = from.IsStop();
    surface.curvature = from.IsStop() ? 0.0 : 1 / from.curvatureRadius;
    surface.radius = from.IsStop() ? stopRadius * aperture_.Extent() : from.apertureRadius;
    surface.eta = from.index / (i > 0 ? lens_.surfaces[i - 1].index : 1.0);
    surfaces_.push_back(surface);
  }
  Place(lens_.surfaces.back().thickness);
}

void LensSystem::Place(double rearZ) {
  double z = rearZ;
  for (size_t i = 0; i < surfaces_.size(); ++i) {
    if (i > 0) z += lens_.surfaces[surfaces_.size() - 1 - i].thickness;
    surfaces_[i].z = z;
  }
}

double LensSystem::StopZ() const {
  return std::find_if(surfaces_.begin(), surfaces_.end(), [](const Surface& s) { return s.isStop; })->z;
}

// Moves the ray to the surface; false if it misses the cap of the sphere around the vertex. With p the intersection
// with the plane of the vertex and c the curvature, the distance t from there solves
//   c t² + 2 (c (p.x d.x + p.y d.y) + d.z) t + c (p.x² + p.y²) = 0
// The form of the solution used here, the one on the cap, remains exact for c = 0.
bool LensSystem::Meet(const Surface& surface, LensRay& ray, Vector3d& normal) {
  if (!(ray.direction.z > 0)) return false;
  const double toPlane = (surface.z - ray.origin.z) / ray.direction.z, c = surface.curvature;
  const Point3d p = ray.origin + toPlane * ray.direction;
  const double b = c * (p.x * ray.direction.x + p.y * ray.direction.y) + ray.direction.z,
               squares = c * HeightSquared(p);
  const double discriminant = b * b - c * squares;
  if (!(discriminant >= 0)) return false;
  const double root = std::sqrt(discriminant);
  const double onwards = b + root > 0 ? -squares / (b + root) : (root - b) / c;
  if (!(toPlane + onwards >= -kTouch)) return false;
  ray.origin = p + onwards * ray.direction;
  normal = {c * ray.origin.x, c * ray.origin.y, 1 + c * (ray.origin.z - surface.z)};
  return normal.z > 0;
}

bool LensSystem::Refract(const Surface& surface, const Vector3d& normal, LensRay& ray) {
  const double cosine = glm::dot(ray.direction, normal), eta = surface.eta;
  const double squared = 1 - eta * eta * std::max(1 - cosine * cosine, 0.0);
  if (!(cosine > 0) || !(squared > 0)) return false;
  ray.direction = glm::normalize(eta * ray.direction + (std::sqrt(squared) - eta * cosine) * normal);
  return true;
}

std::optional<LensSystem::Passed> LensSystem::Trace(LensRay ray) const {
  double transmission = 1;
  Vector3d normal;
  for (const Surface& surface : surfaces_) {
    if (!Meet(surface, ray, normal) || HeightSquared(ray.origin) > surface.radius * surface.radius) return std::nullopt;
    if (surface.isStop) {
      transmission = aperture_.Transmission(Point2d(ray.origin) * inverseStopRadius_);
      if (!(transmission > 0)) return std::nullopt;
    } else if (!Refract(surface, normal, ray)) {
      return std::nullopt;
    }
  }
  if (!(ray.direction.z > 0)) return std::nullopt;
  return Passed{ray, transmission};
}

double LensSystem::Clearance(LensRay ray) const {
  constexpr double infinite = std::numeric_limits<double>::infinity();
  double largest = 0;
  Vector3d normal;
  for (const Surface& surface : surfaces_) {
    if (!Meet(surface, ray, normal)) return infinite;
    largest = std::max(largest, HeightSquared(ray.origin) / (surface.radius * surface.radius));
    if (!surface.isStop && !Refract(surface, normal, ray)) return infinite;
  }
  return ray.direction.z > 0 ? largest : infinite;
}

// System matrix [a b; c d] (determinant 1) of height and of angle times index, from the scene to the film.
std::optional<ThickLens> LensSystem::Approximation() const {
  double a = 1, b = 0, c = 0, d = 1, index = 1;
  for (size_t i = 0; i < lens_.surfaces.size(); ++i) {
    const LensSurface& surface = lens_.surfaces[i];
    const double power = surface.IsStop() ? 0.0 : (surface.index - index) / surface.curvatureRadius;
    c -= power * a;
    d -= power * b;
    index = surface.index;
    if (i + 1 == lens_.surfaces.size()) break;
    const double reduced = surface.thickness / index;
    a += reduced * c;
    b += reduced * d;
  }
  if (!(std::abs(c) > kNoPower)) return std::nullopt;
  const double f = -1 / c;
  return ThickLens{f, surfaces_.back().z - (1 - d) * f, surfaces_.front().z - (a - 1) * f};
}

double LensSystem::RearZInFocus(double distance) const {
  const std::optional<ThickLens> thick = Approximation();
  if (!thick) return RearZ();
  const double f = thick->focalLength;
  if (f < 0) throw Error("the lens spreads light (focal length " + Millimetres(f) + "): it makes no image on a film");
  // The distance from film to object without that between the principal planes is s + s', with 1/s + 1/s' = 1/f.
  const double apart = thick->frontPrincipal - thick->rearPrincipal, both = distance - apart;
  if (!(both >= 4 * f))
    throw Error("the lens, with a focal length of " + Millimetres(f) + ", cannot be focused on what is " +
                Millimetres(distance) + " from the film: it has to be at least " + Millimetres(4 * f + apart));
  const double image = 2 * f * both / (both + std::sqrt(both * (both - 4 * f)));
  return image + (RearZ() - thick->rearPrincipal);
}

void LensSystem::Focus(double distance) {
  const double rearZ = RearZInFocus(distance);
  const LensSurface& rear = lens_.surfaces.back();
  if (!(rearZ > std::max(Sag(rear, rear.apertureRadius), 0.0)))
    throw Error("focused on what is " + Millimetres(distance) + " from the film, the lens touches the film");
  Place(rearZ);
}

double LensSystem::RearReach(double filmRadius) const {
  const LensSurface& rear = lens_.surfaces.back();
  const double radius = surfaces_.front().radius;
  // The line from a film point to the rim crosses the plane of the vertex at this fraction of its length.
  const double toPlane = RearZ() / (RearZ() - Sag(rear, rear.apertureRadius));
  return std::max(radius, filmRadius * std::abs(1 - toPlane) + radius * toPlane);
}

}  // namespace lampyr
