#include "render/progressive_render.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "base/stop.h"

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

// The error that `share` of the pixels are below. `imageError`: that of the whole picture.
double ErrorBelow(const Film& film, double share, double imageError) {
  std::vector<float> errors = film.PixelErrors(imageError);
  const auto count = static_cast<double>(errors.size());
  const auto rank = static_cast<std::ptrdiff_t>(std::clamp(std::ceil(share * count), 1.0, count)) - 1;
  std::nth_element(errors.begin(), errors.begin() + rank, errors.end());
  return static_cast<double>(errors[static_cast<size_t>(rank)]);
}

// The first number of samples per pixel, from `samples` on, at which the error is compared with the target: 16, and
// four numbers in each doubling. Tests at fixed numbers keep the end of a render independent of the lengths of its
// passes, which depend on the clock. Below 16 samples, all of them may have missed what causes the error.
int NextTest(int samples) {
  constexpr double kFirst = 16, kInDoubling = 4;
  const auto test = [](int k) { return static_cast<int64_t>(std::lround(kFirst * std::exp2(k / kInDoubling))); };
  int k = samples <= kFirst ? 0 : static_cast<int>(kInDoubling * std::log2(samples / kFirst)) - 1;
  while (test(k) < samples) ++k;
  return static_cast<int>(std::min<int64_t>(test(k), std::numeric_limits<int>::max()));
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
                                     const RenderSettings& settings, int threads, Film& film, uint32_t firstSample)
    : integrator_(integrator),
      settings_(settings),
      threads_(threads),
      film_(&film),
      passes_(scene, integrator, settings, threads, film, firstSample),
      backup_(scene.lighting->SceneSphere()) {}

bool ProgressiveRender::AddSamples(int count) {
  DropPartialPass();
  const bool isFirst = outcome_.samplesPerPixel == 0;
  backup_.Take(passes_.State(), !isFirst, threads_);
  const WorkEnd end = RunUntilStopped([this, count] { AddWholePass(count); });
  if (end == WorkEnd::Done) return true;
  const bool isGivenUp = end == WorkEnd::GivenUp;
  if (isGivenUp) LeaveToGivenUpPass();
  backup_.Restore(passes_.State(), threads_, isGivenUp);
  passes_.StartAnew();
  outcome_.isPartial = isFirst;
  return false;
}

// The threads of a given-up pass still use film and photons: these are left to them and replaced.
void ProgressiveRender::LeaveToGivenUpPass() {
  ownFilm_.emplace(film_->EmptyCopy());
  film_ = &*ownFilm_;
  passes_.LeaveToGivenUpPass(*film_);
}

void ProgressiveRender::DropPartialPass() {
  if (!outcome_.isPartial) return;
  *film_ = film_->EmptyCopy();
  outcome_.isPartial = false;
}

void ProgressiveRender::AddWholePass(int count) {
  const Clock clock;
  passes_.Add(static_cast<uint32_t>(outcome_.samplesPerPixel), static_cast<uint32_t>(count));
  CheckStop();  // of a pass that was given up nothing is counted
  outcome_.photons = passes_.Photons();
  outcome_.guiding = passes_.Guiding();
  outcome_.counts += passes_.TakeCounts();
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

void ProgressiveRender::Save(ByteWriter& bytes) const {
  bytes.Value(static_cast<uint32_t>(outcome_.samplesPerPixel));
  bytes.Value(outcome_.seconds);
  bytes.Value(outcome_.counts);
  passes_.Save(bytes);
  film_->Save(bytes);
}

void ProgressiveRender::Load(ByteReader& bytes) {
  outcome_.samplesPerPixel = static_cast<int>(bytes.Value<uint32_t>());
  outcome_.seconds = bytes.Value<double>();
  if (outcome_.samplesPerPixel < 0 || !(outcome_.seconds >= 0)) throw Error("it holds a number out of range");
  outcome_.counts = bytes.Value<RenderCounts>();
  passes_.Load(bytes);
  outcome_.photons = passes_.Photons();
  outcome_.guiding = passes_.Guiding();
  film_->Load(bytes);
}

RenderOutcome Continue(ProgressiveRender& render, const StopConditions& stop, const PassCallback& afterPass) {
  const Clock clock;
  const double before = render.Outcome().seconds;
  RenderOutcome outcome = render.Outcome();
  const auto measure = [&] {
    outcome = render.Outcome();
    outcome.seconds = before + clock.Seconds();  // what the user waits for
    const ErrorParts error = render.Picture().PartsOfError(stop.largestSample);
    outcome.relativeError = error.Both();
    if (render.Picture().KeepsBias()) outcome.parts = error;
    if (stop.pixelShare) outcome.pixelError = ErrorBelow(render.Picture(), *stop.pixelShare, outcome.relativeError);
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
    if (!stop.relativeError || outcome.samplesPerPixel != NextTest(outcome.samplesPerPixel)) return false;
    // An unknown error never reaches the target.
    return outcome.droppedFraction > kMostDropped || TargetedError(outcome) <= *stop.relativeError;
  };
  std::optional<double> secondsLeft;
  if (stop.seconds) secondsLeft = std::max(*stop.seconds - outcome.seconds, 0.0);
  const StopWatch watch(stop.interrupted, secondsLeft);
  while (!isDone()) {
    std::optional<double> most = stop.longestPass;
    if (stop.seconds) most = std::min(*stop.seconds - outcome.seconds, most.value_or(*stop.seconds));
    int end = stop.samplesPerPixel;
    if (stop.relativeError) end = std::min(end, NextTest(outcome.samplesPerPixel + 1));
    const bool isWhole = render.AddSamples(render.NextPassSamples(end, most));
    measure();
    if (isWhole) afterPass(outcome, FractionDone(outcome, stop));
    outcome.interrupted = stop.interrupted && stop.interrupted->load();
    if (outcome.interrupted || !isWhole) break;
  }
  return outcome;
}

RenderOutcome Render(const RenderScene& scene, const Integrator& integrator, const RenderSettings& settings,
                     const StopConditions& stop, int threads, Film& film, const PassCallback& afterPass) {
  ProgressiveRender render(scene, integrator, settings, threads, film);
  return Continue(render, stop, afterPass);
}

}  // namespace lampyr
