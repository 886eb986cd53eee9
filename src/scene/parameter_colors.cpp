// Colours of a ParameterList: rgb, spectrum and blackbody parameters as linear Rec. 709.
#include <filesystem>
#include <system_error>

#include "scene/parameters.h"
#include "scene/spectrum.h"
#include "spectral/color_space.h"

namespace lampyr {

namespace {

Color RgbToColor(const Parameter& parameter, size_t first, const std::string& owner, SpectrumRole role) {
  const std::vector<double>& n = parameter.numbers;
  const Vector3d rgb(n[first], n[first + 1], n[first + 2]);
  const std::string what = "\"" + parameter.name + "\" of " + owner;
  for (int i = 0; i < 3; ++i) {
    if (rgb[i] < 0) throw Error(parameter.where, what + " has a negative component");
    if (rgb[i] > 1 && role == SpectrumRole::Albedo) {
      throw Error(parameter.where, what + " has a component above 1: a surface reflects at most what it receives");
    }
  }
  const auto single = [](double x) { return static_cast<float>(x); };
  if (parameter.colorSpace == RgbColorSpace::Srgb) return {single(rgb.x), single(rgb.y), single(rgb.z)};
  const WhiteHandling white = role == SpectrumRole::Illuminant ? WhiteHandling::Keep : WhiteHandling::Adapt;
  const Color color = ClampToGamut(ToRec709(rgb, parameter.colorSpace, white));
  if (role != SpectrumRole::Albedo) return color;
  return {std::min(color.r, 1.0f), std::min(color.g, 1.0f), std::min(color.b, 1.0f)};
}

}  // namespace

Color ParameterList::White() const {
  if (colorSpace_ == RgbColorSpace::Srgb) return Color(1.0f);
  return ClampToGamut(ToRec709(Vector3d(1.0), colorSpace_, WhiteHandling::Keep));
}

std::vector<Color> ParameterList::ColorsOf(const Parameter& parameter, SpectrumRole role) const {
  std::vector<Color> colors;
  if (parameter.type == ParameterType::Rgb) {
    FindNumbers(parameter.name, {ParameterType::Rgb}, 3, false);
    for (size_t i = 0; i < parameter.numbers.size(); i += 3) colors.push_back(RgbToColor(parameter, i, owner_, role));
  } else if (parameter.type == ParameterType::Blackbody) {
    for (const double kelvin : parameter.numbers) {
      if (!(kelvin > 0))
        throw Error(parameter.where, "\"" + parameter.name + "\" of " + owner_ + ": a temperature is above 0 K");
      colors.push_back(BlackbodyToColor(kelvin, role));
    }
  } else if (!parameter.numbers.empty()) {
    colors.push_back(SpectrumToColor(SpectrumFromPairs(parameter.numbers, role, parameter.where), role));
  }
  if (parameter.type != ParameterType::Spectrum) return colors;
  for (const std::string& name : parameter.strings) {
    if (const auto named = FindNamedSpectrum(name, role)) {
      colors.push_back(*named);
      continue;
    }
    const std::string file = ResolveFile(name, parameter.where);
    std::error_code ignored;
    if (!std::filesystem::exists(file, ignored)) {
      throw Error(parameter.where,
                  "\"" + name + "\" is neither a spectrum's name nor a file" + DidYouMean(name, SpectrumNames()));
    }
    colors.push_back(SpectrumToColor(ReadSpectrumFile(file, role, parameter.where), role));
  }
  return colors;
}

std::vector<Color> ParameterList::GetColors(const std::string& name, SpectrumRole role) const {
  const Parameter* parameter = FindTyped(name, {ParameterType::Rgb, ParameterType::Spectrum, ParameterType::Blackbody});
  return parameter ? ColorsOf(*parameter, role) : std::vector<Color>();
}

std::optional<Color> ParameterList::FindColor(const std::string& name, SpectrumRole role) const {
  const Parameter* parameter = FindTyped(name, {ParameterType::Rgb, ParameterType::Spectrum, ParameterType::Blackbody});
  if (!parameter) return std::nullopt;
  if (parameter->type == ParameterType::Rgb && parameter->numbers.size() != 3)
    WrongCount(*parameter, 3, parameter->numbers.size());
  const std::vector<Color> colors = ColorsOf(*parameter, role);
  if (colors.size() != 1) WrongCount(*parameter, 1, colors.size());
  return colors[0];
}

std::shared_ptr<const SpectralCurve> ParameterList::FindCurve(const std::string& name, SpectrumRole role) const {
  const Parameter* parameter = FindTyped(name, {ParameterType::Rgb, ParameterType::Spectrum, ParameterType::Blackbody});
  if (!parameter || parameter->type == ParameterType::Rgb || !FindColor(name, role)) return nullptr;
  if (parameter->type == ParameterType::Blackbody)
    return std::make_shared<const SpectralCurve>(BlackbodyCurve(parameter->numbers[0], role));
  if (parameter->strings.empty()) {
    return std::make_shared<const SpectralCurve>(
        CurveOf(SpectrumFromPairs(parameter->numbers, role, parameter->where), role));
  }
  const std::string& spectrum = parameter->strings[0];
  if (auto named = FindNamedCurve(spectrum, role)) return std::make_shared<const SpectralCurve>(*std::move(named));
  if (FindNamedSpectrum(spectrum, role)) return nullptr;
  const std::string file = ResolveFile(spectrum, parameter->where);
  return std::make_shared<const SpectralCurve>(CurveOf(ReadSpectrumFile(file, role, parameter->where), role));
}

Color ParameterList::GetColor(const std::string& name, const Color& defaultValue, SpectrumRole role) const {
  return FindColor(name, role).value_or(defaultValue);
}

}  // namespace lampyr
