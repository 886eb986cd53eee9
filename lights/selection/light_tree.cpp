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

// A cluster is opened when its importance times its doubt is more than this part of all: lights600 has 0.85 × the
// variance by it, rooms 0.5 ×, for a fifth more time.
constexpr float kNegligible = 1.0f / 32;
// Doubt for being near: of clusters that are seen under more than 60° or so, nothing is sure. And for normals that
// differ: the more, the less their mean says. Nothing is to be opened of an emitter.
constexpr float kDoubtOfSpread = 4, kDoubtOfUnevenness = 0.3f, kNoDoubt = -16;
// What choosing by intensity and trend within a cluster may add to the variance of its light, relative to the square of
// that. And the trend's largest change from the middle outwards, so that most trials of emitters are the last.
constexpr float kAlike = 0.004f, kSteepest = 0.75f;

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

// What was learned of the children of a node, whose own factor is `parentFactor`.
Lanes Learned(const TreeReceiver& receiver, uint32_t node, float parentFactor) {
  const LightLearning::Row& row = receiver.learning->RowOf(receiver.region, node);
  return simd::sqrt(Load(row.known) + parentFactor * parentFactor * (1 - Load(row.learned)));
}

}  // namespace

LightTree::LightTree(std::span<const ClusterBounds> emitters, int threads) {
  LightTreeBuilder(emitters, threads).BuildInto(*this);
}

// One compiled function: the same receiver gives the same bits, whoever asks.
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
    // Points have no normals, and yet do not differ by them: unevenness is more than the variety of the parts.
    Lanes doubt = kDoubtOfUnevenness * simd::min(here.unevenness, variety);
    where(variety < 0.0f, doubt) = kNoDoubt;
    doubtful[cut.count] = here.importance * simd::min(kDoubtOfSpread * here.spread + doubt, Lanes(1.0f));
    total += simd::reduce(here.importance);
    cut.node[cut.count++] = node;
  };
  open(0, 1);
  for (int i = 0; i < cut.count; ++i) {
    auto isToOpen = doubtful[i] > kNegligible * std::max(total, 0.0f);  // what is left after rounding
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
  // Nothing seems to contribute: by intensity.
  cut.count = 1;
  std::copy_n(nodes_[0].lobes.intensity, kWidth, cut.importance[0]);
  cut.total = cut.sum[0] = SumOf(cut.importance[0]);
}

double LightTree::Cut::Concentration() const {
  Lanes squares = 0;
  for (int i = 0; i < count; ++i) squares += Load(importance[i]) * Load(importance[i]);
  return total > 0 ? static_cast<double>(simd::reduce(squares)) / (total * total) : 1;
}

// One compiled function, too.
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
  // A cluster may look as if it contributed while none of its parts does.
  std::copy_n(nodes_[node].lobes.intensity, kWidth, view.importance);
  view.sum = SumOf(view.importance);
}

// One compiled function, too.
[[gnu::noinline]] double LightTree::Trend::At(const Point3& position) const {
  return static_cast<double>(base + glm::dot(gradient, position - middle));
}

// Whether the parts of a cluster send a receiver light in proportion to their intensities and a trend, but for a
// variance of kAlike. For a part at x from the middle, w from the receiver, with normals n there and m of the light,
// the cosines and 1/d² are (n·w')(m·w')/|w'|^k, w' = w + x: its gradient is taken, and its second order, of places that
// fill a cube evenly, is what is left. The cube is in the sphere that all are in, and not in that of the moments, in
// which a weak emitter that is near does not show. One compiled function, too.
[[gnu::noinline]] bool LightTree::IsAlike(uint32_t node, uint32_t child, const TreeReceiver& receiver,
                                          Trend& trend) const {
  using namespace importance;
  if (receiver.learning) return false;  // what is in the way of some is not in the way of others
  const float variety = FromBfloat16(nodes_[node].variety[child]);
  const ClusterLobe cluster = nodes_[node].lobes.Get(static_cast<int>(child));
  const Vector3 way = cluster.mean - receiver.position;
  const float inverse2 = 1 / std::max(glm::dot(way, way), kNearest2);
  const float away2 = cluster.radius * cluster.radius * inverse2;
  if (!(away2 < 0.1f && variety < kAlike)) return false;  // what follows would say the same of most, later
  // How much each factor changes over the radius, and the power of the distance.
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
  if (length2 > 0) {  // points shine alike to all sides
    float height = -glm::dot(cluster.meanNormal, way);
    trend.gradient -= cluster.meanNormal / height;
    if (cluster.twoSided) height = std::abs(height);
    if (!(height > cluster.radius * std::sqrt(length2))) return false;
    emitted = cluster.radius * std::sqrt(length2) / height;
    unevenness = variety / (height * height * inverse2);
    ++power;
  }
  constexpr float kFill = 0.11f;  // of two coordinates x, y in a cube, √ of the mean of x²y², over the radius² about it
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

// u in [0,1), stretched again, chooses among the emitters below a node by intensity. Of like ones, the first guess is
// right.
size_t LightTree::PlaceAt(const Below& below, double& u) const {
  const double x = below.before + u * below.intensity;
  size_t from = below.first, to = from + below.count;  // it is in [from, to)
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
  // x was rounded to the end, where there may be what has no intensity.
  while (from > below.first && !(IntensityAt(from) > 0)) --from;
  u = std::clamp((x - places_[from].before) / static_cast<double>(IntensityAt(from)), 0.0, 0x1.fffffffffffffp-1);
  return from;
}

// By intensity and trend: of those that intensity chooses, some are sent back. The next trial's place is asked for
// while this one's is waited for.
LightTree::Found LightTree::FindByIntensity(uint32_t node, const Trend& trend, double& u) const {
  constexpr uint64_t trials = 64;  // all in vain: at most once in 10^15
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
  while (!(cut.sum[at] > 0)) --at;  // x was rounded beyond the last that counts
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

// The slots from an emitter's up; the builder divides into halves from its 40th level on, and there are 2^31 emitters.
constexpr size_t kLongestWay = 128;

}  // namespace

// From the cut down, as an emitter is chosen: products of the same numbers in the same order.
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

// How often the cut leads to something below this node of it.
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
    // Of the cluster: the sample, over the probability of this emitter within it.
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
