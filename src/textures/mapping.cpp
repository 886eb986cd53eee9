// Angles in texture space: θ from +z, φ from +x towards +y. A point on the axis has φ = 0.
#include "textures/mapping.h"

namespace lampyr {

Point2 TextureMapping2D::MapPosition(const Point3& p) const {
  switch (kind) {
    case Kind::Spherical: {
      const float phi = std::atan2(p.y, p.x);
      const float theta = std::atan2(std::hypot(p.x, p.y), p.z);
      return {theta * kInvPi, (phi < 0 ? phi + 2 * kPi : phi) * (0.5f * kInvPi)};
    }
    case Kind::Cylindrical:
      return {(kPi + std::atan2(p.y, p.x)) * (0.5f * kInvPi), p.z};
    default:
      return Point2(glm::dot(p, axisS), glm::dot(p, axisT)) + delta;
  }
}

}  // namespace lampyr
