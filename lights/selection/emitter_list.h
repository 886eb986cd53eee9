// Every emitter's importance, one after the other: what the light tree comes near to, in O(n). The same questions as
// LightTree answers.
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
    bool byIntensity = false;  // nothing seems to contribute

    static double Concentration() { return 0; }  // unknown: as many samples as there may be
  };
  void Look(const TreeReceiver& receiver, Cut& cut) const;
  EmitterChoice Select(const TreeReceiver& receiver, const Cut& cut, double u, bool defensive) const;
  EmitterProbability ProbabilityOf(const TreeReceiver& receiver, const Cut& cut, uint32_t emitter) const;

  bool IsEmpty() const { return !(intensity_ > 0); }

 private:
  std::vector<LobeBlock> blocks_;
  double intensity_ = 0;
};

}  // namespace lampyr
