// The plan of a render's layers: each holds the light of the paths that match an expression (path_expression.h). All
// expressions are compiled to one automaton before the first ray. A camera subpath carries its state, a light subpath
// or a photon that of the reverse automaton; the pair of both is looked up where they meet.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "film/path_expression.h"

namespace lampyr {

struct OutputLayer {
  std::string name;  // of the layer in the image
  PathExpression expression;
  std::string text;  // of the expression; "" if the layer is that of a light group
};

class OutputPlan {
 public:
  // No layers.
  OutputPlan() = default;
  // `lights`: by index. Throws an Error if the expressions need too many states.
  OutputPlan(std::vector<OutputLayer> layers, const std::vector<LightSourceName>& lights);

  const std::vector<OutputLayer>& Layers() const { return layers_; }
  std::vector<std::string> Names() const;

  // State of a camera subpath before its first event.
  static constexpr uint32_t kCamera = 0;
  // State of a light subpath before its first event.
  uint32_t OfLight(uint32_t light) const { return ofLight_[light]; }
  uint32_t OfMedia() const { return ofMedia_; }
  // State after an event.
  uint32_t AfterFromCamera(uint32_t state, PathEvent event) const {
    return fromCamera_[state][static_cast<size_t>(event)];
  }
  uint32_t AfterFromLight(uint32_t state, PathEvent event) const {
    return fromLight_[state][static_cast<size_t>(event)];
  }
  // The layers of a path whose subpaths have these states; the event at the joint vertex is in one of the two.
  std::span<const uint32_t> LayersOf(uint32_t camera, uint32_t light) const {
    const auto [first, end] = met_[static_cast<size_t>(camera) * fromLight_.size() + light];
    return {lists_.data() + first, lists_.data() + end};
  }

 private:
  using Next = std::array<uint32_t, kPathEvents>;
  class Compiler;

  std::vector<OutputLayer> layers_;
  std::vector<Next> fromCamera_, fromLight_;  // by state
  std::vector<uint32_t> ofLight_;
  uint32_t ofMedia_ = 0;
  std::vector<std::pair<uint32_t, uint32_t>> met_;  // ranges of lists_, by the states of both
  std::vector<uint32_t> lists_;
};

}  // namespace lampyr
