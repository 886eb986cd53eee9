#include "render/settings/render_settings.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <sstream>

#include "render/settings/integrator_choice.h"
#include "render/settings/realistic_lens.h"
#include "spectral/spectral_curve.h"

namespace lampyr {

namespace {

using Names = std::vector<std::string>;

int PositiveInteger(const ParameterList& parameters, const std::string& name, int defaultValue, int maximum) {
  const int value = parameters.GetInteger(name, defaultValue);
  if (value < 1 || value > maximum) {
    throw Error(parameters.WhereOf(name),
                "\"" + name + "\" is " + std::to_string(value) + "; it must be from 1 to " + std::to_string(maximum));
  }
  return value;
}

constexpr int kMaxResolution = 1 << 16;
constexpr int kMaxSamples = 1 << 30;

// In float, as pbrt-v4: 0.55 of 100 pixels are 55, and more than that in double. Bounds may be in any order.
PixelRect CropFromFractions(double x0, double x1, double y0, double y1, int width, int height) {
  const auto pixel = [](double fraction, int size) {
    return static_cast<int>(std::ceil(std::clamp(static_cast<float>(fraction), 0.0f, 1.0f) * static_cast<float>(size)));
  };
  return {pixel(std::min(x0, x1), width), pixel(std::min(y0, y1), height), pixel(std::max(x0, x1), width),
          pixel(std::max(y0, y1), height)};
}

PixelRect ParseCrop(const std::string& text, int width, int height) {
  std::vector<double> numbers;
  std::stringstream stream(text);
  for (std::string item; std::getline(stream, item, ',');) {
    size_t used = 0;
    double value = 0;
    try {
      value = std::stod(item, &used);
    } catch (const std::exception&) {
      used = 0;
    }
    if (used == 0 || used != item.size() || !std::isfinite(value))
      throw UsageError("--crop: \"" + item + "\" is not a number");
    numbers.push_back(value);
  }
  if (numbers.size() != 4) throw UsageError("--crop takes four numbers x0,x1,y0,y1, not \"" + text + "\"");
  const bool pixels = std::any_of(numbers.begin(), numbers.end(), [](double n) { return n > 1; });
  if (!pixels) return CropFromFractions(numbers[0], numbers[1], numbers[2], numbers[3], width, height);
  const auto clampPixel = [](double n, int size) { return static_cast<int>(std::clamp(n, 0.0, double(size))); };
  return {clampPixel(numbers[0], width), clampPixel(numbers[2], height), clampPixel(numbers[1], width),
          clampPixel(numbers[3], height)};
}

// Throws an Error unless pbrt-v4 has a sensor of that name.
void CheckSensorName(const ParameterList& film, const std::string& sensor) {
  const Names known = {
      "cie1931",       "canon_eos_100d",     "canon_eos_1dx_mkii", "canon_eos_200d",    "canon_eos_200d_mkii",
      "canon_eos_5d",  "canon_eos_5d_mkii",  "canon_eos_5d_mkiii", "canon_eos_5d_mkiv", "canon_eos_5ds",
      "canon_eos_m",   "hasselblad_l1d_20c", "nikon_d810",         "nikon_d850",        "sony_ilce_6400",
      "sony_ilce_7m3", "sony_ilce_7rm3",     "sony_ilce_9"};
  if (std::find(known.begin(), known.end(), sensor) != known.end()) return;
  throw Error(film.WhereOf("sensor"), "there is no sensor \"" + sensor + "\"" + DidYouMean(sensor, known));
}

// A named camera's sensor is modelled as the CIE observer followed by white balance, with its own exposure and white
// balance. `isObserver`: the sensor's channels are X, Y and Z, to which its limit applies.
SensorResponse ReadSensor(const ParameterList& film, float imagingRatio, bool isObserver) {
  const double kelvin = film.GetFloat("whitebalance", 0);
  const double most = film.GetFloat("maxcomponentvalue", std::numeric_limits<double>::infinity());
  if (!(most > 0)) throw Error(film.WhereOf("maxcomponentvalue"), "\"maxcomponentvalue\" must be above 0");
  const glm::dmat3 balance =
      LocateErrors(film.WhereOf("whitebalance"), [&] { return kelvin == 0 ? glm::dmat3(1.0) : WhiteBalance(kelvin); });
  return {imagingRatio, glm::mat3(balance), isObserver ? glm::mat3(Rec709ToXyz()) : glm::mat3(1.0f),
          static_cast<float>(most)};
}

void AddLayer(const std::string& text, const FileLocation& where, RenderSettings& settings) {
  const PixelLayer* layer = FindPixelLayer(text);
  if (PlainName(text) == kStrategies) {
    settings.strategies = where;
  } else if (!layer) {
    settings.layers.push_back(ParseLayer(text, where));
  } else if (!settings.Wants(layer->name)) {
    settings.pixelLayers.push_back(layer);
  }
}

void ReadCrop(const ParameterList& film, const RenderOverrides& overrides, RenderSettings& settings,
              Diagnostics& diagnostics) {
  settings.crop = {0, 0, settings.width, settings.height};
  const std::vector<double> window = film.GetFloats("cropwindow");
  const std::vector<int64_t> bounds = film.GetIntegers("pixelbounds");
  if (!window.empty() && !bounds.empty())
    diagnostics.Warn(film.WhereOf("pixelbounds"),
                     "\"pixelbounds\" is ignored: \"cropwindow\" says which part is rendered");
  if (overrides.crop) {
    settings.crop = ParseCrop(*overrides.crop, settings.width, settings.height);
  } else if (!window.empty()) {
    if (window.size() != 4)
      throw Error(film.WhereOf("cropwindow"), "\"cropwindow\" needs 4 values, has " + std::to_string(window.size()));
    settings.crop = CropFromFractions(window[0], window[1], window[2], window[3], settings.width, settings.height);
  } else if (!bounds.empty()) {
    if (bounds.size() != 4)
      throw Error(film.WhereOf("pixelbounds"), "\"pixelbounds\" needs 4 values, has " + std::to_string(bounds.size()));
    const auto limit = [](int64_t n, int size) { return static_cast<int>(std::clamp<int64_t>(n, 0, size)); };
    const auto [x0, x1] = std::minmax(bounds[0], bounds[1]);
    const auto [y0, y1] = std::minmax(bounds[2], bounds[3]);
    if (x0 < 0 || y0 < 0 || x1 > settings.width || y1 > settings.height)
      diagnostics.Warn(film.WhereOf("pixelbounds"),
                       "\"pixelbounds\" reaches beyond the image: the part inside it is rendered");
    settings.crop = {limit(x0, settings.width), limit(y0, settings.height), limit(x1, settings.width),
                     limit(y1, settings.height)};
  }
  if (settings.crop.Width() <= 0 || settings.crop.Height() <= 0) {
    if (overrides.crop)
      throw UsageError("--crop leaves no pixel of the " + std::to_string(settings.width) + "×" +
                       std::to_string(settings.height) + " image");
    throw Error(film.Where(), "the crop leaves no pixel of the image");
  }
}

// The bands of Film "spectral", or those that the command line asks for.
void ReadBands(const ParameterList& film, bool isSpectralFilm, const RenderOverrides& overrides,
               RenderSettings& settings, Diagnostics& diagnostics) {
  constexpr int usual = 16, most = 512;
  SpectralBands bands{PositiveInteger(film, "nbuckets", usual, most), film.GetFloat("lambdamin", SpectralCurve::kFirst),
                      film.GetFloat("lambdamax", SpectralCurve::kLast)};
  for (const char* name : {"lambdamin", "lambdamax"}) {
    const double value = name == std::string("lambdamin") ? bands.from : bands.to;
    if (!(value >= SpectralCurve::kFirst && value <= SpectralCurve::kLast))
      throw Error(film.WhereOf(name),
                  "\"" + std::string(name) + "\" must be from 360 to 830 nm, where spectra are known");
  }
  if (!(bands.to - bands.from >= 1))
    throw Error(film.WhereOf("lambdamax"), "\"lambdamax\" must be above \"lambdamin\", by 1 nm at least");
  if (overrides.spectralBands) bands.count = *overrides.spectralBands;
  if (!isSpectralFilm && !overrides.spectralBands) return;
  if (overrides.spectral == false) {
    if (overrides.spectralBands) throw UsageError("--spectral-bands and --no-spectral exclude each other");
    diagnostics.Warn(film.Where(), "Film \"spectral\": without bands of the spectrum, because of --no-spectral");
    return;
  }
  settings.bands = bands;
  settings.spectral = true;
}

void ReadFilm(const SceneDescription& scene, const RenderOverrides& overrides, RenderSettings& settings,
              Diagnostics& diagnostics) {
  const ParameterList& film = scene.film.parameters;
  const std::string& type = scene.film.type;
  if (type == "gbuffer") {
    const std::string space = film.GetString("coordinatesystem", "camera");
    if (space != "camera" && space != "world") {
      throw Error(film.WhereOf("coordinatesystem"), "\"coordinatesystem\" is \"camera\" or \"world\", not \"" + space +
                                                        "\"" + DidYouMean(space, {"camera", "world"}));
    }
    settings.firstHit = space == "world" ? FirstHitSpace::World : FirstHitSpace::Camera;
  } else if (!type.empty() && type != "spectral" && type != "rgb") {
    throw Error(scene.film.where,
                "there is no Film \"" + type + "\"" + DidYouMean(type, {"rgb", "gbuffer", "spectral"}));
  }
  settings.width = PositiveInteger(film, "xresolution", settings.width, kMaxResolution);
  settings.height = PositiveInteger(film, "yresolution", settings.height, kMaxResolution);
  if (overrides.width) settings.width = *overrides.width;
  if (overrides.height) settings.height = *overrides.height;
  settings.outputFile = film.GetString("filename", "");
  if (const std::string ending = std::filesystem::path(settings.outputFile).extension();
      ending != ".exr" && IsPictureEnding(ending))
    diagnostics.Warn(film.WhereOf("filename"), "pictures are written as OpenEXR (.exr); --png adds one as PNG");
  for (const std::string& layer : film.GetStrings("layers")) AddLayer(layer, film.WhereOf("layers"), settings);
  for (const std::string& layer : overrides.layers) AddLayer(layer, {}, settings);
  settings.seesThroughSmooth = overrides.seesThroughSmooth;
  settings.spectral = overrides.spectral;
  ReadBands(film, type == "spectral", overrides, settings, diagnostics);
  settings.adaptive = overrides.adaptive;
  // pbrt-v4 writes halves by default. Variances need floats, so halves are written only if the scene asks for them.
  settings.halfPrecision = film.GetBool("savefp16", false);
  const std::string sensor = film.GetString("sensor", "cie1931");
  CheckSensorName(film, sensor);
  if (sensor != "cie1931")
    diagnostics.Warn(film.WhereOf("sensor"), "the colours of the sensor \"" + sensor +
                                                 "\" are not modelled: they are those of the CIE 1931 observer");
  const ParameterList& camera = scene.camera.parameters;
  const double exposureTime = camera.GetFloat("shutterclose", 1) - camera.GetFloat("shutteropen", 0);
  if (!(exposureTime > 0)) {
    throw Error(camera.WhereOf("shutterclose"),
                "the exposure is not positive: \"shutterclose\" must be after \"shutteropen\"");
  }
  const auto imagingRatio = static_cast<float>(exposureTime * film.GetFloat("iso", 100) / 100);
  if (!(imagingRatio > 0)) {
    throw Error(film.WhereOf("iso"), "the exposure is not positive: \"iso\" must be above 0");
  }
  settings.sensor = ReadSensor(film, imagingRatio, sensor == "cie1931");

  ReadCrop(film, overrides, settings, diagnostics);
  // The film's size in mm is read for "realistic" cameras only.
  if (!(film.GetFloat("diagonal", 1) > 0)) throw Error(film.WhereOf("diagonal"), "\"diagonal\" must be above 0 (mm)");
  film.CheckAllUsed(
      {"coordinatesystem"},
      {"xresolution", "yresolution", "filename", "savefp16", "sensor", "iso", "whitebalance", "maxcomponentvalue",
       "cropwindow", "pixelbounds", "diagonal", "nbuckets", "lambdamin", "lambdamax"},
      diagnostics);
}

void ReadPixelFilter(const SceneDescription& scene, RenderSettings& settings, Diagnostics& diagnostics) {
  using Kind = PixelFilterSettings::Kind;
  const ParameterList& parameters = scene.pixelFilter.parameters;
  const std::string type = scene.pixelFilter.type.empty() ? "gaussian" : scene.pixelFilter.type;
  PixelFilterSettings& filter = settings.filter;
  struct Entry {
    const char* name;
    Kind kind;
    double radius;
  };
  // pbrt-v4's names and default radii.
  constexpr Entry entries[] = {{"box", Kind::Box, 0.5},
                               {"triangle", Kind::Triangle, 2},
                               {"gaussian", Kind::Gaussian, 1.5},
                               {"mitchell", Kind::Mitchell, 2},
                               {"sinc", Kind::Sinc, 4}};
  const Entry* found = nullptr;
  Names names;
  for (const Entry& entry : entries) {
    names.push_back(entry.name);
    if (type == entry.name) found = &entry;
  }
  if (!found)
    throw Error(scene.pixelFilter.where, "there is no PixelFilter \"" + type + "\"" + DidYouMean(type, names));
  filter.kind = found->kind;
  filter.radiusX = static_cast<float>(parameters.GetFloat("xradius", found->radius));
  filter.radiusY = static_cast<float>(parameters.GetFloat("yradius", found->radius));
  for (const auto& [name, radius] : {std::pair{"xradius", filter.radiusX}, std::pair{"yradius", filter.radiusY}}) {
    if (!(radius > 0)) throw Error(parameters.WhereOf(name), std::string("\"") + name + "\" must be above 0");
  }
  Names known = {"xradius", "yradius"};
  if (filter.kind == Kind::Gaussian) {
    filter.sigma = static_cast<float>(parameters.GetFloat("sigma", 0.5));
    if (!(filter.sigma > 0)) throw Error(parameters.WhereOf("sigma"), "\"sigma\" must be above 0");
    known.push_back("sigma");
  } else if (filter.kind == Kind::Mitchell) {
    filter.b = static_cast<float>(parameters.GetFloat("B", 1.0 / 3));
    filter.c = static_cast<float>(parameters.GetFloat("C", 1.0 / 3));
    known.insert(known.end(), {"B", "C"});
  } else if (filter.kind == Kind::Sinc) {
    filter.tau = static_cast<float>(parameters.GetFloat("tau", 3));
    if (!(filter.tau > 0)) throw Error(parameters.WhereOf("tau"), "\"tau\" must be above 0");
    known.push_back("tau");
  }
  parameters.CheckAllUsed({}, known, diagnostics);
  LocateErrors(scene.pixelFilter.where, [&] { return PixelFilter(filter); });  // throws if the settings are invalid
}

SamplerKind SamplerByName(const std::string& name, bool* known) {
  *known = true;
  if (name == "independent") return SamplerKind::Independent;
  // pbrt-v4's low-discrepancy samplers all become our Owen-scrambled Sobol points.
  const Names sobol = {"sobol", "zsobol", "paddedsobol", "halton", "pmj02bn", "stratified"};
  *known = std::find(sobol.begin(), sobol.end(), name) != sobol.end();
  return SamplerKind::Sobol;
}

void ReadSampler(const SceneDescription& scene, const RenderOverrides& overrides, RenderSettings& settings,
                 Diagnostics& diagnostics) {
  const Names names = {"independent", "sobol", "zsobol", "paddedsobol", "halton", "pmj02bn", "stratified"};
  const ParameterList& parameters = scene.sampler.parameters;
  const std::string& type = scene.sampler.type;
  bool known = true;
  if (!type.empty()) settings.sampler = SamplerByName(type, &known);
  if (!known) throw Error(scene.sampler.where, "there is no Sampler \"" + type + "\"" + DidYouMean(type, names));
  if (type == "stratified") {
    settings.samplesPerPixel =
        PositiveInteger(parameters, "xsamples", 4, 1 << 15) * PositiveInteger(parameters, "ysamples", 4, 1 << 15);
    if (!parameters.GetBool("jitter", true)) {
      diagnostics.Warn(parameters.WhereOf("jitter"), "samples without jitter are not supported; they are jittered");
    }
  } else {
    settings.samplesPerPixel = PositiveInteger(parameters, "pixelsamples", settings.samplesPerPixel, kMaxSamples);
  }
  const auto option = scene.options.find("seed");
  if (option != scene.options.end() && option->second.integers.empty()) {
    throw Error(option->second.where, "the option \"seed\" needs an integer");
  }
  const int64_t optionSeed =
      option != scene.options.end() && !option->second.integers.empty() ? option->second.integers[0] : 0;
  settings.seed = static_cast<uint64_t>(parameters.GetInteger("seed", 0) + optionSeed) + overrides.seed;
  parameters.CheckAllUsed({"randomization", "jitter", "xsamples", "ysamples", "pixelsamples"}, {"pixelsamples", "seed"},
                          diagnostics);
  if (overrides.sampler) {
    settings.sampler = SamplerByName(*overrides.sampler, &known);
    if (!known)
      throw UsageError("--sampler: there is no sampler \"" + *overrides.sampler + "\"" +
                       DidYouMean(*overrides.sampler, names));
  }
  if (overrides.samplesPerPixel) settings.samplesPerPixel = *overrides.samplesPerPixel;
}

// The value that a scene gives a setting; the fallback if it gives none.
SettingValue ValueIn(const ParameterList& parameters, const Setting& setting) {
  const std::string name = setting.NameInScenes();
  if (const bool* isOn = std::get_if<bool>(&setting.fallback)) return parameters.GetBool(name, *isOn);
  if (const auto* integer = std::get_if<int64_t>(&setting.fallback)) {
    // In pbrt-v4 -1 stands for a number that is not given; all numbers that are not above 0 are read like that.
    const int value = parameters.GetInteger(name, static_cast<int>(*integer));
    return *integer < 0 && value <= 0 ? *integer : int64_t{value};
  }
  if (const double* number = std::get_if<double>(&setting.fallback)) return parameters.GetFloat(name, *number);
  return parameters.GetString(name, std::get<std::string>(setting.fallback));
}

// Reads the settings of integrators from the scene, overridden by the command line.
void ReadSettings(const ParameterList& parameters, const RenderOverrides& overrides, Settings& values) {
  for (const std::string& name : values.Names()) {
    const Setting& setting = *values.Find(name);
    if (!setting.isInScenes) continue;
    const SettingValue value = ValueIn(parameters, setting);
    try {
      values.Set(name, value);
    } catch (const Error& error) {
      const bool isWord = std::holds_alternative<std::string>(value);
      throw Error(parameters.WhereOf(setting.NameInScenes()),
                  "\"" + setting.NameInScenes() + "\"" +
                      (isWord ? ": " + error.Text() + DidYouMean(std::get<std::string>(value), setting.choices)
                              : " must be " + setting.Range()));
    }
  }
  for (const auto& [name, value] : overrides.values) {
    try {
      values.Set(name, value);
    } catch (const Error& error) {
      throw UsageError("--" + name + ": " + error.Text());
    }
  }
}

void ReadIntegrator(const SceneDescription& scene, const RenderOverrides& overrides, RenderSettings& settings,
                    Diagnostics& diagnostics) {
  const ParameterList& parameters = scene.integrator.parameters;
  const std::string& type = scene.integrator.type;
  const auto isOneOf = [](const std::string& name, const Names& names) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  // Names that pbrt-v4 has for integrators of lampyr.
  const std::map<std::string, std::string> synonyms = {{"", "auto"}, {"volpath", "path"}, {"lightpath", "light"}};
  const auto synonym = synonyms.find(type);
  settings.integrator = synonym != synonyms.end() ? synonym->second : type;
  const bool isKnown = settings.integrator == "auto" || isOneOf(settings.integrator, IntegratorNames());
  if (!isKnown) {
    const Names notYet = {"ambientocclusion", "function", "mlt", "randomwalk", "simplepath", "simplevolpath"};
    if (!isOneOf(type, notYet)) {
      Names all = notYet;
      const Names ours = IntegratorNames();
      all.insert(all.end(), ours.begin(), ours.end());
      all.insert(all.end(), {"volpath", "lightpath"});
      throw Error(scene.integrator.where, "there is no Integrator \"" + type + "\"" + DidYouMean(type, all));
    }
    if (!overrides.integrator) {
      diagnostics.Warn(scene.integrator.where, "Integrator \"" + type + "\" is not supported yet; \"path\" is used");
    }
    settings.integrator = "path";
  }
  if (settings.integrator != "auto") settings.namedIntegrator = settings.integrator;
  settings.integratorWhere = scene.integrator.where;
  if (overrides.integrator) {
    CheckIntegratorName(*overrides.integrator);
    settings.integrator = *overrides.integrator;
    settings.integratorWhere = {};
  }
  ReadSettings(parameters, overrides, settings.values);
  // Parameters of an integrator that is replaced by "path" are not checked.
  if (!isKnown) return;
  Names known;
  for (const auto& [setting, value] : settings.values.All()) {
    if (setting->isInScenes) known.push_back(setting->NameInScenes());
  }
  // Parameters of pbrt-v4's integrators that have no effect here: warned of.
  parameters.CheckAllUsed({"options", "seed", "visualizestrategies", "visualizeweights"}, known, diagnostics);
}

// Embree replaces all accelerators of pbrt-v4. They do not change the image, so there is no warning.
void CheckAccelerator(const SceneDescription& scene, Diagnostics& diagnostics) {
  const std::string& type = scene.accelerator.type;
  const Names types = {"bvh", "kdtree"};
  if (!type.empty() && std::find(types.begin(), types.end(), type) == types.end()) {
    throw Error(scene.accelerator.where, "there is no Accelerator \"" + type + "\"" + DidYouMean(type, types));
  }
  const Names known = {"maxnodeprims", "splitmethod", "intersectcost", "traversalcost",
                       "emptybonus",   "maxprims",    "maxdepth"};
  for (const std::string& name : known) scene.accelerator.parameters.Find(name);
  scene.accelerator.parameters.CheckAllUsed({}, known, diagnostics);
}

std::unique_ptr<Camera> BuildSphericalCamera(const SceneDescription& description, const CameraFrame& frame,
                                             Diagnostics& diagnostics) {
  const StatementDescription& statement = description.camera;
  const ParameterList& parameters = statement.parameters;
  const std::string mapping = parameters.GetString("mapping", "equalarea");
  if (mapping != "equalarea" && mapping != "equirectangular") {
    throw Error(parameters.WhereOf("mapping"),
                "there is no mapping \"" + mapping + "\"" + DidYouMean(mapping, {"equalarea", "equirectangular"}));
  }
  for (const char* name : {"lensradius", "focaldistance", "screenwindow", "frameaspectratio"}) {
    if (parameters.Find(name))
      diagnostics.Warn(parameters.WhereOf(name), "\"" + std::string(name) + "\" has no effect on a spherical camera");
  }
  if (!(frame.filmMargin.x < static_cast<float>(frame.width) &&
        frame.filmMargin.y < static_cast<float>(frame.height))) {
    const FileLocation& filter = description.pixelFilter.where;
    throw Error(filter.file ? filter : statement.where,
                "the radius of the filter of a spherical camera must be less than its image, which goes all around: " +
                    std::to_string(frame.width) + " by " + std::to_string(frame.height) + " pixels");
  }
  return MakeSphericalCamera(frame,
                             mapping == "equalarea" ? SphericalMapping::EqualArea : SphericalMapping::EquiRectangular);
}

}  // namespace

bool IsPictureEnding(const std::string& ending) {
  const auto endings = {".exr", ".png", ".pfm", ".qoi", ".hdr", ".tif", ".tiff", ".jpg", ".jpeg", ".tga", ".bmp"};
  return std::find(endings.begin(), endings.end(), ending) != endings.end();
}

RenderSettings ReadRenderSettings(const SceneDescription& description, const RenderOverrides& overrides,
                                  Diagnostics& diagnostics) {
  RenderSettings settings;
  ReadFilm(description, overrides, settings, diagnostics);
  ReadPixelFilter(description, settings, diagnostics);
  ReadSampler(description, overrides, settings, diagnostics);
  ReadIntegrator(description, overrides, settings, diagnostics);
  CheckAccelerator(description, diagnostics);
  return settings;
}

std::unique_ptr<Camera> BuildCamera(const SceneDescription& description, const RenderSettings& settings,
                                    const Transform& worldToRender, Diagnostics& diagnostics) {
  const StatementDescription& statement = description.camera;
  const ParameterList& parameters = statement.parameters;
  CameraFrame frame;
  frame.cameraToRender = worldToRender * description.cameraToWorld.start;
  frame.width = settings.width;
  frame.height = settings.height;
  frame.filmMargin = {settings.filter.radiusX, settings.filter.radiusY};
  const std::string type = statement.type.empty() ? "perspective" : statement.type;
  if (type == "realistic") return BuildRealisticCamera(description, frame, diagnostics);
  const double aspect = parameters.GetFloat("frameaspectratio", double(frame.width) / frame.height);
  if (!(aspect > 0)) throw Error(parameters.WhereOf("frameaspectratio"), "\"frameaspectratio\" must be above 0");
  SetDefaultScreenWindow(frame, static_cast<float>(aspect));
  const std::vector<double> window = parameters.GetFloats("screenwindow");
  if (!window.empty()) {
    if (window.size() != 4 || !(window[0] < window[1]) || !(window[2] < window[3])) {
      throw Error(parameters.WhereOf("screenwindow"), "\"screenwindow\" needs 4 values: left < right, bottom < top");
    }
    frame.screenMin = {float(window[0]), float(window[2])};
    frame.screenMax = {float(window[1]), float(window[3])};
  }
  const auto lensRadius = static_cast<float>(parameters.GetFloat("lensradius", 0));
  const auto focalDistance = static_cast<float>(parameters.GetFloat("focaldistance", 1e6));
  if (lensRadius < 0) throw Error(parameters.WhereOf("lensradius"), "\"lensradius\" must be 0 or more");
  if (!(focalDistance > 0)) throw Error(parameters.WhereOf("focaldistance"), "\"focaldistance\" must be above 0");
  Names known = {"frameaspectratio", "screenwindow", "shutteropen", "shutterclose", "lensradius", "focaldistance"};

  std::unique_ptr<Camera> camera;
  if (type == "perspective") {
    const double fov = parameters.GetFloat("fov", 90);
    if (!(fov > 0 && fov < 180)) throw Error(parameters.WhereOf("fov"), "\"fov\" must be between 0 and 180 degrees");
    known.push_back("fov");
    camera = MakePerspectiveCamera(frame, {Degrees(static_cast<float>(fov)), lensRadius, focalDistance});
  } else if (type == "orthographic") {
    camera = MakeOrthographicCamera(frame, {lensRadius, focalDistance});
  } else if (type == "spherical") {
    known.push_back("mapping");
    camera = BuildSphericalCamera(description, frame, diagnostics);
  } else {
    throw Error(statement.where, "there is no Camera \"" + type + "\"" +
                                     DidYouMean(type, {"perspective", "orthographic", "spherical", "realistic"}));
  }
  parameters.CheckAllUsed({}, known, diagnostics);
  return camera;
}

bool RenderSettings::Wants(const char* pixelLayer) const {
  return std::any_of(pixelLayers.begin(), pixelLayers.end(),
                     [&](const PixelLayer* wanted) { return std::string(wanted->name) == pixelLayer; });
}

bool RenderSettings::SamplesLightEdges() const {
  return values.IsOn("light-edges") && !sensor.Limits() && PixelFilter(filter).SquaredWeight() == 1;
}

bool RenderSettings::WantsFirstHit() const {
  const auto isOfSamples = [](const PixelLayer* layer) { return IsOfSamples(*layer); };
  return firstHit || !std::all_of(pixelLayers.begin(), pixelLayers.end(), isOfSamples);
}

}  // namespace lampyr
