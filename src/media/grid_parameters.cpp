#include "media/grid_parameters.h"

#include <algorithm>

namespace lampyr {

GridResolution GetGridResolution(const ParameterList& parameters) {
  GridResolution resolution;
  const char* names[3] = {"nx", "ny", "nz"};
  for (int axis = 0; axis < 3; ++axis) {
    resolution[axis] = parameters.GetInteger(names[axis], 1);
    if (resolution[axis] < 1)
      throw Error(parameters.WhereOf(names[axis]), std::string("\"") + names[axis] + "\" must be at least 1");
  }
  return resolution;
}

namespace {

// In double, because nx · ny · nz may exceed the range of integers.
double VoxelCount(const GridResolution& resolution) {
  return static_cast<double>(resolution[0]) * resolution[1] * resolution[2];
}

void CheckCount(const ParameterList& parameters, const std::string& name, size_t count,
                const GridResolution& resolution) {
  if (static_cast<double>(count) == VoxelCount(resolution)) return;
  throw Error(parameters.WhereOf(name),
              "\"" + name + "\" of " + parameters.Owner() + " needs a value for each of the nx · ny · nz = " +
                  std::to_string(resolution[0]) + " · " + std::to_string(resolution[1]) + " · " +
                  std::to_string(resolution[2]) + " voxels, and has " + std::to_string(count));
}

void TakeMemory(const MediumInput& input, const std::string& name, size_t bytes) {
  input.memory.Take(static_cast<double>(bytes), input.Parameters().WhereOf(name),
                    "the voxels of \"" + name + "\" of " + input.Parameters().Owner());
}

}  // namespace

std::vector<float> GetVoxels(const MediumInput& input, const std::string& name, const GridResolution& resolution,
                             bool isNonNegative) {
  const ParameterList& parameters = input.Parameters();
  const std::vector<double> given = parameters.GetFloats(name);
  if (!parameters.Find(name)) return {};
  CheckCount(parameters, name, given.size(), resolution);
  TakeMemory(input, name, given.size() * sizeof(float));
  std::vector<float> values;
  values.reserve(given.size());
  for (const double value : given) {
    if (isNonNegative && value < 0) {
      throw Error(parameters.WhereOf(name), "\"" + name + "\" of " + parameters.Owner() +
                                                " has a negative value, that "
                                                "of voxel " +
                                                std::to_string(values.size()) + " (counted from 0)");
    }
    values.push_back(static_cast<float>(value));
  }
  return values;
}

std::vector<Color> GetColorVoxels(const MediumInput& input, const std::string& name, const GridResolution& resolution,
                                  SpectrumRole role) {
  const ParameterList& parameters = input.Parameters();
  std::vector<Color> values = parameters.GetColors(name, role);
  if (!parameters.Find(name)) return {};
  CheckCount(parameters, name, values.size(), resolution);
  TakeMemory(input, name, values.size() * sizeof(Color));
  return values;
}

Affine GetToGrid(const MediumInput& input) {
  const Bounds3d box = GetBox(input.Parameters());
  return MakeToSpace(input.renderFromMedium * Transform::Translate(box.min) * Transform::Scale(box.Diagonal()), input);
}

float Largest(const std::vector<float>& values) {
  return *std::max_element(values.begin(), values.end());
}

Color LargestByChannel(const std::vector<Color>& values) {
  Color largest = values.front();
  for (const Color& value : values)
    largest = {std::max(largest.r, value.r), std::max(largest.g, value.g), std::max(largest.b, value.b)};
  return largest;
}

Color BrightestBlackbody(float kelvin) {
  // The luminance is at most ∫ ȳ dλ = 106.9, and no colour of a blackbody has a channel above ten times that.
  return kelvin > kColdestGlow ? Color(1069.0f) : Color(0.0f);
}

MajorantGrid MakeVoxelMajorants(const std::vector<float>& values, const GridResolution& resolution, float factor,
                                const Affine& toGrid) {
  const GridResolution cells = MajorantResolution(resolution);
  return {{Point3(0.0f), Point3(1.0f)},
          cells[0],
          cells[1],
          cells[2],
          MajorantsOf(values, resolution, cells, factor),
          toGrid};
}

}  // namespace lampyr
