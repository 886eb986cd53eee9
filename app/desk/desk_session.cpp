#include "app/desk/desk_session.h"

#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "base/stop.h"
#include "render/analysis/unseen_samples.h"
#include "render/settings/integrator_choice.h"

namespace lampyr {

namespace {

using DeskClock = std::chrono::steady_clock;

double SecondsSince(DeskClock::time_point start) {
  return std::chrono::duration<double>(DeskClock::now() - start).count();
}

// Longest pass, seconds: what is done between passes waits for it.
constexpr double kLongestPass = 0.4;
// Part of the time that pictures may take.
constexpr double kPictureShare = 0.25;

// Mixing for the page comes before rendering. Threads that this one starts inherit it.
void GiveWay() {
  constexpr int kNice = 4;
  (void)setpriority(PRIO_PROCESS, static_cast<id_t>(syscall(SYS_gettid)), kNice);
}

}  // namespace

DeskSession::DeskSession(std::shared_ptr<const BuiltScene> scene, int mostSamples, int threads)
    : mostSamples_(mostSamples), threads_(threads) {
  (void)MakeIntegrator(scene->scene, scene->settings);  // what cannot be rendered is told now
  thread_ = std::thread([this, first = std::move(scene)] { RunThread(first); });
}

DeskSession::~DeskSession() {
  {
    const std::lock_guard lock(mutex_);
    isEnding_ = true;
    RequestStop();
  }
  changed_.notify_all();
  thread_.join();
  WithdrawStop();
}

std::unique_ptr<DeskSession::Job> DeskSession::MakeJob(std::shared_ptr<const BuiltScene> scene) {
  auto job = std::make_unique<Job>();
  job->scene = std::move(scene);
  const RenderSettings& settings = job->scene->settings;
  job->integrator = MakeIntegrator(job->scene->scene, settings);
  job->largestSample = LargestUnseenSample(job->scene->scene, settings);
  const std::vector<std::string> layers = job->scene->scene.outputs->Names();
  if (spare_.valid()) job->film = spare_.get();
  if (!job->film || job->film->Layers() != layers)
    job->film = std::make_unique<Film>(settings.width, settings.height, settings.crop, layers);
  job->render =
      std::make_unique<ProgressiveRender>(job->scene->scene, *job->integrator, settings, threads_, *job->film);
  return job;
}

// Lets go of a job's memory, and makes an empty film for the next one, while others work.
void DeskSession::Recycle(std::unique_ptr<Job> job) {
  spare_ = std::async(std::launch::async, [old = std::move(job), scene = job_->scene]() mutable {
    old.reset();
    const RenderSettings& settings = scene->settings;
    return std::make_unique<Film>(settings.width, settings.height, settings.crop, scene->scene.outputs->Names());
  });
}

double DeskSession::Restart(std::shared_ptr<const BuiltScene> scene) {
  const DeskClock::time_point start = DeskClock::now();
  std::unique_ptr<Job> job = MakeJob(std::move(scene));
  std::unique_lock lock(mutex_);
  next_ = std::move(job);
  hasBegun_ = false;
  if (!isEnding_) RequestStop();
  changed_.notify_all();
  changed_.wait(lock, [this] { return hasBegun_ || isEnding_ || !state_.failure.empty(); });
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

void DeskSession::RunThread(const std::shared_ptr<const BuiltScene>& first) {
  GiveWay();
  std::string failure;
  try {
    std::unique_ptr<Job> job = MakeJob(first);
    {
      const std::lock_guard lock(mutex_);
      if (!next_) next_ = std::move(job);
    }
    Render();
  } catch (const Error& error) {
    failure = error.what();
  } catch (const std::exception& error) {
    failure = std::string("error: ") + error.what();
  } catch (...) {
    failure = "error: a plugin threw something that is no exception";
  }
  const std::lock_guard lock(mutex_);
  state_.failure = failure;
  for (Errand* errand : errands_)
    errand->done.set_exception(std::make_exception_ptr(Error("nothing is rendered any more")));
  errands_.clear();
  // What a pass that did not end refers to stays until the process ends.
  if (HasGivenUpWork()) (void)job_.release();
  changed_.notify_all();
}

bool DeskSession::IsDone() const {
  return job_->render->Outcome().samplesPerPixel >= mostSamples_;
}

// Takes the next job, if there is one. False: the session ends.
bool DeskSession::TakeNext() {
  const std::lock_guard lock(mutex_);
  if (isEnding_) return false;
  if (!next_) return true;
  WithdrawStop();
  std::unique_ptr<Job> old = std::exchange(job_, std::move(next_));
  ++state_.restart;
  state_.samplesPerPixel = 0;
  state_.seconds = 0;
  state_.relativeError = std::numeric_limits<double>::infinity();
  state_.isDone = false;
  renderedSince_ = std::numeric_limits<double>::infinity();
  Recycle(std::move(old));
  hasBegun_ = true;
  changed_.notify_all();
  return true;
}

void DeskSession::RunErrands() {
  std::vector<Errand*> errands;
  {
    const std::lock_guard lock(mutex_);
    if (job_->render->Outcome().samplesPerPixel == 0) return;
    errands.swap(errands_);
  }
  for (Errand* errand : errands) {
    try {
      (*errand->work)(*job_->scene, job_->render->Picture(), job_->render->Outcome().samplesPerPixel);
      errand->done.set_value();
    } catch (...) {
      errand->done.set_exception(std::current_exception());
    }
  }
}

void DeskSession::AddPass() {
  const DeskClock::time_point start = DeskClock::now();
  ProgressiveRender& render = *job_->render;
  if (!render.AddSamples(render.NextPassSamples(mostSamples_, kLongestPass))) {
    if (HasGivenUpWork()) throw Error("a pass did not end when it was asked to: start the desk again");
    return;
  }
  renderedSince_ += SecondsSince(start);
  if (IsDone() || renderedSince_ * kPictureShare >= pictureSeconds_) TakePicture();
}

void DeskSession::TakePicture() {
  const DeskClock::time_point start = DeskClock::now();
  const ProgressiveRender& render = *job_->render;
  auto picture = std::make_shared<DeskPicture>();
  picture->planes = PlanesOf(render.Picture().Develop(), job_->scene->scene.lighting->Groups().Layers(), threads_);
  picture->samplesPerPixel = render.Outcome().samplesPerPixel;
  picture->seconds = render.Outcome().seconds;
  picture->relativeError = render.DroppedFraction() > kMostDropped
                               ? std::numeric_limits<double>::infinity()
                               : render.Picture().RelativeError(job_->largestSample);
  pictureSeconds_ = SecondsSince(start);
  renderedSince_ = 0;
  const std::lock_guard lock(mutex_);
  picture->number = (picture_ ? picture_->number : 0) + 1;
  picture->restart = state_.restart;
  state_.picture = picture->number;
  state_.samplesPerPixel = picture->samplesPerPixel;
  state_.seconds = picture->seconds;
  state_.relativeError = picture->relativeError;
  state_.isDone = IsDone();
  picture_ = std::move(picture);
  changed_.notify_all();
}

void DeskSession::Render() {
  while (TakeNext()) {
    RunErrands();
    {
      std::unique_lock lock(mutex_);
      const bool waits = IsDone() || (isPaused_ && job_->render->Outcome().samplesPerPixel > 0);
      if (waits) {
        changed_.wait(lock, [this] { return isEnding_ || next_ || !errands_.empty() || !(isPaused_ || IsDone()); });
        if (isEnding_ || next_ || !errands_.empty()) continue;
      }
    }
    AddPass();
  }
}

}  // namespace lampyr
