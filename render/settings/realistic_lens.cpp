#include "render/settings/realistic_lens.h"

#include <algorithm>
#include <filesystem>
#include <sstream>

#include "film/image.h"

namespace lampyr {

namespace {

constexpr size_t kMostTexels = size_t{1} << 26;  // of an image of an aperture

double Positive(const ParameterList& parameters, const char* name, double fallback) {
  const double value = parameters.GetFloat(name, fallback);
  if (!(value > 0)) throw Error(parameters.WhereOf(name), "\"" + std::string(name) + "\" must be above 0");
  return value;
}

Aperture ReadApertureImage(const std::string& file) {
  const Image image = ReadImage(file);
  const size_t count = static_cast<size_t>(image.width) * static_cast<size_t>(image.height);
  if (!image.HasRgb()) throw Error("\"" + file + "\" has no colours to be an aperture");
  if (count > kMostTexels) throw Error("\"" + file + "\" is too large to be an aperture: at most 2^26 pixels");
  ApertureImage shape{image.width, image.height, {}};
  shape.values.reserve(count);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) shape.values.push_back(image.RgbAt(x, y).Average());
  }
  return Aperture::OfImage(std::move(shape));
}

Aperture ReadAperture(const ParameterList& parameters) {
  const std::string name = parameters.GetString("aperture", "");
  const std::vector<std::string>& names = Aperture::Names();
  if (name.empty()) return {};
  if (std::find(names.begin(), names.end(), name) != names.end()) return Aperture::Named(name);
  const std::string file = parameters.GetFile("aperture");
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored)) {
    std::string all;
    for (const std::string& known : names) all += (all.empty() ? "" : ", ") + known;
    throw Error(parameters.WhereOf("aperture"), "there is neither an aperture nor an image \"" + name + "\"" +
                                                    DidYouMean(name, names) + "; there are: " + all +
                                                    ", and the disk, if none is given");
  }
  return LocateErrors(parameters.WhereOf("aperture"), [&] { return ReadApertureImage(file); });
}

std::string Shown(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

void WarnOfStop(const ParameterList& parameters, const RealisticSettings& settings, Diagnostics& diagnostics) {
  const double widest = 2 * settings.lens.Stop().apertureRadius;
  if (settings.apertureDiameter <= widest) return;
  diagnostics.Warn(parameters.WhereOf("aperturediameter"),
                   "\"aperturediameter\" is " + Shown(settings.apertureDiameter) + " mm: the lens's stop opens to " +
                       Shown(widest) + " mm, which is used");
}

}  // namespace

std::unique_ptr<Camera> BuildRealisticCamera(const SceneDescription& description, const CameraFrame& frame,
                                             Diagnostics& diagnostics) {
  const ParameterList& parameters = description.camera.parameters;
  RealisticSettings settings;
  const std::string file = parameters.GetFile("lensfile");
  if (file.empty())
    throw Error(description.camera.where, "Camera \"realistic\" needs a \"string lensfile\": the surfaces of its lens");
  settings.lens = ReadLensFile(file, parameters.WhereOf("lensfile"));
  settings.apertureDiameter = Positive(parameters, "aperturediameter", settings.apertureDiameter);
  settings.focusDistance = Positive(parameters, "focusdistance", settings.focusDistance);
  settings.filmDiagonal = Positive(description.film.parameters, "diagonal", settings.filmDiagonal);
  settings.aperture = ReadAperture(parameters);
  WarnOfStop(parameters, settings, diagnostics);
  std::unique_ptr<Camera> camera =
      LocateErrors(parameters.WhereOf("lensfile"), [&] { return MakeRealisticCamera(frame, settings); });
  parameters.CheckAllUsed(
      {}, {"lensfile", "aperturediameter", "focusdistance", "aperture", "shutteropen", "shutterclose"}, diagnostics);
  return camera;
}

}  // namespace lampyr
