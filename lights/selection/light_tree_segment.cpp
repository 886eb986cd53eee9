// Selection by the light tree for a segment of a ray.
#include <algorithm>
#include <array>

#include "lights/selection/light_tree.h"

namespace lampyr {

// Not inlined, so that the same segment always gives the same bits.
[[gnu::noinline]] void LightTree::LookAlong(uint32_t node, const TreeSegment& segment, const SegmentEmitters& emitters,
                                            SegmentView& view) const {
  view.sum = 0;
  view.byIntensity = false;
  for (int slot = 0; slot < kWidth; ++slot) {
    const ClusterLobe lobe = nodes_[node].lobes.Get(slot);
    const uint32_t child = nodes_[node].child[slot];
    double importance = SegmentImportance(lobe, segment);
    if (importance > 0 && (child & kEmitter)) importance = emitters.ImportanceOf(child & ~kEmitter, lobe);
    view.sum += view.importance[slot] = importance;
  }
  if (view.sum > 0) return;
  view.byIntensity = true;
  for (int slot = 0; slot < kWidth; ++slot)
    view.sum += view.importance[slot] = static_cast<double>(nodes_[node].lobes.intensity[slot]);
}

uint32_t LightTree::SegmentView::Choose(double& u) const {
  double left = u * sum;
  uint32_t chosen = 0;
  for (uint32_t slot = 0; slot < kWidth; ++slot) {
    if (!(importance[slot] > 0)) continue;
    chosen = slot;  // the last with importance, in case rounding selects none
    u = std::clamp(left / importance[slot], 0.0, 0x1.fffffffffffffp-1);
    if (left < importance[slot]) break;
    left -= importance[slot];
  }
  return chosen;
}

EmitterChoice LightTree::SelectAlong(const TreeSegment& segment, const SegmentEmitters& emitters, double u,
                                     bool defensive) const {
  EmitterChoice choice;
  choice.u = u;
  if (defensive) {
    choice.emitter = FindByIntensity(0, Trend(), choice.u).emitter;
    choice.probability = ProbabilityAlong(segment, emitters, choice.emitter);
    return choice;
  }
  double probability = 1;
  for (uint32_t node = 0;;) {
    SegmentView view;
    LookAlong(node, segment, emitters, view);
    const uint32_t slot = view.Choose(choice.u), child = nodes_[node].child[slot];
    probability *= view.importance[slot] / view.sum;
    if (child & kEmitter) {
      choice.emitter = child & ~kEmitter;
      choice.probability = {probability, DefensiveProbability(nodes_[node].lobes.intensity[slot])};
      return choice;
    }
    node = child;
  }
}

// From the root downwards, with the same products in the same order as the selection.
EmitterProbability LightTree::ProbabilityAlong(const TreeSegment& segment, const SegmentEmitters& emitters,
                                               uint32_t emitter) const {
  if (emitter >= slots_.size() || slots_[emitter] == kNone) return {0, 0};
  std::array<uint32_t, kLongestWay> way;
  size_t length = 0;
  for (uint32_t slot = slots_[emitter]; slot != kNone; slot = parents_[slot / kWidth]) way[length++] = slot;
  double probability = 1;
  while (length > 0) {
    const uint32_t slot = way[--length];
    SegmentView view;
    LookAlong(slot / kWidth, segment, emitters, view);
    probability *= view.importance[slot % kWidth] / view.sum;
  }
  return {probability, DefensiveProbability(IntensityOf(slots_[emitter]))};
}

double LightTree::ImportanceAlong(const TreeSegment& segment, const SegmentEmitters& emitters) const {
  if (IsEmpty()) return 0;
  SegmentView view;
  LookAlong(0, segment, emitters, view);
  return view.byIntensity ? 0 : view.sum;
}

}  // namespace lampyr
