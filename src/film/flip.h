// LDR-FLIP: the difference that a person sees who flips between two images ([Andersson20]). Private to metrics.cpp and
// its test.
#pragma once

#include <vector>

#include "math/vec.h"

namespace lampyr {

struct FlipSettings {
  double pixelsPerDegree = 67;  // 0.7 m in front of a display of 3840 pixels and 0.7 m
};

// FLIP per pixel, in [0,1]. Both images are linear RGB with `width`·`height` pixels; they are clipped to [0,1] first,
// which is what a display without tone mapping shows. Symmetric in its images.
std::vector<float> FlipMap(const std::vector<Color>& a, const std::vector<Color>& b, int width, int height,
                           const FlipSettings& settings = {});

}  // namespace lampyr
