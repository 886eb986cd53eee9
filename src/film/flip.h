// LDR-FLIP: the difference visible when flipping between two images ([Andersson20]). Private to metrics.cpp and its
// test.
#pragma once

#include <vector>

#include "math/vec.h"

namespace lampyr {

struct FlipSettings {
  double pixelsPerDegree = 67;  // a display 3840 pixels and 0.7 m wide, seen from 0.7 m
};

// FLIP per pixel, in [0,1]. Both images are linear RGB with `width`·`height` pixels, and are first clipped to [0,1],
// which is what a display without tone mapping shows. Symmetric in the two images.
std::vector<float> FlipMap(const std::vector<Color>& a, const std::vector<Color>& b, int width, int height,
                           const FlipSettings& settings = {});

}  // namespace lampyr
