// The film: sums of samples per pixel, their variance, and the image made of them.
//
// A pixel is what its camera samples say plus what light paths have splatted on it. The two are different techniques of
// one estimate, or one of them is absent: a pure path tracer makes no splats, and a pure light tracer no samples.
//
// A film may have layers, which split the picture: each part of a sample or splat belongs to one of them. They are
// summed and normalised as the picture is, so they add up to it but for rounding.
//
// The order of samples does not show in the image: sums are compensated (math/compensated_sum.h), so that the films of
// parts of the samples add up to that of all of them.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "film/image.h"
#include "film/layer_sample.h"
#include "film/pixel_filter.h"
#include "film/splats.h"
#include "math/compensated_sum.h"
#include "math/vec.h"

namespace lampyr {

struct PixelRect {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;  // half open
  int Width() const { return x1 - x0; }
  int Height() const { return y1 - y0; }
};

// Sums of one pixel. A sample with filter weight w and value L adds w·L; the pixel is Σ wL / Σ w.
struct PixelSums {
  CompensatedSum sum[3];
  CompensatedSum sumOfSquares[3];  // of w·L
  CompensatedSum weight;
  double sumOfFourths = 0;  // of the luminance's deviations from the mean before each sample: the error's own error
  uint64_t count = 0;

  void Add(const Color& value, float filterWeight);
  // All samples of another one.
  void Add(const PixelSums& other);
  bool IsFinite() const;
};

class ByteReader;
class ByteWriter;

class Film {
 public:
  // `crop` in pixels of the full image. `layers`: their names.
  Film(int fullWidth, int fullHeight, const PixelRect& crop, std::vector<std::string> layers = {});

  const PixelRect& Crop() const { return crop_; }
  // Pixels are independent: two threads may work on two pixels at once.
  PixelSums& Pixel(int x, int y) { return pixels_[Index(x, y)]; }
  const PixelSums& Pixel(int x, int y) const { return pixels_[Index(x, y)]; }

  const std::vector<std::string>& Layers() const { return layers_; }
  bool HasLayers() const { return !layers_.empty(); }
  // The parts of a sample whose value is added to the pixel itself: `scale` times them, weighted by the filter.
  void AddToLayers(int x, int y, const LayerSample& sample, float scale, float filterWeight,
                   const SensorResponse& sensor = {});
  // Memory that `layers` of them take for each pixel.
  static uint64_t BytesPerPixel(size_t layers, bool withSplats);

  // An empty list for splats on this film.
  SplatList MakeSplatList(const PixelFilter& filter, const SensorResponse& sensor) const;
  // Adds the paths of the lists, in their order. What is made of a sequence of paths does not depend on how it is cut
  // into lists and calls, nor on the number of threads.
  void AddSplats(const PixelFilter& filter, std::span<const SplatList> lists, int threads);
  // Light paths so far, those that were never seen included.
  uint64_t LightPaths() const { return lightPaths_; }

  // All samples and light paths of another film, of the same size, crop and layers.
  void Add(const Film& other);
  // The same samples and light paths as another film, of the same size, crop and layers. Reuses its memory.
  void CopyFrom(const Film& other, int threads);
  // Without samples and light paths, of the same size, crop and layers.
  Film EmptyCopy() const { return {fullWidth_, fullHeight_, crop_, layers_}; }
  // The fraction of the pixels that have a sample.
  double SampledFraction() const;
  // Everything but size, crop and layers.
  void Save(ByteWriter& bytes) const;
  // Into an empty film of the same size, crop and layers. Throws an Error, and leaves the film as it was, where this is
  // not what has been saved.
  void Load(ByteReader& bytes);

  // R, G, B and variance.R, .G, .B: the variance of the pixel's mean (sample variance / n; an upper bound for
  // stratified samplers). Samples and splats count as independent: a sample that also splats does so on all pixels
  // alike, and its share in its own is small. Then NAME.R, .G, .B of each layer.
  Image Develop() const;

  // Estimated relative error of the image at 95 % confidence: 1.96 · sqrt(mean variance of the pixels' means) over
  // mean luminance, where the mean variance is the upper end of its own confidence interval ([Fay97], see film.cpp): a
  // few bright samples that make up most of it say that it is not known well. `largestSample` is the luminance of the
  // brightest sample that may not have been met yet. Infinite while there are fewer than 2 samples per pixel, or 2
  // light paths.
  double RelativeError(double largestSample = 0) const;

 private:
  using LayerSum = std::array<CompensatedSum, 3>;

  size_t Index(int x, int y) const { return static_cast<size_t>(y - crop_.y0) * crop_.Width() + (x - crop_.x0); }
  void AddToRows(const PixelFilter& filter, std::span<const SplatList> lists, int band, int bands);
  double Value(size_t pixel, int channel) const;
  double LayerValue(size_t pixel, size_t layer, size_t channel) const;
  double VarianceOfMean(size_t pixel, int channel) const;
  double FourthOfMean(size_t pixel) const;
  void MakeSplats();

  int fullWidth_, fullHeight_;
  PixelRect crop_;
  std::vector<PixelSums> pixels_;
  std::vector<SplatSums> splats_;  // empty while there are none
  std::vector<std::string> layers_;
  std::vector<LayerSum> layerSums_, layerSplats_;  // of each layer of each pixel; splats: empty while there are none
  uint64_t lightPaths_ = 0;
  double splatSpread_ = 0;  // how many pixels a splat is worth (film.cpp)
};

}  // namespace lampyr
