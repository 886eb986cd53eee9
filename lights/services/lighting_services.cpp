#include "lights/services/lighting_services.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "lights/selection/linked_selector.h"

namespace lampyr {

namespace {

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

LightHit EscapedHit(const Point3& origin, const Vector3& direction) {
  LightHit hit;
  hit.direction = direction;
  hit.position = origin;
  return hit;
}

// Estimates that left float are its ends.
float FluxUnitOf(const std::vector<PlacedLight>& lights, const BoundingSphere& sphere) {
  double power = 0;
  for (const PlacedLight& placed : lights) {
    LightContext context;
    context.transform = &placed.transform;
    context.scene = sphere;
    const double estimate = static_cast<double>(placed.light->GetPowerEstimate(context).Average());
    if (estimate > 0) power += std::min(estimate, static_cast<double>(std::numeric_limits<float>::max()));
  }
  if (!(power > 0)) return 1;
  return static_cast<float>(std::exp2(std::clamp(std::round(std::log2(power)), -120.0, 120.0)));
}

}  // namespace

LightingServices::LightingServices(const GeometryScene& geometry, std::vector<PlacedLight> lights,
                                   LightSelection selection, LightLinking linking)
    : geometry_(geometry),
      lights_(std::move(lights)),
      fronts_(lights_),
      groups_(lights_),
      sphere_(geometry.GetBoundingSphere()),
      fluxUnit_(FluxUnitOf(lights_, sphere_)),
      linking_(std::move(linking)),
      isLinked_(linking_.Excludes() || linking_.HasFilters()) {
  for (uint32_t i = 0; i < lights_.size(); ++i) {
    if (fronts_[i].kind == LightKind::Infinite) infinite_.push_back(i);
  }
  selector_ = linking_.Excludes() ? MakeLinkedSelector(selection, lights_, sphere_, linking_.Sets())
                                  : MakeLightSelector(selection, lights_, sphere_);
  emissionSelector_ = MakeEmissionSelector(lights_, sphere_);
}

bool LightingServices::HasLightThatCanBeHit() const {
  for (uint32_t light = 0; light < fronts_.Size(); ++light) {
    if (CanBeHit(light)) return true;
  }
  return false;
}

LightContext LightingServices::Context(uint32_t light, float time, bool bidirectional,
                                       std::optional<LightTransform>& moved) const {
  const LightFront front = fronts_[light];
  LightContext context;
  context.transform = &lights_[front.place].transform;
  if (front.moves) [[unlikely]]
    context.transform = &moved.emplace(lights_[light].At(time));
  context.scene = sphere_;
  context.time = time;
  context.bidirectional = bidirectional;
  return context;
}

PdfArea LightingServices::EmissionDensity(const LightContext& context, uint32_t light, int patch, PdfArea given) const {
  return context.patch == kAnyPatch ? given : fronts_[light].light->PatchProbability(patch) * given;
}

DirectSample LightingServices::GenerateSamples(const Receiver& receiver, const SelectedLight& selected, const Point2& u,
                                               float time, bool bidirectional) const {
  const LightFront front = fronts_[selected.light];
  std::optional<LightTransform> moved;
  LightContext context = Context(selected.light, time, bidirectional, moved);
  context.u = u;
  context.patch = selected.patch;
  DirectSample direct{
      selected.light,
      IsDelta(front.kind) || !front.canBeHit,
      lampyr::IsAtInfinity(front.kind),
      selected.patch,
      selected.probability,
      Reaches(selected.light, receiver) ? front.light->GenerateSamples(context, receiver.position) : std::nullopt};
  if (direct.sample &&
      !Filter(selected.light, receiver, direct.sample->direction, direct.sample->distance, time, *direct.sample)) {
    direct.sample.reset();
  }
  if (bidirectional && direct.sample) {
    LightSample& sample = *direct.sample;
    sample.pdfEmit = EmissionDensity(context, selected.light, sample.patchIndex, sample.pdfEmit);
    Aim(selected.light, direct.isInfinite ? receiver.position : sample.position, -sample.direction, sample);
  }
  return direct;
}

void LightingServices::Use(LightLearning* learning) {
  learning_ = learning;
  selector_->Use(learning);
}

void LightingServices::RecordResult(const Receiver& receiver, const DirectSample& direct, const Color& arrived) const {
  if (direct.selection.IsZero()) return;
  double irradiance = 0;
  if (direct && !arrived.IsBlack()) {
    const LightSample& sample = *direct.sample;
    const bool hasNormal = LengthSquared(receiver.normal) > 0;
    const float cosine = hasNormal ? AbsDot(sample.direction, receiver.normal) : 1.0f;
    // A light carries its radiance in both; a multiplier may have put out one of them.
    const float radiance = std::max((sample.diffuse * arrived).Average(), (sample.specular * arrived).Average());
    irradiance = static_cast<double>(radiance * cosine / sample.pdfDirect.value);
  }
  selector_->Record(receiver, direct.light, direct.patch, irradiance);
}

// How far in front of a sample its own surface may be met by a ray from `from`.
Vector3 LightingServices::ErrorOfEnd(const SurfacePoint& from, const DirectSample& direct, float time) const {
  const LightSample& sample = *direct.sample;
  if (!fronts_[direct.light].isInstance) [[likely]]
    return sample.positionError;
  const PlacedLight& placed = lights_[direct.light];
  const LightTransform transform = placed.motion ? placed.At(time) : placed.transform;
  const Point3 reach = glm::max(glm::abs(from.position), glm::abs(sample.position));
  return sample.positionError + InstanceRayError(transform.toRender, transform.toLocal, reach);
}

Color LightingServices::Transmission(const SurfacePoint& from, const DirectSample& direct, float time) const {
  const LightSample& sample = *direct.sample;
  const Ray ray = direct.isInfinite
                      ? SpawnRay(from, sample.direction, time)
                      : SpawnRayTo(from, sample.position, ErrorOfEnd(from, direct, time), sample.normal, time);
  return geometry_.Transmission(ray, visibility::kShadow);
}

std::optional<FoundLight> LightingServices::EvaluateSamples(const Receiver& receiver, const Vector3& direction,
                                                            float distance, const SurfacePoint& point, float time,
                                                            bool bidirectional) const {
  const int32_t index = geometry_.LightAt(point.primitive, point.instance);
  if (index < 0) return std::nullopt;
  const auto light = static_cast<uint32_t>(index);
  if (!Reaches(light, receiver)) return std::nullopt;
  std::optional<LightTransform> moved;
  LightContext context = Context(light, time, bidirectional, moved);
  const LightHit hit = SurfaceLightHit(direction, distance, point);
  if (selector_->SelectsPatches(receiver)) context.patch = hit.patchIndex;
  auto evaluation = fronts_[light].light->EvaluateSamples(context, hit, receiver.position);
  if (!evaluation || !Filter(light, receiver, direction, distance, time, *evaluation)) return std::nullopt;
  if (bidirectional) {
    evaluation->pdfEmit = EmissionDensity(context, light, hit.patchIndex, evaluation->pdfEmit);
    Aim(light, hit.position, -direction, *evaluation);
  }
  return FoundLight{light, selector_->Probability(receiver, light, context.patch), *evaluation};
}

std::optional<FoundLight> LightingServices::EvaluateEscaped(size_t i, const Receiver& receiver,
                                                            const Vector3& direction, float time,
                                                            bool bidirectional) const {
  const uint32_t light = infinite_[i];
  if (!Reaches(light, receiver)) return std::nullopt;
  const LightHit hit = EscapedHit(receiver.position, direction);
  std::optional<LightTransform> moved;
  const LightContext context = Context(light, time, bidirectional, moved);
  auto evaluation = fronts_[light].light->EvaluateSamples(context, hit, receiver.position);
  if (!evaluation || !Filter(light, receiver, direction, kInfinity, time, *evaluation)) return std::nullopt;
  if (bidirectional) Aim(light, receiver.position, -direction, *evaluation);
  return FoundLight{light, selector_->Probability(receiver, light, kAnyPatch), *evaluation};
}

bool LightingServices::RunFilter(uint32_t light, const Receiver& receiver, const Vector3& toLight, float distance,
                                 float time, PdfSolidAngle pdfDirect, Color& diffuse, Color& specular) const {
  if (receiver.link == Receiver::kCamera) return true;
  const FilterInstance& root = linking_.Filters()[static_cast<size_t>(lights_[light].filter)];
  const FilterContext context{time, linking_.EnabledFilters(receiver.link)};
  if (context.IsEnabled(root)) {
    root.filter->Filter(context, {1, &receiver.position, &toLight, &distance, &pdfDirect, &diffuse, &specular});
  }
  return !diffuse.IsBlack() || !specular.IsBlack();
}

Color LightingServices::EmissionForCamera(const Vector3& direction, float distance, const SurfacePoint& point,
                                          float time) const {
  const int32_t index = geometry_.LightAt(point.primitive, point.instance);
  if (index < 0) return Color(0.0f);
  const auto light = static_cast<uint32_t>(index);
  std::optional<LightTransform> moved;
  return fronts_[light].light->EvaluateEmissionForCamera(Context(light, time, false, moved),
                                                         SurfaceLightHit(direction, distance, point));
}

Color LightingServices::EscapedEmissionForCamera(size_t i, const Ray& ray) const {
  const uint32_t light = infinite_[i];
  if (!fronts_[light].light->Settings().cameraVisible) return Color(0.0f);
  const LightHit hit = EscapedHit(ray.origin, ray.direction);
  std::optional<LightTransform> moved;
  return fronts_[light].light->EvaluateEmissionForCamera(Context(light, ray.time, false, moved), hit);
}

PdfDiscrete LightingServices::SelectionProbability(const Receiver& receiver, uint32_t light, int patch) const {
  return selector_->Probability(receiver, light, patch);
}

}  // namespace lampyr
