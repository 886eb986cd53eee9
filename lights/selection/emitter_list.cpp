#include "lights/selection/emitter_list.h"

#include <algorithm>

#include "lights/selection/importance_lanes.h"

namespace lampyr {

namespace {

constexpr uint32_t kWidth = LobeBlock::kWidth;

struct Weights {
  alignas(64) float of[kWidth];
  double sum = 0;
};

// Not inlined, so that the same receiver always gives the same bits.
[[gnu::noinline]] Weights WeightsOf(const LobeBlock& block, const TreeReceiver& receiver, bool byIntensity) {
  Weights weights;
  const Lanes lanes = byIntensity ? Load(block.intensity) : Evaluate(block, receiver).importance;
  lanes.copy_to(weights.of, simd::vector_aligned);
  for (const float weight : weights.of) weights.sum += static_cast<double>(weight);
  return weights;
}

}  // namespace

EmitterList::EmitterList(std::span<const ClusterBounds> emitters, int) {
  blocks_.resize((emitters.size() + kWidth - 1) / kWidth);
  for (size_t i = 0; i < emitters.size(); ++i) {
    const ClusterLobe lobe = LobeOf(emitters[i]);
    blocks_[i / kWidth].Set(static_cast<int>(i % kWidth), lobe);
    intensity_ += static_cast<double>(lobe.intensity);
  }
}

void EmitterList::Look(const TreeReceiver& receiver, Cut& cut) const {
  cut = {};
  for (const LobeBlock& block : blocks_) cut.sum += WeightsOf(block, receiver, false).sum;
  cut.irradiance = cut.sum;
  if (!(cut.sum > 0)) cut = {intensity_, 0, true};
}

EmitterChoice EmitterList::Select(const TreeReceiver& receiver, const Cut& cut, double u, bool defensive) const {
  const bool byIntensity = defensive || cut.byIntensity;
  double left = u * (byIntensity ? intensity_ : cut.sum);
  EmitterChoice choice;
  for (uint32_t i = 0; i < blocks_.size(); ++i) {
    const Weights weights = WeightsOf(blocks_[i], receiver, byIntensity);
    if (!(weights.sum > 0)) continue;
    const bool isHere = left < weights.sum;
    for (uint32_t slot = 0; slot < kWidth; ++slot) {
      const auto weight = static_cast<double>(weights.of[slot]);
      if (!(weight > 0)) continue;
      choice.emitter = i * kWidth + slot;  // the last with importance, in case rounding selects none
      choice.u = std::clamp(left / weight, 0.0, 0x1.fffffffffffffp-1);
      if (isHere && left < weight) {
        choice.probability = ProbabilityOf(receiver, cut, choice.emitter);
        return choice;
      }
      left -= weight;
    }
  }
  choice.probability = ProbabilityOf(receiver, cut, choice.emitter);
  return choice;
}

EmitterProbability EmitterList::ProbabilityOf(const TreeReceiver& receiver, const Cut& cut, uint32_t emitter) const {
  if (emitter >= blocks_.size() * kWidth) return {0, 0};
  const auto weight = [&](bool byIntensity) {
    return static_cast<double>(WeightsOf(blocks_[emitter / kWidth], receiver, byIntensity).of[emitter % kWidth]);
  };
  return {weight(cut.byIntensity) / cut.sum, weight(true) / intensity_};
}

// Not inlined, as above.
[[gnu::noinline]] double EmitterList::WeightAlong(const TreeSegment& segment, const SegmentEmitters& emitters,
                                                  uint32_t emitter, bool byIntensity) const {
  const ClusterLobe lobe = blocks_[emitter / kWidth].Get(static_cast<int>(emitter % kWidth));
  if (byIntensity) return static_cast<double>(lobe.intensity);
  return ImportanceAlong(lobe, segment).value > 0 ? emitters.ImportanceOf(emitter, lobe) : 0.0;
}

void EmitterList::LookAlong(const TreeSegment& segment, const SegmentEmitters& emitters, SegmentCut& cut) const {
  cut = {};
  for (uint32_t i = 0; i < blocks_.size() * kWidth; ++i) cut.sum += WeightAlong(segment, emitters, i, false);
  cut.fluence = cut.sum;
  if (!(cut.sum > 0)) cut = {intensity_, 0, true};
}

EmitterChoice EmitterList::SelectAlong(const TreeSegment& segment, const SegmentEmitters& emitters,
                                       const SegmentCut& cut, double u, bool defensive) const {
  const bool byIntensity = defensive || cut.byIntensity;
  double left = u * (byIntensity ? intensity_ : cut.sum);
  EmitterChoice choice;
  for (uint32_t i = 0; i < blocks_.size() * kWidth; ++i) {
    const double weight = WeightAlong(segment, emitters, i, byIntensity);
    if (!(weight > 0)) continue;
    choice.emitter = i;  // the last with importance, in case rounding selects none
    choice.u = std::clamp(left / weight, 0.0, 0x1.fffffffffffffp-1);
    if (left < weight) break;
    left -= weight;
  }
  choice.probability = ProbabilityAlong(segment, emitters, cut, choice.emitter);
  return choice;
}

EmitterProbability EmitterList::ProbabilityAlong(const TreeSegment& segment, const SegmentEmitters& emitters,
                                                 const SegmentCut& cut, uint32_t emitter) const {
  if (emitter >= blocks_.size() * kWidth) return {0, 0};
  return {WeightAlong(segment, emitters, emitter, cut.byIntensity) / cut.sum,
          WeightAlong(segment, emitters, emitter, true) / intensity_};
}

}  // namespace lampyr
