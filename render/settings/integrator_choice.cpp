#include "render/settings/integrator_choice.h"

#include <algorithm>

#include "base/error.h"

namespace lampyr {

namespace {

constexpr const char* kDenoised = ":denoise";
constexpr const char* kAdaptive = "adaptive";

std::string Listed(const std::vector<std::string>& names) {
  std::string all;
  for (const std::string& name : names) all += (all.empty() ? "" : ", ") + name;
  return all;
}

// Applies a change such as "shadow-threshold=0.01". A switch without a value is on.
void Change(const std::string& variant, const IntegratorType& type, const std::string& change, Settings& values) {
  const size_t equals = change.find('=');
  const std::string key = change.substr(0, equals);
  const auto found = std::find_if(type.settings.begin(), type.settings.end(),
                                  [&](const Setting* setting) { return setting->name == key; });
  if (found == type.settings.end()) {
    std::vector<std::string> keys;
    for (const Setting* setting : type.settings) keys.push_back(setting->name);
    keys.emplace_back(kAdaptive);
    throw UsageError("--integrators: \"" + variant + "\": there is no setting \"" + key + "\"" + DidYouMean(key, keys) +
                     "; there are: " + Listed(keys));
  }
  const std::string text = equals != std::string::npos                        ? change.substr(equals + 1)
                           : std::holds_alternative<bool>((*found)->fallback) ? "on"
                                                                              : "";
  try {
    values.Set(key, (*found)->Parse(text));
  } catch (const Error& error) {
    throw UsageError("--integrators: \"" + variant + "\": " + key + ": " + error.Text());
  }
}

}  // namespace

double SplatCount(const RenderSettings& settings) {
  // relMSE of independent camera samples over that of Sobol points, measured in scenes of scenes/ with 64 samples per
  // pixel. Splats are not better distributed than independent samples: they fall where they may.
  constexpr double kGainOfSobol = 1.7;
  return PixelFilter(settings.filter).SplatCount() / (settings.sampler == SamplerKind::Sobol ? kGainOfSobol : 1.0);
}

std::unique_ptr<Integrator> MakeIntegrator(const RenderScene& scene, const RenderSettings& settings) {
  const std::string refusal = IntegratorRefusal(scene, settings.integrator);
  if (!refusal.empty())
    throw UsageError(settings.integratorWhere, "integrator " + settings.integrator + ": " + refusal);
  return IntegratorOf(settings.integrator)
      .create({scene, settings.width, settings.height, settings.sensor.ImagingRatio(), settings.values,
               settings.counts.get(), SplatCount(settings)});
}

bool IsDenoised(const std::string& name) {
  return name.ends_with(kDenoised);
}

bool IsAuto(const std::string& name) {
  return name == kAuto || name.starts_with(kAuto + std::string(":"));
}

RenderSettings VariantOf(const RenderSettings& settings, const std::string& name) {
  if (IsDenoised(name)) return VariantOf(settings, name.substr(0, name.size() - std::string(kDenoised).size()));
  RenderSettings variant = settings;
  if (name == kAuto) return variant;
  if (name == kAuto + std::string(":") + kAdaptive) {
    variant.adaptive.emplace();
    return variant;
  }
  if (IsAuto(name)) {
    throw UsageError("--integrators: \"" + name + "\": auto has the variants " + kAuto + " and " + kAuto + ":" +
                     kAdaptive + ", with or without " + kDenoised + "; set others with an option (--max-depth)");
  }
  size_t colon = name.find(':');
  variant.integrator = name.substr(0, colon);
  variant.integratorWhere = {};
  variant.counts.reset();
  const IntegratorType* type = FindIntegrator(variant.integrator);
  if (!type) {
    throw UsageError("--integrators: there is no integrator \"" + variant.integrator + "\"" +
                     DidYouMean(variant.integrator, IntegratorNames()) + "; there are: " + Listed(IntegratorNames()));
  }
  while (colon != std::string::npos) {
    const size_t next = name.find(':', colon + 1);
    const std::string change = name.substr(colon + 1, next == std::string::npos ? next : next - colon - 1);
    if (change == kAdaptive) {
      variant.adaptive.emplace();
    } else {
      Change(name, *type, change, variant.values);
    }
    colon = next;
  }
  return variant;
}

std::vector<std::string> SettingsWithoutEffect(const std::string& integrator,
                                               const std::map<std::string, SettingValue>& given) {
  const auto reads = [](const IntegratorType& type, const std::string& name) {
    return std::any_of(type.settings.begin(), type.settings.end(),
                       [&](const Setting* setting) { return setting->name == name; });
  };
  std::vector<std::string> lines;
  for (const auto& [name, value] : given) {
    if (reads(IntegratorOf(integrator), name)) continue;
    std::vector<std::string> readers;
    for (const IntegratorType& type : IntegratorRegistry())
      if (reads(type, name)) readers.push_back(type.name);
    lines.push_back("--" + name + " has no effect: " + integrator + " does not have this setting, but " +
                    Listed(readers));
  }
  return lines;
}

bool GathersPhotons(const RenderSettings& settings) {
  return GathersPhotons(settings.integrator, settings.values);
}

StrategyLayers StrategiesOf(const RenderSettings& settings) {
  if (IntegratorOf(settings.integrator).hasTechniques) return {settings.MaxDepth(), GathersPhotons(settings)};
  std::vector<std::string> names;
  for (const IntegratorType& type : IntegratorRegistry()) {
    if (type.hasTechniques) names.push_back(type.name);
  }
  const std::string text = "layer \"" + std::string(kStrategies) + "\": only " + Listed(names) +
                           " have strategies; the integrator is " + settings.integrator;
  const FileLocation where = settings.strategies.value_or(FileLocation());
  if (where.file) throw Error(where, text);
  throw UsageError(text);
}

void CheckIntegratorName(const std::string& name) {
  std::vector<std::string> all = IntegratorNames();
  all.emplace_back(kAuto);
  if (std::find(all.begin(), all.end(), name) == all.end())
    throw UsageError("--integrator: there is no integrator \"" + name + "\"" + DidYouMean(name, all) +
                     "; there are: " + Listed(all));
}

}  // namespace lampyr
