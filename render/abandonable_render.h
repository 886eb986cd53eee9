// Passes of a render that is discarded when it is stopped: no state is kept from which it could continue. A stop then
// takes no longer than the rays under way, whatever the size of the film (progressive_render.h keeps a copy of the film
// from before each pass).
//
// The picture after n samples per pixel is that of ProgressiveRender, byte by byte.
#pragma once

#include "film/film.h"
#include "render/pass_sequence.h"

namespace lampyr {

class AbandonableRender {
 public:
  // The objects behind `scene`, `integrator`, `settings` and `film` (empty, of the settings' crop) must outlive it.
  AbandonableRender(const RenderScene& scene, const Integrator& integrator, const RenderSettings& settings, int threads,
                    Film& film);

  // Adds a pass of `count` samples to every pixel. False: a stop was requested (base/stop.h). The film then holds any
  // part of the pass, and no pass may follow; if the pass had to be given up (HasGivenUpWork), its threads may still
  // run, and all that it refers to, this object included, must stay until the process ends.
  bool AddSamples(int count);
  // Samples per pixel that the next pass should add: at most as many as there are, as take about `longest` seconds, and
  // as are left of `most`. At least 1.
  int NextPassSamples(int most, double longest) const;

  int SamplesPerPixel() const { return samples_; }
  double Seconds() const { return seconds_; }  // of the passes
  const Film& Picture() const { return film_; }
  GuidingStatistics Guiding() const { return passes_.Guiding(); }
  bool LearnsPaths() const { return passes_.LearnsPaths(); }
  const std::shared_ptr<const PathGuide>& Guide() const { return passes_.Guide(); }
  // Fraction of the samples, or of the photons if that is larger, that was dropped as invalid.
  double DroppedFraction() const;

 private:
  Film& film_;
  PassSequence passes_;
  int samples_ = 0;
  double seconds_ = 0;
  RenderCounts counts_;
};

}  // namespace lampyr
