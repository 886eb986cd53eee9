// The render behind the lighting desk: refines the picture pass by pass in a thread of its own, and restarts when the
// scene is edited.
#pragma once

#include <condition_variable>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "app/desk/desk_mixing.h"
#include "film/film.h"
#include "integrators/walk/integrator.h"
#include "render/abandonable_render.h"
#include "render/build/scene_builder.h"

namespace lampyr {

// The picture after some pass.
struct DeskPicture {
  LayerPlanes planes;
  uint64_t number = 0;   // counts the pictures of the session
  uint64_t restart = 0;  // of the render that it belongs to
  int samplesPerPixel = 0;
  double seconds = 0;        // of rendering
  double relativeError = 0;  // at 95 % confidence; infinite if unknown
  std::shared_ptr<const BuiltScene> scene;
  std::shared_ptr<const PathGuide> guide;  // of the last pass; null: walks were not guided
  bool learnsPaths = false;                // a guide is learned
  double guideGain = 1;                    // GuidingStatistics::gain
};

struct DeskState {
  uint64_t restart = 0;  // counts the scenes that were rendered
  uint64_t picture = 0;  // DeskPicture::number of the latest; 0: none yet
  int samplesPerPixel = 0;
  double seconds = 0, relativeError = 0;
  bool isPaused = false, isDone = false;
  std::string failure;  // why rendering has ended; "": it has not failed
};

class DeskSession {
 public:
  // `mostSamples`: per pixel. `threads`: of rendering and mixing.
  DeskSession(std::shared_ptr<const BuiltScene> scene, int mostSamples, int threads);
  ~DeskSession();
  // Ends the render, and all waits for it. May be called by any thread, also more than once.
  void End();

  // Renders another scene from now on. Returns when its first pass has begun; the result is the time that this took, in
  // seconds. Called by one thread at a time.
  double Restart(std::shared_ptr<const BuiltScene> scene);
  void Pause(bool pauses);

  DeskState State() const;
  // The latest picture, also of the scene before; null: none yet.
  std::shared_ptr<const DeskPicture> Picture() const;
  // Waits until there is a picture of the current scene with a number above `number`, or the render has ended, or the
  // time is over.
  void WaitForPicture(uint64_t number, double seconds) const;
  // Calls `work` between two passes with the film and its number of samples per pixel, and waits for it. Rethrows its
  // exceptions; throws an Error if nothing has been rendered yet.
  using FilmWork = std::function<void(const BuiltScene& scene, const Film& film, int samplesPerPixel)>;
  void WithFilm(const FilmWork& work);

  int Threads() const { return threads_; }

 private:
  // The render of one scene, in a thread of its own. Members marked `mutex_` are guarded by it.
  struct Run {
    std::shared_ptr<const BuiltScene> scene;
    std::unique_ptr<Integrator> integrator;
    std::unique_ptr<Film> film;
    std::unique_ptr<AbandonableRender> render;
    double largestSample = 0;
    uint64_t restart = 0;
    bool isStale = false;       // mutex_: another scene is rendered; it ends
    bool isInPass = false;      // mutex_
    bool hasBegun = false;      // mutex_: its first pass
    double pictureSeconds = 0;  // time to make the last picture
    double renderedSince = 0;   // seconds of rendering since then
    std::thread thread;
  };
  struct Errand {
    const FilmWork* work = nullptr;
    std::promise<void> done;
  };

  std::shared_ptr<Run> MakeRun(std::shared_ptr<const BuiltScene> scene);
  void Start(std::shared_ptr<Run> run);
  void StopPass(std::unique_lock<std::mutex>& lock);
  void Recycle(std::shared_ptr<Run> run);
  void RunThread(const std::shared_ptr<Run>& run);
  void Render(Run& run);
  bool Waits(Run& run);
  void RunErrands(Run& run);
  void AddPass(Run& run);
  void TakePicture(Run& run);
  bool IsDone(const Run& run) const { return run.render->SamplesPerPixel() >= mostSamples_; }
  void FailErrands();

  const int mostSamples_, threads_;
  mutable std::mutex mutex_;
  mutable std::condition_variable changed_;
  std::shared_ptr<Run> run_;
  std::vector<Errand*> errands_;
  bool isEnding_ = false, isPaused_ = false;
  DeskState state_;
  std::shared_ptr<const DeskPicture> picture_;
  // An empty film for the next run: making one may take longer than a restart may.
  std::future<std::unique_ptr<Film>> spare_;
  std::future<void> ending_;  // end of the previous run
};

}  // namespace lampyr
