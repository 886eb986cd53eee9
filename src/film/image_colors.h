// Colours of images whose primaries or white are not those of Rec. 709 (Image::chromaticities).
#pragma once

#include "film/image.h"
#include "spectral/color_space.h"

namespace lampyr {

// Treatment of colours outside of the gamut of Rec. 709. Keep: they have negative components, so the map is linear.
// Limit: ClampToGamut, as rendering needs it; negative components of the image itself count as 0.
enum class GamutHandling { Keep, Limit };

// R, G and B in Rec. 709, without chromaticities. Pixels that are not finite stay as they are. Images without
// chromaticities, with those of Rec. 709, or without R, G and B are returned as they are.
Image InRec709(Image image, WhiteHandling white, GamutHandling gamut);
// False if InRec709 would return the image as it is.
bool NeedsConversion(const Image& image, WhiteHandling white);

}  // namespace lampyr
