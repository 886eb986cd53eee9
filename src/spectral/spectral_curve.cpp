#include "spectral/spectral_curve.h"

#include <algorithm>
#include <cmath>

namespace lampyr {

namespace {

double SquaredMicrometres(double nanometres) {
  return nanometres * nanometres * 1e-6;
}

}  // namespace

SpectralCurve::SpectralCurve(const std::function<double(double)>& f) {
  for (size_t i = 0; i < kCount; ++i) values_[i] = f(WavelengthOf(i));
}

double SpectralCurve::At(double wavelength) const {
  const double position = std::clamp(wavelength - kFirst, 0.0, static_cast<double>(kCount - 1));
  const size_t i = std::min(static_cast<size_t>(position), kCount - 2);
  return std::lerp(values_[i], values_[i + 1], position - static_cast<double>(i));
}

double SpectralCurve::Largest() const {
  return *std::max_element(values_.begin(), values_.end());
}

bool SpectralCurve::IsConstant() const {
  return std::all_of(values_.begin(), values_.end(), [this](double value) { return value == values_[0]; });
}

double SellmeierCoefficients::IndexAt(double wavelength) const {
  const double squared = SquaredMicrometres(wavelength);
  double sum = 1;
  for (size_t i = 0; i < b.size(); ++i) sum += b[i] * squared / (squared - c[i]);
  return std::sqrt(sum);
}

double CauchyCoefficients::IndexAt(double wavelength) const {
  const double squared = SquaredMicrometres(wavelength);
  return a + b / squared + c / (squared * squared);
}

}  // namespace lampyr
