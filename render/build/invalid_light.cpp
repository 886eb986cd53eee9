#include "render/build/invalid_light.h"

#include <algorithm>
#include <vector>

#include "integrators/walk/footprint.h"
#include "sampling/rng.h"
#include "sampling/warp.h"

namespace lampyr {

namespace {

constexpr int kAcross = 16;          // camera rays along each side of the grid
constexpr size_t kAsked = 1 << 20;   // samples of lights, at most
constexpr size_t kMostOfPair = 256;  // of a light for a receiver
constexpr uint32_t kPhotons = 4096;  // photons

// Densities may be infinite: those of deltas.
bool IsInvalid(const LightSample& sample) {
  return !sample.diffuse.IsValid() || !sample.specular.IsValid() || !(sample.pdfDirect.value >= 0);
}
bool IsInvalid(const EmissionSample& sample) {
  return !sample.diffuse.IsValid() || !sample.specular.IsValid() || !(sample.pdfEmit.value >= 0) ||
         !(sample.pdfEmitDirection.value >= 0);
}

// Receivers that the camera sees, or the middle of the scene.
std::vector<Receiver> ReceiversOf(const BuiltScene& built) {
  std::vector<Receiver> receivers;
  SceneProbe probe(built.scene);
  probe.ForEachVisible(built.settings.width, built.settings.height, kAcross,
                       [&](const Ray&, const SeenVertex& seen) { receivers.push_back(seen.vertex.receiver); });
  if (receivers.empty()) receivers.push_back({built.scene.lighting->SceneSphere().center, Normal3(0.0f), true, 0});
  return receivers;
}

bool SendsInvalid(const LightingServices& lighting, const Receiver& receiver, uint32_t light, const Point2& u) {
  SelectedLight selected;
  selected.light = light;
  selected.probability = PdfDiscrete(1);
  const DirectSample direct = lighting.GenerateSamples(receiver, selected, u, 0, false);
  return direct.sample && IsInvalid(*direct.sample);
}

}  // namespace

std::optional<InvalidLight> FindInvalidLight(const BuiltScene& built) {
  const LightingServices& lighting = *built.scene.lighting;
  const std::vector<PlacedLight>& lights = lighting.Lights();
  if (lights.empty()) return std::nullopt;
  const auto ofLight = [&](uint32_t light) {
    return InvalidLight{built.lightPlaces[light],
                        "this light gives values or densities that are not finite, or negative"};
  };
  const std::vector<Receiver> receivers = ReceiversOf(built);
  const size_t step = 1 + receivers.size() * lights.size() / kAsked;
  const size_t times = std::clamp<size_t>(kAsked / (receivers.size() * lights.size()), 1, kMostOfPair);
  Rng rng(1);
  for (uint32_t light = 0; light < lights.size(); ++light) {
    for (size_t k = light % step; k < times * receivers.size(); k += step) {
      const Receiver& receiver = receivers[k % receivers.size()];
      const Point2 u = rng.NextPoint2();
      if (!SendsInvalid(lighting, receiver, light, u)) continue;
      // Light is not filtered for Receiver::kCamera, which distinguishes a fault of the light from one of its filter.
      Receiver unfiltered = receiver;
      unfiltered.link = Receiver::kCamera;
      if (lights[light].filter < 0 || SendsInvalid(lighting, unfiltered, light, u)) return ofLight(light);
      return InvalidLight{built.filterPlaces[static_cast<size_t>(lights[light].filter)],
                          "this LightFilter gives values that are not finite, or negative"};
    }
  }
  for (size_t i = 0; i < lighting.InfiniteCount(); ++i) {
    for (const Receiver& receiver : receivers) {
      Ray ray;
      ray.origin = receiver.position;
      ray.direction = SampleUniformSphere(rng.NextPoint2());
      if (lighting.EscapedEmissionForCamera(i, ray).IsValid()) continue;
      for (uint32_t light = 0, infinite = 0; light < lights.size(); ++light) {
        if (lights[light].light->Kind() == LightKind::Infinite && infinite++ == i) return ofLight(light);
      }
    }
  }
  for (uint32_t i = 0; i < kPhotons; ++i) {
    const float uSelect = rng.NextPoint2().x;
    const Point2 u = rng.NextPoint2();
    const auto photon = lighting.GenerateEmission(uSelect, u, rng.NextPoint2(), 0);
    if (photon && IsInvalid(photon->emission)) return ofLight(photon->light);
  }
  return std::nullopt;
}

}  // namespace lampyr
