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
  for (int axis = 0; axis < 3; ++axis) cells[axis] = std::clamp(voxels[axis] / 8, std::min(voxels[axis], 16), 64);
  return cells;
}

namespace {

// A line of voxels, `stride` apart.
struct Line {
  const float* first;
  size_t stride;
  int count;

  float Value(int i) const { return i >= 0 && i < count ? first[static_cast<size_t>(i) * stride] : 0.0f; }
  // Interpolates between the centres of voxels, which have integer coordinates.
  float Interpolate(double x) const {
    const int i = static_cast<int>(std::floor(x));
    const auto part = static_cast<float>(x - i);
    return Value(i) * (1 - part) + Value(i + 1) * part;
  }
};

// The largest interpolated value of the line within a cell: that of a voxel, or at an end.
float MaximumWithin(const Line& line, int cell, int cells) {
  const double low = (cell - kCellMargin) / cells * line.count - 0.5;
  const double high = (cell + 1 + kCellMargin) / cells * line.count - 0.5;
  float most = std::max(line.Interpolate(low), line.Interpolate(high));
  for (int i = static_cast<int>(std::ceil(low)); i <= high; ++i) most = std::max(most, line.Value(i));
  return most;
}

// Maxima within cells of all lines along an axis: a grid of another resolution along that axis.
std::vector<float> MaximaAlong(int axis, std::span<const float> values, const GridResolution& resolution, int cells) {
  size_t stride = 1;  // from voxel to voxel of a line; as many lines start side by side
  for (int i = 0; i < axis; ++i) stride *= static_cast<size_t>(resolution[i]);
  const auto count = static_cast<size_t>(resolution[axis]);
  const size_t slabs = values.size() / (stride * count);
  std::vector<float> maxima(slabs * static_cast<size_t>(cells) * stride);
  for (size_t outer = 0; outer < slabs; ++outer) {
    for (int cell = 0; cell < cells; ++cell) {
      float* out = &maxima[(outer * static_cast<size_t>(cells) + static_cast<size_t>(cell)) * stride];
      for (size_t inner = 0; inner < stride; ++inner)
        out[inner] = MaximumWithin({&values[outer * count * stride + inner], stride, resolution[axis]}, cell, cells);
    }
  }
  return maxima;
}

}  // namespace

// Axis by axis: f(x, y, z) is interpolated in y from f(x, j, z), each of which is at most its maximum over the cell's
// x.
std::vector<float> MajorantsOf(std::span<const float> values, const GridResolution& voxels, const GridResolution& cells,
                               float factor) {
  std::vector<float> majorants = MaximaAlong(0, values, voxels, cells[0]);
  majorants = MaximaAlong(1, majorants, {cells[0], voxels[1], voxels[2]}, cells[1]);
  majorants = MaximaAlong(2, majorants, {cells[0], cells[1], voxels[2]}, cells[2]);
  for (float& majorant : majorants) majorant *= factor * kMajorantMargin;
  return majorants;
}

}  // namespace lampyr
