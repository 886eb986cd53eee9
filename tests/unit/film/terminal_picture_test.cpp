// Pictures as text: of the right size, with the colours of the PNG.
#include "film/terminal_picture.h"

#include <gtest/gtest.h>

namespace lampyr {
namespace {

Image Halves(int width, int height) {
  Image image(width, height, {"R", "G", "B"});
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) image.At(x, y, y < height / 2 ? 0 : 2) = 1;
  }
  return image;
}

TEST(TerminalPicture, HasTwoRowsOfPixelsInALine) {
  EXPECT_EQ(TerminalPicture(Halves(1, 2), 10, 10, 0, ToneMap::Clip), "\033[38;2;255;0;0m\033[48;2;0;0;255m▀\033[0m\n");
}

TEST(TerminalPicture, FitsAndKeepsItsProportions) {
  const std::string text = TerminalPicture(Halves(320, 180), 32, 20, 0, ToneMap::Clip);
  const auto count = [&](const std::string& part) {
    size_t all = 0;
    for (size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++all;
    return all;
  };
  EXPECT_EQ(count("\n"), 9u);
  EXPECT_EQ(count("▀"), 9u * 32);
  EXPECT_EQ(count("\033[38;2;255;0;0m"), count("\033[48;2;0;0;255m"));
}

}  // namespace
}  // namespace lampyr
