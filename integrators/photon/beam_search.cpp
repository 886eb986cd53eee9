#include "integrators/photon/beam_search.h"

namespace lampyr {

namespace {

std::vector<Bounds3> BoxesOf(std::span<const VolumePhoton> balls) {
  std::vector<Bounds3> boxes;
  boxes.reserve(balls.size());
  for (const VolumePhoton& ball : balls) {
    const Vector3 radius(ball.radius);
    boxes.push_back({ball.position - radius, ball.position + radius});
  }
  return boxes;
}

}  // namespace

BeamSearch::BeamSearch(std::span<const VolumePhoton> balls) : tree_(BoxesOf(balls)) {}

void BeamSearch::Find(std::span<const VolumePhoton> balls, const Ray& ray, float tMax, uint32_t first,
                      std::vector<uint32_t>& boxes, std::vector<BeamHit>& hits) const {
  boxes.clear();
  tree_.Find(ray, tMax, boxes);
  for (const uint32_t index : boxes) {
    const VolumePhoton& ball = balls[index];
    const Vector3 toBall = ball.position - ray.origin;
    const float t = glm::dot(toBall, ray.direction);
    if (!(t >= 0 && t < tMax)) continue;
    const float distanceSquared = LengthSquared(toBall - t * ray.direction);
    if (distanceSquared < ball.radius * ball.radius) hits.push_back({first + index, t, distanceSquared});
  }
}

}  // namespace lampyr
