// One row of the table of extremes: a scene of a few pixels whose mean is known, and who has to find it.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "render/settings/render_settings.h"

namespace lampyr::test {

struct ExtremeCase {
  std::string name{};                      // within its group
  std::string scene{};                     // text, without an integrator
  double expected = 0;                     // mean of the image, W/(m² sr)
  std::vector<std::string> integrators{};  // that can find all of the light
  int samples = 8;                         // per pixel of each replica
  int lightSamples = 256;                  // the same of pure light tracing, most of whose paths are never seen
  RenderOverrides overrides{};
  double noise = 0.1;  // a relative error that the row has to notice
  double bias = 1e-3;  // relative error that is allowed beside the noise: rounding, and the blur of photons
  std::string
      limit{};  // why the value is not the one of exact arithmetic; then a warning that holds this must come up:
  std::string warning{};                            // part of a warning of the scene's build
  std::function<void(SceneDescription&)> change{};  // what text would be too long for
};

struct ExtremeGroup {
  const char* name;   // of a section of the table
  const char* title;  // of that section
  std::vector<ExtremeCase> (*cases)();
};
const std::vector<ExtremeGroup>& ExtremeGroups();

// The groups, each in its own file.
std::vector<ExtremeCase> PointLightCases();
std::vector<ExtremeCase> InfiniteLightCases();
std::vector<ExtremeCase> AreaLightCases();
std::vector<ExtremeCase> MaterialCases();
std::vector<ExtremeCase> GeometryCases();
std::vector<ExtremeCase> PhotonCases();
std::vector<ExtremeCase> MediaCases();
std::vector<ExtremeCase> WavelengthCases();
std::vector<ExtremeCase> CameraCases();
std::vector<ExtremeCase> DegenerateCases();

// Integrators that find light directly from a light: all, all but pure light tracing, and those that trace light paths.
inline const std::vector<std::string> kAll = {"path", "light", "bdpt", "sppm", "vcm"};
inline const std::vector<std::string> kFromCamera = {"path", "bdpt", "sppm", "vcm"};

// A number for scene text: all the digits that a double has.
std::string Number(double value);
std::string Numbers(std::initializer_list<double> values);
// The same for names of cases: 1e-06 is 1e-6, 1000 is 1e3.
std::string Short(double value);

}  // namespace lampyr::test
