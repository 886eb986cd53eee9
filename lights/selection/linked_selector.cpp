#include "lights/selection/linked_selector.h"

#include <algorithm>
#include <vector>

namespace lampyr {

namespace {

constexpr uint32_t kAllLights = 0xffffffffu;

class LinkedSelector final : public LightSelector {
 public:
  LinkedSelector(LightSelection selection, std::span<const PlacedLight> lights, const BoundingSphere& scene,
                 const LightSets& sets)
      : setOfClass_(sets.ofClass), all_(MakeLightSelector(selection, lights, scene)) {
    size_t room = 1000000;
    for (const PlacedLight& placed : lights) room += 4 * static_cast<size_t>(placed.light->PatchCount());
    std::vector<uint32_t> place;  // for each set, its index among those with a selector
    for (const std::vector<uint32_t>& members : sets.lights) {
      size_t emitters = 0;
      for (const uint32_t light : members) emitters += static_cast<size_t>(lights[light].light->PatchCount());
      if (members.size() == lights.size() || emitters > room) {
        place.push_back(kAllLights);
        continue;
      }
      room -= emitters;
      place.push_back(static_cast<uint32_t>(parts_.size()));
      std::vector<PlacedLight> own;
      for (const uint32_t light : members) own.push_back(lights[light]);
      parts_.push_back({MakeLightSelector(selection, own, scene), members});
    }
    for (uint32_t& set : setOfClass_) set = place[set];
  }

  // Learned factors belong to one tree, that of all lights.
  void Select(const Receiver& receiver, const LightLearning* learned, double u, LightChoices& choices) const override {
    const Part* part = PartOf(receiver);
    if (!part) return all_->Select(receiver, learned, u, choices);
    part->selector->Select(receiver, nullptr, u, choices);
    for (int i = 0; i < choices.count; ++i) choices.of[i].light = part->lights[choices.of[i].light];
  }

  PdfDiscrete Probability(const Receiver& receiver, const LightLearning* learned, uint32_t light,
                          int patch) const override {
    const Part* part = PartOf(receiver);
    if (!part) return all_->Probability(receiver, learned, light, patch);
    const auto at = std::lower_bound(part->lights.begin(), part->lights.end(), light);
    if (at == part->lights.end() || *at != light) return PdfDiscrete(0);
    const auto own = static_cast<uint32_t>(at - part->lights.begin());
    return part->selector->Probability(receiver, nullptr, own, patch);
  }

  void Record(LightLearning& learning, const Receiver& receiver, uint32_t light, int patch,
              double irradiance) const override {
    if (!PartOf(receiver)) all_->Record(learning, receiver, light, patch, irradiance);
  }

  bool SelectsPatches(const Receiver& receiver) const override {
    const Part* part = PartOf(receiver);
    return part ? part->selector->SelectsPatches(receiver) : all_->SelectsPatches(receiver);
  }

  void TakeSamples(int most) override {
    all_->TakeSamples(most);
    for (const Part& part : parts_) part.selector->TakeSamples(most);
  }

 private:
  struct Part {
    std::unique_ptr<LightSelector> selector;
    std::vector<uint32_t> lights;  // ascending
  };

  const Part* PartOf(const Receiver& receiver) const {
    if (receiver.link == Receiver::kCamera) return nullptr;
    const uint32_t set = setOfClass_[receiver.link];
    return set == kAllLights ? nullptr : &parts_[set];
  }

  std::vector<uint32_t> setOfClass_;
  std::unique_ptr<LightSelector> all_;
  std::vector<Part> parts_;
};

}  // namespace

std::unique_ptr<LightSelector> MakeLinkedSelector(LightSelection selection, std::span<const PlacedLight> lights,
                                                  const BoundingSphere& scene, const LightSets& sets) {
  return std::make_unique<LinkedSelector>(selection, lights, scene, sets);
}

}  // namespace lampyr
