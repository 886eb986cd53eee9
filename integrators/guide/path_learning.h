// Path guiding: learns from the walks of each pass where walks should go after a wide scattering ([Müller17],
// [Vorba14], [Ruppert20]; in one place for camera paths and light paths).
//
// A guide is made of the events seen so far, and tested on the walks of the following passes, which it does
// not know. It is used only if it would have reduced their variance by more than it costs. The guide changes at samples
// 1, 2, 4 … only, so that each pass has one density. Russian roulette learns with it (path_roulette.h). Records are
// taken in the order of the samples, so that all is the same for any number of threads.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "integrators/guide/path_records.h"
#include "integrators/guide/path_roulette.h"
#include "integrators/guide/pixel_blocks.h"

namespace lampyr {

class ByteReader;
class ByteWriter;
class GainEstimate;

class PathLearning {
 public:
  // Samples per pixel after which recording ends in any case.
  static constexpr uint32_t kLastMilestone = 64;

  // Image of width × height pixels, of which `recorded` are rendered (the crop). `forLight`: light paths are guided,
  // too. `always`: a guide is used as soon as there is one.
  PathLearning(int width, int height, size_t recorded, bool forLight, bool always);

  // The fraction of the camera paths that is recorded until the next milestone.
  double Fraction() const;
  // Adds the records of a pass, in any order.
  void Learn(std::span<const PathRecords> records);
  // Called at milestones, after `samples` samples per pixel: tests the candidate, makes the next one, and updates
  // Guide(). True if the density of walks may have changed.
  // `mayUse`: false while the guiding of photons is being learned, or may be soon. Guided camera paths take the MIS
  // weight from photons, and so hide the gain of guiding those, which may be far larger.
  bool Decide(uint32_t samples, int threads, bool mayUse = true);
  // Called instead of Decide at a milestone before which no paths were recorded.
  void Skip(uint32_t samples) { samples_ = samples; }
  // The guide in use; null: walks are not guided.
  const std::shared_ptr<const PathGuide>& Guide() const { return guide_; }
  // The Russian roulette of camera paths; null: nothing is known yet. It is learned from the same records, whether a
  // guide is used or not.
  const std::shared_ptr<const PathRoulette>& Roulette() const { return roulette_.Roulette(); }
  // True until enough is known; recording takes time.
  bool IsRecording() const { return isRecording_; }

  // Variance of the camera paths without a guide over that with the candidate, as estimated by the last verdict, for
  // errors relative to the picture.
  double Gain() const { return gain_; }
  size_t Regions() const { return guide_ ? guide_->Regions() : 0; }

  // Saves all that was learned. To be called between passes.
  void Save(ByteWriter& bytes) const;
  // Loads into an object that has learned nothing, of the same image. Throws an Error if the data is not what Save
  // wrote.
  void Load(ByteReader& bytes);

 private:
  // The least gain for which a guide is used.
  double Worthwhile() const;
  // True for a gain that may become worthwhile with more events.
  bool IsPromising(double gain) const;
  GainEstimate Test(const std::vector<double>& scales) const;
  bool Keep(const std::vector<double>& scales);

  int width_, height_;
  size_t recorded_;
  bool forLight_, always_;
  bool isRecording_ = true;
  bool seemsHopeless_ = false;  // by the last verdict
  uint32_t samples_ = 0;        // at the last milestone
  double gain_ = 1;
  std::shared_ptr<const PathGuide> guide_;  // the guide in use, or null
  std::shared_ptr<const PathGuide> tried_;  // the candidate, or null
  PixelBlocks blocks_;                      // of the recorded paths
  RouletteLearning roulette_;
  PathRecords latest_;  // since the last milestone
  // Weighted events of earlier intervals: of camera paths, and of the light paths along them.
  std::vector<PlacedEvent> kept_, keptOfLight_;
};

}  // namespace lampyr
