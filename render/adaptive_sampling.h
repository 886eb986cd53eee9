// Adaptive sampling: which pixel each sample of a pass belongs to.
//
// Passes are grouped in stages. The first has kFirstStage passes and is uniform; each later one is as long as all
// before it. When a stage begins, every pixel is given a rate, in samples per pass, by what the stages before it have
// measured; the first pass of a stage has one sample in each pixel, the others follow the rates. A pass always has as
// many samples, and light paths, as pixels.
//
// A stage has random numbers of its own. What it adds to a pixel has therefore the expectation of the pixel whatever
// came before it (both_paths.cpp says why the shutter times of passes with photons may share a sequence), and because
// the film weights stages by their passes (film/film.h), the picture is unbiased.
//
// Rates minimise a quantile of the errors of pixels: the error that a given share of them is below.
#pragma once

#include <cstdint>
#include <vector>

#include "film/film.h"
#include "render/settings/render_settings.h"

namespace lampyr {

struct SampleStage {
  uint32_t before = 0;  // passes before it, of this render
  uint32_t first = 0;   // index of its first pass, in the render that this one may be a part of
  uint32_t passes = 0;  // in the stage
  uint64_t seed = 0;    // of its random numbers
};

inline constexpr uint32_t kFirstStage = 4;
// The stage that the pass after `pass` others is in. `offset`: index of the first pass, in a part of a render.
SampleStage StageOf(uint32_t pass, uint32_t offset, uint64_t seed);

class SampleAllocation {
 public:
  // One sample for each of `pixels` in every pass.
  SampleAllocation(const SampleStage& stage, size_t pixels) : stage_(stage), pixels_(pixels) {}
  // Rates from the statistics of the ended stages of the film.
  SampleAllocation(const SampleStage& stage, const Film& film, const AdaptiveSettings& settings);

  const SampleStage& Stage() const { return stage_; }
  // Samples of a pass in the pixels before this one. Pixels: indices into the crop, row by row; passes: from the first
  // of the stage.
  uint64_t Before(size_t pixel, uint32_t pass) const {
    if (ends_.empty() || pass == 0) return pixel;
    if (pixel == 0) return 0;
    const uint64_t passes = stage_.passes - 1, shift = Shift(pass);
    return (ends_[pixel - 1] + shift) / passes;
  }
  uint32_t Count(size_t pixel, uint32_t pass) const {
    return static_cast<uint32_t>(Before(pixel + 1, pass) - Before(pixel, pass));
  }
  // The pixel that sample `slot` of a pass belongs to: samples are in the order of their pixels.
  size_t PixelOf(uint64_t slot, uint32_t pass) const;

 private:
  uint64_t Shift(uint32_t pass) const;

  SampleStage stage_;
  size_t pixels_;
  // Samples of all passes but the first, in this pixel and all before it; empty: one in each pixel and pass. Those of
  // one pass are every (passes - 1)-th, beginning at another one in each pass: together they are all, and a pixel's are
  // evenly distributed over the passes.
  std::vector<uint64_t> ends_;
  uint64_t firstShift_ = 0, shiftStep_ = 0;  // of Shift
};

// The samples that each pixel should have in a stage, by what the ended stages of the film tell; one for each pixel and
// pass on average. Public for tests.
std::vector<double> WantedSamples(const Film& film, const SampleStage& stage, const AdaptiveSettings& settings);

}  // namespace lampyr
