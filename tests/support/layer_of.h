// A layer of a picture as an image of its own.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "film/image.h"

namespace lampyr::test {

// R, G and B of a layer, "" the picture itself.
inline Image LayerOf(const Image& image, const std::string& layer) {
  Image result(image.width, image.height, {"R", "G", "B"});
  for (size_t c = 0; c < 3; ++c) {
    const int index = image.ChannelIndex((layer.empty() ? "" : layer + ".") + result.channels[c]);
    if (index < 0) {
      ADD_FAILURE() << "no layer " << layer;
      return result;
    }
    for (int y = 0; y < image.height; ++y) {
      for (int x = 0; x < image.width; ++x) result.At(x, y, c) = image.At(x, y, static_cast<size_t>(index));
    }
  }
  return result;
}

}  // namespace lampyr::test
