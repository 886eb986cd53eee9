// A tree over emitters that chooses one of them for a receiver, in proportion to an estimate of what it sends there
// ([Conty18 §4, §5]; the estimate: importance.h). Nodes have eight children, whose importances are evaluated together.
//
// A cluster so distant that its emitters differ only by intensity, and to first order by position, is not descended
// into: one of its emitters is sampled directly by these two.
//
// The probability of a given emitter is the product of the shares on its way from the root, O(depth): the same
// operations in the same order as in the selection, and therefore the same bits.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "base/large_array.h"
#include "lights/selection/importance.h"
#include "lights/selection/segment_importance.h"

namespace lampyr {

// Selection probabilities of an emitter by the two strategies.
struct EmitterProbability {
  double byImportance = 1;
  double defensive =
      1;  // by intensity, whatever the receiver: a light whose importance is estimated too low keeps a chance
};
struct EmitterChoice {
  uint32_t emitter = 0;
  EmitterProbability probability;
  double u = 0;  // the random number, rescaled to [0,1)
};

class LightTree {
 public:
  LightTree() = default;
  // Emitters with empty bounds are never selected. The tree does not depend on the number of threads that build it.
  LightTree(std::span<const ClusterBounds> emitters, int threads);

  static constexpr int kWidth = LobeBlock::kWidth;
  static constexpr uint32_t kNone = 0xffffffffu;

  // A cut through the tree for one receiver: clusters with a large and uncertain importance are replaced by their
  // children, so that their importance is the sum over these. Not initialised, because it is large.
  struct Cut {
    static constexpr int kRoom = 16;
    int count;  // nodes: the root, and nodes whose parents are in the cut, in any order
    uint32_t node[kRoom];
    double sum[kRoom];                            // of the importances of a node's children
    alignas(64) float importance[kRoom][kWidth];  // of the children; 0 for those that are in the cut
    alignas(64) float factor[kRoom][kWidth];      // learned factors of the children; set only with learning
    double total;
    double irradiance;  // estimate of the irradiance by all emitters: the total, or 0 if none has importance

    // Sum of the squared shares of the children: 1 if only one contributes, 1/n if n contribute equally.
    double Concentration() const;
  };
  void Look(const TreeReceiver& receiver, Cut& cut) const;

  // `u`: in [0,1). `defensive`: by intensity instead of importance. `cut`: by Look for this receiver. Requires
  // !IsEmpty().
  EmitterChoice Select(const TreeReceiver& receiver, const Cut& cut, double u, bool defensive) const;
  // 0 for emitters that are never selected.
  EmitterProbability ProbabilityOf(const TreeReceiver& receiver, const Cut& cut, uint32_t emitter) const;

  // A sample of `emitter`, chosen by defensive sampling with probability `defensiveShare`, brought the irradiance of
  // `importance`. Records it for each cluster that holds `emitter`, which can be chosen.
  void Record(LightLearning& learning, const TreeReceiver& receiver, const Cut& cut, uint32_t emitter,
              double defensiveShare, double importance) const;

  // The same for a segment of a ray: a cut by the importances of clusters (segment_importance.h) and by those that
  // `emitters` gives. Not initialised, because it is large.
  struct SegmentCut {
    static constexpr int kRoom = Cut::kRoom;
    int count;
    uint32_t node[kRoom];
    double sum[kRoom];                 // of the importances of a node's children
    double importance[kRoom][kWidth];  // of the children; 0 for those that are in the cut
    double total;
    double fluence;  // estimate of ∫ irradiance dt by all emitters: the total, or 0 if none has importance
  };
  void LookAlong(const TreeSegment& segment, const SegmentEmitters& emitters, SegmentCut& cut) const;
  // `cut`: by LookAlong for this segment. Requires !IsEmpty().
  EmitterChoice SelectAlong(const TreeSegment& segment, const SegmentEmitters& emitters, const SegmentCut& cut,
                            double u, bool defensive) const;
  EmitterProbability ProbabilityAlong(const TreeSegment& segment, const SegmentEmitters& emitters,
                                      const SegmentCut& cut, uint32_t emitter) const;

  bool IsEmpty() const { return nodes_.Size() == 0; }
  size_t Bytes() const;
  int Depth() const { return depth_; }

  struct Node {
    LobeBlock lobes;
    uint32_t child[kWidth];  // index of a node, or with the bit kEmitter of an emitter
    // Variance of the normals within a child cluster, as bfloat16 rounded up; kUnlike if its emission ends at a cone.
    // Negative: the child is an emitter.
    uint16_t variety[kWidth];
  };
  static constexpr float kUnlike = 1e6f;

 private:
  static constexpr uint32_t kEmitter = 0x80000000u;
  // Bound of the depth: the builder halves from level 40 on, and there are at most 2^31 emitters.
  static constexpr size_t kLongestWay = 128;

  // A cluster is replaced by its children if its importance times its uncertainty exceeds this fraction of the total:
  // 0.85 × the variance on lights600, 0.5 × on rooms, for a fifth more time.
  static constexpr float kNegligible = 1.0f / 32;
  // Uncertainty, from 0 to 1: by spread, 1 for clusters that subtend more than about 60°; and by the variance of
  // normals. Emitters have no children.
  static constexpr float kDoubtOfSpread = 4, kDoubtOfUnevenness = 0.3f, kNoDoubt = -16;

  friend class LightTreeBuilder;

  // Importances and factors of a node's children, for nodes below the cut.
  struct View {
    alignas(64) float importance[kWidth];
    alignas(64) float factor[kWidth];
    double sum;
  };
  void LookAt(uint32_t node, const TreeReceiver& receiver, float parentFactor, View& view) const;
  // Importances of a node's children for a segment, and the uncertainties of clusters among them, from 0 to 1.
  struct SegmentView {
    double importance[kWidth];
    double sum;
    alignas(64) float doubt[kWidth];
  };
  void EvaluateNode(uint32_t node, const TreeSegment& segment, SegmentView& view) const;
  // Replaces the importances of emitters by the estimates of their lights where they are more than a small part of
  // `total`.
  void AskEmitters(uint32_t node, const SegmentEmitters& emitters, double total, double* importance) const;
  // Evaluates the children of a node below the cut, emitters by the estimates of their lights; by intensity if no child
  // has importance.
  void LookBelow(uint32_t node, const TreeSegment& segment, const SegmentEmitters& emitters, SegmentView& view) const;
  double SeenThrough(const Cut& cut, uint32_t node) const;
  // First-order variation over a cluster: the contribution of an emitter relative to one of the same intensity at the
  // centre. Its mean, weighted by intensity, is 1.
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
    double ofTrend;  // value of the trend there
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

  // Emitters in the order of the tree, so that those below a node are contiguous. Intensity and position have the bits
  // of the emitter's slot.
  struct Place {
    double before;  // sum of the intensities of all places before this one
    uint32_t emitter;
    Point3 position;
  };
  struct Below {
    double before, intensity;  // sums: up to its first place, and of its places
    uint32_t first, count;     // places
    Vector3 offset;            // rounding error of the mean position in the node above
  };
  size_t PlaceAt(const Below& below, double& u) const;
  // The place, if all have the same intensity.
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
