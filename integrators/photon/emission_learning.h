// Emission guiding ([Vorba14]): learns from the photons of each pass where to send photons. Only the first segment of
// light paths is guided, from the light to the first hit.
//
// A candidate guide is made of the photons seen so far and tested on the photons of the following passes, which are
// independent of it. It is used only if it would have reduced the variance of their sums enough. Contributions of
// photons are summed in integers, so that they are the same for any number of threads. The guide changes at samples 1,
// 2, 4 … only, so that each pass has one density.
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
  // `scene` must outlive it. Starts with a guess: if very few photons come near to what an image of width × height
  // pixels sees, directly or after one more bounce, photons are guided there until measurements replace the guess.
  EmissionLearning(const RenderScene& scene, int width, int height);

  // Adds the per-photon image contributions of a pass.
  void Learn(const PhotonUse& use);
  // Called at milestones, after `samples` samples per pixel: evaluates the candidate and updates Guide(). True if the
  // density of emission may have changed.
  bool Decide(uint32_t samples);
  // The guide in use; null: photons are not guided.
  const EmissionGuide* Guide() const { return guide_.get(); }

  // True until enough is known; recording contributions takes time.
  bool IsRecording() const { return isRecording_; }

  // Squared error of the photons' sums without a guide, over that with the candidate, as estimated by the last verdict.
  double Gain() const { return gain_; }
  // The last verdict is far below the gain that a guide needs, and rests on many photons.
  bool SeemsUseless() const;
  int Components() const { return guide_ ? guide_->ComponentCount() : 0; }

  // Saves all that was learned. To be called between passes.
  void Save(ByteWriter& bytes) const;
  // Loads into an object that has learned nothing, of the same scene and image. Throws an Error if the data is not what
  // Save wrote.
  void Load(ByteReader& bytes);

 private:
  void Guess(const RenderScene& scene, int width, int height);
  std::vector<UsefulPhoton> Evidence() const;
  void Thin();
  std::shared_ptr<const EmissionGuide> MakeGuide(std::span<const UsefulPhoton> photons) const;

  const LightingServices& lighting_;
  bool isRecording_ = true;
  std::vector<UsefulPhoton> guessed_;  // empty: photons come near to what is seen without a guide
  std::vector<UsefulPhoton> useful_;
  std::shared_ptr<const EmissionGuide> guide_;  // the guide in use, or null
  // The candidate, or null; and all photons that it is made of.
  std::shared_ptr<const EmissionGuide> tried_;
  std::vector<UsefulPhoton> evidence_;
  // A sum with its effective number of terms.
  struct Sum {
    double sum = 0, squares = 0;
    void Add(double value) {
      sum += value;
      squares += value * value;
    }
    // Number of equal terms with the same relative variance.
    double Count() const { return squares > 0 ? sum * sum / squares : 0; }
  };
  // Squared contributions of the photons since the last verdict: as they would be without a guide, and with the
  // candidate.
  Sum unguided_, aimed_;
  double gain_ = 1;
  bool hasVerdict_ = false;
};

}  // namespace lampyr
