#include "render/analysis/pilot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <tuple>

#include "base/parallel.h"
#include "integrators/bidirectional/connected_path.h"
#include "integrators/photon/emission_learning.h"
#include "integrators/photon/photon_pass.h"
#include "integrators/photon/photon_store.h"
#include "integrators/registry.h"
#include "render/settings/integrator_choice.h"

namespace lampyr {

namespace {

constexpr int kTile = kPilotTile, kChunks = 8;
// Longer paths hold little of the light, and without a limit a closed box of mirrors would keep the pilot for hours.
constexpr int64_t kMostEvents = 20;
constexpr uint64_t kMostLightPaths = 4 * kMostPilotPixels;
// The radius is that of the average pass of so many.
constexpr double kTypicalPasses = 64;
constexpr uint64_t kSeed = 0x9e3779b97f4a7c15;

struct Candidate {
  const char* integrator;
  int log2LightPaths;
  // Samples of each TechniqueGroup per camera path, relative to those of the pilot.
  std::array<double, kTechniqueGroups> counts;
  // Squared error of independent samples over that of Sobol points, as measured in scenes of scenes/ with 64 samples
  // per pixel. More techniques make smoother integrands, and fewer light paths leave fewer points to be well
  // distributed.
  double gainOfSobol;
};
constexpr Candidate Bidirectional(bool merges, int log2LightPaths) {
  const double n = log2LightPaths < 0 ? 1.0 / (1 << -log2LightPaths) : 1 << log2LightPaths;
  constexpr std::array<double, 6> gains = {1.8, 1.87, 1.95, 2.0, 1.95, 1.9};
  return {merges ? "vcm" : "bdpt",
          log2LightPaths,
          {1, 1, n, std::min(n, 1.0), merges ? n : 0.0},
          gains[static_cast<size_t>(log2LightPaths + 3)]};
}
constexpr size_t kCandidates = 13, kFirstOfVcm = 7;
constexpr double kFewestLightPaths = 1.0 / 8;
// The least variance that is told apart, in parts of the squared mean, for n samples: second moment and mean are both
// estimated from them. Candidates with less are equally good, and the cheapest of them is chosen.
double LeastVariance(double samples) {
  return 2.2 / std::sqrt(samples);
}
constexpr std::array<Candidate, kCandidates> kCandidateOf = {{
    {"path", 0, {1, 1, 0, 0, 0}, 1.7},
    Bidirectional(false, -3),
    Bidirectional(false, -2),
    Bidirectional(false, -1),
    Bidirectional(false, 0),
    Bidirectional(false, 1),
    Bidirectional(false, 2),
    Bidirectional(true, -3),
    Bidirectional(true, -2),
    Bidirectional(true, -1),
    Bidirectional(true, 0),
    Bidirectional(true, 1),
    Bidirectional(true, 2),
}};

// Light that a candidate finds rarely, and bright.
struct RareEvent {
  uint32_t pixel;
  float value;     // of one occurrence
  float expected;  // occurrences in a typical render
  float light;     // what it adds to the mean of the pixel, summed over the pilot's samples
  float square;    // to its second moment
};
// A candidate finds it less often than the pilot by this factor.
constexpr double kRare = 16;
// Of a typical render. Events that it is expected to hold less than once are not in its error, but light that is
// missing.
constexpr double kTypicalSamples = 1 << 21;

// Sums over the samples of a pixel.
struct Moments {
  double seen = 0, mean = 0;                   // light that is seen itself, and all other
  std::array<double, kCandidates> square{};    // second moments of single paths
  std::array<double, kCandidates> products{};  // of different paths of one sample
  std::array<double, kCandidates> missing{};

  void operator+=(const Moments& other) {
    seen += other.seen;
    mean += other.mean;
    for (size_t k = 0; k < kCandidates; ++k) {
      square[k] += other.square[k];
      products[k] += other.products[k];
      missing[k] += other.missing[k];
    }
  }
};

// Contributions of the camera path of one pixel in one pass, for each candidate.
struct Found {
  std::array<float, kCandidates> seen{}, other{};  // a light that the pixel sees itself; all other light

  void operator+=(const Found& more) {
    for (size_t k = 0; k < kCandidates; ++k) {
      seen[k] += more.seen[k];
      other[k] += more.other[k];
    }
  }
};

TechniqueGroup GroupOf(const ConnectedPath& path) {
  if (path.isMerged) return TechniqueGroup::Merge;
  if (path.connection) return TechniqueGroup::Light;
  return path.s == 0 ? TechniqueGroup::Hit : path.s == 1 ? TechniqueGroup::Next : TechniqueGroup::Connect;
}

// The pilot's pixels, and where they are on the film.
struct Grid {
  int width, height, tilesX, tilesY;
  Point2 pixel;  // size of a pixel on the film

  explicit Grid(const RenderSettings& settings) {
    const double scale = std::min(1.0, std::sqrt(kMostPilotPixels / (static_cast<double>(settings.width) *
                                                                     static_cast<double>(settings.height))));
    const auto side = [scale](int full, int most) {
      return static_cast<int>(std::clamp(std::lround(scale * full), 1L, static_cast<long>(most)));
    };
    width = side(settings.width, kMostPilotPixels);
    height = side(settings.height, kMostPilotPixels / width);
    tilesX = (width + kTile - 1) / kTile;
    tilesY = (height + kTile - 1) / kTile;
    pixel = {static_cast<float>(settings.width) / static_cast<float>(width),
             static_cast<float>(settings.height) / static_cast<float>(height)};
  }
  int Pixels() const { return width * height; }
  size_t Tiles() const { return static_cast<size_t>(tilesX) * static_cast<size_t>(tilesY); }
  size_t PixelOf(int x, int y) const {
    return static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x);
  }
  size_t TileOf(int x, int y) const {
    return static_cast<size_t>(y / kTile) * static_cast<size_t>(tilesX) + static_cast<size_t>(x / kTile);
  }
  // All tiles are of one size on the film; the last may reach beyond its edge.
  Point2 FilmOfTiles() const {
    return {static_cast<float>(tilesX * kTile) * pixel.x, static_cast<float>(tilesY * kTile) * pixel.y};
  }
  double PartOf(size_t tile) const { return static_cast<double>(PixelsOf(tile)) / Pixels(); }
  int PixelsOf(size_t tile) const {
    const int x = static_cast<int>(tile) % tilesX * kTile, y = static_cast<int>(tile) / tilesX * kTile;
    return std::min(kTile, width - x) * std::min(kTile, height - y);
  }
};

// Adds up the moments of the paths of one chunk.
class Recorder final : public PathObserver {
 public:
  // `spread`: pixels among which a splat is divided (PixelFilter::SplatCount). `splatCount`: that of the weights.
  Recorder(const Grid& grid, double filmPixels, double spread, double splatCount, int passes)
      : moments(static_cast<size_t>(grid.Pixels())),
        found(static_cast<size_t>(grid.Pixels())),
        grid_(grid),
        filmPixels_(filmPixels),
        spread_(spread),
        splatCount_(splatCount),
        renders_(kTypicalSamples / (static_cast<double>(passes) * grid.Pixels())) {}

  void StartSample(int x, int y, float weight) {
    pixel_ = grid_.PixelOf(x, y);
    weight_ = static_cast<double>(weight);
    sums_ = {};
  }
  // A sample is the sum of all paths that one camera path makes. Its square has the products of different paths,
  // besides the squares of each.
  void EndSample() {
    for (size_t k = 0; k < kCandidates; ++k) {
      const Sums& sums = sums_[k];
      moments[pixel_].products[k] += sums.value * sums.value - sums.squares + 2 * sums.value * sums.connected +
                                     (sums.connected * sums.connected - sums.connectedSquares) /
                                         std::max(kCandidateOf[k].counts[3], kFewestLightPaths);
      found[pixel_].other[k] += static_cast<float>(sums.value + sums.connected);
    }
  }
  bool WantsSums() const override { return true; }
  void Observe(const ConnectedPath& path) override {
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
  void ObserveMerge(const ConnectedPath& path, const Photon&) override { Observe(path); }

  // One entry for each pixel; `found` is of the current pass.
  std::vector<Moments> moments;
  std::vector<Found> found;
  std::array<std::vector<RareEvent>, kCandidates> rare;

 private:
  void Add(const ConnectedPath& path, double value, size_t pixel) {
    Moments& here = moments[pixel];
    const bool isSeen = path.s + path.t == 2;
    const double weighted = path.weight * value;
    if (!std::isfinite(weighted)) return;
    (isSeen ? here.seen : here.mean) += weighted;
    const double spread = path.connection ? spread_ : 1.0;
    double known = 0;
    for (const TechniqueSums::Group& group : path.sums.groups) known += group.squares;
    if (!(known > 0)) {
      // Not known how else it could be found: as if all candidates did it like this.
      for (size_t k = 0; k < kCandidates; ++k) {
        here.square[k] += weighted * value / spread;
        if (!path.connection) {
          sums_[k].value += weighted;
          sums_[k].squares += weighted * weighted;
        }
      }
      return;
    }
    const auto own = static_cast<size_t>(GroupOf(path));
    for (size_t k = 0; k < kCandidates; ++k) {
      const auto& counts = kCandidateOf[k].counts;
      double squares = 0, cubes = 0;
      for (size_t g = 0; g < kTechniqueGroups; ++g) {
        const double squared = counts[g] * counts[g];
        squares += squared * path.sums.groups[g].squares;
        cubes += squared * counts[g] * path.sums.groups[g].cubes;
      }
      const double factor = cubes / (squares * squares * (path.connection ? splatCount_ : 1.0));
      if (!std::isfinite(factor) || !(squares > 0)) {
        here.missing[k] += weighted;
        continue;
      }
      here.square[k] += weighted * value * factor;
      if (factor > kRare)
        rare[k].push_back({static_cast<uint32_t>(pixel), static_cast<float>(value * factor),
                           static_cast<float>(renders_ * path.weight / factor), static_cast<float>(weighted),
                           static_cast<float>(weighted * value * factor)});
      if (path.connection || counts[own] == 0) continue;
      const double reweighted = weighted * known * counts[own] * counts[own] / squares;  // w = r² / Σ r²
      if (isSeen) {
        found[pixel].seen[k] += static_cast<float>(reweighted);
        continue;
      }
      if (path.isMerged && path.t == 2)
        here.products[k] += 2 * reweighted * SplatOf(path, value, counts[own], squares) / counts[own];
      const bool isConnected = GroupOf(path) == TechniqueGroup::Connect;
      (isConnected ? sums_[k].connected : sums_[k].value) += reweighted;
      (isConnected ? sums_[k].connectedSquares : sums_[k].squares) += reweighted * reweighted;
    }
  }

  // What the light path of a photon that is merged at a first hit adds to the same pixel by its connection to the lens,
  // on average: the same light path, counted twice. `squares`: Σ (n r)².
  double SplatOf(const ConnectedPath& path, double value, double lightPaths, double squares) const {
    const double splatSquare = path.sums.Of(TechniqueGroup::Light).squares;
    if (!(splatSquare > 0)) return 0;
    const double pixels = std::sqrt(splatSquare) / splatCount_;  // area of a pixel in that of the disc of merging
    const double overlap = 1 / (spread_ + 1 / pixels);           // exact for discs far smaller or larger than a pixel
    return overlap * lightPaths * lightPaths * splatSquare / squares * value / pixels;
  }

  const Grid& grid_;
  double filmPixels_, weight_ = 1;
  double spread_, splatCount_;
  double renders_;  // typical renders for each of the pilot's samples
  size_t pixel_ = 0;
  // Connections have their own sums, because only samples with a light path make them.
  struct Sums {
    double value = 0, squares = 0, connected = 0, connectedSquares = 0;
  };
  std::array<Sums, kCandidates> sums_;  // of the current camera path
};

// Passes of an integrator over the pilot's pixels.
class PilotPasses {
 public:
  PilotPasses(const RenderScene& scene, const RenderSettings& settings, const Grid& grid, int threads, uint32_t passes)
      : scene_(scene), settings_(settings), grid_(grid), threads_(threads), passes_(passes), photons_(kChunks) {}

  // Traces the photons of a pass; where the integrator gathers none, it has none.
  void TracePhotons(const Integrator& integrator, PhotonStore& store, uint32_t pass) {
    const auto paths = static_cast<int>(std::min<uint64_t>(store.LightPaths(), kMostLightPaths));
    ForEachPixel(paths, [&](size_t chunk, int x, int y, Sampler& sampler, RenderCounts& counts, SplatList& splats) {
      sampler.StartPixelSample(x, y, pass + passes_);
      photons_[chunk].StartPath();
      SampleContext context{scene_, sampler, Time(pass), counts};
      context.splats = &splats;
      context.photons = &photons_[chunk];
      context.isForPhotonsAlone = true;
      integrator.Sample(nullptr, context);
    });
    store.Take(photons_);
    store.Finish(pass);
  }
  // One sample of every pixel; `recorders`, one for each chunk, may be empty.
  RenderCounts Trace(const Integrator& integrator, uint32_t pass, const PhotonPass* gather,
                     std::vector<Recorder>& recorders) {
    return ForEachPixel(grid_.Pixels(), [&](size_t chunk, int x, int y, Sampler& sampler, RenderCounts& counts,
                                            SplatList& splats) {
      // Two passes have the same point of the film: what a pixel of the pilot holds of texture and edges is not noise.
      sampler.StartPixelSample(x, y, pass / 2);
      sampler.SetDimension(dimensions::kFilm);
      const Point2 u = sampler.Get2D();
      sampler.StartPixelSample(x, y, pass);
      SampleContext context{scene_, sampler, Time(pass), counts};
      context.splats = integrator.Paths() == TracedPaths::Camera ? nullptr : &splats;
      context.gather = gather;
      const Point2 film((static_cast<float>(x) + u.x) * grid_.pixel.x, (static_cast<float>(y) + u.y) * grid_.pixel.y);
      sampler.SetDimension(dimensions::kLens);
      const CameraRay ray = scene_.camera->GenerateRay(film, sampler.Get2D(), context.time);
      if (!recorders.empty()) {
        context.observer = &recorders[chunk];
        recorders[chunk].StartSample(x, y, ray.weight);
      }
      const bool isVignetted = ray.weight == 0;
      if (!isVignetted || integrator.Paths() != TracedPaths::Camera)
        integrator.Sample(isVignetted ? nullptr : &ray.ray, context);
      if (!recorders.empty()) recorders[chunk].EndSample();
    });
  }

 private:
  float Time(uint32_t pass) const {
    return scene_.hasMotion ? (static_cast<float>(pass) + 0.5f) / static_cast<float>(passes_) : 0.0f;
  }
  // `count`: of the pixels, or more, with further rows.
  template <class Body>
  RenderCounts ForEachPixel(int count, const Body& body) {
    std::vector<RenderCounts> counts(kChunks);
    ParallelFor(kChunks, threads_, [&](int chunk) {
      const auto index = static_cast<size_t>(chunk);
      Sampler sampler(settings_.sampler, kSeed);
      // Splats are not kept, but connections that reach no pixel are not made.
      SplatList splats({0, 0}, {static_cast<float>(settings_.width), static_cast<float>(settings_.height)}, 1);
      const auto begin = [&](int of) { return static_cast<int>(int64_t{count} * of / kChunks); };
      for (int i = begin(chunk); i < begin(chunk + 1); ++i) {
        splats.Clear();
        splats.StartPath();
        body(index, i % grid_.width, i / grid_.width, sampler, counts[index], splats);
      }
    });
    RenderCounts total;
    for (const RenderCounts& part : counts) total += part;
    return total;
  }

  const RenderScene& scene_;
  const RenderSettings& settings_;
  const Grid& grid_;
  int threads_;
  uint32_t passes_;
  std::vector<PhotonList> photons_;
};

// Unit costs in nanoseconds, fitted to the times of path, bdpt, vcm and sppm in 21 scenes (scripts/fit_costs.py). The
// ratio of two integrators' costs in one scene is off by 10 % typically, and by a third at most.
struct Costs {
  double ray = 260, shadowRay = 350, connection = 530, lookup = 250, found = 200, stored = 340;
};

struct Counted {
  RenderCounts path, bdpt, vcm;
  uint64_t stored = 0;  // photons of a pass of vcm
};

// The costs of a sample of a candidate, in two parts.
struct CandidateCost {
  double paths = 0, merging = 0;  // merging in all of the picture; what storing photons costs is in `paths`
};

// Measured with 1/8 to 2 light paths for each camera path, in six scenes: the weights of bidirectional techniques make
// a camera path so many times as costly, and the rest of a light path and its connections costs so much of what rays
// cost on their own.
constexpr double kCameraPathWithWeights = 1.12, kSideBySide = 0.75;

std::array<CandidateCost, kCandidates> CostsOf(const Counted& counted, double samples) {
  constexpr Costs costs;
  const auto rays = [](const RenderCounts& counts) {
    return static_cast<double>(counts.cameraRays + counts.indirectRays);
  };
  const double direct = static_cast<double>(counted.path.shadowRays);
  const double path = costs.ray * rays(counted.path) + costs.shadowRay * direct;
  const double lightRays = std::max(rays(counted.bdpt) - rays(counted.path), 0.0);
  const double more = std::max(static_cast<double>(counted.bdpt.shadowRays) - direct, 0.0);
  // Nearly each ray of a light path ends at a vertex that is connected to the lens.
  const double splats = std::min(more, lightRays);
  const double light = costs.ray * lightRays + costs.connection * splats;
  const double connections = costs.connection * (more - splats);
  std::array<CandidateCost, kCandidates> all{};
  for (size_t k = 0; k < kCandidates; ++k) {
    const Candidate& candidate = kCandidateOf[k];
    const double n = candidate.counts[static_cast<size_t>(TechniqueGroup::Light)];
    all[k].paths = (n > 0 ? kCameraPathWithWeights * path : path) / samples;
    all[k].paths += kSideBySide * (n * light + std::min(n, 1.0) * connections) / samples;
    if (candidate.counts[static_cast<size_t>(TechniqueGroup::Merge)] == 0) continue;
    all[k].paths += costs.stored * n * static_cast<double>(counted.stored) / samples;
    all[k].merging = (costs.lookup * static_cast<double>(counted.vcm.lookups) +
                      costs.found * n * static_cast<double>(counted.vcm.foundPhotons)) /
                     samples;
  }
  return all;
}

// Combines the records of all chunks into the errors of the candidates.
class Records {
 public:
  Records(const Grid& grid, std::vector<Recorder>& recorders)
      : grid_(grid), recorders_(recorders), squaredMeans_(kCandidates * static_cast<size_t>(grid.Pixels())) {}

  // After each pass. The square of a mean is estimated by the product of what two passes have found, which are
  // independent: of lights that a pixel sees itself at different points of the film, of all other light at the same.
  void EndPass(uint32_t pass) {
    std::vector<Found> found(recorders_[0].found.size());
    for (Recorder& recorder : recorders_) {
      for (size_t i = 0; i < found.size(); ++i) found[i] += std::exchange(recorder.found[i], Found());
    }
    for (size_t i = 0; i < found.size(); ++i) {
      for (size_t k = 0; k < kCandidates; ++k) {
        const auto product = [](float a, float b) { return static_cast<double>(a) * static_cast<double>(b); };
        SquaredMeans& means = squaredMeans_[kCandidates * i + k];
        if (pass % 2 == 1) means.other += 2 * product(last_[i].other[k], found[i].other[k]);
        if (pass > 1) means.seen += product(beforeLast_[i].seen[k], found[i].seen[k]);
      }
    }
    if (pass > 1) ++seenPairs_;
    beforeLast_ = std::exchange(last_, std::move(found));
  }

  // The sum over all passes. False: no light was found.
  bool SetErrors(int passes, bool isSobol, std::vector<PilotCandidate>& candidates, double& least) const {
    std::vector<Moments> pixels(squaredMeans_.size() / kCandidates);
    for (const Recorder& recorder : recorders_) {
      for (size_t i = 0; i < pixels.size(); ++i) pixels[i] += recorder.moments[i];
    }
    // The brightness of a pixel is that of its tile, and of the light that it sees itself.
    std::vector<double> tiles(grid_.Tiles());
    double mean = 0, seen = 0;
    ForEachPixel([&](size_t pixel, size_t tile) {
      tiles[tile] += pixels[pixel].mean / (passes * grid_.PixelsOf(tile));
      mean += pixels[pixel].mean / (passes * grid_.Pixels());
      seen += pixels[pixel].seen / (passes * grid_.Pixels());
    });
    if (!(mean + seen > 0)) return false;
    std::vector<double> scales(pixels.size());
    ForEachPixel([&](size_t pixel, size_t tile) {
      const double brightness = tiles[tile] + pixels[pixel].seen / passes;
      scales[pixel] = 1 / ((brightness * brightness + 0.01 * (mean + seen) * (mean + seen)) * passes);
    });
    for (size_t k = 0; k < candidates.size(); ++k) {
      LeaveOutRare(k, passes, mean + seen, scales, pixels);
      PilotCandidate& candidate = candidates[k];
      candidate.secondMoments.resize(grid_.Tiles());
      candidate.tileErrors.resize(grid_.Tiles());
      candidate.tileMissing.resize(grid_.Tiles());
      double squares = 0, squaredMeans = 0, squaredBrightness = 0;
      ForEachPixel([&](size_t pixel, size_t tile) {
        const Moments& here = pixels[pixel];
        const double brightness = tiles[tile] + here.seen / passes;
        const double scale = scales[pixel];
        const double square = scale * (here.square[k] + here.products[k]);
        const SquaredMeans& means = squaredMeans_[kCandidates * pixel + k];
        const double squaredMean = scale * (means.other + (seenPairs_ > 0 ? means.seen * passes / seenPairs_ : 0.0));
        squares += square;
        squaredBrightness += scale * passes * brightness * brightness;
        squaredMeans += squaredMean;
        candidate.tileErrors[tile] += (square - squaredMean) / grid_.Pixels();
        candidate.secondMoments[tile] += here.square[k] / (passes * grid_.PixelsOf(tile));
        candidate.tileMissing[tile] += here.missing[k] / (passes * grid_.Pixels() * (mean + seen));
      });
      for (const double missing : candidate.tileMissing) candidate.missing += missing;
      const double gain = isSobol ? kCandidateOf[k].gainOfSobol : 1.0;
      for (double& error : candidate.tileErrors) error /= gain;
      least = LeastVariance(passes * grid_.Pixels()) * squaredBrightness / grid_.Pixels();
      candidate.error = std::max((squares - squaredMeans) / (gain * grid_.Pixels()), least);
    }
    return true;
  }

 private:
  // Moves the brightest events of candidate `k` out of its second moments, as far as a typical render is expected to
  // hold less than one of them and they are a negligible part of the light.
  void LeaveOutRare(size_t k, int passes, double mean, const std::vector<double>& scales,
                    std::vector<Moments>& pixels) const {
    std::vector<RareEvent> events;
    for (const Recorder& recorder : recorders_)
      events.insert(events.end(), recorder.rare[k].begin(), recorder.rare[k].end());
    const auto relative = [&](const RareEvent& event) {
      return static_cast<double>(event.value) * static_cast<double>(event.value) * scales[event.pixel];
    };
    std::sort(events.begin(), events.end(), [&](const RareEvent& a, const RareEvent& b) {
      const double first = relative(a), second = relative(b);
      return first != second ? first > second : std::tie(a.pixel, a.light) < std::tie(b.pixel, b.light);
    });
    double expected = 0, light = 0;
    for (const RareEvent& event : events) {
      expected += static_cast<double>(event.expected);
      light += static_cast<double>(event.light) / (passes * grid_.Pixels() * mean);
      if (expected > 1 || light > 0.5 * kNegligibleLight) return;
      pixels[event.pixel].square[k] -= static_cast<double>(event.square);
      pixels[event.pixel].missing[k] += static_cast<double>(event.light);
    }
  }
  template <class Body>
  void ForEachPixel(const Body& body) const {
    for (int y = 0; y < grid_.height; ++y) {
      for (int x = 0; x < grid_.width; ++x) body(grid_.PixelOf(x, y), grid_.TileOf(x, y));
    }
  }

  const Grid& grid_;
  std::vector<Recorder>& recorders_;
  std::vector<Found> last_, beforeLast_;  // in the passes before
  struct SquaredMeans {
    double other = 0, seen = 0;
  };
  std::vector<SquaredMeans> squaredMeans_;  // Σ over the passes, by pixel and candidate
  int seenPairs_ = 0;
};

// For the pilot.
RenderSettings WithAllTechniques(const RenderSettings& settings) {
  RenderSettings all = settings;
  all.integrator = "vcm";
  all.values.Set("merge", true);
  all.values.Set("connect", true);
  all.values.Set("max-depth", std::min<int64_t>(all.values.Integer("max-depth"), kMostEvents));
  return all;
}

// The mean over the 3 × 3 tiles around each, `times` times.
std::vector<double> Blurred(std::vector<double> values, const Grid& grid, int times) {
  for (int i = 0; i < times; ++i) {
    std::vector<double> blurred(values.size());
    for (int y = 0; y < grid.tilesY; ++y) {
      for (int x = 0; x < grid.tilesX; ++x) {
        double sum = 0;
        int count = 0;
        for (int v = std::max(y - 1, 0); v <= std::min(y + 1, grid.tilesY - 1); ++v) {
          for (int u = std::max(x - 1, 0); u <= std::min(x + 1, grid.tilesX - 1); ++u, ++count)
            sum += values[static_cast<size_t>(v) * static_cast<size_t>(grid.tilesX) + static_cast<size_t>(u)];
        }
        blurred[static_cast<size_t>(y) * static_cast<size_t>(grid.tilesX) + static_cast<size_t>(x)] = sum / count;
      }
    }
    values = std::move(blurred);
  }
  return values;
}

// Where to merge. Σ error · Σ cost is least where in each tile that choice is made which has the least e/E + c/C, with
// E and C the sums of all choices.
//
// Where only merging finds some of the light, it merges always, and now and then everywhere else, so that the mean is
// right wherever the pilot has seen nothing of that light.
//
// `none`, `all`: the same light paths without merging and with it everywhere. Null: everywhere or nowhere is better.
std::optional<PilotCandidate> MergingInParts(const PilotCandidate& none, const PilotCandidate& all,
                                             const CandidateCost& cost, const Grid& grid, double least) {
  constexpr int kBlurs = 2, kRounds = 8;
  constexpr double kWorthIt = 0.97, kNowAndThen = 1.0 / 16;
  const bool mustMerge = none.missing > kNegligibleLight;
  const std::vector<double> missing = Blurred(none.tileMissing, grid, 1);
  const std::vector<double> without = Blurred(none.tileErrors, grid, kBlurs),
                            with = Blurred(all.tileErrors, grid, kBlurs);
  if (none.error <= least || all.error <= least) return std::nullopt;
  double error = all.error, part = 1;
  std::vector<double> merges(grid.Tiles());
  for (int round = 0; round < kRounds; ++round) {
    const double perError = 1 / error, perCost = cost.merging / (cost.paths + part * cost.merging);
    error = part = 0;
    for (size_t i = 0; i < grid.Tiles(); ++i) {
      const bool isWorthIt = (without[i] - with[i]) * perError > perCost * grid.PartOf(i);
      merges[i] = isWorthIt || (mustMerge && missing[i] > 0) ? 1.0 : 0.0;
      error += merges[i] > 0 ? with[i] : without[i];
      part += merges[i] * grid.PartOf(i);
    }
    if (!(error > 0)) return std::nullopt;
  }
  // Wider by a tile, with a soft edge: the pilot sees a tile by a few samples.
  for (double& value : merges = Blurred(std::move(merges), grid, 1))
    value = std::clamp(3 * value, mustMerge ? kNowAndThen : 0.0, 1.0);
  PilotCandidate mixed = all;
  mixed.error = part = 0;
  std::vector<float> mask;
  for (size_t i = 0; i < grid.Tiles(); ++i) {
    mixed.tileErrors[i] = merges[i] * all.tileErrors[i] + (1 - merges[i]) * none.tileErrors[i];
    mixed.error += mixed.tileErrors[i];
    part += merges[i] * grid.PartOf(i);
    mask.push_back(static_cast<float>(merges[i]));
  }
  if (!(part > 0)) return std::nullopt;
  mixed.error = std::max(mixed.error, least);
  mixed.cost = cost.paths + part * cost.merging;
  mixed.counts.merging = FilmMask(grid.tilesX, grid.tilesY, grid.FilmOfTiles(), std::move(mask));
  const double best = mustMerge ? all.ErrorTimesCost() : std::min(none.ErrorTimesCost(), all.ErrorTimesCost());
  if (mixed.ErrorTimesCost() > kWorthIt * best) return std::nullopt;
  return mixed;
}

std::unique_ptr<Integrator> Make(const char* name, const RenderScene& scene, const RenderSettings& settings) {
  return IntegratorOf(name).create({scene, settings.width, settings.height, settings.sensor.ImagingRatio(),
                                    settings.values, nullptr, SplatCount(settings)});
}

}  // namespace

const PilotCandidate* RenderPilot::Find(const std::string& integrator, int log2LightPaths) const {
  for (const PilotCandidate& candidate : candidates) {
    if (candidate.integrator == integrator && candidate.counts.log2LightPaths == log2LightPaths &&
        candidate.counts.merging.Mean() == 1)
      return &candidate;
  }
  return nullptr;
}

const PilotCandidate* RenderPilot::Best() const {
  const PilotCandidate* best = nullptr;
  for (const PilotCandidate& candidate : candidates) {
    if (candidate.missing > kNegligibleLight) continue;
    if (!best || candidate.ErrorTimesCost() < best->ErrorTimesCost()) best = &candidate;
  }
  // Path tracing is the plainest, and the estimates are no better than this.
  constexpr double kMargin = 1.05;
  const PilotCandidate* path = Find("path");
  const bool isClose =
      best && path && path->missing <= kNegligibleLight && path->ErrorTimesCost() < kMargin * best->ErrorTimesCost();
  return isClose ? path : best;
}

RenderPilot RunPilot(const RenderScene& scene, const RenderSettings& settings, int threads, int passCount) {
  const RenderSettings combined = WithAllTechniques(settings);
  const Grid grid(settings);
  const double filmPixels = static_cast<double>(settings.width) * static_cast<double>(settings.height);
  const double fewer = filmPixels / grid.Pixels();
  const auto path = Make("path", scene, combined), bdpt = Make("bdpt", scene, combined),
             vcm = Make("vcm", scene, combined);
  PhotonSettings photons = vcm->Photons().value();
  // If light paths hardly come near to what is seen, vcm guides them from the start. Those of bdpt are hopeless then.
  RenderScene view = scene;
  std::optional<EmissionLearning> guiding;
  if (photons.guided) guiding.emplace(scene, settings.width, settings.height);
  const bool isGuided = guiding && guiding->Guide();
  if (isGuided)
    view.lighting = std::make_shared<const LightingServices>(scene.lighting->With(nullptr, guiding->Guide()));
  if (photons.lightPaths > 0)
    photons.lightPaths = std::max<uint64_t>(1, static_cast<uint64_t>(static_cast<double>(photons.lightPaths) / fewer));
  // With fewer light paths the same number of photons is found within a larger radius.
  const double shrunk = std::pow(kTypicalPasses, photons.alpha - 1) / photons.alpha;
  const auto wider = static_cast<float>(std::sqrt(fewer * std::min(shrunk, 1.0)));
  PhotonStore store(photons, static_cast<uint64_t>(grid.Pixels()), nullptr);
  PilotPasses passes(view, combined, grid, threads, static_cast<uint32_t>(passCount));
  const double spread = PixelFilter(settings.filter).SplatCount();
  std::vector<Recorder> recorders(kChunks, Recorder(grid, filmPixels, spread, SplatCount(settings), passCount)), none;
  Records records(grid, recorders);
  Counted counted;
  for (uint32_t pass = 0; pass < static_cast<uint32_t>(passCount); ++pass) {
    passes.TracePhotons(*vcm, store, pass);
    PhotonPass gather = store.Open(pass, threads);
    gather.radiusScale = wider;
    gather.radius = static_cast<float>(photons.radius) * wider;
    counted.stored += gather.map->Size();
    counted.vcm += passes.Trace(*vcm, pass, &gather, recorders);
    records.EndPass(pass);
  }
  counted.stored /= static_cast<uint64_t>(passCount);
  counted.vcm.lookups /= static_cast<uint64_t>(passCount);
  counted.vcm.foundPhotons /= static_cast<uint64_t>(passCount);
  counted.path = passes.Trace(*path, 0, nullptr, none);
  counted.bdpt = passes.Trace(*bdpt, 0, nullptr, none);
  RenderPilot pilot;
  const auto costs = CostsOf(counted, grid.Pixels());
  for (size_t k = 0; k < kCandidates; ++k) {
    PilotCandidate candidate;
    candidate.integrator = kCandidateOf[k].integrator;
    candidate.counts.log2LightPaths = kCandidateOf[k].log2LightPaths;
    candidate.cost = costs[k].paths + costs[k].merging;
    pilot.candidates.push_back(std::move(candidate));
  }
  double least = 0;  // error that is told apart
  if (!records.SetErrors(passCount, settings.sampler == SamplerKind::Sobol, pilot.candidates, least)) return {};
  for (size_t k = kFirstOfVcm; k < kCandidates; ++k) {
    const PilotCandidate& none = pilot.candidates[k - kFirstOfVcm + 1];
    if (auto mixed = MergingInParts(none, pilot.candidates[k], costs[k], grid, least))
      pilot.candidates.push_back(std::move(*mixed));
  }
  const bool hasAll = settings.values.IsOn("merge") && settings.values.IsOn("connect");
  // Light paths that are guided, or as many as the settings say, are those of vcm.
  const bool hasOwnPaths = settings.values.Integer("photons") >= 0;
  // Pixels take turns; of a few pixels some passes would have no light path.
  const bool isTiny = std::max(settings.width, settings.height) < static_cast<int>(1 / kFewestLightPaths);
  std::erase_if(pilot.candidates, [&](const PilotCandidate& candidate) {
    return (isTiny && candidate.counts.log2LightPaths < 0) || (isGuided && candidate.integrator == "bdpt") ||
           (!hasAll && candidate.integrator == "vcm") ||
           (hasOwnPaths && candidate.integrator == "vcm" && candidate.counts.log2LightPaths != 0);
  });
  return pilot;
}

}  // namespace lampyr
