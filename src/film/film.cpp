// Sums per pixel, and the image developed from them. Radiance in W/(m² sr); the sums of a million samples do not lose
// precision.
#include "film/film.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <type_traits>
#include <utility>

#include "base/byte_stream.h"
#include "base/error.h"
#include "base/large_pages.h"
#include "base/parallel.h"
#include "film/metrics.h"
#include "film/mix.h"

namespace lampyr {

namespace {

// Variance of the mean of n samples from their sums; 0 for fewer than 2 samples.
double MeanVariance(double sum, double sumOfSquares, double n) {
  if (n < 2) return 0;
  const double mean = sum / n;
  return std::max(0.0, sumOfSquares / n - mean * mean) / (n - 1);
}

// Upper 95 % confidence bound of a sum of rare contributions of different sizes, from the sum and the sum of squares of
// the contributions: the quantile of a gamma distribution with the same moments, to which one more contribution of the
// largest possible size was added ([Fay97 eq. 4]). It prevents trust in an estimate that rests on a few bright samples,
// or whose brightest samples have not occurred yet: the bound of an empty sum is three times `largest`.
double UpperBound(double sum, double sumOfSquares, double largest) {
  largest = std::max(largest, std::sqrt(sumOfSquares));  // no contribution exceeds this
  constexpr double certain = 1e-3;                       // relative size of `largest` below which the bound is the sum
  if (!(largest > certain * sum)) return sum;
  const double mean = sum + largest, variance = sumOfSquares + largest * largest;
  return variance / (2 * mean) * ChiSquaredQuantile(0.05, 2 * mean * mean / variance);
}

// Effective number of pixels of a splat at a pixel centre: (Σ f²)² / Σ f⁴ over the pixels within the radius of the
// filter.
double SplatSpread(const PixelFilter& filter) {
  double squares[2] = {0, 0}, fourths[2] = {0, 0};
  for (int axis = 0; axis < 2; ++axis) {
    const int reach = static_cast<int>(std::ceil(filter.Radius()[axis]));
    for (int i = -reach; i <= reach; ++i) {
      const auto offset = static_cast<float>(i);
      const double f = static_cast<double>(axis == 0 ? filter.EvaluateX(offset) : filter.EvaluateY(offset));
      squares[axis] += f * f;
      fourths[axis] += f * f * f * f;
    }
  }
  return std::pow(squares[0] * squares[1], 2) / (fourths[0] * fourths[1]);
}

// Intensities of 1e30 have variances beyond the range of float: clamped to the largest float.
float ToFiniteFloat(double value) {
  constexpr double largest = std::numeric_limits<float>::max();
  return static_cast<float>(std::clamp(value, -largest, largest));
}

void AddTo(std::array<CompensatedSum, 3>& sum, float weight, const Color& value) {
  sum[0].Add(static_cast<double>(weight) * static_cast<double>(value.r));
  sum[1].Add(static_cast<double>(weight) * static_cast<double>(value.g));
  sum[2].Add(static_cast<double>(weight) * static_cast<double>(value.b));
}

template <class Sums>
void AddAll(LargePageVector<Sums>& to, const LargePageVector<Sums>& from) {
  for (size_t i = 0; i < from.size(); ++i) {
    for (size_t c = 0; c < 3; ++c) to[i][c].Add(from[i][c]);
  }
}

// Copies in bands, one per thread: one thread cannot saturate the memory bandwidth.
template <class Sums>
void Copy(LargePageVector<Sums>& to, const LargePageVector<Sums>& from, int threads) {
  static_assert(std::is_trivially_copyable_v<Sums>);
  to.resize(from.size());
  const size_t band = from.size() / static_cast<size_t>(std::max(threads, 1)) + 1;
  ParallelFor(std::max(threads, 1), threads, [&](int index) {
    const size_t begin = std::min(static_cast<size_t>(index) * band, from.size());
    const size_t end = std::min(begin + band, from.size());
    std::copy(from.begin() + static_cast<std::ptrdiff_t>(begin), from.begin() + static_cast<std::ptrdiff_t>(end),
              to.begin() + static_cast<std::ptrdiff_t>(begin));
  });
}

bool AreFinite(std::span<const CompensatedSum> sums) {
  return std::all_of(sums.begin(), sums.end(), [](const CompensatedSum& sum) { return sum.IsFinite(); });
}

// Optional parts of a saved film.
constexpr int kHasSplats = 1, kHasBias = 2, kHasWhite = 4;

}  // namespace

uint32_t SamplesInHalf(uint32_t n) {
  if (n < 2) return n;
  const uint32_t power = std::bit_floor(n);
  return power / 2 + std::min(n - power, power / 2);
}

void PixelSums::Add(const Color& value, float filterWeight) {
  const double w = static_cast<double>(filterWeight);
  const double weighted[3] = {w * static_cast<double>(value.r), w * static_cast<double>(value.g),
                              w * static_cast<double>(value.b)};
  if (count > 0) {
    const double scale = 1 / static_cast<double>(count);
    double deviation = 0;
    for (int c = 0; c < 3; ++c) deviation += Color::kLuminance[c] * std::abs(weighted[c] - scale * sum[c].Value());
    sumOfFourths += deviation * deviation * deviation * deviation;
  }
  for (int c = 0; c < 3; ++c) {
    sum[c].Add(weighted[c]);
    sumOfSquares[c].Add(weighted[c] * weighted[c]);
  }
  weight.Add(w);
  ++count;
}

void PixelSums::Add(const PixelSums& other) {
  for (int c = 0; c < 3; ++c) {
    sum[c].Add(other.sum[c]);
    sumOfSquares[c].Add(other.sumOfSquares[c]);
  }
  weight.Add(other.weight);
  sumOfFourths += other.sumOfFourths;
  count += other.count;
}

double PixelSums::Divisor() const {
  const auto n = static_cast<double>(count);
  const double sumOfWeights = weight.Value();
  return sumOfWeights > 0.1 * n ? sumOfWeights : n;
}

bool PixelSums::IsFinite() const {
  return AreFinite(sum) && AreFinite(sumOfSquares) && weight.IsFinite() && std::isfinite(sumOfFourths);
}

Film::Film(int fullWidth, int fullHeight, const PixelRect& crop, std::vector<std::string> layers)
    : fullWidth_(fullWidth), fullHeight_(fullHeight), crop_(crop), layers_(std::move(layers)) {
  hasHalf_ = !layers_.empty() && layers_.back() == kHalfLayer;
  bandLayers_ = static_cast<size_t>(std::count_if(layers_.begin(), layers_.end(), IsBandLayer));
  for (size_t i = 0; i < layers_.size(); ++i) {
    const bool isPlace = i >= SplitLayers() && i < SplitLayers() + bandLayers_;
    if (IsBandLayer(layers_[i]) != isPlace || (isPlace && Split(layers_[i], ' ').size() > 3))
      throw Error("the layers of a film with bands of the spectrum are not in their order");
  }
  bandWeights_.resize(3 * bandLayers_);
  const bool inside = crop.x0 >= 0 && crop.y0 >= 0 && crop.x1 <= fullWidth && crop.y1 <= fullHeight;
  if (!inside || crop.Width() <= 0 || crop.Height() <= 0) {
    throw Error("the crop holds no pixel of the " + std::to_string(fullWidth) + " x " + std::to_string(fullHeight) +
                " image, or pixels outside of it");
  }
  pixels_.resize(static_cast<size_t>(crop.Width()) * static_cast<size_t>(crop.Height()));
  layerSums_.resize(pixels_.size() * layers_.size());
}

void Film::AddToLayers(int x, int y, const LayerSample& sample, float scale, float filterWeight,
                       const SensorResponse& sensor) {
  const double factor = static_cast<double>(scale) * static_cast<double>(filterWeight);
  LayerSum* sums = layerSums_.data() + Index(x, y) * layers_.size();
  for (const uint32_t layer : sample.Met()) {
    for (int c = 0; c < 3; ++c) {
      double value = sample.Sum(layer, c);
      if (sensor.Balances()) [[unlikely]] {
        value = 0;
        for (int k = 0; k < 3; ++k) value += static_cast<double>(sensor.BalanceMatrix()[k][c]) * sample.Sum(layer, k);
      }
      sums[layer][static_cast<size_t>(c)].Add(factor * value);
    }
  }
}

void Film::AddToHalf(int x, int y, const Color& value, float filterWeight) {
  AddTo(layerSums_[(Index(x, y) + 1) * layers_.size() - 1], filterWeight, value);
}

uint64_t Film::BytesPerPixel(size_t layers, bool withSplats, bool isAdaptive, bool hasGroups, bool keepsBias) {
  const uint64_t ofLayer = (withSplats ? 2 : 1) * sizeof(LayerSum) + (isAdaptive ? 3 * sizeof(double) : 0);
  const uint64_t ofStages = isAdaptive ? sizeof(PixelStages) + (hasGroups ? sizeof(PixelGroups) : 0) : 0;
  const uint64_t ofBias = keepsBias ? (isAdaptive ? 2 : 1) * sizeof(PixelBias) : 0;
  return sizeof(PixelSums) + (withSplats ? sizeof(SplatSums) : 0) + ofStages + ofBias + layers * ofLayer;
}

double Film::CameraValue(size_t pixel, int channel) const {
  const PixelSums& samples = pixels_[pixel];
  if (endedPasses_ == 0) return samples.count > 0 ? samples.sum[channel].Value() / samples.Divisor() : 0.0;
  double sum = stages_[pixel].sum[channel];
  if (samples.count > 0) sum += passes_ * samples.sum[channel].Value() / static_cast<double>(samples.count);
  return sum / AdaptiveDivisor(pixel);
}

double Film::Value(size_t pixel, int channel) const {
  double value = CameraValue(pixel, channel);
  if (lightPaths_ > 0) value += splats_[pixel].Sum(channel) / static_cast<double>(lightPaths_);
  return value;
}

double Film::LayerValue(size_t pixel, size_t layer, size_t channel) const {
  const PixelSums& samples = pixels_[pixel];
  const size_t index = pixel * layers_.size() + layer;
  double value = 0;
  if (isAdaptive_) {
    const double passes = endedPasses_ == 0 ? 1 : passes_;
    value = (layerStages_[index][channel] + passes * CurrentLayerMean(pixel, layer, channel)) / AdaptiveDivisor(pixel);
  } else if (samples.count > 0) {
    value = layerSums_[index][channel].Value() / samples.Divisor();
  }
  if (lightPaths_ == 0) return value;
  double splats = layerSplats_[index][channel].Value() / static_cast<double>(lightPaths_);
  if (isAdaptive_ && hasHalf_ && layer + 1 == layers_.size()) splats *= HalfShareOfSplats();
  return value + splats;
}

double Film::VarianceOfSplats(size_t pixel, int channel) const {
  if (lightPaths_ == 0) return 0;
  const SplatSums& splats = splats_[pixel];
  return MeanVariance(splats.Sum(channel), splats.SumOfSquares(channel), static_cast<double>(lightPaths_));
}

double Film::VarianceOfMean(size_t pixel, int channel) const {
  const PixelSums& samples = pixels_[pixel];
  const double n = static_cast<double>(samples.count);
  double variance = 0;
  if (isAdaptive_) {
    variance = CameraVariance(pixel, channel);
  } else if (samples.count >= 2) {  // w·L relative to the mean weight
    variance = MeanVariance(samples.sum[channel].Value(), samples.sumOfSquares[channel].Value(), n) *
               std::pow(n / samples.Divisor(), 2);
  }
  return variance + VarianceOfSplats(pixel, channel);
}

// Sum of squares of the contributions of all samples to the variance of the image. A splat contributes to all pixels
// under the filter at once, and the square of that sum exceeds the sum of its squares by the factor splatSpread_.
double Film::FourthOfMean(size_t pixel) const {
  const PixelSums& samples = pixels_[pixel];
  double fourth = 0;
  if (isAdaptive_) {
    fourth = CameraFourth(pixel);
  } else if (samples.count >= 2) {
    fourth = samples.sumOfFourths / std::pow(samples.Divisor(), 4);
  }
  if (lightPaths_ > 0)
    fourth += splatSpread_ * splats_[pixel].SumOfFourths() / std::pow(static_cast<double>(lightPaths_), 4);
  return fourth;
}

SplatList Film::MakeSplatList(const PixelFilter& filter, const SensorResponse& sensor) const {
  const Vector2 radius = filter.Radius() - Vector2(0.5f);  // beyond the pixel centres
  // A splat is divided by the light paths of all pixels: what it adds to a sample of one pixel is limited.
  const float pixels = static_cast<float>(fullWidth_) * static_cast<float>(fullHeight_);
  SplatList list(Point2(crop_.x0, crop_.y0) + Vector2(0.5f) - filter.Radius(), Point2(crop_.x1, crop_.y1) + radius,
                 sensor.WithLimitTimes(pixels));
  if (!HasBands()) return list;
  list.SetLanes(LanesOfSplats());
  return list;
}

void Film::MakeSplats() {
  splats_.resize(pixels_.size());
  layerSplats_.resize(layerSums_.size());
}

void Film::AddSplats(const PixelFilter& filter, std::span<const SplatList> lists, int threads, uint32_t sample) {
  MakeSplats();
  if (splatSpread_ == 0) splatSpread_ = SplatSpread(filter);
  const int bands = std::max(threads, 1);
  // Passes of an adaptive film are counted from its own first one, also in a part of a render.
  const bool isInHalf = hasHalf_ && IsInHalf(isAdaptive_ ? static_cast<uint32_t>(endedPasses_ + passes_) : sample);
  ParallelFor(bands, threads, [&](int band) { AddToRows(filter, lists, band, bands, isInHalf); });
  for (const SplatList& list : lists) {
    lightPaths_ += list.Paths();
    if (isInHalf) halfPaths_ += list.Paths();
  }
}

// Fetches the splats of the pixel at `film` into the cache.
void Film::PrefetchSplats(const Point2& film) const {
  const int x = std::clamp(static_cast<int>(film.x), crop_.x0, crop_.x1 - 1);
  const int y = std::clamp(static_cast<int>(film.y), crop_.y0, crop_.y1 - 1);
  const char* sums = reinterpret_cast<const char*>(&splats_[Index(x, y)]);
  constexpr size_t kLine = 64;
  for (size_t offset = 0; offset < sizeof(SplatSums); offset += kLine) Prefetch(sums + offset);
}

// Adds to the rows of one band. Groups of rows are assigned to the bands in turn, so that the threads share a bright
// spot.
void Film::AddToRows(const PixelFilter& filter, std::span<const SplatList> lists, int band, int bands, bool isInHalf) {
  constexpr int kGroup = 4;
  const Vector2 radius = filter.Radius();
  // Within [low, high]: the radius may be far larger than the film.
  const auto firstPixel = [](float p, float r, int low, int high) {
    return static_cast<int>(std::clamp(std::floor(p - 0.5f - r), static_cast<float>(low), static_cast<float>(high)));
  };
  const auto lastPixel = [](float p, float r, int low, int high) {
    return static_cast<int>(std::clamp(std::ceil(p - 0.5f + r), static_cast<float>(low), static_cast<float>(high)));
  };
  std::vector<float> weightsX(static_cast<size_t>(std::min(2 * radius.x + 4, static_cast<float>(crop_.Width()))));
  // Calls add(pixel, weight) for the pixels under the filter at `film`.
  const auto spread = [&](const Point2& film, const auto& add) {
    const int y0 = firstPixel(film.y, radius.y, crop_.y0, crop_.y1);
    const int y1 = lastPixel(film.y, radius.y, crop_.y0 - 1, crop_.y1 - 1);
    const int x0 = firstPixel(film.x, radius.x, crop_.x0, crop_.x1);
    const int x1 = lastPixel(film.x, radius.x, crop_.x0 - 1, crop_.x1 - 1);
    bool hasWeights = false;
    for (int y = y0; y <= y1; ++y) {
      if (y / kGroup % bands != band) continue;
      const float weightY = filter.EvaluateY(film.y - (static_cast<float>(y) + 0.5f));
      if (weightY == 0) continue;
      for (int x = x0; x <= x1 && !hasWeights; ++x)
        weightsX[static_cast<size_t>(x - x0)] = filter.EvaluateX(film.x - (static_cast<float>(x) + 0.5f));
      hasWeights = true;
      for (int x = x0; x <= x1; ++x) {
        const float weight = weightY * weightsX[static_cast<size_t>(x - x0)];
        if (weight != 0) add(Index(x, y), weight);
      }
    }
  };
  // Every band tests all splats; pixels of those that fall into other bands are not fetched.
  const auto reachesBand = [&](const Point2& film) {
    const int first = firstPixel(film.y, radius.y, crop_.y0, crop_.y1) / kGroup;
    const int last = lastPixel(film.y, radius.y, crop_.y0 - 1, crop_.y1 - 1) / kGroup;
    return last - first + 1 >= bands || (band - first % bands + bands) % bands <= last - first;
  };
  uint64_t firstPath = lightPaths_ + 1;  // 0 denotes no path
  for (const SplatList& list : lists) {
    for (const Splat& splat : list.Splats()) {
      // Splats fall anywhere on the film.
      constexpr ptrdiff_t kAhead = 4;
      if (&list.Splats().back() - &splat >= kAhead && reachesBand((&splat)[kAhead].film))
        PrefetchSplats((&splat)[kAhead].film);
      spread(splat.film, [&](size_t pixel, float weight) {
        splats_[pixel].Add(firstPath + splat.path, static_cast<double>(weight), splat.value);
        if (isInHalf) AddTo(layerSplats_[(pixel + 1) * layers_.size() - 1], weight, splat.value);
      });
    }
    for (const SplatPart& part : list.Parts()) {
      spread(part.film, [&](size_t pixel, float weight) {
        AddTo(layerSplats_[pixel * layers_.size() + part.layer], weight, part.value);
      });
    }
    firstPath += list.Paths();
  }
}

void Film::Add(const Film& other) {
  if (other.isAdaptive_ && other.passes_ > 0) {
    Film ended = other;
    ended.EndStage();
    Add(ended);
    return;
  }
  if (isAdaptive_ && passes_ > 0) EndStage();
  for (size_t i = 0; i < pixels_.size(); ++i) pixels_[i].Add(other.pixels_[i]);
  AddAll(layerSums_, other.layerSums_);
  if (isAdaptive_) AddStages(other);
  if (other.KeepsBias()) {
    KeepBias();
    for (size_t i = 0; i < bias_.size(); ++i) bias_[i].Add(other.bias_[i]);
    for (size_t i = 0; i < biasStages_.size(); ++i) biasStages_[i].Add(other.biasStages_[i]);
  }
  for (size_t c = 0; c < 3; ++c) whiteSum_[c] += other.whiteSum_[c];
  for (size_t band = 0; band < bandWeights_.size(); ++band) bandWeights_[band] += other.bandWeights_[band];
  whitePasses_ += other.whitePasses_;
  if (other.splats_.empty()) return;
  MakeSplats();
  for (size_t i = 0; i < splats_.size(); ++i) splats_[i].Add(other.splats_[i]);
  AddAll(layerSplats_, other.layerSplats_);
  lightPaths_ += other.lightPaths_;
  halfPaths_ += other.halfPaths_;
  splatSpread_ = other.splatSpread_;
}

void Film::CopyFrom(const Film& other, int threads) {
  Copy(pixels_, other.pixels_, threads);
  Copy(splats_, other.splats_, threads);
  Copy(layerSums_, other.layerSums_, threads);
  Copy(layerSplats_, other.layerSplats_, threads);
  Copy(stages_, other.stages_, threads);
  Copy(groups_, other.groups_, threads);
  Copy(bias_, other.bias_, threads);
  Copy(biasStages_, other.biasStages_, threads);
  Copy(layerStages_, other.layerStages_, threads);
  lightPaths_ = other.lightPaths_;
  halfPaths_ = other.halfPaths_;
  whiteSum_ = other.whiteSum_;
  bandWeights_ = other.bandWeights_;
  whitePasses_ = other.whitePasses_;
  splatSpread_ = other.splatSpread_;
  passes_ = other.passes_;
  endedPasses_ = other.endedPasses_;
}

Film Film::EmptyCopy() const {
  Film empty(fullWidth_, fullHeight_, crop_, layers_);
  if (isAdaptive_) empty.MakeAdaptive(HasGroups());
  if (KeepsBias()) empty.KeepBias();
  return empty;
}

void Film::CountWhite(const std::array<double, 3>& white) {
  for (size_t c = 0; c < 3; ++c) whiteSum_[c] += white[c];
  for (int i = 0; i < 3 && HasBands(); ++i) {
    if (lanes_.band[i] >= 0) bandWeights_[static_cast<size_t>(lanes_.band[i])] += lanes_.weight[i];
  }
  ++whitePasses_;
}

double Film::WhiteScale(size_t channel) const {
  return whitePasses_ > 0 && whiteSum_[channel] > 0 ? static_cast<double>(whitePasses_) / whiteSum_[channel] : 1.0;
}

double Film::SampledFraction() const {
  const auto sampled =
      std::count_if(pixels_.begin(), pixels_.end(), [](const PixelSums& pixel) { return pixel.count > 0; });
  return static_cast<double>(sampled) / static_cast<double>(pixels_.size());
}

void Film::Save(ByteWriter& bytes) const {
  bytes.Values(std::span(pixels_));
  bytes.Values(std::span(layerSums_));
  if (isAdaptive_) {
    bytes.Values(std::span(stages_));
    bytes.Values(std::span(groups_));
    bytes.Values(std::span(layerStages_));
    bytes.Value(passes_);
    bytes.Value(endedPasses_);
    bytes.Value(halfPaths_);
  }
  bytes.Value(static_cast<uint8_t>((splats_.empty() ? 0 : kHasSplats) | (KeepsBias() ? kHasBias : 0) |
                                   (whitePasses_ > 0 ? kHasWhite : 0)));
  if (!splats_.empty()) {
    bytes.Values(std::span(splats_));
    bytes.Values(std::span(layerSplats_));
    bytes.Value(lightPaths_);
    bytes.Value(splatSpread_);
  }
  bytes.Values(std::span(bias_));
  bytes.Values(std::span(biasStages_));
  if (whitePasses_ == 0) return;
  bytes.Value(whiteSum_);
  bytes.Value(whitePasses_);
  bytes.Values(std::span(bandWeights_));
}

void Film::Load(ByteReader& bytes) {
  Film film = EmptyCopy();
  bytes.Values(std::span(film.pixels_));
  bytes.Values(std::span(film.layerSums_));
  if (isAdaptive_) {
    bytes.Values(std::span(film.stages_));
    bytes.Values(std::span(film.groups_));
    bytes.Values(std::span(film.layerStages_));
    film.passes_ = bytes.Value<uint32_t>();
    film.endedPasses_ = bytes.Value<uint64_t>();
    film.halfPaths_ = bytes.Value<uint64_t>();
    film.CheckStages();
  }
  const auto parts = bytes.Value<uint8_t>();
  if ((parts & ~(kHasSplats | kHasBias | kHasWhite)) != 0) throw Error("it holds a number out of range");
  if ((parts & kHasSplats) != 0) {
    film.MakeSplats();
    bytes.Values(std::span(film.splats_));
    bytes.Values(std::span(film.layerSplats_));
    film.lightPaths_ = bytes.Value<uint64_t>();
    film.splatSpread_ = bytes.Value<double>();
  }
  if (film.halfPaths_ > film.lightPaths_) throw Error("it holds a number out of range");
  if (KeepsBias() && (parts & kHasBias) == 0) throw Error("it holds no estimates of the bias of merging photons");
  if ((parts & kHasBias) != 0) {
    film.KeepBias();
    bytes.Values(std::span(film.bias_));
    bytes.Values(std::span(film.biasStages_));
  }
  if ((parts & kHasWhite) != 0) {
    film.whiteSum_ = bytes.Value<std::array<double, 3>>();
    film.whitePasses_ = bytes.Value<uint64_t>();
    for (const double white : film.whiteSum_)
      if (!std::isfinite(white)) throw Error("it holds sums that are not finite");
    bytes.Values(std::span(film.bandWeights_));
    for (const double weight : film.bandWeights_)
      if (!std::isfinite(weight)) throw Error("it holds sums that are not finite");
  }
  const bool isFinite =
      std::all_of(film.pixels_.begin(), film.pixels_.end(), [](const PixelSums& pixel) { return pixel.IsFinite(); }) &&
      std::all_of(film.splats_.begin(), film.splats_.end(), [](const SplatSums& sums) { return sums.IsFinite(); }) &&
      std::all_of(film.layerSums_.begin(), film.layerSums_.end(), [](const LayerSum& s) { return AreFinite(s); }) &&
      std::all_of(film.layerSplats_.begin(), film.layerSplats_.end(), [](const LayerSum& s) { return AreFinite(s); }) &&
      std::isfinite(film.splatSpread_) && film.StagesAreFinite() && film.BiasIsFinite();
  if (!isFinite) throw Error("it holds sums that are not finite");
  *this = std::move(film);
}

float Film::SplatShare(size_t pixel) const {
  double splats = 0, all = 0;
  for (int c = 0; c < 3; ++c) {
    splats += VarianceOfSplats(pixel, c);
    all += VarianceOfMean(pixel, c);
  }
  return all > 0 ? static_cast<float>(std::min(splats / all, 1.0)) : 0.0f;
}

Image Film::Develop() const {
  std::vector<std::string> channels = {"R", "G", "B", "variance.R", "variance.G", "variance.B"};
  // Number of channels of each layer: three, but for the last layer of bands.
  std::vector<size_t> widths;
  for (const std::string& layer : layers_) {
    const std::vector<std::string> bands = IsBandLayer(layer) ? Split(layer, ' ') : std::vector<std::string>();
    for (const std::string& channel : bands) channels.push_back(channel);
    for (const char* channel : {".R", ".G", ".B"}) {
      if (bands.empty()) channels.push_back(layer + channel);
    }
    widths.push_back(bands.empty() ? 3 : bands.size());
  }
  const bool hasWideSplats =
      splatSpread_ > 1 && std::any_of(splats_.begin(), splats_.end(), [](const SplatSums& splats) {
        return splats.SumOfSquares(0) + splats.SumOfSquares(1) + splats.SumOfSquares(2) > 0;
      });
  if (hasWideSplats) channels.emplace_back(kSplatShareChannel);
  Image image(crop_.Width(), crop_.Height(), std::move(channels));
  image.offsetX = crop_.x0;
  image.offsetY = crop_.y0;
  image.fullWidth = fullWidth_;
  image.fullHeight = fullHeight_;
  if (isAdaptive_ && hasHalf_) image.metadata[kHalfShareMetadata] = "0.5";
  const std::array<double, 3> white = {WhiteScale(0), WhiteScale(1), WhiteScale(2)};
  const size_t firstBand = SplitLayers();
  float* out = image.data.data();
  for (size_t i = 0; i < pixels_.size(); ++i) {
    for (int c = 0; c < 3; ++c) *out++ = ToFiniteFloat(white[static_cast<size_t>(c)] * Value(i, c));
    for (int c = 0; c < 3; ++c)
      *out++ = ToFiniteFloat(std::pow(white[static_cast<size_t>(c)], 2) * VarianceOfMean(i, c));
    for (size_t layer = 0; layer < layers_.size(); ++layer) {
      const bool isOfBands = layer >= firstBand && layer < firstBand + bandLayers_;
      for (size_t c = 0; c < widths[layer]; ++c) {
        const double scale = isOfBands ? BandScale(3 * (layer - firstBand) + c) : white[c];
        *out++ = ToFiniteFloat(scale * LayerValue(i, layer, c));
      }
    }
    if (hasWideSplats) *out++ = SplatShare(i);
  }
  return image;
}

ErrorParts Film::PartsOfError(double largestSample) const {
  double varianceSum = 0, fourthSum = 0, luminanceSum = 0, samples = 0;
  for (size_t i = 0; i < pixels_.size(); ++i) {
    const uint64_t own = Samples(i);
    const bool tooFew = lightPaths_ > 0 ? lightPaths_ < 2 || own == 1 : own < 2;
    if (tooFew) return {std::numeric_limits<double>::infinity(), 0};
    // The channels of a sample share its path: they are taken as fully correlated, which bounds the variance from
    // above.
    double deviation = 0, value = 0;
    for (int c = 0; c < 3; ++c) {
      deviation += Color::kLuminance[c] * std::sqrt(VarianceOfMean(i, c));
      value += Color::kLuminance[c] * Value(i, c);
    }
    varianceSum += deviation * deviation;
    fourthSum += FourthOfMean(i);
    luminanceSum += value;
    samples += static_cast<double>(own);
  }
  const double n = static_cast<double>(pixels_.size());
  const double largest = samples > 0 ? std::pow(largestSample * n / samples, 2) : 0;
  const double bound = UpperBound(varianceSum, fourthSum, largest), biasSquare = MeanBiasSquare();
  const double meanLuminance = luminanceSum / n;
  // An image that is black after this many samples per pixel counts as converged. Before that, light paths may still
  // find a contribution: pixels have no variance until the first splat.
  constexpr double kLong = 4096;
  const bool isBlack = varianceSum == 0 && meanLuminance == 0;
  const double lightPathsPerPixel =
      static_cast<double>(lightPaths_) / (static_cast<double>(fullWidth_) * static_cast<double>(fullHeight_));
  if (isBlack && std::max(samples / n, lightPathsPerPixel) >= kLong) return {};
  if (bound == 0 && biasSquare == 0 && !(isBlack && lightPaths_ > 0)) return {};  // black or constant
  if (!(meanLuminance > 0)) return {std::numeric_limits<double>::infinity(), 0};
  return {1.959963984540054 * std::sqrt(bound / n) / meanLuminance, std::sqrt(biasSquare) / meanLuminance};
}

}  // namespace lampyr
