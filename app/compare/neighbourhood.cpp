#include "app/compare/neighbourhood.h"

#include <algorithm>

#include "base/error.h"

namespace lampyr {

namespace {

constexpr int kReach = 3;  // pixels to each side

using Sums = std::array<double, 3>;  // R, G, B; in double, because squares exceed the range of floats

// The mean over the neighbours of every item of a line, those beyond its ends left out.
template <class At>
void SmoothLine(int length, const At& at) {
  std::vector<Sums> sums(static_cast<size_t>(length) + 1);
  for (size_t i = 0; i < static_cast<size_t>(length); ++i) {
    for (size_t c = 0; c < 3; ++c) sums[i + 1][c] = sums[i][c] + at(i)[c];
  }
  for (int i = 0; i < length; ++i) {
    const int begin = std::max(0, i - kReach), end = std::min(length, i + kReach + 1);
    for (size_t c = 0; c < 3; ++c) {
      const double sum = sums[static_cast<size_t>(end)][c] - sums[static_cast<size_t>(begin)][c];
      at(static_cast<size_t>(i))[c] = sum / (end - begin);
    }
  }
}

}  // namespace

std::vector<std::array<double, 3>> NeighbourhoodSquares(const Image& image) {
  std::vector<Sums> means;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const Color color = image.RgbAt(x, y);
      means.push_back({static_cast<double>(color.r), static_cast<double>(color.g), static_cast<double>(color.b)});
    }
  }
  const auto width = static_cast<size_t>(image.width);
  for (size_t y = 0; y < static_cast<size_t>(image.height); ++y)
    SmoothLine(image.width, [&](size_t x) -> Sums& { return means[y * width + x]; });
  for (size_t x = 0; x < width; ++x) SmoothLine(image.height, [&](size_t y) -> Sums& { return means[y * width + x]; });
  double squares = 0;
  for (Sums& mean : means) {
    for (double& value : mean) {
      value *= value;
      squares += value / (3 * static_cast<double>(means.size()));
    }
  }
  for (Sums& mean : means) {
    for (double& value : mean) value += 0.01 * squares;
  }
  return means;
}

double RelativeNoise(const Image& mean) {
  const std::vector<Sums> squares = NeighbourhoodSquares(mean);
  const size_t channels = mean.channels.size();
  const char* names[] = {"R", "G", "B"};
  bool hasVariance = true;
  for (const char* name : names) hasVariance &= mean.ChannelIndex(std::string("variance.") + name) >= 0;
  const std::string layer = hasVariance ? "variance." : "stderr.";
  double noise = 0;
  for (size_t c = 0; c < 3; ++c) {
    const int channel = mean.ChannelIndex(layer + names[c]);
    if (channel < 0) throw Error("the noise of a picture without variances or standard errors is not known");
    for (size_t i = 0; i < squares.size(); ++i) {
      const auto value = static_cast<double>(mean.data[i * channels + static_cast<size_t>(channel)]);
      if (squares[i][c] > 0) noise += (hasVariance ? value : value * value) / squares[i][c];
    }
  }
  return noise / (3 * static_cast<double>(squares.size()));
}

}  // namespace lampyr
