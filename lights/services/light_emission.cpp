// Emission of photons, guided or not, and the evaluation of their origin for next-event estimation at their first hit.
#include "lights/services/lighting_services.h"

namespace lampyr {

namespace {

// The evaluation of a photon's origin on a delta light: the values of the photon, with the inverse-square falloff of
// the light's samples.
LightEvaluation DeltaFirstHit(const EmissionSample& emission, LightKind kind, float distanceSquared) {
  LightEvaluation evaluation;
  const float falloff = kind == LightKind::DeltaPosition ? 1 / distanceSquared : 1.0f;
  evaluation.normal = kind == LightKind::DeltaPosition ? Normal3(0.0f) : emission.direction;
  evaluation.diffuse = emission.diffuse * falloff;
  evaluation.specular = emission.specular * falloff;
  evaluation.pdfDirect = PdfSolidAngle(1);
  evaluation.pdfEmit = emission.pdfEmit;
  evaluation.pdfEmitDirection = emission.pdfEmitDirection;
  evaluation.solidAngleToArea = 1;
  return evaluation;
}

LightHit HitOf(const EmissionSample& emission, LightKind kind, const Vector3& direction, const Point3& P) {
  LightHit hit;
  hit.direction = -direction;
  hit.position = P;
  if (kind != LightKind::Area) return hit;
  hit.position = emission.position;
  hit.distance = glm::distance(P, emission.position);
  hit.normal = emission.normal;
  hit.uv = Point2(emission.uvw.x, emission.uvw.y);
  hit.patchIndex = emission.patchIndex;
  return hit;
}

// Intensity and densities of a point light, from its sample seen from P.
std::optional<EmissionSample> EmissionOfPoint(const LightSample& seen) {
  EmissionSample sample;
  const float squared = Sqr(seen.distance);
  sample.position = seen.position;
  sample.positionError = seen.positionError;
  sample.diffuse = seen.diffuse * squared;
  sample.specular = seen.specular * squared;
  sample.pdfEmit = seen.pdfEmit;
  sample.pdfEmitDirection = seen.pdfEmitDirection;
  return sample;
}

// Offsets the origin from the surface that the photon leaves. A point light is offset from surfaces that it touches up
// to rounding, as shadow rays are: a point in the plane of a floor does not light it.
Point3 OriginOf(const EmissionSample& emission, LightKind kind) {
  if (IsAtInfinity(kind)) return emission.position;
  if (kind == LightKind::Area)
    return OffsetRayOrigin(emission.position, emission.positionError, emission.normal, emission.direction);
  constexpr float kLeast = 1e-30f;  // a point light at the coordinate origin has no rounding error
  return OffsetRayOrigin(emission.position, emission.positionError + Vector3(kLeast), emission.direction,
                         emission.direction);
}

}  // namespace

// Keeps the sampled position, or direction of a light at infinity, and aims the other at a component of the guide.
std::optional<EmissionSample> LightingServices::EmitAimed(const LightContext& context,
                                                          const EmissionGuide::Choice& choice) const {
  const Light& light = *scene_->fronts[choice.light].light;
  const LightKind kind = light.Kind();
  std::optional<EmissionSample> emission = light.GenerateEmission(context);
  if (IsAtInfinity(choice.light)) {
    if (!emission) return std::nullopt;
    const Vector3& direction = emission->direction;
    const Vector3 offset = guide_->SampleLine(choice, direction, context.uDirection) - scene_->sphere.center;
    emission->position =
        scene_->sphere.center + offset - (glm::dot(offset, direction) + scene_->sphere.radius) * direction;
    if (guide_->LineDensity(choice.light, emission->position, direction).IsZero()) return std::nullopt;
    return emission;
  }
  if (kind == LightKind::DeltaPosition && !emission) {
    // The unguided direction was dark.
    const auto bounds = light.GetEmissionBounds(context);
    if (!bounds) return std::nullopt;
    emission.emplace().position = bounds->box.Center();
  }
  if (!emission) return std::nullopt;
  const Vector3 direction = guide_->SampleDirection(choice, emission->position, context.uDirection);
  // A direction at the rim of a component may be rounded past it, where the aimed density is 0.
  const bool isMissed = guide_->DirectionDensity(choice.light, emission->position, direction).IsZero();
  const Point3 P = emission->position + guide_->Reach(choice, emission->position) * direction;
  if (kind == LightKind::DeltaPosition) {
    const auto seen = light.GenerateSamples(context, P);
    if (!seen || isMissed) return std::nullopt;
    emission = EmissionOfPoint(*seen);
    emission->direction = emission->normal = direction;
    return emission;
  }
  const LightHit hit = HitOf(*emission, kind, direction, P);
  const auto found = light.EvaluateSamples(context, hit, P);
  const LightEvaluation evaluation = found && !isMissed ? *found : LightEvaluation();
  const float opacity = light.Opacity(hit);
  emission->direction = direction;
  emission->emissionCosine = AbsDot(emission->normal, direction);
  emission->diffuse = evaluation.diffuse * opacity;
  emission->specular = evaluation.specular * opacity;
  emission->pdfEmitDirection = evaluation.pdfEmitDirection;
  return emission;
}

std::optional<LightingServices::Emission> LightingServices::Emit(double uSelect, const Point2& u,
                                                                 const Point2& uDirection, float time) const {
  EmissionGuide::Choice choice;
  if (guide_) {
    choice = guide_->Select(uSelect);
    if (!choice.exists) return std::nullopt;
  } else {
    LightChoices choices;
    scene_->emissionSelector->Select({}, uSelect, choices);
    if (choices.count == 0) return std::nullopt;
    choice.light = choices.of[0].light;
    choice.probability = choices.of[0].probability;
  }
  std::optional<LightTransform> moved;
  LightContext context = Context(choice.light, time, true, moved);
  context.u = u;
  context.uDirection = uDirection;
  const Light& light = *scene_->fronts[choice.light].light;
  const auto sample =
      choice.target == EmissionGuide::kNone ? light.GenerateEmission(context) : EmitAimed(context, choice);
  if (!sample) return std::nullopt;
  return Emission{choice.probability, choice.light, *sample};
}

std::optional<EmittedPhoton> LightingServices::GenerateEmission(float uSelect, const Point2& u,
                                                                const Point2& uDirection, float time) const {
  const auto emitted = Emit(MoreBits(uSelect, Point3(u.x, u.y, uDirection.x)), u, uDirection, time);
  if (!emitted) return std::nullopt;
  const LightFront front = scene_->fronts[emitted->light];
  EmittedPhoton photon;
  photon.light = emitted->light;
  photon.emissionSelection = emitted->selection;
  photon.emission = emitted->sample;
  EmissionSample& emission = photon.emission;
  Tune(photon.light, emission);
  photon.pdfUnguided = IsAtInfinity(photon.light) ? emission.pdfEmit.value : emission.pdfEmitDirection.value;
  Aim(photon.light, emission.position, emission.direction, emission);
  const bool fromSurface = front.kind == LightKind::Area;
  photon.fromSurface = fromSurface && front.canBeHit;
  photon.ray.origin = OriginOf(emission, front.kind);
  photon.ray.direction = emission.direction;
  photon.ray.time = time;
  return photon;
}

float LightingServices::EmissionGain(const EmittedPhoton& photon) const {
  if (!guide_) return 1;
  return static_cast<float>(guide_->Gain(photon.light, photon.emission.position, photon.emission.direction,
                                         static_cast<double>(photon.pdfUnguided)));
}

bool LightingServices::IsOrigin(const EmittedPhoton& photon, const SurfacePoint& point, const Vector3& toRay,
                                float distance) const {
  if (scene_->geometry.LightAt(point.primitive, point.instance) != static_cast<int32_t>(photon.light)) return false;
  const EmissionSample& emission = photon.emission;
  // On the same side of the surface, within rounding: a unit direction has an error of 2^-22, which grows along grazing
  // surfaces.
  const float cosine = glm::dot(point.Ng, toRay);
  if (cosine * glm::dot(emission.normal, toRay) < 0) return false;
  // A line passes a side of a triangle, of a bilinear patch and of a quadric once. Distances are not compared there:
  // where a triangle is slender, the rounding of barycentric coordinates moves points along it by much more than their
  // errors. Surfaces of light types (Surface()) may be passed several times.
  constexpr float kSameNormal = 0.999f;
  const bool isOnPatch =
      !scene_->fronts[photon.light].light->Surface() && static_cast<int>(point.patch) == emission.patchIndex;
  if (isOnPatch && glm::dot(point.Ng, emission.normal) > kSameNormal) return true;
  const float error =
      MaxAbsComponent(point.positionError) + MaxAbsComponent(emission.positionError) + 0x1p-20f * distance;
  return glm::distance(point.position, emission.position) * std::abs(cosine) <= 8 * error;
}

std::optional<FoundLight> LightingServices::EvaluateFirstHit(const EmittedPhoton& photon,
                                                             const Receiver& receiver) const {
  const EmissionSample& emission = photon.emission;
  const LightKind kind = scene_->fronts[photon.light].kind;
  std::optional<LightTransform> moved;
  LightContext context = Context(photon.light, photon.ray.time, true, moved);
  SetReceiver(receiver, context);
  if (selector_->SelectsPatches(receiver)) context.patch = emission.patchIndex;
  const PdfDiscrete selection = selector_->Probability(receiver, Selection(), photon.light, context.patch);
  const Vector3 way = receiver.position - emission.position;
  if (IsDelta(kind)) {
    if (!(LengthSquared(way) > 0)) return std::nullopt;
    return FoundLight{photon.light, selection, DeltaFirstHit(emission, kind, LengthSquared(way))};
  }
  const LightHit hit = HitOf(emission, kind, emission.direction, receiver.position);
  auto evaluation = scene_->fronts[photon.light].light->EvaluateSamples(context, hit, receiver.position);
  if (!evaluation) return std::nullopt;
  Tune(photon.light, *evaluation);
  evaluation->pdfEmit = EmissionDensity(context, photon.light, hit.patchIndex, evaluation->pdfEmit);
  Aim(photon.light, emission.position, emission.direction, *evaluation);
  return FoundLight{photon.light, selection, *evaluation};
}

bool LightingServices::LandsFiltered(const EmittedPhoton& photon, const Receiver& receiver, Color& diffuse,
                                     Color& specular) const {
  if (!Reaches(photon.light, receiver)) return false;
  if (scene_->lights[photon.light].filter < 0) return true;
  const std::optional<FoundLight> found = EvaluateFirstHit(photon, receiver);
  if (!found) return false;
  const Point3& start = photon.emission.position;
  const float distance = IsAtInfinity(photon.light) ? kInfinity : glm::distance(receiver.position, start);
  return RunFilter(photon.light, receiver, -photon.emission.direction, distance, photon.ray.time,
                   found->evaluation.pdfDirect, diffuse, specular);
}

PdfDiscrete LightingServices::EmissionSelectionProbability(uint32_t light) const {
  return guide_ ? guide_->Probability(light) : scene_->emissionSelector->Probability({}, light, kAnyPatch);
}

}  // namespace lampyr
