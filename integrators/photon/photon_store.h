// Photons from the pass that traces them to the pass that gathers them.
#pragma once

#include <cstdint>
#include <vector>

#include "integrators/photon/emission_learning.h"
#include "integrators/photon/photon_pass.h"
#include "integrators/walk/integrator.h"

namespace lampyr {

struct PhotonStatistics {
  uint64_t passes = 0;
  uint64_t photons = 0;                    // gathered from, of all passes
  uint64_t mostPhotons = 0;                // of one pass
  uint64_t mostBytes = 0;                  // of one map
  uint64_t rejected = 0;                   // not finite
  double buildSeconds = 0;                 // of all maps
  double guideGain = 1;                    // EmissionLearning::Gain
  int64_t guideTargets = 0;                // that photons are aimed at; 0: they are not
  double firstRadius = 0, lastRadius = 0;  // scene units; 0: by the pixel's size where it looks
};

class PhotonStore {
 public:
  // A pass traces `pixels` light paths unless the settings say otherwise.
  // `learning` is told what became of each pass's photons, as long as it records; null: nobody is.
  PhotonStore(const PhotonSettings& settings, uint64_t pixels, EmissionLearning* learning = nullptr);

  // Light paths of which photons are wanted in each pass.
  uint64_t LightPaths() const { return lightPaths_; }
  // Whether the paths' origins are wanted.
  bool WantsOrigins() const { return learning_ && learning_->IsRecording(); }
  // Whether photons of the pass being traced still fit into memory.
  bool HasRoom() const { return hasRoom_; }
  // Takes the photons of paths that follow those taken before, all of one pass. Where they leave no room, whole paths
  // are left out from the first that does not fit on: the pass has fewer light paths, the same for any number of
  // threads.
  void Take(std::vector<PhotonList>& lists);

  // Whether what has been taken is for this pass.
  bool IsFor(uint32_t pass) const { return isTaken_ && pass_ == pass; }
  // The photons of the pass that is open have been gathered: what they were good for is learned.
  void EndGathering();
  // All light paths of a pass are traced, and its own photons are gathered; those of the paths are for pass `next`.
  void Finish(uint32_t next);
  // Makes the map, unless it is made. Requires IsFor(pass).
  const PhotonPass& Open(uint32_t pass, int threads);
  void Clear();

  const PhotonStatistics& Statistics() const { return statistics_; }
  // Counts on from there.
  const PhotonStatistics& Continue(const PhotonStatistics& before) { return statistics_ = before; }
  // While a map is made of them, everything counted.
  static uint64_t BytesPerPhoton(bool withUse = false);

 private:
  std::shared_ptr<PhotonUse> MakeUse(std::vector<uint32_t> origins) const;

  PhotonSettings settings_;
  EmissionLearning* learning_;
  uint64_t lightPaths_;
  uint64_t most_;  // photons
  std::vector<PhotonList> waiting_;
  uint64_t photons_ = 0, paths_ = 0;  // that wait
  bool hasRoom_ = true;
  bool isTaken_ = false;
  uint32_t pass_ = 0;
  PhotonPass open_;
  PhotonStatistics statistics_;
};

}  // namespace lampyr
