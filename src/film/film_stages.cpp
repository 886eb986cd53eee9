// Adaptive films: pixels that differ in their numbers of samples.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/error.h"
#include "film/film.h"

namespace lampyr {

namespace {

constexpr double kNinetyFive = 1.959963984540054;  // standard errors in half a 95 % interval

bool AllFinite(const double* values, size_t count) {
  return std::all_of(values, values + count, [](double value) { return std::isfinite(value); });
}

// Number of samples of the half layer among n of an adaptive pixel: every second one.
uint64_t HalfOf(uint64_t n) {
  return (n + 1) / 2;
}

}  // namespace

bool PixelStages::IsFinite() const {
  return AllFinite(sum, 3) && std::isfinite(weight) && AllFinite(valueSum, 3) && AllFinite(squareSum, 3) &&
         std::isfinite(fourthSum) && std::isfinite(independent) && std::isfinite(shared) &&
         std::isfinite(sumOfFourths) && std::isfinite(splatLuminance) && std::isfinite(splatVariance);
}

void PixelGroups::Add(const PixelSums& pass) {
  squares += pass.count * pass.count;
  if (pass.count < 2) return;
  freedom += pass.count - 1;
  for (int c = 0; c < 3; ++c) {
    const double sum = pass.sum[c].Value();
    within[c] += std::max(0.0, pass.sumOfSquares[c].Value() - sum * sum / static_cast<double>(pass.count));
  }
}

bool PixelGroups::IsFinite() const {
  return AllFinite(within, 3);
}

void Film::MakeAdaptive(bool hasGroups) {
  isAdaptive_ = true;
  stages_.resize(pixels_.size());
  layerStages_.resize(layerSums_.size(), {0, 0, 0});
  biasStages_.resize(bias_.size());
  if (hasGroups) groups_.resize(pixels_.size());
}

void Film::EndStage() {
  const auto passes = static_cast<double>(passes_);
  for (size_t i = 0; i < pixels_.size(); ++i) {
    PixelSums& ended = pixels_[i];
    PixelStages& stages = stages_[i];
    for (size_t layer = 0; layer < layers_.size(); ++layer) {
      const size_t index = i * layers_.size() + layer;
      for (size_t c = 0; c < 3; ++c) layerStages_[index][c] += passes * CurrentLayerMean(i, layer, c);
      layerSums_[index] = LayerSum();
    }
    if (ended.count == 0) continue;
    const double scale = passes / static_cast<double>(ended.count);
    if (KeepsBias()) {
      biasStages_[i].AddScaled(bias_[i], scale);
      bias_[i] = PixelBias();
    }
    for (int c = 0; c < 3; ++c) {
      stages.sum[c] += scale * ended.sum[c].Value();
      stages.valueSum[c] += ended.sum[c].Value();
      stages.squareSum[c] += ended.sumOfSquares[c].Value();
    }
    stages.weight += scale * ended.weight.Value();
    stages.independent += scale * scale * static_cast<double>(ended.count);
    if (HasGroups()) {
      stages.shared += scale * scale * static_cast<double>(groups_[i].squares);
      groups_[i].squares = 0;
    }
    stages.sumOfFourths += std::pow(scale, 4) * ended.sumOfFourths;
    stages.fourthSum += ended.sumOfFourths;
    stages.count += ended.count;
    ended = PixelSums();
    NoteSplats(i);
  }
  endedPasses_ += passes_;
  passes_ = 0;
}

// Σ N Σw / n over all stages, or Σ N where negative weights cancel that (PixelSums::Divisor).
double Film::AdaptiveDivisor(size_t pixel) const {
  const PixelSums& current = pixels_[pixel];
  const double passes = endedPasses_ == 0 ? 1 : passes_;
  const double all = static_cast<double>(endedPasses_) + passes;
  double weight = stages_[pixel].weight;
  if (current.count > 0) weight += passes * current.weight.Value() / static_cast<double>(current.count);
  return weight > 0.1 * all ? weight : all;
}

// Σ over the samples of a layer in the current stage, by their number.
double Film::CurrentLayerMean(size_t pixel, size_t layer, size_t channel) const {
  if (pixels_[pixel].count == 0) return 0;
  if (hasHalf_ && layer + 1 == layers_.size()) return CurrentHalf(pixel, channel);
  return layerSums_[pixel * layers_.size() + layer][channel].Value() / static_cast<double>(pixels_[pixel].count);
}

// Half of an estimate of the pixel that is uncorrelated with the rest of the pixel and has the same variance. With as
// many even samples (mean E) as odd ones (mean O) the estimate is E; otherwise a E + (1 - a) O, with a² / e + (1 - a)²
// / o = 2 / n.
double Film::CurrentHalf(size_t pixel, size_t channel) const {
  const PixelSums& samples = pixels_[pixel];
  const auto n = static_cast<double>(samples.count), e = static_cast<double>(HalfOf(samples.count)), o = n - e;
  const double all = samples.sum[channel].Value(), even = layerSums_[(pixel + 1) * layers_.size() - 1][channel].Value();
  if (!(o > 0)) return 0.5 * all / n;
  const double both = 1 / e + 1 / o;
  const double a = (1 / o + std::sqrt(1 / (o * o) - both * (1 / o - 2 / n))) / both;
  return 0.5 * (a * even / e + (1 - a) * (all - even) / o);
}

// Factor that scales the splats of the half layer to half of all splats.
double Film::HalfShareOfSplats() const {
  return halfPaths_ == 0 ? 1 : 0.5 * static_cast<double>(lightPaths_) / static_cast<double>(halfPaths_);
}

// Variance of CameraValue. All samples of a pixel have the same variance, whatever their stage: for a stage with one
// sample it is estimated from the others.
double Film::CameraVariance(size_t pixel, int channel) const {
  const PixelSums& current = pixels_[pixel];
  const PixelStages& stages = stages_[pixel];
  const auto n = static_cast<double>(stages.count + current.count);
  if (n < 2) return 0;
  const double mean = (stages.valueSum[channel] + current.sum[channel].Value()) / n;
  const double square = (stages.squareSum[channel] + current.sumOfSquares[channel].Value()) / n;
  const double ofSample = std::max(0.0, square - mean * mean) * n / (n - 1);
  const double passes = endedPasses_ == 0 ? 1 : static_cast<double>(passes_);
  const double scale = current.count > 0 ? passes / static_cast<double>(current.count) : 0;
  const double all = AdaptiveDivisor(pixel);
  const double independent = stages.independent + scale * scale * static_cast<double>(current.count);
  if (!HasGroups() || groups_[pixel].freedom == 0) return ofSample * independent / (all * all);
  const PixelGroups& groups = groups_[pixel];
  const double within = std::min(ofSample, groups.within[channel] / static_cast<double>(groups.freedom));
  const double shared = stages.shared + scale * scale * static_cast<double>(groups.squares);
  return (within * independent + (ofSample - within) * shared) / (all * all);
}

double Film::CameraFourth(size_t pixel) const {
  const PixelSums& current = pixels_[pixel];
  const double passes = endedPasses_ == 0 ? 1 : static_cast<double>(passes_);
  double fourth = stages_[pixel].sumOfFourths;
  if (current.count > 0) fourth += current.sumOfFourths * std::pow(passes / static_cast<double>(current.count), 4);
  return fourth / std::pow(AdaptiveDivisor(pixel), 4);
}

Film::PixelStatistics Film::StatisticsOf(size_t pixel) const {
  const PixelStages& stages = stages_[pixel];
  const auto n = static_cast<double>(stages.count);
  PixelStatistics statistics;
  const auto all = static_cast<double>(endedPasses_);
  const double divisor = stages.weight > 0.1 * all ? stages.weight : all;
  double deviation = 0;
  for (int c = 0; c < 3; ++c) {
    const double weight = Color::kLuminance[c], mean = stages.valueSum[c] / n;
    statistics.luminance += weight * stages.sum[c] / divisor;
    deviation += weight * std::sqrt(std::max(0.0, stages.squareSum[c] - n * mean * mean));
  }
  statistics.luminance += stages.splatLuminance;
  statistics.squares = std::pow(deviation * all / divisor, 2);
  statistics.fourths = stages.fourthSum * std::pow(all / divisor, 4);
  statistics.splatVariance = stages.splatVariance;
  return statistics;
}

// Splats continue in the next stage, whose sampling rates depend on the splats up to here alone.
void Film::NoteSplats(size_t pixel) {
  if (lightPaths_ < 2) return;
  const auto paths = static_cast<double>(lightPaths_);
  double luminance = 0, deviation = 0;
  for (int c = 0; c < 3; ++c) {
    const double mean = splats_[pixel].Sum(c) / paths;
    luminance += Color::kLuminance[c] * mean;
    deviation += Color::kLuminance[c] *
                 std::sqrt(std::max(0.0, splats_[pixel].SumOfSquares(c) / paths - mean * mean) / (paths - 1));
  }
  stages_[pixel].splatLuminance = luminance;
  stages_[pixel].splatVariance = deviation * deviation;
}

void Film::AddStages(const Film& other) {
  for (size_t i = 0; i < stages_.size(); ++i) {
    PixelStages& to = stages_[i];
    const PixelStages& from = other.stages_[i];
    for (int c = 0; c < 3; ++c) {
      to.sum[c] += from.sum[c];
      to.valueSum[c] += from.valueSum[c];
      to.squareSum[c] += from.squareSum[c];
    }
    to.weight += from.weight;
    to.independent += from.independent;
    to.shared += from.shared;
    to.sumOfFourths += from.sumOfFourths;
    to.fourthSum += from.fourthSum;
    to.count += from.count;
  }
  for (size_t i = 0; i < groups_.size(); ++i) {
    for (int c = 0; c < 3; ++c) groups_[i].within[c] += other.groups_[i].within[c];
    groups_[i].freedom += other.groups_[i].freedom;
  }
  for (size_t i = 0; i < layerStages_.size(); ++i) {
    for (size_t c = 0; c < 3; ++c) layerStages_[i][c] += other.layerStages_[i][c];
  }
  endedPasses_ += other.endedPasses_;
}

// Throws an Error for numbers that no render produces.
void Film::CheckStages() const {
  constexpr uint64_t kMost = uint64_t{1} << 30;
  bool isSound = endedPasses_ <= kMost && passes_ <= kMost;
  for (size_t i = 0; i < pixels_.size() && isSound; ++i) {
    isSound = (endedPasses_ == 0) == (stages_[i].count == 0) && (passes_ == 0) == (pixels_[i].count == 0);
  }
  if (!isSound) throw Error("it holds a number out of range");
}

bool Film::StagesAreFinite() const {
  return std::all_of(stages_.begin(), stages_.end(), [](const PixelStages& s) { return s.IsFinite(); }) &&
         std::all_of(groups_.begin(), groups_.end(), [](const PixelGroups& g) { return g.IsFinite(); }) &&
         std::all_of(layerStages_.begin(), layerStages_.end(), [](const auto& sum) { return AllFinite(&sum[0], 3); });
}

std::vector<float> Film::PixelErrors(double imageError) const {
  constexpr double kDark = 0.01, kKnown = 1;
  std::vector<double> luminances(pixels_.size(), 0), deviations(pixels_.size(), 0);
  const std::vector<double> biases = BiasSquares();
  double all = 0;
  for (size_t i = 0; i < pixels_.size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      luminances[i] += Color::kLuminance[c] * Value(i, c);
      deviations[i] += Color::kLuminance[c] * std::sqrt(VarianceOfMean(i, c));
    }
    all += luminances[i];
  }
  const double least = kDark * std::max(all, 0.0) / static_cast<double>(pixels_.size());
  std::vector<float> errors(pixels_.size());
  for (size_t i = 0; i < pixels_.size(); ++i) {
    const bool tooFew = Samples(i) == 1 || (Samples(i) == 0 && lightPaths_ < 2);
    const double luminance = std::max(luminances[i], least);
    double error = std::numeric_limits<double>::infinity();
    double half = kNinetyFive * deviations[i];
    if (!biases.empty()) half = std::hypot(half, std::sqrt(biases[i]));
    // While the error of the picture is large, pixels that are still black may yet be lit.
    const bool mayBeLit = half == 0 && luminances[i] <= 0 && !(imageError <= kKnown);
    if (!tooFew && !mayBeLit) error = half == 0 ? 0 : half / luminance;
    errors[i] = static_cast<float>(error);
  }
  return errors;
}

}  // namespace lampyr
