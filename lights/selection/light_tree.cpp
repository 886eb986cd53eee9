#include "lights/selection/light_tree.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "lights/selection/light_tree_builder.h"

namespace lampyr {

namespace {

constexpr int kWidth = LightTree::kWidth;

// Importance() of light_bounds.h for all children at once: the same steps, as loops over arrays that the compiler turns
// into vectors, and choices instead of branches. One compiled function, so that a probability that is asked for again
// has the same bits.
[[gnu::noinline]] void Importances(const LightTree::Node& node, const TreeReceiver& receiver, float* result) {
  constexpr float slack = 1e-4f, nearest = 1e-20f;
  const Point3 p = receiver.position;
  const Normal3 n = receiver.normal;
  const bool hasNormal = n.x != 0 || n.y != 0 || n.z != 0;
  const float isTransmissive = receiver.isTransmissive ? 1.0f : 0.0f;
  alignas(32) float twoSided[kWidth];
  for (int i = 0; i < kWidth; ++i) twoSided[i] = node.twoSided >> i & 1u ? 1.0f : 0.0f;
  for (int i = 0; i < kWidth; ++i) {
    const float x = p.x - 0.5f * (node.minX[i] + node.maxX[i]), hx = 0.5f * (node.maxX[i] - node.minX[i]);
    const float y = p.y - 0.5f * (node.minY[i] + node.maxY[i]), hy = 0.5f * (node.maxY[i] - node.minY[i]);
    const float z = p.z - 0.5f * (node.minZ[i] + node.maxZ[i]), hz = 0.5f * (node.maxZ[i] - node.minZ[i]);
    const float distance2 = x * x + y * y + z * z, radius2 = hx * hx + hy * hy + hz * hz;
    float atLeast = distance2 > radius2 ? distance2 : radius2;
    atLeast = atLeast > nearest ? atLeast : nearest;
    const float positive2 = distance2 > nearest ? distance2 : nearest;
    const float inverse = 1 / std::sqrt(positive2);
    float seenSine2 = radius2 / positive2;
    seenSine2 = seenSine2 < 1 ? seenSine2 : 1.0f;
    const float seenSine = std::sqrt(seenSine2), seenCosine = std::sqrt(1 - seenSine2);

    float cosine = (node.axisX[i] * x + node.axisY[i] * y + node.axisZ[i] * z) * inverse;
    cosine = twoSided[i] > 0 ? std::abs(cosine) : cosine;
    cosine = cosine < 1 ? cosine : 1.0f;
    cosine = cosine > -1 ? cosine : -1.0f;
    const float sine = std::sqrt(1 - cosine * cosine);
    const float cosO = node.cosThetaO[i], sinO = std::sqrt(1 - cosO * cosO);
    const bool withinO = cosine >= cosO;
    const float cosBeyond = withinO ? 1.0f : cosine * cosO + sine * sinO;
    const float sinBeyond = withinO ? 0.0f : sine * cosO - cosine * sinO;
    const float emitted = cosBeyond >= seenCosine ? 1.0f : cosBeyond * seenCosine + sinBeyond * seenSine;
    const bool isDark = emitted < node.cosThetaE[i] - slack;

    float facing = -(n.x * x + n.y * y + n.z * z) * inverse;
    facing = isTransmissive > 0 ? std::abs(facing) : facing;
    facing = facing < 1 ? facing : 1.0f;
    facing = facing > -1 ? facing : -1.0f;
    const float facingSine = std::sqrt(1 - facing * facing);
    float received = facing >= seenCosine ? 1.0f : facing * seenCosine + facingSine * seenSine;
    received = hasNormal ? received : 1.0f;
    const bool isBehind = received < -slack;

    const bool isInside = distance2 <= radius2;
    const float most = node.intensity[i] / atLeast;
    const float angles = (emitted > slack ? emitted : slack) * (received > slack ? received : slack);
    const float outside = isDark || isBehind ? 0.0f : most * angles;
    result[i] = isInside ? most : outside;
  }
}

// What each child is chosen with; both add up to 1.
struct Shares {
  alignas(32) float seen[kWidth];
  alignas(32) float blind[kWidth];
};

[[gnu::noinline]] void SharesOf(const LightTree::Node& node, const TreeReceiver& receiver, Shares& shares) {
  Importances(node, receiver, shares.seen);
  float sum = 0, sumBlind = 0;
  for (int i = 0; i < kWidth; ++i) {
    sum += shares.seen[i];
    sumBlind += node.intensity[i];
  }
  for (int i = 0; i < kWidth; ++i) shares.blind[i] = node.intensity[i] / sumBlind;
  // A cluster may look as if it contributed while none of its parts does.
  const bool isDark = !(sum > 0);
  for (int i = 0; i < kWidth; ++i) shares.seen[i] = isDark ? shares.blind[i] : shares.seen[i] / sum;
}

// The child at u in [0,1), and u within its share.
int Choose(const float* shares, double& u) {
  int last = 0;
  for (int i = 0; i < kWidth; ++i) {
    const auto share = static_cast<double>(shares[i]);
    if (!(share > 0)) continue;
    last = i;
    if (u < share) {
      u /= share;
      return i;
    }
    u -= share;
  }
  u = 0x1.fffffffffffffp-1;  // shares that add up to a little less than 1
  return last;
}

}  // namespace

LightTree::LightTree(std::span<const ClusterBounds> emitters, int threads) {
  LightTreeBuilder(emitters, threads).BuildInto(*this);
}

LightTree::Choice LightTree::Select(const TreeReceiver& receiver, double u, bool blindly) const {
  Choice choice;
  uint32_t node = 0;
  for (;;) {
    Shares shares;
    SharesOf(nodes_[node], receiver, shares);
    const int slot = Choose(blindly ? shares.blind : shares.seen, u);
    choice.probability.seen *= static_cast<double>(shares.seen[slot]);
    choice.probability.blind *= static_cast<double>(shares.blind[slot]);
    const uint32_t child = nodes_[node].child[slot];
    if (child & kEmitter) {
      choice.emitter = child & ~kEmitter;
      choice.u = std::min(u, 0x1.fffffffffffffp-1);
      return choice;
    }
    node = child;
  }
}

LightTree::Probabilities LightTree::ProbabilityOf(const TreeReceiver& receiver, uint32_t emitter) const {
  if (emitter >= slots_.size() || slots_[emitter] == kNone) return {0, 0};
  // From the root down, as it is chosen: products of the same numbers in the same order.
  constexpr size_t kRoom = 128;  // the builder divides into halves from its 40th level on, and there are 2^31 emitters
  std::array<uint32_t, kRoom> way;
  size_t length = 0;
  for (uint32_t slot = slots_[emitter]; slot != kNone && length < kRoom; slot = nodes_[slot / kWidth].parent)
    way[length++] = slot;
  Probabilities probability;
  while (length > 0) {
    const uint32_t slot = way[--length];
    Shares shares;
    SharesOf(nodes_[slot / kWidth], receiver, shares);
    probability.seen *= static_cast<double>(shares.seen[slot % kWidth]);
    probability.blind *= static_cast<double>(shares.blind[slot % kWidth]);
  }
  return probability;
}

float LightTree::TotalImportance(const TreeReceiver& receiver) const {
  if (IsEmpty()) return 0;
  alignas(32) float importances[kWidth];
  Importances(nodes_[0], receiver, importances);
  float sum = 0;
  for (const float importance : importances) sum += importance;
  return sum;
}

size_t LightTree::Bytes() const {
  return nodes_.capacity() * sizeof(Node) + slots_.capacity() * sizeof(uint32_t);
}

}  // namespace lampyr
