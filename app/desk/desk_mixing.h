// Mixing the layers of a picture for the screen: each multiplied by its factor, summed, exposed and tone-mapped. Planes
// of floats, so that twenty layers of a full picture take a few hundredths of a second.
#pragma once

#include <cstdint>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "film/image.h"
#include "math/vec.h"

namespace lampyr {

// The picture so far as layers that add up to it.
struct LayerPlanes {
  int width = 0, height = 0;
  std::vector<std::string> names;
  std::vector<float> values;    // by layer, channel (R, G, B) and pixel
  std::vector<float> variance;  // of the mean of a pixel, by channel and pixel; of all layers at 1

  size_t Pixels() const { return static_cast<size_t>(width) * static_cast<size_t>(height); }
  std::span<const float> Plane(size_t layer, size_t channel) const {
    return {values.data() + (3 * layer + channel) * Pixels(), Pixels()};
  }
};

// The planes of a developed picture (Film::Develop): of the layers `names`, or of the whole picture if there are none.
LayerPlanes PlanesOf(const Image& image, const std::vector<std::string>& names, int threads);

struct ScreenLook {
  float exposure = 0;  // stops
  ToneMap toneMap = ToneMap::Filmic;
};

// Mixes pictures for the screen. A fader that moves changes one layer: the sums are kept, and only layers whose factors
// have changed are read. Sums are doubles, and are computed anew from time to time, so that rounding errors of terms
// that were added and subtracted again are never visible. May be called from several threads.
class ScreenMixer {
 public:
  // Returns 8 bits of R, G, B and alpha, sRGB, by rows from the top. `factors`: of each layer. `picture`: a number that
  // identifies the planes.
  std::string Mix(const LayerPlanes& planes, uint64_t picture, const std::vector<Color>& factors,
                  const ScreenLook& look, int threads);

 private:
  std::mutex mutex_;
  std::vector<double> sums_;  // by channel and pixel
  std::vector<Color> factors_;
  uint64_t picture_ = 0;
  int changes_ = 0;  // since the sums were last computed anew
};

// One pixel, linear. `deviation`: of its mean; known only while all factors are equal.
struct MixedPixel {
  Color value{0.0f};
  Color deviation{0.0f};
  bool hasDeviation = false;
};
MixedPixel MixPixel(const LayerPlanes& planes, const std::vector<Color>& factors, int x, int y);

}  // namespace lampyr
