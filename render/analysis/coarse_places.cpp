#include "render/analysis/coarse_places.h"

#include <sstream>

namespace lampyr {

void WarnOfCoarsePlaces(const RenderScene& scene, const RenderSettings& settings, Diagnostics& diagnostics) {
  const Point2 middle(0.5f * static_cast<float>(settings.width), 0.5f * static_cast<float>(settings.height));
  const Ray ray = scene.camera->GenerateRay(middle, Point2(0.5f), 0).ray;
  const Ray beside = scene.camera->GenerateRay(middle + Point2(1, 0), Point2(0.5f), 0).ray;
  float error = 0, distance = 0;
  try {
    RayHit hit;
    Color passed;
    if (!scene.geometry->Intersect(ray, visibility::kCamera, hit, passed)) return;
    error = MaxComponent(scene.geometry->GetSurfacePoint(ray, hit).positionError);
    distance = hit.t;
  } catch (...) {
    return;  // a plugin's surface may throw anything; the render will report it
  }
  const float pixel = glm::distance(ray.origin + distance * ray.direction, beside.origin + distance * beside.direction);
  constexpr float kCoarse = 0.1f;
  if (!(error > kCoarse * distance && error > pixel)) return;
  std::ostringstream text;
  text << "the surface in the middle of the picture is so large that places on it are known to " << error
       << " units only, and the camera is " << distance
       << " away: what is smaller is lost there. Smaller surfaces, where the camera is, would be exact";
  diagnostics.Warn(text.str());
}

}  // namespace lampyr
