// Common parts of lights whose intensity over directions is an image: sampling weights of texels, and a coarse copy for
// quadrature.
#pragma once

#include <vector>

#include "lights/emission_image.h"

namespace lampyr {

// Raises positive weights to at least 1e-6 of the mean, so that the density of a dim texel beside one of 1e9 is within
// the range of float.
inline void LiftDimWeights(std::vector<float>& weights) {
  double sum = 0;
  for (const float weight : weights) sum += static_cast<double>(weight);
  const auto least = static_cast<float>(1e-6 * sum / static_cast<double>(weights.size()));
  for (float& weight : weights) weight = weight > 0 ? std::max(weight, least) : 0.0f;
}

// An image resampled to about 64 × 64 parts: texels of small images are subdivided, those of large images averaged.
class ImageParts {
 public:
  ImageParts() = default;
  explicit ImageParts(const EmissionImage& image);

  struct Part {
    Point2d low{0.0}, high{0.0};  // in [0,1]², v counts down from the image's top
    Color mean;
    Point2 Middle() const { return Point2(0.5 * (low + high)); }
  };
  const std::vector<Part>& Parts() const { return parts_; }

 private:
  std::vector<Part> parts_;
};

}  // namespace lampyr
