// Selection by the light tree for a segment of a ray.
#include <algorithm>
#include <array>

#include "lights/selection/light_tree.h"
#include "lights/selection/segment_importance_lanes.h"

namespace lampyr {

namespace {

constexpr int kWidth = LightTree::kWidth;

// Samples a child in proportion to the importances and rescales u.
uint32_t Choose(const double* importance, double sum, double& u) {
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

}  // namespace

// Not inlined, so that the same segment always gives the same bits.
[[gnu::noinline]] void LightTree::EvaluateNode(uint32_t node, const TreeSegment& segment, SegmentView& view) const {
  const LaneSegmentImportances lanes = EvaluateAlong(nodes_[node].lobes, segment);
  alignas(64) float importance[kWidth];
  lanes.importance.copy_to(importance, simd::vector_aligned);
  const Lanes variety = importance::LoadBfloat16(nodes_[node].variety);
  Lanes doubt = kDoubtOfUnevenness * simd::min(lanes.unevenness, variety);
  where(variety < 0.0f, doubt) = kNoDoubt;
  doubt = simd::min(kDoubtOfSpread * lanes.spread + doubt, Lanes(1.0f));
  doubt.copy_to(view.doubt, simd::vector_aligned);
  view.sum = 0;
  for (int slot = 0; slot < kWidth; ++slot)
    view.sum += view.importance[slot] = segment.length > 0 ? static_cast<double>(importance[slot]) : 0.0;
}

// Not inlined, as above.
[[gnu::noinline]] void LightTree::AskEmitters(uint32_t node, const SegmentEmitters& emitters, double total,
                                              double* importance) const {
  constexpr double kAsked = 1.0 / 64;
  for (int slot = 0; slot < kWidth; ++slot) {
    const uint32_t child = nodes_[node].child[slot];
    if (!(child & kEmitter) || !(importance[slot] > kAsked * total)) continue;
    importance[slot] = emitters.ImportanceOf(child & ~kEmitter, nodes_[node].lobes.Get(slot));
  }
}

// Not inlined, as above.
[[gnu::noinline]] void LightTree::LookBelow(uint32_t node, const TreeSegment& segment, const SegmentEmitters& emitters,
                                            SegmentView& view) const {
  EvaluateNode(node, segment, view);
  AskEmitters(node, emitters, view.sum, view.importance);
  view.sum = 0;
  for (const double importance : view.importance) view.sum += importance;
  if (view.sum > 0) return;
  for (int slot = 0; slot < kWidth; ++slot)
    view.sum += view.importance[slot] = static_cast<double>(nodes_[node].lobes.intensity[slot]);
}

// As Look. Not inlined, as above.
[[gnu::noinline]] void LightTree::LookAlong(const TreeSegment& segment, const SegmentEmitters& emitters,
                                            SegmentCut& cut) const {
  cut.count = 0;
  cut.total = cut.fluence = 0;
  if (IsEmpty()) return;
  double doubtful[SegmentCut::kRoom][kWidth], total = 0;
  const auto open = [&](uint32_t node) {
    SegmentView view;
    EvaluateNode(node, segment, view);
    for (int slot = 0; slot < kWidth; ++slot)
      doubtful[cut.count][slot] = view.importance[slot] * static_cast<double>(view.doubt[slot]);
    std::copy_n(view.importance, kWidth, cut.importance[cut.count]);
    total += view.sum;
    cut.node[cut.count++] = node;
  };
  open(0);
  for (int i = 0; i < cut.count; ++i) {
    for (int slot = 0; slot < kWidth && cut.count < SegmentCut::kRoom; ++slot) {
      if (!(doubtful[i][slot] > static_cast<double>(kNegligible) * std::max(total, 0.0))) continue;
      total -= cut.importance[i][slot];
      cut.importance[i][slot] = 0;
      open(nodes_[cut.node[i]].child[slot]);
    }
  }
  for (int i = 0; i < cut.count; ++i) {
    AskEmitters(cut.node[i], emitters, total, cut.importance[i]);
    cut.sum[i] = 0;
    for (const double importance : cut.importance[i]) cut.sum[i] += importance;
    cut.total += cut.sum[i];
  }
  cut.fluence = cut.total;
  if (cut.total > 0) return;
  // No emitter has importance: selection by intensity.
  cut.count = 1;
  cut.sum[0] = 0;
  for (int slot = 0; slot < kWidth; ++slot)
    cut.sum[0] += cut.importance[0][slot] = static_cast<double>(nodes_[0].lobes.intensity[slot]);
  cut.total = cut.sum[0];
}

EmitterChoice LightTree::SelectAlong(const TreeSegment& segment, const SegmentEmitters& emitters, const SegmentCut& cut,
                                     double u, bool defensive) const {
  EmitterChoice choice;
  choice.u = u;
  if (defensive) {
    choice.emitter = FindByIntensity(0, Trend(), choice.u).emitter;
    choice.probability = ProbabilityAlong(segment, emitters, cut, choice.emitter);
    return choice;
  }
  double x = u * cut.total;
  int at = 0;
  while (at + 1 < cut.count && x >= cut.sum[at]) x -= cut.sum[at++];
  while (!(cut.sum[at] > 0)) --at;  // rounding led beyond the last node with importance
  choice.u = std::min(x / cut.sum[at], 0x1.fffffffffffffp-1);
  uint32_t node = cut.node[at], slot = Choose(cut.importance[at], cut.sum[at], choice.u);
  double probability = cut.importance[at][slot] / cut.total;
  for (uint32_t child; !((child = nodes_[node].child[slot]) & kEmitter);) {
    node = child;
    SegmentView view;
    LookBelow(node, segment, emitters, view);
    slot = Choose(view.importance, view.sum, choice.u);
    probability *= view.importance[slot] / view.sum;
  }
  choice.emitter = nodes_[node].child[slot] & ~kEmitter;
  choice.probability = {probability, DefensiveProbability(nodes_[node].lobes.intensity[slot])};
  return choice;
}

// From the cut downwards, with the same products in the same order as the selection.
EmitterProbability LightTree::ProbabilityAlong(const TreeSegment& segment, const SegmentEmitters& emitters,
                                               const SegmentCut& cut, uint32_t emitter) const {
  if (emitter >= slots_.size() || slots_[emitter] == kNone) return {0, 0};
  std::array<uint32_t, kLongestWay> way;
  size_t length = 0;
  int at = cut.count;
  for (uint32_t slot = slots_[emitter]; at == cut.count; slot = parents_[slot / kWidth]) {
    way[length++] = slot;
    at = static_cast<int>(std::find(cut.node, cut.node + cut.count, slot / kWidth) - cut.node);
  }
  double probability = cut.importance[at][way[--length] % kWidth] / cut.total;
  while (length > 0) {
    const uint32_t slot = way[--length];
    SegmentView view;
    LookBelow(slot / kWidth, segment, emitters, view);
    probability *= view.importance[slot % kWidth] / view.sum;
  }
  return {probability, DefensiveProbability(IntensityOf(slots_[emitter]))};
}

}  // namespace lampyr
