// s > 1, t > 1: a vertex of the light subpath is connected to one of the camera subpath.
#include <bit>
#include <cmath>

#include "integrators/bidirectional/techniques.h"
#include "integrators/bidirectional/weights.h"
#include "integrators/walk/path_layers.h"

namespace lampyr {

namespace {

// A fibre is met on its far side, too, as seen along the ray: it must not hide itself.
Ray RayBetween(const PathVertex& from, const PathVertex& to, float time) {
  Ray ray = SpawnRayTo(from.point, to.point.position, to.point.positionError, to.point.Ng, time);
  if (to.bsdf.IsFibre()) {
    constexpr float kMargin = 1.01f;
    const float through = glm::length(to.point.dpdv) / to.GeometryTerm(ray.direction);
    ray.tMax = std::max(ray.tMax - kMargin * through, 0.0f);
  }
  return ray;
}

// Transmittance from a vertex of the camera subpath to one of the light subpath, and the factors of media between them.
Color TraceConnection(const SampleContext& context, const PathVertex& z, const PathVertex& y, EdgeFactors& factors) {
  ++context.counts.shadowRays;
  const Ray ray = RayBetween(z, y, context.time);
  if (context.scene.media.empty()) [[likely]]
    return context.scene.Transmittance(ray, visibility::kIndirect);
  const uint64_t decider = Hash(std::bit_cast<uint32_t>(ray.direction.x), std::bit_cast<uint32_t>(ray.direction.y),
                                std::bit_cast<uint32_t>(ray.tMax));
  return TransmittanceOf(context, ray, visibility::kIndirect, z.EndTowards(ray.direction), y.EndTowards(-ray.direction),
                         decider, factors);
}

// In all of these `fy` and `fz` are of the vertices of both subpaths, towards each other; `factors` are from the
// camera's vertex on.
void AddConnectionToLayers(const BidirectionalSample& sample, size_t lightCount, const Vector3& toCamera,
                           const BsdfEvaluation& fy, const BsdfEvaluation& fz, const Color& contribution) {
  const PathVertex &y = sample.light.vertices[lightCount - 1], &z = sample.camera.Last();
  const SampleContext& context = sample.context;
  thread_local PathLabels labels;
  LabelsAfter(*context.outputs, TransportMode::Importance, sample.light.vertices.LabelsAt(lightCount - 1),
              PartsOf(y, toCamera, false, y.diffuse * fy.diffuse, y.specular * fy.specular), labels);
  AddArrivingToLayers(context, sample.camera, PartsOf(z, -toCamera, false, fz.diffuse, fz.specular), labels.All(),
                      contribution);
}

inline Joint JointOf(const BidirectionalSample& sample, size_t lightCount, const Vector3& toCamera,
                     double squaredDistance, const BsdfEvaluation& fy, const BsdfEvaluation& fz,
                     const EdgeFactors& factors) {
  const PathVertex &y = sample.light.vertices[lightCount - 1], &z = sample.camera.Last();
  return {{sample.continuesHere * SolidAngleDensity(fz.pdfForward) *
               (factors.forward * EdgeDensity(y, toCamera, squaredDistance)),
           y.PreviousReverse(fy.pdfReverse)},
          {SolidAngleDensity(fy.pdfForward) * (factors.reverse * EdgeDensity(z, toCamera, squaredDistance)),
           z.PreviousReverse(fz.pdfReverse)},
          y.CanMerge(),
          z.CanMerge(),
          MergeVolume(y, EdgeBefore(sample.light.vertices, lightCount), {toCamera, factors},
                      sample.settings.photons.volume),
          MergeVolume(z, {-toCamera, factors.Reversed(), y.IsInMedium()}, {z.toPrevious, z.factors},
                      sample.settings.photons.volume)};
}

void ReportConnection(const BidirectionalSample& sample, size_t lightCount, const Color& arriving, double weight,
                      const EdgeFactors& factors, const Joint& joint, double flightRatio) {
  ConnectedPath path;
  path.value = arriving;
  path.weight = weight;
  path.factors = factors;
  sample.SetLight(path, lightCount);
  sample.SetCamera(path);
  if (sample.WantsSums()) [[unlikely]]
    path.sums = sample.SumsOfConnection(lightCount, joint.light, flightRatio);
  sample.Report(path);
}

}  // namespace

Color Connect(const BidirectionalSample& sample, size_t lightCount) {
  const SampleContext& context = sample.context;
  const PathVertex &y = sample.light.vertices[lightCount - 1], &z = sample.camera.Last();
  if (y.isDelta || context.IsCounted(y.isDispersed || z.isDispersed)) return Color(0.0f);
  const Way way{Vector3(y.WayTo(z))};
  if (!(way.squared > 0)) return Color(0.0f);
  const Vector3& toCamera = way.direction;
  const BsdfEvaluation fy = y.Evaluate(toCamera, TransportMode::Importance);
  const Color leaving = y.diffuse * fy.diffuse + y.specular * fy.specular;
  if (leaving.IsBlack()) return leaving;
  const BsdfEvaluation fz = z.Evaluate(-toCamera, TransportMode::Radiance);
  const double geometric =
      static_cast<double>(y.GeometryTerm(toCamera) * z.ScatteringCosine(toCamera) * y.ArrivalCorrection(y.toPrevious)) /
      way.squared;
  const Color value =
      Product(z.Throughput() * fz.Sum(), leaving,
              geometric * static_cast<double>(sample.Lighting().FluxUnit()) / sample.connectionsPerSample);
  if (value.IsBlack()) return value;
  const bool hasMedia = !context.scene.media.empty();
  const ShadowRays shadowRays = sample.WantedShadowRays();
  const auto survivalWeightOf = [&](double weight) {
    return shadowRays.SurvivalWeight(value * static_cast<float>(weight), sample.radiance,
                                     ShadowRays::DeciderOf(toCamera.x, toCamera.y));
  };
  EdgeFactors factors;  // from the camera's vertex on
  Color transmitted(1.0f);
  // Media on the way are a part of the weight: survival is decided without it, and the shadow ray comes first.
  const float survivalInMedia = hasMedia ? survivalWeightOf(1) : 1.0f;
  if (hasMedia) [[unlikely]] {
    if (survivalInMedia == 0) return Color(0.0f);
    transmitted = TraceConnection(context, z, y, factors);
    if (transmitted.IsBlack()) return transmitted;
  }
  const Joint joint = JointOf(sample, lightCount, toCamera, way.squared, fy, fz, factors);
  const double flightRatio = sample.FlightRatio(-toCamera, std::sqrt(way.squared), factors.reverse);
  const PartialWeight cameraWeight = sample.CameraWeight(flightRatio);
  const auto weightWith = [&](double merging) {
    return ConnectWeight(y.weight, joint.light, cameraWeight, joint.camera, sample.connectionCount, merging);
  };
  // Merging only lowers the weight: what is dropped without it is dropped with it, before its terms are computed.
  if (!hasMedia && sample.merging && survivalWeightOf(weightWith(0)) == 0) return Color(0.0f);
  const double weight = weightWith(sample.MergingOfConnection(lightCount, joint));
  const float survivalWeight = hasMedia ? survivalInMedia : survivalWeightOf(weight);
  if (survivalWeight == 0) return Color(0.0f);
  const Color arriving = value * (hasMedia ? transmitted : TraceConnection(context, z, y, factors));
  if (arriving.IsBlack()) return arriving;
  const Color contribution = arriving * static_cast<float>(weight) * survivalWeight;
  if (context.layers) [[unlikely]]
    AddConnectionToLayers(sample, lightCount, toCamera, fy, fz, contribution);
  if (!sample.IsObserved()) [[likely]]
    return contribution;
  ReportConnection(sample, lightCount, arriving, weight, factors, joint, flightRatio);
  return contribution;
}

}  // namespace lampyr
