#include "film/mix.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <set>

#include "base/error.h"
#include "film/film.h"

namespace lampyr {

namespace {

constexpr const char* kGroupsMetadata = "lampyr.lightGroups";
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

// "" is the picture.
bool HasLayer(const Image& image, const std::string& layer) {
  return std::all_of(kChannels.begin(), kChannels.end(), [&](const char* channel) {
    return image.ChannelIndex((layer.empty() ? "" : layer + ".") + channel) >= 0;
  });
}

void Check(const Image& image, const std::vector<LayerFactor>& factors) {
  const std::vector<std::string> known = ColorLayers(image);
  if (known.empty()) throw Error("the picture has no layers: light groups or --layer make them");
  if (!HasLayer(image, ""))
    throw Error("the picture has layers, but not the channels R, G and B that they are parts of");
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

// Multiplies a layer; "" is the picture.
void Scale(const Color& factor, const std::string& layer, Image& image) {
  const std::array<size_t, 3> channels = ChannelsOfLayer(image, layer);
  for (size_t i = 0; i < image.data.size(); i += image.channels.size()) {
    for (size_t c = 0; c < 3; ++c) image.data[i + channels[c]] *= ChannelOf(factor, c);
  }
}

// Scales variances, bands of the spectrum and layers besides the groups, valid if all light has one factor. The bands
// require a gray factor.
void ScaleOthers(const Color& factor, const std::vector<std::string>& groups, Image& image) {
  for (size_t channel = 0; channel < image.channels.size(); ++channel) {
    if (!IsBandLayer(image.channels[channel])) continue;
    for (size_t i = channel; i < image.data.size(); i += image.channels.size()) image.data[i] *= factor.r;
  }
  if (HasLayer(image, "variance")) Scale(factor * factor, "variance", image);
  for (const std::string& layer : ColorLayers(image)) {
    if (std::find(groups.begin(), groups.end(), layer) == groups.end()) Scale(factor, layer, image);
  }
}

bool IsGray(const Color& factor) {
  return factor.r == factor.g && factor.g == factor.b;
}

// The image reduced to the channels for which `isKept` is true.
Image Kept(const Image& image, const std::function<bool(const std::string&)>& isKept) {
  std::vector<std::string> kept;
  for (const std::string& channel : image.channels) {
    if (isKept(channel)) kept.push_back(channel);
  }
  Image result = ChannelsOf(image, kept);
  result.metadata = image.metadata;
  return result;
}

// True for channels that are valid for the unmixed light alone: halves of the samples, the picture before denoising,
// strategies and errors.
bool IsOfParts(const std::string& channel) {
  for (const char* layer : {"half.", "noisy.", "bias."})
    if (channel.starts_with(layer)) return true;
  // A light group may be called "weighted", but strategies have another dot: "weighted.s2-t3.R".
  for (const char* strategies : {"weighted.", "unweighted."})
    if (channel.starts_with(strategies) && channel.find('.') != channel.rfind('.')) return true;
  return channel == "relativeError" || channel == kSplatShareChannel;
}

// Drops the channels that are unknown after a change of single layers, and all layers besides `known`.
Image WithoutUnknown(const Image& image, const std::vector<std::string>& known) {
  const std::vector<std::string> layers = ColorLayers(image);
  const auto isIn = [](const std::vector<std::string>& names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  return Kept(image, [&](const std::string& channel) {
    if (IsBandLayer(channel) || channel.starts_with("variance.") || IsOfParts(channel)) return false;
    const std::string layer = channel.substr(0, channel.rfind('.'));
    return layer == channel || !isIn(layers, layer) || isIn(known, layer);
  });
}

void CheckIsFinite(const Image& image, const Image& mixed) {
  for (size_t i = 0; i < image.data.size(); ++i) {
    if (std::isfinite(image.data[i]) && !std::isfinite(mixed.data[i]))
      throw Error("the factors are too large: values of the picture would not be finite");
  }
}

// All light groups, added up.
void AddUp(const std::vector<std::string>& groups, const std::vector<LayerFactor>& factors, Image& mixed) {
  const std::array<size_t, 3> picture = ChannelsOfLayer(mixed, "");
  for (size_t i = 0; i < mixed.data.size(); i += mixed.channels.size()) {
    for (const size_t channel : picture) mixed.data[i + channel] = 0;
  }
  for (const std::string& group : groups) {
    Scale(FactorOf(group, factors), group, mixed);
    const std::array<size_t, 3> layer = ChannelsOfLayer(mixed, group);
    for (size_t i = 0; i < mixed.data.size(); i += mixed.channels.size()) {
      for (size_t c = 0; c < 3; ++c) mixed.data[i + picture[c]] += mixed.data[i + layer[c]];
    }
  }
}

// `mixed`, with what its picture and groups do not hold scaled, too, where all light of `image` has the factor. Throws
// an Error if the result is not finite.
Image WithOthersScaled(const Image& image, const Color& factor, const std::vector<std::string>& groups, Image& mixed) {
  ScaleOthers(factor, groups, mixed);
  CheckIsFinite(image, mixed);
  return Kept(mixed, [&](const std::string& channel) {
    return !IsOfParts(channel) && (IsGray(factor) || !IsBandLayer(channel));
  });
}

// Adds the change of a layer to the picture.
void AddDifference(const LayerFactor& each, Image& mixed) {
  const std::array<size_t, 3> picture = ChannelsOfLayer(mixed, ""), layer = ChannelsOfLayer(mixed, each.layer);
  for (size_t i = 0; i < mixed.data.size(); i += mixed.channels.size()) {
    for (size_t c = 0; c < 3; ++c)
      mixed.data[i + picture[c]] += (ChannelOf(each.factor, c) - 1) * mixed.data[i + layer[c]];
  }
  Scale(each.factor, each.layer, mixed);
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
    constexpr std::array<const char*, 5> kOthers = {"variance", "half", "noisy", "Albedo", "bias"};
    if (std::find(kOthers.begin(), kOthers.end(), layer) != kOthers.end() || layer.find('.') != std::string::npos ||
        layer.starts_with("CryptoObject") || layer.starts_with("CryptoMaterial") ||
        image.ChannelIndex(layer + ".G") < 0 || image.ChannelIndex(layer + ".B") < 0)
      continue;
    layers.push_back(layer);
  }
  return layers;
}

std::vector<std::string> GroupLayers(const Image& image) {
  const auto list = image.metadata.find(kGroupsMetadata);
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
  // In a denoised picture the groups are those of the noisy one, so that their sum is not the picture.
  const bool isDenoised = image.ChannelIndex("noisy.R") >= 0;
  const std::vector<std::string> groups = isDenoised ? std::vector<std::string>() : GroupLayers(image);
  const auto isGroup = [&](const std::string& layer) {
    return std::find(groups.begin(), groups.end(), layer) != groups.end();
  };
  Image mixed = image;
  std::vector<std::string> named;
  bool mixesGroups = false, mixesOthers = false;
  for (const LayerFactor& each : factors) {
    named.push_back(each.layer);
    if (isGroup(each.layer)) {
      mixesGroups = true;
    } else if (each.factor != Color(1.0f)) {
      mixesOthers = true;
    }
  }
  if (mixesGroups) AddUp(groups, factors, mixed);
  for (const LayerFactor& each : factors) {
    if (!isGroup(each.layer)) AddDifference(each, mixed);
  }
  CheckIsFinite(image, mixed);
  if (mixesOthers) {
    // Groups and other layers may contain some of the light that has changed.
    mixed = WithoutUnknown(mixed, mixesGroups ? std::vector<std::string>() : named);
    mixed.metadata.erase(kGroupsMetadata);
    return mixed;
  }
  if (!mixesGroups) return mixed;
  const Color factor = FactorOf(groups.front(), factors);
  const bool isUniform = std::all_of(groups.begin(), groups.end(),
                                     [&](const std::string& group) { return FactorOf(group, factors) == factor; });
  if (!isUniform) return WithoutUnknown(mixed, groups);
  return factor == Color(1.0f) ? mixed : WithOthersScaled(image, factor, groups, mixed);
}

Image ScaleAllLight(const Image& image, const Color& factor) {
  Image scaled = image;
  Scale(factor, "", scaled);
  return WithOthersScaled(image, factor, {}, scaled);
}

}  // namespace lampyr
