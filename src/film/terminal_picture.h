// Pictures as text, for terminals that show colours of 24 bits.
#pragma once

#include <string>
#include <vector>

#include "film/image.h"

namespace lampyr {

// 8-bit sRGB pixels for display, three bytes each: those of WritePng.
std::vector<unsigned char> DisplayPixels(const Image& image, float exposureStops, ToneMap toneMap);

// The picture in lines of half blocks, two rows of pixels in each, at most `columns` wide and `lines` high. Each line
// ends with a reset and a newline.
std::string TerminalPicture(const Image& image, int columns, int lines, float exposureStops, ToneMap toneMap);

// True if the environment declares that the terminal shows 24-bit colours (COLORTERM).
bool TerminalHasTrueColor();

}  // namespace lampyr
