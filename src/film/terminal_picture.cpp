#include "film/terminal_picture.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace lampyr {

namespace {

// The mean of the pixels that each pixel of the smaller image covers.
Image Shrunk(const Image& image, int width, int height) {
  Image small(width, height, {"R", "G", "B"});
  for (int y = 0; y < height; ++y) {
    const int y0 = y * image.height / height, y1 = std::max((y + 1) * image.height / height, y0 + 1);
    for (int x = 0; x < width; ++x) {
      const int x0 = x * image.width / width, x1 = std::max((x + 1) * image.width / width, x0 + 1);
      Color sum;
      for (int v = y0; v < y1; ++v) {
        for (int u = x0; u < x1; ++u) sum += image.RgbAt(u, v);
      }
      const Color mean = sum / static_cast<float>((x1 - x0) * (y1 - y0));
      small.At(x, y, 0) = mean.r;
      small.At(x, y, 1) = mean.g;
      small.At(x, y, 2) = mean.b;
    }
  }
  return small;
}

std::string ColorCode(int kind, const unsigned char* rgb) {
  std::string code = "\033[" + std::to_string(kind) + ";2";
  for (int c = 0; c < 3; ++c) code += ";" + std::to_string(rgb[c]);
  return code + "m";
}

}  // namespace

std::string TerminalPicture(const Image& image, int columns, int lines, float exposureStops, ToneMap toneMap) {
  constexpr int kForeground = 38, kBackground = 48;
  const double scale =
      std::min({1.0, static_cast<double>(std::max(columns, 1)) / image.width, 2.0 * std::max(lines, 1) / image.height});
  const int width = std::max(static_cast<int>(image.width * scale), 1);
  const int height = std::max(static_cast<int>(std::lround(image.height * scale / 2)), 1) * 2;
  const std::vector<unsigned char> pixels = DisplayPixels(Shrunk(image, width, height), exposureStops, toneMap);
  std::string text;
  for (int y = 0; y < height; y += 2) {
    for (int x = 0; x < width; ++x) {
      const auto at = [&](int row) { return pixels.data() + 3 * (static_cast<size_t>(row) * width + x); };
      text += ColorCode(kForeground, at(y)) + ColorCode(kBackground, at(y + 1)) + "▀";
    }
    text += "\033[0m\n";
  }
  return text;
}

bool TerminalHasTrueColor() {
  const char* colors = std::getenv("COLORTERM");
  return colors && (std::string(colors) == "truecolor" || std::string(colors) == "24bit");
}

}  // namespace lampyr
