#include "integrators/guide/selection_test.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/byte_stream.h"
#include "base/error.h"
#include "integrators/guide/gain_estimate.h"

namespace lampyr {

namespace {

// Samples tested between two milestones: while what is learned is not used, and while it is. One costs as much as two
// or three others, so that learning is a few percent of a short render.
constexpr double kTested = 1 << 12, kTestedInUse = 1 << 14;
constexpr size_t kMostTested = size_t{1} << 20;  // of a file
// Least gain for which learned selection is used: it takes up to half as long again, because clusters of the tree in
// which lights seem alike are descended into; a sixth at most where samples have light paths, too. A selection that is
// in use stays in use down to this part of that gain above 1.
constexpr double kPays = 1.3, kPaysForBoth = 1.15, kStaysInUse = 0.8;
// Standard deviations by which the gain is above what is worthwhile, and by which it is below what is promising before
// learning ends early: after kNeverPays samples per pixel; or after kFindsNothing, if the samples found too little for
// a verdict. It ends after kAllLearned, when most has been learned.
constexpr double kSureThatItPays = 2, kSureThatNot = 2;
constexpr double kMayPay = 1.1;
constexpr uint32_t kNeverPays = 2, kFindsNothing = 16, kAllLearned = 64;
// Smallest effective number of samples for a verdict.
constexpr double kFewestOfVerdict = 64;

}  // namespace

SelectionTest::SelectionTest(int width, int height, size_t rendered, bool isBidirectional, bool always)
    : rendered_(rendered),
      isBidirectional_(isBidirectional),
      always_(always),
      isUsed_(always),
      blocks_(width, height) {}

double SelectionTest::Worthwhile() const {
  return isBidirectional_ ? kPaysForBoth : kPays;
}

double SelectionTest::Fraction() const {
  if (always_) return 1;
  const double expected = std::max(samples_, 1u) * static_cast<double>(rendered_);
  return (isUsed_ ? kTestedInUse : kTested) / expected;
}

void SelectionTest::Learn(std::span<const TestedSamples> samples) {
  for (const TestedSamples& list : samples) {
    for (const TestedSample& sample : list.All()) {
      if (std::isfinite(sample.found) && std::isfinite(sample.unlearned) && std::isfinite(sample.learned))
        latest_.push_back(sample);
    }
  }
}

void SelectionTest::Decide(uint32_t samples) {
  // The first factors are made of these samples and tested on the next ones.
  const bool isTested = samples_ > 0 && !always_;
  samples_ = samples;
  // Sums are the same for any number of threads, and for any division into passes.
  std::stable_sort(latest_.begin(), latest_.end(), [](const TestedSample& a, const TestedSample& b) {
    return std::pair(a.sample, a.pixel) < std::pair(b.sample, b.pixel);
  });
  for (const TestedSample& sample : latest_) blocks_.Add(sample.pixel, sample.found);
  if (isTested) {
    const std::vector<double> scales = blocks_.Scales();
    GainEstimate gain;
    double ofMeans = 0;
    for (const TestedSample& sample : latest_) {
      const size_t block = blocks_.Of(sample.pixel);
      const double scale = scales[block] * scales[block];
      const double square = sample.found * sample.found;
      gain.Add(scale * (square + sample.unlearned), scale * (square + sample.learned));
      ofMeans += scale * blocks_.SquaredMean(block);
    }
    gain.SetSquaredMeans(ofMeans);
    if (gain.EffectiveCount() >= kFewestOfVerdict) {
      gain_ = gain.Ratio();
      isUsed_ = isUsed_ ? gain_ - 1 > kStaysInUse * (Worthwhile() - 1) : gain.Bound(-kSureThatItPays) > Worthwhile();
      if (!isUsed_ && samples >= kNeverPays && gain.Bound(kSureThatNot) < kMayPay) isLearning_ = false;
    } else if (!isUsed_ && samples >= kFindsNothing) {
      isLearning_ = false;
    }
  }
  if (samples >= kAllLearned) isLearning_ = false;
  latest_.clear();
}

void SelectionTest::Save(ByteWriter& bytes) const {
  bytes.Value<uint8_t>(isLearning_ ? 1 : 0);
  bytes.Value<uint8_t>(isUsed_ ? 1 : 0);
  bytes.Value(samples_);
  bytes.Value(gain_);
  bytes.List(blocks_.All());
  bytes.List(std::span(latest_));
}

void SelectionTest::Load(ByteReader& bytes) {
  isLearning_ = bytes.Flag();
  isUsed_ = bytes.Flag();
  samples_ = bytes.Value<uint32_t>();
  gain_ = bytes.Value<double>();
  std::vector<PixelBlocks::Block> blocks = bytes.List<PixelBlocks::Block>(blocks_.Count());
  latest_ = bytes.List<TestedSample>(kMostTested);
  bool isSound = std::isfinite(gain_) && gain_ >= 0 && blocks_.Set(std::move(blocks));
  for (const TestedSample& sample : latest_)
    isSound = isSound && std::isfinite(sample.found) && std::isfinite(sample.unlearned) &&
              std::isfinite(sample.learned) && blocks_.Of(sample.pixel) < blocks_.Count();
  if (!isSound) throw Error("it holds a test of light selection that cannot be");
}

}  // namespace lampyr
