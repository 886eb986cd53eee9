#include "render/both_paths.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "render/light_edges.h"
#include "render/settings/integrator_choice.h"
#include "render/strategy_recorder.h"

namespace lampyr {

namespace {

constexpr uint64_t kBeforeTheFirst = 0x6a09e667f3bcc908;  // changes the seed for the photons of the first pass
constexpr uint64_t kMorePaths = 0xbb67ae8584caa73b;       // changes the seed for further light paths of a sample
constexpr int kPassTimes = -2;                            // in the place of the pixel row, for what passes share

// Fetches the sums of a pixel into the cache, while its sample is traced.
void PrefetchSums(const PixelSums& sums) {
  constexpr size_t kLine = 64;
  for (size_t offset = 0; offset < sizeof(PixelSums); offset += kLine)
    Prefetch(reinterpret_cast<const char*>(&sums) + offset);
}

// A pass of camera and light paths, in chunks of the pixels of the full image.
class BothPaths {
 public:
  BothPaths(const Pass& pass, PhotonStore* kept)
      : pass_(pass),
        wanted_(pass.integrator.Photons()),
        own_(wanted_.value_or(PhotonSettings()), pass.Pixels()),
        store_(kept ? *kept : own_),
        lightPaths_(wanted_ ? store_.LightPaths() : pass.Pixels()),
        log2LightPaths_(pass.integrator.Log2LightPaths()),
        tracesAnew_(wanted_ && (pass.scene.hasMotion || pass.scene.isSpectral)),
        chunks_(4 * std::max(pass.threads, 1)),
        // Smaller chunks for small images, so that all threads have work.
        chunkPaths_(std::min((pass.Pixels() + static_cast<uint64_t>(chunks_) - 1) / static_cast<uint64_t>(chunks_),
                             kChunkPaths)),
        // The limit of a sample is on what a splat adds to it: divided by the light paths of a sample.
        splats_(static_cast<size_t>(chunks_),
                pass.film.MakeSplatList(
                    pass.filter, pass.settings.sensor.WithLimitTimes(std::exp2(static_cast<float>(log2LightPaths_))))),
        photons_(static_cast<size_t>(chunks_)),
        records_(pass.MakeRecords(static_cast<size_t>(chunks_))),
        tested_(pass.MakeTested(static_cast<size_t>(chunks_))),
        counts_(static_cast<size_t>(chunks_)) {}

  RenderCounts Trace() {
    if (wanted_ && !tracesAnew_ && !store_.IsFor(pass_.first)) TracePhotonsBefore(pass_.first);
    // Sample by sample over all pixels: chunks never share a pixel, and the film adds paths in their order.
    for (uint32_t index = pass_.first; index < pass_.end; ++index) {
      if (tracesAnew_) {
        store_.Clear();
        TracePhotons(0, index, SeedOfPhotons());
        store_.Finish(index);
      }
      if (wanted_) gather_ = &store_.Open(index, pass_.threads);
      for (uint64_t round = 0; round < pass_.Pixels(); round += PathsPerRound()) {
        TraceRound(round, pass_.Pixels(), index, pass_.Seed(), true);
        if (wanted_ && !tracesAnew_) store_.Take(photons_);
        pass_.film.AddSplats(pass_.filter, splats_, pass_.threads, index);
      }
      if (tracesAnew_) {
        store_.EndGathering();
      } else if (wanted_) {
        TracePhotons(pass_.Pixels(), index, pass_.Seed());
        store_.Finish(index + 1);
      }
    }
    if (pass_.learning) pass_.learning->Learn(records_);
    if (pass_.selection) pass_.selection->Learn(tested_);
    return Total(counts_);
  }

 private:
  class AdaptivePixels;
  struct SlotSampler;

  uint64_t PathsPerRound() const { return static_cast<uint64_t>(chunks_) * chunkPaths_; }
  uint64_t SeedOfPhotons() const { return MixBits(pass_.Seed() + kBeforeTheFirst); }

  // Traces the photons that the sample before would have left. Before the very first sample, or that of a stage, these
  // are photons of other light paths.
  void TracePhotonsBefore(uint32_t index) {
    store_.Clear();
    const bool isFirst = index == pass_.Offset();
    TracePhotons(0, isFirst ? index : index - 1, isFirst ? SeedOfPhotons() : pass_.Seed());
    store_.Finish(index);
  }
  // Traces light paths for their photons only.
  void TracePhotons(uint64_t begin, uint32_t index, uint64_t seed) {
    for (uint64_t round = begin; round < lightPaths_; round += PathsPerRound()) {
      TraceRound(round, lightPaths_, index, seed, false);
      store_.Take(photons_);
    }
  }

  // Traces the pixels from `round` on, as many as the chunks take. Without `withCamera`: light paths for their photons
  // only.
  void TraceRound(uint64_t round, uint64_t end, uint32_t index, uint64_t seed, bool withCamera) {
    const float passTime =
        wanted_ && pass_.scene.hasMotion ? SharedByPass(pass_.settings.seed, pass_.allocation, index).time : 0;
    ParallelFor(chunks_, pass_.threads, [&](int chunk) {
      uint64_t begin = std::min(round + static_cast<uint64_t>(chunk) * chunkPaths_, end);
      uint64_t chunkEnd = std::min(begin + chunkPaths_, end);
      if (withCamera && pass_.allocation) {
        begin = NextPixelFrom(begin, index);
        chunkEnd = NextPixelFrom(chunkEnd, index);
      }
      TraceChunk(static_cast<size_t>(chunk), begin, chunkEnd, index, seed, withCamera, passTime);
    });
  }
  // Slots of the crop before a slot.
  uint64_t CropSlotsBefore(uint64_t slot) const;
  // The first slot from `slot` on before which the samples of a pixel end: chunks share no pixel.
  uint64_t NextPixelFrom(uint64_t slot, uint32_t index) const;
  // The light paths of a sample of a pixel: none, or some. `index`: of the sample, becomes that of the light path.
  int LightPathsOf(int x, int y, uint32_t& index) const;
  void TraceChunk(size_t chunk, uint64_t begin, uint64_t end, uint32_t index, uint64_t seed, bool withCamera,
                  float passTime);
  // `context`: of the sample of a slot.
  void StartLightPath(size_t chunk, bool keepsPhotons, uint32_t index, SampleContext& context);

  const Pass& pass_;
  const std::optional<PhotonSettings> wanted_;
  PhotonStore own_;
  PhotonStore& store_;
  const uint64_t lightPaths_;  // of a pass, but for log2LightPaths_
  const int log2LightPaths_;
  // True if photons come from light paths traced for each sample, at its time because things move, or at its
  // wavelengths. Otherwise they are those that the light paths of the sample before have left.
  const bool tracesAnew_;
  const int chunks_;
  const uint64_t chunkPaths_;
  const PhotonPass* gather_ = nullptr;
  // Per chunk:
  std::vector<SplatList> splats_;
  std::vector<PhotonList> photons_;
  std::vector<PathRecords> records_;   // none, unless camera paths are recorded
  std::vector<TestedSamples> tested_;  // none, unless selection of lights learns
  std::vector<RenderCounts> counts_;
};

uint64_t BothPaths::CropSlotsBefore(uint64_t slot) const {
  const PixelRect& crop = pass_.film.Crop();
  const auto width = static_cast<uint64_t>(pass_.settings.width);
  const auto within = [](uint64_t value, int begin, int end) {
    return std::clamp(static_cast<int64_t>(value) - begin, int64_t{0}, int64_t{end - begin});
  };
  const uint64_t x = slot % width, y = slot / width;
  const int64_t rows = within(y, crop.y0, crop.y1);
  const bool isInRow = y >= static_cast<uint64_t>(crop.y0) && y < static_cast<uint64_t>(crop.y1);
  return static_cast<uint64_t>(rows * crop.Width() + (isInRow ? within(x, crop.x0, crop.x1) : 0));
}

uint64_t BothPaths::NextPixelFrom(uint64_t slot, uint32_t index) const {
  const uint32_t pass = index - pass_.Offset();
  const PixelRect& crop = pass_.film.Crop();
  const auto cropWidth = static_cast<uint64_t>(crop.Width());
  while (slot > 0 && slot < pass_.Pixels()) {
    const uint64_t k = CropSlotsBefore(slot);
    const bool isFirst = k == 0 || k >= pass_.film.Pixels() ||
                         pass_.allocation->PixelOf(k, pass) != pass_.allocation->PixelOf(k - 1, pass);
    if (isFirst) break;
    const uint64_t x = static_cast<uint64_t>(crop.x0) + k % cropWidth,
                   y = static_cast<uint64_t>(crop.y0) + k / cropWidth;
    slot = y * static_cast<uint64_t>(pass_.settings.width) + x + 1;
  }
  return slot;
}

// With one light path in n samples the pixels of a row, and of a column, take turns. In adaptive films, where a pixel
// does not have every sample in the same place, every pass begins the turns anew.
int BothPaths::LightPathsOf(int x, int y, uint32_t& index) const {
  if (log2LightPaths_ >= 0) return 1 << log2LightPaths_;
  if (pass_.allocation) {
    const auto place = static_cast<uint32_t>(x + 3 * y) + static_cast<uint32_t>(MixBits(pass_.Seed() + index));
    return place % (1u << -log2LightPaths_) == 0 ? 1 : 0;
  }
  const auto turn = static_cast<uint32_t>(x + 3 * y);
  const auto samples = 1u << -log2LightPaths_;
  const auto shift = static_cast<uint32_t>(MixBits(pass_.settings.seed));
  const uint32_t moved = index + (turn + shift) % samples;
  index = moved / samples;
  return moved % samples == 0 ? 1 : 0;
}

// The samples of a chunk of an adaptive film: those of one pixel after the other.
class BothPaths::AdaptivePixels {
 public:
  // `isReplay`: the samples of the pass are in the film already, and are traced again for their photons.
  AdaptivePixels(const Pass& pass, uint32_t index, bool isReplay)
      : pass_(pass), stagePass_(index - pass.Offset()), isReplay_(isReplay), samplers_(pass) {}
  ~AdaptivePixels() { EndPixel(); }
  AdaptivePixels(const AdaptivePixels&) = delete;

  // Begins the sample of a slot of the crop.
  Sampler& Start(uint64_t slot) {
    const PixelRect& crop = pass_.film.Crop();
    const SampleAllocation& allocation = *pass_.allocation;
    if (slot < pixelBegin_ || slot >= pixelEnd_) {
      const size_t pixel = allocation.PixelOf(slot, stagePass_);
      EndPixel();
      pixelBegin_ = allocation.Before(pixel, stagePass_);
      pixelEnd_ = allocation.Before(pixel + 1, stagePass_);
      isBegun_ = true;
      x_ = crop.x0 + static_cast<int>(pixel % static_cast<size_t>(crop.Width()));
      y_ = crop.y0 + static_cast<int>(pixel / static_cast<size_t>(crop.Width()));
      sums_ = pass_.film.Pixel(x_, y_);
    }
    number_ = pass_.film.Pixel(x_, y_).count + slot - pixelBegin_;
    if (isReplay_) number_ -= pixelEnd_ - pixelBegin_;
    return samplers_.Start(x_, y_, number_);
  }
  int X() const { return x_; }
  int Y() const { return y_; }
  // Index of the sample among those of its pixel and stage.
  uint32_t Number() const { return static_cast<uint32_t>(number_); }
  // Adds the radiance of the sample.
  void Add(const PixelRay& ray, const Color& radiance, SampleAdder& adder) {
    adder.Add(x_, y_, AdaptiveSampler::IsInHalf(number_), ray, radiance, sums_, &ofPass_, &biasOfPass_);
  }

 private:
  void EndPixel() {
    if (!isBegun_ || isReplay_) return;
    pass_.film.Pixel(x_, y_) = sums_;
    if (pass_.film.HasGroups()) pass_.film.AddGroup(x_, y_, ofPass_);
    if (pass_.film.KeepsBias()) pass_.film.AddBias(x_, y_, biasOfPass_);
    ofPass_ = PixelSums();
    biasOfPass_ = PassBias();
  }

  const Pass& pass_;
  uint32_t stagePass_;
  bool isReplay_;
  AdaptiveSampler samplers_;
  int x_ = 0, y_ = 0;                       // pixel of the sample
  uint64_t pixelBegin_ = 0, pixelEnd_ = 0;  // its slots
  uint64_t number_ = 0;
  bool isBegun_ = false;
  PixelSums sums_, ofPass_;  // of the pixel: with those of earlier passes, and of this one
  PassBias biasOfPass_;
};

// Starts the samples of slots.
struct BothPaths::SlotSampler {
  // `adaptive`: null where slots are those of their own pixels.
  SlotSampler(const BothPaths& paths, uint64_t seed, uint32_t anIndex, AdaptivePixels* adaptive)
      : paths_(paths), index_(anIndex), adaptive_(adaptive), sampler_(paths.pass_.settings.sampler, seed) {}

  Sampler& Start(uint64_t slot) {
    const auto width = static_cast<uint64_t>(paths_.pass_.settings.width);
    x = static_cast<int>(slot % width);
    y = static_cast<int>(slot / width);
    number = lightNumber = index_ - paths_.pass_.Offset();
    lightPaths = paths_.LightPathsOf(x, y, lightNumber);
    const PixelRect& crop = paths_.pass_.film.Crop();
    isInCrop = x >= crop.x0 && x < crop.x1 && y >= crop.y0 && y < crop.y1;
    if (!adaptive_ || !isInCrop) {
      sampler_.StartPixelSample(x, y, number);
      return sampler_;
    }
    Sampler& sampler = adaptive_->Start(paths_.CropSlotsBefore(slot));
    x = adaptive_->X();
    y = adaptive_->Y();
    number = adaptive_->Number();
    return sampler;
  }

  int x = 0, y = 0;          // pixel of the sample
  uint32_t number = 0;       // of the sample in its sequence
  uint32_t lightNumber = 0;  // of its light path, where there are fewer of them
  int lightPaths = 0;
  bool isInCrop = false;

 private:
  const BothPaths& paths_;
  uint32_t index_;
  AdaptivePixels* adaptive_;
  Sampler sampler_;
};

// A slot is a pixel of the full image, or one of the light paths beyond them. In an adaptive film the samples of the
// crop take its slots in the order of their pixels; random numbers are those of the pixel.
void BothPaths::TraceChunk(size_t chunk, uint64_t begin, uint64_t end, uint32_t index, uint64_t seed, bool withCamera,
                           float passTime) {
  const RenderSettings& settings = pass_.settings;
  splats_[chunk].Clear();
  SampleAdder adder(settings, pass_.film, counts_[chunk]);
  LayerSample* layers = adder.StartLayers();
  std::optional<StrategyRecorder> recorder;
  if (withCamera && pass_.HasStrategies())
    recorder.emplace(StrategiesOf(settings), static_cast<uint32_t>(pass_.PlannedLayers()), *layers, splats_[chunk]);
  Sampler lightSampler(settings.sampler, seed), moreSampler(settings.sampler, MixBits(seed + kMorePaths));
  std::optional<AdaptivePixels> adaptive;
  if (pass_.allocation && (withCamera || seed == pass_.Seed())) adaptive.emplace(pass_, index, !withCamera);
  SlotSampler slots(*this, seed, index, adaptive ? &*adaptive : nullptr);
  EdgeSampler edges(pass_, wanted_.has_value());
  for (uint64_t i = begin; i < end; ++i) {
    const bool keepsPhotons = wanted_ && i < lightPaths_ && store_.HasRoom() && !(tracesAnew_ && withCamera);
    if (!keepsPhotons && !withCamera) break;
    Sampler& sampler = slots.Start(i);
    const int x = slots.x, y = slots.y, lightPaths = slots.lightPaths;
    const float time = wanted_ && pass_.scene.hasMotion ? passTime : SampleTime(pass_.scene, sampler);
    SampleContext context{pass_.scene, sampler, time, counts_[chunk]};
    context.observer = recorder ? &*recorder : nullptr;
    context.outputs = pass_.Outputs();
    if (context.outputs) context.layers = layers;
    context.gather = withCamera ? gather_ : nullptr;
    context.isForPhotonsAlone = !withCamera;
    context.tracesLight = lightPaths > 0;
    if (pass_.scene.isSpectral) context.lane = FirstLane(seed, i, slots.number);
    if (lightPaths > 0) StartLightPath(chunk, keepsPhotons, index, context);
    if (log2LightPaths_ < 0 && !pass_.allocation) {
      lightSampler.StartPixelSample(x, y, slots.lightNumber);
      context.lightSampler = &lightSampler;
    }
    if (!withCamera || !slots.isInCrop) {
      if (lightPaths > 0) SampleLanes(pass_.integrator, nullptr, context);
    } else {
      PixelRay ray = MakePixelRay(pass_.scene, pass_.filter, x, y, time, sampler);
      context.film = ray.film;
      pass_.Record(x, y, pass_.allocation ? slots.number : index, pass_.learning ? &records_[chunk] : nullptr,
                   pass_.selection ? &tested_[chunk] : nullptr, context);
      if (!adaptive) PrefetchSums(pass_.film.Pixel(x, y));
      context.mergeBias = adder.StartBias();
      adder.StartLayers();
      const Color radiance = edges.Radiance(x, y, slots.number, context, ray);
      if (adaptive) {
        adaptive->Add(ray, radiance, adder);
      } else {
        adder.Add(x, y, IsInHalf(index), ray, radiance, pass_.film.Pixel(x, y));
      }
    }
    const auto more = static_cast<uint32_t>(std::max(lightPaths - 1, 0));
    for (uint32_t k = 0; k < more; ++k) {
      StartLightPath(chunk, keepsPhotons, index, context);
      moreSampler.StartPixelSample(x, y, slots.number * more + k);
      SampleLanes(pass_.integrator, nullptr, context.With(moreSampler));
    }
  }
}

void BothPaths::StartLightPath(size_t chunk, bool keepsPhotons, uint32_t index, SampleContext& context) {
  splats_[chunk].StartPath();
  context.splats = &splats_[chunk];
  if (!keepsPhotons) return;
  photons_[chunk].StartPath();
  context.photons = &photons_[chunk];
  context.lastGathering = index + 1;
  context.withOrigin = store_.WantsOrigins();
}

}  // namespace

SharedByPass::SharedByPass(uint64_t seed, const SampleAllocation* allocation, uint32_t pass) {
  const uint32_t first = allocation ? allocation->Stage().first - allocation->Stage().before : 0;
  Sampler sampler(SamplerKind::Sobol, first == 0 ? seed : MixBits(seed + first));
  sampler.StartPixelSample(0, kPassTimes, pass - first);
  sampler.SetDimension(dimensions::kTime);
  const Point2 point = sampler.Get2D();
  time = point.x;
  wavelengths = point.y;
}

RenderCounts TraceBothPaths(const Pass& pass, PhotonStore* kept) {
  return BothPaths(pass, kept).Trace();
}

}  // namespace lampyr
