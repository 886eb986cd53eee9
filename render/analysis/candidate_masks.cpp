#include "render/analysis/candidate_masks.h"

#include <algorithm>
#include <cmath>
#include <limits>

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

// Chooses one of the options for each tile, and whether it merges. The sums E and C over all tiles follow from the
// choices, so it takes several rounds: in each, a tile takes the least e/E + c/C by the sums of the round before.
class Choices {
 public:
  Choices(std::span<const CameraPaths> options, const Grid& grid) : options_(options), grid_(grid) {
    constexpr int kBlurs = 2;
    for (const CameraPaths& paths : options) {
      Tiles tiles;
      tiles.without = Blurred(paths.none->tileErrors, grid, kBlurs);
      if (paths.all) {
        tiles.with = Blurred(paths.all->tileErrors, grid, kBlurs);
        tiles.mergedOnly = Blurred(paths.all->tileMergedOnly, grid, kBlurs);
      }
      tiles_.push_back(std::move(tiles));
    }
    const PilotCandidate& none = *options[0].none;
    mustMerge_ = options[0].all && none.missing > kNegligibleLight;
    missing_ = Blurred(none.tileMissing, grid, 1);
    const PilotCandidate& first = options[0].all ? *options[0].all : none;
    error_ = first.error;
    cost_ = options[0].cost.paths + (options[0].all ? options[0].cost.merging : 0.0);
    merges.resize(grid.Tiles());
    must.resize(grid.Tiles());
    isWhole.resize(grid.Tiles());
  }

  // False: nothing is left to choose by.
  bool Run() {
    constexpr int kRounds = 8;
    for (int round = 0; round < kRounds; ++round) {
      const double perError = 1 / error_, perCost = 1 / cost_;
      error_ = cost_ = 0;
      for (size_t tile = 0; tile < grid_.Tiles(); ++tile) Choose(tile, perError, perCost);
      if (!(error_ > 0)) return false;
    }
    return true;
  }
  bool MustMerge() const { return mustMerge_; }

  std::vector<double> merges, must, isWhole;  // by tile

 private:
  struct Tiles {
    std::vector<double> without, with, mergedOnly;  // errors
  };

  void Choose(size_t tile, double perError, double perCost) {
    double least = std::numeric_limits<double>::infinity(), error = 0, cost = 0;
    for (size_t i = 0; i < options_.size(); ++i) {
      const Tiles& tiles = tiles_[i];
      const CandidateCost& costs = options_[i].cost;
      const double part = grid_.PartOf(tile);
      const auto consider = [&](double merging, double forced, double itsError) {
        const double itsCost = (costs.paths + std::max(merging, forced) * costs.merging) * part;
        const double sum = itsError * perError + itsCost * perCost;
        if (sum >= least) return;
        least = sum;
        error = itsError;
        cost = itsCost;
        merges[tile] = merging;
        must[tile] = forced;
        isWhole[tile] = i == 0 ? 1 : 0;
      };
      if (!options_[i].all) {
        consider(0, 0, tiles.without[tile]);
        continue;
      }
      const double forced = mustMerge_ && missing_[tile] > 0
                                ? ProbabilityOf(tiles.mergedOnly[tile] * perError, perCost * costs.merging * part)
                                : 0.0;
      consider(0, forced, ErrorAt(forced, tiles.without[tile], tiles.with[tile], tiles.mergedOnly[tile]));
      consider(1, forced, tiles.with[tile]);
    }
    error_ += error;
    cost_ += cost;
  }

  std::span<const CameraPaths> options_;
  const Grid& grid_;
  std::vector<Tiles> tiles_;
  bool mustMerge_ = false;
  std::vector<double> missing_;
  double error_ = 0, cost_ = 0;
};

// The least error · cost of the options without masks.
double LeastOf(std::span<const CameraPaths> options, bool mustMerge) {
  double least = std::numeric_limits<double>::infinity();
  for (const CameraPaths& paths : options) {
    if (!mustMerge) least = std::min(least, paths.none->ErrorTimesCost());
    if (paths.all) least = std::min(least, paths.all->ErrorTimesCost());
  }
  return least;
}

// Sets error and cost of a candidate whose tiles merge with the probabilities `merges`, and of whose camera paths the
// part `wholePart` are those of options[0].
void SetMixed(std::span<const CameraPaths> options, const Grid& grid, const std::vector<double>& merges,
              const std::vector<double>& wholePart, PilotCandidate& mixed) {
  mixed.error = mixed.uncertainty = mixed.cost = 0;
  for (size_t i = 0; i < grid.Tiles(); ++i) {
    mixed.tileErrors[i] = mixed.tileVariances[i] = 0;
    for (size_t o = 0; o < options.size(); ++o) {
      const CameraPaths& paths = options[o];
      const double part = o == 0 ? wholePart[i] : 1 - wholePart[i];
      mixed.cost += part * (paths.cost.paths + merges[i] * paths.cost.merging) * grid.PartOf(i);
      if (!paths.all) {
        mixed.tileErrors[i] += part * paths.none->tileErrors[i];
        mixed.tileVariances[i] += part * part * paths.none->tileVariances[i];
        continue;
      }
      const double with = paths.all->tileErrors[i], mergedOnly = paths.all->tileMergedOnly[i];
      mixed.tileErrors[i] += part * ErrorAt(merges[i], paths.none->tileErrors[i], with, mergedOnly);
      const double ofAll = part * DeviationFactor(merges[i], with, mergedOnly), ofNone = part * (1 - merges[i]);
      mixed.tileVariances[i] +=
          ofAll * ofAll * paths.all->tileVariances[i] + ofNone * ofNone * paths.none->tileVariances[i];
    }
    mixed.error += mixed.tileErrors[i];
    mixed.uncertainty += mixed.tileVariances[i];
  }
  mixed.uncertainty = std::sqrt(mixed.uncertainty);
}

FilmMask MaskOf(const std::vector<double>& values, const Grid& grid) {
  return FilmMask(grid.tilesX, grid.tilesY, grid.FilmOfTiles(), std::vector<float>(values.begin(), values.end()));
}

}  // namespace

std::optional<PilotCandidate> InParts(std::span<const CameraPaths> options, const Grid& grid, double least) {
  constexpr double kWorthIt = 0.97;
  for (const CameraPaths& paths : options)
    if (paths.none->error <= least || (paths.all && paths.all->error <= least)) return std::nullopt;
  Choices choices(options, grid);
  if (!choices.Run()) return std::nullopt;
  // Wider by a tile, with a soft edge: the pilot sees a tile by a few samples.
  std::vector<double> merges = Blurred(std::move(choices.merges), grid, 1),
                      wholePart = Blurred(std::move(choices.isWhole), grid, 1);
  const std::vector<double> must = Largest(Largest(choices.must, grid), grid);
  double merging = 0, longer = 0;
  for (size_t i = 0; i < grid.Tiles(); ++i) {
    merges[i] = std::max(std::min(3 * merges[i], 1.0), must[i]);
    wholePart[i] = std::min(3 * wholePart[i], 1.0);
    merging += merges[i] * grid.PartOf(i);
    longer += wholePart[i] * grid.PartOf(i);
  }
  const bool canMerge = options[0].all != nullptr;
  // That it merges nowhere is another candidate.
  if (canMerge && !(merging > 0)) return std::nullopt;
  PilotCandidate mixed = canMerge ? *options[0].all : *options[0].none;
  SetMixed(options, grid, merges, wholePart, mixed);
  mixed.error = std::max(mixed.error, least);
  if (canMerge && merging < 1) mixed.counts.merging = MaskOf(merges, grid);
  if (longer < 1) {
    for (double& part : wholePart) part = kContinuing + (1 - kContinuing) * part;
    mixed.counts.continuing = MaskOf(wholePart, grid);
  }
  if (mixed.ErrorTimesCost() > kWorthIt * LeastOf(options.first(1), choices.MustMerge())) return std::nullopt;
  return mixed;
}

}  // namespace lampyr::pilot
