#include "render/progressive_render.h"

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "base/stop.h"
#include "render/passes.h"

namespace lampyr {

namespace {

struct Clock {
  std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();
  double Seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(); }
};

// The error that StopConditions::relativeError is about.
double TargetedError(const RenderOutcome& outcome) {
  return outcome.pixelError.value_or(outcome.relativeError);
}

// The error that `share` of the pixels are below.
double ErrorBelow(const Film& film, double share) {
  std::vector<float> errors = film.PixelErrors();
  const auto count = static_cast<double>(errors.size());
  const auto rank = static_cast<std::ptrdiff_t>(std::clamp(std::ceil(share * count), 1.0, count)) - 1;
  std::nth_element(errors.begin(), errors.begin() + rank, errors.end());
  return static_cast<double>(errors[static_cast<size_t>(rank)]);
}

double FractionDone(const RenderOutcome& outcome, const StopConditions& stop) {
  double fraction = static_cast<double>(outcome.samplesPerPixel) / stop.samplesPerPixel;
  if (stop.seconds) fraction = std::max(fraction, outcome.seconds / *stop.seconds);
  // The error falls with the square root of the samples.
  if (stop.relativeError && TargetedError(outcome) > 0) {
    fraction = std::max(fraction, std::pow(*stop.relativeError / TargetedError(outcome), 2.0));
  }
  return std::min(fraction, 1.0);
}

}  // namespace

ProgressiveRender::ProgressiveRender(const RenderScene& scene, const Integrator& integrator,
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
      wantedPhotons_(integrator.Photons()),
      backup_(scene.lighting->SceneSphere()) {
  if (wantedPhotons_ && wantedPhotons_->guided)
    guiding_ = std::make_unique<EmissionLearning>(scene, settings.width, settings.height);
  if (settings.adaptive && integrator.Paths() != TracedPaths::Light && !film.IsAdaptive())
    film.MakeAdaptive(wantedPhotons_.has_value());
  MakePhotonStore();
  if (settings.LearnsLights()) learning_ = std::make_unique<LightLearning>(scene.lighting->SceneSphere());
}

void ProgressiveRender::MakePhotonStore() {
  if (!wantedPhotons_) return;
  const uint64_t pixels = static_cast<uint64_t>(settings_.width) * static_cast<uint64_t>(settings_.height);
  photons_ = std::make_unique<PhotonStore>(*wantedPhotons_, pixels, guiding_.get());
}

void ProgressiveRender::AddPass(uint32_t done, uint32_t count) {
  // The lighting with what has been learned so far; it does not change during the pass.
  view_ = scene_;
  view_.lighting = std::make_shared<const LightingServices>(
      scene_.lighting->With(learning_.get(), guiding_ ? guiding_->Guide() : nullptr));
  const RenderCounts counts = RenderPass(view_, integrator_, settings_, filter_, firstSample_ + done, count, threads_,
                                         *film_, techniques_, photons_.get(), allocation_ ? &*allocation_ : nullptr);
  CheckStop();  // the counts of a given-up pass are not added
  if (film_->IsAdaptive()) film_->CountPasses(count);
  counts_ += counts;
}

// Begins the stage of a pass, if it is another one than that of `allocation_`: ends the one before, after whole passes.
void ProgressiveRender::StartStage(uint32_t pass) {
  const SampleStage stage = StageOf(pass, firstSample_, settings_.seed);
  if (allocation_ && allocation_->Stage().before == stage.before) return;
  if (stage.before == 0) {
    allocation_.emplace(stage, film_->Pixels());
    return;
  }
  if (film_->EndedPasses() < stage.before) {
    film_->EndStage();
    // Those of the last pass belong to light paths that the stage's rates depend on.
    if (photons_) photons_->Clear();
  }
  allocation_.emplace(stage, *film_, *settings_.adaptive);
}

namespace {

// Samples per pixel at which learning of light selection ends: most of what can be learned has been by then.
constexpr uint32_t kLastLearned = 64;

}  // namespace

// Called at milestones: after 2^n samples.
void ProgressiveRender::Learn(uint32_t samples) {
  bool changesDensities = false;
  if (learning_ && learning_->IsRecording()) {
    learning_->Freeze();
    if (samples >= kLastLearned) learning_->StopRecording();
    changesDensities = true;
  }
  if (guiding_ && guiding_->IsRecording() && guiding_->Decide(samples)) changesDensities = true;
  // The photons of the last pass, and their weights, have densities of the view before. They are dropped and others
  // traced in their place, as when a render is resumed.
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
  allocation_.reset();
  counts_ = RenderCounts();
  // Photons are traced again, as after loading a checkpoint.
  MakePhotonStore();
  if (photons_) photons_->Continue(statistics);
  outcome_.isPartial = isFirst;
  return false;
}

// The threads of a given-up pass still use film, techniques and photons: these are left to them and replaced.
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
    uint32_t next = learns ? std::min(end, milestone) : end;
    if (film_->IsAdaptive()) {
      StartStage(first);
      next = std::min(next, allocation_->Stage().before + allocation_->Stage().passes);
    }
    AddPass(first, next - first);
    first = next;
    if (learns && first == milestone) Learn(first);
  }
  if (photons_) outcome_.photons = photons_->Statistics();
  if (guiding_) {
    outcome_.photons->guideGain = guiding_->Gain();
    outcome_.photons->guideComponents = guiding_->Components();
  }
  outcome_.counts += std::exchange(counts_, RenderCounts());
  outcome_.samplesPerPixel += count;
  outcome_.seconds += clock.Seconds();
}

int ProgressiveRender::NextPassSamples(int samplesPerPixel, std::optional<double> secondsLeft) const {
  // Light paths are those of the full image.
  const bool followsLight = integrator_.Paths() != TracedPaths::Camera;
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
  const double pixels = integrator_.Paths() == TracedPaths::Camera
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
  if (outcome_.samplesPerPixel < 0 || !(outcome_.seconds >= 0)) throw Error("it holds a number out of range");
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
    if (stop.pixelShare) outcome.pixelError = ErrorBelow(render.Picture(), *stop.pixelShare);
    outcome.droppedFraction = render.DroppedFraction();
    // The dropped samples may have held any part of the light.
    if (outcome.droppedFraction > kMostDropped) {
      outcome.relativeError = std::numeric_limits<double>::infinity();
      if (outcome.pixelError) outcome.pixelError = outcome.relativeError;
    }
  };
  measure();
  const auto isDone = [&] {
    if (outcome.samplesPerPixel >= stop.samplesPerPixel) return true;
    if (outcome.samplesPerPixel == 0) return false;
    if (stop.seconds && outcome.seconds >= *stop.seconds * 0.999) return true;
    // With fewer samples, all of them may have missed what causes the error.
    constexpr int fewest = 16;
    // An unknown error never reaches the target.
    const bool isHopeless = outcome.droppedFraction > kMostDropped && stop.relativeError;
    if (isHopeless && outcome.samplesPerPixel >= fewest) return true;
    return stop.relativeError && outcome.samplesPerPixel >= fewest && TargetedError(outcome) <= *stop.relativeError;
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

RenderOutcome Render(const RenderScene& scene, const Integrator& integrator, const RenderSettings& settings,
                     const StopConditions& stop, int threads, Film& film, const PassCallback& afterPass,
                     TechniqueImages* techniques) {
  ProgressiveRender render(scene, integrator, settings, threads, film, techniques);
  return Continue(render, stop, afterPass);
}

}  // namespace lampyr
