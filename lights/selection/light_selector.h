// Light selection, for next-event estimation at a receiver and for emission.
//
// The selection probability is not part of a light's own densities. When another technique finds the same light, it is
// evaluated again for the same receiver, and must then have the same bits.
#pragma once

#include <algorithm>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "lights/placed_light.h"
#include "lights/selection/ray_segment.h"

namespace lampyr {

// The point that is lit. Part of a path vertex.
//
// A normal of 0: the receiver is in a medium, is a lens, or is on a strand, which turns. Light then counts from all
// directions alike, without a cosine, and isTransmissive has no effect.
struct Receiver {
  Point3 position{0.0f};
  Normal3 normal{0.0f};         // shading normal, on the side of the path's previous vertex; or 0
  bool isTransmissive = false;  // light from the other side contributes, too
  uint32_t link = 0;            // class of light linking and light filters (services/linking.h)

  // `link` of the camera: lights that it sees are neither linked nor filtered.
  static constexpr uint32_t kCamera = 0xffffffffu;

  // A point in a medium. `link`: class of the medium; 0 is lit by all lights.
  static Receiver InMedium(const Point3& position, uint32_t link = 0) { return {position, Normal3(0.0f), false, link}; }
  bool HasNormal() const { return LengthSquared(normal) > 0; }
};

struct SelectedLight {
  uint32_t light = 0;
  int patch = kAnyPatch;    // kAnyPatch: the light samples its patch itself
  PdfDiscrete probability;  // times the number of choices: the expected number of choices of this light
  float u = 0;              // the random number, rescaled to [0,1)
};

// The lights selected for a receiver: one, or several by stratified sampling, one from each of `count` equal parts of
// the distribution. Not initialised beyond `count`.
struct LightChoices {
  static constexpr int kMost = 16;
  int count = 0;
  SelectedLight of[kMost];
};

class LightLearning;

// Settings of light selection. All calls of a pass have the same, so that all techniques have the same probabilities.
struct SelectionSettings {
  const LightLearning* learned = nullptr;  // factors learned from shadow rays; null: none
  int mostSamples = 1;                     // the largest number of choices, in [1, LightChoices::kMost]
};

class LightSelector {
 public:
  virtual ~LightSelector() = default;
  // `u`: in [0,1); needs more bits than a float's if there are many lights. No choices: no light can contribute.
  virtual void Select(const Receiver& receiver, const SelectionSettings& settings, double u,
                      LightChoices& choices) const = 0;
  // Expected number of choices of this (light, patch) by Select at this receiver: its probability times the number of
  // choices.
  virtual PdfDiscrete Probability(const Receiver& receiver, const SelectionSettings& settings, uint32_t light,
                                  int patch) const = 0;
  // Selects one light for a segment of a ray in a medium, by u as in Select. `lights`: those of this selector. nullopt:
  // there is none. The selected light may turn out not to reach the segment.
  virtual std::optional<SelectedLight> SelectForSegment(const RaySegment& segment, const SegmentLights& lights,
                                                        double u) const = 0;
  // Probability of this (light, patch) in SelectForSegment.
  virtual PdfDiscrete SegmentProbability(const RaySegment& segment, const SegmentLights& lights, uint32_t light,
                                         int patch) const = 0;
  // Overloads for one choice without learned factors.
  void Select(const Receiver& receiver, double u, LightChoices& choices) const { Select(receiver, {}, u, choices); }
  PdfDiscrete Probability(const Receiver& receiver, uint32_t light, int patch) const {
    return Probability(receiver, {}, light, patch);
  }
  // True if Record has an effect for some receivers.
  virtual bool Learns() const { return false; }
  // Records in `learning` the irradiance caused by a light that was selected with `settings`; 0: it was occluded or
  // dark. `settings` may be of another selection than the learned one.
  virtual void Record(LightLearning&, const Receiver&, const SelectionSettings& /*settings*/, uint32_t /*light*/,
                      int /*patch*/, double /*irradiance*/) const {}
  // True if patches of lights are selected individually at this receiver; Probability then depends on `patch`.
  virtual bool SelectsPatches(const Receiver&) const { return false; }
};

enum class LightSelection { Uniform, Power, Tree, Exhaustive };

// Parses the name on the command line. "bvh", the name of pbrt-v4's tree, is accepted. nullopt: unknown name.
std::optional<LightSelection> ParseLightSelection(const std::string& name);
std::string NameOf(LightSelection selection);

// Light linking: sets of lights that illuminate a receiver. `ofClass`: for each class of receivers (Receiver::link) the
// index of its set in `lights`; each set is in ascending order. Empty: all lights illuminate all receivers.
struct LightSets {
  std::vector<uint32_t> ofClass;
  std::vector<std::vector<uint32_t>> lights;
};

// Selects in proportion to `weights` (0 or more), independent of the receiver. With all weights 0, selects nothing.
std::unique_ptr<LightSelector> MakeTableSelector(std::span<const float> weights);

// Uniform; by estimated power × importanceMultiplier, with a lower bound so that every light can be selected (the power
// of a moving light is its mean over the shutter); or by importance at the receiver, with a tree or exhaustively
// (tree_selector.h). No tree is built for a single light.
std::unique_ptr<LightSelector> MakeLightSelector(LightSelection selection, std::span<const PlacedLight> lights,
                                                 const BoundingSphere& scene);

// For emission: by power; lights with traceLightPaths off have probability 0.
std::unique_ptr<LightSelector> MakeEmissionSelector(std::span<const PlacedLight> lights, const BoundingSphere& scene);

}  // namespace lampyr
