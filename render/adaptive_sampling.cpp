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

// Variances of a pixel, relative to its squared luminance, that its number of samples follows from.
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

struct SampleNoise {
  std::vector<double> variances, trusts;
};

// Relative variance of a sample of every pixel: the variance of the samples near it, or that of a wider neighbourhood
// if that is larger. Where one sample in a thousand finds a light, most pixels have not met it yet.
//
// Trust in it, from 0 to 1, grows with the number of large samples within kPixels that make it up. Few bright samples
// tell only where they happened to fall.
SampleNoise NoiseOf(PixelGrid squares, PixelGrid fourths, PixelGrid counts) {
  constexpr int kNear = 1, kTrusted = 3, kFar = 4;                               // blurs
  constexpr double kEnough = 48, kPixels = 4 * std::numbers::pi * (1 + 4 + 16);  // under kTrusted blurs
  const size_t pixels = squares.values.size();
  SampleNoise noise{std::vector<double>(pixels, 0), std::vector<double>(pixels, 1)};
  for (int blurs = 1; blurs <= kFar; ++blurs) {
    const int step = 1 << (blurs - 1);
    squares = Blurred(squares, step);
    counts = Blurred(counts, step);
    if (blurs <= kTrusted) fourths = Blurred(fourths, step);
    for (size_t i = 0; i < pixels; ++i) {
      const double square = squares.values[i];
      if (blurs == kNear || blurs == kFar)
        noise.variances[i] = std::max(noise.variances[i], square / std::max(counts.values[i] - 1, 1.0));
      if (blurs != kTrusted || !(fourths.values[i] > 0)) continue;
      const double large = kPixels * square * square / fourths.values[i];
      noise.trusts[i] = large / (large + kEnough);
    }
  }
  return noise;
}

std::vector<PixelNeed> NeedsOf(const Film& film, const SampleStage& stage) {
  const size_t pixels = film.Pixels();
  const PixelGrid empty{film.Crop().Width(), film.Crop().Height(), std::vector<double>(pixels)};
  PixelGrid luminance = empty, squares = empty, fourths = empty, counts = empty, splats = empty;
  double mean = 0;
  for (size_t i = 0; i < pixels; ++i) {
    const Film::PixelStatistics statistics = film.StatisticsOf(i);
    luminance.values[i] = std::max(statistics.luminance, 0.0);
    squares.values[i] = statistics.squares;
    fourths.values[i] = statistics.fourths;
    counts.values[i] = static_cast<double>(film.Stages(i).count);
    splats.values[i] = statistics.splatVariance;
    mean += luminance.values[i] / static_cast<double>(pixels);
  }
  luminance = Blurred(luminance, 1);
  for (size_t i = 0; i < pixels; ++i) {
    const double square = std::pow(std::max(luminance.values[i], kDark * mean), 2);
    squares.values[i] = square > 0 ? squares.values[i] / square : 0;
    fourths.values[i] = square > 0 ? fourths.values[i] / (square * square) : 0;
    splats.values[i] = square > 0 ? splats.values[i] / square : 0;
  }
  splats = Blurred(splats, 1);
  const auto [variances, trusts] = NoiseOf(std::move(squares), std::move(fourths), std::move(counts));
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
  // Splats may have more variance than the target by themselves, which no camera sample changes. Half of theirs is then
  // enough for the camera samples.
  const double ofCamera = std::max(target - need.splats, 0.5 * need.splats);
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
  // The lowest target that the samples of the stage suffice for. Beyond the share no pixel is given more than those in
  // it.
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
}

// A multiple of a number near the golden section of `passes - 1` and prime to it: passes in a row are far apart.
uint64_t SampleAllocation::Shift(uint32_t pass) const {
  const uint64_t passes = stage_.passes - 1;
  auto step = static_cast<uint64_t>(0.6180339887498949 * static_cast<double>(passes) + 0.5);
  while (std::gcd(step, passes) != 1) ++step;
  return (MixBits(stage_.seed) % passes + (pass - 1) % passes * step) % passes;
}

size_t SampleAllocation::PixelOf(uint64_t slot, uint32_t pass) const {
  if (ends_.empty() || pass == 0) return slot;
  size_t low = 0, high = pixels_ - 1;
  while (low < high) {
    const size_t middle = (low + high) / 2;
    if (Before(middle + 1, pass) > slot) {
      high = middle;
    } else {
      low = middle + 1;
    }
  }
  return low;
}

}  // namespace lampyr
