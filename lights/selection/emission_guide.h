// Where photons are worth sending: learned from those that reached what the camera sees, and part of every density.
//
// A guide is targets: spheres around the places where such photons landed first, with weights, light by light. A light
// with a place sends a photon into the cone that a target fills, a light at infinity through the disk that it shows to
// the photon's direction; so one description serves every kind, whatever the light is and wherever on it the photon
// starts, and its density can be asked for any photon. With probability kGuided the light is chosen by what its photons
// brought and the photon is aimed; otherwise it is what it would be without a guide, so that no place is lost and no
// photon carries more than 1/(1 - kGuided) of what it would have carried.
//
// Weights are those that make the sum of all photons least noisy: in proportion to the root of (how likely a photon
// comes to the target without a guide · the mean square of what those bring). A place that few photons leave for where
// they are of use, with much each, is worth more of them than what it brings on the whole.
//
// Among all photons of light l the part that is aimed is Share(l): their density is (1 - share) · own + share · aimed.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "lights/light.h"
#include "sampling/tables.h"

namespace lampyr {

class LightSelector;
struct PlacedLight;

// A photon that was of use.
struct UsefulPhoton {
  uint32_t light = 0;
  Point3 landing{0.0f};  // where it first met a surface
  double worth = 0;      // what the camera got by it, over its density; any unit
  double squared = 0;    // the mean square of that without a guide, as far as this one tells
  double own = 0;        // density of such a photon of this light without a guide, 1/m² across its way where it lands
};

class EmissionGuide {
 public:
  static constexpr double kGuided = 0.6;
  static constexpr int kMostTargets = 64;  // of a light

  // `unguided` chooses lights otherwise and must outlive the guide, like `lights`. Without useful photons the guide
  // never aims.
  EmissionGuide(std::span<const UsefulPhoton> photons, std::span<const PlacedLight> lights,
                const LightSelector& unguided, const BoundingSphere& scene);

  struct Choice {
    uint32_t light = 0;
    PdfDiscrete probability;  // of the light, aimed or not
    int target = kNone;       // kNone: the light emits as it would without a guide
    bool exists = false;
  };
  static constexpr int kNone = -1;
  // u in [0,1), of many bits.
  Choice Select(double u) const;
  PdfDiscrete Probability(uint32_t light) const;
  float Share(uint32_t light) const;

  // From a place of the light along a unit direction, in 1/sr; of lights with a place.
  PdfSolidAngle DirectionDensity(uint32_t light, const Point3& from, const Vector3& direction) const;
  Vector3 SampleDirection(const Choice& choice, const Point3& from, const Point2& u) const;
  // How far a target's middle is, at least its radius: a distance that the photon may well travel.
  float Reach(const Choice& choice, const Point3& from) const;
  // Of the line through `on` along the unit `direction` among all parallel ones, in 1/m² across them; of lights at
  // infinity.
  PdfArea LineDensity(uint32_t light, const Point3& on, const Vector3& direction) const;
  // A point on the line.
  Point3 SampleLine(const Choice& choice, const Vector3& direction, const Point2& u) const;

  // Whether photons like this one are aimed.
  bool Aims(uint32_t light, const Point3& on, const Vector3& direction) const {
    return Share(light) > 0 && AimedDensity(light, on, direction) > 0;
  }
  // Against photons without a guide: how much more often one like this is sent. `own`: its density then, 1/sr of its
  // direction or 1/m² of its line (whichever is aimed).
  double Gain(uint32_t light, const Point3& on, const Vector3& direction, double own) const;

  int TargetCount() const;
  size_t LightCount() const { return entries_.size(); }

 private:
  static constexpr int kWidth = 8;
  struct alignas(32) Block {
    float x[kWidth], y[kWidth], z[kWidth], radius[kWidth], weight[kWidth];
  };
  struct Entry {
    uint32_t light = 0;
    uint32_t firstBlock = 0, blocks = 0;
    int targets = 0;
    float share = 0;
  };
  struct Target {
    Point3 center{0.0f};
    float radius = 0;
  };

  float AimedDensity(uint32_t light, const Point3& on, const Vector3& direction) const;
  const Entry* EntryOf(uint32_t light) const;
  double LearnedProbability(uint32_t light) const;
  Target TargetOf(const Choice& choice) const;
  double AddTargets(std::span<UsefulPhoton> photons, float smallest, Entry& entry);

  std::span<const PlacedLight> lights_;
  const LightSelector& unguided_;
  AliasTable table_;               // over entries
  std::vector<Entry> entries_;     // in the order of lights
  std::vector<uint32_t> indices_;  // by light: 1 + its entry, or 0
  std::vector<Block> blocks_;
};

}  // namespace lampyr
