// Mixing the layers of a picture: the picture with lights dimmed, tinted or off, without another render.
#pragma once

#include <string>
#include <vector>

#include "film/image.h"

namespace lampyr {

struct LayerFactor {
  std::string layer;
  Color factor{1.0f};
};

// The parts of a list between separators; an empty text has one, which is empty.
std::vector<std::string> Split(const std::string& text, char separator);

// The names of the layers of an image that have R, G and B, without "variance".
std::vector<std::string> ColorLayers(const Image& image);
// The layers of light groups, which add up to the picture; empty if it has none.
std::vector<std::string> GroupLayers(const Image& image);

// The picture with each of the layers multiplied by its factor. Light groups are summed, so that groups at 0 contribute
// nothing; for other layers, and in denoised pictures, the change of the layer is added to the picture. Only layers
// that are valid for the mixed picture are kept, so that it can be mixed again: for light groups, all groups; for other
// layers, those that were named, if no group was, assumed to have no light in common. Other layers, variances and bands
// of the spectrum are kept only if all groups have one factor, bands only if that is gray. Throws an Error for a layer
// that the image does not have, or that is named twice, and for results that are not finite.
Image MixLayers(const Image& image, const std::vector<LayerFactor>& factors);

// The picture with all of its light multiplied by the factor, and the layers that are valid for it.
Image ScaleAllLight(const Image& image, const Color& factor);

}  // namespace lampyr
