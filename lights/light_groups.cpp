#include "lights/light_groups.h"

#include <algorithm>
#include <map>

#include "base/error.h"
#include "lights/placed_light.h"

namespace lampyr {

namespace {

constexpr const char* kRest = "rest";

bool IsPlain(unsigned char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '_' ||
         c >= 0x80;
}

}  // namespace

std::string LayerNameOf(const std::string& name, const std::string& what) {
  constexpr size_t most = 200;  // bytes; OpenEXR ends at 255
  std::string layer = name;
  for (char& c : layer) {
    if (!IsPlain(static_cast<unsigned char>(c))) c = '_';
  }
  if (layer == kRest) {
    throw Error(what + " cannot be called \"rest\": that is the layer of the lights that are in no light group");
  }
  const bool isMatte = layer.starts_with("CryptoObject") || layer.starts_with("CryptoMaterial");
  for (const char* taken : {"variance", "R", "G", "B", "A", "Albedo", "bias", "half", "noisy", "feature", "S0"}) {
    if (layer == taken || isMatte)
      throw Error(what + " cannot be called \"" + name + "\": images have a channel or layer of that name");
  }
  if (layer.size() > most) {
    throw Error("the name of " + what + " may have " + std::to_string(most) + " bytes; this one has " +
                std::to_string(layer.size()));
  }
  return layer;
}

std::string LayerOfLightGroup(const std::string& group) {
  return LayerNameOf(group, "a light group");
}

LightGroups::LightGroups(const std::vector<PlacedLight>& lights, bool hasGlowingMedia) {
  std::map<std::string, std::string> groups;  // by their layers
  bool hasRest = hasGlowingMedia;
  for (const PlacedLight& placed : lights) {
    const std::string& group = placed.light->Settings().lightGroup;
    if (group.empty()) {
      hasRest = true;
      continue;
    }
    const auto [same, isNew] = groups.emplace(LayerOfLightGroup(group), group);
    if (!isNew && same->second != group) {
      throw Error("the light groups \"" + same->second + "\" and \"" + group + "\" would both be the layer \"" +
                  same->first + "\": rename one");
    }
  }
  if (groups.empty()) return;
  for (const auto& [layer, group] : groups) layers_.push_back(layer);
  if (hasRest) layers_.emplace_back(kRest);
  if (layers_.size() > kMost) {
    throw Error("there are " + std::to_string(layers_.size()) + " light groups; " + std::to_string(kMost) +
                " are the most that can be told apart");
  }
  ofLight_.reserve(lights.size());
  for (const PlacedLight& placed : lights) {
    const std::string& group = placed.light->Settings().lightGroup;
    const std::string layer = group.empty() ? kRest : LayerOfLightGroup(group);
    const auto last = layers_.end() - (hasRest ? 1 : 0);
    const auto found = group.empty() ? last : std::lower_bound(layers_.begin(), last, layer);
    ofLight_.push_back(static_cast<uint16_t>(found - layers_.begin()));
  }
}

}  // namespace lampyr
