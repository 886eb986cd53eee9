#include "render/analysis/pilot_records.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <tuple>
#include <utility>

namespace lampyr::pilot {

namespace {

// A candidate finds it less often than the pilot by this factor.
constexpr double kRare = 16;

// So many of a candidate's events are kept in each chunk.
constexpr size_t kMostRare = 2048;

TechniqueGroup GroupOf(const ConnectedPath& path) {
  if (path.isMerged) return TechniqueGroup::Merge;
  if (path.connection) return TechniqueGroup::Light;
  return path.s == 0 ? TechniqueGroup::Hit : path.s == 1 ? TechniqueGroup::Next : TechniqueGroup::Connect;
}

// Squared error of independent samples over that of Sobol points, for the relMSE of one independent sample: the noisier
// samples are, the less it matters how well their points are distributed. Fitted to path, bdpt and vcm in ten scenes of
// scenes/, 64×64 with 160 samples per pixel, where it is 0.8 to 3.
double GainOfSobol(double error) {
  return error > 0 ? std::clamp(1.6 * std::pow(error, -0.25), 1.0, 3.0) : 1.0;
}

// The least variance that is told apart, in parts of the squared mean, for n samples: second moment and mean are both
// estimated from them. Candidates with less are equally good, and the cheapest of them is chosen.
double LeastVariance(double samples) {
  return 2.2 / std::sqrt(samples);
}

// Factor that makes the squared error of a pixel relative to its brightness. `mean`: brightness of the picture.
double ScaleOf(double brightness, double mean) {
  return 1 / (brightness * brightness + 0.01 * mean * mean);
}

}  // namespace

void Recorder::EndSample() {
  for (size_t k = 0; k < kCandidates; ++k) {
    const Sums& sums = sums_[k];
    // Σ_(i≠j) x_i x_j / (the probability that both are found).
    const double part = std::max(kCandidateOf[k].connections, kFewestLightPaths), on = kCandidateOf[k].continuing;
    const Sum &here = sums.unconnected, &connected = sums.connected, &beyond = sums.unconnectedBeyond,
              &both = sums.connectedBeyond;
    double products = here.Products() + 2 * here.value * (connected.value + beyond.value + both.value);
    products += connected.Products() / part + beyond.Products() / on + both.Products() / (part * on);
    products += 2 * connected.value * (beyond.value + both.value / part) + 2 * beyond.value * both.value / on;
    moments[pixel_].products[k] += products;
  }
}

void Recorder::Observe(const ConnectedPath& path) {
  size_t pixel = pixel_;
  double scale = weight_;
  if (path.connection) {
    const Point2& film = path.connection->camera.film;
    const int x = static_cast<int>(std::floor(film.x / grid_.pixel.x)),
              y = static_cast<int>(std::floor(film.y / grid_.pixel.y));
    if (x < 0 || y < 0 || x >= grid_.width || y >= grid_.height) return;
    pixel = grid_.PixelOf(x, y);
    scale = 1 / filmPixels_;
  }
  Add(path, static_cast<double>(path.value.Average()) * scale, pixel);
}

void Recorder::AddAlike(const ConnectedPath& path, double value, size_t pixel) {
  Moments& here = moments[pixel];
  const double weighted = path.weight * value;
  for (size_t k = 0; k < kCandidates; ++k) {
    here.square[k] += weighted * value * (path.connection ? 1 / splatCount_ : 1.0);
    if (path.connection) continue;
    found[pixel].Add(k, weighted, true);
    sums_[k].unconnected.Add(weighted);
  }
}

namespace {

// Σ (n r)² and Σ (n r)³ r of the groups, without the counts that differ among candidates.
struct GroupSums {
  TechniqueSums::Group path, light, connect, merge;
};
// With so many camera paths that continue.
GroupSums SumsOf(const TechniqueSums& sums, double continuing) {
  const auto of = [&](TechniqueGroup group) {
    TechniqueSums::Group sum = sums.Of(group);
    if (const TechniqueGroup beyond = BeyondOf(group); beyond != group) {
      sum.squares += continuing * continuing * sums.Of(beyond).squares;
      sum.cubes += continuing * continuing * continuing * sums.Of(beyond).cubes;
    }
    return sum;
  };
  GroupSums grouped{of(TechniqueGroup::Hit), of(TechniqueGroup::Light), of(TechniqueGroup::Connect),
                    of(TechniqueGroup::Merge)};
  const TechniqueSums::Group next = of(TechniqueGroup::Next);
  grouped.path.squares += next.squares;
  grouped.path.cubes += next.cubes;
  return grouped;
}

double CountOf(TechniqueGroup group, const Candidate& candidate) {
  switch (group) {
    case TechniqueGroup::Light:
      return candidate.lightPaths;
    case TechniqueGroup::Connect:
      return candidate.connections;
    case TechniqueGroup::Merge:
      return candidate.merging;
    default:
      return 1;
  }
}

}  // namespace

void Recorder::Add(const ConnectedPath& path, double value, size_t pixel) {
  Moments& here = moments[pixel];
  const bool isSeen = path.s + path.t == 2;
  const double weighted = path.weight * value;
  if (!std::isfinite(weighted)) return;
  (isSeen ? here.seen : here.mean) += weighted;
  double known = 0;
  for (const TechniqueSums::Group& group : path.sums.groups) known += group.squares;
  if (!(known > 0)) return AddAlike(path, value, pixel);
  const double splatSquare = path.connection ? 1 / splatCount_ : 1.0;
  const TechniqueGroup own = GroupOf(path);
  const double bySplats = path.sums.Of(TechniqueGroup::Light).squares;
  const GroupSums ofWhole = SumsOf(path.sums, 1), ofEnding = SumsOf(path.sums, kContinuing);
  std::array<bool, kCandidates> isMissed{};
  for (size_t k = 0; k < kCandidates; ++k) {
    const Candidate& candidate = kCandidateOf[k];
    const GroupSums& sums = candidate.continuing < 1 ? ofEnding : ofWhole;
    const double light = candidate.lightPaths * candidate.lightPaths,
                 connect = candidate.connections * candidate.connections, merge = candidate.merging * candidate.merging;
    const double squares =
        sums.path.squares + light * sums.light.squares + connect * sums.connect.squares + merge * sums.merge.squares;
    const double cubes = sums.path.cubes + light * candidate.lightPaths * sums.light.cubes +
                         connect * candidate.connections * sums.connect.cubes +
                         merge * candidate.merging * sums.merge.cubes;
    const double factor = cubes / (squares * squares) * splatSquare;
    if (!std::isfinite(factor) || !(squares > 0)) {
      here.missing[k] += weighted;
      isMissed[k] = true;
      continue;
    }
    here.square[k] += weighted * value * factor;
    if (Merges(k) && isMissed[WithoutMerging(k)]) here.mergedOnly[k] += weighted * value * factor;
    const double expected = renders_ * path.weight / factor;
    if (factor > kRare && expected < 1)
      Keep({pixel, value * factor, expected, weighted, weighted * value * factor}, rare[k]);
    if (bySplats < known && !path.connection) {
      // As if there were no splats in the pilot, and by the candidate's techniques of camera paths.
      const double ofCamera = 1 - light * bySplats / squares;
      found[pixel].Add(k, weighted * known / (known - bySplats) * ofCamera, bySplats < 0.5 * known);
    }
    const double count = CountOf(own, candidate);
    if (path.connection || count == 0) continue;
    const double ofOwn = path.sums.isBeyond ? count * candidate.continuing : count;
    const double reweighted = weighted * known * ofOwn * ofOwn / squares;  // w = r² / Σ r²
    if (path.isMerged && path.t == 2) here.products[k] += 2 * reweighted * SplatOf(path, value, count, squares) / count;
    Sums& all = sums_[k];
    if (own == TechniqueGroup::Connect) found[pixel].connected[k] += static_cast<float>(reweighted);
    if (own == TechniqueGroup::Connect) {
      (path.sums.isBeyond ? all.connectedBeyond : all.connected).Add(reweighted);
    } else {
      (path.sums.isBeyond ? all.unconnectedBeyond : all.unconnected).Add(reweighted);
    }
  }
}

void Recorder::Keep(const RareEvent& event, std::vector<RareEvent>& brightest) {
  const auto isBrighter = [](const RareEvent& a, const RareEvent& b) { return a.value > b.value; };
  if (brightest.size() == kMostRare) {
    if (event.value <= brightest.front().value) return;
    std::pop_heap(brightest.begin(), brightest.end(), isBrighter);
    brightest.pop_back();
  }
  brightest.push_back(event);
  std::push_heap(brightest.begin(), brightest.end(), isBrighter);
}

double Recorder::SplatOf(const ConnectedPath& path, double value, double lightPaths, double squares) const {
  const double splatSquare = path.sums.Of(TechniqueGroup::Light).squares;
  if (!(splatSquare > 0)) return 0;
  const double pixels = std::sqrt(splatSquare) / splatCount_;  // area of a pixel in that of the disc of merging
  const double overlap = 1 / (spread_ + 1 / pixels);           // exact for discs far smaller or larger than a pixel
  return overlap * lightPaths * lightPaths * splatSquare / squares * value / pixels;
}

void Records::EndPass(uint32_t pass) {
  std::vector<Found> found(recorders_[0].found.size());
  for (Recorder& recorder : recorders_) {
    for (size_t i = 0; i < found.size(); ++i) found[i] += std::exchange(recorder.found[i], Found());
  }
  for (size_t i = 0; i < found.size() && pass % 2 == 1; ++i) {
    for (size_t k = 0; k < kCandidates; ++k) {
      SquaredMean& squared = squaredMeans_[kCandidates * i + k];
      squared.value += 2 * static_cast<double>(last_[i].value[k]) * static_cast<double>(found[i].value[k]);
      squared.connected += 2 * static_cast<double>(last_[i].connected[k]) * static_cast<double>(found[i].connected[k]);
      squared.oftener += 2 * static_cast<double>(last_[i].oftener[k]) * static_cast<double>(found[i].oftener[k]);
    }
  }
  last_ = std::move(found);
}

Records::Brightness Records::BrightnessOf(const std::vector<Moments>& pixels, int passes) const {
  Brightness brightness;
  std::vector<double> tiles(grid_.Tiles());
  double mean = 0;
  ForEachPixel([&](size_t pixel, size_t tile) {
    tiles[tile] += pixels[pixel].mean / (passes * grid_.PixelsOf(tile));
    mean += (pixels[pixel].mean + pixels[pixel].seen) / (passes * grid_.Pixels());
  });
  brightness.mean = mean;
  brightness.scales.resize(pixels.size());
  ForEachPixel([&](size_t pixel, size_t tile) {
    const double here = tiles[tile] + pixels[pixel].seen / passes;
    brightness.scales[pixel] = ScaleOf(here, mean) / passes;
    brightness.squared += brightness.scales[pixel] * passes * here * here / grid_.Pixels();
  });
  return brightness;
}

double Records::WeightAt(double brightness) const {
  return squaredWeight_ * ScaleOf(brightness, meanLight_) / grid_.Pixels();
}

bool Records::SetErrors(int passes, double squaredWeight, bool isSobol, std::vector<PilotCandidate>& candidates) {
  squaredWeight_ = squaredWeight;
  std::vector<Moments> pixels(squaredMeans_.size() / kCandidates);
  for (const Recorder& recorder : recorders_) {
    for (size_t i = 0; i < pixels.size(); ++i) pixels[i] += recorder.moments[i];
  }
  const Brightness brightness = BrightnessOf(pixels, passes);
  if (!(brightness.mean > 0)) return false;
  meanLight_ = brightness.mean;
  for (const Moments& pixel : pixels) meanUnseen_ += pixel.mean / (passes * grid_.Pixels());
  for (size_t k = 0; k < candidates.size(); ++k) LeaveOutRare(k, passes, brightness.mean, brightness.scales, pixels);
  const std::vector<char> isLeftOut = Hopeless(pixels, brightness.scales);
  for (size_t k = 0; k < candidates.size(); ++k)
    AddUp(k, passes, brightness, pixels, isLeftOut, squaredWeight, candidates[k]);
  weights_.assign(pixels.size(), 0);
  for (size_t i = 0; i < pixels.size(); ++i)
    if (!isLeftOut[i]) weights_[i] = squaredWeight * brightness.scales[i] * passes / grid_.Pixels();
  least_ = LeastVariance(passes * grid_.Pixels()) * brightness.squared;
  // More light paths, or more merges, leave the points in the pixels as they are, and what these gain.
  std::array<double, kCandidates> gains;
  for (size_t k = 0; k < candidates.size(); ++k)
    gains[k] = isSobol ? GainOfSobol(candidates[WithFewestSamples(k)].error) : 1.0;
  for (size_t k = 0; k < candidates.size(); ++k) {
    PilotCandidate& candidate = candidates[k];
    for (double& error : candidate.tileErrors) error /= gains[k];
    for (double& error : candidate.tileMergedOnly) error /= gains[k];
    for (double& variance : candidate.tileVariances) variance /= gains[k] * gains[k];
    candidate.uncertainty /= gains[k];
    candidate.error = std::max(candidate.error / gains[k], least_);
    candidate.gainOfSobol = gains[k];
  }
  return true;
}

std::vector<double> Records::RelativeErrors(const std::vector<double>& squares) const {
  std::vector<double> errors(grid_.Tiles());
  ForEachPixel([&](size_t pixel, size_t tile) { errors[tile] += squares[pixel] * weights_[pixel]; });
  return errors;
}

void Records::AddUp(size_t k, int passes, const Brightness& brightness, const std::vector<Moments>& pixels,
                    const std::vector<char>& isLeftOut, double squaredWeight, PilotCandidate& candidate) const {
  candidate.secondMoments.resize(grid_.Tiles());
  candidate.tileErrors.resize(grid_.Tiles());
  candidate.tileVariances.resize(grid_.Tiles());
  candidate.tileMissing.resize(grid_.Tiles());
  candidate.tileMergedOnly.resize(grid_.Tiles());
  ForEachPixel([&](size_t pixel, size_t tile) {
    const Moments& here = pixels[pixel];
    candidate.secondMoments[tile] += here.square[k] / (passes * grid_.PixelsOf(tile));
    candidate.tileMissing[tile] += here.missing[k] / (passes * grid_.Pixels() * brightness.mean);
    if (isLeftOut[pixel]) return;
    const double secondMoment = here.square[k] + here.products[k];
    const SquaredMean& squared = squaredMeans_[kCandidates * pixel + k];
    const double below = squared.Below(secondMoment);
    const double variance = secondMoment - below - squared.OfTurns(kCandidateOf[k].connections, below);
    const double error = squaredWeight * brightness.scales[pixel] * variance / grid_.Pixels();
    candidate.tileErrors[tile] += error;
    candidate.tileVariances[tile] += error * error;
    candidate.tileMergedOnly[tile] += squaredWeight * brightness.scales[pixel] * here.mergedOnly[k] / grid_.Pixels();
  });
  double variances = 0;
  for (size_t tile = 0; tile < grid_.Tiles(); ++tile) {
    candidate.missing += candidate.tileMissing[tile];
    candidate.error += candidate.tileErrors[tile];
    // Variance of the tile's sum, from the spread of its pixels.
    double& variance = candidate.tileVariances[tile];
    const int n = grid_.PixelsOf(tile);
    variance -= candidate.tileErrors[tile] * candidate.tileErrors[tile] / n;
    variance = std::max(variance * n / std::max(n - 1, 1), 0.0);
    variances += variance;
  }
  candidate.uncertainty = std::sqrt(variances);
}

std::vector<char> Records::Hopeless(const std::vector<Moments>& pixels, const std::vector<double>& scales) const {
  constexpr double kPart = 0.001;
  std::vector<std::pair<double, size_t>> least(pixels.size());
  for (size_t i = 0; i < pixels.size(); ++i) {
    double square = std::numeric_limits<double>::infinity();
    for (size_t k = 0; k < kCandidates; ++k) {
      if (pixels[i].missing[k] == 0) square = std::min(square, pixels[i].square[k] + pixels[i].products[k]);
    }
    least[i] = {std::isfinite(square) ? scales[i] * square : 0.0, i};
  }
  const auto count = static_cast<std::ptrdiff_t>(std::lround(kPart * static_cast<double>(pixels.size())));
  std::partial_sort(least.begin(), least.begin() + count, least.end(), std::greater<>());
  std::vector<char> isHopeless(pixels.size());
  for (std::ptrdiff_t i = 0; i < count; ++i) isHopeless[least[static_cast<size_t>(i)].second] = 1;
  return isHopeless;
}

void Records::LeaveOutRare(size_t k, int passes, double mean, const std::vector<double>& scales,
                           std::vector<Moments>& pixels) const {
  std::vector<RareEvent> events;
  for (const Recorder& recorder : recorders_)
    events.insert(events.end(), recorder.rare[k].begin(), recorder.rare[k].end());
  const auto relative = [&](const RareEvent& event) { return event.value * event.value * scales[event.pixel]; };
  std::sort(events.begin(), events.end(), [&](const RareEvent& a, const RareEvent& b) {
    const double first = relative(a), second = relative(b);
    return first != second ? first > second : std::tie(a.pixel, a.light) < std::tie(b.pixel, b.light);
  });
  double expected = 0, missing = 0;
  for (const Moments& pixel : pixels) missing += pixel.missing[k];
  const double most = 0.5 * kNegligibleLight * passes * grid_.Pixels() * mean;
  for (const RareEvent& event : events) {
    expected += event.expected;
    missing += event.light;
    if (expected > 1 || missing > most) return;
    pixels[event.pixel].square[k] -= event.square;
    pixels[event.pixel].missing[k] += event.light;
  }
}

}  // namespace lampyr::pilot
