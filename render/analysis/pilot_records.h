// Records of the pilot's samples, and the errors of the candidates estimated from them.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "film/pixel_filter.h"
#include "integrators/bidirectional/connected_path.h"
#include "render/analysis/pilot.h"
#include "render/analysis/pilot_candidates.h"

namespace lampyr::pilot {

// The pilot's pixels, and where they are on the film.
struct Grid {
  int width, height, tilesX, tilesY;
  Point2 pixel;       // size of a pixel on the film
  double filmPixels;  // of the render

  explicit Grid(const RenderSettings& settings) {
    const double scale = std::min(1.0, std::sqrt(kMostPilotPixels / (static_cast<double>(settings.width) *
                                                                     static_cast<double>(settings.height))));
    const auto side = [scale](int full, int most) {
      return static_cast<int>(std::clamp(std::lround(scale * full), 1L, static_cast<long>(most)));
    };
    width = side(settings.width, kMostPilotPixels);
    height = side(settings.height, kMostPilotPixels / width);
    tilesX = (width + kPilotTile - 1) / kPilotTile;
    tilesY = (height + kPilotTile - 1) / kPilotTile;
    pixel = {static_cast<float>(settings.width) / static_cast<float>(width),
             static_cast<float>(settings.height) / static_cast<float>(height)};
    filmPixels = static_cast<double>(settings.width) * static_cast<double>(settings.height);
  }
  int Pixels() const { return width * height; }
  // Pixels of the film for each of the pilot's.
  double Fewer() const { return filmPixels / Pixels(); }
  size_t Tiles() const { return static_cast<size_t>(tilesX) * static_cast<size_t>(tilesY); }
  size_t PixelOf(int x, int y) const {
    return static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x);
  }
  size_t TileOf(int x, int y) const {
    return static_cast<size_t>(y / kPilotTile) * static_cast<size_t>(tilesX) + static_cast<size_t>(x / kPilotTile);
  }
  // All tiles are of one size on the film; the last may reach beyond its edge.
  Point2 FilmOfTiles() const {
    return {static_cast<float>(tilesX * kPilotTile) * pixel.x, static_cast<float>(tilesY * kPilotTile) * pixel.y};
  }
  double PartOf(size_t tile) const { return static_cast<double>(PixelsOf(tile)) / Pixels(); }
  int PixelsOf(size_t tile) const {
    const int x = static_cast<int>(tile) % tilesX * kPilotTile, y = static_cast<int>(tile) / tilesX * kPilotTile;
    return std::min(kPilotTile, width - x) * std::min(kPilotTile, height - y);
  }
};

// Squared error of independent samples over that of Sobol points, for light found by splats and photons: the points of
// a pixel are well distributed, and those of the light paths that reach it from all over the picture are not. 1.0 to
// 1.55 for sppm in nine scenes of scenes/ and of another renderer, 64×64 with 32 samples per pixel.
inline constexpr double kGainOfSobolForLight = 1.2;

// Samples of a pixel at most.
inline constexpr int kMostPasses = 28;

// The first of `count` elements that belongs to the chunk.
inline int BeginOfChunk(int count, int chunk, int chunks) {
  return static_cast<int>(int64_t{count} * chunk / chunks);
}

// A rare and bright contribution, as a candidate finds it.
struct RareEvent {
  size_t pixel;
  double value;     // of one occurrence
  double expected;  // occurrences in a typical render, times the passes of the pilot
  double light;     // what it adds to the mean of the pixel, summed over the pilot's samples
  double square;    // to its second moment
  double ofLight;   // the part of that which splats and photons find
};
// Samples of a typical render. Events that it is expected to hold less than once are left out of a candidate's error
// and count as missing light.
inline constexpr double kTypicalSamples = 1 << 21;

// Sums over the samples of a pixel.
struct Moments {
  double seen = 0, mean = 0;                   // light that is seen itself, and all other
  std::array<double, kCandidates> square{};    // second moments of single paths
  std::array<double, kCandidates> products{};  // of different paths of one sample
  std::array<double, kCandidates> ofLight{};   // the part of `square` by splats and photons
  std::array<double, kCandidates> missing{};
  // For candidates that merge: second moments of the light that only merging finds.
  std::array<double, kCandidates> mergedOnly{};
};

// What the camera path of one pixel adds to it in one pass, for each candidate; expected values over its techniques.
struct Found {
  std::array<float, kCandidates> value{};
  std::array<float, kCandidates> oftener{};    // of that, what camera paths of the pilot find more often than splats do
  std::array<float, kCandidates> connected{};  // by connections
};

// The square of a pixel's mean, as two passes estimate it; summed over the passes.
struct SquaredMean {
  double value = 0, oftener = 0, connected = 0;  // of the sums of Found
  // `secondMoment`: the pixel's, summed over the passes. No mean is larger. A product of two samples may be: where
  // camera paths find light rarely and splats find it often, the second moment is known from the many splats, and the
  // product of two rare samples exceeds it by far. Light that camera paths find often (`oftener`) has no such samples
  // and is not limited: the bound is noisy and would make it too small.
  double Below(double secondMoment) const { return std::min(value, std::max(oftener, secondMoment)); }
  // The part of the variance that is no noise because samples take turns: the fraction `connections` of them has a
  // light path, and its mean differs from that of the rest. `squaredMean`: of the pixel.
  double OfTurns(double connections, double squaredMean) const {
    if (!(connections > 0) || connections >= 1) return 0;
    return (1 / connections - 1) * std::clamp(connected, 0.0, std::max(squaredMean, 0.0));
  }
};

// Sums of all pixels; one entry for each.
struct PixelSums {
  std::vector<Moments> moments;
  // In the current pass, and of camera paths alone: they are in one pixel of the image, and splats anywhere in the
  // pilot's.
  std::vector<Found> found;
};

// Adds up the moments of the paths of one chunk. Pixels of other chunks, which splats reach, are added to after the
// pass: sums do not depend on the number of threads.
class Recorder final : public PathObserver {
 public:
  // `first`, `end`: pixels of the chunk. `splatCount`: that of the weights. `mostPasses`: of the pilot. `countsSeen`:
  // of Records.
  Recorder(const Grid& grid, const PixelFilter& filter, double splatCount, bool countsSeen, int mostPasses,
           PixelSums& pixels, size_t first, size_t end)
      : grid_(grid),
        filmPixels_(grid.filmPixels),
        spread_(filter.SplatCount()),
        splatCount_(splatCount),
        countsSeen_(countsSeen),
        renders_(kTypicalSamples / grid.Pixels()),
        mostPasses_(mostPasses),
        pixels_(pixels),
        first_(first),
        end_(end) {}

  void StartSample(int x, int y, float weight) {
    pixel_ = grid_.PixelOf(x, y);
    weight_ = static_cast<double>(weight);
    sums_ = {};
  }
  // A sample is the sum of all paths that one camera path makes. Its square has the products of different paths,
  // besides the squares of each.
  void EndSample();
  // Adds to pixels of other chunks, after the pass.
  void EndPass();
  bool WantsSums() const override { return true; }
  void Observe(const ConnectedPath& path) override;
  void ObserveMerge(const ConnectedPath& path, const Photon&) override { Observe(path); }
  void ObserveBeamMerge(const ConnectedPath& path, const BeamVertex&, uint32_t) override { Observe(path); }

  std::array<std::vector<RareEvent>, kCandidates> rare;

 private:
  using PerCandidate = std::array<double, kCandidates>;
  // Second moments of a path by other techniques.
  struct Factors {
    PerCandidate squares;  // Σ (n r)²; 0: the candidate does not find the path
    PerCandidate factors;  // of the second moment
    PerCandidate ofLight;  // the part of that which splats and photons find
  };
  // Contribution of a splat to a pixel.
  struct Splat {
    size_t pixel;
    bool isSeen;
    double weighted;
    PerCandidate squares;  // second moments; negative: the light is missed
    PerCandidate ofLight;  // the part of splats and photons
  };

  static Factors FactorsOf(const TechniqueSums& sums, double splatSquare);
  void Add(const ConnectedPath& path, double value);
  void AddSplat(const ConnectedPath& path, double value, size_t pixel);
  void Add(const Splat& splat);
  // Adds a path whose densities by other techniques are unknown, as if all candidates found it in the same way.
  void AddAlike(const ConnectedPath& path, double value);
  void KeepRare(const ConnectedPath& path, double value, size_t pixel, const Factors& found);

  // What the light path of a photon that is merged at a first hit adds to the same pixel by its connection to the lens,
  // on average: the same light path, counted twice. `squares`: Σ (n r)².
  double SplatOf(const ConnectedPath& path, double value, double lightPaths, double squares) const;

  const Grid& grid_;
  double filmPixels_, weight_ = 1;
  double spread_;      // pixels among which a splat is divided
  double splatCount_;  // of the weights
  bool countsSeen_;
  double renders_;  // typical renders for each of the pilot's samples, times its passes
  int mostPasses_;
  size_t pixel_ = 0;
  PixelSums& pixels_;
  size_t first_, end_;
  std::vector<Splat> elsewhere_;
  // Σ x and Σ x² of what a camera path finds. Connections have their own sums, because only samples with a light path
  // make them; so has what a camera path finds beyond the vertex where it may end.
  struct Sum {
    PerCandidate value{}, squares{};
  };
  struct Sums {
    Sum unconnected, connected, unconnectedBeyond, connectedBeyond;
  };
  Sums sums_;  // of the current camera path
};

// Combines the records of all chunks into the errors of the candidates.
class Records {
 public:
  // `splatCount`: that of the weights. `countsSeen`: light that the camera sees itself is a part of the noise. It is
  // not if further camera rays look for it (render/light_edges.h). `chunks`: of the pixels, each with a recorder.
  Records(const Grid& grid, const PixelFilter& filter, double splatCount, bool countsSeen, int chunks, int mostPasses);

  std::span<Recorder> Recorders() { return recorders_; }

  // After each pass. The square of a pixel's mean is estimated by the product of what two passes have found in it,
  // which are independent.
  void EndPass(uint32_t pass);

  // The sum over all passes. False: no light was found. `squaredWeight`: PixelFilter::SquaredWeight. A pixel is Σ wL /
  // Σ w over its samples, so that weights of either sign scale its variance and do not add to it.
  bool SetErrors(int passes, double squaredWeight, bool isSobol, std::vector<PilotCandidate>& candidates);
  // The errors of tiles, as PilotCandidate::tileErrors but by independent samples, of squared errors by pixel. After
  // SetErrors.
  std::vector<double> RelativeErrors(const std::vector<double>& squares) const;
  // After SetErrors: the least error that is distinguishable; the mean light of a pixel, and its part that is not seen
  // directly.
  double LeastError() const { return least_; }
  double MeanLight() const { return meanLight_; }
  double MeanUnseen() const { return meanUnseen_; }
  // Weight of the squared error of a pixel in the error of the picture; 0: the pixel is left out.
  double WeightOf(size_t pixel) const { return weights_[pixel]; }
  // Weight of a pixel of that brightness.
  double WeightAt(double brightness) const;

 private:
  struct Brightness {
    double mean = 0;             // of the picture
    double squared = 0;          // mean of the squares of pixels, each by its scale
    std::vector<double> scales;  // 1 / (passes · squared brightness), by pixel
  };
  // The brightness of a pixel is that of its tile, and of the light that it sees itself.
  Brightness BrightnessOf(const std::vector<Moments>& pixels, int passes) const;

  // Sets the estimates of candidate `k`, as those of independent samples. `isLeftOut`: pixels that do not count.
  void AddUp(size_t k, int passes, const Brightness& brightness, const std::vector<Moments>& pixels,
             const std::vector<char>& isLeftOut, double squaredWeight, PilotCandidate& candidate) const;

  // Moves the brightest events of candidate `k` out of its second moments, as far as a typical render is expected to
  // hold less than one of them and they are a negligible part of the light.
  void LeaveOutRare(size_t k, int passes, double mean, const std::vector<double>& scales,
                    std::vector<Moments>& pixels) const;
  // The part of the second moments of candidate `k` by splats and photons, weighted as errors are.
  static double PartOfLight(size_t k, const Brightness& brightness, const std::vector<Moments>& pixels,
                            const std::vector<char>& isLeftOut);
  // The thousandth of the pixels in which even the best candidate is noisiest, marked by 1: a firefly there, which all
  // candidates have, would hide their differences elsewhere.
  std::vector<char> Hopeless(const std::vector<Moments>& pixels, const std::vector<double>& scales) const;
  template <class Body>
  void ForEachPixel(const Body& body) const {
    for (int y = 0; y < grid_.height; ++y) {
      for (int x = 0; x < grid_.width; ++x) body(grid_.PixelOf(x, y), grid_.TileOf(x, y));
    }
  }

  const Grid& grid_;
  PixelSums pixels_;
  std::vector<Recorder> recorders_;
  double least_ = 0, meanLight_ = 0, meanUnseen_ = 0, squaredWeight_ = 1;
  std::vector<double> weights_;            // by pixel: of a squared error, in RelativeErrors
  std::vector<Found> last_;                // in the pass before
  std::vector<SquaredMean> squaredMeans_;  // by pixel and candidate
};

}  // namespace lampyr::pilot
