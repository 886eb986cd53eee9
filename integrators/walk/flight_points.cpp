#include "integrators/walk/flight_points.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "sampling/rng.h"

namespace lampyr {

namespace {

// Optical depth up to which every sampled point is used: of the way to the camera, or of the sphere around the media.
constexpr double kDepthOfTaken = 4;

// The largest extinction of a medium, 1/scene unit.
double MostExtinction(const Medium& medium) {
  if (medium.IsHomogeneous()) return static_cast<double>(medium.At(Point3(0.0f)).Extinction().Max());
  const std::vector<float>& majorants = medium.Majorants()->Values();
  return majorants.empty() ? 0.0 : static_cast<double>(*std::max_element(majorants.begin(), majorants.end()));
}

// True if the medium fills the space around the camera, or around everything.
bool IsAround(const RenderScene& scene, int32_t medium) {
  return medium == scene.exterior || medium == scene.cameraExterior || medium == scene.unbounded ||
         medium == scene.cameraMedium;
}

// True if the camera may see the medium along straight lines.
bool IsSeen(const RenderScene& scene, int32_t medium, const MediumSurfaces& surfaces) {
  return surfaces.passesStraight || IsAround(scene, medium);
}
// Equiangular density, for a point at `height` above the line that sees the range under `angle`. `x`: from its foot.
double EquiangularDensity(double height, double angle, double x) {
  return height / (angle * (height * height + x * x));
}

}  // namespace

std::optional<BoundingSphere> SphereOfMedia(const RenderScene& scene, bool seenAlone) {
  Bounds3 box;
  bool isUnbounded = false, isAny = false;
  const std::vector<MediumSurfaces> allSurfaces = scene.geometry->SurfacesOfAll(scene.media.size());
  for (size_t i = 0; i < scene.media.size(); ++i) {
    const auto index = static_cast<int32_t>(i);
    if (!scene.media[i]->Scatters() || (seenAlone && !IsSeen(scene, index, allSurfaces[i]))) continue;
    const bool isAround = IsAround(scene, index);
    if (allSurfaces[i].box.IsEmpty() && !isAround) continue;  // named, but not used
    isAny = true;
    box.Add(allSurfaces[i].box);
    isUnbounded = isUnbounded || isAround;
  }
  if (!isAny) return std::nullopt;
  if (isUnbounded) return scene.lighting->SceneSphere();
  return BoundingSphere{box.Center(), static_cast<float>(0.5 * glm::length(Vector3d(box.Diagonal())))};
}

std::shared_ptr<const FlightPoints> FlightPoints::Of(const RenderScene& scene) {
  if (scene.media.empty()) return nullptr;
  const std::optional<CameraView> view = scene.camera->ConnectsLightPaths() ? scene.camera->View() : std::nullopt;
  if (!view) return nullptr;
  std::shared_ptr<FlightPoints> points(new FlightPoints);
  points->place_ = Point3d(view->place);
  for (const Vector3& plane : view->planes) points->planes_.emplace_back(plane);
  const std::optional<BoundingSphere> sphere = SphereOfMedia(scene, true);
  if (!sphere) return nullptr;
  points->center_ = Point3d(sphere->center);
  points->radius_ = static_cast<double>(sphere->radius);
  points->extinctions_.assign(scene.media.size(), -1);
  const std::vector<MediumSurfaces> allSurfaces = scene.geometry->SurfacesOfAll(scene.media.size());
  for (size_t i = 0; i < scene.media.size(); ++i) {
    if (scene.media[i]->Scatters() && IsSeen(scene, static_cast<int32_t>(i), allSurfaces[i]))
      points->extinctions_[i] = MostExtinction(*scene.media[i]);
  }
  return points;
}

double FlightPoints::ShareAt(const Point3d& position, int32_t medium) const {
  const double extinction = extinctions_[static_cast<size_t>(medium)];
  if (extinction < 0) return 0;
  const double depth = extinction * std::min(glm::distance(position, place_), 2 * radius_);
  return depth > kDepthOfTaken ? kDepthOfTaken / depth : 1.0;
}

// The part of the line in the sphere, before all planes, and beyond `least`. Directions are rounded to float and not
// exactly unit: for a distant sphere, the error of a squared distance to its centre would exceed the sphere.
FlightPoints::Range FlightPoints::RangeOf(const Point3d& origin, const Vector3d& direction, double least) const {
  Range range;
  const Vector3d toCenter = center_ - origin;
  const double length = glm::dot(direction, direction);  // squared
  const double middle = glm::dot(toCenter, direction) / length;
  const Vector3d across = toCenter - middle * direction;
  const double squared = radius_ * radius_ - glm::dot(across, across);
  if (!(squared > 0)) return range;
  const double half = std::sqrt(squared / length);
  range.from = std::max(middle - half, least);
  range.to = middle + half;
  const Vector3d fromPlace = origin - place_;
  for (const Vector3d& normal : planes_) {
    const double before = glm::dot(fromPlace, normal), slope = glm::dot(direction, normal);
    if (slope > 0) {
      range.from = std::max(range.from, -before / slope);
    } else if (slope < 0) {
      range.to = std::min(range.to, -before / slope);
    } else if (before < 0) {
      return range;
    }
  }
  if (!(range.to > range.from)) return range;
  range.foot = -glm::dot(fromPlace, direction) / length;
  // Lower bounds of the height of the camera above the line: directions in float resolve no smaller one, and the
  // density stays finite.
  constexpr double kSpacing = 0x1p-16, kOfRadius = 0x1p-30;
  const double furthest = std::max(std::abs(range.from - range.foot), std::abs(range.to - range.foot));
  range.height = std::max({glm::length(fromPlace + range.foot * direction), kSpacing * furthest, kOfRadius * radius_,
                           std::numeric_limits<double>::min()});
  // The difference of two angles, accurate where it is tiny.
  const double start = range.from - range.foot, end = range.to - range.foot;
  range.angle = std::atan2(range.height * (range.to - range.from), range.height * range.height + start * end);
  return range;
}

std::optional<FlightPoints::Sample> FlightPoints::Generate(const FineLine& line, bool startsAnywhere, double u) const {
  constexpr double kAnywhere = -std::numeric_limits<double>::infinity();
  const Range range = RangeOf(line.start, line.direction, startsAnywhere ? kAnywhere : 0.0);
  if (!(range.angle > 0)) return std::nullopt;
  const double start = std::atan2(range.from - range.foot, range.height);
  const double x = range.height * std::tan(start + u * range.angle);
  const double t = std::clamp(range.foot + x, range.from, range.to);
  const double density = EquiangularDensity(range.height, range.angle, x);
  if (!(t > 0) || !(density > 0) || !std::isfinite(density)) return std::nullopt;
  return Sample{t, density};
}

double FlightPoints::Density(const Point3d& position, const Vector3d& toStart, double distance, int32_t medium) const {
  const double share = ShareAt(position, medium);
  if (!(share > 0)) return 0;
  const Range range = RangeOf(position, -toStart, -distance);
  if (!(range.angle > 0) || range.from > 0 || range.to < 0) return 0;
  return share * EquiangularDensity(range.height, range.angle, range.foot);
}

bool AddFlightVertex(const SampleContext& context, const FlightPoints& points, const PathState& state,
                     const Flight& flight, const EmittedPhoton* photon, Sampler& sampler, uint32_t dimension,
                     LightPath& path) {
  const bool isFirst = path.vertices.Count() == 0;
  const LightingServices& lighting = *context.scene.lighting;
  sampler.SetDimension(dimension);
  const Point2 u = sampler.Get2D();
  const bool startsAnywhere = isFirst && photon && lighting.IsAtInfinity(photon->light);
  const auto sample = points.Generate(flight.line, startsAnywhere, static_cast<double>(u.x));
  if (!sample || (isFirst && photon && sample->t < static_cast<double>(photon->emission.shinesFrom))) return false;
  const auto span = std::find_if(flight.spans.begin(), flight.spans.end(),
                                 [&](const MediumSpan& one) { return sample->t >= one.tMin && sample->t < one.tMax; });
  if (span == flight.spans.end()) return false;
  const double share = points.ShareAt(flight.line.start + sample->t * flight.line.direction, span->medium);
  if (!(static_cast<double>(u.y) < share)) return false;
  const uint64_t decider = Hash(std::bit_cast<uint32_t>(u.x), std::bit_cast<uint32_t>(u.y));
  const auto point = PointOnFlight(context, flight, sample->t, decider);
  if (!point) return false;
  PathVertex& vertex = path.vertices.Next();
  MakeVertexInMedium(context.scene, point->position, state.ray.direction, point->index,
                     {point->coefficients.scattering, point->medium->Asymmetry()}, point->coefficients.Extinction(),
                     vertex);
  vertex.factors = point->factors;
  vertex.isDispersed = state.isDispersed;
  vertex.diffuse = state.diffuse;
  vertex.specular = state.specular;
  if (isFirst && photon && !lighting.FilterFirstHit(*photon, vertex.receiver, vertex.diffuse, vertex.specular))
    return false;
  const Color scale = point->transmittance / static_cast<float>(share * sample->density);
  vertex.diffuse *= scale;
  vertex.specular *= scale;
  path.vertices.Add();
  if (context.outputs) path.vertices.LabelLast(*context.outputs, TransportMode::Importance, state.event);
  return true;
}

double FlightPoints::RatioAt(const Vertex& vertex, const Vector3& toStart, double distance, double collision) const {
  if (!vertex.IsInMedium() || !(collision > 0)) return 0;
  return Density(vertex.Position(), Vector3d(toStart), distance, vertex.insideMedium) / collision;
}

}  // namespace lampyr
