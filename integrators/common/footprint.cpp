#include "integrators/common/footprint.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "integrators/common/subpath.h"

namespace lampyr {

double PixelArea(const Camera& camera, const Ray& ray, double filmPixels, double distance) {
  Point2 film;
  const auto densities = camera.EvaluateRay(ray, &film);
  if (!densities) return 0;
  // Of film points chosen uniformly in the full image.
  if (camera.HasParallelRays() || camera.ConnectsByDirection())
    return 1 / (static_cast<double>(densities->pdfPosition.value) * filmPixels);
  return distance * distance / (static_cast<double>(densities->pdfDirection.value) * filmPixels);
}

namespace {

// The distance that a camera ray goes until it meets something that is not a delta, past those that are.
std::optional<double> DistanceSeen(const RenderScene& scene, const Ray& ray, Sampler& sampler) {
  constexpr int mostEvents = 16;
  double distance = 0;
  Flight flight;
  flight.ray = ray;
  flight.specular = Color(1.0f);
  for (int depth = 1; depth <= mostEvents; ++depth) {
    RayHit hit;
    if (!scene.geometry->Intersect(flight.ray, depth == 1 ? visibility::kCamera : visibility::kIndirect, hit))
      return std::nullopt;
    PathVertex vertex;
    const SurfacePoint point = scene.geometry->GetSurfacePoint(flight.ray, hit);
    distance += static_cast<double>(hit.t);
    if (!MakeVertex(scene, flight.ray, hit, point, vertex)) return std::nullopt;
    if (!vertex.isDelta) return distance;
    vertex.specular = Color(1.0f);
    if (!Scatter(vertex, TransportMode::Radiance, 1, SubpathDimensions(), depth, 1, sampler, flight))
      return std::nullopt;
  }
  return std::nullopt;
}

}  // namespace

double TypicalFootprint(const RenderScene& scene, int width, int height) {
  constexpr int across = 24;
  const double filmPixels = static_cast<double>(width) * static_cast<double>(height);
  std::vector<double> areas;
  Sampler sampler(SamplerKind::Independent, 0);
  for (int i = 0; i < across * across; ++i) {
    sampler.StartPixelSample(i, 0, 0);
    const Point2 film((static_cast<float>(i % across) + 0.5f) / across * static_cast<float>(width),
                      (static_cast<float>(i / across) + 0.5f) / across * static_cast<float>(height));
    const CameraRay ray = scene.camera->GenerateRay(film, Point2(0.5f), 0);
    const std::optional<double> distance = DistanceSeen(scene, ray.ray, sampler);
    if (!distance) continue;
    const double area = PixelArea(*scene.camera, ray.ray, filmPixels, *distance);
    if (area > 0 && std::isfinite(area)) areas.push_back(area);
  }
  if (areas.empty()) return 1e-3 * static_cast<double>(scene.lighting->SceneSphere().radius);
  const auto middle = areas.begin() + static_cast<std::ptrdiff_t>(areas.size() / 2);
  std::nth_element(areas.begin(), middle, areas.end());
  return std::sqrt(*middle);
}

}  // namespace lampyr
