// What one sample says to each layer of the film: the parts that add up to the value of the sample.
#pragma once

#include <cstdint>
#include <vector>

#include "math/vec.h"

namespace lampyr {

// Kept by a thread from sample to sample; costs what the layers that a sample meets cost, however many there are.
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
  // Layers with a part in the sample, in the order in which they were met.
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
