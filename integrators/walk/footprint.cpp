#include "integrators/walk/footprint.h"

#include <cmath>
#include <vector>

namespace lampyr {

namespace {

// Follows a path over delta vertices to the first vertex that is not a delta.
class SkipDeltas final : public PathVisitor {
 public:
  bool Arrived(Subpath& path, const PathState& state) override {
    PathVertex& vertex = path.Last();
    if (!vertex.isDelta) {
      distance_ = state.length;
      return false;
    }
    vertex.specular = Color(1.0f);
    vertex.diffuse = Color(0.0f);
    return true;
  }
  // Path length to that vertex, once it is found.
  const std::optional<float>& Distance() const { return distance_; }

 private:
  std::optional<float> distance_;
};

constexpr int kMostDeltas = 16;

}  // namespace

double PixelArea(const Camera& camera, const Ray& ray, double filmPixels, double distance) {
  Point2 film;
  const auto densities = camera.EvaluateRay(ray, &film);
  if (!densities) return distance * distance * camera.PixelSolidAngle(ray);
  // Both densities are for film points chosen uniformly in the full image.
  if (camera.ConnectsByDirection()) return 1 / (static_cast<double>(densities->pdfPosition.value) * filmPixels);
  return distance * distance / (static_cast<double>(densities->pdfDirection.value) * filmPixels);
}

bool SceneProbe::Find(PathState& state, Subpath& path, SeenVertex& seen) {
  SkipDeltas visitor;
  const int before = static_cast<int>(path.Count());
  Walk(Context(), {TransportMode::Radiance, before + kMostDeltas, {}, false}, state, path, visitor);
  if (!visitor.Distance()) return false;
  seen.vertex = path.Last();
  seen.vertex.diffuse = Color(0.0f);
  seen.vertex.specular = Color(1.0f);
  seen.distance = *visitor.Distance();
  return true;
}

void SceneProbe::ForEachVisible(int width, int height, int across, const Visit& visit) {
  SeenVertex seen;
  const auto cells = static_cast<float>(across);
  for (int i = 0; i < across * across; ++i) {
    sampler_.StartPixelSample(i, 0, 0);
    const Point2 film((static_cast<float>(i % across) + 0.5f) / cells * static_cast<float>(width),
                      (static_cast<float>(i / across) + 0.5f) / cells * static_cast<float>(height));
    PathState state;
    const CameraRay cameraRay = scene_.camera->GenerateRay(film, Point2(0.5f), 0);
    if (cameraRay.weight == 0) continue;
    state.ray = cameraRay.ray;
    state.medium = scene_.MediumOf(state.ray);
    state.specular = Color(1.0f);
    const Ray ray = state.ray;
    path_.Clear();
    if (Find(state, path_, seen)) visit(ray, seen);
  }
}

bool SceneProbe::Bounce(SeenVertex& from, int block, PathState& state, SeenVertex& seen) {
  const WalkSettings settings{TransportMode::Radiance, kMostDeltas, {}, false};
  state = PathState();
  if (!Scatter(Context(), settings, block, from.vertex, state)) return false;
  PathState onward = state;
  path_.Clear();
  path_.Next() = from.vertex;
  path_.Add();
  return Find(onward, path_, seen);
}

}  // namespace lampyr
