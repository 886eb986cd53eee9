#include "integrators/path/path_walk.h"

#include "base/stop.h"
#include "integrators/common/escaped_emission.h"
#include "integrators/common/mis.h"
#include "integrators/common/roulette.h"

namespace lampyr {

// The path so far. Throughput is split by the lobe that the last direction came from, because a light may show diffuse
// and specular lobes different radiance.
struct PathWalk::State {
  explicit State(const Ray& cameraRay, LayerSample* wanted) : layers(wanted), ray(cameraRay) {}

  LayerSample* const layers;
  Ray ray;
  Color throughputDiffuse{0.0f};
  Color throughputSpecular{1.0f};
  Receiver receiver;           // the last vertex: where the other technique would have sampled the light
  PdfSolidAngle pdfDirection;  // of `ray`, by the BSDF
  float etaScale = 1;
  float length = 0;        // from the camera
  int depth = 0;           // scattering events so far
  bool fromCamera = true;  // nothing has scattered yet
  bool fromDelta = false;  // the last event was a delta: light sampling could not have found this
  bool isLook = false;     // the ray is for lights alone: other light from there is left to the gatherer

  Color Throughput() const { return throughputDiffuse + throughputSpecular; }
};

// Whatever the walk itself returns has come through here, or is the background.
inline Color PathWalk::Found(const State& path, uint32_t light, const Color& radiance) const {
  if (path.layers) path.layers->Add(lighting_.GroupOf(light), radiance);
  return radiance;
}

// Radiance of a light that the BSDF's direction found, weighted against next-event estimation.
Color PathWalk::WeightedEmission(const State& path, const FoundLight& found) const {
  const Color radiance =
      path.throughputDiffuse * found.evaluation.diffuse + path.throughputSpecular * found.evaluation.specular;
  if (path.fromDelta || !samplesLights_) return radiance;
  return radiance * PowerHeuristic(path.pdfDirection, found.selection * found.evaluation.pdfDirect);
}

Color PathWalk::EmissionAt(const State& path, const RayHit& hit, const SurfacePoint& point) const {
  if (path.fromCamera) {
    const Color seen =
        path.throughputSpecular * lighting_.EmissionForCamera(path.ray.direction, hit.t, point, path.ray.time);
    if (path.layers) path.layers->Add(lighting_.GroupAt(point), seen);
    return seen;
  }
  const float distance = glm::distance(point.position, path.receiver.position);
  const auto found =
      lighting_.EvaluateSamples(path.receiver, path.ray.direction, distance, point, path.ray.time, false);
  return found ? Found(path, found->light, WeightedEmission(path, *found)) : Color(0.0f);
}

Color PathWalk::EscapedEmission(const State& path) const {
  if (path.fromCamera) {
    return EscapedEmissionForCamera(lighting_, path.ray, path.throughputSpecular, path.layers);
  }
  Color sum;
  for (size_t i = 0; i < lighting_.InfiniteCount(); ++i) {
    const auto found = lighting_.EvaluateEscaped(i, path.receiver, path.ray.direction, path.ray.time, false);
    if (found) sum += Found(path, found->light, WeightedEmission(path, *found));
  }
  return sum;
}

Color PathWalk::DirectLight(const State& path, const SurfacePoint& point, const Bsdf& bsdf, const Vector3& wo,
                            const Receiver& receiver, const Color& soFar, Sampler& sampler,
                            RenderCounts& counts) const {
  sampler.SetDimension(dimensions_.Of(path.depth, dimensions::kLightSelection));
  LightChoices lights;
  lighting_.SelectLights(receiver, sampler.Get1D(), lights);
  const Point2 u = sampler.Get2D();
  Color sum;
  for (int i = 0; i < lights.count; ++i)
    sum += SampleLight(path, point, bsdf, wo, receiver, lights.of[i], MovedPoint(u, i), soFar + sum, counts);
  return sum;
}

Color PathWalk::SampleLight(const State& path, const SurfacePoint& point, const Bsdf& bsdf, const Vector3& wo,
                            const Receiver& receiver, const SelectedLight& light, const Point2& u, const Color& soFar,
                            RenderCounts& counts) const {
  const DirectSample direct = lighting_.GenerateSamples(receiver, light, u, path.ray.time, false);
  const auto nothingArrives = [&] {
    lighting_.UpdateWithResults(receiver, direct, Color(0.0f));
    return Color(0.0f);
  };
  if (!direct) return nothingArrives();
  const LightSample& sample = *direct.sample;

  const BsdfEvaluation f = bsdf.Evaluate(wo, sample.direction, TransportMode::Radiance);
  const Color scattered = f.diffuse * sample.diffuse + f.specular * sample.specular;
  if (scattered.IsBlack()) return nothingArrives();

  const PdfSolidAngle pdf = direct.selection * sample.pdfDirect;
  const float weight = direct.isDelta ? 1.0f : PowerHeuristic(pdf, f.pdfForward);
  const float cosTheta = AbsDot(sample.direction, bsdf.ShadingFrame().z);
  const Color contribution = path.Throughput() * scattered * (cosTheta * weight / pdf.value);
  if (contribution.IsBlack()) return Color(0.0f);
  const float worth = shadowRays_.Worth(contribution, soFar, ShadowRays::DeciderOf(u.x, u.y));
  if (worth == 0) return Color(0.0f);
  ++counts.shadowRays;
  const Color arrived = lighting_.Transmission(point, direct, path.ray.time);
  lighting_.UpdateWithResults(receiver, direct, arrived);
  return Found(path, light.light, contribution * arrived * worth);
}

// Continues the path by the BSDF and Russian roulette. False: it ends here.
bool PathWalk::Scatter(State& path, const SurfacePoint& point, const Bsdf& bsdf, const Vector3& wo,
                       const Receiver& receiver, Sampler& sampler) const {
  sampler.SetDimension(dimensions_.Of(path.depth, dimensions::kLobe));
  const float uLobe = sampler.Get1D();
  const auto sample = bsdf.Sample(wo, uLobe, sampler.Get2D(), TransportMode::Radiance);
  if (!sample) return false;
  path.isLook = !sample->isDelta && sample->pdfForward.value <= gatherBelow_;
  if (path.isLook && !looksForLights_) return false;
  const Color throughput = path.Throughput();
  path.throughputDiffuse = throughput * sample->weightDiffuse;
  path.throughputSpecular = throughput * sample->weightSpecular;
  if (sample->isTransmission) path.etaScale *= Sqr(sample->eta);
  path.pdfDirection = sample->pdfForward;
  path.fromDelta = sample->isDelta;
  path.fromCamera = false;
  path.receiver = receiver;
  path.ray = SpawnRay(point, sample->wi, path.ray.time);
  ++path.depth;

  const float survival = SurvivalProbability(path.Throughput(), path.etaScale, path.depth);
  if (survival < 1) {
    sampler.SetDimension(dimensions_.Of(path.depth - 1, dimensions::kRoulette));
    if (sampler.Get1D() >= survival) return false;
    path.throughputDiffuse /= survival;
    path.throughputSpecular /= survival;
  }
  return true;
}

Color PathWalk::Radiance(const Ray& cameraRay, Sampler& sampler, RenderCounts& counts, const PhotonGatherer* gatherer,
                         LayerSample* layers) const {
  State path(cameraRay, layers);
  Color radiance;
  for (;;) {
    CheckStop();
    ++(path.fromCamera ? counts.cameraRays : counts.indirectRays);
    RayHit hit;
    Color passed;
    const bool isHit =
        geometry_.Intersect(path.ray, path.fromCamera ? visibility::kCamera : visibility::kIndirect, hit, passed);
    path.throughputDiffuse *= passed;
    path.throughputSpecular *= passed;
    if (!isHit) return radiance + EscapedEmission(path);
    path.length += hit.t;
    const SurfacePoint point = geometry_.GetSurfacePoint(path.ray, hit);
    const GeometryAttributes& attributes = geometry_.Attributes(hit.primitive);
    if (attributes.light >= 0) radiance += EmissionAt(path, hit, point);
    if (path.isLook) return radiance;

    const Material* material = attributes.material >= 0 ? materials_[attributes.material].get() : nullptr;
    if (!material) return radiance;  // a black surface, such as an analytic light
    if (path.depth >= maxDepth_) return radiance;

    const Vector3 wo = -path.ray.direction;
    const Bsdf bsdf = material->GetBsdf(point, wo);
    const Normal3 Ns = bsdf.ShadingFrame().z;
    const Receiver receiver{point.position, glm::dot(Ns, wo) < 0 ? -Ns : Ns, bsdf.IsTransmissive(), attributes.link};
    if (!bsdf.IsDelta()) {
      if (samplesLights_) radiance += DirectLight(path, point, bsdf, wo, receiver, radiance, sampler, counts);
      if (gatherer) radiance += gatherer->Gather(point, bsdf, wo, path.Throughput(), path.depth + 1, path.length);
    }
    if (!Scatter(path, point, bsdf, wo, receiver, sampler)) return radiance;
  }
}

}  // namespace lampyr
