#include "integrators/common/footprint.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "integrators/common/subpath.h"

namespace lampyr {

double PixelArea(const Camera& camera, const Ray& ray, double filmPixels, double distance) {
  Point2 film;
  const auto densities = camera.EvaluateRay(ray, &film);
  if (!densities) return 0;
  // Of film points chosen uniformly in the full image.
  if (camera.ConnectsByDirection()) return 1 / (static_cast<double>(densities->pdfPosition.value) * filmPixels);
  return distance * distance / (static_cast<double>(densities->pdfDirection.value) * filmPixels);
}

bool FindSeenVertex(const RenderScene& scene, const Ray& ray, Sampler& sampler, PathVertex& vertex, double& distance) {
  constexpr int mostEvents = 16;
  distance = 0;
  Flight flight;
  flight.ray = ray;
  for (int depth = 1; depth <= mostEvents; ++depth) {
    RayHit hit;
    if (!scene.geometry->Intersect(flight.ray, depth == 1 ? visibility::kCamera : visibility::kIndirect, hit))
      return false;
    const SurfacePoint point = scene.geometry->GetSurfacePoint(flight.ray, hit);
    distance += static_cast<double>(hit.t);
    if (!MakeVertex(scene, flight.ray, hit, point, vertex)) return false;
    if (!vertex.isDelta) return true;
    vertex.specular = Color(1.0f);
    if (!Scatter(vertex, TransportMode::Radiance, 1, SubpathDimensions(), depth, 1, sampler, flight)) return false;
  }
  return false;
}

void VisitSeen(const RenderScene& scene, int width, int height, int across, const SeenVisitor& visit) {
  PathVertex vertex;
  Sampler sampler(SamplerKind::Independent, 0);
  const auto cells = static_cast<float>(across);
  for (int i = 0; i < across * across; ++i) {
    sampler.StartPixelSample(i, 0, 0);
    const Point2 film((static_cast<float>(i % across) + 0.5f) / cells * static_cast<float>(width),
                      (static_cast<float>(i / across) + 0.5f) / cells * static_cast<float>(height));
    const Ray ray = scene.camera->GenerateRay(film, Point2(0.5f), 0).ray;
    double distance;
    if (FindSeenVertex(scene, ray, sampler, vertex, distance)) visit(ray, vertex, distance, sampler);
  }
}

double TypicalFootprint(const RenderScene& scene, int width, int height) {
  const double filmPixels = static_cast<double>(width) * static_cast<double>(height);
  std::vector<double> areas;
  VisitSeen(scene, width, height, 24, [&](const Ray& ray, const PathVertex&, double distance, Sampler&) {
    const double area = PixelArea(*scene.camera, ray, filmPixels, distance);
    if (area > 0 && std::isfinite(area)) areas.push_back(area);
  });
  if (areas.empty()) return 1e-3 * static_cast<double>(scene.lighting->SceneSphere().radius);
  const auto middle = areas.begin() + static_cast<std::ptrdiff_t>(areas.size() / 2);
  std::nth_element(areas.begin(), middle, areas.end());
  return std::sqrt(*middle);
}

}  // namespace lampyr
