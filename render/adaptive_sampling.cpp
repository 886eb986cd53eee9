#include "render/adaptive_sampling.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "math/vec.h"
#include "sampling/rng.h"

namespace lampyr {

namespace {

constexpr uint64_t kOfStage = 0x3c6ef372fe94f82b;  // changes the seed from stage to stage
constexpr double kDark = 0.01;  // of the mean luminance: darker pixels count as that (Film::PixelErrors)
constexpr double kOwnPasses = 32;                  // at which a pixel counts as much as its neighbourhood
// Rates. The lower limit is for pixels whose noise has not shown yet, the upper for fireflies.
constexpr double kLeastRate = 0.25, kMostRate = 32;

// What decides how many samples a pixel should have, relative to its squared luminance.
struct PixelNeed {
  double ofSample = 0;  // variance of a sample
  double before = 0;    // variance of the picture per `ofSample`, as far as it comes from earlier stages
  double splats = 0;    // variance of the splats when the stage ends
};

// Blurs by a binomial filter of 5 x 5 pixels.
std::vector<double> Blurred(const std::vector<double>& values, int width, int height) {
  constexpr double kWeights[5] = {1, 4, 6, 4, 1};
  const auto along = [&](const std::vector<double>& from, bool isHorizontal) {
    std::vector<double> to(from.size());
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        double sum = 0, weight = 0;
        for (int k = -2; k <= 2; ++k) {
          const int i = isHorizontal ? x + k : x, j = isHorizontal ? y : y + k;
          if (i < 0 || i >= width || j < 0 || j >= height) continue;
          sum += kWeights[k + 2] * from[static_cast<size_t>(j) * static_cast<size_t>(width) + static_cast<size_t>(i)];
          weight += kWeights[k + 2];
        }
        to[static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x)] = sum / weight;
      }
    }
    return to;
  };
  return along(along(values, true), false);
}

std::vector<PixelNeed> NeedsOf(const Film& film, const SampleStage& stage) {
  const size_t pixels = film.Pixels();
  const int width = film.Crop().Width(), height = film.Crop().Height();
  std::vector<double> luminance(pixels), variance(pixels), splats(pixels);
  double mean = 0;
  for (size_t i = 0; i < pixels; ++i) {
    const Film::PixelStatistics statistics = film.StatisticsOf(i);
    luminance[i] = std::max(statistics.luminance, 0.0);
    variance[i] = statistics.sampleVariance;
    splats[i] = statistics.splatVariance;
    mean += luminance[i] / static_cast<double>(pixels);
  }
  // Of few samples the mean of a neighbourhood is known better than that of a pixel.
  const auto before = static_cast<double>(film.EndedPasses());
  const double own = before / (before + kOwnPasses);
  for (std::vector<double>* values : {&luminance, &variance}) {
    const std::vector<double> blurred = Blurred(*values, width, height);
    for (size_t i = 0; i < pixels; ++i) (*values)[i] = own * (*values)[i] + (1 - own) * blurred[i];
  }
  const double all = before + stage.passes;
  std::vector<PixelNeed> needs(pixels);
  for (size_t i = 0; i < pixels; ++i) {
    const double square = std::pow(std::max(luminance[i], kDark * mean), 2);
    if (!(square > 0)) continue;
    needs[i].ofSample = variance[i] / square;
    needs[i].before = film.Stages(i).independent / (all * all);
    needs[i].splats = splats[i] / square * before / all;
  }
  return needs;
}

// Samples with which the relative variance of a pixel after the stage is `target`.
double SamplesFor(const PixelNeed& need, double target, double stageShare, double least, double most) {
  if (!(need.ofSample > 0)) return least;
  // Where splats alone have more variance than the target, half of theirs is little enough.
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
  const double scale = all / sumFor(std::exp2(high));
  for (double& own : samples) own *= scale;
  return samples;
}

SampleAllocation::SampleAllocation(const SampleStage& stage, const Film& film, const AdaptiveSettings& settings)
    : stage_(stage), pixels_(film.Pixels()) {
  // The first pass has a sample in each pixel; the others have the rest.
  const std::vector<double> wanted = WantedSamples(film, stage, settings);
  double sum = 0;
  for (const double own : wanted) sum += std::max(own - 1, 0.0);
  if (!(sum > 0)) return;
  ends_.resize(pixels_);
  double end = 0;
  for (size_t i = 0; i < pixels_; ++i) {
    end += std::max(wanted[i] - 1, 0.0) / sum * static_cast<double>(pixels_);
    ends_[i] = end;
  }
  ends_.back() = static_cast<double>(pixels_);
}

uint64_t SampleAllocation::End(size_t pixel, uint32_t pass) const {
  if (pixel + 1 == pixels_) return pixels_;
  // Multiples of the golden ratio: over passes, too, the samples of a pixel are near its rate.
  const double sum = static_cast<double>(MixBits(stage_.seed) >> 11) * 0x1p-53 + 0.6180339887498949 * pass;
  const double shift = sum - std::floor(sum);
  return static_cast<uint64_t>(std::min(std::floor(ends_[pixel] + shift), static_cast<double>(pixels_)));
}

size_t SampleAllocation::PixelOf(uint64_t slot, uint32_t pass) const {
  if (ends_.empty() || pass == 0) return slot;
  size_t low = 0, high = pixels_ - 1;
  while (low < high) {
    const size_t middle = (low + high) / 2;
    if (End(middle, pass) > slot) {
      high = middle;
    } else {
      low = middle + 1;
    }
  }
  return low;
}

}  // namespace lampyr
