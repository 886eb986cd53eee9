// Choosing one light among many: for next-event estimation at a receiver, and for emission.
//
// The probability of a choice is never part of a light's own densities. It is asked for again when another technique
// finds the same light, with the very receiver that the choice was made for: both must be the same bits.
#pragma once

#include <algorithm>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "lights/placed_light.h"

namespace lampyr {

// The point that is being lit. It travels with a path's vertex.
struct Receiver {
  Point3 position{0.0f};
  Normal3 normal{0.0f};         // shading normal, on the side of the path's previous vertex; 0 in a volume
  bool isTransmissive = false;  // light from behind counts too
  uint32_t link = 0;            // class of its light linking and light filters (services/linking.h)

  // The camera's own place: what it sees is neither linked nor filtered.
  static constexpr uint32_t kCamera = 0xffffffffu;
};

struct SelectedLight {
  uint32_t light = 0;
  int patch = kAnyPatch;    // kAnyPatch: the light chooses its patch itself
  PdfDiscrete probability;  // times the number of samples that the receiver takes: the expected number of this light
  float u = 0;              // the random number, stretched over [0,1) again
};

// What a receiver takes: one light, or several, one from each of as many equal parts of the distribution. Not
// initialised beyond `count`.
struct LightChoices {
  static constexpr int kMost = 16;
  int count = 0;
  SelectedLight of[kMost];
};

class LightLearning;

class LightSelector {
 public:
  virtual ~LightSelector() = default;
  // u in [0,1), of more bits than a float's where there are many lights. `learned`: what is known from shadow rays, or
  // null. No choices: no light can contribute.
  virtual void Select(const Receiver& receiver, const LightLearning* learned, double u,
                      LightChoices& choices) const = 0;
  // Expected number of times that Select chooses this (light, patch) at this receiver: the probability, times the
  // number of choices.
  virtual PdfDiscrete Probability(const Receiver& receiver, const LightLearning* learned, uint32_t light,
                                  int patch) const = 0;
  // The same with nothing learned.
  void Select(const Receiver& receiver, double u, LightChoices& choices) const {
    Select(receiver, nullptr, u, choices);
  }
  PdfDiscrete Probability(const Receiver& receiver, uint32_t light, int patch) const {
    return Probability(receiver, nullptr, light, patch);
  }
  // Records in `learning` that the selected light brought this irradiance (0: it was occluded, or dark).
  virtual void Record(LightLearning&, const Receiver&, uint32_t, int, double) const {}
  // Whether lights are selected patch by patch at this receiver: patchIndex then belongs to what is asked for.
  virtual bool SelectsPatches(const Receiver&) const { return false; }

  // At most so many choices for a receiver, in [1, LightChoices::kMost]; 1 unless said. Before the first Select.
  virtual void TakeSamples(int most) { mostSamples_ = std::clamp(most, 1, LightChoices::kMost); }

 protected:
  int MostSamples() const { return mostSamples_; }

 private:
  int mostSamples_ = 1;
};

enum class LightSelection { Uniform, Power, Tree, Exhaustive };

// The name as on the command line (or "bvh", pbrt-v4's name of its tree); nullopt for an unknown one.
std::optional<LightSelection> ParseLightSelection(const std::string& name);
std::string NameOf(LightSelection selection);

// Receivers by the lights that shine on them: `ofClass` says for each class of receivers (Receiver::link) which of
// `lights` these are, in ascending order. Empty: all lights shine on all.
struct LightSets {
  std::vector<uint32_t> ofClass;
  std::vector<std::vector<uint32_t>> lights;
};

// Selects in proportion to `weights` (not negative), whatever the receiver. With all weights 0, selects nothing.
std::unique_ptr<LightSelector> MakeTableSelector(std::span<const float> weights);

// Every light alike; by estimated power × importanceMultiplier, with a floor so that no light is impossible (the power
// of a light that moves is its mean over the shutter); or by what each is estimated to send to the receiver, with a
// tree or one by one (tree_selector.h). A single light needs no choice, and no tree.
std::unique_ptr<LightSelector> MakeLightSelector(LightSelection selection, std::span<const PlacedLight> lights,
                                                 const BoundingSphere& scene);

// For emission: by power; lights with traceLightPaths off have probability 0.
std::unique_ptr<LightSelector> MakeEmissionSelector(std::span<const PlacedLight> lights, const BoundingSphere& scene);

}  // namespace lampyr
