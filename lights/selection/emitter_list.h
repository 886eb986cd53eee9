// Selection among emitters by the importance of each one, in O(n): the reference that the light tree approximates. Same
// interface as LightTree.
#pragma once

#include <span>
#include <vector>

#include "lights/selection/light_tree.h"

namespace lampyr {

class EmitterList {
 public:
  EmitterList(std::span<const ClusterBounds> emitters, int threads);

  struct Cut {
    double sum = 0;
    double irradiance = 0;     // as LightTree::Cut
    bool byIntensity = false;  // no emitter has importance

    static double Concentration() { return 0; }  // unknown: the largest number of samples is taken
  };
  void Look(const TreeReceiver& receiver, Cut& cut) const;
  EmitterChoice Select(const TreeReceiver& receiver, const Cut& cut, double u, bool defensive) const;
  EmitterProbability ProbabilityOf(const TreeReceiver& receiver, const Cut& cut, uint32_t emitter) const;

  // For a segment, as LightTree.
  struct SegmentCut {
    double sum = 0;
    double fluence = 0;
    bool byIntensity = false;
  };
  void LookAlong(const TreeSegment& segment, const SegmentEmitters& emitters, SegmentCut& cut) const;
  EmitterChoice SelectAlong(const TreeSegment& segment, const SegmentEmitters& emitters, const SegmentCut& cut,
                            double u, bool defensive) const;
  EmitterProbability ProbabilityAlong(const TreeSegment& segment, const SegmentEmitters& emitters,
                                      const SegmentCut& cut, uint32_t emitter) const;

  bool IsEmpty() const { return !(intensity_ > 0); }

 private:
  double WeightAlong(const TreeSegment& segment, const SegmentEmitters& emitters, uint32_t emitter,
                     bool byIntensity) const;

  std::vector<LobeBlock> blocks_;
  double intensity_ = 0;
};

}  // namespace lampyr
