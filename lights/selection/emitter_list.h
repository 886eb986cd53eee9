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

  struct Root {
    double sum = 0;
    double irradiance = 0;     // as LightTree::Root
    bool byIntensity = false;  // nothing seems to contribute
  };
  Root Look(const TreeReceiver& receiver) const;
  EmitterChoice Select(const TreeReceiver& receiver, const Root& root, double u, bool blindly) const;
  EmitterProbability ProbabilityOf(const TreeReceiver& receiver, const Root& root, uint32_t emitter) const;

  bool IsEmpty() const { return !(intensity_ > 0); }

 private:
  double WeightOf(const TreeReceiver& receiver, bool byIntensity, uint32_t emitter) const;

  std::vector<LobeBlock> blocks_;
  double intensity_ = 0;
};

}  // namespace lampyr
