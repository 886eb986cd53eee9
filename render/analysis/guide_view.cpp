#include "render/analysis/guide_view.h"

#include <cmath>

#include "integrators/walk/walk.h"

namespace lampyr {

namespace {

// Ends a path at the first vertex where walks may be guided.
class FirstGuidedVertex final : public PathVisitor {
 public:
  bool Arrived(Subpath& path, const PathState&) override {
    const PathVertex& vertex = path.Last();
    if (vertex.isDelta || !vertex.bsdf.IsWide()) return vertex.isDelta;
    guide = vertex.guide;
    position = vertex.point.position;
    return false;
  }

  const GuideRegion* guide = nullptr;
  Point3 position{0.0f};
};

// A frame with the direction in which the camera looks, and the right and the lower side of the picture.
struct PictureFrame {
  Vector3 forward, right, down;

  PictureFrame(const Camera& camera, int width, int height) {
    const Point2 middle(0.5f * static_cast<float>(width), 0.5f * static_cast<float>(height));
    const auto pointAt = [&](const Point2& film) {
      const Ray ray = camera.GenerateRay(film, Point2(0.5f), 0).ray;
      return std::pair(ray.origin + ray.direction, ray.direction);
    };
    const auto [at, direction] = pointAt(middle);
    forward = direction;
    Vector3 across = pointAt(middle + Point2(1, 0)).first - at;
    across -= glm::dot(across, forward) * forward;
    const bool isKnown = glm::length(across) > 0;
    right = isKnown ? glm::normalize(across) : Frame::FromNormal(Normal3(forward)).x;
    down = glm::cross(forward, right);
    if (glm::dot(pointAt(middle + Point2(0, 1)).first - at, down) < 0) down = -down;
  }

  Vector3 At(int column, int row) const {
    const double azimuth = 2 * 3.14159265358979323846 * ((column + 0.5) / GuideView::kColumns - 0.5);
    const double elevation = 3.14159265358979323846 * ((row + 0.5) / GuideView::kRows - 0.5);  // downwards
    const auto part = [](double value) { return static_cast<float>(value); };
    return glm::normalize(part(std::cos(elevation) * std::cos(azimuth)) * forward +
                          part(std::cos(elevation) * std::sin(azimuth)) * right + part(std::sin(elevation)) * down);
  }
};

}  // namespace

GuideView ViewGuide(const RenderScene& scene, const std::shared_ptr<const PathGuide>& guide, int width, int height,
                    int x, int y) {
  GuideView view;
  RenderScene guided = scene;
  guided.guide = guide;
  guided.roulette = nullptr;
  Sampler sampler(SamplerKind::Independent, 0);
  sampler.StartPixelSample(x, y, 0);
  RenderCounts counts;
  const SampleContext context{.scene = guided, .sampler = sampler, .time = 0, .counts = counts};
  const Point2 film(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
  const CameraRay camera = guided.camera->GenerateRay(film, Point2(0.5f), 0);
  if (camera.weight == 0) return view;  // vignetted: the pixel sees nothing
  PathState state;
  state.ray = camera.ray;
  state.medium = guided.MediumOf(camera.ray);
  state.specular = Color(1.0f);
  FirstGuidedVertex visitor;
  Subpath path;
  Walk(context, {.mode = TransportMode::Radiance, .maxDepth = 32, .hasRoulette = false}, state, path, visitor);
  // A region without a share is not guided, and has no mixture.
  if (!visitor.guide || !(visitor.guide->radiance.share > 0)) return view;
  const MixtureFit& radiance = visitor.guide->radiance;
  view.isGuided = true;
  view.share = radiance.share;
  const PictureFrame frame(*guided.camera, width, height);
  for (int row = 0; row < GuideView::kRows; ++row) {
    for (int column = 0; column < GuideView::kColumns; ++column)
      view.densities.push_back(radiance.mixture.Density(visitor.position, frame.At(column, row)).value);
  }
  return view;
}

}  // namespace lampyr
