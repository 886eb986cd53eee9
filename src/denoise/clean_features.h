// Features of a picture with their own noise removed, so that the regression does not copy it ([Bitterli16 §4.3]).
#pragma once

#include <atomic>
#include <vector>

#include "denoise/window_regression.h"
#include "film/image.h"

namespace lampyr {

// The features of the picture, filtered by non-local means with their variances; for pictures without features, the
// layers Albedo and Ns of Film "gbuffer", taken as free of noise. Empty if there are none. Values that are not finite
// become 0.
std::vector<CleanFeature> CleanFeatures(const Image& image, int threads, const std::atomic<bool>& interrupted);

}  // namespace lampyr
