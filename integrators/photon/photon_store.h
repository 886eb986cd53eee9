// Keeps photons from the pass that traces them to the pass that gathers them.
#pragma once

#include <cstdint>
#include <vector>

#include "integrators/photon/emission_learning.h"
#include "integrators/photon/photon_pass.h"
#include "integrators/walk/integrator.h"

namespace lampyr {

struct PhotonStatistics {
  uint64_t passes = 0;
  uint64_t photons = 0;                    // in the maps of all passes
  uint64_t mostPhotons = 0;                // in the map of one pass
  uint64_t mostBytes = 0;                  // of one map
  uint64_t rejected = 0;                   // not finite
  double buildSeconds = 0;                 // of all maps
  double guideGain = 1;                    // EmissionLearning::Gain
  int64_t guideComponents = 0;             // components of the guiding mixture; 0: photons are not guided
  double firstRadius = 0, lastRadius = 0;  // scene units; 0: derived from the pixel footprint at each vertex
};

class PhotonStore {
 public:
  // A pass traces `pixels` light paths, times those of a camera path, unless the settings say otherwise. `learning`
  // receives the per-photon contributions of each pass as long as it records; may be null.
  PhotonStore(const PhotonSettings& settings, uint64_t pixels, EmissionLearning* learning = nullptr);

  // Number of light paths per pass whose photons are wanted.
  uint64_t LightPaths() const { return lightPaths_; }
  // True if the origins of the paths are to be recorded.
  bool WantsOrigins() const { return learning_ && learning_->IsRecording(); }
  // True as long as photons of the pass being traced fit into memory.
  bool HasRoom() const { return hasRoom_; }
  // Takes the photons of the next paths of the same pass, in order. When memory is used up, all paths from the first
  // that does not fit are left out: the pass has fewer light paths, the same ones for any number of threads. The first
  // path of a pass is kept, whatever it takes.
  //
  // The mean over the paths of a pass is unbiased then, although their number depends on them. Given the number and the
  // first path that does not fit, those before it are exchangeable, so their mean is the expectation of the first path.
  // Where the first itself does not fit, it is that expectation alone.
  // (Weights that depend on the number, those of vcm, leave a bias of the order of 1 / paths.)
  void Take(std::vector<PhotonList>& lists);

  // True if the photons that were taken are for this pass.
  bool IsFor(uint32_t pass) const { return isTaken_ && pass_ == pass; }
  // To be called when the photons of the open pass have been gathered: learns from their contributions.
  void EndGathering();
  // To be called when all light paths of a pass are traced and its own photons gathered: the photons that were taken
  // are for pass `next`.
  void Finish(uint32_t next);
  // The photons for `pass`. Builds the map, unless this pass is open already. Requires IsFor(pass). `scale`: of all
  // radii; 0: RadiusScale of the pass.
  const PhotonPass& Open(uint32_t pass, int threads, double scale = 0);
  void Clear();

  const PhotonStatistics& Statistics() const { return statistics_; }
  // Continues the counts of an earlier store.
  const PhotonStatistics& Continue(const PhotonStatistics& before) { return statistics_ = before; }
  // Memory per photon while the map is built, everything included but densities. `withUse`: with PhotonUse.
  static uint64_t BytesPerPhoton(bool withUse = false);

 private:
  std::shared_ptr<PhotonUse> MakeUse(std::vector<uint32_t> origins) const;
  // Moves `list` to waiting_, and leaves an empty one in its place.
  void Keep(PhotonList& list);

  PhotonSettings settings_;
  EmissionLearning* learning_;
  uint64_t lightPaths_;
  uint64_t perPhoton_, most_;  // bytes of a photon and of a pass
  std::vector<PhotonList> waiting_;
  uint64_t bytes_ = 0, paths_ = 0;  // in waiting_
  std::vector<PhotonList> spare_;   // empty, with memory that the system need not provide again for every pass
  bool hasRoom_ = true;
  bool isTaken_ = false;
  uint32_t pass_ = 0;
  PhotonPass open_;
  PhotonStatistics statistics_;
};

}  // namespace lampyr
