// A medium that is the same everywhere.
#include "media/medium_makers.h"

namespace lampyr {

namespace {

class HomogeneousMedium : public Medium {
 public:
  HomogeneousMedium(const std::string& name, float asymmetry, const MediumCoefficients& coefficients)
      : Medium(name, asymmetry, !coefficients.emission.IsBlack(), !coefficients.scattering.IsBlack()),
        coefficients_(coefficients) {}

  MediumCoefficients At(const Point3&) const override { return coefficients_; }

 private:
  MediumCoefficients coefficients_;
};

}  // namespace

std::shared_ptr<const Medium> MakeHomogeneous(const MediumInput& input) {
  const ParameterList& parameters = input.Parameters();
  const ScatteringParameters scattering = GetScattering(parameters, true, true);
  const Color radiance = GetEmittedRadiance(parameters) * GetNonNegative(parameters, "Lescale", 1);
  parameters.CheckAllUsed({}, {"type", "preset", "sigma_a", "sigma_s", "scale", "g", "Le", "Lescale"},
                          input.diagnostics);
  const Color emission = scattering.absorption * radiance;
  CheckRange(emission, "the emission of this medium", parameters.Where());
  return std::make_shared<HomogeneousMedium>(
      input.description.name, scattering.asymmetry,
      MediumCoefficients{scattering.absorption, scattering.scattering, emission});
}

}  // namespace lampyr
