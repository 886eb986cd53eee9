// An image in a light's beam: base of "gobo" and "cookie". The image lies on a rectangle in a plane across the beam;
// seen along the beam, with +y up, its left is at −x and it is upright.
#pragma once

#include "lights/filters/beam_window.h"

namespace lampyr {

class BeamImage {
 public:
  // Reads filename, width, height, tile, fill, blur, tint and the position of the plane. Throws located Errors.
  BeamImage(const ParameterList& parameters, const FilterBuildContext& build, const char* mode);

  Color Factor(const FilterEdge& edge) const {
    const auto at = window_.Crossing(edge);
    return at ? Lookup(*at) : fill_;
  }

 private:
  Color Lookup(const Point2& place) const;
  const Color& Texel(int x, int y) const { return texels_[static_cast<size_t>(y) * width_ + x]; }
  void Blur(float sigma, bool alongX);

  BeamWindow window_;
  Vector2 texelsPerLength_{0.0f};
  Vector2 middle_{0.0f};        // in texels, from the outer corner of the first
  int width_ = 0, height_ = 0;  // in texels, with a margin for the blur beyond the rim
  bool tiles_ = false;
  Color fill_{0.0f};
  std::vector<Color> texels_;
};

// The type of a filter that is a BeamImage and nothing else.
FilterType BeamImageType(const char* name, const char* help, const char* mode);

}  // namespace lampyr
