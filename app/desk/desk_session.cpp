#include "app/desk/desk_session.h"

#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <utility>

#include "base/stop.h"
#include "render/analysis/unseen_samples.h"
#include "render/progressive_render.h"
#include "render/settings/integrator_choice.h"

namespace lampyr {

namespace {

using DeskClock = std::chrono::steady_clock;

double SecondsSince(DeskClock::time_point start) {
  return std::chrono::duration<double>(DeskClock::now() - start).count();
}

// Longest pass, seconds: work between passes waits for it.
constexpr double kLongestPass = 0.4;
// Fraction of the time that pictures may take.
constexpr double kPictureShare = 0.25;

// Lowers the priority of rendering below that of mixing for the page. Threads started by this one inherit it.
void GiveWay() {
  constexpr int kNice = 10;
  (void)setpriority(PRIO_PROCESS, static_cast<id_t>(syscall(SYS_gettid)), kNice);
}

}  // namespace

DeskSession::DeskSession(std::shared_ptr<const BuiltScene> scene, int mostSamples, int threads)
    : mostSamples_(mostSamples), threads_(threads) {
  auto run = std::make_shared<Run>();
  run->scene = std::move(scene);
  // The integrator is made here, so that a scene it refuses is an error of the constructor.
  run->integrator = MakeIntegrator(run->scene->scene, run->scene->settings);
  const std::lock_guard lock(mutex_);
  Start(std::move(run));
  Recycle(nullptr);
}

DeskSession::~DeskSession() {
  End();
  run_->thread.join();
}

void DeskSession::End() {
  std::unique_lock lock(mutex_);
  if (std::exchange(isEnding_, true)) return;
  FailErrands();
  changed_.notify_all();
  StopPass(lock);
}

std::shared_ptr<DeskSession::Run> DeskSession::MakeRun(std::shared_ptr<const BuiltScene> scene) {
  auto run = std::make_shared<Run>();
  run->scene = std::move(scene);
  const RenderSettings& settings = run->scene->settings;
  run->integrator = MakeIntegrator(run->scene->scene, settings);
  run->largestSample = LargestUnseenSample(run->scene->scene, settings);
  if (spare_.valid()) run->film = spare_.get();
  if (run->film && run->film->Layers() != run->scene->scene.outputs->Names()) run->film.reset();
  return run;
}

// To be called under the lock.
void DeskSession::Start(std::shared_ptr<Run> run) {
  run->restart = ++state_.restart;
  run->renderedSince = std::numeric_limits<double>::infinity();
  state_.samplesPerPixel = 0;
  state_.seconds = 0;
  state_.relativeError = std::numeric_limits<double>::infinity();
  state_.isDone = false;
  run_ = std::move(run);
  run_->thread = std::thread([this, started = run_] { RunThread(started); });
  changed_.notify_all();
}

// Ends the current pass, if any. Other work of the thread may continue.
void DeskSession::StopPass(std::unique_lock<std::mutex>& lock) {
  run_->isStale = true;
  changed_.notify_all();
  if (!run_->isInPass) return;
  RequestStop();
  changed_.wait(lock, [this] { return !run_->isInPass; });
  WithdrawStop();
}

// Makes an empty film for the next run, and frees the memory of the previous run, if any, in the background.
void DeskSession::Recycle(std::shared_ptr<Run> run) {
  spare_ = std::async(std::launch::async, [scene = run_->scene] {
    const RenderSettings& settings = scene->settings;
    return std::make_unique<Film>(settings.width, settings.height, settings.crop, scene->scene.outputs->Names());
  });
  if (!run) return;
  // Not waited for here: the ending threads may need the lock.
  ending_ = std::async(std::launch::async, [before = std::move(ending_), old = std::move(run)]() mutable {
    GiveWay();
    if (before.valid()) before.wait();
    old->thread.join();
    old.reset();
  });
}

double DeskSession::Restart(std::shared_ptr<const BuiltScene> scene) {
  const DeskClock::time_point start = DeskClock::now();
  std::shared_ptr<Run> next = MakeRun(std::move(scene));
  std::unique_lock lock(mutex_);
  StopPass(lock);
  if (!state_.failure.empty()) throw Error(state_.failure);
  std::shared_ptr<Run> old = run_;
  Start(std::move(next));
  Recycle(std::move(old));
  const std::shared_ptr<Run> now = run_;
  changed_.wait(lock, [&] { return now->hasBegun || isEnding_ || !state_.failure.empty(); });
  return SecondsSince(start);
}

void DeskSession::Pause(bool pauses) {
  const std::lock_guard lock(mutex_);
  isPaused_ = pauses;
  changed_.notify_all();
}

DeskState DeskSession::State() const {
  const std::lock_guard lock(mutex_);
  DeskState state = state_;
  state.isPaused = isPaused_;
  return state;
}

std::shared_ptr<const DeskPicture> DeskSession::Picture() const {
  const std::lock_guard lock(mutex_);
  return picture_;
}

void DeskSession::WaitForPicture(uint64_t number, double seconds) const {
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, std::chrono::duration<double>(seconds), [&] {
    const bool isNew = picture_ && picture_->number > number && picture_->restart == state_.restart;
    return isNew || isEnding_ || !state_.failure.empty();
  });
}

void DeskSession::WithFilm(const FilmWork& work) {
  Errand errand;
  errand.work = &work;
  std::future<void> done = errand.done.get_future();
  {
    const std::lock_guard lock(mutex_);
    if (isEnding_ || !state_.failure.empty()) throw Error("nothing is rendered any more");
    errands_.push_back(&errand);
    changed_.notify_all();
  }
  done.get();
}

void DeskSession::FailErrands() {
  for (Errand* errand : errands_)
    errand->done.set_exception(std::make_exception_ptr(Error("nothing is rendered any more")));
  errands_.clear();
}

void DeskSession::RunThread(const std::shared_ptr<Run>& run) {
  GiveWay();
  std::string failure;
  try {
    Render(*run);
  } catch (const Stopped&) {
    // before its first pass
  } catch (const Error& error) {
    failure = error.what();
  } catch (const std::exception& error) {
    failure = std::string("error: ") + error.what();
  } catch (...) {
    failure = "error: a plugin threw something that is no exception";
  }
  const std::lock_guard lock(mutex_);
  run->isInPass = false;
  if (!failure.empty()) state_.failure = failure;
  if (!failure.empty() || isEnding_) FailErrands();
  // The threads of a pass that was given up still use the run: it is never destroyed.
  if (HasGivenUpWork()) (void)new std::shared_ptr<Run>(run);
  changed_.notify_all();
}

void DeskSession::Render(Run& run) {
  const RenderSettings& settings = run.scene->settings;
  if (!run.film) {
    run.film =
        std::make_unique<Film>(settings.width, settings.height, settings.crop, run.scene->scene.outputs->Names());
    run.largestSample = LargestUnseenSample(run.scene->scene, settings);
  }
  run.render = std::make_unique<AbandonableRender>(run.scene->scene, *run.integrator, settings, threads_, *run.film);
  while (true) {
    RunErrands(run);
    const bool waits = Waits(run);
    {
      const std::lock_guard lock(mutex_);
      if (run.isStale || isEnding_) return;
    }
    if (!waits) AddPass(run);
  }
}

// Waits while there is nothing to render. True: there was other work.
bool DeskSession::Waits(Run& run) {
  std::unique_lock lock(mutex_);
  const auto rests = [&] { return IsDone(run) || (isPaused_ && run.render->SamplesPerPixel() > 0); };
  if (!rests()) return false;
  changed_.wait(lock, [&] { return run.isStale || isEnding_ || !errands_.empty() || !rests(); });
  return true;
}

void DeskSession::RunErrands(Run& run) {
  std::vector<Errand*> errands;
  {
    const std::lock_guard lock(mutex_);
    if (run.isStale || run.render->SamplesPerPixel() == 0) return;
    errands.swap(errands_);
  }
  for (Errand* errand : errands) {
    try {
      (*errand->work)(*run.scene, run.render->Picture(), run.render->SamplesPerPixel());
      errand->done.set_value();
    } catch (...) {
      errand->done.set_exception(std::current_exception());
    }
  }
}

void DeskSession::AddPass(Run& run) {
  const DeskClock::time_point start = DeskClock::now();
  {
    const std::lock_guard lock(mutex_);
    if (run.isStale || isEnding_) return;
    run.isInPass = run.hasBegun = true;
    changed_.notify_all();
  }
  const bool isWhole = run.render->AddSamples(run.render->NextPassSamples(mostSamples_, kLongestPass));
  if (!isWhole && HasGivenUpWork()) throw Error("a pass did not end when it was asked to: start the desk again");
  {
    const std::lock_guard lock(mutex_);
    run.isInPass = false;
    changed_.notify_all();
    if (run.isStale || isEnding_ || !isWhole) return;
  }
  run.renderedSince += SecondsSince(start);
  if (IsDone(run) || run.renderedSince * kPictureShare >= run.pictureSeconds) TakePicture(run);
}

void DeskSession::TakePicture(Run& run) {
  const DeskClock::time_point start = DeskClock::now();
  const AbandonableRender& render = *run.render;
  auto picture = std::make_shared<DeskPicture>();
  picture->planes = PlanesOf(render.Picture().Develop(), run.scene->scene.lighting->Groups().Layers(), threads_);
  picture->samplesPerPixel = render.SamplesPerPixel();
  picture->seconds = render.Seconds();
  picture->relativeError = render.DroppedFraction() > kMostDropped ? std::numeric_limits<double>::infinity()
                                                                   : render.Picture().RelativeError(run.largestSample);
  picture->restart = run.restart;
  picture->scene = run.scene;
  picture->guide = render.Guide();
  picture->learnsPaths = render.LearnsPaths();
  picture->guideGain = render.Guiding().gain;
  run.pictureSeconds = SecondsSince(start);
  run.renderedSince = 0;
  std::shared_ptr<const DeskPicture> before;  // may be the last to hold its scene: ends after the lock does
  const std::lock_guard lock(mutex_);
  if (run.isStale) return;
  picture->number = (picture_ ? picture_->number : 0) + 1;
  state_.picture = picture->number;
  state_.samplesPerPixel = picture->samplesPerPixel;
  state_.seconds = picture->seconds;
  state_.relativeError = picture->relativeError;
  state_.isDone = IsDone(run);
  before = std::exchange(picture_, std::move(picture));
  changed_.notify_all();
}

}  // namespace lampyr
