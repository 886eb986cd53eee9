#include "render/analysis/merging_mask.h"

#include <algorithm>
#include <cmath>

namespace lampyr::pilot {

namespace {

// Calls visit(tile) for the tiles of the 3 × 3 around `tile` that the grid has.
template <class Visit>
void ForTilesAround(size_t tile, const Grid& grid, const Visit& visit) {
  const int x = static_cast<int>(tile) % grid.tilesX, y = static_cast<int>(tile) / grid.tilesX;
  for (int v = std::max(y - 1, 0); v <= std::min(y + 1, grid.tilesY - 1); ++v) {
    for (int u = std::max(x - 1, 0); u <= std::min(x + 1, grid.tilesX - 1); ++u)
      visit(static_cast<size_t>(v) * static_cast<size_t>(grid.tilesX) + static_cast<size_t>(u));
  }
}

// The mean over the 3 × 3 tiles around each, `times` times.
std::vector<double> Blurred(std::vector<double> values, const Grid& grid, int times) {
  for (int i = 0; i < times; ++i) {
    std::vector<double> blurred(values.size());
    for (size_t tile = 0; tile < values.size(); ++tile) {
      double sum = 0;
      int count = 0;
      ForTilesAround(tile, grid, [&](size_t other) {
        sum += values[other];
        ++count;
      });
      blurred[tile] = sum / count;
    }
    values = std::move(blurred);
  }
  return values;
}

// The largest of the 3 × 3 tiles around each.
std::vector<double> Largest(const std::vector<double>& values, const Grid& grid) {
  std::vector<double> largest = values;
  for (size_t tile = 0; tile < values.size(); ++tile)
    ForTilesAround(tile, grid, [&](size_t other) { largest[tile] = std::max(largest[tile], values[other]); });
  return largest;
}

// The least probability of merging in tiles where the pilot has seen light that only merging finds, and around them,
// if merging does not pay there otherwise. Elsewhere such light is negligible (kNegligibleLight), and weights without
// merging are cheaper.
constexpr double kNowAndThen = 1.0 / 16;

// The error of a tile that is merged with that probability. Light that nothing but merging finds is then found as
// rarely, and is divided by the probability when it is.
double ErrorAt(double probability, double without, double with, double mergedOnly) {
  const double mixed = probability * with + (1 - probability) * without;
  return probability > 0 ? mixed + mergedOnly * (1 / probability - probability) : mixed;
}

// Standard deviation of ErrorAt, as a factor on that of `with`: errors of light that only merging finds grow by 1 / q.
double DeviationFactor(double probability, double with, double mergedOnly) {
  if (!(probability > 0)) return 0;
  const double part = with > 0 ? std::clamp(mergedOnly / with, 0.0, 1.0) : 1.0;
  return probability + part * (1 / probability - probability);
}

// The probability q that minimises error / q + cost · q.
double ProbabilityOf(double error, double cost) {
  return cost > 0 ? std::clamp(std::sqrt(error / cost), kNowAndThen, 1.0) : 1.0;
}

}  // namespace

std::optional<PilotCandidate> MergingInParts(const PilotCandidate& none, const PilotCandidate& all,
                                             const CandidateCost& cost, const Grid& grid, double least) {
  constexpr int kBlurs = 2, kRounds = 8;
  constexpr double kWorthIt = 0.97;
  const bool mustMerge = none.missing > kNegligibleLight;
  const std::vector<double> missing = Blurred(none.tileMissing, grid, 1);
  const std::vector<double> without = Blurred(none.tileErrors, grid, kBlurs),
                            with = Blurred(all.tileErrors, grid, kBlurs),
                            mergedOnly = Blurred(all.tileMergedOnly, grid, kBlurs);
  if (none.error <= least || all.error <= least) return std::nullopt;
  double error = all.error, part = 1;
  std::vector<double> merges(grid.Tiles()), must(grid.Tiles());
  for (int round = 0; round < kRounds; ++round) {
    const double perError = 1 / error, perCost = cost.merging / (cost.paths + part * cost.merging);
    error = part = 0;
    for (size_t i = 0; i < grid.Tiles(); ++i) {
      const bool isWorthIt = (without[i] - with[i]) * perError > perCost * grid.PartOf(i);
      merges[i] = isWorthIt ? 1.0 : 0.0;
      must[i] = mustMerge && missing[i] > 0 ? ProbabilityOf(mergedOnly[i] * perError, perCost * grid.PartOf(i)) : 0.0;
      const double probability = std::max(merges[i], must[i]);
      error += ErrorAt(probability, without[i], with[i], mergedOnly[i]);
      part += probability * grid.PartOf(i);
    }
    if (!(error > 0)) return std::nullopt;
  }
  // Wider by a tile, with a soft edge: the pilot sees a tile by a few samples.
  merges = Blurred(std::move(merges), grid, 1);
  must = Largest(Largest(must, grid), grid);
  for (size_t i = 0; i < merges.size(); ++i) merges[i] = std::max(std::min(3 * merges[i], 1.0), must[i]);
  PilotCandidate mixed = all;
  mixed.error = mixed.uncertainty = part = 0;
  std::vector<float> mask;
  for (size_t i = 0; i < grid.Tiles(); ++i) {
    mixed.tileErrors[i] = ErrorAt(merges[i], none.tileErrors[i], all.tileErrors[i], all.tileMergedOnly[i]);
    mixed.error += mixed.tileErrors[i];
    const double ofAll = DeviationFactor(merges[i], all.tileErrors[i], all.tileMergedOnly[i]), ofNone = 1 - merges[i];
    mixed.tileVariances[i] = ofAll * ofAll * all.tileVariances[i] + ofNone * ofNone * none.tileVariances[i];
    mixed.uncertainty += mixed.tileVariances[i];
    part += merges[i] * grid.PartOf(i);
    mask.push_back(static_cast<float>(merges[i]));
  }
  if (!(part > 0)) return std::nullopt;
  mixed.uncertainty = std::sqrt(mixed.uncertainty);
  mixed.error = std::max(mixed.error, least);
  mixed.cost = cost.paths + part * cost.merging;
  mixed.counts.merging = FilmMask(grid.tilesX, grid.tilesY, grid.FilmOfTiles(), std::move(mask));
  const double best = mustMerge ? all.ErrorTimesCost() : std::min(none.ErrorTimesCost(), all.ErrorTimesCost());
  if (mixed.ErrorTimesCost() > kWorthIt * best) return std::nullopt;
  return mixed;
}

}  // namespace lampyr::pilot
