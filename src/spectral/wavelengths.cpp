#include "spectral/wavelengths.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "spectral/cie.h"
#include "spectral/color_space.h"

namespace lampyr {

namespace {

// Red and blue of the upsampling basis every 10 nm from 360 nm on; green is the rest to 1. scripts/fit_upsampling.py
// makes it.
constexpr double kBasisStep = 10;
constexpr std::array<std::array<double, 2>, 48> kBasis = {{
    {0.0265425, 0.9734575},
    {0.0265416, 0.9734584},
    {0.0265368, 0.9734632},
    {0.0265198, 0.9734802},
    {0.0264563, 0.9735437},
    {0.0262009, 0.9737991},
    {0.0253246, 0.9746754},
    {0.02298, 0.97702},
    {0.0194513, 0.9805487},
    {0.0188318, 0.9811682},
    {0.0305803, 0.9694197},
    {0.0124801, 0.8752892},
    {0, 0.7024061},
    {0, 0.491342},
    {0, 0.2852386},
    {0, 0.1150063},
    {0, 0.0114463},
    {0, 0},
    {0, 0},
    {0, 0},
    {0, 0},
    {0.0187152, 0.0462409},
    {0.2084836, 0.0516821},
    {0.4767427, 0.034682},
    {0.7362296, 0.012995},
    {0.921657, 0},
    {1, 0},
    {1, 0},
    {1, 0},
    {1, 0},
    {1, 0},
    {1, 0},
    {1, 0},
    {1, 0},
    {1, 0},
    {1, 0},
    {1, 0},
    {1, 0},
    {1, 0},
    {1, 0},
    {1, 0},
    {1, 0},
    {1, 0},
    {1, 0},
    {1, 0},
    {1, 0},
    {1, 0},
    {1, 0},
}};

// Matching functions for red, green and blue times D65, per nm, whose integrals are 1 each.
struct Tables {
  SpectralCurve rgb[3];

  Tables() {
    Vector3d white(0.0);
    const auto weighted = [](double wavelength) { return ColorMatching(wavelength) * DaylightD65(wavelength); };
    // The trapezoid rule, which is exact for curves, linear between their entries.
    constexpr size_t last = SpectralCurve::kCount - 1;
    for (size_t i = 0; i <= last; ++i)
      white += weighted(SpectralCurve::WavelengthOf(i)) * (i == 0 || i == last ? 0.5 : 1.0);
    for (int c = 0; c < 3; ++c) {
      rgb[c] = SpectralCurve([&](double wavelength) {
        return XyzToRec709(weighted(wavelength) / white * XyzOfChromaticity(0.3127, 0.3290))[c];
      });
    }
  }
};

const Tables& TheTables() {
  static const Tables tables;
  return tables;
}

// A smooth density of wavelengths, proportional to 1 / cosh²(slope (λ - middle)). It is smooth: then a regular grid of
// a few places integrates the smooth functions that spectra mostly are, which a density in proportion to the weights,
// with their three peaks, would spoil. Of this family the variance of a single wavelength is least here.
class SmoothDensity {
 public:
  double At(double wavelength) const {
    const double c = std::cosh(kSlope * (wavelength - kMiddle));
    return kSlope / ((high_ - low_) * c * c);
  }
  double Below(double wavelength) const { return (std::tanh(kSlope * (wavelength - kMiddle)) - low_) / (high_ - low_); }
  // The wavelength below which the integral is u.
  double Invert(double u) const {
    const double wavelength = kMiddle + std::atanh(low_ + u * (high_ - low_)) / kSlope;
    return std::clamp(wavelength, static_cast<double>(SpectralCurve::kFirst),
                      static_cast<double>(SpectralCurve::kLast));
  }

 private:
  static constexpr double kMiddle = 535, kSlope = 0.009;
  double low_ = std::tanh(kSlope * (SpectralCurve::kFirst - kMiddle)),
         high_ = std::tanh(kSlope * (SpectralCurve::kLast - kMiddle));
};

// The density of wavelengths: the smooth one, or the mean of it and of an even one over a range.
class Density {
 public:
  explicit Density(const std::optional<WavelengthRange>& even) : even_(even) {}

  double At(double wavelength) const {
    if (!even_) return smooth_.At(wavelength);
    const bool isInside = wavelength >= even_->from && wavelength <= even_->to;
    return 0.5 * (smooth_.At(wavelength) + (isInside ? 1 / (even_->to - even_->from) : 0.0));
  }
  double Invert(double u) const {
    if (!even_) return smooth_.Invert(u);
    double low = SpectralCurve::kFirst, high = SpectralCurve::kLast;
    constexpr int enough = 60;  // halvings, beyond the precision of a double
    for (int i = 0; i < enough; ++i) {
      const double middle = 0.5 * (low + high);
      const double ofEven = std::clamp((middle - even_->from) / (even_->to - even_->from), 0.0, 1.0);
      (0.5 * (smooth_.Below(middle) + ofEven) < u ? low : high) = middle;
    }
    return 0.5 * (low + high);
  }

 private:
  SmoothDensity smooth_;
  std::optional<WavelengthRange> even_;
};

double FractionOf(double x) {
  return x - std::floor(x);
}

}  // namespace

Color UpsamplingBasis(double wavelength) {
  const double position =
      std::clamp((wavelength - SpectralCurve::kFirst) / kBasisStep, 0.0, static_cast<double>(kBasis.size() - 1));
  const size_t i = std::min(static_cast<size_t>(position), kBasis.size() - 2);
  const double t = position - static_cast<double>(i);
  const double red = std::lerp(kBasis[i][0], kBasis[i + 1][0], t), blue = std::lerp(kBasis[i][1], kBasis[i + 1][1], t);
  return {static_cast<float>(red), static_cast<float>(std::max(1 - red - blue, 0.0)), static_cast<float>(blue)};
}

double WhiteSpectrum(double wavelength) {
  static const double scale = [] {
    double observer = 0, white = 0;
    for (double at = kLambdaMin; at <= kLambdaMax; at += 1) {
      observer += ColorMatching(at).y;
      white += ColorMatching(at).y * DaylightD65(at);
    }
    return observer / white;
  }();
  return scale * DaylightD65(wavelength);
}

Wavelengths::Wavelengths(double u, const std::optional<WavelengthRange>& even) {
  const Tables& tables = TheTables();
  const Density density(even);
  for (int lane = 0; lane < kLanes; ++lane) {
    const double wavelength = density.Invert(std::clamp((lane + u) / kLanes, 0.0, 1.0));
    wavelengths_[static_cast<size_t>(lane)] = wavelength;
    basis_[static_cast<size_t>(lane)] = UpsamplingBasis(wavelength);
    const double perDensity = 1 / (kLanes * density.At(wavelength));
    perDensity_[static_cast<size_t>(lane)] = perDensity;
    for (int c = 0; c < 3; ++c) {
      const double weight = tables.rgb[c].At(wavelength) * perDensity;
      toRgb_[lane][c] = static_cast<float>(weight);
      white_[static_cast<size_t>(c)] += weight;
    }
  }
}

// The van der Corput sequence would be as regular, but Sobol samples of the pixels are made of the same bits: pixels
// would see one half of the spectrum in one half of their area. The passes from 2^n to 2^(n+1) therefore take the
// places between those of before in another order, by the golden section.
Wavelengths Wavelengths::OfPass(uint64_t seed, uint64_t pass, const std::optional<WavelengthRange>& even) {
  constexpr double kGolden = 0.6180339887498949, kPerSeed = 0.7548776662466927;
  const double shift = FractionOf(kPerSeed * static_cast<double>(1 + seed % (uint64_t{1} << 20)));
  if (pass == 0) return Wavelengths(shift, even);
  const uint64_t places = std::bit_floor(pass), number = pass - places;
  // The odd step nearest to places · golden section visits all places once.
  const auto step = static_cast<uint64_t>(kGolden * static_cast<double>(places)) | 1;
  const uint64_t place = number * step % places;
  return Wavelengths(FractionOf(shift + (static_cast<double>(place) + 0.5) / static_cast<double>(places)), even);
}

Color Wavelengths::FromRgb(const Color& rgb) const {
  if (rgb.r == rgb.g && rgb.g == rgb.b) return rgb;
  const auto at = [&rgb](const Color& weights) { return rgb.r * weights.r + rgb.g * weights.g + rgb.b * weights.b; };
  return {at(basis_[0]), at(basis_[1]), at(basis_[2])};
}

Color Wavelengths::At(const SpectralCurve& curve) const {
  return {static_cast<float>(curve.At(wavelengths_[0])), static_cast<float>(curve.At(wavelengths_[1])),
          static_cast<float>(curve.At(wavelengths_[2]))};
}

Vector3d ColorOf(const SpectralCurve& relativeToWhite) {
  const Tables& tables = TheTables();
  Vector3d sum(0.0);
  constexpr size_t last = SpectralCurve::kCount - 1;
  for (size_t i = 0; i <= last; ++i) {
    const double value = relativeToWhite.Entry(i) * (i == 0 || i == last ? 0.5 : 1.0);
    sum += value * Vector3d(tables.rgb[0].Entry(i), tables.rgb[1].Entry(i), tables.rgb[2].Entry(i));
  }
  return sum;
}

}  // namespace lampyr
