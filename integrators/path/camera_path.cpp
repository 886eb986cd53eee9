#include "integrators/path/camera_path.h"

#include "integrators/walk/lens.h"
#include "integrators/walk/partial_weight.h"

namespace lampyr {

namespace {

class CameraPath final : public PathVisitor, NextEventVisitor {
 public:
  CameraPath(const SampleContext& context, const CameraPathSettings& settings, PhotonGatherer* gatherer)
      : context_(context),
        lighting_(*context.scene.lighting),
        settings_(settings),
        nextEvent_{settings.dimensions, false, settings.shadowRays},
        gatherer_(gatherer) {}

  void Escaped(const Subpath& path, const PathState& state) override {
    if (path.Count() == 0) {
      radiance_ += EscapedEmissionForCamera(context_, state.ray, state.specular);
      return;
    }
    for (size_t i = 0; i < lighting_.InfiniteCount(); ++i) {
      const auto found = lighting_.EvaluateEscaped(i, path.Last().receiver, state.ray.direction, context_.time, false);
      if (found) AddFound(path.Last(), state, *found);
    }
  }

  bool Met(const Subpath& path, const PathState& state, const RayHit& hit, const SurfacePoint& point,
           bool isLight) override {
    if (isLight && path.Count() == 0) {
      const Color seen = state.specular * lighting_.EmissionForCamera(state.ray.direction, hit.t, point, context_.time);
      if (context_.layers) context_.layers->Add(lighting_.GroupAt(point), seen);
      radiance_ += seen;
    } else if (isLight) {
      const Receiver& receiver = path.Last().receiver;
      const float distance = glm::distance(point.position, receiver.position);
      const auto found =
          lighting_.EvaluateSamples(receiver, state.ray.direction, distance, point, context_.time, false);
      if (found) AddFound(path.Last(), state, *found);
    }
    return !emissionOnly_;
  }

  void Glowed(const Subpath&, const Color& throughput, const Color& radiance) override {
    const Color seen = throughput * radiance;
    if (context_.layers) context_.layers->Add(lighting_.Groups().OfMedia(), seen);
    radiance_ += seen;
  }

  // Light that is scattered on the way to a surface whose emission alone is wanted is gathered.
  bool Collided(const Subpath&, const PathState&) override { return !emissionOnly_; }

  bool Arrived(Subpath& path, const PathState& state) override {
    const PathVertex& vertex = path.Last();
    if (vertex.isDelta) return true;
    const auto events = static_cast<int>(path.Count());
    const bool gathers = gatherer_ && vertex.GathersPhotons();
    if (gathers) gatherer_->Find(vertex, state.length);
    if (SamplesLights(vertex))
      radiance_ += SampleDirectLight(context_, nextEvent_, vertex, events - 1, radiance_, *this);
    if (gathers) radiance_ += gatherer_->Gather(vertex, events, state.length);
    return true;
  }

  // Directions from which photons are gathered are still traced for the emission of the surface they hit, and of the
  // media on the way: next-event estimation alone would miss a panel that touches the floor, and misses all media.
  bool Scattered(const Subpath& path, const PathState& state) override {
    emissionOnly_ = !path.Last().scatteredDelta && path.Last().GathersPhotons() &&
                    state.pdfDirection.value <= static_cast<double>(settings_.gatherBelow);
    return !emissionOnly_ || (settings_.samplesLights && HasEmissionToFind());
  }

  const Color& Radiance() const { return radiance_; }

 private:
  bool SamplesLights(const PathVertex& vertex) const { return settings_.samplesLights || !vertex.GathersPhotons(); }

  bool HasEmissionToFind() const { return lighting_.HasLightThatCanBeHit() || settings_.mediaGlow; }

  // A light found by BSDF sampling, weighted against next-event estimation.
  void AddFound(const PathVertex& last, const PathState& state, const FoundLight& found) {
    Color radiance = state.diffuse * found.evaluation.diffuse + state.specular * found.evaluation.specular;
    if (!last.scatteredDelta && SamplesLights(last)) {
      const PdfSolidAngle direction(static_cast<float>(state.pdfDirection.value * state.factors.forward));
      radiance *= PowerHeuristic(direction, found.selection * found.evaluation.pdfDirect);
    }
    if (context_.layers) context_.layers->Add(lighting_.GroupOf(found.light), radiance);
    radiance_ += radiance;
  }

  float Weigh(const LightConnection& light) override {
    if (light.direct.isDelta) return 1;
    return PowerHeuristic(light.direct.selection * light.direct.sample->pdfDirect,
                          static_cast<float>(light.factors.forward) * light.f.pdfForward);
  }
  void Arrived(const LightConnection& light, const Color&, const Color& contribution) override {
    if (context_.layers) context_.layers->Add(lighting_.GroupOf(light.direct.light), contribution);
  }

  const SampleContext& context_;
  const LightingServices& lighting_;
  const CameraPathSettings& settings_;
  const NextEventSettings nextEvent_;
  PhotonGatherer* gatherer_;
  bool emissionOnly_ = false;  // the ray is traced for emission alone: other light from there is gathered
  Color radiance_;
};

}  // namespace

Color TraceCameraPath(const SampleContext& context, const CameraPathSettings& settings, const Ray& ray,
                      PhotonGatherer* gatherer) {
  thread_local Subpath path(false);
  path.Clear();
  PathState state;
  state.ray = ray;
  state.medium = context.scene.cameraMedium;
  state.specular = Color(1.0f);
  CameraPath visitor(context, settings, gatherer);
  Walk(context, {TransportMode::Radiance, settings.maxDepth, settings.dimensions, true, settings.materialsAfterWide},
       state, path, visitor);
  return visitor.Radiance();
}

}  // namespace lampyr
