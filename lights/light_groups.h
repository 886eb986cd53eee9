// Light groups: lights with the same "lightGroup". Their contribution is written to a separate layer of the image.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace lampyr {

struct PlacedLight;

// Layer name of `name`: characters other than letters, digits, '-', '_' and non-ASCII ones become '_', because dots
// separate layers from channels and layer names occur in file names. Throws an Error if the name is reserved in images,
// or longer than channel names may be. `what` has the name: "a layer".
std::string LayerNameOf(const std::string& name, const std::string& what);
std::string LayerOfLightGroup(const std::string& group);

class LightGroups {
 public:
  // `hasGlowingMedia`: participating media emit light, too, which is in no group.
  // Throws an Error if two groups would share a layer, or if there are more than 65535.
  explicit LightGroups(const std::vector<PlacedLight>& lights, bool hasGlowingMedia = false);

  // Names of the layers in alphabetical order, followed by "rest" if some lights name no group, or media glow. Empty if
  // no light names a group.
  const std::vector<std::string>& Layers() const { return layers_; }
  // Group of lights[light] as an index into Layers(); 0 without groups.
  uint32_t Of(uint32_t light) const { return ofLight_.empty() ? 0 : ofLight_[light]; }

  // Group of light that participating media emit: the layer "rest".
  uint32_t OfMedia() const { return layers_.empty() ? 0 : static_cast<uint32_t>(layers_.size() - 1); }

  static constexpr size_t kMost = 65535;

 private:
  std::vector<std::string> layers_;
  std::vector<uint16_t> ofLight_;  // empty without groups
};

}  // namespace lampyr
