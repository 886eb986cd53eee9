// Light groups: lights that share a "lightGroup", whose light a render sums up in a layer of its own beside the
// picture.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace lampyr {

struct PlacedLight;

// The layer of a group: what is no letter, digit, '-', '_' or part of a character beyond ASCII becomes '_', because
// layers are told from channels by dots and are parts of file names elsewhere. Throws Error where the name is one that
// images have a use for, or longer than their channels' names may be.
std::string LayerOfLightGroup(const std::string& group);

class LightGroups {
 public:
  // Throws Error where two groups would share a layer, or where there are more than 65535 of them.
  explicit LightGroups(const std::vector<PlacedLight>& lights);

  // The name of each group's layer, in alphabetical order; then "rest", if there are lights that name no group. None
  // where no light names one.
  const std::vector<std::string>& Layers() const { return layers_; }
  // The group of lights[light], an index into Layers(); 0 where there are none.
  uint32_t Of(uint32_t light) const { return ofLight_.empty() ? 0 : ofLight_[light]; }

  static constexpr size_t kMost = 65535;

 private:
  std::vector<std::string> layers_;
  std::vector<uint16_t> ofLight_;  // empty while there are no groups
};

}  // namespace lampyr
