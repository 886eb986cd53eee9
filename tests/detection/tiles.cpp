#include <array>
#include <cmath>

#include "detection/baseline_render.h"
#include "suite/statistics.h"

namespace lampyr::test {

namespace {

constexpr int kTile = 4;

double Squared(double x) {
  return x * x;
}

struct Tiles {
  std::vector<RunningMean> means;
  uint64_t dropped = 0;
};

Tiles RenderTiles(BuiltScene& built, int samplesPerPixel, uint64_t seed) {
  Tiles tiles;
  const int across = built.settings.width / kTile, down = built.settings.height / kTile;
  tiles.means.resize(static_cast<size_t>(across) * static_cast<size_t>(down));
  for (int i = 0; i < kReplicas; ++i) {
    const Rendered rendered = RenderCounted(built, samplesPerPixel, seed + static_cast<uint64_t>(i));
    tiles.dropped += rendered.outcome.counts.droppedSamples;
    for (size_t tile = 0; tile < tiles.means.size(); ++tile) {
      const int x0 = kTile * (static_cast<int>(tile) % across), y0 = kTile * (static_cast<int>(tile) / across);
      double sum = 0;
      for (int y = y0; y < y0 + kTile; ++y) {
        for (int x = x0; x < x0 + kTile; ++x) sum += static_cast<double>(rendered.image.RgbAt(x, y).Average());
      }
      tiles.means[tile].Add(sum / (kTile * kTile));
    }
  }
  return tiles;
}

// p-values of Welch's test, of tiles with any noise.
std::vector<double> PValues(const Tiles& a, const Tiles& b) {
  std::vector<double> values;
  for (size_t tile = 0; tile < a.means.size(); ++tile) {
    const RunningMean &first = a.means[tile], &second = b.means[tile];
    const double va = Squared(first.StandardError()), vb = Squared(second.StandardError());
    const double rounding = Squared(1e-5 * std::max(std::abs(first.Mean()), std::abs(second.Mean())));
    if (!(va > rounding) && !(vb > rounding)) {
      const double difference = std::abs(first.Mean() - second.Mean());
      if (difference > 1e-3 * std::max(std::abs(first.Mean()), std::abs(second.Mean()))) values.push_back(0);
      continue;
    }
    const double t = (first.Mean() - second.Mean()) / std::sqrt(va + vb);
    const double nu = Squared(va + vb) * (kReplicas - 1) / (Squared(va) + Squared(vb));
    values.push_back(NormalTail(NormalDeviate(t, nu)));
  }
  return values;
}

}  // namespace

Finding FindByTiles(const BaselineScene& scene, const std::string& reference, const std::string& tested, double seconds,
                    const Counter& counter) {
  constexpr int kMostLooks = 10;
  Finding finding;
  const double start = CpuSeconds();
  BuiltScene first = BuildFor(scene, reference), second = BuildFor(scene, tested);
  const double level = SidakLevel(kFamilyWise, 2 * kMostLooks);
  for (int look = 0; look < kMostLooks && !finding.found && finding.seconds < seconds; ++look) {
    const uint64_t before = counter(), seed = 1000 * static_cast<uint64_t>(look + 1);
    const Tiles a = RenderTiles(first, 1 << look, seed), b = RenderTiles(second, 1 << look, seed + 500);
    const std::vector<double> values = PValues(a, b);
    std::array<double, 10> observed{}, expected{}, errors{};
    expected.fill(static_cast<double>(values.size()) / 10);
    double least = 1;
    for (const double p : values) {
      ++observed[std::min(static_cast<size_t>(10 * p), size_t{9})];
      least = std::min(least, p);
    }
    if (a.dropped + b.dropped > 0) {
      finding.property = "not finite";
    } else if (least < SidakLevel(level, static_cast<int>(values.size()))) {
      finding.property = "a tile";
    } else if (ChiSquaredTest(observed, expected, errors) < level) {
      finding.property = "all tiles";
    }
    finding.found = !finding.property.empty();
    finding.samples = counter() - before;
    finding.seconds = CpuSeconds() - start;
  }
  return finding;
}

}  // namespace lampyr::test
