#include "render/analysis/sppm_candidate.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <utility>

#include "integrators/registry.h"
#include "render/analysis/pilot_passes.h"

namespace lampyr::pilot {

namespace {

constexpr const char* kName = "sppm";
constexpr int kFewestPairs = 4;  // of passes
// No more than two pairs where its error in equal time is larger than that of the best by the first factor, and a
// single one where it is by the second.
constexpr double kHopeless = 2, kQuiteHopeless = 6;
// Blur takes some light from edges, so that less than this is not told from it.
constexpr double kTolerated = 0.03;

double Squared(double x) {
  return x * x;
}

double Sum(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

// Errors and means of pairs of passes.
class Measured {
 public:
  explicit Measured(const Records& records) : records_(records) {}

  // Results of a pass, by pixel: light that is not seen directly, and the estimate of its bias.
  struct Found {
    std::vector<double> light, bias;
  };
  // Adds two passes.
  void Add(const Found& firstPass, const Found& secondPass) {
    const std::vector<double>&first = firstPass.light, &second = secondPass.light;
    std::vector<double>& errors = pairs_.emplace_back(first.size());
    double biasOfPair = 0;
    for (size_t i = 0; i < first.size(); ++i) {
      errors[i] = 0.5 * Squared(first[i] - second[i]) * records_.WeightOf(i);
      biasOfPair += firstPass.bias[i] * secondPass.bias[i] * records_.WeightOf(i);
    }
    squaredBiases_.push_back(biasOfPair);
    const double pixels = static_cast<double>(first.size()), a = Sum(first) / pixels, b = Sum(second) / pixels;
    sum_ += 0.5 * (a + b);
    squares_ += 0.25 * Squared(a - b);
  }
  // Adds light that is seen itself, which is noisy at the edges of what emits it. Where the other passes of the pilot
  // have not met it, the brightness of the pixel is that of these passes.
  void AddSeen(const std::vector<std::vector<double>>& passes) {
    for (size_t i = 0; i < passes[0].size(); ++i) {
      double mean = 0;
      for (const std::vector<double>& pass : passes) mean += pass[i] / static_cast<double>(passes.size());
      const double weight = std::min(records_.WeightOf(i), records_.WeightAt(mean));
      for (size_t pair = 0; pair < pairs_.size(); ++pair)
        pairs_[pair][i] += 0.5 * Squared(passes[2 * pair][i] - passes[2 * pair + 1][i]) * weight;
    }
  }
  // Leaves out the thousandth of the pixels that are noisiest: a firefly there would decide alone.
  void LeaveOutNoisiest() {
    std::vector<std::pair<double, size_t>> errors(pairs_[0].size());
    for (size_t i = 0; i < errors.size(); ++i) {
      errors[i] = {0, i};
      for (const std::vector<double>& pair : pairs_) errors[i].first += pair[i];
    }
    const auto count = static_cast<std::ptrdiff_t>(errors.size() / 1000);
    std::partial_sort(errors.begin(), errors.begin() + count, errors.end(), std::greater<>());
    for (std::vector<double>& pair : pairs_)
      for (std::ptrdiff_t i = 0; i < count; ++i) pair[errors[static_cast<size_t>(i)].second] = 0;
  }
  // Error of independent samples, by tile; Error() is that of the picture.
  std::vector<double> TileErrors(const Grid& grid) const {
    std::vector<double> tiles(grid.Tiles());
    for (int y = 0; y < grid.height; ++y) {
      for (int x = 0; x < grid.width; ++x)
        for (const std::vector<double>& pair : pairs_) tiles[grid.TileOf(x, y)] += pair[grid.PixelOf(x, y)] / Pairs();
    }
    return tiles;
  }
  double Error() const {
    double sum = 0;
    for (const std::vector<double>& pair : pairs_) sum += Sum(pair);
    return sum / Pairs();
  }
  // Standard error of Error(), from the spread of pairs: pixels share photons, so that their spread does not give it.
  // Unknown for a single pair.
  double StandardError() const {
    std::vector<double> errors;
    for (const std::vector<double>& pair : pairs_) errors.push_back(Sum(pair));
    return StandardErrorOf(errors);
  }
  double StandardErrorOfBias() const { return StandardErrorOf(squaredBiases_); }
  // Squared bias, as Error(): the product of two passes, whose noise is independent.
  double SquaredBias() const { return Sum(squaredBiases_) / Pairs(); }
  // Light of a pixel, on average, and its standard error.
  double Mean() const { return sum_ / Pairs(); }
  double ErrorOfMean() const { return std::sqrt(squares_) / Pairs(); }

 private:
  static double StandardErrorOf(const std::vector<double>& values) {
    const auto n = static_cast<double>(values.size());
    if (n < 2) return std::abs(Sum(values));
    const double mean = Sum(values) / n;
    double squares = 0;
    for (const double value : values) squares += Squared(value - mean);
    return std::sqrt(squares / (n * (n - 1)));
  }
  double Pairs() const { return static_cast<double>(pairs_.size()); }

  const Records& records_;
  std::vector<std::vector<double>> pairs_;  // squared error of each pixel, its part of the picture's
  std::vector<double> squaredBiases_;       // of each pair
  double sum_ = 0, squares_ = 0;
};

// Rays and photons of a pass of sppm.
struct Counts {
  PassCounts rays;   // of a pass
  double alpha = 1;  // PhotonSettings::alpha
  uint64_t stored = 0;
  double CostOfSample(const Grid& grid) const { return CostOfSppm(rays, stored, grid.Pixels()); }
};

// Traces pairs of passes, and no more than two where the error of the best makes it hopeless.
Counts Trace(const RenderScene& scene, const RenderScene& counted, const RenderSettings& settings, const Grid& grid,
             const PilotCandidate* best, double gain, uint32_t pairs, int threads, Measured& measured) {
  const double fewer = grid.Fewer();
  RenderSettings ofSeen = settings;
  ofSeen.values.Set("max-depth", int64_t{0});
  const std::unique_ptr<Integrator> sppm = Make(kName, scene, settings, fewer),
                                    emission = Make("path", scene, ofSeen, fewer);
  const PhotonSettings photons = PhotonsOfPilot(*sppm, fewer);
  const double wider = WiderRadius(fewer, photons.alpha);
  Counts counts;
  counts.alpha = photons.alpha;
  PhotonStore store(photons, static_cast<uint64_t>(grid.Pixels()));
  PilotPasses passes(scene, settings, grid, threads), countedPasses(counted, settings, grid, threads);
  const auto pixels = static_cast<size_t>(grid.Pixels());
  Measured::Found found{std::vector<double>(pixels), std::vector<double>(pixels)}, last;
  std::vector<std::vector<double>> seen;
  for (uint32_t pass = 0; pass < 2 * pairs; ++pass) {
    const PassCounts light = passes.TracePhotons(*sppm, store, pass);
    const PhotonPass& gather = store.Open(pass, threads, wider);
    const PassCounts camera = passes.Trace(*sppm, pass, &gather, {.values = &found.light, .biases = &found.bias});
    if (pass == 0) {
      counts.stored = gather.map->Size();
      counts.rays = scene.isSpectral ? countedPasses.Trace(*sppm, pass, &gather) : camera;
      counts.rays += light;
    }
    store.EndGathering();
    std::vector<double>& emitted = seen.emplace_back(pixels);
    passes.Trace(*emission, pass, nullptr, {.values = &emitted});
    for (size_t i = 0; i < pixels; ++i) found.light[i] -= emitted[i];
    if (pass % 2 == 1) measured.Add(last, found);
    last = found;
    if (best && pass % 2 == 1 && pass < 4) {
      const double worse = measured.Error() / gain * counts.CostOfSample(grid) / (best->error * best->cost);
      if (worse > (pass == 1 ? kQuiteHopeless : kHopeless)) break;
    }
  }
  measured.LeaveOutNoisiest();
  if (!settings.SamplesLightEdges()) measured.AddSeen(seen);
  return counts;
}

}  // namespace

std::optional<PilotCandidate> SppmCandidate(const RenderScene& scene, const RenderScene& counted,
                                            const RenderSettings& settings, const Grid& grid, const Records& records,
                                            const PilotCandidate* best, int passCount, int threads) {
  if (!IntegratorRefusal(scene, kName).empty() || !IntegratorHints(scene, kName).empty()) return std::nullopt;
  const double gain = settings.sampler == SamplerKind::Sobol ? kGainOfSobolForLight : 1.0;
  const auto pairs = static_cast<uint32_t>(std::max(passCount / 4, kFewestPairs));
  Measured measured(records);
  const Counts counts = Trace(scene, counted, settings, grid, best, gain, pairs, threads, measured);
  PilotCandidate candidate;
  candidate.integrator = kName;
  candidate.error = std::max(measured.Error() / gain, records.LeastError());
  candidate.uncertainty = measured.StandardError() / gain;
  // The squared radius of the average pass shrinks as passes^(α - 1), and with it the bias. From the pilot's radius,
  // which is wider by the root of `Fewer`, to that of the render the squared bias is taken to shrink as the squared
  // radius: between r⁴, that of smooth light, and r, that of edges.
  const double alpha = counts.alpha, longer = kBlurredPasses / kTypicalPasses;
  candidate.noiseGrowth = std::pow(longer, 1 - alpha);
  // A typical bias, which takes the place of the estimate where its noise is larger: in a Cornell box and in
  // scenes/rainbow the squared bias after 350 passes was 0.4 and 1.8 times the noise.
  constexpr double kTypicalBias = 0.6;
  const double scale = kBlurredPasses / grid.Fewer() * std::pow(longer, 2 * (alpha - 1)),
               typical = kTypicalBias * candidate.noiseGrowth * candidate.error,
               noise = scale * measured.StandardErrorOfBias(),
               known = typical > 0 ? Squared(typical) / (Squared(typical) + Squared(noise)) : 1.0;
  candidate.biasError = std::max(std::lerp(typical, scale * measured.SquaredBias(), known), 0.0);
  candidate.cost = counts.CostOfSample(grid);
  candidate.tileErrors = measured.TileErrors(grid);
  for (double& error : candidate.tileErrors) error /= gain;
  for (std::vector<double>* tiles :
       {&candidate.secondMoments, &candidate.tileVariances, &candidate.tileMissing, &candidate.tileMergedOnly})
    tiles->resize(grid.Tiles());
  const double least = (1 - kTolerated) * records.MeanUnseen() - 4 * measured.ErrorOfMean();
  candidate.missing = std::max((least - measured.Mean()) / records.MeanLight(), 0.0);
  return candidate;
}

}  // namespace lampyr::pilot
