// Guiding of photon emission, learned from photons that reached what the camera sees, and part of every density.
//
// The guide is a mixture, per light, of components ("targets"): spheres around the first hits of such photons. A light
// with a position samples the cone that a sphere subtends; a light at infinity samples the disk that the sphere shows
// to the photon's direction. The description does not depend on the type of light or on where on it the photon starts,
// and the density of any photon can be evaluated. With probability kGuided the light is chosen by the contributions of
// its photons and the photon is aimed at a component; otherwise the unguided emission is sampled (defensive sampling),
// so that the weight of a photon is at most 1/(1 - kGuided) of its unguided weight.
//
// The weights of components minimise the variance of the sum over photons: each is proportional to the root of (the
// unguided probability of hitting the sphere · the second moment of the contribution of such photons).
//
// Share(l): probability that a photon of light l is aimed. The density of its photons is
// (1 - share) · unguided + share · aimed.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "lights/light.h"
#include "sampling/tables.h"

namespace lampyr {

class LightSelector;
struct PlacedLight;

// A photon that contributed to the image.
struct UsefulPhoton {
  uint32_t light = 0;
  Point3 firstHit{0.0f};
  double contribution = 0;     // to the image, over the density of the photon; any unit
  double secondMoment = 0;     // this photon's part of the mean square of contributions without a guide
  double unguidedDensity = 0;  // of this light's photons at the first hit, 1/m² perpendicular to the photon
};

class EmissionGuide {
 public:
  static constexpr double kGuided = 0.6;
  static constexpr int kMaxComponents = 64;  // of a light

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

  // For lights with a position: density of the unit `direction` from the point `from`, 1/sr.
  PdfSolidAngle DirectionDensity(uint32_t light, const Point3& from, const Vector3& direction) const;
  Vector3 SampleDirection(const Choice& choice, const Point3& from, const Point2& u) const;
  // Distance to the centre of the component, at least its radius: a typical length of the photon's first segment.
  float Reach(const Choice& choice, const Point3& from) const;
  // For lights at infinity: density of the line through `on` along the unit `direction` among parallel lines, 1/m²
  // perpendicular to them.
  PdfArea LineDensity(uint32_t light, const Point3& on, const Vector3& direction) const;
  // Samples a line; returns a point on it.
  Point3 SampleLine(const Choice& choice, const Vector3& direction, const Point2& u) const;

  // True if the aimed density of such a photon is positive.
  bool Aims(uint32_t light, const Point3& on, const Vector3& direction) const {
    return Share(light) > 0 && AimedDensity(light, on, direction) > 0;
  }
  // Density of such a photon over its density without a guide. `own`: that density, 1/sr for its direction or 1/m² for
  // its line, whichever is aimed.
  double Gain(uint32_t light, const Point3& on, const Vector3& direction, double own) const;

  int ComponentCount() const;
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
