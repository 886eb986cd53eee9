#include "lights/services/lighting_services.h"

namespace lampyr {

namespace {

bool IsDeltaKind(LightKind kind) {
  return kind == LightKind::DeltaPosition || kind == LightKind::DeltaDirection;
}
bool IsInfiniteKind(LightKind kind) {
  return kind == LightKind::Infinite || kind == LightKind::DeltaDirection;
}

LightHit SurfaceLightHit(const Vector3& direction, float distance, const SurfacePoint& point) {
  LightHit hit;
  hit.direction = direction;
  hit.distance = distance;
  hit.position = point.position;
  hit.normal = point.Ng;
  hit.uv = point.uv;
  hit.patchIndex = static_cast<int>(point.patch);
  return hit;
}

}  // namespace

LightingServices::LightingServices(const GeometryScene& geometry, std::vector<PlacedLight> lights,
                                   LightSelection selection)
    : geometry_(geometry), lights_(std::move(lights)), sphere_(geometry.GetBoundingSphere()) {
  for (uint32_t i = 0; i < lights_.size(); ++i) {
    kinds_.push_back(lights_[i].light->Kind());
    if (kinds_.back() == LightKind::Infinite) infinite_.push_back(i);
  }
  selector_ = MakeLightSelector(selection, lights_, sphere_);
  emissionSelector_ = MakeEmissionSelector(lights_, sphere_);
}

LightContext LightingServices::Context(uint32_t light, float time, bool bidirectional) const {
  LightContext context;
  context.transform = &lights_[light].transform;
  context.scene = sphere_;
  context.time = time;
  context.bidirectional = bidirectional;
  return context;
}

DirectSample LightingServices::GenerateSamples(const Receiver& receiver, float uSelect, const Point2& u, float time,
                                               bool bidirectional) const {
  const std::optional<SelectedLight> selected = selector_->Select(receiver, uSelect);
  if (!selected) return {};
  const PlacedLight& placed = lights_[selected->light];
  const LightKind kind = kinds_[selected->light];
  LightContext context = Context(selected->light, time, bidirectional);
  context.u = u;
  context.patch = selected->patch;
  return {selected->light, IsDeltaKind(kind) || !placed.canBeHit, IsInfiniteKind(kind), selected->probability,
          placed.light->GenerateSamples(context, receiver.position)};
}

Color LightingServices::Transmission(const SurfacePoint& from, const DirectSample& direct, float time) const {
  const LightSample& sample = *direct.sample;
  const Ray ray = direct.isInfinite ? SpawnRay(from, sample.direction, time)
                                    : SpawnRayTo(from, sample.position, sample.positionError, sample.normal, time);
  return geometry_.Occluded(ray, visibility::kShadow) ? Color(0.0f) : Color(1.0f);
}

std::optional<FoundLight> LightingServices::EvaluateSamples(const Receiver& receiver, const Vector3& direction,
                                                            float distance, const SurfacePoint& point, float time,
                                                            bool bidirectional) const {
  const int32_t index = geometry_.LightAt(point.primitive, point.instance);
  if (index < 0) return std::nullopt;
  const auto light = static_cast<uint32_t>(index);
  LightContext context = Context(light, time, bidirectional);
  const LightHit hit = SurfaceLightHit(direction, distance, point);
  if (selector_->SelectsPatches()) context.patch = hit.patchIndex;
  const auto evaluation = lights_[light].light->EvaluateSamples(context, hit, receiver.position);
  if (!evaluation) return std::nullopt;
  return FoundLight{light, selector_->Probability(receiver, light, context.patch), *evaluation};
}

std::optional<FoundLight> LightingServices::EvaluateEscaped(size_t i, const Receiver& receiver,
                                                            const Vector3& direction, float time,
                                                            bool bidirectional) const {
  const uint32_t light = infinite_[i];
  LightHit hit;
  hit.direction = direction;
  const auto evaluation =
      lights_[light].light->EvaluateSamples(Context(light, time, bidirectional), hit, receiver.position);
  if (!evaluation) return std::nullopt;
  return FoundLight{light, selector_->Probability(receiver, light, kAnyPatch), *evaluation};
}

Color LightingServices::EmissionForCamera(const Vector3& direction, float distance, const SurfacePoint& point,
                                          float time) const {
  const int32_t index = geometry_.LightAt(point.primitive, point.instance);
  if (index < 0) return Color(0.0f);
  const auto light = static_cast<uint32_t>(index);
  return lights_[light].light->EvaluateEmissionForCamera(Context(light, time, false),
                                                         SurfaceLightHit(direction, distance, point));
}

Color LightingServices::EscapedEmissionForCamera(const Vector3& direction, float time) const {
  Color sum;
  for (const uint32_t light : infinite_) {
    LightHit hit;
    hit.direction = direction;
    if (!lights_[light].light->Settings().cameraVisible) continue;
    sum += lights_[light].light->EvaluateEmissionForCamera(Context(light, time, false), hit);
  }
  return sum;
}

std::optional<EmittedPhoton> LightingServices::GenerateEmission(float uSelect, const Point2& u,
                                                                const Point2& uDirection, float time) const {
  const std::optional<SelectedLight> selected = emissionSelector_->Select({}, uSelect);
  if (!selected) return std::nullopt;
  LightContext context = Context(selected->light, time, true);
  context.u = u;
  context.uDirection = uDirection;
  const std::optional<EmissionSample> emission = lights_[selected->light].light->GenerateEmission(context);
  if (!emission) return std::nullopt;
  EmittedPhoton photon{selected->light, selected->probability, *emission, std::nullopt, {}};
  const bool fromSurface = kinds_[selected->light] == LightKind::Area;
  photon.ray.origin =
      fromSurface ? OffsetRayOrigin(emission->position, emission->positionError, emission->normal, emission->direction)
                  : emission->position;
  photon.ray.direction = emission->direction;
  photon.ray.time = time;
  RayHit hit;
  if (geometry_.Intersect(photon.ray, visibility::kIndirect, hit)) photon.landing = hit;
  return photon;
}

std::optional<FoundLight> LightingServices::EvaluateLanding(const EmittedPhoton& photon,
                                                            const Receiver& receiver) const {
  LightHit hit;
  hit.direction = -photon.emission.direction;
  hit.position = photon.emission.position;
  hit.distance = glm::distance(photon.emission.position, receiver.position);
  hit.normal = photon.emission.normal;
  hit.uv = Point2(photon.emission.uvw.x, photon.emission.uvw.y);
  hit.patchIndex = photon.emission.patchIndex;
  LightContext context = Context(photon.light, photon.ray.time, true);
  if (selector_->SelectsPatches()) context.patch = hit.patchIndex;
  const auto evaluation = lights_[photon.light].light->EvaluateSamples(context, hit, receiver.position);
  if (!evaluation) return std::nullopt;
  return FoundLight{photon.light, selector_->Probability(receiver, photon.light, context.patch), *evaluation};
}

PdfDiscrete LightingServices::SelectionProbability(const Receiver& receiver, uint32_t light, int patch) const {
  return selector_->Probability(receiver, light, patch);
}

PdfDiscrete LightingServices::EmissionSelectionProbability(uint32_t light) const {
  return emissionSelector_->Probability({}, light, kAnyPatch);
}

}  // namespace lampyr
