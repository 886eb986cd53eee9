// The lights at infinity of a selector: selected by the irradiance that each causes at a receiver, which depends on the
// receiver's normal alone. It is tabulated by normal.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "lights/selection/light_selector.h"
#include "sampling/tables.h"

namespace lampyr {

class FarLights {
 public:
  // `far`: indices of the lights at infinity in `lights`, ascending.
  FarLights(std::span<const PlacedLight> lights, std::span<const uint32_t> far, const BoundingSphere& scene);

  bool IsEmpty() const { return lights_.empty(); }
  size_t Count() const { return lights_.size(); }
  uint32_t LightAt(size_t i) const { return lights_[i]; }
  // Index of a light among those at infinity; nullopt: it has a position.
  std::optional<uint32_t> IndexOf(uint32_t light) const;

  // A normal of the table and its opposite, as needed for a receiver.
  struct Place {
    static constexpr uint32_t kNone = 0xffffffffu;  // without a normal, or without a table
    uint32_t front = kNone, back = kNone;           // `back`: of transmissive receivers
  };
  Place PlaceOf(const Normal3& normal, bool isTransmissive) const;

  // Estimated irradiance by all of them together, W/m², mean of the channels; at a place with a normal without what
  // scattering finds.
  double Irradiance(const Place& place) const;
  // Estimated irradiance by all of them without regard to normals: for segments in media.
  double Irradiance() const { return irradiance_; }
  // Estimated irradiance over Irradiance(place), which leaves out what scattering finds.
  double Whole(const Place& place, uint32_t index) const {
    return place.front == Place::kNone ? 1 : 1 / std::max(parts_[index], 1e-3);
  }

  struct Choice {
    uint32_t index;
    PdfDiscrete probability;
    float u;  // the random number, rescaled to [0,1)
  };
  Choice Select(const Place& place, double u) const;  // requires !IsEmpty()
  PdfDiscrete Probability(const Place& place, uint32_t index) const;

 private:
  double WeightUpTo(const Place& place, size_t index) const;

  std::vector<uint32_t> lights_;
  AliasTable overall_;  // without regard to normals
  double irradiance_ = 0;
  // Table by normal: cumulated irradiances, starting with 0 for each normal. Empty if no table was made: there is no
  // irradiance, or there are too many lights.
  std::vector<double> sums_;
  std::vector<double> parts_;  // by light: factor of its irradiance in sums_
};

}  // namespace lampyr
