#include "suite/surface_tracer.h"

#include <glm/matrix.hpp>

namespace lampyr::suite {

SurfaceTracer::SurfaceTracer(const IntersectableLight& surface, const LightTransform& transform)
    : surface_(surface),
      linear_(transform.toRender.linear),
      inverse_(glm::inverse(glm::dmat3(transform.toRender.linear))),
      translation_(transform.toRender.translation),
      determinant_(std::abs(glm::determinant(glm::dmat3(transform.toRender.linear)))) {
  Bounds3d render;
  const std::vector<Point3> points = surface.GetBounds();
  for (const Point3& p : points) {
    box_.Add(Point3d(p));
    render.Add(linear_ * Point3d(p) + translation_);
  }
  if (points.empty()) return;
  enclosure_.middle = render.Center();
  for (const Point3& p : points) {
    enclosure_.radius =
        std::max(enclosure_.radius, glm::length(linear_ * Point3d(p) + translation_ - enclosure_.middle));
  }
}

SurfaceHit SurfaceTracer::Complete(const LocalHit& hit, double distance) const {
  SurfaceHit result;
  result.distance = distance;
  result.local = hit.position;
  result.position = linear_ * hit.position + translation_;
  const Vector3d normal = hit.normal * inverse_;  // by the inverse transpose
  result.normal = glm::normalize(normal);
  result.stretch = determinant_ * glm::length(normal);
  result.uv = hit.uv;
  return result;
}

std::optional<LocalHit> SurfaceTracer::IntersectLocal(const Point3d& origin, const Vector3d& direction, double from,
                                                      double to) const {
  LocalRay ray;
  ray.origin = origin;
  ray.direction = direction;
  ray.tMin = from;
  ray.tMax = to;
  return surface_.Intersect(ray);
}

std::optional<SurfaceHit> SurfaceTracer::Trace(const Point3d& origin, const Vector3d& direction, double from,
                                               double to) const {
  const auto hit = IntersectLocal(ToLocal(origin), inverse_ * direction, from, to);
  if (!hit) return std::nullopt;
  return Complete(*hit, hit->t);
}

std::optional<SurfaceTracer::Found> SurfaceTracer::Find(const Point3d& origin, const Vector3d& direction,
                                                        const Point3d& position) const {
  std::optional<Found> best;
  double from = 0, nearest = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 32; ++i) {
    const auto hit = Trace(origin, direction, from);
    if (!hit) break;
    const double away = glm::length(hit->position - position);
    if (away < nearest) {
      nearest = away;
      best = Found{*hit, i == 0};
    }
    from = hit->distance + 1e-9 * (hit->distance + enclosure_.radius);
  }
  return best;
}

std::vector<Estimate> SurfaceTracer::IntegrateOver(size_t cells, const std::function<size_t(const SurfaceHit&)>& cellOf,
                                                   const std::function<double(const SurfaceHit&)>& f, Rng& rng) const {
  const Vector3d size = box_.Diagonal();
  const double faces[3] = {size.y * size.z, size.z * size.x, size.x * size.y};
  const double area = 2 * (faces[0] + faces[1] + faces[2]), reach = 2 * glm::length(size);
  constexpr int kLattices = 64, kPoints = 2048;
  std::vector<RunningMean> means(cells);
  std::vector<double> sums(cells);
  for (int lattice = 0; lattice < kLattices; ++lattice) {
    std::fill(sums.begin(), sums.end(), 0.0);
    LatticeMean(rng, 1, kPoints, [&](const float(&v)[4]) {
      // One number chooses the face, by area, and the side.
      double choice = 0.5 * area * std::fmod(2.0 * static_cast<double>(v[0]), 1.0);
      const double sign = v[0] < 0.5f ? 1 : -1;
      int axis = 0;
      while (axis < 2 && choice >= faces[axis]) choice -= faces[axis++];
      const int across = (axis + 1) % 3, along = (axis + 2) % 3;
      const double part = faces[axis] > 0 ? std::min(choice / faces[axis], 1.0) : 0.5;
      Point3d entry;
      entry[axis] = sign > 0 ? box_.min[axis] : box_.max[axis];
      entry[across] = box_.min[across] + size[across] * part;
      entry[along] = box_.min[along] + size[along] * static_cast<double>(v[1]);
      Vector3d direction;
      const double r = std::sqrt(static_cast<double>(v[2])), phi = 2 * kPiDouble * static_cast<double>(v[3]);
      direction[axis] = sign * std::sqrt(1 - r * r);
      direction[across] = r * std::cos(phi);
      direction[along] = r * std::sin(phi);
      const Point3d origin = entry - reach * direction;
      double from = 0;
      for (int i = 0; i < 32; ++i) {
        const auto hit = IntersectLocal(origin, direction, from, std::numeric_limits<double>::infinity());
        if (!hit) break;
        const SurfaceHit point = Complete(*hit, hit->t);
        sums[cellOf(point)] += 0.5 * area * point.stretch * f(point);
        from = hit->t * (1 + 1e-9);
      }
      return 0.0;
    });
    for (size_t cell = 0; cell < cells; ++cell) means[cell].Add(sums[cell] / kPoints);
  }
  std::vector<Estimate> result;
  for (const RunningMean& mean : means) result.push_back(EstimateOf(mean));
  return result;
}

LightHit HitFrom(const SurfaceHit& found, const Vector3d& direction) {
  LightHit hit;
  hit.direction = glm::normalize(Vector3(direction));
  hit.distance = static_cast<float>(found.distance);
  hit.position = Point3(found.position);
  hit.normal = Normal3(found.normal);
  hit.uv = found.uv;
  return hit;
}

Cap CapTowards(const Enclosure& around, const Point3& P) {
  Cap cap;
  const Vector3d way = around.middle - Point3d(P);
  const double distance = glm::length(way), sine = around.radius / distance;
  if (!(sine < 0.95)) return cap;
  cap.axis = way / distance;
  cap.wMax = 1.02 * sine * sine / (1 + std::sqrt(1 - sine * sine));
  return cap;
}

}  // namespace lampyr::suite
