// The film: sums of samples per pixel, their variance, and the image developed from them.
//
// A pixel is the sum of two techniques: the mean of its camera samples, and the splats of light paths. Either may be
// absent: a pure path tracer has no splats, a pure light tracer no camera samples.
//
// A film may have layers, which split the image: each part of a sample or splat belongs to one of them. They are summed
// and normalised like the image, so that they add up to it except for rounding.
//
// The image does not depend on the order of the samples: sums are compensated (math/compensated_sum.h). The films of
// parts of the samples add up to the film of all samples.
//
// The pixels of an adaptive film differ in their numbers of samples. Its passes are grouped in stages; a pixel is the
// mean of its stages, weighted by their passes. These weights are the same in all pixels and known beforehand, so that
// the picture is unbiased although the numbers of samples depend on the samples of earlier stages. The mean over all
// samples of a pixel would be biased: after a stage that by chance found little light, the next one has fewer samples,
// and the dark stage gets too large a weight.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "base/large_pages.h"
#include "film/image.h"
#include "film/layer_sample.h"
#include "film/pixel_filter.h"
#include "film/splats.h"
#include "math/compensated_sum.h"
#include "math/vec.h"

namespace lampyr {

// The layer of a film that gets about half of the samples (by index), instead of a part of each sample. It is the last
// layer. This layer and the rest are two estimates with independent noise, from which the noise of any processed
// picture is estimated.
inline constexpr const char* kHalfLayer = "half";
// True if a sample belongs to kHalfLayer: the first half of the indices from each power of two to the next. Aligned
// blocks of a Sobol sequence are each well distributed; two parts that are well distributed only together have opposite
// errors.
inline bool IsInHalf(uint32_t sampleIndex) {
  return sampleIndex < 2 ? sampleIndex == 0 : (sampleIndex & (std::bit_floor(sampleIndex) / 2)) == 0;
}
// Number of the first n samples that belong to kHalfLayer: from n/2 to n·2/3, rounded up.
uint32_t SamplesInHalf(uint32_t n);

// Fraction of the samples that are in kHalfLayer, if these are not the first ones of the picture: a key of
// Image::metadata.
inline constexpr const char* kHalfShareMetadata = "lampyr.halfShare";

// A channel: the fraction of a pixel's variance that is due to splats. A splat is in several pixels, so that their
// noise is correlated: in the variance of a sum over pixels, that of splats counts this many times
// (PixelFilter::SplatCount; a key of Image::metadata).
inline constexpr const char* kSplatShareChannel = "splatShare";
inline constexpr const char* kSplatCountMetadata = "lampyr.splatCount";

// Spectral bands that a film keeps besides its picture: equal parts of the range of wavelengths from `from` to `to`
// (nm).
struct SpectralBands {
  int count = 0;
  double from = 0, to = 0;

  double Width() const { return (to - from) / count; }
  // Index of the band of a wavelength; -1: none.
  int Of(double wavelength) const;
  bool operator==(const SpectralBands&) const = default;
};
// The layers of a film for these bands: three bands each, in place of the red, green and blue of other layers. The name
// of such a layer lists its channels, which are named by the middle of the band, as in the layout for spectral images
// of [Fichet21].
std::vector<std::string> LayersOfBands(const SpectralBands& bands);
bool IsBandLayer(const std::string& layer);

// The bands of the three wavelengths of a pass.
struct LanesInBands {
  int band[3] = {-1, -1, -1};     // by lane; -1: none
  double weight[3] = {0, 0, 0};   // 1 / (density of the wavelength · width of the band)
  float radiance[3] = {0, 0, 0};  // spectral radiance of 1 in that lane, times the weight
};

struct PixelRect {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;  // half open
  int Width() const { return x1 - x0; }
  int Height() const { return y1 - y0; }
};

// Sums over the samples of one pixel. A sample with filter weight w and value L adds w·L; the pixel is Σ wL / Σ w.
struct PixelSums {
  CompensatedSum sum[3];
  CompensatedSum sumOfSquares[3];  // of w·L
  CompensatedSum weight;
  double sumOfFourths = 0;  // of deviations of the luminance from the running mean: precision of the variance
  uint64_t count = 0;

  void Add(const Color& value, float filterWeight);
  // Adds all samples of `other`.
  void Add(const PixelSums& other);
  // Divisor of the sums. Filter weights have mean 1, so that Σw is near n; those of filters with negative lobes may
  // cancel while there are few samples. The divisor is then n, which keeps the pixel finite and unbiased.
  double Divisor() const;
  bool IsFinite() const;
};

// The completed stages of a pixel of an adaptive film. N: passes of a stage; n: samples of the pixel in it. The pixel
// is Σ N ΣwL / n over Σ N Σw / n: the ratio of each single stage would be biased, as ratios of few samples are.
struct PixelStages {
  double sum[3] = {0, 0, 0}, weight = 0;  // Σ N ΣwL / n, Σ N Σw / n
  // Variance of `sum` per variance of a sample: Σ N² / n for independent samples, and Σ N² Σ c² / n² for samples of
  // which the c of one pass are equal.
  double independent = 0, shared = 0;
  double sumOfFourths = 0;  // Σ N⁴ · fourths / n⁴
  // Over the samples of all stages, as in PixelSums:
  double valueSum[3] = {0, 0, 0}, squareSum[3] = {0, 0, 0}, fourthSum = 0;
  uint64_t count = 0;
  double splatLuminance = 0, splatVariance = 0;  // of all splats when the last stage ended

  bool IsFinite() const;
};

// Statistics of samples of an adaptive film that are correlated, because all those of a pass gather the same photons:
// the variation within passes, and the sizes of passes.
struct PixelGroups {
  double within[3] = {0, 0, 0};  // Σ squared deviations of samples from the mean of their pass
  uint64_t freedom = 0;          // degrees of freedom of `within`
  uint64_t squares = 0;          // Σ c² of the passes of the current stage

  // Adds the samples of one pass.
  void Add(const PixelSums& pass);
  bool IsFinite() const;
};

// The bias of a pixel by merging photons, as estimated by its samples (photon/merge_bias.h): sums over the samples of
// one pass, which gather the same photons.
struct PassBias {
  double sum[3] = {0, 0, 0};  // of w·B; B: estimate of a sample
  uint32_t count = 0;         // samples

  void Add(const Color& bias, float filterWeight);
};

// Sums over the passes of a pixel, taken as independent. g: PassBias::sum, in squares its luminance; c:
// PassBias::count. The terms of completed stages of an adaptive film are scaled by N / n, as in PixelStages, and their
// squares by its square.
struct PixelBias {
  CompensatedSum sum[3];             // Σ g
  CompensatedSum squares, products;  // Σ g², Σ c g
  double weights = 0;                // Σ c²

  void Add(const PassBias& pass);
  void Add(const PixelBias& other);
  void AddScaled(const PixelBias& other, double scale);
  bool IsFinite() const;
};

// The parts of the relative error of an image at 95 % confidence (Film::PartsOfError).
struct ErrorParts {
  double noise = 0;  // half the width of the confidence interval of the noise, which differs between seeds
  double bias = 0;   // bound of the root mean square bias of the pixels, by merging photons
  double Both() const;
};

class ByteReader;
class ByteWriter;

class Film {
 public:
  // `crop`: in pixels of the full image. `layers`: names of the layers, LayersOfBands after all others; kHalfLayer may
  // be the last. Throws an Error if the crop is empty or reaches beyond the image.
  Film(int fullWidth, int fullHeight, const PixelRect& crop, std::vector<std::string> layers = {});

  const PixelRect& Crop() const { return crop_; }
  // Pixels are independent: two threads may work on two pixels at once.
  PixelSums& Pixel(int x, int y) { return pixels_[Index(x, y)]; }
  const PixelSums& Pixel(int x, int y) const { return pixels_[Index(x, y)]; }

  const std::vector<std::string>& Layers() const { return layers_; }
  // Number of layers that samples are split into: without those of bands and kHalfLayer.
  size_t SplitLayers() const { return layers_.size() - bandLayers_ - (hasHalf_ ? 1 : 0); }
  bool HasLayers() const { return SplitLayers() > 0; }
  bool HasHalf() const { return hasHalf_; }
  // Adds a camera sample, whose value is added to the pixel itself, to kHalfLayer.
  void AddToHalf(int x, int y, const Color& value, float filterWeight);
  bool HasBands() const { return bandLayers_ > 0; }
  // Sets the wavelengths of the next pass: of its samples (AddToBands), its splats, and its white (CountWhite).
  void SetLanes(const LanesInBands& lanes) { lanes_ = lanes; }
  // Adds a camera sample, whose value is added to the pixel itself, to the bands. `value`: by lane.
  void AddToBands(int x, int y, const Color& value, float filterWeight);
  // Adds the layer parts of a sample whose value is added to the pixel itself, scaled by `scale` and weighted by the
  // filter.
  void AddToLayers(int x, int y, const LayerSample& sample, float scale, float filterWeight,
                   const SensorResponse& sensor = {});
  // Bytes per pixel of a film with `layers` layers.
  static uint64_t BytesPerPixel(size_t layers, bool withSplats, bool isAdaptive = false, bool hasGroups = true,
                                bool keepsBias = false);

  // An empty list for splats onto this film.
  SplatList MakeSplatList(const PixelFilter& filter, const SensorResponse& sensor) const;
  // Adds the paths of the lists, in order; all belong to the sample of index `sample`. The result does not depend on
  // how a sequence of paths is divided into lists and calls, nor on the number of threads.
  void AddSplats(const PixelFilter& filter, std::span<const SplatList> lists, int threads, uint32_t sample = 0);
  // Number of light paths so far, including those without a splat.
  uint64_t LightPaths() const { return lightPaths_; }

  // Makes an empty film adaptive. `hasGroups`: the samples of a pass gather the same photons.
  void MakeAdaptive(bool hasGroups);
  bool IsAdaptive() const { return isAdaptive_; }
  // Adaptive films. `passes` were added to the current stage.
  void CountPasses(uint32_t passes) { passes_ += passes; }
  // Ends the stage, in which each pixel must have a sample: the sums of Pixel() start again from 0.
  void EndStage();
  // Adds the samples of a pixel in one pass, which have been added to the pixel already, to its groups; for films with
  // groups.
  void AddGroup(int x, int y, const PixelSums& pass) { groups_[Index(x, y)].Add(pass); }
  bool HasGroups() const { return !groups_.empty(); }
  // Makes an empty film keep estimates of the bias of merging photons. It does not change the picture.
  void KeepBias();
  bool KeepsBias() const { return !bias_.empty(); }
  // Adds the bias estimates of the samples of a pixel in one pass. The samples themselves are added by Pixel().
  void AddBias(int x, int y, const PassBias& pass) { bias_[Index(x, y)].Add(pass); }
  // Estimate of the bias of a pixel (an index into the crop, row by row), 0 unless estimates are kept. Signed.
  double Bias(size_t pixel, int channel) const;

  // Statistics of the completed stages: passes; and for a pixel (an index into the crop, row by row) its stages, its
  // luminance, the sums of squared deviations of the luminance of its samples and of their squares, and the variance of
  // all splats.
  uint64_t EndedPasses() const { return endedPasses_; }
  const PixelStages& Stages(size_t pixel) const { return stages_[pixel]; }
  struct PixelStatistics {
    double luminance = 0, squares = 0, fourths = 0, splatVariance = 0;
  };
  PixelStatistics StatisticsOf(size_t pixel) const;

  // Samples of a pixel (an index into the crop, row by row).
  uint64_t Samples(size_t pixel) const { return pixels_[pixel].count + (isAdaptive_ ? stages_[pixel].count : 0); }
  size_t Pixels() const { return pixels_.size(); }

  // Counts a pass in which radiance 1 of a white scene was estimated as `white`, by channel, from a few wavelengths.
  // The picture is divided by the mean over all passes, so that white stays white after any number of them.
  void CountWhite(const std::array<double, 3>& white);

  // Adds all samples and light paths of another film of the same size, crop and layers, as stages of their own if they
  // are adaptive.
  void Add(const Film& other);
  // Copies the samples and light paths of another film of the same size, crop and layers. Reuses memory.
  void CopyFrom(const Film& other, int threads);
  // An empty film of the same size, crop, layers and kind.
  Film EmptyCopy() const;
  // Fraction of the pixels with at least one sample.
  double SampledFraction() const;
  // Writes everything except size, crop and layers.
  void Save(ByteWriter& bytes) const;
  // Reads the data of Save into an empty film of the same size, crop and layers. Throws an Error for any other data,
  // and then leaves the film unchanged.
  void Load(ByteReader& bytes);

  // The image: R, G, B and variance.R, .G, .B, the variance of the mean of a pixel (sample variance / n; an upper bound
  // for stratified samplers), then NAME.R, .G, .B of each layer. Camera samples and splats are taken as independent:
  // the splats of a camera sample go to all pixels alike, and their share in its own pixel is small.
  Image Develop() const;

  // Estimated relative error of the image at 95 % confidence. Its noise is 1.96 · sqrt(mean variance of the pixel
  // means) / mean luminance. The mean variance is the upper end of its own confidence interval ([Fay97], see film.cpp),
  // because it is uncertain if a few bright samples make up most of it. `largestSample`: luminance of the brightest
  // sample that may not have occurred yet. Infinite with fewer than 2 samples per pixel, or fewer than 2 light paths. 0
  // without variance if `largestSample` is 0, but for a black image that light paths are splatted to; and for an image
  // that is still black after 4096 samples, or light paths, per pixel. The bias is that of merging photons
  // (film_bias.cpp), 0 unless its estimates are kept.
  ErrorParts PartsOfError(double largestSample = 0) const;
  double RelativeError(double largestSample = 0) const { return PartsOfError(largestSample).Both(); }

  // Half the width of the 95 % interval of a pixel's luminance, relative to it, or to 1 % of the mean luminance in
  // darker pixels; pixel by pixel, row by row. With the bias. Infinite where there are fewer than 2 samples, and, while
  // `imageError`, the relative error of the whole picture, is above 1, where all samples were black.
  std::vector<float> PixelErrors(double imageError = 0) const;
  // Squared bound of the bias of the luminance, pixel by pixel, each from its neighbourhood; empty unless estimates are
  // kept.
  std::vector<double> BiasSquares() const;

 private:
  using LayerSum = std::array<CompensatedSum, 3>;

  size_t Index(int x, int y) const { return static_cast<size_t>(y - crop_.y0) * crop_.Width() + (x - crop_.x0); }
  double CameraValue(size_t pixel, int channel) const;
  double AdaptiveDivisor(size_t pixel) const;
  double CameraVariance(size_t pixel, int channel) const;
  double CameraFourth(size_t pixel) const;
  double HalfShareOfSplats() const;
  struct BiasMoments {
    double square = 0, variance = 0;
  };
  BiasMoments BiasMomentsOf(size_t pixel) const;
  double MeanBiasSquare() const;
  bool BiasIsFinite() const;
  void NoteSplats(size_t pixel);
  void AddStages(const Film& other);
  bool StagesAreFinite() const;
  void CheckStages() const;
  double CurrentLayerMean(size_t pixel, size_t layer, size_t channel) const;
  double CurrentHalf(size_t pixel, size_t channel) const;
  void PrefetchSplats(const Point2& film) const;
  void AddToRows(const PixelFilter& filter, std::span<const SplatList> lists, int band, int bands, bool isInHalf);
  double Value(size_t pixel, int channel) const;
  double LayerValue(size_t pixel, size_t layer, size_t channel) const;
  double VarianceOfMean(size_t pixel, int channel) const;
  double VarianceOfSplats(size_t pixel, int channel) const;  // the variance of a pixel by its splats
  float SplatShare(size_t pixel) const;                      // kSplatShareChannel
  double FourthOfMean(size_t pixel) const;
  double WhiteScale(size_t channel) const;
  double BandScale(size_t band) const;
  SplatList::Lanes LanesOfSplats() const;
  void MakeSplats();

  int fullWidth_, fullHeight_;
  PixelRect crop_;
  LargePageVector<PixelSums> pixels_;
  LargePageVector<SplatSums> splats_;  // empty without splats
  std::vector<std::string> layers_;
  bool hasHalf_ = false;                               // the last layer is kHalfLayer
  size_t bandLayers_ = 0;                              // those of bands, which are before it
  LanesInBands lanes_;                                 // of the pass that is being added
  std::vector<double> bandWeights_;                    // per band: Σ LanesInBands::weight over the passes
  LargePageVector<LayerSum> layerSums_, layerSplats_;  // per layer and pixel; layerSplats_: empty without splats
  uint64_t lightPaths_ = 0, halfPaths_ = 0;            // halfPaths_: of those, in kHalfLayer of an adaptive film
  std::array<double, 3> whiteSum_{};
  uint64_t whitePasses_ = 0;
  double splatSpread_ = 0;  // effective number of pixels of a splat (film.cpp)
  bool isAdaptive_ = false;
  uint32_t passes_ = 0;                                 // of the current stage
  uint64_t endedPasses_ = 0;                            // of those before it
  LargePageVector<PixelStages> stages_;                 // empty unless adaptive
  LargePageVector<PixelGroups> groups_;                 // empty unless adaptive with groups
  LargePageVector<PixelBias> bias_;                     // empty unless kept; of an adaptive film: of the current stage
  LargePageVector<PixelBias> biasStages_;               // empty unless adaptive and kept
  LargePageVector<std::array<double, 3>> layerStages_;  // per layer and pixel: Σ passes · mean; empty unless adaptive
};

}  // namespace lampyr
