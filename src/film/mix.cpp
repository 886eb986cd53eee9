#include "film/mix.h"

#include <algorithm>
#include <array>
#include <set>

#include "base/error.h"
#include "film/film.h"

namespace lampyr {

namespace {

constexpr std::array<const char*, 3> kChannels = {"R", "G", "B"};

float ChannelOf(const Color& color, size_t channel) {
  return std::array{color.r, color.g, color.b}[channel];
}

std::array<size_t, 3> ChannelsOfLayer(const Image& image, const std::string& layer) {
  std::array<size_t, 3> channels{};
  for (size_t c = 0; c < 3; ++c)
    channels[c] = static_cast<size_t>(image.ChannelIndex((layer.empty() ? "" : layer + ".") + kChannels[c]));
  return channels;
}

void Check(const Image& image, const std::vector<LayerFactor>& factors) {
  const std::vector<std::string> known = ColorLayers(image);
  if (known.empty()) throw Error("the picture has no layers: light groups or --layer make them");
  std::set<std::string> named;
  for (const LayerFactor& each : factors) {
    if (std::find(known.begin(), known.end(), each.layer) == known.end())
      throw Error("the picture has no layer \"" + each.layer + "\"" + DidYouMean(each.layer, known));
    if (!named.insert(each.layer).second) throw Error("the layer \"" + each.layer + "\" is named twice");
  }
}

Color FactorOf(const std::string& layer, const std::vector<LayerFactor>& factors) {
  for (const LayerFactor& each : factors) {
    if (each.layer == layer) return each.factor;
  }
  return Color(1.0f);
}

// Variances and bands of the spectrum of the picture, of which all light has one factor. The bands need one without
// colour.
void ScaleOthers(const Color& factor, Image& image) {
  for (size_t channel = 0; channel < image.channels.size(); ++channel) {
    if (!IsBandLayer(image.channels[channel])) continue;
    for (size_t i = channel; i < image.data.size(); i += image.channels.size()) image.data[i] *= factor.r;
  }
  for (size_t c = 0; c < 3; ++c) {
    const int channel = image.ChannelIndex(std::string("variance.") + kChannels[c]);
    if (channel < 0) continue;
    const float scale = ChannelOf(factor, c) * ChannelOf(factor, c);
    for (size_t i = static_cast<size_t>(channel); i < image.data.size(); i += image.channels.size())
      image.data[i] *= scale;
  }
}

bool IsGray(const Color& factor) {
  return factor.r == factor.g && factor.g == factor.b;
}

// Without what is known of the picture as a whole alone.
Image Without(const Image& image, bool variances, bool bands) {
  std::vector<std::string> kept;
  for (const std::string& channel : image.channels) {
    if (!(variances && channel.starts_with("variance.")) && !(bands && IsBandLayer(channel))) kept.push_back(channel);
  }
  Image result = ChannelsOf(image, kept);
  result.metadata = image.metadata;
  result.offsetX = image.offsetX;
  result.offsetY = image.offsetY;
  result.fullWidth = image.fullWidth;
  result.fullHeight = image.fullHeight;
  return result;
}

}  // namespace

std::vector<std::string> Split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  for (size_t begin = 0; begin <= text.size();) {
    const size_t end = std::min(text.find(separator, begin), text.size());
    parts.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return parts;
}

std::vector<std::string> ColorLayers(const Image& image) {
  std::vector<std::string> layers;
  for (const std::string& channel : image.channels) {
    if (!channel.ends_with(".R")) continue;
    const std::string layer = channel.substr(0, channel.size() - 2);
    constexpr std::array<const char*, 4> kOthers = {"variance", "half", "noisy", "Albedo"};
    if (std::find(kOthers.begin(), kOthers.end(), layer) != kOthers.end() || layer.find('.') != std::string::npos ||
        layer.starts_with("Crypto") || image.ChannelIndex(layer + ".G") < 0 || image.ChannelIndex(layer + ".B") < 0)
      continue;
    layers.push_back(layer);
  }
  return layers;
}

std::vector<std::string> GroupLayers(const Image& image) {
  const auto list = image.metadata.find("lampyr.lightGroups");
  if (list == image.metadata.end()) return {};
  const std::vector<std::string> all = ColorLayers(image);
  std::vector<std::string> groups = Split(list->second, ',');
  for (const std::string& group : groups) {
    if (std::find(all.begin(), all.end(), group) == all.end()) return {};
  }
  return groups;
}

Image MixLayers(const Image& image, const std::vector<LayerFactor>& factors) {
  Check(image, factors);
  // Of a denoised picture the groups are those of the noisy one: their sum is not the picture.
  const bool isDenoised = image.ChannelIndex("noisy.R") >= 0;
  const std::vector<std::string> groups = isDenoised ? std::vector<std::string>() : GroupLayers(image);
  Image mixed = image;
  const std::array<size_t, 3> picture = ChannelsOfLayer(image, "");
  const size_t pixels = image.data.size() / image.channels.size();
  const auto at = [&](Image& of, size_t pixel, size_t channel) -> float& {
    return of.data[pixel * of.channels.size() + channel];
  };
  const auto isGroup = [&](const std::string& layer) {
    return std::find(groups.begin(), groups.end(), layer) != groups.end();
  };
  const bool mixesGroups =
      std::any_of(factors.begin(), factors.end(), [&](const LayerFactor& each) { return isGroup(each.layer); });
  for (size_t pixel = 0; mixesGroups && pixel < pixels; ++pixel) {
    for (size_t c = 0; c < 3; ++c) at(mixed, pixel, picture[c]) = 0;
  }
  for (const std::string& group : mixesGroups ? groups : std::vector<std::string>()) {
    const Color factor = FactorOf(group, factors);
    const std::array<size_t, 3> layer = ChannelsOfLayer(image, group);
    for (size_t pixel = 0; pixel < pixels; ++pixel) {
      for (size_t c = 0; c < 3; ++c) {
        float& value = at(mixed, pixel, layer[c]);
        value *= ChannelOf(factor, c);
        at(mixed, pixel, picture[c]) += value;
      }
    }
  }
  bool isUniform = true;
  for (const LayerFactor& each : factors) {
    if (isGroup(each.layer)) continue;
    isUniform = false;
    const std::array<size_t, 3> layer = ChannelsOfLayer(image, each.layer);
    for (size_t pixel = 0; pixel < pixels; ++pixel) {
      for (size_t c = 0; c < 3; ++c)
        at(mixed, pixel, picture[c]) +=
            (ChannelOf(each.factor, c) - 1) * image.data[pixel * image.channels.size() + layer[c]];
    }
  }
  for (const std::string& group : groups)
    isUniform = isUniform && FactorOf(group, factors) == FactorOf(groups.front(), factors);
  if (!isUniform) return Without(mixed, true, true);
  if (!mixesGroups) return mixed;
  const Color factor = FactorOf(groups.front(), factors);
  ScaleOthers(factor, mixed);
  return IsGray(factor) ? mixed : Without(mixed, false, true);
}

}  // namespace lampyr
