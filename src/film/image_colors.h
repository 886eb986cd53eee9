// Colours of images whose primaries or white are not those of Rec. 709 (Image::chromaticities).
#pragma once

#include "film/image.h"
#include "spectral/color_space.h"

namespace lampyr {

// What becomes of colours outside of the gamut. Limit: negative components become 0 and the others are scaled to the
// same luminance, as a renderer needs them; negative components of the image count as 0. Keep: components stay
// negative.
enum class GamutHandling { Keep, Limit };

// R, G and B in Rec. 709, without chromaticities. Pixels that are not finite stay as they are. Images without
// chromaticities, with those of Rec. 709, or without R, G and B are returned as they are.
Image InRec709(Image image, WhiteHandling white, GamutHandling gamut);
// False if InRec709 would return the image as it is.
bool NeedsConversion(const Image& image, WhiteHandling white);

}  // namespace lampyr
