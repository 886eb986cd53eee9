// Learns from the photons of each pass where photons are worth sending ([Vorba14] calls it guiding; what is learned
// here is the first way alone, from the light to where a photon lands).
//
// A guide that was made of the photons seen so far is tried on those of the passes that follow, which it knows nothing
// of: would their sums have been less noisy, had it aimed them? Only then is it used. What photons bring is summed in
// integers, the same for any number of threads, and the guide changes at samples 1, 2, 4 … alone, so that each pass has
// one density.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "integrators/photon/photon_use.h"
#include "integrators/walk/integrator.h"

namespace lampyr {

class ByteReader;
class ByteWriter;

class EmissionLearning {
 public:
  // `scene` must outlive it. Begins with a guess: where next to none of the photons come near to what an image of
  // width × height sees, at once or after another bounce, they are aimed there until it is known better.
  EmissionLearning(const RenderScene& scene, int width, int height);

  // What the camera's paths of a pass got by the photons it gathered.
  void Learn(const PhotonUse& use);
  // A milestone is reached, after so many samples of each pixel: makes up its mind. Whether photons are to be aimed
  // otherwise from now on, by Guide().
  bool Decide(uint32_t samples);
  // Null: photons are not aimed.
  const EmissionGuide* Guide() const { return guide_.get(); }

  // Until enough is known: recording takes time.
  bool IsRecording() const { return isRecording_; }

  // By how much less the squared error of the photons' sums is said to be than without a guide; of the last decision.
  double Gain() const { return gain_; }
  int Targets() const { return guide_ ? guide_->TargetCount() : 0; }

  // All that was learned. Between passes.
  void Save(ByteWriter& bytes) const;
  // Into one that has learned nothing, of the same scene and image. Throws an Error where this is not what has been
  // saved.
  void Load(ByteReader& bytes);

 private:
  void Guess(const RenderScene& scene, int width, int height);
  std::vector<UsefulPhoton> Evidence() const;
  void Thin();
  std::shared_ptr<const EmissionGuide> MakeGuide(std::span<const UsefulPhoton> photons) const;

  const LightingServices& lighting_;
  bool isRecording_ = true;
  std::vector<UsefulPhoton> guessed_;  // none: photons come near to what is seen by themselves
  std::vector<UsefulPhoton> useful_;
  std::shared_ptr<const EmissionGuide> guide_;  // in use, or null
  std::shared_ptr<const EmissionGuide> tried_;  // on trial, or null; all that it is made of:
  std::vector<UsefulPhoton> evidence_;
  // A sum that few may have decided.
  struct Sum {
    double sum = 0, squares = 0;
    void Add(double value) {
      sum += value;
      squares += value * value;
    }
    // As many equal ones would be as sure.
    double Count() const { return squares > 0 ? sum * sum / squares : 0; }
  };
  // Of the photons since the last verdict: squares of what they brought, as if aimed by nobody, and by the one on
  // trial.
  Sum unguided_, aimed_;
  double gain_ = 1;
  bool hasVerdict_ = false;
};

}  // namespace lampyr
