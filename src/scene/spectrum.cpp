#include "scene/spectrum.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "scene/lexer.h"
#include "scene/text_file.h"
#include "spectral/cie.h"
#include "spectral/wavelengths.h"

namespace lampyr {

namespace {

constexpr double kGrid = 1;  // nm

bool IsUnbounded(SpectrumRole role) {
  return role == SpectrumRole::Unbounded || role == SpectrumRole::Extinction;
}

// A piecewise linear spectrum at `lambda`. Beyond its ends it is 0, or constant if `continueEnds`.
double Evaluate(const std::vector<SpectrumSample>& spectrum, double lambda, bool continueEnds) {
  const auto above = std::lower_bound(spectrum.begin(), spectrum.end(), lambda,
                                      [](const SpectrumSample& s, double l) { return s.wavelength < l; });
  if (above == spectrum.end()) return continueEnds ? spectrum.back().value : 0;
  if (above->wavelength == lambda) return above->value;
  if (above == spectrum.begin()) return continueEnds ? above->value : 0;
  const SpectrumSample &a = *(above - 1), &b = *above;
  return std::lerp(a.value, b.value, (lambda - a.wavelength) / (b.wavelength - a.wavelength));
}

// The mean of such a spectrum over [low, high], exact.
double Mean(const std::vector<SpectrumSample>& spectrum, double low, double high, bool continueEnds) {
  const double first = spectrum.front().wavelength, last = spectrum.back().wavelength;
  double sum = 0;
  if (continueEnds) {
    sum += spectrum.front().value * std::max(std::min(high, first) - low, 0.0);
    sum += spectrum.back().value * std::max(high - std::max(low, last), 0.0);
  }
  double from = std::max(low, first);
  const double end = std::min(high, last);
  auto next = std::upper_bound(spectrum.begin(), spectrum.end(), from,
                               [](double l, const SpectrumSample& s) { return l < s.wavelength; });
  while (from < end) {  // `next` is the first sample beyond `from`
    const double to = std::min(next->wavelength, end);
    sum += 0.5 * (Evaluate(spectrum, from, false) + Evaluate(spectrum, to, false)) * (to - from);
    from = to;
    if (next->wavelength <= from) ++next;
  }
  return sum / (high - low);
}

// Wavelengths to integrate over: every nanometre of the visible range, and around each sample of the spectrum, so that
// narrow lines are not missed and jumps at the ends remain jumps.
std::vector<double> GridOf(const std::vector<SpectrumSample>& spectrum) {
  std::vector<double> list;
  for (double lambda = kLambdaMin; lambda <= kLambdaMax; lambda += kGrid) list.push_back(lambda);
  for (const SpectrumSample& sample : spectrum) {
    for (const double lambda : {sample.wavelength - 1e-6, sample.wavelength, sample.wavelength + 1e-6}) {
      if (lambda > kLambdaMin && lambda < kLambdaMax) list.push_back(lambda);
    }
  }
  std::sort(list.begin(), list.end());
  return list;
}

// ∫ f(λ) dλ by the trapezoid rule.
Vector3d Integrate(const std::vector<double>& wavelengths, const std::function<Vector3d(double)>& f) {
  Vector3d sum(0.0), last = f(wavelengths.front());
  for (size_t i = 1; i < wavelengths.size(); ++i) {
    const Vector3d value = f(wavelengths[i]);
    sum += (last + value) * (0.5 * (wavelengths[i] - wavelengths[i - 1]));
    last = value;
  }
  return sum;
}

// Integrals over D65, which calibrate the fitted matching functions so that D65 is exactly white.
const Vector3d& WhiteIntegral() {
  static const Vector3d white =
      Integrate(GridOf({}), [](double lambda) { return ColorMatching(lambda) * DaylightD65(lambda); });
  return white;
}

// XYZ (Y = 1 for white) from integrals over the matching functions.
Vector3d CalibratedXyz(const Vector3d& integrals) {
  return integrals / WhiteIntegral() * XyzOfChromaticity(0.3127, 0.3290);
}

Vector3d ChannelWeights(double lambda) {
  const Vector3d rgb = XyzToRec709(CalibratedXyz(ColorMatching(lambda) * DaylightD65(lambda)));
  return glm::max(rgb, Vector3d(0.0));
}

Color ToColor(const Vector3d& c) {
  return {static_cast<float>(c.x), static_cast<float>(c.y), static_cast<float>(c.z)};
}

Color FunctionToColor(const std::function<double(double)>& f, const std::vector<double>& wavelengths,
                      SpectrumRole role) {
  if (IsUnbounded(role)) {
    const Vector3d sum = Integrate(wavelengths, [&](double l) { return ChannelWeights(l) * f(l); });
    return ToColor(sum / Integrate(wavelengths, ChannelWeights));
  }
  if (role == SpectrumRole::Albedo) {
    const auto reflected = [&](double l) { return ColorMatching(l) * (DaylightD65(l) * f(l)); };
    const auto white = [](double l) { return ColorMatching(l) * DaylightD65(l); };
    // Both integrals on the same grid: a reflectance of 1 is white to the last bit.
    const Vector3d xyz =
        Integrate(wavelengths, reflected) / Integrate(wavelengths, white) * XyzOfChromaticity(0.3127, 0.3290);
    const Color color = ClampToGamut(XyzToRec709(xyz));
    return {std::min(color.r, 1.0f), std::min(color.g, 1.0f), std::min(color.b, 1.0f)};
  }
  const Vector3d xyz = CalibratedXyz(Integrate(wavelengths, [&](double l) { return ColorMatching(l) * f(l); }));
  if (!(xyz.y > 0)) return Color(0.0f);
  return ClampToGamut(XyzToRec709(xyz / xyz.y));
}

}  // namespace

Color SpectrumToColor(const std::vector<SpectrumSample>& spectrum, SpectrumRole role) {
  const bool continueEnds = role == SpectrumRole::Unbounded;
  double largest = 0;
  for (const SpectrumSample& sample : spectrum) largest = std::max(largest, sample.value);
  if (largest == 0) return Color(0.0f);
  // Scaled to a maximum of 1 for the integration: no overflow or underflow, whatever the unit.
  const auto f = [&](double lambda) { return Evaluate(spectrum, lambda, continueEnds) / largest; };
  const std::vector<double> wavelengths = GridOf(spectrum);
  if (role == SpectrumRole::Illuminant) return FunctionToColor(f, wavelengths, role);
  if (IsUnbounded(role)) return FunctionToColor(f, wavelengths, role) * static_cast<float>(largest);
  const auto unscaled = [&](double lambda) { return std::min(1.0, Evaluate(spectrum, lambda, false)); };
  return FunctionToColor(unscaled, wavelengths, role);
}

Color BlackbodyToColor(double kelvin, SpectrumRole role) {
  const std::vector<double> wavelengths = GridOf({});
  double largest = 0;
  for (const double lambda : wavelengths) largest = std::max(largest, Blackbody(lambda, kelvin));
  return FunctionToColor([&](double lambda) { return Blackbody(lambda, kelvin) / largest; }, wavelengths, role);
}

Color NormalizedBlackbody(double kelvin) {
  // Planck's law over its maximum, by Wien's displacement law: x = hc / (λ k T) is kPeak there.
  constexpr double kPeak = 4.965114231744276, kSecondRadiation = 1.438776877e7;  // nm·K
  const auto relative = [kelvin](double lambda) {
    const double x = kSecondRadiation / (lambda * kelvin);
    return std::pow(x / kPeak, 5) * std::exp(kPeak - x) * (std::expm1(-kPeak) / std::expm1(-x));
  };
  const std::vector<double> wavelengths = GridOf({});
  const double luminance = Integrate(wavelengths, [&](double l) { return ColorMatching(l) * relative(l); }).y;
  return FunctionToColor(relative, wavelengths, SpectrumRole::Illuminant) * static_cast<float>(luminance);
}

SpectralCurve CurveOfPower(const SpectralCurve& power, SpectrumRole role) {
  const double largest = power.Largest();
  if (IsUnbounded(role) || !(largest > 0)) return power;
  if (role == SpectrumRole::Albedo)
    return SpectralCurve([&](double wavelength) { return power.At(wavelength) / largest; });
  const SpectralCurve relative(
      [&](double wavelength) { return power.At(wavelength) / largest / DaylightD65(wavelength); });
  const Vector3d rgb = ColorOf(relative);
  const double luminance = glm::dot(rgb, Vector3d(Color::kLuminance[0], Color::kLuminance[1], Color::kLuminance[2]));
  return luminance > 0 ? SpectralCurve([&](double wavelength) { return relative.At(wavelength) / luminance; })
                       : SpectralCurve();
}

SpectralCurve CurveOf(const std::vector<SpectrumSample>& spectrum, SpectrumRole role) {
  // The mean over the nanometre around the wavelength, so that a narrow line keeps its power.
  const bool continueEnds = role == SpectrumRole::Unbounded;
  const SpectralCurve curve(
      [&](double wavelength) { return Mean(spectrum, wavelength - 0.5, wavelength + 0.5, continueEnds); });
  if (role == SpectrumRole::Illuminant) return CurveOfPower(curve, role);
  if (IsUnbounded(role)) return curve;
  return SpectralCurve([&](double wavelength) { return std::min(curve.At(wavelength), 1.0); });
}

SpectralCurve BlackbodyCurve(double kelvin, SpectrumRole role) {
  const SpectralCurve body([&](double wavelength) { return Blackbody(wavelength, kelvin); });
  // Other roles: scaled to a maximum of 1, as in BlackbodyToColor.
  return CurveOfPower(body, role == SpectrumRole::Illuminant ? role : SpectrumRole::Albedo);
}

namespace {

// `whereOf`: the location of a pair.
std::vector<SpectrumSample> CheckedPairs(const std::vector<double>& numbers, SpectrumRole role,
                                         const FileLocation& where,
                                         const std::function<FileLocation(size_t)>& whereOf) {
  constexpr double kLargestAlbedo = 1.1;  // measurements are off by a few percent
  constexpr double kShortest = 100;       // nm; a spectrum that ends below has no visible wavelength
  if (numbers.size() % 2 != 0) {
    throw Error(where, "a spectrum is pairs of wavelength and value: " + std::to_string(numbers.size()) +
                           " numbers are not a multiple of 2");
  }
  if (numbers.size() < 4) throw Error(where, "a spectrum needs at least 2 pairs of wavelength and value");
  std::vector<SpectrumSample> spectrum(numbers.size() / 2);
  for (size_t i = 0; i < spectrum.size(); ++i) {
    spectrum[i] = {numbers[2 * i], numbers[2 * i + 1]};
    const auto fail = [&](const char* what) {
      throw Error(whereOf(i), "pair " + std::to_string(i + 1) + " of the spectrum " + what);
    };
    if (!(spectrum[i].wavelength > 0)) fail("has a wavelength that is not above 0 nm");
    if (i > 0 && !(spectrum[i].wavelength > spectrum[i - 1].wavelength))
      fail("does not have a longer wavelength than the pair before");
    if (spectrum[i].value < 0) fail("has a negative value");
    if (role == SpectrumRole::Albedo && spectrum[i].value > kLargestAlbedo)
      fail("has a value above 1: a surface reflects at most what it receives. Is it in percent?");
  }
  if (spectrum.back().wavelength < kShortest)
    throw Error(whereOf(0), "the spectrum ends below 100 nm: wavelengths are in nanometres. Are these micrometres?");
  return spectrum;
}

}  // namespace

std::vector<SpectrumSample> SpectrumFromPairs(const std::vector<double>& numbers, SpectrumRole role,
                                              const FileLocation& where) {
  return CheckedPairs(numbers, role, where, [&](size_t) { return where; });
}

std::vector<SpectrumSample> ReadSpectrumFile(const std::filesystem::path& file, SpectrumRole role,
                                             const FileLocation& where) {
  const auto name = std::make_shared<const std::string>(file.string());
  Lexer lexer(name, ReadTextFile(file, where));
  std::vector<double> numbers;
  std::vector<int> lines;  // of each pair
  for (double number = 0; lexer.TryNumber(number);) {
    if (numbers.size() % 2 == 0) lines.push_back(lexer.Line());
    numbers.push_back(number);
  }
  const Token rest = lexer.Next();
  if (rest.kind != TokenKind::End) throw Error(rest.where, Describe(rest) + " is not a number");
  return CheckedPairs(numbers, role, FileLocation{name}, [&](size_t pair) {
    return FileLocation{name, lines[pair], 1};
  });
}

}  // namespace lampyr
