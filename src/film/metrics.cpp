// Differences of two images: sums in double over all pixels and the channels R, G, B.
#include "film/metrics.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <optional>

#include "base/error.h"
#include "film/film.h"
#include "film/flip.h"

namespace lampyr {

namespace {

using Planes = std::array<std::vector<double>, 3>;  // R, G, B

// An image with the data that the metrics need.
struct Measured {
  std::vector<Color> colors;
  std::optional<Planes> variance;  // of the pixels' means
  std::vector<float> sharing;      // factor of a pixel's variance in a sum over pixels; empty: 1
  bool isOfOneSample = false;      // its variances are 0, because one sample has none
  bool isDenoised = false;         // the errors of nearby pixels are correlated
  float relativeRounding = 0;      // of the stored format, half or float
  double samples = 0;              // per pixel; 0: not known
  double brightness = 0;           // mean of all values
};

std::vector<Color> ReadColors(const Image& image, const char* which) {
  if (!image.HasRgb()) throw Error(std::string("the ") + which + " image has no channels R, G and B");
  std::vector<Color> colors;
  colors.reserve(static_cast<size_t>(image.width) * static_cast<size_t>(image.height));
  size_t broken = 0;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      colors.push_back(image.RgbAt(x, y));
      const Color& c = colors.back();
      if (!std::isfinite(c.r) || !std::isfinite(c.g) || !std::isfinite(c.b)) ++broken;
    }
  }
  if (broken > 0) {
    throw Error("the " + std::string(which) + " image has " + std::to_string(broken) +
                " pixels that are infinite or not numbers");
  }
  return colors;
}

// Variances of the pixel means: from "variance.R" … or, squared, from "stderr.R" …
std::optional<Planes> ReadVariance(const Image& image, const char* which) {
  Planes planes;
  for (const bool isVariance : {true, false}) {
    const std::string layer = isVariance ? "variance." : "stderr.";
    const int index[3] = {image.ChannelIndex(layer + "R"), image.ChannelIndex(layer + "G"),
                          image.ChannelIndex(layer + "B")};
    if (index[0] < 0 || index[1] < 0 || index[2] < 0) continue;
    for (int c = 0; c < 3; ++c) {
      for (size_t i = static_cast<size_t>(index[c]); i < image.data.size(); i += image.channels.size()) {
        const float value = image.data[i];
        if (!(value >= 0) || std::isinf(value)) {
          throw Error("the layer \"" + layer + "\" of the " + which + " image has values that are no " +
                      (isVariance ? "variance" : "standard error"));
        }
        const auto wide = static_cast<double>(value);
        planes[c].push_back(isVariance ? wide : wide * wide);
      }
    }
    return planes;
  }
  return std::nullopt;
}

// Relative rounding error of the stored values. In images stored as half, the last 13 bits are 0. The rounding of a
// constant region does not average out, so that the block test has to allow for it.
float RelativeRounding(const std::vector<Color>& colors) {
  const auto isHalf = [](float v) { return (std::bit_cast<uint32_t>(v) & 0x1fffu) == 0; };
  const bool allHalf = std::all_of(colors.begin(), colors.end(),
                                   [&](const Color& c) { return isHalf(c.r) && isHalf(c.g) && isHalf(c.b); });
  return allHalf ? 0x1p-11f : 0x1p-22f;
}

// Factors of the variances of pixels in sums over them, because splats are in several pixels at once.
std::vector<float> ReadSharing(const Image& image) {
  std::vector<float> factors;
  const int channel = image.ChannelIndex(kSplatShareChannel);
  const auto count = image.metadata.find(kSplatCountMetadata);
  if (channel < 0 || count == image.metadata.end()) return factors;
  const float more = std::clamp(static_cast<float>(std::atof(count->second.c_str())), 1.0f, 1e6f) - 1;
  for (size_t i = static_cast<size_t>(channel); i < image.data.size(); i += image.channels.size())
    factors.push_back(1 + more * std::clamp(image.data[i], 0.0f, 1.0f));
  return factors;
}

Measured Measure(const Image& image, const char* which) {
  Measured measured;
  measured.colors = ReadColors(image, which);
  measured.variance = ReadVariance(image, which);
  measured.relativeRounding = RelativeRounding(measured.colors);
  measured.isOfOneSample = IsOfOneSample(image);
  measured.isDenoised = image.ChannelIndex("noisy.R") >= 0;
  measured.sharing = ReadSharing(image);
  if (const auto samples = image.metadata.find("lampyr.samplesPerPixel"); samples != image.metadata.end())
    measured.samples = std::max(std::atof(samples->second.c_str()), 0.0);
  for (const Color& color : measured.colors)
    measured.brightness += static_cast<double>(color.Average()) / static_cast<double>(measured.colors.size());
  return measured;
}

// The variance of a pixel in a sum over pixels.
double VarianceInSum(const Measured& image, int channel, size_t i) {
  const double variance = (*image.variance)[channel][i];
  return image.sharing.empty() ? variance : variance * static_cast<double>(image.sharing[i]);
}

// Largest difference between two equal values that were summed in another order and stored.
double RoundingOf(double a, double b, const Measured& first, const Measured& second) {
  return std::abs(a) * static_cast<double>(first.relativeRounding) +
         std::abs(b) * static_cast<double>(second.relativeRounding) +
         static_cast<double>(std::numeric_limits<float>::min());
}

std::array<double, 3> Channels(const Color& c) {
  return {static_cast<double>(c.r), static_cast<double>(c.g), static_cast<double>(c.b)};
}

// value / divisor with 0/0 = 0; infinite if only the divisor is 0.
double Ratio(double value, double divisor) {
  if (value == 0) return 0;
  return divisor == 0 ? std::copysign(std::numeric_limits<double>::infinity(), value) : value / divisor;
}

void MeasureErrors(const Measured& a, const Measured& b, ImageDifference& difference) {
  const size_t pixels = a.colors.size();
  const double n = 3.0 * static_cast<double>(pixels);
  double squares = 0, referenceSquares = 0;
  for (size_t i = 0; i < pixels; ++i) {
    const auto va = Channels(a.colors[i]), vb = Channels(b.colors[i]);
    for (int c = 0; c < 3; ++c) {
      squares += (va[c] - vb[c]) * (va[c] - vb[c]);
      referenceSquares += vb[c] * vb[c];
      difference.meanA += va[c] / n;
      difference.meanB += vb[c] / n;
    }
  }
  difference.mse = squares / n;
  const double floor = 0.01 * referenceSquares / n;
  double relative = 0;
  for (size_t i = 0; i < pixels; ++i) {
    const auto va = Channels(a.colors[i]), vb = Channels(b.colors[i]);
    for (int c = 0; c < 3; ++c) relative += Ratio((va[c] - vb[c]) * (va[c] - vb[c]), vb[c] * vb[c] + floor);
  }
  difference.relMse = relative / n;
}

// Variance of the difference of the means of a pixel in a sum over pixels, averaged over its channels. The channels
// share the paths of the pixel and are taken as fully correlated: exact for gray, an upper bound otherwise.
double VarianceOfGray(const Measured& a, const Measured& b, size_t i) {
  double deviation = 0;
  for (int c = 0; c < 3; ++c) {
    deviation += std::sqrt(VarianceInSum(a, c, i) + VarianceInSum(b, c, i));
  }
  return deviation * deviation / 9;
}

void MeasureBias(const Measured& a, const Measured& b, ImageDifference& difference) {
  const size_t pixels = a.colors.size();
  const double n = static_cast<double>(pixels), bias = difference.meanA - difference.meanB;
  double varianceOfMean = 0;
  for (size_t i = 0; i < pixels; ++i) {
    if (a.variance && b.variance) {
      varianceOfMean += VarianceOfGray(a, b, i) / (n * n);
    } else {
      const auto va = Channels(a.colors[i]), vb = Channels(b.colors[i]);
      const double gray = (va[0] - vb[0] + va[1] - vb[1] + va[2] - vb[2]) / 3;
      varianceOfMean += (gray - bias) * (gray - bias) / (n * std::max(1.0, n - 1));
    }
  }
  difference.bias = Ratio(bias, std::abs(difference.meanB));
  difference.biasInterval = Ratio(1.959963984540054 * std::sqrt(varianceOfMean), std::abs(difference.meanB));
}

// Variance of a sum over pixels that is 0 in one image and `expected` in another: that of samples as bright as the
// picture, and as rare as `expected` implies. Example: a pixel that only the tail of a filter reaches.
double VarianceOfNothing(const Measured& image, double expected) {
  return image.samples > 0 ? std::abs(expected) * image.brightness / image.samples : 0.0;
}

// z of one block and channel: difference of the block means over its standard error; 0 for a difference within
// rounding. Empty if there is neither a difference nor a variance.
std::optional<double> BlockZ(const Measured& a, const Measured& b, int channel, int width, const int (&block)[4]) {
  double sumA = 0, sumB = 0, varianceA = 0, varianceB = 0;
  for (int y = block[1]; y < block[3]; ++y) {
    for (int x = block[0]; x < block[2]; ++x) {
      const size_t i = static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x);
      sumA += Channels(a.colors[i])[channel];
      sumB += Channels(b.colors[i])[channel];
      varianceA += VarianceInSum(a, channel, i);
      varianceB += VarianceInSum(b, channel, i);
    }
  }
  if (sumA == 0 && varianceA == 0) varianceA = VarianceOfNothing(a, sumB);
  if (sumB == 0 && varianceB == 0) varianceB = VarianceOfNothing(b, sumA);
  const double variance = varianceA + varianceB;
  // The rounding of a constant region is the same in all its pixels, so that it adds up like the values.
  const double rounding = RoundingOf(sumA, sumB, a, b);
  const bool isRounding = std::abs(sumA - sumB) <= rounding;
  if (variance == 0 && isRounding) return std::nullopt;
  return isRounding ? 0 : (sumA - sumB) / std::sqrt(variance + rounding * rounding / 3);
}

// Half of the family-wise rate is given to the largest z, half to the sum of squares; both are divided among the
// channels. chiSquared is that of the worst channel: two channels that agree must not hide one that does not.
BlockTest TestBlocks(const Measured& a, const Measured& b, int width, int height, int blockSize, double rate) {
  BlockTest test;
  test.blockSize = blockSize;
  int blocksOf[3] = {0, 0, 0};
  double chiSquaredOf[3] = {0, 0, 0};
  for (int y = 0; y < height; y += blockSize) {
    for (int x = 0; x < width; x += blockSize) {
      const int block[4] = {x, y, std::min(x + blockSize, width), std::min(y + blockSize, height)};
      for (int c = 0; c < 3; ++c) {
        const auto z = BlockZ(a, b, c, width, block);
        if (!z) continue;
        ++blocksOf[c];
        chiSquaredOf[c] += *z * *z;
        test.largestZ = std::max(test.largestZ, std::abs(*z));
      }
    }
  }
  const double rateOfEach = SidakRate(rate, 2);
  test.threshold = NormalQuantileTwoSided(SidakRate(rateOfEach, blocksOf[0] + blocksOf[1] + blocksOf[2]));
  double worst = -1;
  for (int c = 0; c < 3; ++c) {
    const double threshold = ChiSquaredQuantile(SidakRate(rateOfEach, 3), blocksOf[c]);
    const double excess = threshold > 0 ? chiSquaredOf[c] / threshold : 0;
    if (excess <= worst) continue;
    worst = excess;
    test.blocks = blocksOf[c];
    test.chiSquared = chiSquaredOf[c];
    test.chiSquaredThreshold = threshold;
  }
  return test;
}

}  // namespace

namespace {

void CheckSameSize(const Image& a, const Image& b) {
  if (a.width != b.width || a.height != b.height || a.width <= 0 || a.height <= 0) {
    throw Error("the images have different sizes: " + std::to_string(a.width) + " x " + std::to_string(a.height) +
                " and " + std::to_string(b.width) + " x " + std::to_string(b.height));
  }
  if (a.offsetX != b.offsetX || a.offsetY != b.offsetY) throw Error("the images are different crops");
}

// Calls visit(pixel, channel, reference value, its variance, divisor of relMse) for all pixels and channels.
template <class Visit>
void VisitReference(const Measured& reference, Visit visit) {
  const size_t pixels = reference.colors.size();
  double squares = 0;
  for (const Color& color : reference.colors) {
    for (const double v : Channels(color)) squares += v * v;
  }
  const double floor = 0.01 * squares / (3.0 * static_cast<double>(pixels));
  for (size_t i = 0; i < pixels; ++i) {
    const auto value = Channels(reference.colors[i]);
    for (size_t c = 0; c < 3; ++c) {
      const double variance = reference.variance ? (*reference.variance)[c][i] : 0.0;
      visit(i, c, value[c], variance, value[c] * value[c] + floor);
    }
  }
}

double MeanOfMap(const std::vector<float>& map) {
  double sum = 0;
  for (const float value : map) sum += static_cast<double>(value);
  return sum / static_cast<double>(map.size());
}

}  // namespace

bool IsOfOneSample(const Image& image) {
  const auto text = [&](const char* name) {
    const auto found = image.metadata.find(name);
    return found == image.metadata.end() ? std::string() : found->second;
  };
  const std::string samples = text("lampyr.samplesPerPixel");
  return (samples == "0" || samples == "1") && text("lampyr.integrator") != "light";
}

ImageError MeasureError(const Image& image, const Image& reference, float exposureStops) {
  CheckSameSize(image, reference);
  Measured measured = Measure(image, "first"), truth = Measure(reference, "reference");
  const double n = 3.0 * static_cast<double>(truth.colors.size());
  ImageError error;
  double sum = 0, sumOfReference = 0;
  VisitReference(truth, [&](size_t i, size_t c, double value, double variance, double divisor) {
    const double difference = Channels(measured.colors[i])[c] - value;
    error.mse += (difference * difference - variance) / n;
    error.relMse += Ratio(difference * difference - variance, divisor) / n;
    sum += difference;
    sumOfReference += value;
  });
  error.bias = Ratio(sum, std::abs(sumOfReference));
  if (exposureStops != 0) {
    const float exposure = std::exp2(exposureStops);
    for (Color& color : measured.colors) color *= exposure;
    for (Color& color : truth.colors) color *= exposure;
  }
  error.flip = MeanOfMap(FlipMap(measured.colors, truth.colors, image.width, image.height));
  return error;
}

CommonError MeasureCommonError(std::span<const Image* const> images, const Image& reference) {
  const Measured truth = Measure(reference, "reference");
  std::vector<std::vector<Color>> colors;
  for (const Image* image : images) {
    CheckSameSize(*image, reference);
    colors.push_back(ReadColors(*image, "compared"));
  }
  const size_t left = images.size() < 3 ? 0 : images.size();
  const double count = static_cast<double>(images.size());
  const double n = 3.0 * static_cast<double>(truth.colors.size());
  CommonError error;
  error.without.assign(left, 0.0);
  error.varyingWithout.assign(left, 0.0);
  std::vector<double> differences(images.size());
  VisitReference(truth, [&](size_t i, size_t c, double value, double variance, double divisor) {
    double total = 0, squares = 0;
    for (size_t k = 0; k < colors.size(); ++k) {
      differences[k] = Channels(colors[k][i])[c] - value;
      total += differences[k];
      squares += differences[k] * differences[k];
    }
    const double product = (total * total - squares) / (count * (count - 1));  // mean over pairs
    error.mse += (product - variance) / n;
    error.relMse += Ratio(product - variance, divisor) / n;
    error.varying += Ratio(squares / count - product, divisor) / n;
    for (size_t k = 0; k < left; ++k) {
      const double own = differences[k], others = total - own, squaresOfOthers = squares - own * own;
      const double without = (others * others - squaresOfOthers) / ((count - 1) * (count - 2));
      error.without[k] += Ratio(without - variance, divisor) / n;
      error.varyingWithout[k] += Ratio(squaresOfOthers / (count - 1) - without, divisor) / n;
    }
  });
  return error;
}

std::vector<Color> RelativeErrorDivisors(const Image& reference) {
  const Measured truth = Measure(reference, "reference");
  std::vector<Color> roots(truth.colors.size());
  VisitReference(truth, [&](size_t i, size_t c, double, double, double divisor) {
    (c == 0 ? roots[i].r : c == 1 ? roots[i].g : roots[i].b) = static_cast<float>(std::sqrt(divisor));
  });
  return roots;
}

std::optional<ImageNoise> NoiseOf(const Image& reference, int parts) {
  const Measured truth = Measure(reference, "reference");
  if (!truth.variance) return std::nullopt;
  const double n = 3.0 * static_cast<double>(truth.colors.size());
  ImageNoise noise;
  double mean = 0, varianceOfSum = 0, deviation = 0, mseDeviation = 0, relMseDeviation = 0;
  double varianceOfMse = 0, varianceOfRelMse = 0;
  VisitReference(truth, [&](size_t, size_t c, double value, double variance, double divisor) {
    noise.mse += variance / n;
    noise.relMse += Ratio(variance, divisor) / n;
    mean += value / n;
    deviation += std::sqrt(variance);
    mseDeviation += variance;
    relMseDeviation += Ratio(variance, divisor);
    if (c < 2) return;
    varianceOfSum += deviation * deviation;
    varianceOfMse += mseDeviation * mseDeviation;
    varianceOfRelMse += relMseDeviation * relMseDeviation;
    deviation = mseDeviation = relMseDeviation = 0;
  });
  // Variance of e² - v̂ for a normal e with variance v: 2 v², plus that of v̂ from `parts` parts: 2 v²/(parts - 1).
  const double factor = 2 + 2 / std::max(1.0, static_cast<double>(parts) - 1);
  noise.mseError = std::sqrt(factor * varianceOfMse) / n;
  noise.relMseError = std::sqrt(factor * varianceOfRelMse) / n;
  noise.relativeError = Ratio(std::sqrt(noise.mse), std::abs(mean));
  noise.meanError = Ratio(std::sqrt(varianceOfSum) / n, std::abs(mean));
  return noise;
}

double MeanValue(const Image& image) {
  double sum = 0;
  const std::vector<Color> colors = ReadColors(image, "given");
  for (const Color& color : colors) {
    for (const double v : Channels(color)) sum += v;
  }
  return sum / (3.0 * static_cast<double>(colors.size()));
}

std::vector<float> RelativeErrorMap(const Image& image, const Image& reference) {
  CheckSameSize(image, reference);
  const Measured measured = Measure(image, "first"), truth = Measure(reference, "reference");
  std::vector<double> squares(truth.colors.size(), 0.0);
  VisitReference(truth, [&](size_t i, size_t c, double value, double, double divisor) {
    const double difference = Channels(measured.colors[i])[c] - value;
    squares[i] += Ratio(difference * difference, divisor) / 3;
  });
  std::vector<float> map;
  map.reserve(squares.size());
  for (const double square : squares) map.push_back(static_cast<float>(std::sqrt(square)));
  return map;
}

namespace {

bool IsBlack(const Measured& image) {
  return std::all_of(image.colors.begin(), image.colors.end(), [](const Color& color) { return color.IsBlack(); });
}

bool IsEqual(const Measured& a, const Measured& b) {
  for (size_t i = 0; i < a.colors.size(); ++i) {
    const auto va = Channels(a.colors[i]), vb = Channels(b.colors[i]);
    for (size_t c = 0; c < 3; ++c) {
      if (std::abs(va[c] - vb[c]) > RoundingOf(va[c], vb[c], a, b)) return false;
    }
  }
  return true;
}

// The reason why the block test is impossible; "" if it is possible.
std::string ReasonForSilence(const Measured& a, const Measured& b) {
  if (!a.variance || !b.variance) return "both images need variance layers";
  if (a.isDenoised || b.isDenoised)
    return "pixels of a denoised image share their noise: compare the images as they were rendered";
  if (a.isOfOneSample || b.isOfOneSample) {
    const char* which = a.isOfOneSample && b.isOfOneSample ? "both images have"
                        : a.isOfOneSample                  ? "the first image has"
                                                           : "the second image has";
    return std::string(which) + " one sample per pixel, whose variance is not known";
  }
  return "";
}

}  // namespace

const char* NameOf(Verdict verdict) {
  constexpr const char* names[] = {"equal", "agree", "differ", "cannot say"};
  return names[static_cast<int>(verdict)];
}

Image DifferenceImage(const Image& image, const Image& reference) {
  const std::vector<float> relative = RelativeErrorMap(image, reference);
  Image difference(image.width, image.height, {"R", "G", "B", "relative.Y"});
  difference.offsetX = image.offsetX;
  difference.offsetY = image.offsetY;
  difference.fullWidth = image.fullWidth;
  difference.fullHeight = image.fullHeight;
  float* out = difference.data.data();
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const Color d = image.RgbAt(x, y) - reference.RgbAt(x, y);
      for (const float value : {d.r, d.g, d.b}) *out++ = std::abs(value);
      *out++ = relative[static_cast<size_t>(y) * static_cast<size_t>(image.width) + static_cast<size_t>(x)];
    }
  }
  return difference;
}

ImageDifference CompareImages(const Image& a, const Image& b, int blockSize, double familyWiseRate) {
  CheckSameSize(a, b);
  if (blockSize < 1) throw Error("the block size must be at least 1");
  const Measured first = Measure(a, "first"), second = Measure(b, "second");
  ImageDifference difference;
  MeasureErrors(first, second, difference);
  MeasureBias(first, second, difference);
  difference.flip = MeanOfMap(FlipMap(first.colors, second.colors, a.width, a.height));
  difference.reason = ReasonForSilence(first, second);
  difference.hasBlockTest = difference.reason.empty();
  if (difference.hasBlockTest) {
    difference.blockTest = TestBlocks(first, second, a.width, a.height, blockSize, familyWiseRate);
    difference.verdict = difference.blockTest.Agrees() ? Verdict::Agree : Verdict::Differ;
  }
  if (IsBlack(first) && IsBlack(second)) {
    difference.verdict = Verdict::CannotSay;
    difference.reason = "both images are black";
  } else if (IsEqual(first, second)) {
    difference.verdict = Verdict::Equal;
    difference.reason.clear();
  }
  return difference;
}

}  // namespace lampyr
