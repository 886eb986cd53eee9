// A medium from a NanoVDB file: a grid of densities and, for fire, one of temperatures.
#include <algorithm>

#include "base/mapped_file.h"
#include "media/box_medium.h"
#include "media/grid_parameters.h"
#include "media/medium_makers.h"
#include "media/nanovdb_file.h"

namespace lampyr {

namespace {

struct NanoVdbData {
  ScatteringParameters scattering;
  std::shared_ptr<const SparseVoxels> density, temperature;  // temperature: null if there is none
  Affine densityToTemperature;                               // of indices
  TemperatureScale temperatureScale;
  float radianceScale = 1;
  bool isEmissive = false;
};

// The box's space is that of the indices of densities, in which the box is [min, max + 1], as in pbrt-v4.
class NanoVdbMedium : public BoxMedium {
 public:
  NanoVdbMedium(const std::string& name, NanoVdbData data, const Affine& toIndex, MajorantGrid majorants)
      : BoxMedium(name, data.scattering.asymmetry, data.isEmissive, toIndex, std::move(majorants)),
        data_(std::move(data)) {}

  size_t Bytes() const override {
    return data_.density->Bytes() + (data_.temperature ? data_.temperature->Bytes() : 0);
  }

 protected:
  MediumCoefficients AtInside(const Point3& p) const override {
    const float density = data_.density->Interpolate(p);
    MediumCoefficients result{data_.scattering.absorption * density, data_.scattering.scattering * density, Color()};
    if (data_.isEmissive && density > 0) {
      const float value = data_.temperature->Interpolate(data_.densityToTemperature.Point(p));
      result.emission =
          result.absorption * (BlackbodyTable::Get().At(data_.temperatureScale.Kelvin(value)) * data_.radianceScale);
    }
    return result;
  }

 private:
  NanoVdbData data_;
};

// The largest value that interpolation may return, the background included; at least 0.
float LargestOf(const SparseVoxels& voxels) {
  IndexBox box = voxels.Box();
  for (int& upper : box.max) ++upper;
  return std::max(voxels.Maximum(box), voxels.Background());
}

struct NanoVdbGrids {
  NanoVdbGrid density;
  std::optional<NanoVdbGrid> temperature;
};

Error MissingGrid(const NanoVdbReader& reader, const std::string& name) {
  std::string names;
  for (const std::string& known : reader.Names()) names += (names.empty() ? "\"" : ", \"") + known + "\"";
  return Error("it has no grid \"" + name + "\"" + DidYouMean(name, reader.Names()) + "; there is: " + names);
}

NanoVdbGrids ReadGrids(const MediumInput& input) {
  const ParameterList& parameters = input.Parameters();
  const std::string file = parameters.GetFile("filename");
  if (file.empty()) throw Error(parameters.Where(), parameters.Owner() + " needs \"string filename\"");
  const FileLocation where = parameters.WhereOf("filename");
  const std::string densityName = parameters.GetString("gridname", "density");
  const std::string temperatureName = parameters.GetString("temperaturename", "temperature");
  try {
    const MappedFile mapped(file);
    const NanoVdbReader reader(mapped.Bytes());
    auto density = reader.Read(densityName, false, input.memory, where);
    if (!density) throw MissingGrid(reader, densityName);
    auto temperature = reader.Read(temperatureName, true, input.memory, where);
    if (!temperature && parameters.Find("temperaturename")) throw MissingGrid(reader, temperatureName);
    return {std::move(*density), std::move(temperature)};
  } catch (const Error& error) {
    if (error.Where().file) throw;  // of memory, not of the file
    throw Error(where, "\"" + file + "\" cannot be used as a volume: " + error.Text());
  }
}

// Emission by the temperatures, if the file has them.
void ReadEmission(const MediumInput& input, NanoVdbGrids& grids, float densest, NanoVdbData& data) {
  const ParameterList& parameters = input.Parameters();
  data.radianceScale =
      GetNonNegative(parameters, "Lescale", static_cast<double>(GetNonNegative(parameters, "LeScale", 1)));
  data.temperatureScale = GetTemperatureScale(parameters);
  if (!grids.temperature) return;
  const float hottest = data.temperatureScale.Kelvin(LargestOf(grids.temperature->voxels));
  CheckTemperature(hottest, parameters.WhereOf("filename"));
  const Color emission = data.scattering.absorption * densest * (BrightestBlackbody(hottest) * data.radianceScale);
  CheckRange(emission, "the emission of this medium", parameters.Where());
  data.isEmissive = !emission.IsBlack();
  if (!data.isEmissive) return;
  data.densityToTemperature = (grids.temperature->indexToMedium.Inverse() * grids.density.indexToMedium).ToAffine();
  data.temperature = std::make_shared<SparseVoxels>(std::move(grids.temperature->voxels));
}

MajorantGrid MakeMajorants(const SparseVoxels& density, float extinction, const Affine& toIndex) {
  const GridResolution cells = MajorantResolution(density);
  Bounds3 box;
  for (int axis = 0; axis < 3; ++axis) {
    box.min[axis] = static_cast<float>(density.Box().min[axis]);
    box.max[axis] = static_cast<float>(density.Box().max[axis]) + 1;
  }
  return {box, cells[0], cells[1], cells[2], MajorantsOf(density, cells, extinction), toIndex};
}

}  // namespace

std::shared_ptr<const Medium> MakeNanoVdb(const MediumInput& input) {
  const ParameterList& parameters = input.Parameters();
  NanoVdbData data;
  data.scattering = GetScattering(parameters, false, true);
  NanoVdbGrids grids = ReadGrids(input);
  const Color extinction = data.scattering.Extinction();
  const float densest = LargestOf(grids.density.voxels);
  CheckRange(extinction * densest, "the extinction of this medium", parameters.Where());
  ReadEmission(input, grids, densest, data);
  parameters.CheckAllUsed({},
                          {"type", "filename", "gridname", "temperaturename", "sigma_a", "sigma_s", "scale", "g",
                           "Lescale", "LeScale", "temperaturescale", "temperatureoffset", "temperaturecutoff"},
                          input.diagnostics);
  const Affine toIndex = MakeToSpace(input.renderFromMedium * grids.density.indexToMedium, input);
  MajorantGrid majorants = MakeMajorants(grids.density.voxels, extinction.Max(), toIndex);
  data.density = std::make_shared<SparseVoxels>(std::move(grids.density.voxels));
  return std::make_shared<NanoVdbMedium>(input.description.name, std::move(data), toIndex, std::move(majorants));
}

}  // namespace lampyr
