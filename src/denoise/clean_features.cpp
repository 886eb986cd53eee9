#include "denoise/clean_features.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "base/parallel.h"
#include "denoise/denoise.h"

namespace lampyr {

namespace {

constexpr int kWindow = 4, kPatch = 1, kTile = 32;

// Channels that belong together, such as Albedo.R, .G, .B, and are filtered with the same weights.
struct FeatureGroup {
  std::string name;
  std::vector<size_t> channels;  // of the image
  std::vector<int> variances;    // of the image; negative: none
};

std::string NameWithoutChannel(const std::string& name) {
  return name.substr(0, name.rfind('.'));
}

void AddChannel(std::vector<FeatureGroup>& groups, const std::string& group, size_t channel, int variance) {
  if (groups.empty() || groups.back().name != group || groups.back().channels.size() == 3)
    groups.push_back({group, {}, {}});
  groups.back().channels.push_back(channel);
  groups.back().variances.push_back(variance);
}

std::vector<FeatureGroup> FindGroups(const Image& image) {
  std::vector<FeatureGroup> groups;
  size_t count = 0;
  for (size_t c = 0; c < image.channels.size() && count < kMostFeatures; ++c) {
    const std::string& name = image.channels[c];
    if (!name.starts_with(kFeaturePrefix) || name.starts_with(kFeatureVariancePrefix)) continue;
    const std::string feature = name.substr(std::string(kFeaturePrefix).size());
    AddChannel(groups, NameWithoutChannel(feature), c, image.ChannelIndex(kFeatureVariancePrefix + feature));
    ++count;
  }
  if (!groups.empty()) return groups;
  for (const char* name : {"Albedo.R", "Albedo.G", "Albedo.B", "Ns.X", "Ns.Y", "Ns.Z"}) {
    const int channel = image.ChannelIndex(name);
    if (channel >= 0) AddChannel(groups, NameWithoutChannel(name), static_cast<size_t>(channel), -1);
  }
  return groups;
}

float FiniteOr0(float value) {
  constexpr float largest = 1e18f;
  return std::abs(value) < largest ? value : 0;
}

// The channels of a group. Their own spread determines which differences are negligible.
Guide ReadGroup(const Image& image, const FeatureGroup& group) {
  Guide guide;
  double spread = 0;
  for (size_t k = 0; k < group.channels.size(); ++k) {
    Plane value(image.width, image.height), variance(image.width, image.height);
    double sum = 0, squares = 0;
    for (size_t i = 0; i < value.Size(); ++i) {
      const float* pixel = image.data.data() + i * image.channels.size();
      value.values[i] = FiniteOr0(pixel[group.channels[k]]);
      if (group.variances[k] >= 0) variance.values[i] = std::max(FiniteOr0(pixel[group.variances[k]]), 0.0f);
      sum += static_cast<double>(value.values[i]);
      squares += static_cast<double>(value.values[i]) * static_cast<double>(value.values[i]);
    }
    const double mean = sum / static_cast<double>(value.Size());
    spread = std::max(spread, squares / static_cast<double>(value.Size()) - mean * mean);
    guide.values.push_back(std::move(value));
    // The variance of few samples is itself noisy.
    guide.variances.push_back(BoxMeans(variance, 1, 1));
  }
  guide.smallestVariance = static_cast<float>(std::max(1e-5 * spread, 1e-12));
  return guide;
}

void FilterTile(const Guide& guide, const Tile& tile, std::vector<CleanFeature>& clean) {
  PatchDistances distances(kWindow, kPatch);
  distances.Compute(guide, tile);
  for (int pixel = 0; pixel < tile.Pixels(); ++pixel) {
    const int x = tile.x0 + pixel % tile.Width(), y = tile.y0 + pixel / tile.Width();
    float values[3] = {0, 0, 0}, variances[3] = {0, 0, 0}, weights = 0;
    for (int offset = 0; offset < distances.Offsets(); ++offset) {
      const float weight = WeightOf(distances.At(offset)[pixel]);
      if (weight == 0) continue;
      weights += weight;
      const int fromX = x + offset % (2 * kWindow + 1) - kWindow, fromY = y + offset / (2 * kWindow + 1) - kWindow;
      for (size_t k = 0; k < clean.size(); ++k) {
        values[k] += weight * guide.values[k].At(fromX, fromY);
        variances[k] += weight * weight * guide.variances[k].At(fromX, fromY);
      }
    }
    for (size_t k = 0; k < clean.size(); ++k) {
      clean[k].value.At(x, y) = weights > 0 ? values[k] / weights : guide.values[k].At(x, y);
      clean[k].variance.At(x, y) = weights > 0 ? variances[k] / (weights * weights) : guide.variances[k].At(x, y);
    }
  }
}

std::vector<CleanFeature> FilterGroup(const Guide& guide, int threads, const std::atomic<bool>& interrupted) {
  const int width = guide.values[0].width, height = guide.values[0].height;
  std::vector<CleanFeature> clean;
  for (size_t k = 0; k < guide.values.size(); ++k) clean.push_back({guide.values[k], guide.variances[k]});
  const bool hasNoise = std::any_of(guide.variances.begin(), guide.variances.end(), [](const Plane& plane) {
    return std::any_of(plane.values.begin(), plane.values.end(), [](float v) { return v > 0; });
  });
  if (!hasNoise) return clean;
  const int columns = (width + kTile - 1) / kTile, rows = (height + kTile - 1) / kTile;
  ParallelFor(columns * rows, threads, [&](int index) {
    if (interrupted.load()) return;
    const int x = index % columns * kTile, y = index / columns * kTile;
    FilterTile(guide, {x, y, std::min(x + kTile, width), std::min(y + kTile, height)}, clean);
  });
  return clean;
}

}  // namespace

std::vector<CleanFeature> CleanFeatures(const Image& image, int threads, const std::atomic<bool>& interrupted) {
  std::vector<CleanFeature> features;
  for (const FeatureGroup& group : FindGroups(image)) {
    for (CleanFeature& feature : FilterGroup(ReadGroup(image, group), threads, interrupted))
      features.push_back(std::move(feature));
  }
  return features;
}

}  // namespace lampyr
