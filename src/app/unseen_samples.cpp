#include "app/unseen_samples.h"

#include <algorithm>

#include "math/frame.h"
#include "sampling/warp.h"

namespace lampyr {

namespace {

// What scatters into less than a thirtieth of a steradian sends an image of a light rather than a glow.
constexpr float kNearlySmooth = 30;  // 1/sr

// Lights may send different radiance to diffuse and to specular lobes.
float Brighter(const Color& diffuse, const Color& specular) {
  return std::max(diffuse.Luminance(), specular.Luminance());
}

struct Vertex {
  SurfacePoint point;
  Vector3 wo{0.0f};
  Bsdf bsdf;
  std::optional<BsdfSample> scattered;
  bool isSmooth = false;
};

// Where a ray ended; nullopt where nothing is scattered.
std::optional<Vertex> FindVertex(const RenderScene& scene, const Ray& ray, const RayHit& hit, Sampler& sampler) {
  const int index = scene.geometry->Attributes(hit.primitive).material;
  const Material* material = index >= 0 ? scene.materials[static_cast<size_t>(index)].get() : nullptr;
  if (!material) return std::nullopt;
  Vertex vertex;
  vertex.point = scene.geometry->GetSurfacePoint(ray, hit);
  vertex.wo = -ray.direction;
  vertex.bsdf = material->GetBsdf(vertex.point, vertex.wo);
  const float uLobe = sampler.Get1D();
  vertex.scattered = vertex.bsdf.Sample(vertex.wo, uLobe, sampler.Get2D(), TransportMode::Radiance);
  vertex.isSmooth = vertex.scattered && !material->IsInterface() &&
                    (vertex.scattered->isDelta || vertex.scattered->pdfForward.value > kNearlySmooth);
  return vertex;
}

float BrightestPhoton(const RenderScene& scene) {
  constexpr uint32_t photons = 16384;
  Sampler sampler(SamplerKind::Sobol, 0);
  float brightest = 0;
  for (uint32_t i = 0; i < photons; ++i) {
    sampler.StartPixelSample(0, 0, i);
    const float uSelect = sampler.Get1D();
    const Point2 u = sampler.Get2D(), uDirection = sampler.Get2D();
    const auto photon = scene.lighting->GenerateEmission(uSelect, u, uDirection, 0);
    if (!photon || !photon->landing || !scene.lighting->CanBeHit(photon->light)) continue;
    const float radiance = Brighter(photon->emission.diffuse, photon->emission.specular);
    if (radiance <= brightest) continue;
    const auto vertex = FindVertex(scene, photon->ray, *photon->landing, sampler);
    if (vertex && vertex->isSmooth) brightest = radiance;
  }
  return brightest;
}

// Light that reaches a smooth vertex straight from a light that can be hit.
float DirectLight(const RenderScene& scene, const Vertex& vertex, Sampler& sampler) {
  const Normal3 Ns = vertex.bsdf.ShadingFrame().z;
  const Receiver receiver{vertex.point.position, glm::dot(Ns, vertex.wo) < 0 ? -Ns : Ns, true};
  LightChoices lights;
  scene.lighting->SelectLights(receiver, sampler.Get1D(), lights);
  const Point2 u = sampler.Get2D();
  float brightest = 0;
  for (int i = 0; i < lights.count; ++i) {
    const DirectSample direct = scene.lighting->GenerateSamples(receiver, lights.of[i], MovedPoint(u, i), 0, false);
    if (!direct || direct.isDelta || scene.lighting->Transmission(vertex.point, direct, 0).IsBlack()) continue;
    brightest = std::max(brightest, Brighter(direct.sample->diffuse, direct.sample->specular));
  }
  return brightest;
}

float BrightestFromCamera(const RenderScene& scene, const RenderSettings& settings) {
  constexpr uint32_t paths = 4096;
  constexpr int vertices = 3;
  Sampler sampler(SamplerKind::Sobol, 0);
  const Point2 corner(settings.crop.x0, settings.crop.y0), size(settings.crop.Width(), settings.crop.Height());
  float brightest = 0;
  for (uint32_t i = 0; i < paths; ++i) {
    sampler.StartPixelSample(1, 0, i);
    const Point2 film = corner + sampler.Get2D() * size;
    Ray ray = scene.camera->GenerateRay(film, sampler.Get2D(), 0).ray;
    for (int k = 0; k < vertices; ++k) {
      RayHit hit;
      if (!scene.geometry->Intersect(ray, k == 0 ? visibility::kCamera : visibility::kIndirect, hit)) break;
      const auto vertex = FindVertex(scene, ray, hit, sampler);
      if (!vertex) break;
      if (vertex->isSmooth) brightest = std::max(brightest, DirectLight(scene, *vertex, sampler));
      const Normal3 n = glm::dot(vertex->point.Ng, vertex->wo) < 0 ? -vertex->point.Ng : vertex->point.Ng;
      const Vector3 glow = Frame::FromNormal(n).ToWorld(SampleCosineHemisphere(sampler.Get2D()));
      ray = SpawnRay(vertex->point, vertex->isSmooth ? vertex->scattered->wi : glow, 0);
    }
  }
  return brightest;
}

}  // namespace

double LargestUnseenSample(const RenderScene& scene, const RenderSettings& settings) {
  const auto& lights = scene.lighting->Lights();
  bool anyCanBeHit = false;
  for (uint32_t i = 0; i < lights.size(); ++i) anyCanBeHit |= scene.lighting->CanBeHit(i);
  if (!anyCanBeHit) return 0;
  const float brightest = std::max(BrightestPhoton(scene), BrightestFromCamera(scene, settings));
  return static_cast<double>(brightest) * static_cast<double>(settings.imagingRatio);
}

}  // namespace lampyr
