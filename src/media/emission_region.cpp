#include "media/emission_region.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "media/box_medium.h"
#include "sampling/rng.h"

namespace lampyr {

namespace {

// Points of a grid's cell at which its emission is looked up.
constexpr int kProbes = 8;
// Least weight of a grid's cell relative to the mean emission of all cells: times its majorant over the mean one.
constexpr double kLeastWeight = 0.05;

constexpr int kCellsOfPlace = 16;  // per axis
constexpr int kRaysToFind = 128;   // per axis of the squares that rays start from, to find the box
constexpr int kRaysToWeigh = 4;    // per axis and cell
constexpr float kLeastWeightOfPlace = 0.05f;

size_t CellCount(const std::array<int, 3>& resolution) {
  return static_cast<size_t>(resolution[0]) * static_cast<size_t>(resolution[1]) * static_cast<size_t>(resolution[2]);
}

size_t IndexOf(const std::array<int, 3>& resolution, const std::array<int, 3>& cell) {
  return (static_cast<size_t>(cell[2]) * static_cast<size_t>(resolution[1]) + static_cast<size_t>(cell[1])) *
             static_cast<size_t>(resolution[0]) +
         static_cast<size_t>(cell[0]);
}

std::array<int, 3> CellOf(const std::array<int, 3>& resolution, size_t index) {
  const auto nx = static_cast<size_t>(resolution[0]), ny = static_cast<size_t>(resolution[1]);
  return {static_cast<int>(index % nx), static_cast<int>(index / nx % ny), static_cast<int>(index / (nx * ny))};
}

double VolumeOf(const Bounds3& box) {
  const Vector3d d = Vector3d(box.max) - Vector3d(box.min);
  return d.x * d.y * d.z;
}

// The point of a cell at `u`.
Point3 PointIn(const Bounds3& box, const std::array<int, 3>& resolution, const std::array<int, 3>& cell,
               const Vector3& u) {
  Point3 point;
  for (int axis = 0; axis < 3; ++axis) {
    const float t = (static_cast<float>(cell[axis]) + u[axis]) / static_cast<float>(resolution[axis]);
    point[axis] = box.min[axis] + t * (box.max[axis] - box.min[axis]);
  }
  return point;
}

}  // namespace

EmissionRegion::EmissionRegion(const Bounds3& box, const std::array<int, 3>& resolution, std::span<const float> weights,
                               const Affine& toRender)
    : box_(box),
      resolution_(resolution),
      toRender_(toRender),
      fromRender_(toRender.Inverse()),
      cells_(weights),
      cellVolume_(VolumeOf(box) * std::abs(glm::determinant(glm::dmat3(toRender.linear))) /
                  static_cast<double>(CellCount(resolution))) {}

double EmissionRegion::DensityOf(uint32_t cell) const {
  return static_cast<double>(cells_.Probability(cell).value) / cellVolume_;
}

EmissionRegion::Point EmissionRegion::Sample(double uCell, const Vector3& u) const {
  const AliasTable::Result chosen = cells_.Sample(uCell);
  const Point3 inBox = PointIn(box_, resolution_, CellOf(resolution_, chosen.index), u);
  return {toRender_.Point(inBox), DensityOf(chosen.index)};
}

double EmissionRegion::Density(const Point3& position) const {
  const Point3 p = fromRender_.Point(position);
  std::array<int, 3> cell;
  for (int axis = 0; axis < 3; ++axis) {
    const float side = box_.max[axis] - box_.min[axis];
    if (!(p[axis] >= box_.min[axis] && p[axis] <= box_.max[axis])) return 0;
    const auto n = static_cast<float>(resolution_[axis]);
    cell[axis] = std::min(static_cast<int>((p[axis] - box_.min[axis]) / side * n), resolution_[axis] - 1);
  }
  return DensityOf(static_cast<uint32_t>(IndexOf(resolution_, cell)));
}

EmissionRegion RegionOfGrid(const Medium& medium, double& emission) {
  // All media with majorants are box media.
  const auto& boxed = dynamic_cast<const BoxMedium&>(medium);
  const MajorantGrid& grid = *medium.Majorants();
  const Affine toRender = boxed.ToSpace().Inverse();
  const std::vector<float>& majorants = grid.Values();
  std::vector<float> weights(majorants.size());
  double sum = 0, majorantSum = 0;
  Rng rng(majorants.size());
  for (size_t i = 0; i < majorants.size(); ++i) {
    if (!(majorants[i] > 0)) continue;
    majorantSum += static_cast<double>(majorants[i]);
    const std::array<int, 3> cell = CellOf(grid.Resolution(), i);
    double mean = 0;
    for (int k = 0; k < kProbes; ++k) {
      const Vector3 corner(static_cast<float>(k & 1), static_cast<float>(k >> 1 & 1), static_cast<float>(k >> 2));
      const Vector3 u = 0.5f * (corner + Vector3(rng.NextFloat(), rng.NextFloat(), rng.NextFloat()));
      const Point3 inBox = PointIn(grid.Bounds(), grid.Resolution(), cell, u);
      mean += static_cast<double>(medium.At(toRender.Point(inBox)).emission.Average()) / kProbes;
    }
    weights[i] = static_cast<float>(mean);
    sum += mean;
  }
  // A medium whose probes are all dark may still emit.
  const double perMajorant = sum > 0 ? kLeastWeight * sum / majorantSum : 1;
  for (size_t i = 0; i < majorants.size(); ++i)
    weights[i] += static_cast<float>(perMajorant * static_cast<double>(majorants[i]));
  EmissionRegion region(grid.Bounds(), grid.Resolution(), weights, toRender);
  emission = (sum > 0 ? sum : majorantSum) / static_cast<double>(majorants.size()) * VolumeOf(grid.Bounds()) *
             std::abs(glm::determinant(glm::dmat3(toRender.linear)));
  return region;
}

namespace {

// Calls visit(axis, ray, tMin, tMax) for the parts in `medium` of n × n parallel rays through a box along each axis, at
// each of the times. The rays start at the side of `within`, in `exterior`.
template <class Visit>
void ScanBox(const GeometryScene& geometry, const Bounds3& within, const Bounds3& box, int n,
             std::span<const float> times, int32_t exterior, int32_t medium, const Visit& visit) {
  for (int axis = 0; axis < 3; ++axis) {
    const int second = (axis + 1) % 3, third = (axis + 2) % 3;
    for (int k = 0; k < n * n; ++k) {
      Ray ray;
      const auto at = [&](int side, int step) {
        const float t = (static_cast<float>(step) + 0.5f) / static_cast<float>(n);
        return box.min[side] + t * (box.max[side] - box.min[side]);
      };
      ray.origin[axis] = within.min[axis];
      ray.origin[second] = at(second, k % n);
      ray.origin[third] = at(third, k / n);
      ray.direction = Vector3(0.0f);
      ray.direction[axis] = 1;
      ray.tMax = within.max[axis] - within.min[axis];
      for (const float time : times) {
        ray.time = time;
        ForEachSpan(geometry, ray, exterior, medium, [&](float tMin, float tMax) { visit(axis, ray, tMin, tMax); });
      }
    }
  }
}

// Adds the cells' parts of the interval [from, to] along an axis, in units of cells.
void AddToCells(std::array<int, 3> cell, int axis, double from, double to, FoundPlace& place) {
  const double most = place.resolution[static_cast<size_t>(axis)];
  from = std::max(from, 0.0);
  to = std::min(to, most);
  for (int i = static_cast<int>(from); i < to; ++i) {
    cell[static_cast<size_t>(axis)] = i;
    const double part = std::min(to, i + 1.0) - std::max(from, static_cast<double>(i));
    place.weights[IndexOf(place.resolution, cell)] += static_cast<float>(part);
  }
}

// The box of the surfaces that bound a medium, not flat, within the scene's box; for the medium around the scene, the
// scene's box.
Bounds3 BoxToScan(const Bounds3& within, const MediumSurfaces& surfaces, bool isExterior) {
  if (isExterior || surfaces.box.IsEmpty()) return within;
  constexpr float kThickness = 1e-3f;
  const Vector3 diagonal = surfaces.box.Diagonal();
  const Vector3 margin(kThickness * std::max({diagonal.x, diagonal.y, diagonal.z}));
  Bounds3 box;
  box.min = glm::max(surfaces.box.min - margin, within.min);
  box.max = glm::min(surfaces.box.max + margin, within.max);
  return box;
}

constexpr float kOpen[] = {0.0f};
constexpr float kShutter[] = {0.0f, 0.25f, 0.5f, 0.75f, 1.0f};

}  // namespace

FoundPlace FindPlaceOf(const GeometryScene& geometry, const Bounds3& within, int32_t exterior, int32_t medium) {
  FoundPlace place;
  const MediumSurfaces surfaces = geometry.SurfacesOf(medium);
  const Bounds3 scanned = BoxToScan(within, surfaces, medium == exterior);
  const std::span<const float> times = surfaces.move ? std::span<const float>(kShutter) : std::span<const float>(kOpen);
  Bounds3 found;
  const Vector3 spacing = scanned.Diagonal() / static_cast<float>(kRaysToFind);
  ScanBox(geometry, within, scanned, kRaysToFind, times, exterior, medium,
          [&](int, const Ray& ray, float tMin, float tMax) {
            found.Add(ray.origin + tMin * ray.direction);
            found.Add(ray.origin + tMax * ray.direction);
          });
  if (found.IsEmpty()) return place;
  place.box.min = glm::max(found.min - spacing, scanned.min);
  place.box.max = glm::min(found.max + spacing, scanned.max);
  place.resolution = {kCellsOfPlace, kCellsOfPlace, kCellsOfPlace};
  place.weights.resize(CellCount(place.resolution));
  const Vector3d cellSide = Vector3d(place.box.Diagonal()) / static_cast<double>(kCellsOfPlace);
  constexpr int kRays = kRaysToWeigh * kCellsOfPlace;
  const auto add = [&](int axis, const Ray& ray, float tMin, float tMax) {
    std::array<int, 3> cell{};
    for (int i = 0; i < 3; ++i) {
      const double at = static_cast<double>(ray.origin[i] - place.box.min[i]) / cellSide[i];
      cell[static_cast<size_t>(i)] = std::clamp(static_cast<int>(at), 0, kCellsOfPlace - 1);
    }
    const double start = static_cast<double>(ray.origin[axis] - place.box.min[axis]);
    AddToCells(cell, axis, (start + static_cast<double>(tMin)) / cellSide[axis],
               (start + static_cast<double>(tMax)) / cellSide[axis], place);
  };
  ScanBox(geometry, within, place.box, kRays, times, exterior, medium, add);
  double full = 0;
  for (float& weight : place.weights) {
    const float part = weight / (3.0f * kRaysToWeigh * kRaysToWeigh * static_cast<float>(times.size()));
    full += static_cast<double>(part);
    // Cells that no ray finds may contain a part of the medium.
    weight = std::max(std::sqrt(part), kLeastWeightOfPlace);
  }
  place.volume = full * cellSide.x * cellSide.y * cellSide.z;
  if (!(full > 0)) place.box = Bounds3();
  return place;
}

}  // namespace lampyr
