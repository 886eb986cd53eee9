#include "app/desk/desk_mixing.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/parallel.h"

namespace lampyr {

namespace {

constexpr size_t kBlock = 4096;  // pixels mixed at once: their sums fit the cache

// Table of encoded values over x / (1 + x), which is fine for x near 0 and covers all x.
constexpr size_t kSteps = size_t{1} << 16;
using ScreenTable = std::array<uint8_t, kSteps>;

ScreenTable MakeScreenTable(ToneMap toneMap) {
  ScreenTable table{};
  for (size_t i = 0; i < kSteps; ++i) {
    const float t = static_cast<float>(i) / static_cast<float>(kSteps);
    table[i] = ToDisplay(t / (1 - t), 1, toneMap);
  }
  return table;
}

const ScreenTable& ScreenTableOf(ToneMap toneMap) {
  static const ScreenTable clip = MakeScreenTable(ToneMap::Clip), filmic = MakeScreenTable(ToneMap::Filmic);
  return toneMap == ToneMap::Clip ? clip : filmic;
}

float ChannelOf(const Color& color, size_t channel) {
  return channel == 0 ? color.r : channel == 1 ? color.g : color.b;
}

// Adds `factor` times each value.
void Accumulate(const float* __restrict values, double factor, size_t count, double* __restrict sums) {
  for (size_t i = 0; i < count; ++i) sums[i] += factor * static_cast<double>(values[i]);
}

// Steps of the table.
void Encode(const double* __restrict sums, float exposure, size_t count, uint32_t* __restrict steps) {
  constexpr float largest = 1e6f;
  for (size_t i = 0; i < count; ++i) {
    const float sum = static_cast<float>(sums[i]) * exposure;
    const float x = sum > 0 ? std::min(sum, largest) : 0.0f;  // 0 for NaN
    steps[i] = static_cast<uint32_t>(static_cast<int32_t>(x / (1 + x) * static_cast<float>(kSteps)));
  }
}

}  // namespace

LayerPlanes PlanesOf(const Image& image, const std::vector<std::string>& names, int threads) {
  LayerPlanes planes;
  planes.width = image.width;
  planes.height = image.height;
  planes.names = names;
  const size_t layers = std::max<size_t>(names.size(), 1), pixels = planes.Pixels(), stride = image.channels.size();
  std::vector<size_t> channels;
  for (size_t layer = 0; layer < layers; ++layer) {
    for (const char* channel : {"R", "G", "B"}) {
      const std::string name = names.empty() ? channel : names[layer] + "." + channel;
      channels.push_back(static_cast<size_t>(image.ChannelIndex(name)));
    }
  }
  for (const char* name : {"variance.R", "variance.G", "variance.B"})
    channels.push_back(static_cast<size_t>(image.ChannelIndex(name)));
  planes.values.resize(3 * layers * pixels);
  planes.variance.resize(3 * pixels);
  const size_t blocks = (pixels + kBlock - 1) / kBlock;
  ParallelFor(static_cast<int>(blocks), threads, [&](int block) {
    const size_t first = static_cast<size_t>(block) * kBlock, end = std::min(first + kBlock, pixels);
    for (size_t c = 0; c < channels.size(); ++c) {
      float* plane =
          c < 3 * layers ? planes.values.data() + c * pixels : planes.variance.data() + (c - 3 * layers) * pixels;
      const float* from = image.data.data() + channels[c];
      for (size_t i = first; i < end; ++i) plane[i] = from[i * stride];
    }
  });
  return planes;
}

std::string ScreenMixer::Mix(const LayerPlanes& planes, uint64_t picture, const std::vector<Color>& factors,
                             const ScreenLook& look, int threads) {
  constexpr int kMostChanges = 64;
  const std::lock_guard lock(mutex_);
  const size_t pixels = planes.Pixels();
  const bool isNew = picture != picture_ || sums_.size() != 3 * pixels || factors_.size() != factors.size() ||
                     changes_ >= kMostChanges;
  if (isNew) {
    sums_.assign(3 * pixels, 0);
    factors_.assign(factors.size(), Color(0.0f));
    picture_ = picture;
    changes_ = 0;
  }
  ++changes_;
  std::string screen(4 * pixels, '\xff');
  const ScreenTable& table = ScreenTableOf(look.toneMap);
  const float exposure = std::exp2(look.exposure);
  const size_t blocks = (pixels + kBlock - 1) / kBlock;
  ParallelFor(static_cast<int>(blocks), threads, [&](int block) {
    const size_t first = static_cast<size_t>(block) * kBlock, count = std::min(kBlock, pixels - first);
    std::array<uint32_t, kBlock> steps;
    for (size_t c = 0; c < 3; ++c) {
      double* sums = sums_.data() + c * pixels + first;
      for (size_t layer = 0; layer < factors.size(); ++layer) {
        const double change =
            static_cast<double>(ChannelOf(factors[layer], c)) - static_cast<double>(ChannelOf(factors_[layer], c));
        if (change != 0) Accumulate(planes.Plane(layer, c).data() + first, change, count, sums);
      }
      Encode(sums, exposure, count, steps.data());
      char* out = screen.data() + 4 * first + c;
      for (size_t i = 0; i < count; ++i) out[4 * i] = static_cast<char>(table[steps[i]]);
    }
  });
  factors_ = factors;
  return screen;
}

MixedPixel MixPixel(const LayerPlanes& planes, const std::vector<Color>& factors, int x, int y) {
  const size_t pixel = static_cast<size_t>(y) * static_cast<size_t>(planes.width) + static_cast<size_t>(x);
  MixedPixel mixed;
  mixed.hasDeviation = true;
  for (size_t layer = 0; layer < factors.size(); ++layer) {
    mixed.value += factors[layer] *
                   Color(planes.Plane(layer, 0)[pixel], planes.Plane(layer, 1)[pixel], planes.Plane(layer, 2)[pixel]);
    mixed.hasDeviation = mixed.hasDeviation && factors[layer] == factors.front();
  }
  if (!mixed.hasDeviation) return mixed;
  const auto deviation = [&](size_t channel) { return std::sqrt(planes.variance[channel * planes.Pixels() + pixel]); };
  mixed.deviation = factors.front() * Color(deviation(0), deviation(1), deviation(2));
  return mixed;
}

}  // namespace lampyr
