// Rendering in passes until a stop condition holds: samples, time, error or an interrupt.
//
// The picture after n samples per pixel is a pure function of scene, settings and seed. It depends neither on the
// number of threads nor on the division into passes.
#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <string>

#include "base/byte_stream.h"
#include "film/film.h"
#include "integrators/photon/photon_store.h"
#include "integrators/walk/integrator.h"
#include "render/pass_sequence.h"
#include "render/settings/render_settings.h"

namespace lampyr {

struct StopConditions {
  int samplesPerPixel = 16;             // maximum
  std::optional<double> seconds;        // of rendering
  std::optional<double> relativeError;  // at 95 % confidence (Film::RelativeError)
  // Share of the pixels that are to be below `relativeError`, each by itself (Film::PixelErrors), in place of the
  // image.
  std::optional<double> pixelShare;
  std::optional<double> longestPass;               // longest duration of a pass, for work between passes
  double largestSample = 0;                        // brightest sample that may not have come yet (unseen_samples.h)
  const std::atomic<bool>* interrupted = nullptr;  // set by a signal handler: end soon (StopWatch)
};

struct RenderOutcome {
  int samplesPerPixel = 0;
  double seconds = 0;                // of the passes; returned by Continue: until its end
  double relativeError = 0;          // infinite where it is unknown
  std::optional<ErrorParts> parts;   // of it, where photons are merged
  double droppedFraction = 0;        // ProgressiveRender::DroppedFraction
  std::optional<double> pixelError;  // the error that `pixelShare` of the pixels are below, where that is given
  bool interrupted = false;
  // True if the first pass was cut short: the film holds part of the first sample, for preview only.
  bool isPartial = false;
  RenderCounts counts;
  std::optional<PhotonStatistics> photons;  // of integrators that gather them
  GuidingStatistics guiding;
};

// Fraction of dropped samples above which the picture counts as wrong and its error as unknown.
constexpr double kMostDropped = 1e-3;

// Called after each pass.
using PassCallback = std::function<void(const RenderOutcome& soFar, double fractionDone)>;

// A render that can be continued at any time. The objects behind `scene`, `integrator`, `settings`, `film` (empty, of
// the settings' crop) must outlive it. The film is made adaptive if the settings are, and the
// integrator traces camera paths.
class ProgressiveRender {
 public:
  // `firstSample`: index of the first sample of each pixel. A render that starts later computes a part of the render
  // that starts at 0, pass by pass with the same photon radii.
  ProgressiveRender(const RenderScene& scene, const Integrator& integrator, const RenderSettings& settings, int threads,
                    Film& film, uint32_t firstSample = 0);

  // Adds a pass of `count` samples to every pixel. Only this counts as render time. Light selection and emission
  // guiding learn from samples 0 … 2^n - 1 and use that from sample 2^n on, whatever the division into passes. False: a
  // stop was requested (base/stop.h), and the pass was cut short. The state is then that before the pass, except that
  // after the first pass the film keeps its partial sample until that is dropped. If the pass had to be given up
  // (HasGivenUpWork), its threads may still run: scene, integrator, settings, film and this object must
  // stay until the process ends.
  bool AddSamples(int count);
  // Removes from the film what a first pass that was cut short has left in it.
  void DropPartialPass();
  // Samples per pixel that the next pass should add: as many as the film has already, but at most about 2^22 in the
  // whole image, so that progress is shown, interrupts are answered, and an error target is not exceeded by much.
  // Limited to `samplesPerPixel` in all and, after the first pass, to what fits into `secondsLeft`. At least 1.
  int NextPassSamples(int samplesPerPixel, std::optional<double> secondsLeft) const;

  // Does not update relativeError.
  const RenderOutcome& Outcome() const { return outcome_; }
  // The given film, or its replacement after a pass was given up.
  const Film& Picture() const { return *film_; }
  // Fraction of the samples, or of the photons if that is larger, that was dropped as invalid (not finite or negative).
  double DroppedFraction() const {
    return passes_.DroppedFraction(outcome_.counts.droppedSamples, outcome_.samplesPerPixel);
  }

  // Saves the film and all state that later samples depend on. To be called between whole passes.
  void Save(ByteWriter& bytes) const;
  // Restores the state that a render of the same scene, settings and first sample saved; to be called before any sample
  // is added. Throws an Error if the data is not what Save wrote, after which this object must not be used.
  void Load(ByteReader& bytes);

 private:
  void AddWholePass(int count);
  void LeaveToGivenUpPass();

  const Integrator& integrator_;
  const RenderSettings& settings_;
  int threads_;
  Film* film_;
  std::optional<Film> ownFilm_;  // replaces the film that a given-up pass still uses
  PassSequence passes_;
  RenderOutcome outcome_;
  RenderBackup backup_;
};

// Adds samples until a stop condition holds. The samples and the time of a loaded state count.
RenderOutcome Continue(ProgressiveRender& render, const StopConditions& stop, const PassCallback& afterPass);

// Renders into `film` (empty, of the settings' crop).
RenderOutcome Render(const RenderScene& scene, const Integrator& integrator, const RenderSettings& settings,
                     const StopConditions& stop, int threads, Film& film, const PassCallback& afterPass);

}  // namespace lampyr
