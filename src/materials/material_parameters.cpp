#include "materials/coat_table.h"
#include "materials/material_makers.h"

namespace lampyr {

namespace {

float Clamp(float x, float low, float high) {
  return std::min(std::max(low, x), high);
}  // NaN: low

FloatParameter GetRoughness(const MaterialInput& input, const std::string& name, const FloatParameter& defaultValue) {
  const auto given = input.textures.FindFloat(input.parameters, name);
  if (!given) return defaultValue;
  if (given->IsConstant() && !(given->Evaluate({}) >= 0)) {
    throw Error(input.parameters.WhereOf(name), "\"" + name + "\" must not be negative");
  }
  return *given;
}

// The coefficient of a named spectrum.
ColorParameter NamedSpectrum(const std::string& name) {
  Parameter parameter;
  parameter.type = ParameterType::Spectrum;
  parameter.name = "value";
  parameter.strings = {name};
  const ParameterList list({}, "Material", {parameter});
  return {list.GetColor("value", Color(1.0f), SpectrumRole::Unbounded),
          list.FindCurve("value", SpectrumRole::Unbounded)};
}

// A constant coefficient as a function of the wavelength. Null if it is a colour or a texture.
std::shared_ptr<const SpectralCurve> CurveOf(const ColorParameter& parameter) {
  if (!parameter.IsConstant()) return nullptr;
  if (parameter.Curve()) return parameter.Curve();
  const Color value = parameter.Evaluate({});
  if (value.r != value.g || value.g != value.b) return nullptr;
  return std::make_shared<const SpectralCurve>([&](double) { return static_cast<double>(value.r); });
}

}  // namespace

Color ClampToUnit(const Color& c) {
  return {Clamp(c.r, 0, 1), Clamp(c.g, 0, 1), Clamp(c.b, 0, 1)};
}

void CheckMaterialParameters(const MaterialInput& input, std::vector<std::string> known,
                             const std::vector<std::string>& alsoInPbrt) {
  input.parameters.Find("type");  // of named materials; already used for the dispatch
  known.insert(known.end(), {"displacement", "normalmap", "type"});
  input.parameters.CheckAllUsed(alsoInPbrt, known, input.diagnostics);
}

RoughnessParameters::RoughnessParameters(const MaterialInput& input, const std::string& prefix) {
  const FloatParameter both = GetRoughness(input, prefix + "roughness", 0.0f);
  u_ = GetRoughness(input, prefix + "uroughness", both);
  v_ = GetRoughness(input, prefix + "vroughness", both);
  remap_ = input.parameters.GetBool("remaproughness", true);
  const bool split = input.parameters.Find(prefix + "uroughness") || input.parameters.Find(prefix + "vroughness");
  isAnisotropic_ = split && !(IsConstant() && u_.Evaluate({}) == v_.Evaluate({}));
}

TrowbridgeReitz RoughnessParameters::Evaluate(const TextureContext& where) const {
  constexpr float kMax = 1e3f;
  const float u = Clamp(u_.Evaluate(where), 0, kMax);
  const float v = isAnisotropic_ ? Clamp(v_.Evaluate(where), 0, kMax) : u;
  const TrowbridgeReitz microfacets = remap_ ? TrowbridgeReitz(std::sqrt(u), std::sqrt(v)) : TrowbridgeReitz(u, v);
  return isRoughened_ ? microfacets.Roughened() : microfacets;
}

std::vector<float> RoughnessParameters::TableAlphas() const {
  if (!IsConstant()) return TexturedAlphas();
  const TrowbridgeReitz microfacets = Evaluate({});
  return {std::sqrt(microfacets.alphaX * microfacets.alphaY)};
}

MetalParameters::MetalParameters(const MaterialInput& input, const std::string& prefix) {
  reflectance_ = input.textures.FindColor(input.parameters, "reflectance", SpectrumRole::Albedo);
  const auto eta = input.textures.FindColor(input.parameters, prefix + "eta", SpectrumRole::Unbounded);
  const auto k = input.textures.FindColor(input.parameters, prefix + "k", SpectrumRole::Unbounded);
  if (reflectance_ && (eta || k)) {
    throw Error(input.parameters.WhereOf("reflectance"),
                "a metal takes either \"reflectance\" or \"" + prefix + "eta\" and \"" + prefix + "k\", not both");
  }
  if (reflectance_) return;
  eta_ = eta ? *eta : NamedSpectrum("metal-Cu-eta");
  k_ = k ? *k : NamedSpectrum("metal-Cu-k");
  const auto etaCurve = CurveOf(eta_), kCurve = CurveOf(k_);
  if (!etaCurve || !kCurve || (etaCurve->IsConstant() && kCurve->IsConstant())) return;
  const MetalIndex index = RgbIndexOf(*etaCurve, *kCurve);
  eta_ = {index.eta, etaCurve};
  k_ = {index.k, kCurve};
}

MetalIndex MetalParameters::Evaluate(const TextureContext& where) const {
  constexpr float kMax = 1e6f;
  const auto bound = [](const Color& c) {
    return Color(Clamp(c.r, 0, kMax), Clamp(c.g, 0, kMax), Clamp(c.b, 0, kMax));
  };
  if (!reflectance_) return {bound(eta_.Evaluate(where)), bound(k_.Evaluate(where))};
  // With η = 1 the reflectance at normal incidence is k²/(4 + k²) ([Pharr23 §9.4]).
  const Color r = reflectance_->Evaluate(where);
  const auto absorption = [](float x) {
    const float bounded = Clamp(x, 0, 0.9999f);
    return 2 * std::sqrt(bounded / (1 - bounded));
  };
  return {Color(1.0f), {absorption(r.r), absorption(r.g), absorption(r.b)}};
}

void MetalParameters::TuneTo(const std::shared_ptr<const Wavelengths>& wavelengths) {
  if (reflectance_) {
    reflectance_->TuneTo(wavelengths);
  } else {
    eta_.TuneTo(wavelengths);
    k_.TuneTo(wavelengths);
  }
}

bool MetalParameters::IsConstant() const {
  return reflectance_ ? reflectance_->IsConstant() : eta_.IsConstant() && k_.IsConstant();
}

namespace {

// The formula that replaces the spectrum of the index; null: none.
std::shared_ptr<const SpectralCurve> FindEtaFormula(const ParameterList& parameters) {
  const std::vector<double> cauchy = parameters.GetFloats("cauchy"), sellmeier = parameters.GetFloats("sellmeier");
  if (cauchy.empty() && sellmeier.empty()) return nullptr;
  const std::string name = cauchy.empty() ? "sellmeier" : "cauchy";
  const FileLocation where = parameters.WhereOf(name);
  if (!cauchy.empty() && !sellmeier.empty())
    throw Error(where, "an index is given by \"cauchy\" or by \"sellmeier\", not by both");
  if (!cauchy.empty() && cauchy.size() != 2 && cauchy.size() != 3)
    throw Error(where, "\"cauchy\" needs 2 or 3 numbers, a, b and c of n = a + b/λ² + c/λ⁴ with λ in µm; it has " +
                           std::to_string(cauchy.size()));
  if (!sellmeier.empty() && sellmeier.size() != 6)
    throw Error(where, "\"sellmeier\" needs 6 numbers, b1 b2 b3 c1 c2 c3 with c in µm²; it has " +
                           std::to_string(sellmeier.size()));
  const auto index = [&](double wavelength) {
    if (!cauchy.empty()) {
      return CauchyCoefficients{cauchy[0], cauchy[1], cauchy.size() > 2 ? cauchy[2] : 0}.IndexAt(wavelength);
    }
    return SellmeierCoefficients{{sellmeier[0], sellmeier[1], sellmeier[2]}, {sellmeier[3], sellmeier[4], sellmeier[5]}}
        .IndexAt(wavelength);
  };
  auto curve = std::make_shared<const SpectralCurve>(index);
  for (size_t i = 0; i < SpectralCurve::kCount; ++i) {
    if (!(curve->Entry(i) >= 1e-2 && curve->Entry(i) <= 1e2)) {
      throw Error(where, "\"" + name + "\" gives an index that is not between 0.01 and 100 at " +
                             std::to_string(static_cast<int>(SpectralCurve::WavelengthOf(i))) + " nm");
    }
  }
  return curve;
}

// The d line of helium, at which indices of refraction are quoted (n_d), nm.
constexpr double kQuotedWavelength = 587.56;

}  // namespace

std::shared_ptr<const SpectralCurve> FindEtaCurve(const MaterialInput& input, const std::string& name) {
  const Parameter* given = input.parameters.Find(name);
  auto curve = FindEtaFormula(input.parameters);
  if (curve && given) {
    throw Error(given->where, "\"" + name + "\" and a formula of the index exclude each other");
  }
  if (given && given->type == ParameterType::Spectrum)
    curve = input.parameters.FindCurve(name, SpectrumRole::Unbounded);
  return curve && !curve->IsConstant() ? curve : nullptr;
}

float GetEta(const MaterialInput& input, const std::string& name, float defaultValue) {
  const Parameter* given = input.parameters.Find(name);
  if (!given) {
    const auto curve = FindEtaFormula(input.parameters);
    return curve ? static_cast<float>(curve->At(kQuotedWavelength)) : defaultValue;
  }
  float eta = 0;
  if (given->type == ParameterType::Float) {
    eta = static_cast<float>(input.parameters.GetFloat(name, static_cast<double>(defaultValue)));
  } else {
    const Color color = input.parameters.GetColor(name, Color(defaultValue), SpectrumRole::Unbounded);
    eta = color.Average();
    if (given->type == ParameterType::Rgb && (color.r != color.g || color.g != color.b))
      input.diagnostics.Warn(given->where, "\"" + name +
                                               "\" is one index for all colours: the mean of these is used; "
                                               "glass that disperses has a spectrum, or \"cauchy\" or \"sellmeier\"");
  }
  if (eta == 0) {  // pbrt-v4: "no boundary"
    input.diagnostics.Warn(input.parameters.WhereOf(name), "\"" + name + "\" 0 is taken as 1");
    return 1;
  }
  if (!(eta >= 1e-2f && eta <= 1e2f)) {
    throw Error(input.parameters.WhereOf(name), "\"" + name + "\" must be an index of refraction between 0.01 and 100");
  }
  return eta;
}

}  // namespace lampyr
