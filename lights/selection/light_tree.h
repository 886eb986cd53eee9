// A tree over emitters that chooses one of them for a receiver, in proportion to an estimate of what it sends there
// ([Conty18 §4, §5]; the estimate: importance.h). Nodes have eight children, whose importances are evaluated together.
//
// A cluster that is so far that its parts can only differ in their intensities, and a little by a trend over their
// places, is not looked into: an emitter is found by these among all of the cluster's at once.
//
// The probability of a given emitter is the product of its shares on the way from the root, which it knows the nodes
// of: O(depth), the same operations in the same order as when it was chosen, and so the same bits.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "base/large_array.h"
#include "lights/selection/importance.h"

namespace lampyr {

// Of a choice, or of a given emitter.
struct EmitterProbability {
  double byImportance = 1;
  double defensive =
      1;  // by intensity, whatever the receiver: a light whose importance is estimated too low keeps a chance
};
struct EmitterChoice {
  uint32_t emitter = 0;
  EmitterProbability probability;
  double u = 0;  // the random number, stretched over [0,1) again
};

class LightTree {
 public:
  LightTree() = default;
  // Emitters with empty bounds are never chosen. Builds on `threads`; the tree is the same for any number of them.
  LightTree(std::span<const ClusterBounds> emitters, int threads);

  static constexpr int kWidth = LobeBlock::kWidth;
  static constexpr uint32_t kNone = 0xffffffffu;

  // What every question about a receiver begins with: clusters that seem to send it much, and whose importance by
  // itself is doubtful, are opened, so that theirs is the sum of their parts'. Not initialised: it is large.
  struct Cut {
    static constexpr int kRoom = 16;
    int count;  // nodes: the root, and some whose parents are in the cut, in any order
    uint32_t node[kRoom];
    double sum[kRoom];                            // of a node's importances
    alignas(64) float importance[kRoom][kWidth];  // of the children; 0 of those that are in the cut themselves
    alignas(64) float factor[kRoom][kWidth];      // that was learned of the children; only where something is learned
    double total;
    double irradiance;  // an estimate of that from all emitters: the total, or 0 where none seems to contribute

    // The sum of the squares of the children's shares: 1 when a single one matters, 1/n when n matter alike.
    double Concentration() const;
  };
  void Look(const TreeReceiver& receiver, Cut& cut) const;

  // u in [0,1). `defensive`: by intensity instead of importance. `cut` is what Look gave for this receiver. Requires
  // !IsEmpty().
  EmitterChoice Select(const TreeReceiver& receiver, const Cut& cut, double u, bool defensive) const;
  // 0 for emitters that are never chosen.
  EmitterProbability ProbabilityOf(const TreeReceiver& receiver, const Cut& cut, uint32_t emitter) const;

  // A sample of `emitter`, chosen by defensive sampling with probability `defensiveShare`, brought the irradiance of
  // `importance`. Records it for each cluster that holds `emitter`, which can be chosen.
  void Record(LightLearning& learning, const TreeReceiver& receiver, const Cut& cut, uint32_t emitter,
              double defensiveShare, double importance) const;

  bool IsEmpty() const { return nodes_.Size() == 0; }
  size_t Bytes() const;
  int Depth() const { return depth_; }

  struct Node {
    LobeBlock lobes;
    uint32_t child[kWidth];  // a node, or an emitter: see kEmitter
    // The variance of the normals of a cluster's parts, kUnlike where their light ends at an edge: the upper half of a
    // float, or a little more. Below 0: an emitter.
    uint16_t variety[kWidth];
  };
  static constexpr float kUnlike = 1e6f;

 private:
  static constexpr uint32_t kEmitter = 0x80000000u;

  friend class LightTreeBuilder;

  // What is seen of a node's children, below the cut. The factors: as in the cut.
  struct View {
    alignas(64) float importance[kWidth];
    alignas(64) float factor[kWidth];
    double sum;
  };
  void LookAt(uint32_t node, const TreeReceiver& receiver, float parentFactor, View& view) const;
  double SeenThrough(const Cut& cut, uint32_t node) const;
  // What a part of a cluster sends beside one of the same intensity in its middle, to first order: of all parts by
  // intensity, the mean is 1.
  struct Trend {
    Vector3 gradient{0.0f};
    Point3 middle{0.0f};
    float base = 1;
    double most = 1;

    double At(const Point3& position) const;
  };
  bool IsAlike(uint32_t node, uint32_t child, const TreeReceiver& receiver, Trend& trend) const;
  struct Found {
    uint32_t emitter;
    float intensity;
    double ofTrend;  // what the trend says of it
  };
  Found Descend(const TreeReceiver& receiver, const Cut& cut, double& u, double& probability) const;
  Found FindByIntensity(uint32_t node, const Trend& trend, double& u) const;
  double ImportanceProbability(const TreeReceiver& receiver, const Cut& cut, uint32_t slot) const;
  float IntensityOf(uint32_t slot) const { return nodes_[slot / kWidth].lobes.intensity[slot % kWidth]; }
  Point3 PositionOf(uint32_t slot) const {
    const LobeBlock& lobes = nodes_[slot / kWidth].lobes;
    return {lobes.meanX[slot % kWidth], lobes.meanY[slot % kWidth], lobes.meanZ[slot % kWidth]};
  }
  double DefensiveProbability(float intensity) const { return static_cast<double>(intensity) / below_[0].intensity; }

  // Emitters in the order of the tree, so that those below a node are one after the other. Intensity and position are
  // those of the emitter's slot, to the bit.
  struct Place {
    double before;  // sum of the intensities of all places before this one
    uint32_t emitter;
    Point3 position;
  };
  struct Below {
    double before, intensity;  // sums: up to its first place, and of its places
    uint32_t first, count;     // places
    Vector3 offset;  // what rounding left between the places' mean by intensity and what the node above has for it
  };
  size_t PlaceAt(const Below& below, double& u) const;
  // Where it is when all have the same intensity.
  static size_t GuessAt(const Below& below, double u) {
    return below.first + std::min(static_cast<size_t>(u * below.count), static_cast<size_t>(below.count) - 1);
  }
  float IntensityAt(size_t place) const {
    return static_cast<float>(places_[place + 1].before - places_[place].before);
  }

  // A slot is node · kWidth + child.
  LargeArray<Node> nodes_;         // the root first
  LargeArray<Below> below_;        // of each node
  LargeArray<Place> places_;       // and one more at the end
  std::vector<uint32_t> parents_;  // of each node: its slot in the node above
  std::vector<uint32_t> slots_;    // of each emitter
  int depth_ = 0;                  // nodes from the root to an emitter, at most
};

}  // namespace lampyr
