#include "lights/selection/light_tree.h"

#include <algorithm>
#include <array>

#include "lights/selection/importance_lanes.h"
#include "lights/selection/light_tree_builder.h"

namespace lampyr {

namespace {

constexpr int kWidth = LightTree::kWidth;

// A cluster is opened when its importance times its doubt is more than this part of all: lights600 has 0.85 × the
// variance by it, rooms 0.5 ×, for a fifth more time.
constexpr float kNegligible = 1.0f / 32;
// Doubt for being near: of clusters that are seen under more than 60° or so, nothing is sure.
constexpr float kDoubtOfSpread = 4;

double SumOf(const float* weights) {
  double sum = 0;
  for (int i = 0; i < kWidth; ++i) sum += static_cast<double>(weights[i]);
  return sum;
}

// The child at u in [0,1) of all weights one after the other, and u within its share. No branch hangs on u.
uint32_t Choose(const float* weights, double sum, double& u) {
  const double x = u * sum;
  double before[kWidth + 1];
  before[0] = 0;
  for (int i = 0; i < kWidth; ++i) before[i + 1] = before[i] + static_cast<double>(weights[i]);
  int slot = 0;
  for (int i = 1; i <= kWidth; ++i) slot += before[i] <= x ? 1 : 0;
  if (slot == kWidth) [[unlikely]] {  // u · sum was rounded to the sum
    while (slot > 1 && !(weights[slot - 1] > 0)) --slot;
    u = 0x1.fffffffffffffp-1;
    return static_cast<uint32_t>(slot - 1);
  }
  u = std::min((x - before[slot]) / static_cast<double>(weights[slot]), 0x1.fffffffffffffp-1);
  return static_cast<uint32_t>(slot);
}

}  // namespace

LightTree::LightTree(std::span<const ClusterBounds> emitters, int threads) {
  LightTreeBuilder(emitters, threads).BuildInto(*this);
  if (!IsEmpty()) intensity_ = SumOf(nodes_[0].lobes.intensity);
}

// One compiled function: the same receiver gives the same bits, whoever asks.
[[gnu::noinline]] void LightTree::Look(const TreeReceiver& receiver, Cut& cut) const {
  cut.count = 0;
  cut.total = cut.irradiance = 0;
  if (IsEmpty()) return;
  Lanes doubtful[Cut::kRoom];
  float total = 0;
  const auto open = [&](uint32_t node) {
    const LaneImportances here = Evaluate(nodes_[node].lobes, receiver);
    here.importance.copy_to(cut.importance[cut.count], simd::vector_aligned);
    doubtful[cut.count] =
        here.importance * simd::min(kDoubtOfSpread * here.spread + Load(nodes_[node].doubt), Lanes(1.0f));
    total += simd::reduce(here.importance);
    cut.node[cut.count++] = node;
  };
  open(0);
  for (int i = 0; i < cut.count; ++i) {
    auto isToOpen = doubtful[i] > kNegligible * std::max(total, 0.0f);  // what is left after rounding
    while (simd::any_of(isToOpen) && cut.count < Cut::kRoom) {
      const int slot = simd::find_first_set(isToOpen);
      isToOpen[static_cast<size_t>(slot)] = false;
      total -= cut.importance[i][slot];
      cut.importance[i][slot] = 0;
      open(nodes_[cut.node[i]].child[slot]);
    }
  }
  for (int i = 0; i < cut.count; ++i) cut.total += cut.sum[i] = SumOf(cut.importance[i]);
  cut.irradiance = cut.total;
  if (cut.total > 0) [[likely]]
    return;
  // Nothing seems to contribute: by intensity.
  cut.count = 1;
  std::copy_n(nodes_[0].lobes.intensity, kWidth, cut.importance[0]);
  cut.total = cut.sum[0] = SumOf(cut.importance[0]);
}

// The importances of a node's children, below the cut; returns their sum. One compiled function, too.
[[gnu::noinline]] double LightTree::LookAt(uint32_t node, const TreeReceiver& receiver, float* importance) const {
  Evaluate(nodes_[node].lobes, receiver).importance.copy_to(importance, simd::vector_aligned);
  const double sum = SumOf(importance);
  if (sum > 0) [[likely]]
    return sum;
  // A cluster may look as if it contributed while none of its parts does.
  std::copy_n(nodes_[node].lobes.intensity, kWidth, importance);
  return SumOf(importance);
}

uint32_t LightTree::SelectSlot(const TreeReceiver& receiver, const Cut& cut, double& u, double& probability) const {
  double x = u * cut.total;
  int at = 0;
  while (at + 1 < cut.count && x >= cut.sum[at]) x -= cut.sum[at++];
  while (!(cut.sum[at] > 0)) --at;  // x was rounded beyond the last that counts
  u = std::min(x / cut.sum[at], 0x1.fffffffffffffp-1);
  uint32_t node = cut.node[at];
  uint32_t slot = Choose(cut.importance[at], cut.sum[at], u);
  probability = static_cast<double>(cut.importance[at][slot]) / cut.total;
  while (!(nodes_[node].child[slot] & kEmitter)) {
    node = nodes_[node].child[slot];
    alignas(64) float importance[kWidth];
    const double sum = LookAt(node, receiver, importance);
    slot = Choose(importance, sum, u);
    probability *= static_cast<double>(importance[slot]) / sum;
  }
  return node * kWidth + slot;
}

uint32_t LightTree::SelectSlotBlindly(double& u) const {
  for (uint32_t node = 0;;) {
    const float* intensity = nodes_[node].lobes.intensity;
    const uint32_t slot = Choose(intensity, SumOf(intensity), u);
    if (nodes_[node].child[slot] & kEmitter) return node * kWidth + slot;
    node = nodes_[node].child[slot];
  }
}

EmitterChoice LightTree::Select(const TreeReceiver& receiver, const Cut& cut, double u, bool blindly) const {
  EmitterChoice choice;
  choice.u = u;
  uint32_t slot;
  if (blindly) {
    slot = SelectSlotBlindly(choice.u);
    choice.probability.seen = SeenProbability(receiver, cut, slot);
  } else {
    slot = SelectSlot(receiver, cut, choice.u, choice.probability.seen);
  }
  choice.probability.blind = BlindProbability(slot);
  choice.emitter = nodes_[slot / kWidth].child[slot % kWidth] & ~kEmitter;
  return choice;
}

// What the shares of the levels multiply to.
double LightTree::BlindProbability(uint32_t slot) const {
  return static_cast<double>(nodes_[slot / kWidth].lobes.intensity[slot % kWidth]) / intensity_;
}

// From the cut down, as an emitter is chosen: products of the same numbers in the same order.
double LightTree::SeenProbability(const TreeReceiver& receiver, const Cut& cut, uint32_t slot) const {
  constexpr size_t kRoom = 128;  // the builder divides into halves from its 40th level on, and there are 2^31 emitters
  std::array<uint32_t, kRoom> way;
  size_t length = 0;
  int at = 0;
  for (;;) {
    way[length++] = slot;
    const uint32_t node = slot / kWidth;
    const uint32_t* known = std::find(cut.node, cut.node + cut.count, node);
    if (known != cut.node + cut.count) {
      at = static_cast<int>(known - cut.node);
      break;
    }
    slot = parents_[node];
  }
  double probability = static_cast<double>(cut.importance[at][way[--length] % kWidth]) / cut.total;
  while (length > 0) {
    const uint32_t below = way[--length];
    alignas(64) float importance[kWidth];
    const double sum = LookAt(below / kWidth, receiver, importance);
    probability *= static_cast<double>(importance[below % kWidth]) / sum;
  }
  return probability;
}

EmitterProbability LightTree::ProbabilityOf(const TreeReceiver& receiver, const Cut& cut, uint32_t emitter) const {
  if (emitter >= slots_.size() || slots_[emitter] == kNone) return {0, 0};
  return {SeenProbability(receiver, cut, slots_[emitter]), BlindProbability(slots_[emitter])};
}

size_t LightTree::Bytes() const {
  return nodes_.capacity() * sizeof(Node) + (parents_.capacity() + slots_.capacity()) * sizeof(uint32_t);
}

}  // namespace lampyr
