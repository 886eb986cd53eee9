// Passes in their order, with what happens between them: light selection and emission guiding learn, and the stages of
// adaptive sampling begin.
#pragma once

#include <memory>
#include <optional>

#include "film/film.h"
#include "integrators/guide/path_learning.h"
#include "integrators/photon/photon_store.h"
#include "integrators/walk/integrator.h"
#include "render/adaptive_sampling.h"
#include "render/light_edges.h"
#include "render/render_backup.h"
#include "render/settings/render_settings.h"

namespace lampyr {

// Statistics of path guiding: PathLearning::Gain, and the regions of the guide in use; 0: walks are not guided.
// Statistics of learned light selection: SelectionTest::Gain, and true if the selection is used.
struct GuidingStatistics {
  double gain = 1;
  size_t regions = 0;
  double lightGain = 1;
  bool usesLearnedLights = false;
};

// The picture after n passes does not depend on how they are divided into calls. After a pass that was cut short
// (base/stop.h) the sequence is of no use until what it has changed is restored.
class PassSequence {
 public:
  // The objects behind the arguments must outlive it. `film`: empty, of the settings' crop; it is made adaptive if the
  // settings are, and the integrator follows camera paths. `firstSample`: index of the first sample of each pixel.
  PassSequence(const RenderScene& scene, const Integrator& integrator, const RenderSettings& settings, int threads,
               Film& film, uint32_t firstSample = 0);

  // Adds `count` passes after `done` others. Learns from samples 0 … 2^n - 1 and uses that from sample 2^n on.
  void Add(uint32_t done, uint32_t count);

  const Integrator& TracedBy() const { return integrator_; }
  Film& Picture() const { return *film_; }
  // What passes change.
  PassState State() { return {*film_, &learning_, &selection_, &guiding_, &paths_}; }
  // Counts since the last call.
  RenderCounts TakeCounts();
  // Photon statistics; nullopt if the integrator gathers no photons.
  std::optional<PhotonStatistics> Photons() const;
  GuidingStatistics Guiding() const;
  bool LearnsPaths() const { return paths_ != nullptr; }
  // The guide of walks that the last pass had; null: they were not guided.
  const std::shared_ptr<const PathGuide>& Guide() const { return view_.guide; }
  // Fraction of `dropped` of all samples, or of the photons if that is larger, that was invalid.
  double DroppedFraction(uint64_t dropped, int samplesPerPixel) const;

  // To be called after a pass was cut short and its state restored: makes anew what else the pass had changed.
  void StartAnew();
  // Continues with another film; objects that a given-up pass still uses are left to that pass.
  void LeaveToGivenUpPass(Film& film);
  // Saves, or restores, all state but the film.
  void Save(ByteWriter& bytes) const;
  void Load(ByteReader& bytes);

 private:
  void AddPass(uint32_t done, uint32_t count);
  void Learn(uint32_t samples);
  // True if it is known after `samples` samples per pixel whether photons will be guided. `part`: divides the number of
  // samples that this takes (2: half as many are enough).
  bool PhotonsAreSettled(uint32_t samples, uint32_t part) const;
  // True if the camera paths after `samples` samples per pixel are recorded for path guiding.
  bool RecordsPathsAfter(uint32_t samples) const;
  void StartStage(uint32_t done);
  void MakePhotonStore();

  const RenderScene& scene_;
  const LightingServices lighting_;  // of the scene, with lights selected as the settings say
  RenderScene view_;                 // as the current pass sees it, with what has been learned
  const Integrator& integrator_;
  const RenderSettings& settings_;
  PixelFilter filter_;
  int threads_;
  Film* film_;
  uint32_t firstSample_;
  std::optional<PhotonSettings> wantedPhotons_;
  RenderCounts counts_;
  PhotonStatistics before_;                    // of the photons, before the last call of Add
  std::unique_ptr<LightLearning> learning_;    // null: selection learns nothing
  std::unique_ptr<SelectionTest> selection_;   // of what it learns; null with it
  std::unique_ptr<EmissionLearning> guiding_;  // null: no emission guiding
  std::unique_ptr<PathLearning> paths_;        // null: no path guiding
  std::unique_ptr<PhotonStore> photons_;       // of integrators that gather them
  std::unique_ptr<const LightEdges> edges_;    // null: all samples have one camera ray
  bool hasSoughtEdges_ = false;
  std::unique_ptr<SampleAllocation> allocation_;  // of the last stage, in an adaptive film
};

}  // namespace lampyr
