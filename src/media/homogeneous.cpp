// A medium that is the same everywhere.
#include "media/medium_makers.h"
#include "spectral/wavelengths.h"

namespace lampyr {

namespace {

// The parameters of the coefficients: colours with their scale, and curves where spectra are given.
struct MediumColors {
  Color absorption, scattering, radiance;
  std::shared_ptr<const SpectralCurve> absorptionCurve, scatteringCurve, radianceCurve;
  float coefficientScale = 1, radianceScale = 1;  // of the curves

  MediumCoefficients Make() const { return {absorption, scattering, absorption * radiance}; }
  MediumCoefficients MakeAt(const Wavelengths& wavelengths) const {
    const auto at = [&](const Color& color, const std::shared_ptr<const SpectralCurve>& curve, float scale) {
      return curve ? wavelengths.At(*curve) * scale : wavelengths.FromRgb(color);
    };
    const Color a = at(absorption, absorptionCurve, coefficientScale);
    return {a, at(scattering, scatteringCurve, coefficientScale), a * at(radiance, radianceCurve, radianceScale)};
  }
};

class HomogeneousMedium : public Medium {
 public:
  HomogeneousMedium(const std::string& name, float asymmetry, const MediumCoefficients& coefficients,
                    std::shared_ptr<const MediumColors> colors)
      : Medium(name, asymmetry, !coefficients.emission.IsBlack(), !coefficients.scattering.IsBlack()),
        coefficients_(coefficients),
        colors_(std::move(colors)) {}

  MediumCoefficients At(const Point3&) const override { return coefficients_; }
  std::shared_ptr<const Medium> AtWavelengths(const std::shared_ptr<const Medium>&,
                                              const std::shared_ptr<const Wavelengths>& wavelengths) const override {
    return std::make_shared<HomogeneousMedium>(Name(), Asymmetry(), colors_->MakeAt(*wavelengths), colors_);
  }

 private:
  MediumCoefficients coefficients_;
  std::shared_ptr<const MediumColors> colors_;
};

}  // namespace

std::shared_ptr<const Medium> MakeHomogeneous(const MediumInput& input) {
  const ParameterList& parameters = input.Parameters();
  const ScatteringParameters scattering = GetScattering(parameters, true, true);
  MediumColors colors;
  colors.radianceScale = GetNonNegative(parameters, "Lescale", 1);
  colors.absorption = scattering.absorption;
  colors.scattering = scattering.scattering;
  colors.radiance = GetEmittedRadiance(parameters) * colors.radianceScale;
  if (parameters.GetString("preset", "").empty()) {
    colors.coefficientScale = GetNonNegative(parameters, "scale", 1);
    colors.absorptionCurve = parameters.FindCurve("sigma_a", SpectrumRole::Extinction);
    colors.scatteringCurve = parameters.FindCurve("sigma_s", SpectrumRole::Extinction);
  }
  colors.radianceCurve = parameters.FindCurve("Le", SpectrumRole::Illuminant);
  parameters.CheckAllUsed({}, {"type", "preset", "sigma_a", "sigma_s", "scale", "g", "Le", "Lescale"},
                          input.diagnostics);
  const MediumCoefficients coefficients = colors.Make();
  CheckRange(coefficients.emission, "the emission of this medium", parameters.Where());
  return std::make_shared<HomogeneousMedium>(input.description.name, scattering.asymmetry, coefficients,
                                             std::make_shared<const MediumColors>(std::move(colors)));
}

}  // namespace lampyr
