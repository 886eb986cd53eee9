#include "lights/selection/light_tree.h"

#include <algorithm>
#include <array>

#include "lights/selection/light_tree_builder.h"

namespace lampyr {

namespace {

constexpr int kWidth = LightTree::kWidth;

// The child at u in [0,1) of all weights one after the other, and u within its share. No branch hangs on u.
int Choose(const float* weights, double sum, double& u) {
  const double x = u * sum;
  double before[kWidth + 1];
  before[0] = 0;
  for (int i = 0; i < kWidth; ++i) before[i + 1] = before[i] + static_cast<double>(weights[i]);
  int slot = 0;
  for (int i = 1; i <= kWidth; ++i) slot += before[i] <= x ? 1 : 0;
  if (slot == kWidth) [[unlikely]] {  // u · sum was rounded to the sum
    while (slot > 0 && !(weights[slot - 1] > 0)) --slot;
    u = 0x1.fffffffffffffp-1;
    return std::max(slot - 1, 0);
  }
  u = std::min((x - before[slot]) / static_cast<double>(weights[slot]), 0x1.fffffffffffffp-1);
  return slot;
}

}  // namespace

LightTree::LightTree(std::span<const ClusterBounds> emitters, int threads) {
  LightTreeBuilder(emitters, threads).BuildInto(*this);
  if (IsEmpty()) return;
  for (const float intensity : nodes_[0].lobes.intensity) intensity_ += static_cast<double>(intensity);
}

// One compiled function: the same receiver gives the same bits, whoever asks.
[[gnu::noinline]] LightTree::Root LightTree::LookAt(uint32_t node, const TreeReceiver& receiver) const {
  Root root;
  Evaluate(nodes_[node].lobes, receiver, root.importances);
  root.irradiance = root.sum = root.importances.Sum();
  if (root.sum > 0) [[likely]]
    return root;
  // A cluster may look as if it contributed while none of its parts does.
  std::copy_n(nodes_[node].lobes.intensity, kWidth, root.importances.of);
  root.sum = root.importances.Sum();
  return root;
}

LightTree::Root LightTree::Look(const TreeReceiver& receiver) const {
  return IsEmpty() ? Root() : LookAt(0, receiver);
}

EmitterChoice LightTree::Select(const TreeReceiver& receiver, const Root& root, double u, bool blindly) const {
  EmitterChoice choice;
  uint32_t node = 0;
  Root here = root;
  for (;;) {
    const float* weights = blindly ? nodes_[node].lobes.intensity : here.importances.of;
    double sum = here.sum;
    if (blindly) {
      sum = 0;
      for (int i = 0; i < kWidth; ++i) sum += static_cast<double>(weights[i]);
    }
    const int slot = Choose(weights, sum, u);
    choice.probability.seen *= static_cast<double>(here.importances.of[slot]) / here.sum;
    const uint32_t child = nodes_[node].child[slot];
    if (child & kEmitter) {
      choice.emitter = child & ~kEmitter;
      choice.probability.blind = BlindProbability(node * kWidth + static_cast<uint32_t>(slot));
      choice.u = u;
      return choice;
    }
    node = child;
    here = LookAt(node, receiver);
  }
}

// What the shares of the levels multiply to.
double LightTree::BlindProbability(uint32_t slot) const {
  return static_cast<double>(nodes_[slot / kWidth].lobes.intensity[slot % kWidth]) / intensity_;
}

EmitterProbability LightTree::ProbabilityOf(const TreeReceiver& receiver, const Root& root, uint32_t emitter) const {
  if (emitter >= slots_.size() || slots_[emitter] == kNone) return {0, 0};
  // From the root down, as it is chosen: products of the same numbers in the same order.
  constexpr size_t kRoom = 128;  // the builder divides into halves from its 40th level on, and there are 2^31 emitters
  std::array<uint32_t, kRoom> way;
  size_t length = 0;
  for (uint32_t slot = slots_[emitter]; slot != kNone && length < kRoom; slot = nodes_[slot / kWidth].parent)
    way[length++] = slot;
  EmitterProbability probability;
  probability.seen *= static_cast<double>(root.importances.of[way[--length] % kWidth]) / root.sum;
  while (length > 0) {
    const uint32_t slot = way[--length];
    const Root here = LookAt(slot / kWidth, receiver);
    probability.seen *= static_cast<double>(here.importances.of[slot % kWidth]) / here.sum;
  }
  probability.blind = BlindProbability(slots_[emitter]);
  return probability;
}

size_t LightTree::Bytes() const {
  return nodes_.capacity() * sizeof(Node) + slots_.capacity() * sizeof(uint32_t);
}

}  // namespace lampyr
