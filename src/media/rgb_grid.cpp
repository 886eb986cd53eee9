// A medium whose coefficients and emission are colours on a grid of voxels.
#include <algorithm>

#include "media/box_medium.h"
#include "media/grid_parameters.h"
#include "media/medium_makers.h"

namespace lampyr {

namespace {

struct RgbGridData {
  GridResolution resolution{};
  std::vector<Color> absorption, scattering;  // empty: 1
  std::vector<Color> radiance;                // empty: none
  float scale = 1, radianceScale = 1;
  float asymmetry = 0;
  bool isEmissive = false;
};

class RgbGridMedium : public BoxMedium {
 public:
  RgbGridMedium(const std::string& name, RgbGridData data, const Affine& toGrid, MajorantGrid majorants)
      : BoxMedium(name, data.asymmetry, data.isEmissive, toGrid, std::move(majorants)), data_(std::move(data)) {}

  size_t Bytes() const override {
    return (data_.absorption.size() + data_.scattering.size() + data_.radiance.size()) * sizeof(Color);
  }

 protected:
  MediumCoefficients AtInside(const Point3& p) const override {
    const VoxelStencil stencil = StencilAt(data_.resolution, p);
    const auto coefficient = [&](const std::vector<Color>& values) {
      return (values.empty() ? Color(1.0f) : stencil.Interpolate(values)) * data_.scale;
    };
    MediumCoefficients result{coefficient(data_.absorption), coefficient(data_.scattering), Color()};
    if (data_.isEmissive)
      result.emission = result.absorption * (stencil.Interpolate(data_.radiance) * data_.radianceScale);
    return result;
  }

 private:
  RgbGridData data_;
};

RgbGridData ReadRgbGrid(const MediumInput& input) {
  const ParameterList& parameters = input.Parameters();
  RgbGridData data;
  data.resolution = GetGridResolution(parameters);
  data.absorption = GetColorVoxels(input, "sigma_a", data.resolution, SpectrumRole::Extinction);
  data.scattering = GetColorVoxels(input, "sigma_s", data.resolution, SpectrumRole::Extinction);
  data.radiance = GetColorVoxels(input, "Le", data.resolution, SpectrumRole::Illuminant);
  if (data.absorption.empty() && data.scattering.empty()) {
    throw Error(parameters.Where(),
                parameters.Owner() + " needs \"rgb sigma_a\" or \"rgb sigma_s\", a colour for each voxel");
  }
  if (!data.radiance.empty() && data.absorption.empty()) {
    throw Error(parameters.WhereOf("Le"), "\"Le\" of " + parameters.Owner() +
                                              " needs \"rgb sigma_a\": the emission is "
                                              "their product");
  }
  data.scale = GetNonNegative(parameters, "scale", 1);
  data.radianceScale = GetNonNegative(parameters, "Lescale", 1);
  data.asymmetry = GetAsymmetry(parameters);
  const Color absorption = data.absorption.empty() ? Color(1.0f) : LargestByChannel(data.absorption);
  const Color scattering = data.scattering.empty() ? Color(1.0f) : LargestByChannel(data.scattering);
  CheckRange((absorption + scattering) * data.scale, "the extinction of this medium", parameters.Where());
  if (data.radiance.empty()) return data;
  const Color emission = absorption * data.scale * (LargestByChannel(data.radiance) * data.radianceScale);
  CheckRange(emission, "the emission of this medium", parameters.Where());
  data.isEmissive = !emission.IsBlack();
  return data;
}

MajorantGrid MakeMajorants(const RgbGridData& data, const Affine& toGrid) {
  // A constant coefficient does not fall off at the sides of the box, so that it is added to the bounds of the grid.
  const bool isConstant[2] = {data.absorption.empty(), data.scattering.empty()};
  const std::vector<Color>& first = isConstant[0] ? data.scattering : data.absorption;
  std::vector<float> extinction;
  extinction.reserve(first.size());
  for (size_t i = 0; i < first.size(); ++i) {
    const Color sum = isConstant[0] || isConstant[1] ? first[i] : first[i] + data.scattering[i];
    extinction.push_back(sum.Max());
  }
  const MajorantGrid grid = MakeVoxelMajorants(extinction, data.resolution, data.scale, toGrid);
  std::vector<float> majorants = grid.Values();
  if (isConstant[0] || isConstant[1]) {
    for (float& majorant : majorants) majorant += data.scale * kMajorantMargin;
  }
  const auto& [nx, ny, nz] = grid.Resolution();
  return {grid.Bounds(), nx, ny, nz, std::move(majorants), toGrid};
}

}  // namespace

std::shared_ptr<const Medium> MakeRgbGrid(const MediumInput& input) {
  const ParameterList& parameters = input.Parameters();
  RgbGridData data = ReadRgbGrid(input);
  const Affine toGrid = GetToGrid(input);
  parameters.CheckAllUsed({},
                          {"type", "nx", "ny", "nz", "p0", "p1", "sigma_a", "sigma_s", "scale", "g", "Le", "Lescale"},
                          input.diagnostics);
  MajorantGrid majorants = MakeMajorants(data, toGrid);
  return std::make_shared<RgbGridMedium>(input.description.name, std::move(data), toGrid, std::move(majorants));
}

}  // namespace lampyr
