#include "lights/selection/emitter_list.h"

#include <algorithm>

namespace lampyr {

namespace {

constexpr uint32_t kWidth = LobeBlock::kWidth;

}  // namespace

EmitterList::EmitterList(std::span<const ClusterBounds> emitters, int) {
  blocks_.resize((emitters.size() + kWidth - 1) / kWidth);
  for (size_t i = 0; i < emitters.size(); ++i) {
    const ClusterLobe lobe = LobeOf(emitters[i]);
    blocks_[i / kWidth].Set(static_cast<int>(i % kWidth), lobe);
    intensity_ += static_cast<double>(lobe.intensity);
  }
}

EmitterList::Root EmitterList::Look(const TreeReceiver& receiver) const {
  Root root;
  Importances importances;
  for (const LobeBlock& block : blocks_) {
    Evaluate(block, receiver, importances);
    root.sum += importances.Sum();
  }
  root.irradiance = root.sum;
  if (!(root.sum > 0)) root = {intensity_, 0, true};
  return root;
}

EmitterChoice EmitterList::Select(const TreeReceiver& receiver, const Root& root, double u, bool blindly) const {
  const bool byIntensity = blindly || root.byIntensity;
  double left = u * (byIntensity ? intensity_ : root.sum);
  EmitterChoice choice;
  for (uint32_t i = 0; i < blocks_.size(); ++i) {
    Importances weights;
    if (byIntensity) {
      std::copy_n(blocks_[i].intensity, kWidth, weights.of);
    } else {
      Evaluate(blocks_[i], receiver, weights);
    }
    const double ofBlock = weights.Sum();
    if (!(ofBlock > 0)) continue;
    const bool isHere = left < ofBlock;
    for (uint32_t slot = 0; slot < kWidth; ++slot) {
      const auto weight = static_cast<double>(weights.of[slot]);
      if (!(weight > 0)) continue;
      choice.emitter = i * kWidth + slot;  // the last one that can be, should rounding leave none
      choice.u = std::clamp(left / weight, 0.0, 0x1.fffffffffffffp-1);
      if (isHere && left < weight) {
        choice.probability = ProbabilityOf(receiver, root, choice.emitter);
        return choice;
      }
      left -= weight;
    }
  }
  choice.probability = ProbabilityOf(receiver, root, choice.emitter);
  return choice;
}

double EmitterList::WeightOf(const TreeReceiver& receiver, bool byIntensity, uint32_t emitter) const {
  const LobeBlock& block = blocks_[emitter / kWidth];
  if (byIntensity) return static_cast<double>(block.intensity[emitter % kWidth]);
  Importances importances;
  Evaluate(block, receiver, importances);
  return static_cast<double>(importances.of[emitter % kWidth]);
}

EmitterProbability EmitterList::ProbabilityOf(const TreeReceiver& receiver, const Root& root, uint32_t emitter) const {
  if (emitter >= blocks_.size() * kWidth) return {0, 0};
  return {WeightOf(receiver, root.byIntensity, emitter) / root.sum, WeightOf(receiver, true, emitter) / intensity_};
}

}  // namespace lampyr
