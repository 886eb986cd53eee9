#include "media/voxels.h"

#include <algorithm>
#include <cmath>

namespace lampyr {

float VoxelStencil::Interpolate(const std::vector<float>& values) const {
  float sum = 0;
  for (size_t i = 0; i < 8; ++i) sum += weight[i] * values[index[i]];
  return sum;
}

Color VoxelStencil::Interpolate(const std::vector<Color>& values) const {
  Color sum;
  for (size_t i = 0; i < 8; ++i) sum += weight[i] * values[index[i]];
  return sum;
}

VoxelStencil StencilAt(const GridResolution& resolution, const Point3& point) {
  std::array<std::array<size_t, 2>, 3> index;
  std::array<std::array<float, 2>, 3> weight;
  for (int axis = 0; axis < 3; ++axis) {
    const int n = resolution[axis];
    const float x = point[axis] * static_cast<float>(n) - 0.5f;
    const float low = std::clamp(std::floor(x), -1.0f, static_cast<float>(n - 1));
    const int i = static_cast<int>(low);
    const float above = std::clamp(x - low, 0.0f, 1.0f);
    weight[axis] = {i >= 0 ? 1 - above : 0.0f, i + 1 < n ? above : 0.0f};
    index[axis] = {static_cast<size_t>(std::max(i, 0)), static_cast<size_t>(std::min(i + 1, n - 1))};
  }
  VoxelStencil stencil;
  const auto nx = static_cast<size_t>(resolution[0]), ny = static_cast<size_t>(resolution[1]);
  for (size_t corner = 0; corner < 8; ++corner) {
    const size_t x = corner & 1, y = corner >> 1 & 1, z = corner >> 2;
    stencil.index[corner] = (index[2][z] * ny + index[1][y]) * nx + index[0][x];
    stencil.weight[corner] = weight[0][x] * weight[1][y] * weight[2][z];
  }
  return stencil;
}

GridResolution MajorantResolution(const GridResolution& voxels) {
  GridResolution cells;
  for (int axis = 0; axis < 3; ++axis) cells[axis] = std::clamp(voxels[axis] / 8, 16, 64);
  return cells;
}

namespace {

struct Range {
  int first = 0, last = 0;  // both included
};

// The voxels that the values in a cell are interpolated from.
Range VoxelsOf(int cell, int cells, int voxels) {
  const double low = (cell - kCellMargin) / cells * voxels - 0.5,
               high = (cell + 1 + kCellMargin) / cells * voxels - 0.5;
  return {std::clamp(static_cast<int>(std::floor(low)), 0, voxels - 1),
          std::clamp(static_cast<int>(std::floor(high)) + 1, 0, voxels - 1)};
}

float MaximumOf(std::span<const float> values, const GridResolution& voxels, Range x, Range y, Range z) {
  const auto nx = static_cast<size_t>(voxels[0]), ny = static_cast<size_t>(voxels[1]);
  float most = 0;
  for (int plane = z.first; plane <= z.last; ++plane) {
    for (int row = y.first; row <= y.last; ++row) {
      const float* line = &values[(static_cast<size_t>(plane) * ny + static_cast<size_t>(row)) * nx];
      for (int column = x.first; column <= x.last; ++column) most = std::max(most, line[column]);
    }
  }
  return most;
}

}  // namespace

std::vector<float> MajorantsOf(std::span<const float> values, const GridResolution& voxels, const GridResolution& cells,
                               float factor) {
  std::vector<float> bounds;
  for (int z = 0; z < cells[2]; ++z) {
    for (int y = 0; y < cells[1]; ++y) {
      for (int x = 0; x < cells[0]; ++x) {
        const float most = MaximumOf(values, voxels, VoxelsOf(x, cells[0], voxels[0]), VoxelsOf(y, cells[1], voxels[1]),
                                     VoxelsOf(z, cells[2], voxels[2]));
        bounds.push_back(most * factor * kMajorantMargin);
      }
    }
  }
  return bounds;
}

}  // namespace lampyr
