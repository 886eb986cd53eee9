#include "render/analysis/unseen_samples.h"

#include <algorithm>
#include <sstream>

#include "integrators/walk/light_path.h"
#include "integrators/walk/next_event.h"

namespace lampyr {

namespace {

// A lobe narrower than a thirtieth of a steradian shows an image of a light rather than a glow.
constexpr float kNearlySmooth = 30;  // 1/sr

// Lights may send different radiance to diffuse and to specular lobes.
float Brighter(const Color& diffuse, const Color& specular) {
  return std::max(diffuse.Luminance(), specular.Luminance());
}

// True if one random sample of the vertex's scattering shows a sharp image of a light.
bool IsSmooth(const RenderScene& scene, const Vertex& vertex, Sampler& sampler) {
  if (vertex.IsInMedium()) return false;
  const int index = scene.geometry->Attributes(vertex.point.primitive).material;
  if (scene.materials[static_cast<size_t>(index)]->IsInterface()) return false;
  const float uLobe = sampler.Get1D();
  const auto sample = vertex.bsdf.Sample(vertex.toPrevious, uLobe, sampler.Get2D(), TransportMode::Radiance);
  return sample && (sample.isDelta || sample.pdfForward.value > kNearlySmooth);
}

// The brightest emission whose first hit is smooth.
class BrightPhotons final : public LightPathVisitor {
 public:
  explicit BrightPhotons(const SampleContext& context) : context_(context) {}

  bool FirstHit(const EmittedPhoton& photon, PathVertex& first) override {
    const float radiance = Brighter(photon.emission.diffuse, photon.emission.specular);
    if (context_.scene.lighting->CanBeHit(photon.light) && radiance > brightest &&
        IsSmooth(context_.scene, first, context_.sampler))
      brightest = radiance;
    return false;
  }
  void Arrived(LightPath&, const PathState&) override {}

  float brightest = 0;

 private:
  const SampleContext& context_;
};

float BrightestPhoton(const RenderScene& scene) {
  constexpr uint32_t photons = 16384;
  Sampler sampler(SamplerKind::Sobol, 0);
  RenderCounts counts;
  const SampleContext context{scene, sampler, 0, counts};
  BrightPhotons visitor(context);
  LightPath path(false);
  for (uint32_t i = 0; i < photons; ++i) {
    sampler.StartPixelSample(0, 0, i);
    TraceLightPath(context, 1, {}, path, visitor);
  }
  return visitor.brightest;
}

// The brightest direct light of lights that can be hit, at smooth vertices of camera paths.
class BrightVertices final : public PathVisitor {
 public:
  explicit BrightVertices(const SampleContext& context) : context_(context) {}

  bool Arrived(Subpath& path, const PathState&) override {
    const RenderScene& scene = context_.scene;
    const Vertex& vertex = path.Last();
    Sampler& sampler = context_.sampler;
    sampler.SetDimension(PathDimensions().Of(kBlock + static_cast<int>(path.Count()), 0));
    if (!IsSmooth(scene, vertex, sampler)) return true;
    const float uSelect = sampler.Get1D();
    // A smooth surface may show a light from either side.
    Receiver receiver = vertex.receiver;
    receiver.isTransmissive = true;
    ForChosenLights(*scene.lighting, receiver, uSelect, sampler.Get2D(),
                    [&](const SelectedLight& light, const Point2& u) {
                      const DirectSample direct = scene.lighting->GenerateSamples(receiver, light, u, 0, false);
                      if (!direct || direct.isDelta || scene.lighting->Transmittance(vertex.point, direct, 0).IsBlack())
                        return;
                      brightest = std::max(brightest, Brighter(direct.sample->diffuse, direct.sample->specular));
                    });
    return true;
  }

  float brightest = 0;

 private:
  static constexpr int kBlock = 20;  // block of sampler dimensions, beyond those of the path

  const SampleContext& context_;
};

struct SeenByCamera {
  float brightest = 0, largestWeight = 0;  // of rays
};
SeenByCamera LookFromCamera(const RenderScene& scene, const RenderSettings& settings) {
  constexpr uint32_t paths = 4096;
  constexpr int vertices = 3;
  Sampler sampler(SamplerKind::Sobol, 0);
  RenderCounts counts;
  const SampleContext context{scene, sampler, 0, counts};
  BrightVertices visitor(context);
  Subpath path(false);
  float largestWeight = 0;
  const Point2 corner(settings.crop.x0, settings.crop.y0), size(settings.crop.Width(), settings.crop.Height());
  for (uint32_t i = 0; i < paths; ++i) {
    sampler.StartPixelSample(1, 0, i);
    const Point2 film = corner + sampler.Get2D() * size;
    PathState state;
    const CameraRay ray = scene.camera->GenerateRay(film, sampler.Get2D(), 0);
    largestWeight = std::max(largestWeight, ray.weight);
    if (ray.weight == 0) continue;
    state.ray = ray.ray;
    state.medium = scene.MediumOf(state.ray);
    state.specular = Color(1.0f);
    path.Clear();
    Walk(context, {TransportMode::Radiance, vertices, {}, false}, state, path, visitor);
  }
  return {visitor.brightest, largestWeight};
}

}  // namespace

double LargestUnseenSample(const RenderScene& scene, const RenderSettings& settings) {
  if (!scene.lighting->HasLightThatCanBeHit()) return 0;
  const SeenByCamera seen = LookFromCamera(scene, settings);
  const float brightest = std::max(BrightestPhoton(scene), seen.brightest) * seen.largestWeight;
  return static_cast<double>(brightest) * static_cast<double>(settings.sensor.Scale(Color(brightest)));
}

void WarnOfCoarsePlaces(const RenderScene& scene, const RenderSettings& settings, Diagnostics& diagnostics) {
  const Point2 middle(0.5f * static_cast<float>(settings.width), 0.5f * static_cast<float>(settings.height));
  const Ray ray = scene.camera->GenerateRay(middle, Point2(0.5f), 0).ray;
  const Ray beside = scene.camera->GenerateRay(middle + Point2(1, 0), Point2(0.5f), 0).ray;
  float error = 0, distance = 0;
  try {
    RayHit hit;
    Color passed;
    if (!scene.geometry->Intersect(ray, visibility::kCamera, hit, passed)) return;
    error = MaxComponent(scene.geometry->GetSurfacePoint(ray, hit).positionError);
    distance = hit.t;
  } catch (...) {
    return;  // a plugin's surface may throw anything; the render will report it
  }
  const float pixel = glm::distance(ray.origin + distance * ray.direction, beside.origin + distance * beside.direction);
  constexpr float kCoarse = 0.1f;
  if (!(error > kCoarse * distance && error > pixel)) return;
  std::ostringstream text;
  text << "the surface in the middle of the picture is so large that points on it are rounded to " << error
       << " scene units, and the camera is " << distance
       << " away: finer detail is lost. Divide it into smaller surfaces";
  diagnostics.Warn(text.str());
}

}  // namespace lampyr
