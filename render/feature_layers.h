// Auxiliary features for the denoiser (denoise/denoise.h): albedo, normal and inverse distance of the first surface,
// also in perfect mirrors and through smooth glass. They depend neither on the integrator nor on which samples of the
// picture are rendered.
#pragma once

#include <atomic>
#include <string>
#include <vector>

#include "film/image.h"
#include "render/build/scene_builder.h"

namespace lampyr {

// The channels, and the same with feature.variance. in front:
//   feature.Albedo.R, .G, .B   reflectance and transmittance of the first surface that is no perfect mirror or smooth
//                              glass, times what those on the way reflect and transmit, in [0, 1]
//   feature.N.X, .Y, .Z        its shading normal, on the side that is seen
//   feature.inverseDistance.Z  1 / length of the way to it; 0 where there is none
const std::vector<std::string>& FeatureChannels();

// Name of the metadata of a picture that is to have these layers.
inline constexpr const char* kFeaturesMetadata = "lampyr.features";

// An image of FeatureChannels() over the crop: means over the rays of 16 samples of each pixel, up to 128 at edges, and
// the variances of these means. Without channels if `interrupted` was set, which is checked at each row.
Image FeatureLayers(const BuiltScene& built, int threads, const std::atomic<bool>& interrupted);

}  // namespace lampyr
