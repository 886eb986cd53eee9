// The test of learned light selection: does its lower variance outweigh its cost?
//
// Some samples estimate the variance that another selection would have had. A light sample of radiance X that was
// chosen with the density p has the share X² of the second moment of its path; chosen with the density q it would have
// X² p/q. The rest stays as it is. So each tested path gives its second moment for both selections. The factors under
// test are independent of the path: they were learned from earlier ones.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "integrators/guide/pixel_blocks.h"

namespace lampyr {

class ByteReader;
class ByteWriter;

struct TestedSample {
  uint32_t pixel = 0;   // y · width + x
  uint32_t sample = 0;  // index in the pixel
  double found = 0;     // mean of the channels, W/(m² sr)
  // Increase of the second moment, if lights were chosen without the factors, and with them.
  double unlearned = 0, learned = 0;
};

// The tested samples of one thread's share of a pass.
class TestedSamples {
 public:
  // `tests`: false: the samples are learned from, but nothing is kept of them.
  void SetFraction(double fraction, bool tests) {
    fraction_ = fraction;
    tests_ = tests;
  }
  bool Tests() const { return tests_; }
  // True for that fraction of the samples. `decider`: uniform bits that depend on the sample alone.
  bool Wants(uint64_t decider) const { return static_cast<double>(decider >> 11) * 0x1p-53 < fraction_; }
  void Start(uint32_t pixel, uint32_t sample) {
    if (tests_) samples_.push_back({pixel, sample, 0, 0, 0});
  }
  // Of the last sample, if it is tested: a light sample of this radiance, chosen with the density `chosen`.
  void Add(float radiance, float chosen, float unlearned, float learned) {
    const double square = static_cast<double>(radiance) * static_cast<double>(radiance);
    const auto added = [&](float density) { return square * (static_cast<double>(chosen / density) - 1); };
    samples_.back().unlearned += added(unlearned);
    samples_.back().learned += added(learned);
  }
  void End(float found) {
    if (tests_) samples_.back().found = static_cast<double>(found);
  }
  std::span<const TestedSample> All() const { return samples_; }

 private:
  double fraction_ = 0;
  bool tests_ = true;
  std::vector<TestedSample> samples_;
};

class SelectionTest {
 public:
  // Image of width × height pixels, of which `rendered` are rendered (the crop). `isBidirectional`: a sample also has a
  // light path, so that selection is less of its cost. `always`: learned selection is used as soon as anything is
  // learned, whether it pays or not.
  SelectionTest(int width, int height, size_t rendered, bool isBidirectional, bool always);

  // The fraction of the samples that is tested, and from which selection learns, until the next milestone.
  double Fraction() const;
  // Adds the tested samples of a pass, in any order.
  void Learn(std::span<const TestedSamples> samples);
  // Called at milestones, after `samples` samples per pixel.
  void Decide(uint32_t samples);

  // False: what is learned is used without a test.
  bool Tests() const { return !always_; }
  // True until enough is known; learning takes time.
  bool IsLearning() const { return isLearning_; }
  bool IsUsed() const { return isUsed_; }
  // Variance of the samples without what was learned over that with it, as estimated by the last verdict, for errors
  // relative to the picture.
  double Gain() const { return gain_; }

  void Save(ByteWriter& bytes) const;
  // Loads into an object that has learned nothing, of the same image. Throws an Error if the data is not what Save
  // wrote.
  void Load(ByteReader& bytes);

 private:
  // The least gain for which what was learned is used.
  double Worthwhile() const;

  size_t rendered_;
  bool isBidirectional_, always_;
  bool isLearning_ = true, isUsed_ = false;
  uint32_t samples_ = 0;  // at the last milestone
  double gain_ = 1;
  PixelBlocks blocks_;
  std::vector<TestedSample> latest_;  // since the last milestone
};

}  // namespace lampyr
