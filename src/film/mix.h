// Mixing the layers of a picture: what it would be with lights dimmed, tinted, or off, without a render.
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

// The picture with each of the layers times its factor. Light groups are added up, so that groups at 0 leave nothing;
// of other layers, and in denoised pictures, the picture gets the difference. Only layers that are valid for the mixed
// picture are kept, so that it can be mixed again: of light groups, all groups; of other layers, those that were named,
// if no group was, taken to have no light in common. Other layers, variances and bands of the spectrum stay only where
// all groups have one factor, bands only where that has no colour. Throws an Error for a layer that the image does not
// have, or that is named twice, and for values that would not be finite.
Image MixLayers(const Image& image, const std::vector<LayerFactor>& factors);

}  // namespace lampyr
