#include "render/adaptive_sampling.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <utility>

#include "base/stop.h"
#include "math/vec.h"
#include "sampling/rng.h"

namespace lampyr {

namespace {

constexpr uint64_t kOfStage = 0x3c6ef372fe94f82b;  // changes the seed from stage to stage
constexpr double kDark = 0.01;  // of the mean luminance: darker pixels count as that (Film::PixelErrors)
constexpr double kTiny = std::numeric_limits<double>::min();
// Rates. The lower limit is for pixels whose noise has not shown yet, the upper for fireflies.
constexpr double kLeastRate = 0.5, kMostRate = 32;

// Variances of a pixel, relative to its squared luminance, that determine its number of samples.
struct PixelNeed {
  double ofSample = 0;  // variance of a sample
  double before = 0;    // variance of the picture per `ofSample`, as far as it comes from earlier stages
  double splats = 0;    // variance of the splats when the stage ends
  double trust = 1;     // 1: `ofSample` is known, or small; 0: it may be anything
};

struct PixelGrid {
  int width, height;
  std::vector<double> values;
};

// Blurs by a binomial filter of five values, `step` pixels apart, along one axis.
PixelGrid BlurredAlong(const PixelGrid& from, bool isHorizontal, int step) {
  constexpr double kWeights[5] = {1, 4, 6, 4, 1};
  const int size = isHorizontal ? from.width : from.height, stride = isHorizontal ? 1 : from.width;
  PixelGrid to = from;
  for (int i = 0; i < static_cast<int>(from.values.size()); ++i) {
    const int at = isHorizontal ? i % from.width : i / from.width;
    double sum = 0, weight = 0;
    for (int k = -2; k <= 2; ++k) {
      if (at + k * step < 0 || at + k * step >= size) continue;
      sum += kWeights[k + 2] * from.values[static_cast<size_t>(i + k * step * stride)];
      weight += kWeights[k + 2];
    }
    to.values[static_cast<size_t>(i)] = sum / weight;
  }
  return to;
}
PixelGrid Blurred(const PixelGrid& from, int step) {
  CheckStop();
  return BlurredAlong(BlurredAlong(from, true, step), false, step);
}

// Sums over the samples of every pixel.
struct SampleSums {
  PixelGrid squares, fourths, counts;

  // Variance of a sample.
  double Variance(size_t pixel) const { return squares.values[pixel] / std::max(counts.values[pixel] - 1, 1.0); }
  // The number of large samples in a pixel that its squares would come from if all of these were equal.
  double Large(size_t pixel) const {
    const double square = squares.values[pixel];
    return fourths.values[pixel] > 0 ? square * square / fourths.values[pixel] : 0;
  }
  void Blur(int step) {
    for (PixelGrid* grid : {&squares, &fourths, &counts}) *grid = Blurred(*grid, step);
  }
};

// Limits the variance of a pixel by that of its neighbourhood, estimated from the mean of standard deviations. A few
// bright samples do not predict where the next one will fall; with a mean of variances, a single one of them would
// attract samples to hundreds of pixels.
void LimitOutliers(SampleSums& sums) {
  constexpr double kMost = 4;
  constexpr int kBlurs = 3;
  PixelGrid deviations = sums.squares;
  for (size_t i = 0; i < deviations.values.size(); ++i) deviations.values[i] = std::sqrt(sums.Variance(i));
  for (int blurs = 0; blurs < kBlurs; ++blurs) deviations = Blurred(deviations, 1 << blurs);
  for (size_t i = 0; i < deviations.values.size(); ++i) {
    const double limit = kMost * deviations.values[i] * deviations.values[i], variance = sums.Variance(i);
    if (!(variance > limit)) continue;
    const double share = limit / variance;
    sums.squares.values[i] *= share;
    sums.fourths.values[i] *= share * share;
  }
}

struct SampleNoise {
  std::vector<double> variances, trusts;
};

// Relative variance of a sample of every pixel, from the samples near it. Edges are a pixel wide: the samples of the
// pixel itself count, as far as they are enough to tell that it is noisier. Where one sample in a thousand finds a
// light, most pixels have not met it yet: the variance of a wider neighbourhood counts, as far as the samples near the
// pixel may have missed what makes it up.
//
// Trust in it, from 0 to 1, grows with the number of large samples around the pixel that make it up.
SampleNoise NoiseOf(SampleSums sums) {
  constexpr int kTrusted = 3, kFar = 4;                                          // blurs
  constexpr double kEnough = 48, kPixels = 4 * std::numbers::pi * (1 + 4 + 16);  // under kTrusted blurs
  constexpr double kOwn = 8;                                                     // large samples in a pixel
  constexpr double kMissed = 1, kNearPixels = 4 * std::numbers::pi;              // large samples under one blur
  const size_t pixels = sums.squares.values.size();
  SampleNoise noise{std::vector<double>(pixels, 0), std::vector<double>(pixels, 1)};
  LimitOutliers(sums);
  const SampleSums own = sums;
  sums.Blur(1);
  for (size_t i = 0; i < pixels; ++i) {
    const double near = sums.Variance(i), large = own.Large(i);
    noise.variances[i] = near + std::max(own.Variance(i) - near, 0.0) * large / (large + kOwn);
  }
  for (int blurs = 2; blurs <= kFar; ++blurs) {
    sums.Blur(1 << (blurs - 1));
    for (size_t i = 0; i < pixels; ++i) {
      const double large = sums.Large(i), missed = kMissed / (kMissed + kNearPixels * large);
      noise.variances[i] += std::max(sums.Variance(i) - noise.variances[i], 0.0) * missed;
      if (blurs == kTrusted && large > 0) noise.trusts[i] = kPixels * large / (kPixels * large + kEnough);
    }
  }
  return noise;
}

// Brings the luminance of each pixel nearer to the mean of those around it, the more the less their difference exceeds
// the pixel's own error.
void ReduceNoise(PixelGrid& luminance, const SampleSums& sums, const PixelGrid& splats) {
  const PixelGrid near = Blurred(luminance, 1);
  for (size_t i = 0; i < luminance.values.size(); ++i) {
    const double count = std::max(sums.counts.values[i], 2.0), difference = near.values[i] - luminance.values[i];
    const double variance = sums.squares.values[i] / (count * (count - 1)) + splats.values[i];
    if (variance > 0) luminance.values[i] += difference * variance / (variance + difference * difference);
  }
}

std::vector<PixelNeed> NeedsOf(const Film& film, const SampleStage& stage) {
  const size_t pixels = film.Pixels();
  const PixelGrid empty{film.Crop().Width(), film.Crop().Height(), std::vector<double>(pixels)};
  PixelGrid luminance = empty, splats = empty;
  SampleSums sums{empty, empty, empty};
  double mean = 0;
  for (size_t i = 0; i < pixels; ++i) {
    const Film::PixelStatistics statistics = film.StatisticsOf(i);
    luminance.values[i] = std::max(statistics.luminance, 0.0);
    sums.squares.values[i] = statistics.squares;
    sums.fourths.values[i] = statistics.fourths;
    sums.counts.values[i] = static_cast<double>(film.Stages(i).count);
    splats.values[i] = statistics.splatVariance;
    mean += luminance.values[i] / static_cast<double>(pixels);
  }
  ReduceNoise(luminance, sums, splats);
  for (size_t i = 0; i < pixels; ++i) {
    const double square = std::pow(std::max(luminance.values[i], kDark * mean), 2);
    const double scale = square > 0 ? 1 / square : 0;
    sums.squares.values[i] *= scale;
    sums.fourths.values[i] *= scale * scale;
    splats.values[i] *= scale;
  }
  splats = Blurred(splats, 1);
  const auto [variances, trusts] = NoiseOf(std::move(sums));
  const auto before = static_cast<double>(film.EndedPasses());
  const double all = before + stage.passes;
  std::vector<PixelNeed> needs(pixels);
  double root = 0;
  for (const double variance : variances) root += std::sqrt(variance) / static_cast<double>(pixels);
  for (size_t i = 0; i < pixels; ++i) {
    needs[i].ofSample = variances[i];
    needs[i].trust = 1 - (1 - trusts[i]) * variances[i] / std::max(variances[i] + root * root, kTiny);
    needs[i].before = film.Stages(i).independent / (all * all);
    needs[i].splats = splats.values[i] * before / all;
  }
  return needs;
}

// Samples with which the relative variance of a pixel after the stage is `target`.
double SamplesFor(const PixelNeed& need, double target, double stageShare, double least, double most) {
  if (!(need.ofSample > 0)) return least;
  // Splats may have more variance than the target by themselves, which no camera sample changes. A small part of theirs
  // is then enough for the camera samples.
  constexpr double kBelowSplats = 0.1;
  const double ofCamera = std::max(target - need.splats, kBelowSplats * need.splats);
  const double room = ofCamera / need.ofSample - need.before;
  if (!(room > 0)) return most;
  return std::clamp(stageShare * stageShare / room, least, most);
}

}  // namespace

SampleStage StageOf(uint32_t pass, uint32_t offset, uint64_t seed) {
  SampleStage stage;
  stage.before = pass < kFirstStage ? 0 : std::bit_floor(pass);
  stage.passes = pass < kFirstStage ? kFirstStage : stage.before;
  stage.first = offset + stage.before;
  stage.seed = stage.first == 0 ? seed : MixBits(seed + kOfStage * (uint64_t{stage.first} + 1));
  return stage;
}

std::vector<double> WantedSamples(const Film& film, const SampleStage& stage, const AdaptiveSettings& settings) {
  const std::vector<PixelNeed> needs = NeedsOf(film, stage);
  const auto pixels = static_cast<double>(needs.size());
  const double passes = stage.passes, stageShare = passes / (static_cast<double>(film.EndedPasses()) + passes);
  const double least = kLeastRate * passes, most = kMostRate * passes, all = passes * pixels;
  const auto rank = static_cast<size_t>(std::clamp(settings.share * pixels, 1.0, pixels)) - 1;
  std::vector<double> samples(needs.size()), sorted;
  // The lowest target that the samples of the stage suffice for. Pixels outside of the share get no more samples than
  // the noisiest pixel in it.
  const auto sumFor = [&](double target) {
    CheckStop();
    for (size_t i = 0; i < needs.size(); ++i) samples[i] = SamplesFor(needs[i], target, stageShare, least, most);
    sorted = samples;
    std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(rank), sorted.end());
    const double limit = sorted[rank];
    double sum = 0;
    for (double& own : samples) sum += own = std::min(own, limit);
    return sum;
  };
  double low = -60, high = 60;  // of log₂ of the target
  constexpr int kSteps = 20;
  for (int step = 0; step < kSteps; ++step) {
    const double middle = 0.5 * (low + high);
    (sumFor(std::exp2(middle)) > all ? low : high) = middle;
  }
  sumFor(std::exp2(high));
  double sum = 0;
  for (size_t i = 0; i < samples.size(); ++i)
    sum += samples[i] = needs[i].trust * samples[i] + (1 - needs[i].trust) * passes;
  for (double& own : samples) own *= all / sum;
  return samples;
}

SampleAllocation::SampleAllocation(const SampleStage& stage, const Film& film, const AdaptiveSettings& settings)
    : stage_(stage), pixels_(film.Pixels()) {
  // The first pass has a sample in each pixel; the others have the rest.
  const std::vector<double> wanted = WantedSamples(film, stage, settings);
  double sum = 0;
  for (const double own : wanted) sum += std::max(own - 1, 0.0);
  if (!(sum > 0) || !std::isfinite(sum)) return;
  const uint64_t all = uint64_t{stage.passes - 1} * pixels_;
  ends_.resize(pixels_);
  double end = 0;
  for (size_t i = 0; i < pixels_; ++i) {
    end += std::max(wanted[i] - 1, 0.0) / sum * static_cast<double>(all);
    ends_[i] = std::min(static_cast<uint64_t>(end + 0.5), all);
  }
  ends_.back() = all;
  const uint64_t others = stage_.passes - 1;
  firstShift_ = MixBits(stage_.seed) % others;
  shiftStep_ = static_cast<uint64_t>(0.6180339887498949 * static_cast<double>(others) + 0.5);
  while (std::gcd(shiftStep_, others) != 1) ++shiftStep_;
}

// A multiple of a number near the golden section of `passes - 1` and prime to it: passes in a row are far apart.
uint64_t SampleAllocation::Shift(uint32_t pass) const {
  const uint64_t passes = stage_.passes - 1;
  return (firstShift_ + (pass - 1) % passes * shiftStep_) % passes;
}

size_t SampleAllocation::PixelOf(uint64_t slot, uint32_t pass) const {
  if (ends_.empty() || pass == 0) return slot;
  // The first pixel with Before(pixel + 1, pass) > slot: (end + shift) / passes > slot.
  const uint64_t shifted = (slot + 1) * (uint64_t{stage_.passes} - 1), shift = Shift(pass);
  const uint64_t end = shifted > shift ? shifted - shift : 0;
  return static_cast<size_t>(std::lower_bound(ends_.begin(), ends_.end() - 1, end) - ends_.begin());
}

}  // namespace lampyr
