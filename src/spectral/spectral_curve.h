// A function of the wavelength: reflectance, index, coefficient or light.
#pragma once

#include <array>
#include <functional>
#include <memory>

namespace lampyr {

// Tabulated at each nanometre of the visible range, and linear in between. Immutable.
class SpectralCurve {
 public:
  // Wavelengths in nm. 471 values.
  static constexpr int kFirst = 360, kLast = 830;
  static constexpr size_t kCount = kLast - kFirst + 1;

  SpectralCurve() = default;  // 0
  // Tabulates a function of the wavelength in nm. The caller has to average a function that varies within a nanometre.
  explicit SpectralCurve(const std::function<double(double)>& f);

  // `wavelength` in nm; constant beyond the ends.
  double At(double wavelength) const;
  double Entry(size_t i) const { return values_[i]; }
  static double WavelengthOf(size_t i) { return kFirst + static_cast<double>(i); }
  double Largest() const;
  bool IsConstant() const;

 private:
  std::array<double, kCount> values_{};
};

// Index of refraction of a glass by its Sellmeier coefficients ([Born99 §2.3.4]), `c` in µm²:
//   n² = 1 + Σ b λ² / (λ² - c), λ in µm.
struct SellmeierCoefficients {
  std::array<double, 3> b{}, c{};
  double IndexAt(double wavelength) const;  // nm; NaN where n² is not above 0
};

// Index of refraction by Cauchy's formula, λ in µm: n = a + b / λ² + c / λ⁴.
struct CauchyCoefficients {
  double a = 1, b = 0, c = 0;
  double IndexAt(double wavelength) const;  // nm
};

}  // namespace lampyr
