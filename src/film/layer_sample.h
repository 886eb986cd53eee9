// The contributions of one sample to the layers of the film, which add up to the value of the sample.
#pragma once

#include <cstdint>
#include <vector>

#include "math/vec.h"

namespace lampyr {

// Reused by a thread from sample to sample. The cost is proportional to the layers with a contribution, not to all
// layers.
class LayerSample {
 public:
  explicit LayerSample(size_t layers) : parts_(layers) { met_.reserve(layers); }

  void Clear() {
    for (const uint32_t layer : met_) parts_[layer] = Part();
    met_.clear();
  }
  void Add(uint32_t layer, const Color& value) {
    Part& part = parts_[layer];
    if (!part.isMet) {
      part.isMet = true;
      met_.push_back(layer);
    }
    part.sum[0] += static_cast<double>(value.r);
    part.sum[1] += static_cast<double>(value.g);
    part.sum[2] += static_cast<double>(value.b);
  }
  // Layers with a contribution, in order of their first one.
  const std::vector<uint32_t>& Met() const { return met_; }
  double Sum(uint32_t layer, int channel) const { return parts_[layer].sum[channel]; }

 private:
  struct Part {
    double sum[3] = {0, 0, 0};
    bool isMet = false;
  };
  std::vector<Part> parts_;
  std::vector<uint32_t> met_;
};

}  // namespace lampyr
