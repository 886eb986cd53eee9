#include "media/medium_emission.h"

#include <algorithm>

#include "geometry/medium_at.h"

namespace lampyr {

namespace {

// Probability with which a point of a medium without a box of its own is sampled uniformly within the scene's sphere:
// the rays that find the medium may miss a part of it.
constexpr double kEverywhere = 1.0 / 16;
// The same probability for the medium around the camera if only opaque surfaces bound it.
constexpr double kUnbounded = 1.0 / 2;

constexpr double kSphere = 4 * static_cast<double>(kPi);  // sr

Bounds3 BoxAround(const BoundingSphere& sphere) {
  return {sphere.center - Vector3(sphere.radius), sphere.center + Vector3(sphere.radius)};
}

}  // namespace

double RoughPowerOf(const Medium& medium, int32_t index, const GeometryScene& geometry) {
  double emission = 0;
  if (medium.IsHomogeneous()) {
    const MediumSurfaces surfaces = geometry.SurfacesOf(index);
    const Bounds3 box = surfaces.box.IsEmpty() ? BoxAround(geometry.GetBoundingSphere()) : surfaces.box;
    const Vector3d sides(box.Diagonal());
    emission = static_cast<double>(medium.At(Point3(0.0f)).emission.Average()) * sides.x * sides.y * sides.z;
  } else {
    RegionOfGrid(medium, emission);
  }
  return kSphere * emission;
}

MediumEmission::MediumEmission(std::vector<std::shared_ptr<const Medium>> media, const GeometryScene& geometry,
                               const BoundingSphere& within, int32_t exterior, std::optional<int32_t> unbounded)
    : media_(std::move(media)), geometry_(geometry), within_(within), exterior_(exterior), unbounded_(unbounded) {
  for (size_t i = 0; i < media_.size(); ++i) {
    if (media_[i]->IsEmissive()) Add(static_cast<int32_t>(i));
  }
  for (const Source& source : sources_) power_ += source.power;
}

void MediumEmission::Add(int32_t index) {
  const Medium& medium = *media_[static_cast<size_t>(index)];
  if (medium.IsHomogeneous()) {
    double volume = 0;
    sources_.push_back(BoundedSource(index, volume));
    sources_.back().power = kSphere * static_cast<double>(medium.At(Point3(0.0f)).emission.Average()) * volume;
  } else {
    double emission = 0;
    sources_.push_back({index, {RegionOfGrid(medium, emission)}, {1.0}});
    sources_.back().power = kSphere * emission;
  }
}

MediumEmission::Source MediumEmission::BoundedSource(int32_t index, double& volume) const {
  const Bounds3 within = BoxAround(within_);
  const float all[] = {1.0f};
  Source source{index, {EmissionRegion(within, {1, 1, 1}, all, Affine())}, {1.0}};
  const FoundPlace place = FindPlaceOf(geometry_, within, exterior_, index);
  if (place.box.IsEmpty()) {
    // The medium is smaller than the distance between rays.
    const double side = static_cast<double>(within_.radius) / 64;
    volume = side * side * side;
    return source;
  }
  volume = place.volume;
  source.regions.emplace_back(place.box, place.resolution, place.weights, Affine());
  const double everywhere = index == unbounded_ ? kUnbounded : kEverywhere;
  source.shares = {everywhere, 1 - everywhere};
  return source;
}

bool MediumEmission::IsThere(int32_t medium, const Point3& position, float time) const {
  if (glm::distance(position, within_.center) > within_.radius) return false;
  const FoundMedium found = FindMedium(geometry_, position, time);
  return found.medium.value_or(exterior_) == medium || (found.isOfOpaque && unbounded_ == medium);
}

std::optional<EmissionPoint> MediumEmission::Sample(double uSelect, const Vector3& u, float time) const {
  // In double, because the rest of the random number selects among many cells.
  double rest = uSelect * power_;
  size_t index = 0;
  while (index + 1 < sources_.size() && rest >= sources_[index].power) rest -= sources_[index++].power;
  const Source& source = sources_[index];
  rest = std::clamp(rest / source.power, 0.0, 1.0);
  size_t region = 0;
  if (source.regions.size() > 1) {
    region = rest < source.shares[0] ? 0 : 1;
    rest = region == 0 ? rest / source.shares[0] : (rest - source.shares[0]) / source.shares[1];
  }
  const EmissionRegion::Point point = source.regions[region].Sample(rest, u);
  EmissionPoint result;
  result.position = point.position;
  result.medium = source.medium;
  result.emission = media_[static_cast<size_t>(source.medium)]->At(point.position).emission;
  if (result.emission.IsBlack() || !IsThere(source.medium, point.position, time)) return std::nullopt;
  for (size_t i = 0; i < source.regions.size(); ++i) {
    const double density = i == region ? point.density : source.regions[i].Density(point.position);
    result.density += source.shares[i] * density;
  }
  result.density *= source.power / power_;
  return result;
}

}  // namespace lampyr
