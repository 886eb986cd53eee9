#include "render/analysis/pilot_records.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <tuple>
#include <utility>

namespace lampyr::pilot {

namespace {

// An event is rare if a candidate finds it less often than the pilot by this factor.
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

// The least distinguishable variance, relative to the squared mean, for n samples: second moment and mean are both
// estimated from them. Candidates with less variance are equally good, and the cheapest of them is chosen.
double LeastVariance(double samples) {
  return 2.2 / std::sqrt(samples);
}

// Factor that makes the squared error of a pixel relative to its brightness. `mean`: brightness of the picture.
double ScaleOf(double brightness, double mean) {
  return 1 / (brightness * brightness + 0.01 * mean * mean);
}

// Keeps the brightest of a candidate's events.
void Keep(const RareEvent& event, std::vector<RareEvent>& brightest) {
  const auto isBrighter = [](const RareEvent& a, const RareEvent& b) { return a.value > b.value; };
  if (brightest.size() == kMostRare) {
    if (event.value <= brightest.front().value) return;
    std::pop_heap(brightest.begin(), brightest.end(), isBrighter);
    brightest.pop_back();
  }
  brightest.push_back(event);
  std::push_heap(brightest.begin(), brightest.end(), isBrighter);
}

// Numbers of techniques of all candidates, and powers of them; those that end early come last.
struct Counts {
  std::array<double, kCandidates> light, connect, merge, continuing;
};
constexpr Counts kCounts = [] {
  Counts counts{};
  for (size_t k = 0; k < kCandidates; ++k) {
    const Candidate& candidate = kCandidateOf[k];
    counts.light[k] = candidate.lightPaths;
    counts.connect[k] = candidate.connections;
    counts.merge[k] = candidate.merging;
    counts.continuing[k] = candidate.continuing;
  }
  return counts;
}();

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

double Known(const TechniqueSums& sums) {
  double known = 0;
  for (const TechniqueSums::Group& group : sums.groups) known += group.squares;
  return known;
}

}  // namespace

void Recorder::EndSample() {
  // Σ_(i≠j) x_i x_j / (the probability that both are found); of one sum, (Σ x)² - Σ x².
  PerCandidate& products = pixels_.moments[pixel_].products;
  const Sum &here = sums_.unconnected, &connected = sums_.connected, &beyond = sums_.unconnectedBeyond,
            &both = sums_.connectedBeyond;
  for (size_t k = 0; k < kCandidates; ++k) {
    const double part = std::max(kCounts.connect[k], kFewestLightPaths), on = kCounts.continuing[k];
    const auto ofOne = [k](const Sum& sum) { return sum.value[k] * sum.value[k] - sum.squares[k]; };
    products[k] += ofOne(here) + 2 * here.value[k] * (connected.value[k] + beyond.value[k] + both.value[k]) +
                   ofOne(connected) / part + ofOne(beyond) / on + ofOne(both) / (part * on) +
                   2 * connected.value[k] * (beyond.value[k] + both.value[k] / part) +
                   2 * beyond.value[k] * both.value[k] / on;
  }
}

void Recorder::EndPass() {
  for (const Splat& splat : elsewhere_) Add(splat);
  elsewhere_.clear();
}

void Recorder::Observe(const ConnectedPath& path) {
  const auto value = static_cast<double>(path.value.Average());
  if (!std::isfinite(path.weight * value)) return;
  if (!path.connection) return Add(path, value * weight_);
  const Point2& film = path.connection->camera.film;
  const int x = static_cast<int>(std::floor(film.x / grid_.pixel.x)),
            y = static_cast<int>(std::floor(film.y / grid_.pixel.y));
  if (x < 0 || y < 0 || x >= grid_.width || y >= grid_.height) return;
  AddSplat(path, value / filmPixels_, grid_.PixelOf(x, y));
}

Recorder::Factors Recorder::FactorsOf(const TechniqueSums& sums, double splatSquare) {
  Factors all;
  const GroupSums ofWhole = SumsOf(sums, 1), ofEnding = SumsOf(sums, kContinuing);
  const auto set = [&all, splatSquare](const GroupSums& groups, size_t first, size_t end) {
    for (size_t k = first; k < end; ++k) {
      const double light = kCounts.light[k], connect = kCounts.connect[k], merge = kCounts.merge[k];
      const double squares = groups.path.squares + light * light * groups.light.squares +
                             connect * connect * groups.connect.squares + merge * merge * groups.merge.squares;
      const double cubes = groups.path.cubes + light * light * light * groups.light.cubes +
                           connect * connect * connect * groups.connect.cubes +
                           merge * merge * merge * groups.merge.cubes;
      const double factor = cubes / (squares * squares) * splatSquare;
      const bool isFound = squares > 0 && factor <= std::numeric_limits<double>::max();
      const double ofLight = light * light * light * groups.light.cubes + merge * merge * merge * groups.merge.cubes;
      all.squares[k] = isFound ? squares : 0;
      all.factors[k] = isFound ? factor : 0;
      all.ofLight[k] = isFound && cubes > 0 ? ofLight / cubes : 0;
    }
  };
  set(ofWhole, 0, kWholeCandidates);
  set(ofEnding, kWholeCandidates, kCandidates);
  return all;
}

void Recorder::AddAlike(const ConnectedPath& path, double value) {
  const double weighted = path.weight * value;
  for (double& square : pixels_.moments[pixel_].square) square += weighted * value;
  Found& found = pixels_.found[pixel_];
  for (std::array<float, kCandidates>* of : {&found.value, &found.oftener})
    for (float& sum : *of) sum += static_cast<float>(weighted);
  for (double& sum : sums_.unconnected.value) sum += weighted;
  for (double& sum : sums_.unconnected.squares) sum += weighted * weighted;
}

void Recorder::KeepRare(const ConnectedPath& path, double value, size_t pixel, const Factors& found) {
  const PerCandidate& factors = found.factors;
  if (*std::max_element(factors.begin(), factors.end()) <= kRare) return;
  const double weighted = path.weight * value;
  for (size_t k = 0; k < kCandidates; ++k) {
    const double expected = renders_ * path.weight / factors[k];
    if (factors[k] > kRare && expected < mostPasses_)
      Keep({pixel, value * factors[k], expected, weighted, weighted * value * factors[k], found.ofLight[k]}, rare[k]);
  }
}

void Recorder::AddSplat(const ConnectedPath& path, double value, size_t pixel) {
  Splat splat{pixel, path.s + path.t == 2, path.weight * value, {}, {}};
  const bool isCounted = !splat.isSeen || countsSeen_;
  if (Known(path.sums) > 0) {
    const Factors found = FactorsOf(path.sums, 1 / splatCount_);
    const auto& [squares, factors, ofLight] = found;
    for (size_t k = 0; k < kCandidates; ++k)
      splat.squares[k] = squares[k] > 0 ? splat.weighted * value * factors[k] : -1;
    splat.ofLight = ofLight;
    if (isCounted) KeepRare(path, value, pixel, found);
  } else {
    splat.squares.fill(splat.weighted * value / splatCount_);
    splat.ofLight.fill(1);
  }
  if (!isCounted)
    for (double& square : splat.squares) square = std::min(square, 0.0);
  if (pixel >= first_ && pixel < end_) {
    Add(splat);
  } else {
    elsewhere_.push_back(splat);
  }
}

void Recorder::Add(const Splat& splat) {
  Moments& here = pixels_.moments[splat.pixel];
  (splat.isSeen ? here.seen : here.mean) += splat.weighted;
  for (size_t k = 0; k < kCandidates; ++k) {
    const bool isMissed = splat.squares[k] < 0;
    here.square[k] += isMissed ? 0 : splat.squares[k];
    here.ofLight[k] += isMissed ? 0 : splat.squares[k] * splat.ofLight[k];
    here.missing[k] += isMissed ? splat.weighted : 0;
  }
}

void Recorder::Add(const ConnectedPath& path, double value) {
  Moments& here = pixels_.moments[pixel_];
  const double weighted = path.weight * value, known = Known(path.sums);
  const bool isSeen = path.s + path.t == 2, isCounted = !isSeen || countsSeen_;
  (isSeen ? here.seen : here.mean) += weighted;
  if (!(known > 0)) return isCounted ? AddAlike(path, value) : void();
  const Factors moments = FactorsOf(path.sums, 1);
  const auto& [squares, factors, ofLight] = moments;
  if (!isCounted) {
    for (size_t k = 0; k < kCandidates; ++k) here.missing[k] += squares[k] > 0 ? 0 : weighted;
    return;
  }
  for (size_t k = 0; k < kCandidates; ++k) {
    here.square[k] += weighted * value * factors[k];
    here.ofLight[k] += weighted * value * factors[k] * ofLight[k];
    here.missing[k] += squares[k] > 0 ? 0 : weighted;
  }
  for (size_t k = 1; k < kCandidates; ++k)
    if (Merges(k) && squares[WithoutMerging(k)] == 0) here.mergedOnly[k] += weighted * value * factors[k];
  KeepRare(path, value, pixel_, moments);
  const TechniqueGroup own = GroupOf(path);
  Found& found = pixels_.found[pixel_];
  if (const double bySplats = path.sums.Of(TechniqueGroup::Light).squares; bySplats < known) {
    // Expected value by the candidate's techniques of camera paths, if the pilot had no splats.
    const double byOthers = weighted * known / (known - bySplats), often = bySplats < 0.5 * known ? 1.0 : 0.0;
    for (size_t k = 0; k < kCandidates; ++k) {
      const double light = kCounts.light[k], ofCamera = 1 - light * light * bySplats / squares[k];
      const double value = squares[k] > 0 ? byOthers * ofCamera : 0;
      found.value[k] += static_cast<float>(value);
      found.oftener[k] += static_cast<float>(often * value);
    }
  }
  const bool isConnected = own == TechniqueGroup::Connect, isBeyond = path.sums.isBeyond;
  const PerCandidate* const counts = isConnected                    ? &kCounts.connect
                                     : own == TechniqueGroup::Merge ? &kCounts.merge
                                                                    : nullptr;
  Sum& all = isBeyond ? (isConnected ? sums_.connectedBeyond : sums_.unconnectedBeyond)
                      : (isConnected ? sums_.connected : sums_.unconnected);
  PerCandidate reweighted;
  for (size_t k = 0; k < kCandidates; ++k) {
    const double ofOwn = (counts ? (*counts)[k] : 1.0) * (isBeyond ? kCounts.continuing[k] : 1.0);
    reweighted[k] = squares[k] > 0 ? weighted * known * ofOwn * ofOwn / squares[k] : 0;  // w = r² / Σ r²
    all.value[k] += reweighted[k];
    all.squares[k] += reweighted[k] * reweighted[k];
  }
  if (isConnected)
    for (size_t k = 0; k < kCandidates; ++k) found.connected[k] += static_cast<float>(reweighted[k]);
  if (!path.isMerged || path.t != 2) return;
  for (size_t k = 0; k < kCandidates; ++k)
    if (kCounts.merge[k] > 0 && squares[k] > 0)
      here.products[k] += 2 * reweighted[k] * SplatOf(path, value, kCounts.merge[k], squares[k]) / kCounts.merge[k];
}

double Recorder::SplatOf(const ConnectedPath& path, double value, double lightPaths, double squares) const {
  const double splatSquare = path.sums.Of(TechniqueGroup::Light).squares;
  if (!(splatSquare > 0)) return 0;
  const double pixels = std::sqrt(splatSquare) / splatCount_;  // area of a pixel in that of the disc of merging
  const double overlap = 1 / (spread_ + 1 / pixels);           // exact for discs far smaller or larger than a pixel
  return overlap * lightPaths * lightPaths * splatSquare / squares * value / pixels;
}

Records::Records(const Grid& grid, const PixelFilter& filter, double splatCount, bool countsSeen, int chunks,
                 int mostPasses)
    : grid_(grid), squaredMeans_(kCandidates * static_cast<size_t>(grid.Pixels())) {
  const auto pixels = static_cast<size_t>(grid.Pixels());
  pixels_.moments.resize(pixels);
  pixels_.found.resize(pixels);
  recorders_.reserve(static_cast<size_t>(chunks));
  for (int chunk = 0; chunk < chunks; ++chunk) {
    recorders_.emplace_back(grid, filter, splatCount, countsSeen, mostPasses, pixels_,
                            static_cast<size_t>(BeginOfChunk(grid.Pixels(), chunk, chunks)),
                            static_cast<size_t>(BeginOfChunk(grid.Pixels(), chunk + 1, chunks)));
  }
}

void Records::EndPass(uint32_t pass) {
  for (Recorder& recorder : recorders_) recorder.EndPass();
  std::vector<Found>& found = pixels_.found;
  for (size_t i = 0; i < found.size() && pass % 2 == 1; ++i) {
    for (size_t k = 0; k < kCandidates; ++k) {
      SquaredMean& squared = squaredMeans_[kCandidates * i + k];
      squared.value += 2 * static_cast<double>(last_[i].value[k]) * static_cast<double>(found[i].value[k]);
      squared.connected += 2 * static_cast<double>(last_[i].connected[k]) * static_cast<double>(found[i].connected[k]);
      squared.oftener += 2 * static_cast<double>(last_[i].oftener[k]) * static_cast<double>(found[i].oftener[k]);
    }
  }
  std::swap(last_, found);
  found.assign(last_.size(), {});
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
  std::vector<Moments> pixels = pixels_.moments;
  const Brightness brightness = BrightnessOf(pixels, passes);
  if (!(brightness.mean > 0)) return false;
  meanLight_ = brightness.mean;
  meanUnseen_ = 0;
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
  for (size_t k = 0; k < candidates.size(); ++k) {
    const double ofLight = PartOfLight(k, brightness, pixels, isLeftOut);
    const double ofCamera = GainOfSobol(candidates[WithFewestSamples(k)].error);
    gains[k] = isSobol ? 1 / ((1 - ofLight) / ofCamera + ofLight / std::min(kGainOfSobolForLight, ofCamera)) : 1.0;
  }
  for (size_t k = 0; k < candidates.size(); ++k) {
    PilotCandidate& candidate = candidates[k];
    for (double& error : candidate.tileErrors) error /= gains[k];
    for (double& error : candidate.tileMergedOnly) error /= gains[k];
    for (double& variance : candidate.tileVariances) variance /= gains[k] * gains[k];
    candidate.uncertainty /= gains[k];
    candidate.error = std::max(candidate.error / gains[k], least_);
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
    if (n > 1) {  // else it is unknown, and is taken to be as large as the error
      variance -= candidate.tileErrors[tile] * candidate.tileErrors[tile] / n;
      variance = std::max(variance * n / (n - 1), 0.0);
    }
    variances += variance;
  }
  candidate.uncertainty = std::sqrt(variances);
}

double Records::PartOfLight(size_t k, const Brightness& brightness, const std::vector<Moments>& pixels,
                            const std::vector<char>& isLeftOut) {
  double all = 0, ofLight = 0;
  for (size_t i = 0; i < pixels.size(); ++i) {
    if (isLeftOut[i]) continue;
    all += brightness.scales[i] * pixels[i].square[k];
    ofLight += brightness.scales[i] * pixels[i].ofLight[k];
  }
  return all > 0 ? std::clamp(ofLight / all, 0.0, 1.0) : 0.0;
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
    if (event.expected >= passes) continue;  // a typical render is expected to hold it
    expected += event.expected / passes;
    missing += event.light;
    if (expected > 1 || missing > most) return;
    pixels[event.pixel].square[k] -= event.square;
    pixels[event.pixel].ofLight[k] -= event.square * event.ofLight;
    pixels[event.pixel].missing[k] += event.light;
  }
}

}  // namespace lampyr::pilot
