#include "app/render_run.h"

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "base/parallel.h"
#include "base/stop.h"
#include "sampling/rng.h"

namespace lampyr {

namespace {

constexpr int kTileSize = 16;
constexpr uint64_t kChunkPaths = 4096;  // light paths that one thread traces before their splats are added
constexpr uint64_t kBeforeTheFirst = 0x6a09e667f3bcc908;  // of the seed of the photons that the first pass gathers
// Where camera samples have the row of their pixel:
constexpr int kLightPaths = -1, kPassTimes = -2;

// One time of the shutter for all of a path.
float SampleTime(const RenderScene& scene, Sampler& sampler) {
  if (!scene.hasMotion) return 0;
  sampler.SetDimension(dimensions::kTime);
  return sampler.Get1D();
}

// The time of all paths of a pass, in scenes with motion: a photon is where its path was at that time, and only paths
// of the same time may meet it. Times of consecutive passes are stratified.
float PassTime(const RenderSettings& settings, uint32_t pass) {
  Sampler sampler(settings.sampler, settings.seed);
  sampler.StartPixelSample(0, kPassTimes, pass);
  sampler.SetDimension(dimensions::kTime);
  return sampler.Get1D();
}

// A ray through one pixel.
struct PixelRay {
  CameraRay camera;
  float filterWeight = 1;
};
PixelRay MakePixelRay(const RenderScene& scene, const PixelFilter& filter, int x, int y, float time, Sampler& sampler) {
  sampler.SetDimension(dimensions::kFilm);
  const PixelFilter::Offset offset = filter.Sample(sampler.Get2D());
  const Point2 film(static_cast<float>(x) + 0.5f + offset.offset.x, static_cast<float>(y) + 0.5f + offset.offset.y);
  Point2 lens(0.5f);
  if (!scene.camera->HasPinhole()) {
    sampler.SetDimension(dimensions::kLens);
    lens = sampler.Get2D();
  }
  return {scene.camera->GenerateRay(film, lens, time), offset.weight};
}

// Where samples of one thread go.
struct SampleAdder {
  SampleAdder(const RenderSettings& settings, Film& aFilm, RenderCounts& someCounts)
      : imagingRatio(settings.imagingRatio), film(aFilm), counts(someCounts) {
    if (film.HasLayers()) layers.emplace(film.Layers().size());
  }

  // What the next sample is to be split into; null: nothing.
  LayerSample* StartLayers() {
    if (!layers) return nullptr;
    layers->Clear();
    return &*layers;
  }
  // A sample of one pixel, added to `sums` and to the pixel's layers. A value that is none is left out of both and
  // counted.
  void Add(int x, int y, const PixelRay& ray, const Color& radiance, PixelSums& sums) {
    const float scale = ray.camera.weight * imagingRatio;
    Color value = radiance * scale;
    const bool isValid = value.IsValid();
    if (!isValid) {
      ++counts.droppedSamples;
      value = Color(0.0f);
    }
    sums.Add(value, ray.filterWeight);
    if (layers && isValid) film.AddToLayers(x, y, *layers, scale, ray.filterWeight);
  }

  float imagingRatio;
  Film& film;
  RenderCounts& counts;
  std::optional<LayerSample> layers;
};

struct Clock {
  std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();
  double Seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(); }
};

double FractionDone(const RenderOutcome& outcome, const StopConditions& stop) {
  double fraction = static_cast<double>(outcome.samplesPerPixel) / stop.samplesPerPixel;
  if (stop.seconds) fraction = std::max(fraction, outcome.seconds / *stop.seconds);
  // The error falls with the square root of the samples.
  if (stop.relativeError && outcome.relativeError > 0) {
    fraction = std::max(fraction, std::pow(*stop.relativeError / outcome.relativeError, 2.0));
  }
  return std::min(fraction, 1.0);
}

}  // namespace

RenderCounts RenderPass(const RenderScene& scene, const CameraIntegrator& integrator, const RenderSettings& settings,
                        const PixelFilter& filter, uint32_t first, uint32_t count, int threads, Film& film) {
  const PixelRect& crop = film.Crop();
  const int tilesX = (crop.Width() + kTileSize - 1) / kTileSize;
  const int tilesY = (crop.Height() + kTileSize - 1) / kTileSize;
  std::vector<RenderCounts> tileCounts(static_cast<size_t>(tilesX) * tilesY);
  ParallelFor(tilesX * tilesY, threads, [&](int tile) {
    const int x0 = crop.x0 + tile % tilesX * kTileSize, x1 = std::min(x0 + kTileSize, crop.x1);
    const int y0 = crop.y0 + tile / tilesX * kTileSize, y1 = std::min(y0 + kTileSize, crop.y1);
    Sampler sampler(settings.sampler, settings.seed);
    RenderCounts counts;
    SampleAdder adder(settings, film, counts);
    for (int y = y0; y < y1; ++y) {
      for (int x = x0; x < x1; ++x) {
        PixelSums sums = film.Pixel(x, y);
        for (uint32_t i = 0; i < count; ++i) {
          sampler.StartPixelSample(x, y, first + i);
          const PixelRay ray = MakePixelRay(scene, filter, x, y, SampleTime(scene, sampler), sampler);
          adder.Add(x, y, ray, integrator.Radiance(ray.camera.ray, sampler, counts, adder.StartLayers()), sums);
        }
        film.Pixel(x, y) = sums;
      }
    }
    tileCounts[tile] = counts;
  });
  RenderCounts total;
  for (const RenderCounts& counts : tileCounts) total += counts;
  return total;
}

RenderCounts RenderPass(const RenderScene& scene, const LightPathIntegrator& integrator, const RenderSettings& settings,
                        const PixelFilter& filter, uint32_t first, uint32_t count, int threads, Film& film) {
  const uint64_t perSample = static_cast<uint64_t>(settings.width) * static_cast<uint64_t>(settings.height);
  const uint64_t end = (static_cast<uint64_t>(first) + count) * perSample;
  // As many chunks at a time as keep all threads busy: memory stays bounded. The film adds paths in their order, so the
  // division into chunks does not show.
  const int chunks = 4 * std::max(threads, 1);
  std::vector<SplatList> lists(static_cast<size_t>(chunks), film.MakeSplatList(filter, settings.imagingRatio));
  std::vector<RenderCounts> counts(static_cast<size_t>(chunks));
  for (uint64_t round = first * perSample; round < end; round += chunks * kChunkPaths) {
    ParallelFor(chunks, threads, [&](int chunk) {
      SplatList& splats = lists[static_cast<size_t>(chunk)];
      splats.Clear();
      Sampler sampler(settings.sampler, settings.seed);
      const uint64_t begin = round + static_cast<uint64_t>(chunk) * kChunkPaths;
      for (uint64_t i = begin; i < std::min(begin + kChunkPaths, end); ++i) {
        sampler.StartPixelSample(static_cast<int>(i >> 32), kLightPaths, static_cast<uint32_t>(i));
        splats.StartPath();
        integrator.TracePath(SampleTime(scene, sampler), sampler, splats, counts[static_cast<size_t>(chunk)]);
      }
    });
    film.AddSplats(filter, lists, threads);
  }
  RenderCounts total;
  for (const RenderCounts& part : counts) total += part;
  return total;
}

namespace {

// What a sweep over all pixels leaves, chunk by chunk.
struct Sweep {
  Sweep(int chunks, const Film& film, const PixelFilter& filter, float scale)
      : splats(static_cast<size_t>(chunks), film.MakeSplatList(filter, scale)),
        photons(static_cast<size_t>(chunks)),
        counts(static_cast<size_t>(chunks)) {}

  RenderCounts Total() const {
    RenderCounts total;
    for (const RenderCounts& part : counts) total += part;
    return total;
  }

  std::vector<SplatList> splats;
  std::vector<PhotonList> photons;
  std::vector<RenderCounts> counts;
};

}  // namespace

RenderCounts RenderPass(const RenderScene& scene, const BidirectionalIntegrator& integrator,
                        const RenderSettings& settings, const PixelFilter& filter, uint32_t first, uint32_t count,
                        int threads, Film& film, TechniqueImages* techniques, PhotonStore* kept) {
  const auto width = static_cast<uint64_t>(settings.width), height = static_cast<uint64_t>(settings.height);
  const uint64_t pixels = width * height;
  const PixelRect& crop = film.Crop();
  const int chunks = 4 * std::max(threads, 1);
  // A small image has work for all threads, too.
  const uint64_t share = (pixels + static_cast<uint64_t>(chunks) - 1) / static_cast<uint64_t>(chunks);
  const uint64_t chunkPaths = std::min(share, kChunkPaths);
  Sweep sweep(chunks, film, filter, settings.imagingRatio);
  std::vector<TechniqueImages::Recorder> recorders;
  if (techniques) recorders.assign(static_cast<size_t>(chunks), TechniqueImages::Recorder(*techniques, filter));

  const std::optional<PhotonSettings> wanted = integrator.Photons();
  PhotonStore here(wanted.value_or(PhotonSettings()), pixels);
  PhotonStore& store = kept ? *kept : here;
  const PhotonPass* gather = nullptr;
  const uint64_t lightPaths = wanted ? store.LightPaths() : pixels;
  // Photons are those that the light paths of the pass before have left, or, where things move, those of paths that are
  // traced for them at the time of the pass that gathers them.
  const bool hasTimes = wanted && scene.hasMotion;
  // The pixels from `round` on, as many as the chunks take. Without the camera: light paths and their photons alone.
  const auto render = [&](uint64_t round, uint64_t end, uint32_t index, uint64_t seed, bool withCamera) {
    const float passTime = hasTimes ? PassTime(settings, index) : 0;
    ParallelFor(chunks, threads, [&](int chunk) {
      const auto own = static_cast<size_t>(chunk);
      SplatList& splats = sweep.splats[own];
      RenderCounts& ofChunk = sweep.counts[own];
      splats.Clear();
      TechniqueImages::Recorder* recorder = techniques && withCamera ? &recorders[own] : nullptr;
      const PhotonPass* found = withCamera ? gather : nullptr;
      SampleAdder adder(settings, film, ofChunk);
      LayerSample* layers = adder.StartLayers();
      SampleSinks withoutPhotons{splats, ofChunk, recorder, found};
      withoutPhotons.layers = layers;
      SampleSinks withPhotons = withoutPhotons;
      withPhotons.photons = &sweep.photons[own];
      withPhotons.withOrigin = store.WantsOrigins();
      withPhotons.isForPhotonsAlone = !withCamera;
      Sampler sampler(settings.sampler, seed);
      const uint64_t begin = round + static_cast<uint64_t>(chunk) * chunkPaths;
      for (uint64_t i = begin; i < std::min(begin + chunkPaths, end); ++i) {
        const int x = static_cast<int>(i % width), y = static_cast<int>(i / width);
        sampler.StartPixelSample(x, y, index);
        splats.StartPath();
        const bool keepsPhotons = wanted && i < lightPaths && store.HasRoom() && !(hasTimes && withCamera);
        if (!keepsPhotons && !withCamera) break;
        if (keepsPhotons) sweep.photons[own].StartPath();
        const SampleSinks& sinks = keepsPhotons ? withPhotons : withoutPhotons;
        const float time = hasTimes ? passTime : SampleTime(scene, sampler);
        if (!withCamera || x < crop.x0 || x >= crop.x1 || y < crop.y0 || y >= crop.y1) {
          if (recorder) recorder->StartSample(x, y, 0);
          integrator.Sample(nullptr, time, sampler, sinks);
          continue;
        }
        const PixelRay ray = MakePixelRay(scene, filter, x, y, time, sampler);
        if (recorder) recorder->StartSample(x, y, ray.camera.weight * settings.imagingRatio * ray.filterWeight);
        adder.StartLayers();
        const Color radiance = integrator.Sample(&ray.camera.ray, time, sampler, sinks);
        adder.Add(x, y, ray, radiance, film.Pixel(x, y));
      }
    });
  };
  const uint64_t perRound = static_cast<uint64_t>(chunks) * chunkPaths;
  // Light paths alone, for their photons.
  const auto tracePhotons = [&](uint64_t begin, uint32_t index, uint64_t seed) {
    for (uint64_t round = begin; round < lightPaths; round += perRound) {
      render(round, lightPaths, index, seed, false);
      store.Take(sweep.photons);
    }
  };
  const uint64_t seedOfPhotons = MixBits(settings.seed + kBeforeTheFirst);
  if (wanted && !hasTimes && !store.IsFor(first)) {
    // What the pass before would have left; before the very first one, photons of light paths of their own.
    store.Clear();
    tracePhotons(0, first == 0 ? 0 : first - 1, first == 0 ? seedOfPhotons : settings.seed);
    store.Finish(first);
  }
  // One sample of all pixels after the other: chunks never meet in a pixel, and the film adds paths in their order.
  for (uint32_t index = first; index < first + count; ++index) {
    if (hasTimes) {
      store.Clear();
      tracePhotons(0, index, seedOfPhotons);
      store.Finish(index);
    }
    if (wanted) gather = &store.Open(index, threads);
    for (uint64_t round = 0; round < pixels; round += perRound) {
      render(round, pixels, index, settings.seed, true);
      if (wanted && !hasTimes) store.Take(sweep.photons);
      film.AddSplats(filter, sweep.splats, threads);
      if (techniques) techniques->AddSplats(filter, recorders, threads);
    }
    if (!wanted) continue;
    if (hasTimes) {
      store.EndGathering();
      continue;
    }
    tracePhotons(pixels, index, settings.seed);
    store.Finish(index + 1);
  }
  return sweep.Total();
}

ProgressiveRender::ProgressiveRender(const RenderScene& scene, const AnyIntegrator& integrator,
                                     const RenderSettings& settings, int threads, Film& film,
                                     TechniqueImages* techniques, uint32_t firstSample)
    : scene_(scene),
      integrator_(integrator),
      settings_(settings),
      filter_(settings.filter),
      threads_(threads),
      film_(&film),
      techniques_(techniques),
      firstSample_(firstSample),
      backup_(scene.lighting->SceneSphere()) {
  if (const auto* chosen = std::get_if<std::unique_ptr<BidirectionalIntegrator>>(&integrator))
    wantedPhotons_ = (*chosen)->Photons();
  if (wantedPhotons_ && wantedPhotons_->guided)
    guiding_ = std::make_unique<EmissionLearning>(scene, settings.width, settings.height);
  MakePhotonStore();
  if (settings.learnLights) learning_ = std::make_unique<LightLearning>(scene.lighting->SceneSphere());
}

void ProgressiveRender::MakePhotonStore() {
  if (!wantedPhotons_) return;
  const uint64_t pixels = static_cast<uint64_t>(settings_.width) * static_cast<uint64_t>(settings_.height);
  photons_ = std::make_unique<PhotonStore>(*wantedPhotons_, pixels, guiding_.get());
}

void ProgressiveRender::AddPass(uint32_t done, uint32_t count) {
  const uint32_t first = firstSample_ + done;
  const RenderCounts counts = std::visit(
      [&]<class Chosen>(const std::unique_ptr<Chosen>& chosen) {
        if constexpr (std::is_same_v<Chosen, BidirectionalIntegrator>) {
          return RenderPass(scene_, *chosen, settings_, filter_, first, count, threads_, *film_, techniques_,
                            photons_.get());
        } else {
          return RenderPass(scene_, *chosen, settings_, filter_, first, count, threads_, *film_);
        }
      },
      integrator_);
  CheckStop();  // a pass that was given up adds to nothing
  counts_ += counts;
}

namespace {

// By then most of what can be learned has been.
constexpr uint32_t kLastLearned = 64;

// What is learned counts while this lives, whatever ends a pass.
class LearnedLighting {
 public:
  LearnedLighting(LightingServices& lighting, LightLearning* selection, const EmissionGuide* guide)
      : lighting_(lighting) {
    lighting_.Use(selection);
    lighting_.AimBy(guide);
  }
  ~LearnedLighting() {
    lighting_.Use(nullptr);
    lighting_.AimBy(nullptr);
  }
  LearnedLighting(const LearnedLighting&) = delete;
  LearnedLighting& operator=(const LearnedLighting&) = delete;

 private:
  LightingServices& lighting_;
};

}  // namespace

// At a milestone.
void ProgressiveRender::Learn(uint32_t samples) {
  bool changesDensities = false;
  if (learning_ && learning_->IsRecording()) {
    learning_->Freeze();
    if (samples >= kLastLearned) learning_->StopRecording();
    changesDensities = true;
  }
  if (guiding_ && guiding_->IsRecording() && guiding_->Decide(samples)) changesDensities = true;
  // The photons of the last pass have densities that are no longer, of their emission or in their weights: others are
  // traced in their place, as they are where a render is resumed.
  if (changesDensities && photons_) photons_->Clear();
}

bool ProgressiveRender::AddSamples(int count) {
  DropPartialPass();
  const bool isFirst = outcome_.samplesPerPixel == 0;
  const PhotonStatistics statistics = photons_ ? photons_->Statistics() : PhotonStatistics();
  backup_.Take(State(), !isFirst, threads_);
  const WorkEnd end = RunUntilStopped([this, count] { AddWholePass(count); });
  if (end == WorkEnd::Done) return true;
  const bool isGivenUp = end == WorkEnd::GivenUp;
  if (isGivenUp) LeaveToGivenUpPass();
  backup_.Restore(State(), threads_, isGivenUp);
  counts_ = RenderCounts();
  // As after loading: the photons are traced again.
  MakePhotonStore();
  if (photons_) photons_->Continue(statistics);
  outcome_.isPartial = isFirst;
  return false;
}

// Its threads still use the film and the rest: these are theirs from now on.
void ProgressiveRender::LeaveToGivenUpPass() {
  ownFilm_.emplace(film_->EmptyCopy());
  film_ = &*ownFilm_;
  if (techniques_) {
    ownTechniques_.emplace(techniques_->EmptyCopy());
    techniques_ = &*ownTechniques_;
  }
  (void)photons_.release();
}

void ProgressiveRender::DropPartialPass() {
  if (!outcome_.isPartial) return;
  *film_ = film_->EmptyCopy();
  outcome_.isPartial = false;
}

void ProgressiveRender::AddWholePass(int count) {
  const Clock clock;
  auto first = static_cast<uint32_t>(outcome_.samplesPerPixel);
  const uint32_t end = first + static_cast<uint32_t>(count);
  while (first < end) {
    const uint32_t milestone = std::bit_ceil(first + 1);
    const bool learns = (learning_ && learning_->IsRecording()) || (guiding_ && guiding_->IsRecording());
    const uint32_t next = learns ? std::min(end, milestone) : end;
    {
      const LearnedLighting lighting(*scene_.lighting, learning_.get(), guiding_ ? guiding_->Guide() : nullptr);
      AddPass(first, next - first);
    }
    first = next;
    if (learns && first == milestone) Learn(first);
  }
  if (photons_) outcome_.photons = photons_->Statistics();
  if (guiding_) {
    outcome_.photons->guideGain = guiding_->Gain();
    outcome_.photons->guideTargets = guiding_->Targets();
  }
  outcome_.counts += std::exchange(counts_, RenderCounts());
  outcome_.samplesPerPixel += count;
  outcome_.seconds += clock.Seconds();
}

int ProgressiveRender::NextPassSamples(int samplesPerPixel, std::optional<double> secondsLeft) const {
  // Light paths are those of the full image.
  const bool followsLight = !std::holds_alternative<std::unique_ptr<CameraIntegrator>>(integrator_);
  const int64_t pixels = followsLight ? static_cast<int64_t>(settings_.width) * settings_.height
                                      : static_cast<int64_t>(film_->Crop().Width()) * film_->Crop().Height();
  const int64_t largest = std::max<int64_t>(1, (int64_t{1} << 22) / std::max<int64_t>(1, pixels));
  const int done = outcome_.samplesPerPixel;
  const int64_t wanted = std::min<int64_t>(std::max(1, done), largest);
  const int count = static_cast<int>(std::min<int64_t>(wanted, samplesPerPixel - done));
  if (!secondsLeft || done == 0) return std::max(count, 1);
  const double affordable = *secondsLeft * done / std::max(outcome_.seconds, 1e-9);
  return static_cast<int>(std::clamp(affordable, 1.0, static_cast<double>(std::max(count, 1))));
}

double ProgressiveRender::DroppedFraction() const {
  const auto fraction = [](uint64_t dropped, double all) {
    return dropped == 0 ? 0 : static_cast<double>(dropped) / std::max(all, static_cast<double>(dropped));
  };
  const double pixels = std::holds_alternative<std::unique_ptr<CameraIntegrator>>(integrator_)
                            ? static_cast<double>(film_->Crop().Width()) * film_->Crop().Height()
                            : static_cast<double>(settings_.width) * settings_.height;
  const double ofSamples = fraction(outcome_.counts.droppedSamples, pixels * outcome_.samplesPerPixel);
  if (!outcome_.photons) return ofSamples;
  const auto photons = static_cast<double>(outcome_.photons->photons + outcome_.photons->rejected);
  return std::max(ofSamples, fraction(outcome_.photons->rejected, photons));
}

// Photons are not saved: those of the last pass are traced again.
void ProgressiveRender::Save(ByteWriter& bytes) const {
  bytes.Value(static_cast<uint32_t>(outcome_.samplesPerPixel));
  bytes.Value(outcome_.seconds);
  bytes.Value(outcome_.counts);
  if (photons_) bytes.Value(photons_->Statistics());
  if (learning_) learning_->Save(bytes);
  if (guiding_) guiding_->Save(bytes);
  film_->Save(bytes);
}

void ProgressiveRender::Load(ByteReader& bytes) {
  outcome_.samplesPerPixel = static_cast<int>(bytes.Value<uint32_t>());
  outcome_.seconds = bytes.Value<double>();
  if (outcome_.samplesPerPixel < 0 || !(outcome_.seconds >= 0)) throw Error("it holds a number that cannot be");
  outcome_.counts = bytes.Value<RenderCounts>();
  if (photons_) outcome_.photons = photons_->Continue(bytes.Value<PhotonStatistics>());
  if (learning_) learning_->Load(bytes);
  if (guiding_) guiding_->Load(bytes);
  film_->Load(bytes);
}

RenderOutcome Continue(ProgressiveRender& render, const StopConditions& stop, const PassCallback& afterPass) {
  const Clock clock;
  const double before = render.Outcome().seconds;
  RenderOutcome outcome = render.Outcome();
  const auto measure = [&] {
    outcome = render.Outcome();
    outcome.seconds = before + clock.Seconds();  // what the user waits for
    outcome.relativeError = render.Picture().RelativeError(stop.largestSample);
    outcome.droppedFraction = render.DroppedFraction();
    // What was left out may have been all that there is to see.
    if (outcome.droppedFraction > kMostDropped) outcome.relativeError = std::numeric_limits<double>::infinity();
  };
  measure();
  const auto isDone = [&] {
    if (outcome.samplesPerPixel >= stop.samplesPerPixel) return true;
    if (outcome.samplesPerPixel == 0) return false;
    if (stop.seconds && outcome.seconds >= *stop.seconds * 0.999) return true;
    // Too few samples may all have missed what makes the error.
    constexpr int fewest = 16;
    // An error that stays unknown is never met.
    const bool isHopeless = outcome.droppedFraction > kMostDropped && stop.relativeError;
    if (isHopeless && outcome.samplesPerPixel >= fewest) return true;
    return stop.relativeError && outcome.samplesPerPixel >= fewest && outcome.relativeError <= *stop.relativeError;
  };
  std::optional<double> secondsLeft;
  if (stop.seconds) secondsLeft = std::max(*stop.seconds - outcome.seconds, 0.0);
  const StopWatch watch(stop.interrupted, secondsLeft);
  while (!isDone()) {
    std::optional<double> most = stop.longestPass;
    if (stop.seconds) most = std::min(*stop.seconds - outcome.seconds, most.value_or(*stop.seconds));
    const bool isWhole = render.AddSamples(render.NextPassSamples(stop.samplesPerPixel, most));
    measure();
    if (isWhole) afterPass(outcome, FractionDone(outcome, stop));
    outcome.interrupted = stop.interrupted && stop.interrupted->load();
    if (outcome.interrupted || !isWhole) break;
  }
  return outcome;
}

RenderOutcome Render(const RenderScene& scene, const AnyIntegrator& integrator, const RenderSettings& settings,
                     const StopConditions& stop, int threads, Film& film, const PassCallback& afterPass,
                     TechniqueImages* techniques) {
  ProgressiveRender render(scene, integrator, settings, threads, film, techniques);
  return Continue(render, stop, afterPass);
}

}  // namespace lampyr
