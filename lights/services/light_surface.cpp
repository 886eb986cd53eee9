// The map is inverted in double from the very matrix that places sampled points, so that a shadow ray which stops short
// of a sample does not meet the light in front of it.
#include "lights/services/light_surface.h"

#include <glm/matrix.hpp>

namespace lampyr {

namespace {

class LightSurface final : public CustomSurface {
 public:
  explicit LightSurface(const PlacedLight& placed)
      : light_(placed.light),
        surface_(*placed.light->Surface()),
        motion_(placed.motion),
        still_(placed.transform.toRender) {}

  bool Moves() const override { return motion_ != nullptr; }
  Bounds3 GetBounds(float begin, float end) const override;
  std::optional<double> Intersect(const RayDouble& ray, float time, SurfacePoint* point) const override {
    return motion_ ? Map(motion_->At(time)).Intersect(surface_, ray, point) : still_.Intersect(surface_, ray, point);
  }

 private:
  struct Map {
    glm::dmat3 linear, inverse;
    Vector3d translation;

    explicit Map(const Affine& toRender)
        : linear(toRender.linear), inverse(glm::inverse(linear)), translation(toRender.translation) {}
    std::optional<double> Intersect(const IntersectableLight& surface, const RayDouble& ray, SurfacePoint* point) const;
    void SetPoint(const LocalHit& hit, const RayDouble& ray, SurfacePoint& point) const;
  };

  std::shared_ptr<const Light> light_;
  const IntersectableLight& surface_;
  std::shared_ptr<const Motion> motion_;
  Map still_;  // unless it moves
};

std::optional<double> LightSurface::Map::Intersect(const IntersectableLight& surface, const RayDouble& ray,
                                                   SurfacePoint* point) const {
  const auto hit =
      surface.Intersect({inverse * (ray.origin - translation), inverse * ray.direction, ray.tMin, ray.tMax});
  if (!hit) return std::nullopt;
  if (point) SetPoint(*hit, ray, *point);
  return hit->t;
}

void LightSurface::Map::SetPoint(const LocalHit& hit, const RayDouble& ray, SurfacePoint& point) const {
  const Point3d position = linear * hit.position + translation;
  point.position = Point3(position);
  // Rounded once to float; and what intersection in double loses over the way from the origin.
  constexpr double roundingOfFloat = 0x1p-24, roundingOfDouble = 64 * 0x1p-53;
  const Vector3d way = Abs(ray.origin) + std::abs(hit.t) * Abs(ray.direction) + Abs(translation);
  point.positionError = Vector3(roundingOfFloat * Abs(position) + roundingOfDouble * way) * 2.0f;
  point.Ng = Normal3(glm::normalize(hit.normal * inverse));
  point.Ns = point.Ng;
  point.uv = hit.uv;
}

// A point moves along straight lines between keys: its positions at the keys and at both ends bound it.
Bounds3 LightSurface::GetBounds(float begin, float end) const {
  std::vector<Affine> places;
  if (motion_) {
    places = {motion_->At(begin), motion_->At(end)};
    const size_t last = motion_->Keys().size() - 1;
    for (size_t i = 0; i <= last; ++i) {
      const float time =
          motion_->Begin() + (motion_->End() - motion_->Begin()) * static_cast<float>(i) / static_cast<float>(last);
      if (time >= begin && time <= end) places.push_back(motion_->Keys()[i]);
    }
  } else {
    places.push_back({glm::mat3(still_.linear), Vector3(still_.translation)});
  }
  Bounds3 bounds;
  for (const Affine& place : places) {
    for (const Point3& p : surface_.GetBounds()) {
      // A box around what double-precision intersection finds, not around its rounding.
      const Vector3 error = place.PointError(p, Vector3(0.0f)) * 2.0f;
      bounds.Add(place.Point(p) - error);
      bounds.Add(place.Point(p) + error);
    }
  }
  return bounds;
}

}  // namespace

std::shared_ptr<const CustomSurface> MakeLightSurface(const PlacedLight& placed) {
  if (!placed.light->Surface()) return nullptr;
  return std::make_shared<LightSurface>(placed);
}

}  // namespace lampyr
