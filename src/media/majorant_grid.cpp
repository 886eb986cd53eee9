#include "media/majorant_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace lampyr {

namespace {

constexpr double kInfinityDouble = std::numeric_limits<double>::infinity();

}  // namespace

MajorantGrid::MajorantGrid(const Bounds3& bounds, int nx, int ny, int nz, std::vector<float> majorants,
                           const Affine& toMedium)
    : bounds_(bounds), resolution_{nx, ny, nz}, majorants_(std::move(majorants)) {
  const glm::dmat3 linear(toMedium.linear);
  const Vector3d diagonal = Vector3d(bounds.max) - Vector3d(bounds.min);
  for (int axis = 0; axis < 3; ++axis) {
    const double cells = resolution_[axis] / diagonal[axis];
    for (int column = 0; column < 3; ++column) linear_[column][axis] = linear[column][axis] * cells;
    translation_[axis] =
        (static_cast<double>(toMedium.translation[axis]) - static_cast<double>(bounds.min[axis])) * cells;
  }
}

float MajorantGrid::At(const Point3& position) const {
  const Point3d p = linear_ * Point3d(position) + translation_;
  std::array<int, 3> cell;
  for (int axis = 0; axis < 3; ++axis) {
    if (!(p[axis] >= 0 && p[axis] <= resolution_[axis])) return 0;
    cell[axis] = std::min(static_cast<int>(p[axis]), resolution_[axis] - 1);
  }
  return majorants_[(static_cast<size_t>(cell[2]) * resolution_[1] + cell[1]) * resolution_[0] + cell[0]];
}

MajorantWalk::MajorantWalk(const MajorantGrid& grid, const RayDouble& ray)
    : grid_(&grid), origin_(grid.linear_ * ray.origin + grid.translation_), direction_(grid.linear_ * ray.direction) {
  double start = ray.tMin;
  tEnd_ = ray.tMax;
  for (int axis = 0; axis < 3; ++axis) {
    const double o = origin_[axis], d = direction_[axis], side = grid.resolution_[axis];
    if (d == 0) {
      if (!(o >= 0 && o <= side)) return;
      continue;
    }
    // The same expressions as in Crossing, so that the walk ends where this interval does.
    const double low = (0 - o) / d, high = (side - o) / d;
    start = std::max(start, std::min(low, high));
    tEnd_ = std::min(tEnd_, std::max(low, high));
  }
  if (!(start < tEnd_)) return;
  isDone_ = false;
  t_ = start;
  for (int axis = 0; axis < 3; ++axis) {
    const double position = origin_[axis] + (direction_[axis] == 0 ? 0 : start * direction_[axis]);
    const double last = grid.resolution_[axis] - 1;
    cell_[axis] = position > 0 ? static_cast<int>(std::min(position, last)) : 0;
    crossings_[axis] = Crossing(axis);
  }
}

double MajorantWalk::Crossing(int axis) const {
  const double d = direction_[axis];
  if (d == 0) return kInfinityDouble;
  return (cell_[axis] + (d > 0 ? 1 : 0) - origin_[axis]) / d;
}

float MajorantWalk::Majorant() const {
  const auto& [nx, ny, nz] = grid_->resolution_;
  return grid_->majorants_[(static_cast<size_t>(cell_[2]) * ny + cell_[1]) * nx + cell_[0]];
}

int MajorantWalk::NextAxis() const {
  const int axis = crossings_[1] < crossings_[0] ? 1 : 0;
  return crossings_[2] < crossings_[axis] ? 2 : axis;
}

double MajorantWalk::Step() {
  const int axis = NextAxis();
  const int next = cell_[axis] + (direction_[axis] > 0 ? 1 : -1);
  const double crossing = crossings_[axis];
  isDone_ = !(crossing < tEnd_) || next < 0 || next >= grid_->resolution_[axis];
  if (isDone_) return tEnd_;
  cell_[axis] = next;
  crossings_[axis] = Crossing(axis);
  return crossing;
}

bool MajorantWalk::Next(MajorantSegment& segment) {
  while (!isDone_) {
    segment.tMin = t_;
    segment.majorant = Majorant();
    double end = 0;
    do {
      end = Step();
    } while (!isDone_ && Majorant() == segment.majorant);
    segment.tMax = t_ = std::max(t_, end);
    if (segment.tMin < segment.tMax) return true;
  }
  return false;
}

}  // namespace lampyr
