// The bias of merging photons: its estimate from the samples of a pixel, and the bound that is part of stated errors.
//
// An estimate B of a pixel's bias has noise of its own, about twice that of the light that is merged. The square of the
// bias is therefore estimated by B² less the variance of B, which is unbiased; pixel by pixel it may be negative, and
// is then taken to be 0 in the mean over many pixels.
//
// B estimates the bias where this is proportional to the square of the radius, in regions of smooth light. At the edges
// of light and of surfaces the bias is proportional to the radius itself, and the difference of the estimates at r and
// r / √2, of which B is 2, has to be multiplied by 1 / (1 - 1 / √2). The pixels with edges are not known, so the bound
// uses this factor everywhere.
#include <algorithm>
#include <cmath>

#include "film/film.h"

namespace lampyr {

namespace {

// Square of the bound over B: 1 / (1 - 1 / √2) / 2 = 1 + 1 / √2.
constexpr double kBoundSquared = 1.70710678118654752 * 1.70710678118654752;

double LuminanceOf(const CompensatedSum (&sum)[3]) {
  double luminance = 0;
  for (int c = 0; c < 3; ++c) luminance += Color::kLuminance[c] * sum[c].Value();
  return luminance;
}

// Blurs by a binomial filter of five values along one axis of an image, which ends at its edges.
std::vector<double> BlurredAlong(const std::vector<double>& from, int width, bool isHorizontal) {
  constexpr double kWeights[5] = {1, 4, 6, 4, 1};
  const int height = static_cast<int>(from.size()) / width;
  const int size = isHorizontal ? width : height, stride = isHorizontal ? 1 : width;
  std::vector<double> to(from.size());
  for (int i = 0; i < static_cast<int>(from.size()); ++i) {
    const int at = isHorizontal ? i % width : i / width;
    double sum = 0, weight = 0;
    for (int k = std::max(-2, -at); k <= std::min(2, size - 1 - at); ++k) {
      sum += kWeights[k + 2] * from[static_cast<size_t>(i + k * stride)];
      weight += kWeights[k + 2];
    }
    to[static_cast<size_t>(i)] = sum / weight;
  }
  return to;
}

}  // namespace

void PassBias::Add(const Color& bias, float filterWeight) {
  const double w = static_cast<double>(filterWeight);
  sum[0] += w * static_cast<double>(bias.r);
  sum[1] += w * static_cast<double>(bias.g);
  sum[2] += w * static_cast<double>(bias.b);
  ++count;
}

void PixelBias::Add(const PassBias& pass) {
  weights += static_cast<double>(pass.count) * pass.count;
  // Most samples merge nothing.
  if (pass.sum[0] == 0 && pass.sum[1] == 0 && pass.sum[2] == 0) return;
  double luminance = 0;
  for (int c = 0; c < 3; ++c) {
    sum[c].Add(pass.sum[c]);
    luminance += Color::kLuminance[c] * pass.sum[c];
  }
  squares.Add(luminance * luminance);
  products.Add(pass.count * luminance);
}

void PixelBias::Add(const PixelBias& other) {
  for (int c = 0; c < 3; ++c) sum[c].Add(other.sum[c]);
  squares.Add(other.squares);
  products.Add(other.products);
  weights += other.weights;
}

void PixelBias::AddScaled(const PixelBias& other, double scale) {
  for (int c = 0; c < 3; ++c) sum[c].Add(scale * other.sum[c].Value());
  squares.Add(scale * scale * other.squares.Value());
  products.Add(scale * scale * other.products.Value());
  weights += scale * scale * other.weights;
}

bool PixelBias::IsFinite() const {
  return std::all_of(sum, sum + 3, [](const CompensatedSum& own) { return own.IsFinite(); }) && squares.IsFinite() &&
         products.IsFinite() && std::isfinite(weights);
}

double ErrorParts::Both() const {
  return std::hypot(noise, bias);
}

void Film::KeepBias() {
  bias_.resize(pixels_.size());
  if (isAdaptive_) biasStages_.resize(pixels_.size());
}

bool Film::BiasIsFinite() const {
  const auto isFinite = [](const PixelBias& sums) { return sums.IsFinite(); };
  return std::all_of(bias_.begin(), bias_.end(), isFinite) &&
         std::all_of(biasStages_.begin(), biasStages_.end(), isFinite);
}

// Normalised like CameraValue.
double Film::Bias(size_t pixel, int channel) const {
  const PixelSums& samples = pixels_[pixel];
  if (!KeepsBias()) return 0;
  const double current = bias_[pixel].sum[channel].Value(), white = WhiteScale(static_cast<size_t>(channel));
  if (endedPasses_ == 0) return samples.count > 0 ? white * current / samples.Divisor() : 0.0;
  double sum = biasStages_[pixel].sum[channel].Value();
  if (samples.count > 0) sum += passes_ * current / static_cast<double>(samples.count);
  return white * sum / AdaptiveDivisor(pixel);
}

// B² and the variance of B. The variance of the sum T of k passes, each with the sum g of c samples, where m is the
// mean of a sample, is Σ (g - c m)² / (1 - Σ c² / k²), with scaled g and c: the divisor is 1 - 1 / k if all c are
// equal.
Film::BiasMoments Film::BiasMomentsOf(size_t pixel) const {
  const PixelSums& samples = pixels_[pixel];
  const bool hasStages = endedPasses_ > 0;
  double scale = 1, passes = static_cast<double>(samples.count), divisor = samples.count > 0 ? samples.Divisor() : 1.0;
  PixelBias sums;
  if (hasStages) {
    sums = biasStages_[pixel];
    scale = samples.count > 0 ? passes_ / static_cast<double>(samples.count) : 0.0;
    passes = static_cast<double>(endedPasses_ + (samples.count > 0 ? passes_ : 0));
    divisor = AdaptiveDivisor(pixel);
  }
  sums.AddScaled(bias_[pixel], scale);
  const double freedom = 1 - sums.weights / (passes * passes);
  if (!(passes >= 2 && freedom > 0)) return {};
  const double total = LuminanceOf(sums.sum), mean = total / passes;
  const double deviations = sums.squares.Value() + mean * (mean * sums.weights - 2 * sums.products.Value());
  double white = 0;  // factor of the luminance: those of the channels are nearly equal after a few passes
  for (size_t c = 0; c < 3; ++c) white += Color::kLuminance[c] * WhiteScale(c);
  const double square = white * white / (divisor * divisor);
  return {square * total * total, square * std::max(0.0, deviations) / freedom};
}

// Upper end of the 95 % interval of the mean of squared biases, one-sided, and of the bound. B² less its variance W has
// about the variance 2 W² + 4 B² W. Pixels are taken as independent, although neighbours gather some of the same
// photons.
double Film::MeanBiasSquare() const {
  constexpr double kNinetyFive = 1.6448536269514722;
  double sum = 0, variance = 0;
  for (size_t i = 0; i < bias_.size(); ++i) {
    const BiasMoments of = BiasMomentsOf(i);
    sum += of.square - of.variance;
    variance += of.variance * (2 * of.variance + 4 * std::max(0.0, of.square - of.variance));
  }
  if (sum == 0 && variance == 0) return 0;
  const double upper = sum + kNinetyFive * std::sqrt(variance);
  return kBoundSquared * std::max(0.0, upper) / static_cast<double>(bias_.size());
}

std::vector<double> Film::BiasSquares() const {
  std::vector<double> squares(bias_.size());
  if (squares.empty()) return squares;
  for (size_t i = 0; i < squares.size(); ++i) {
    const BiasMoments of = BiasMomentsOf(i);
    squares[i] = of.square - of.variance;
  }
  squares = BlurredAlong(BlurredAlong(squares, crop_.Width(), true), crop_.Width(), false);
  for (double& square : squares) square = kBoundSquared * std::max(0.0, square);
  return squares;
}

}  // namespace lampyr
