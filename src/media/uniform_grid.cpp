// A medium whose coefficients are constant colours times a density, given on a grid of voxels.
#include <algorithm>

#include "media/box_medium.h"
#include "media/grid_parameters.h"
#include "media/medium_makers.h"

namespace lampyr {

namespace {

struct UniformGridData {
  ScatteringParameters scattering;
  GridResolution resolution{};
  std::vector<float> density;
  Color radiance;                    // L_e, unless there are temperatures
  std::vector<float> radianceScale;  // empty: 1
  std::vector<float> temperature;    // empty: none
  TemperatureScale temperatureScale;
  bool isEmissive = false;
};

class UniformGridMedium : public BoxMedium {
 public:
  UniformGridMedium(const std::string& name, UniformGridData data, const Affine& toGrid, MajorantGrid majorants)
      : BoxMedium(name, data.scattering.asymmetry, data.isEmissive, toGrid, std::move(majorants)),
        data_(std::move(data)) {}

  size_t Bytes() const override {
    return (data_.density.size() + data_.radianceScale.size() + data_.temperature.size()) * sizeof(float);
  }

 protected:
  MediumCoefficients AtInside(const Point3& p) const override {
    const VoxelStencil stencil = StencilAt(data_.resolution, p);
    const float density = stencil.Interpolate(data_.density);
    MediumCoefficients result{data_.scattering.absorption * density, data_.scattering.scattering * density, Color()};
    if (data_.isEmissive && density > 0) result.emission = result.absorption * Radiance(stencil);
    return result;
  }

 private:
  Color Radiance(const VoxelStencil& stencil) const {
    const float scale = data_.radianceScale.empty() ? 1.0f : stencil.Interpolate(data_.radianceScale);
    if (data_.temperature.empty()) return data_.radiance * scale;
    return BlackbodyTable::Get().At(data_.temperatureScale.Kelvin(stencil.Interpolate(data_.temperature))) * scale;
  }

  UniformGridData data_;
};

// Emission by a constant colour, or by temperatures; either may be scaled by voxel.
void ReadEmission(const MediumInput& input, UniformGridData& data) {
  const ParameterList& parameters = input.Parameters();
  data.radiance = GetEmittedRadiance(parameters);
  data.radianceScale = GetVoxels(input, "Lescale", data.resolution, true);
  data.temperature = GetVoxels(input, "temperature", data.resolution, false);
  data.temperatureScale = GetTemperatureScale(parameters);
  const float scale = data.radianceScale.empty() ? 1.0f : Largest(data.radianceScale);
  Color brightest = data.radiance * scale;
  if (!data.temperature.empty()) {
    if (parameters.Find("Le")) {
      throw Error(parameters.WhereOf("Le"), "\"Le\" and \"temperature\" exclude each other: one of them says how " +
                                                parameters.Owner() + " glows");
    }
    const float hottest = data.temperatureScale.Kelvin(Largest(data.temperature));
    CheckTemperature(hottest, parameters.WhereOf("temperature"));
    brightest = BrightestBlackbody(hottest) * scale;
  }
  const Color emission = data.scattering.absorption * Largest(data.density) * brightest;
  CheckRange(emission, "the emission of this medium", parameters.Where());
  data.isEmissive = !emission.IsBlack();
}

}  // namespace

std::shared_ptr<const Medium> MakeUniformGrid(const MediumInput& input) {
  const ParameterList& parameters = input.Parameters();
  UniformGridData data;
  data.scattering = GetScattering(parameters, false, true);
  data.resolution = GetGridResolution(parameters);
  data.density = GetVoxels(input, "density", data.resolution, true);
  if (data.density.empty()) {
    throw Error(parameters.Where(), parameters.Owner() + " needs \"float density\" [ … ], a value for each voxel");
  }
  const Color extinction = data.scattering.Extinction();
  CheckRange(extinction * Largest(data.density), "the extinction of this medium", parameters.Where());
  ReadEmission(input, data);
  const Affine toGrid = GetToGrid(input);
  parameters.CheckAllUsed({},
                          {"type", "nx", "ny", "nz", "density", "p0", "p1", "sigma_a", "sigma_s", "scale", "g", "Le",
                           "Lescale", "temperature", "temperaturescale", "temperatureoffset", "temperaturecutoff"},
                          input.diagnostics);
  MajorantGrid majorants = MakeVoxelMajorants(data.density, data.resolution, extinction.Max(), toGrid);
  return std::make_shared<UniformGridMedium>(input.description.name, std::move(data), toGrid, std::move(majorants));
}

}  // namespace lampyr
