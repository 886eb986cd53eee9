#include "lights/selection/light_tree.h"

#include <algorithm>
#include <array>

#include "lights/selection/importance_lanes.h"
#include "lights/selection/light_learning.h"
#include "lights/selection/light_tree_builder.h"
#include "sampling/rng.h"

namespace lampyr {

namespace {

constexpr int kWidth = LightTree::kWidth;

// kAlike: variance that sampling a cluster by intensity and trend may add, relative to the square of its contribution.
// kSteepest: largest relative change of the trend over the radius, so that few proposals are rejected.
constexpr float kAlike = 0.004f, kSteepest = 0.75f;
// Least learned factor of an importance.
constexpr float kLeastFactor = 0.2f;

double SumOf(const float* weights) {
  double sum = 0;
  for (int i = 0; i < kWidth; ++i) sum += static_cast<double>(weights[i]);
  return sum;
}

// Samples a child in proportion to the weights and rescales u. No branch depends on u.
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

// Learned factors of the children of a node whose own factor is `parentFactor`. A region may be on both sides of
// something small: what is occluded in most of it may light the rest. The least factor bounds what such a light weighs.
Lanes Learned(const TreeReceiver& receiver, uint32_t node, float parentFactor) {
  const LightLearning::Row& row = receiver.learning->RowOf(receiver.region, node);
  const Lanes factor = simd::sqrt(Load(row.known) + parentFactor * parentFactor * (1 - Load(row.learned)));
  return simd::max(factor, Lanes(kLeastFactor));
}

}  // namespace

LightTree::LightTree(std::span<const ClusterBounds> emitters, int threads) {
  LightTreeBuilder(emitters, threads).BuildInto(*this);
}

// Not inlined, so that the same receiver always gives the same bits.
[[gnu::noinline]] void LightTree::Look(const TreeReceiver& receiver, Cut& cut) const {
  cut.count = 0;
  cut.total = cut.irradiance = 0;
  if (IsEmpty()) return;
  Lanes doubtful[Cut::kRoom];
  float total = 0;
  const auto open = [&](uint32_t node, float parentFactor) {
    LaneImportances here = Evaluate(nodes_[node].lobes, receiver);
    if (receiver.learning) {
      const Lanes factor = Learned(receiver, node, parentFactor);
      factor.copy_to(cut.factor[cut.count], simd::vector_aligned);
      here.importance *= factor;
    }
    here.importance.copy_to(cut.importance[cut.count], simd::vector_aligned);
    const Lanes variety = importance::LoadBfloat16(nodes_[node].variety);
    // A cluster of points has no mean normal although its normals do not vary: its unevenness exceeds its variety.
    Lanes doubt = kDoubtOfUnevenness * simd::min(here.unevenness, variety);
    where(variety < 0.0f, doubt) = kNoDoubt;
    doubtful[cut.count] = here.importance * simd::min(kDoubtOfSpread * here.spread + doubt, Lanes(1.0f));
    total += simd::reduce(here.importance);
    cut.node[cut.count++] = node;
  };
  open(0, 1);
  for (int i = 0; i < cut.count; ++i) {
    auto isToOpen = doubtful[i] > kNegligible * std::max(total, 0.0f);  // can be negative by rounding
    while (simd::any_of(isToOpen) && cut.count < Cut::kRoom) {
      const int slot = simd::find_first_set(isToOpen);
      isToOpen[static_cast<size_t>(slot)] = false;
      total -= cut.importance[i][slot];
      cut.importance[i][slot] = 0;
      open(nodes_[cut.node[i]].child[slot], receiver.learning ? cut.factor[i][slot] : 1.0f);
    }
  }
  for (int i = 0; i < cut.count; ++i) cut.total += cut.sum[i] = SumOf(cut.importance[i]);
  cut.irradiance = cut.total;
  if (cut.total > 0) [[likely]]
    return;
  // No emitter has importance: selection by intensity.
  cut.count = 1;
  std::copy_n(nodes_[0].lobes.intensity, kWidth, cut.importance[0]);
  cut.total = cut.sum[0] = SumOf(cut.importance[0]);
}

double LightTree::Cut::Concentration() const {
  Lanes squares = 0;
  for (int i = 0; i < count; ++i) squares += Load(importance[i]) * Load(importance[i]);
  return total > 0 ? static_cast<double>(simd::reduce(squares)) / (total * total) : 1;
}

// Not inlined, as above.
[[gnu::noinline]] void LightTree::LookAt(uint32_t node, const TreeReceiver& receiver, float parentFactor,
                                         View& view) const {
  Lanes importance = Evaluate(nodes_[node].lobes, receiver).importance;
  if (receiver.learning) {
    const Lanes factor = Learned(receiver, node, parentFactor);
    factor.copy_to(view.factor, simd::vector_aligned);
    importance *= factor;
  }
  importance.copy_to(view.importance, simd::vector_aligned);
  view.sum = SumOf(view.importance);
  if (view.sum > 0) [[likely]]
    return;
  // A cluster can have importance while none of its children has: by intensity then.
  std::copy_n(nodes_[node].lobes.intensity, kWidth, view.importance);
  view.sum = SumOf(view.importance);
}

// Not inlined, as above.
[[gnu::noinline]] double LightTree::Trend::At(const Point3& position) const {
  return static_cast<double>(base + glm::dot(gradient, position - middle));
}

// True if the contributions of a cluster's emitters to a receiver are proportional to intensity and trend, up to a
// variance of kAlike. For an emitter at offset x from the mean, with w from the receiver to the mean and normals n at
// the receiver and m at the light, cosines and 1/d² give (n·w')(m·w')/|w'|^k with w' = w + x. The trend is its
// gradient; the second-order term, for positions evenly distributed in a cube, is the error. The cube is inscribed in
// the bounding sphere rather than derived from the variance, which does not show a weak emitter that is near. Not
// inlined, as above.
[[gnu::noinline]] bool LightTree::IsAlike(uint32_t node, uint32_t child, const TreeReceiver& receiver,
                                          Trend& trend) const {
  using namespace importance;
  if (receiver.learning) return false;  // occlusion differs within the cluster
  const float variety = FromBfloat16(nodes_[node].variety[child]);
  const ClusterLobe cluster = nodes_[node].lobes.Get(static_cast<int>(child));
  const Vector3 way = cluster.mean - receiver.position;
  const float inverse2 = 1 / std::max(glm::dot(way, way), kNearest2);
  const float away2 = cluster.radius * cluster.radius * inverse2;
  if (!(away2 < 0.1f && variety < kAlike)) return false;  // early rejection of most clusters
  // Relative change of each factor over the radius, and the power of the distance.
  float power = 2, received = 0, emitted = 0, unevenness = 0;
  trend.gradient = Vector3(0.0f);
  if (LengthSquared(receiver.normal) > 0) {
    float height = glm::dot(receiver.normal, way);
    trend.gradient += receiver.normal / height;
    if (receiver.isTransmissive) height = std::abs(height);
    if (!(height > cluster.radius)) return false;
    received = cluster.radius / height;
    ++power;
  }
  const float length2 = glm::dot(cluster.meanNormal, cluster.meanNormal);
  if (length2 > 0) {  // isotropic points have no mean normal
    float height = -glm::dot(cluster.meanNormal, way);
    trend.gradient -= cluster.meanNormal / height;
    if (cluster.twoSided) height = std::abs(height);
    if (!(height > cluster.radius * std::sqrt(length2))) return false;
    emitted = cluster.radius * std::sqrt(length2) / height;
    unevenness = variety / (height * height * inverse2);
    ++power;
  }
  constexpr float kFill = 0.11f;  // √(mean of x²y²) in a cube, over the squared radius of its sphere
  const float away = std::sqrt(away2);
  const float left =
      kFill * (received * emitted + power * away * (received + emitted) + 0.5f * power * (power + 2) * away2);
  if (!(left * left + unevenness < kAlike)) return false;
  trend.gradient -= power * inverse2 * way;
  const float change = cluster.radius * glm::length(trend.gradient);
  if (!(change < kSteepest)) return false;
  trend.middle = cluster.mean;
  trend.base = 1 - glm::dot(trend.gradient, below_[nodes_[node].child[child]].offset);
  trend.most = 1 + static_cast<double>(change);
  return true;
}

// Samples an emitter below a node by intensity and rescales u. Starts from the place that equal intensities would give,
// and searches from there by doubling steps and bisection.
size_t LightTree::PlaceAt(const Below& below, double& u) const {
  const double x = below.before + u * below.intensity;
  size_t from = below.first, to = from + below.count;  // the result is in [from, to)
  size_t at = GuessAt(below, u);
  if (places_[at].before <= x) {
    for (size_t step = 1; from = at, at + step < to; step *= 2) {
      if (places_[at + step].before > x) {
        to = at + step;
        break;
      }
      at += step;
    }
  } else {
    for (size_t step = 1; to = at, at - from > step; step *= 2) {
      at -= step;
      if (places_[at].before <= x) {
        from = at;
        break;
      }
    }
  }
  while (to - from > 1) {
    const size_t middle = from + (to - from) / 2;
    (places_[middle].before <= x ? from : to) = middle;
  }
  // Rounding may lead to a last place without intensity.
  while (from > below.first && !(IntensityAt(from) > 0)) --from;
  u = std::clamp((x - places_[from].before) / static_cast<double>(IntensityAt(from)), 0.0, 0x1.fffffffffffffp-1);
  return from;
}

// Samples by intensity and trend: proposals by intensity, accepted in proportion to the trend. The place of the next
// proposal is prefetched.
LightTree::Found LightTree::FindByIntensity(uint32_t node, const Trend& trend, double& u) const {
  constexpr uint64_t trials = 64;  // all rejected with a probability of at most 1e-15
  const uint64_t bits = std::bit_cast<uint64_t>(u);
  const Below& below = below_[node];
  for (uint64_t trial = 1;; ++trial) {
    const double next = static_cast<double>(Hash(bits, trial) >> 11) * 0x1p-53;
    if (trend.most > 1) __builtin_prefetch(&places_[GuessAt(below, next)]);
    const size_t at = PlaceAt(below, u);
    const double weight = trend.At(places_[at].position), share = weight / trend.most;
    if (u < share || trial == trials) {
      u = std::min(u / share, 0x1.fffffffffffffp-1);
      return {places_[at].emitter, IntensityAt(at), weight};
    }
    u = next;
  }
}

LightTree::Found LightTree::Descend(const TreeReceiver& receiver, const Cut& cut, double& u,
                                    double& probability) const {
  double x = u * cut.total;
  int at = 0;
  while (at + 1 < cut.count && x >= cut.sum[at]) x -= cut.sum[at++];
  while (!(cut.sum[at] > 0)) --at;  // rounding led beyond the last node with importance
  u = std::min(x / cut.sum[at], 0x1.fffffffffffffp-1);
  uint32_t node = cut.node[at];
  uint32_t slot = Choose(cut.importance[at], cut.sum[at], u);
  probability = static_cast<double>(cut.importance[at][slot]) / cut.total;
  float factor = receiver.learning ? cut.factor[at][slot] : 1.0f;
  for (;;) {
    const uint32_t child = nodes_[node].child[slot];
    if (child & kEmitter) return {child & ~kEmitter, nodes_[node].lobes.intensity[slot], 1};
    if (Trend trend; IsAlike(node, slot, receiver, trend)) {
      const Found found = FindByIntensity(child, trend, u);
      probability *= found.ofTrend * (static_cast<double>(found.intensity) / below_[child].intensity);
      return found;
    }
    node = child;
    View view;
    LookAt(node, receiver, factor, view);
    slot = Choose(view.importance, view.sum, u);
    probability *= static_cast<double>(view.importance[slot]) / view.sum;
    if (receiver.learning) factor = view.factor[slot];
  }
}

EmitterChoice LightTree::Select(const TreeReceiver& receiver, const Cut& cut, double u, bool defensive) const {
  EmitterChoice choice;
  choice.u = u;
  Found found;
  if (defensive) {
    found = FindByIntensity(0, Trend(), choice.u);
    choice.probability.byImportance = ImportanceProbability(receiver, cut, slots_[found.emitter]);
  } else {
    found = Descend(receiver, cut, choice.u, choice.probability.byImportance);
  }
  choice.probability.defensive = DefensiveProbability(found.intensity);
  choice.emitter = found.emitter;
  return choice;
}

namespace {

int IndexIn(const LightTree::Cut& cut, uint32_t node) {
  const uint32_t* at = std::find(cut.node, cut.node + cut.count, node);
  return at == cut.node + cut.count ? -1 : static_cast<int>(at - cut.node);
}

}  // namespace

// From the cut downwards, with the same products in the same order as the selection.
double LightTree::ImportanceProbability(const TreeReceiver& receiver, const Cut& cut, uint32_t slot) const {
  std::array<uint32_t, kLongestWay> way;
  size_t length = 0;
  int at;
  for (uint32_t above = slot;; above = parents_[above / kWidth]) {
    way[length++] = above;
    at = IndexIn(cut, above / kWidth);
    if (at >= 0) break;
  }
  const uint32_t first = way[--length] % kWidth;
  double probability = static_cast<double>(cut.importance[at][first]) / cut.total;
  float factor = receiver.learning ? cut.factor[at][first] : 1.0f;
  for (uint32_t above = way[length]; length > 0; above = way[length]) {
    const uint32_t below = way[--length], child = below / kWidth;
    if (Trend trend; IsAlike(above / kWidth, above % kWidth, receiver, trend)) {
      return probability *
             (trend.At(PositionOf(slot)) * (static_cast<double>(IntensityOf(slot)) / below_[child].intensity));
    }
    View view;
    LookAt(child, receiver, factor, view);
    probability *= static_cast<double>(view.importance[below % kWidth]) / view.sum;
    if (receiver.learning) factor = view.factor[below % kWidth];
  }
  return probability;
}

// Sum of the importances in the cut below this node.
double LightTree::SeenThrough(const Cut& cut, uint32_t node) const {
  double sum = 0;
  for (int i = 0; i < cut.count; ++i) {
    for (uint32_t above = cut.node[i];; above = parents_[above] / kWidth) {
      if (above == node) sum += cut.sum[i];
      if (above == node || parents_[above] == kNone) break;
    }
  }
  return sum / cut.total;
}

void LightTree::Record(LightLearning& learning, const TreeReceiver& receiver, const Cut& cut, uint32_t emitter,
                       double defensiveShare, double importance) const {
  const uint32_t own = slots_[emitter];
  const auto mix = [&](double seen, uint32_t slot) {
    return (1 - defensiveShare) * seen + defensiveShare * DefensiveProbability(IntensityOf(slot));
  };
  const double chosen = mix(ImportanceProbability(receiver, cut, own), own);
  for (uint32_t slot = own; slot != kNone; slot = parents_[slot / kWidth]) {
    const uint32_t node = slot / kWidth, child = nodes_[node].child[slot % kWidth];
    alignas(64) float unlearned[kWidth];
    Evaluate(nodes_[node].lobes, receiver).importance.copy_to(unlearned, simd::vector_aligned);
    const auto estimate = static_cast<double>(unlearned[slot % kWidth]);
    if (!(estimate > 0)) continue;
    double seen = 1;
    if (child & kEmitter) {
      seen = chosen;
    } else {
      const bool isOpened = IndexIn(cut, child) >= 0;
      seen = mix(isOpened ? SeenThrough(cut, child) : ImportanceProbability(receiver, cut, slot), slot);
    }
    // Estimate for the cluster: the sample over the probability of this emitter within it.
    learning.Record(receiver.region, node, static_cast<int>(slot % kWidth), importance * seen / chosen / estimate);
  }
}

EmitterProbability LightTree::ProbabilityOf(const TreeReceiver& receiver, const Cut& cut, uint32_t emitter) const {
  if (emitter >= slots_.size() || slots_[emitter] == kNone) return {0, 0};
  const uint32_t slot = slots_[emitter];
  return {ImportanceProbability(receiver, cut, slot), DefensiveProbability(IntensityOf(slot))};
}

size_t LightTree::Bytes() const {
  return nodes_.Size() * sizeof(Node) + below_.Size() * sizeof(Below) + places_.Size() * sizeof(Place) +
         (parents_.capacity() + slots_.capacity()) * sizeof(uint32_t);
}

}  // namespace lampyr
