// Dense grids of voxels over the unit cube, x fastest, interpolated trilinearly between the centres of voxels. As in
// pbrt-v4, all is 0 beyond the grid, so that values fall off within half a voxel of the cube's sides.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "math/vec.h"

namespace lampyr {

using GridResolution = std::array<int, 3>;

// The voxels around a point and their weights; those beyond the grid have weight 0.
struct VoxelStencil {
  std::array<size_t, 8> index;
  std::array<float, 8> weight;

  float Interpolate(const std::vector<float>& values) const;
  Color Interpolate(const std::vector<Color>& values) const;
};

// `point`: in the unit cube.
VoxelStencil StencilAt(const GridResolution& resolution, const Point3& point);

// Resolution of a grid of majorants over a grid of voxels: one cell per voxel up to 16 cells per axis, and about one
// per 8 voxels, up to 64, of grids with more than 128.
GridResolution MajorantResolution(const GridResolution& voxels);

// Upper bounds of the interpolated values in the cells of a grid that is not finer than the voxels, times `factor` ≥ 0.
// Each bound also holds a little beyond its cell and for values that are rounded up, because points are in float.
std::vector<float> MajorantsOf(std::span<const float> values, const GridResolution& voxels, const GridResolution& cells,
                               float factor);

// Relative enlargement of a cell of majorants, and of its majorant, to allow for rounding.
inline constexpr double kCellMargin = 0.01;
inline constexpr float kMajorantMargin = 1.00001f;

}  // namespace lampyr
