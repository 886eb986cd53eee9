// Parameters of media that are given on a grid of voxels. Internal to media/.
#pragma once

#include "media/majorant_grid.h"
#include "media/medium_makers.h"
#include "media/voxels.h"

namespace lampyr {

// "nx", "ny" and "nz", each at least 1, default 1.
GridResolution GetGridResolution(const ParameterList& parameters);

// A value, or colour, for each voxel, x fastest; empty if the parameter is absent. Throws located Errors for another
// number of values, and for a negative one if `isNonNegative`.
std::vector<float> GetVoxels(const MediumInput& input, const std::string& name, const GridResolution& resolution,
                             bool isNonNegative);
std::vector<Color> GetColorVoxels(const MediumInput& input, const std::string& name, const GridResolution& resolution,
                                  SpectrumRole role);

// From render space to the space in which the grid's box (GetBox) is the unit cube.
Affine GetToGrid(const MediumInput& input);

// The largest value of a list that is not empty.
float Largest(const std::vector<float>& values);
Color LargestByChannel(const std::vector<Color>& values);

// An upper bound of the blackbody colours up to a temperature; black if those are dark.
Color BrightestBlackbody(float kelvin);

// Majorants over the unit cube, bounds of `factor` times the interpolated values.
MajorantGrid MakeVoxelMajorants(const std::vector<float>& values, const GridResolution& resolution, float factor,
                                const Affine& toGrid);

}  // namespace lampyr
