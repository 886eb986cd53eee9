// Rendering in passes until a stop condition holds: samples, time, error or an interrupt.
//
// The picture after n samples per pixel is a pure function of scene, settings and seed: neither the number of threads
// nor the division into passes shows in it.
#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <string>

#include "base/byte_stream.h"
#include "film/film.h"
#include "integrators/photon/photon_store.h"
#include "integrators/walk/integrator.h"
#include "render/render_backup.h"
#include "render/settings/render_settings.h"
#include "render/technique_images.h"

namespace lampyr {

struct StopConditions {
  int samplesPerPixel = 16;                        // never more than that
  std::optional<double> seconds;                   // of rendering
  std::optional<double> relativeError;             // at 95 % confidence (Film::RelativeError)
  std::optional<double> longestPass;               // seconds, where something is to be done between passes
  double largestSample = 0;                        // that may not have come yet (unseen_samples.h)
  const std::atomic<bool>* interrupted = nullptr;  // set by a signal handler: end soon (StopWatch)
};

struct RenderOutcome {
  int samplesPerPixel = 0;
  double seconds = 0;          // of the passes; of Continue: until it has ended
  double relativeError = 0;    // infinite where it is unknown
  double droppedFraction = 0;  // ProgressiveRender::DroppedFraction
  bool interrupted = false;
  // The first pass was cut short: the film holds a part of the first sample, for looking at.
  bool isPartial = false;
  RenderCounts counts;
  std::optional<PhotonStatistics> photons;  // of integrators that gather them
};

// A picture that more than this part of its samples was dropped from is wrong, and its error unknown.
constexpr double kMostDropped = 1e-3;

// Called after each pass.
using PassCallback = std::function<void(const RenderOutcome& soFar, double fractionDone)>;

// A render that is continued as long as its owner likes. What `scene`, `integrator`, `settings`, `film` (empty, of the
// settings' crop) and `techniques` refer to must outlive it.
class ProgressiveRender {
 public:
  // `firstSample`: of each pixel. Who starts later renders a part of what who starts at 0 does: photons have the radii
  // of their pass.
  ProgressiveRender(const RenderScene& scene, const Integrator& integrator, const RenderSettings& settings, int threads,
                    Film& film, TechniqueImages* techniques = nullptr, uint32_t firstSample = 0);

  // A pass: as many samples more of every pixel. Only this takes time that counts. What is learned of lights and of
  // where photons are of use is learned from samples 0 … 2^n - 1 and counts from sample 2^n on, whatever the passes
  // are. False: a stop was requested (base/stop.h), and the pass was cut short. All is as it was before the pass then,
  // but that of the first pass the film keeps what there is, until it is dropped. Where the pass had to be given up
  // (HasGivenUpWork), scene, integrator, settings, film, techniques and this must stay until the process ends.
  bool AddSamples(int count);
  // Empties the film of what a first pass that was cut short has left in it.
  void DropPartialPass();
  // Samples that a pass should add: as many as there are, at most about 2^22 in the whole image, so that progress
  // shows, interrupts are answered and an error target is not overshot by much; not beyond `samplesPerPixel` in all,
  // nor, after the first pass, what takes longer than `secondsLeft`. At least 1.
  int NextPassSamples(int samplesPerPixel, std::optional<double> secondsLeft) const;

  // relativeError is not kept up to date here.
  const RenderOutcome& Outcome() const { return outcome_; }
  // The given film, but for another one after a pass that was given up.
  const Film& Picture() const { return *film_; }
  // Of the samples, or of the photons where that is more, the part that was dropped because it was no finite number.
  double DroppedFraction() const;
  const TechniqueImages* Techniques() const { return techniques_; }

  // All that the samples to come depend on, and the film. Between whole passes.
  void Save(ByteWriter& bytes) const;
  // Goes on where one of the same scene, settings and first sample was saved, before any sample is added here. Throws
  // an Error where this is not what has been saved; it is of no use then.
  void Load(ByteReader& bytes);

 private:
  void AddPass(uint32_t first, uint32_t count);
  void AddWholePass(int count);
  void Learn(uint32_t samples);
  void MakePhotonStore();
  void LeaveToGivenUpPass();
  PassState State() { return {*film_, techniques_, &learning_, &guiding_}; }

  const RenderScene& scene_;
  RenderScene view_;  // as the pass under way sees it
  const Integrator& integrator_;
  const RenderSettings& settings_;
  PixelFilter filter_;
  int threads_;
  Film* film_;
  TechniqueImages* techniques_;
  std::optional<Film> ownFilm_;  // in the place of what a pass that was given up uses
  std::optional<TechniqueImages> ownTechniques_;
  uint32_t firstSample_;
  std::optional<PhotonSettings> wantedPhotons_;
  RenderOutcome outcome_;
  RenderCounts counts_;                        // of the pass under way
  std::unique_ptr<LightLearning> learning_;    // null: selection learns nothing
  std::unique_ptr<EmissionLearning> guiding_;  // null: photons are not aimed
  std::unique_ptr<PhotonStore> photons_;       // of integrators that gather them
  RenderBackup backup_;
};

// Adds samples until a condition holds. What was loaded counts: its samples and its time.
RenderOutcome Continue(ProgressiveRender& render, const StopConditions& stop, const PassCallback& afterPass);

// A new render, into `film` (empty, of the settings' crop). `techniques`, if any, are recorded for integrators that
// have them.
RenderOutcome Render(const RenderScene& scene, const Integrator& integrator, const RenderSettings& settings,
                     const StopConditions& stop, int threads, Film& film, const PassCallback& afterPass,
                     TechniqueImages* techniques = nullptr);

}  // namespace lampyr
