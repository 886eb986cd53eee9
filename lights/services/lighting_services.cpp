#include "lights/services/lighting_services.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "lights/selection/linked_selector.h"
#include "media/surface_tints.h"

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

// The scene's bounding sphere. With an unbounded medium it also holds MediaAround::unboundedHolds and all lights with a
// position.
BoundingSphere SphereAround(const GeometryScene& geometry, const std::vector<PlacedLight>& lights,
                            const MediaAround& media) {
  BoundingSphere sphere = geometry.GetBoundingSphere();
  if (media.unboundedHolds.empty()) return sphere;
  constexpr float kMargin = 1.001f;
  const auto hold = [&sphere](const Point3& point) {
    sphere.radius = std::max(sphere.radius, kMargin * glm::distance(point, sphere.center));
  };
  for (const Point3& point : media.unboundedHolds) hold(point);
  for (const PlacedLight& placed : lights) {
    // Between the keys of a motion the place is on a line.
    const size_t keys = placed.motion ? placed.motion->Keys().size() : 1;
    for (size_t i = 0; i < keys; ++i) {
      const LightTransform transform = placed.motion ? placed.At(placed.motion->TimeOf(i)) : placed.transform;
      LightContext context;
      context.transform = &transform;
      context.scene = geometry.GetBoundingSphere();
      const auto bounds = placed.light->GetEmissionBounds(context);
      if (!bounds || bounds->box.IsEmpty()) continue;
      hold(bounds->box.min);
      hold(bounds->box.max);
    }
  }
  return sphere;
}

// Clamps estimates to the range of float. `power`: of media.
float FluxUnitOf(const std::vector<PlacedLight>& lights, const BoundingSphere& sphere, double power) {
  for (const PlacedLight& placed : lights) {
    LightContext context;
    context.transform = &placed.transform;
    context.scene = sphere;
    const double estimate = static_cast<double>(placed.light->GetPowerEstimate(context).Average());
    if (estimate > 0) power += std::min(estimate, static_cast<double>(std::numeric_limits<float>::max()));
  }
  // Estimates of lights that do emit are 0 where they are below the range of float, or miss a texel.
  if (!(power > 0)) return lights.empty() ? 1.0f : 0x1p-60f;
  return static_cast<float>(std::exp2(std::clamp(std::round(std::log2(power)), -120.0, 120.0)));
}

}  // namespace

LightingServices::SceneLights::SceneLights(const GeometryScene& traced, std::vector<PlacedLight> placed,
                                           LightLinking links, const MediaAround& media)
    : geometry(traced),
      lights(std::move(placed)),
      fronts(lights),
      groups(lights, media.glow),
      sphere(SphereAround(geometry, lights, media)),
      fluxUnit(FluxUnitOf(lights, sphere, media.glowPower)),
      linking(std::move(links)),
      isLinked(linking.Excludes() || linking.HasFilters()) {
  for (uint32_t i = 0; i < lights.size(); ++i) {
    if (fronts[i].kind == LightKind::Infinite) infinite.push_back(i);
    hasLightThatCanBeHit = hasLightThatCanBeHit || CanBeHit(i);
  }
  emissionSelector = MakeEmissionSelector(lights, sphere);
}

LightingServices::LightingServices(const GeometryScene& geometry, std::vector<PlacedLight> lights,
                                   LightSelection selection, LightLinking linking, int mostSamples,
                                   const MediaAround& media)
    : scene_(std::make_shared<const SceneLights>(geometry, std::move(lights), std::move(linking), media)) {
  *this = Selecting(selection, mostSamples);
}

LightingServices LightingServices::Selecting(LightSelection selection, int mostSamples) const {
  LightingServices view = *this;
  view.mostSamples_ = std::clamp(mostSamples, 1, LightChoices::kMost);
  if (selector_ && selection == selection_) return view;
  view.selection_ = selection;
  const LightLinking& linking = scene_->linking;
  view.selector_ = linking.Excludes() ? MakeLinkedSelector(selection, scene_->lights, scene_->sphere, linking.Sets())
                                      : MakeLightSelector(selection, scene_->lights, scene_->sphere);
  return view;
}

LightingServices LightingServices::With(LightLearning* learning, const EmissionGuide* guide, bool isTrial) const {
  LightingServices view = *this;
  view.learning_ = learning;
  view.isTrial_ = isTrial;
  view.guide_ = guide;
  return view;
}

namespace {

// a / b by channel. Where b is too small or negative, as in saturated colours: the quotient of the largest channel.
Color Quotient(const Color& a, const Color& b) {
  constexpr float kSmall = 1e-3f;
  const float largest = b.Max();
  if (!(largest > 0)) return Color(0.0f);
  const float usual = largest == b.r ? a.r / b.r : largest == b.g ? a.g / b.g : a.b / b.b;
  const auto divide = [&](float x, float y) { return y > kSmall * largest ? x / y : usual; };
  return {divide(a.r, b.r), divide(a.g, b.g), divide(a.b, b.b)};
}

}  // namespace

LightingServices LightingServices::AtWavelengths(std::shared_ptr<const Wavelengths> wavelengths) const {
  LightingServices view = *this;
  view.ownSpectra_.clear();
  for (uint32_t i = 0; i < scene_->lights.size(); ++i) {
    const std::vector<LightSpectrum>& spectra = scene_->lights[i].light->Settings().spectra;
    if (spectra.empty()) continue;
    OwnSpectra& all = view.ownSpectra_.emplace_back(OwnSpectra{i, Color(1.0f), Color(1.0f)});
    for (const LightSpectrum& spectrum : spectra) {
      all.color *= spectrum.color;
      all.own *= wavelengths->At(*spectrum.curve);
    }
  }
  view.wavelengths_ = std::move(wavelengths);
  return view;
}

// The other factors of an emission, such as a texture or a tint, are colours: their product is upsampled.
Color LightingServices::Tuned(uint32_t light, const Color& emitted) const {
  const auto found = std::lower_bound(ownSpectra_.begin(), ownSpectra_.end(), light,
                                      [](const OwnSpectra& a, uint32_t b) { return a.light < b; });
  if (found == ownSpectra_.end() || found->light != light) return wavelengths_->FromRgb(emitted);
  return wavelengths_->FromRgb(Quotient(emitted, found->color)) * found->own;
}

LightContext LightingServices::Context(uint32_t light, float time, bool bidirectional,
                                       std::optional<LightTransform>& moved) const {
  const LightFront front = scene_->fronts[light];
  LightContext context;
  context.transform = &scene_->lights[front.place].transform;
  if (front.moves) [[unlikely]]
    context.transform = &moved.emplace(scene_->lights[light].At(time));
  context.scene = scene_->sphere;
  context.time = time;
  context.bidirectional = bidirectional;
  return context;
}

PdfArea LightingServices::EmissionDensity(const LightContext& context, uint32_t light, int patch, PdfArea given) const {
  return context.patch == kAnyPatch ? given : scene_->fronts[light].light->PatchProbability(patch) * given;
}

DirectSample LightingServices::GenerateSamples(const Receiver& receiver, const SelectedLight& selected, const Point2& u,
                                               float time, bool bidirectional) const {
  const LightFront front = scene_->fronts[selected.light];
  std::optional<LightTransform> moved;
  LightContext context = Context(selected.light, time, bidirectional, moved);
  context.u = u;
  context.patch = selected.patch;
  SetReceiver(receiver, context);
  DirectSample direct{
      selected.light,
      IsDelta(front.kind) || !front.canBeHit,
      lampyr::IsAtInfinity(front.kind),
      selected.patch,
      selected.probability,
      Reaches(selected.light, receiver) ? front.light->GenerateSamples(context, receiver.position) : std::nullopt};
  if (direct.sample) Tune(selected.light, *direct.sample);
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

void LightingServices::RecordResult(const Receiver& receiver, const DirectSample& direct, const Color& arrived) const {
  if (direct.selection.IsZero()) return;
  double irradiance = 0;
  if (direct && !arrived.IsBlack()) {
    const LightSample& sample = *direct.sample;
    const float cosine = receiver.HasNormal() ? AbsDot(sample.direction, receiver.normal) : 1.0f;
    // Both parts hold the radiance of a light; a multiplier may have set one of them to 0.
    const float radiance = std::max((sample.diffuse * arrived).Average(), (sample.specular * arrived).Average());
    irradiance = static_cast<double>(radiance * cosine / sample.pdfDirect.value);
  }
  selector_->Record(*learning_, receiver, Selection(), direct.light, direct.patch, irradiance);
}

LightingServices::Selections LightingServices::SelectionsOf(const Receiver& receiver,
                                                            const DirectSample& direct) const {
  if (!learning_) return {PdfDiscrete(0), PdfDiscrete(0)};
  const auto of = [&](const LightLearning* learned) {
    return selector_->Probability(receiver, {learned, mostSamples_}, direct.light, direct.patch);
  };
  return {isTrial_ ? of(learning_) : direct.selection, isTrial_ ? direct.selection : of(nullptr)};
}

// Distance before a sample within which a ray from `from` may hit the sample's own surface.
Vector3 LightingServices::ErrorOfEnd(const SurfacePoint& from, const DirectSample& direct, float time) const {
  const LightSample& sample = *direct.sample;
  if (!scene_->fronts[direct.light].isInstance) [[likely]]
    return sample.positionError;
  const PlacedLight& placed = scene_->lights[direct.light];
  const LightTransform transform = placed.motion ? placed.At(time) : placed.transform;
  const Point3 reach = glm::max(Abs(from.position), Abs(sample.position));
  return sample.positionError + InstanceRayError(transform.toRender, transform.toLocal, reach);
}

Ray LightingServices::ShadowRay(const SurfacePoint& from, const DirectSample& direct, float time) const {
  const LightSample& sample = *direct.sample;
  return direct.isInfinite ? SpawnRay(from, sample.direction, time)
                           : SpawnRayTo(from, sample.position, ErrorOfEnd(from, direct, time), sample.normal, time);
}

Color LightingServices::Transmittance(const SurfacePoint& from, const DirectSample& direct, float time) const {
  const Ray ray = ShadowRay(from, direct, time);
  return wavelengths_ ? TransmittanceAt(*wavelengths_, scene_->geometry, ray, visibility::kShadow)
                      : scene_->geometry.Transmittance(ray, visibility::kShadow);
}

std::optional<FoundLight> LightingServices::EvaluateSamples(const Receiver& receiver, const Vector3& direction,
                                                            float distance, const SurfacePoint& point, float time,
                                                            bool bidirectional) const {
  const int32_t index = scene_->geometry.LightAt(point.primitive, point.instance);
  if (index < 0) return std::nullopt;
  const auto light = static_cast<uint32_t>(index);
  if (!Reaches(light, receiver)) return std::nullopt;
  std::optional<LightTransform> moved;
  LightContext context = Context(light, time, bidirectional, moved);
  const LightHit hit = SurfaceLightHit(direction, distance, point);
  if (selector_->SelectsPatches(receiver)) context.patch = hit.patchIndex;
  auto evaluation = scene_->fronts[light].light->EvaluateSamples(context, hit, receiver.position);
  if (evaluation) Tune(light, *evaluation);
  if (!evaluation || !Filter(light, receiver, direction, distance, time, *evaluation)) return std::nullopt;
  if (bidirectional) {
    evaluation->pdfEmit = EmissionDensity(context, light, hit.patchIndex, evaluation->pdfEmit);
    Aim(light, hit.position, -direction, *evaluation);
  }
  return FoundLight{light, selector_->Probability(receiver, Selection(), light, context.patch), *evaluation,
                    context.patch};
}

std::optional<FoundLight> LightingServices::EvaluateEscaped(size_t i, const Receiver& receiver,
                                                            const Vector3& direction, float time,
                                                            bool bidirectional) const {
  const uint32_t light = scene_->infinite[i];
  if (!Reaches(light, receiver)) return std::nullopt;
  const LightHit hit = EscapedHit(receiver.position, direction);
  std::optional<LightTransform> moved;
  LightContext context = Context(light, time, bidirectional, moved);
  SetReceiver(receiver, context);
  auto evaluation = scene_->fronts[light].light->EvaluateSamples(context, hit, receiver.position);
  if (evaluation) Tune(light, *evaluation);
  if (!evaluation || !Filter(light, receiver, direction, kInfinity, time, *evaluation)) return std::nullopt;
  if (bidirectional) Aim(light, receiver.position, -direction, *evaluation);
  return FoundLight{light, selector_->Probability(receiver, Selection(), light, kAnyPatch), *evaluation};
}

bool LightingServices::RunFilter(uint32_t light, const Receiver& receiver, const Vector3& toLight, float distance,
                                 float time, PdfSolidAngle pdfDirect, Color& diffuse, Color& specular) const {
  if (receiver.link == Receiver::kCamera) return true;
  const FilterInstance& root = scene_->linking.Filters()[static_cast<size_t>(scene_->lights[light].filter)];
  const FilterContext context{time, scene_->linking.EnabledFilters(receiver.link)};
  if (context.IsEnabled(root)) {
    if (!wavelengths_) [[likely]] {
      root.filter->Filter(context, {1, &receiver.position, &toLight, &distance, &pdfDirect, &diffuse, &specular});
    } else {
      // The factors of the filter are colours in Rec. 709.
      Color ofDiffuse(1.0f), ofSpecular(1.0f);
      root.filter->Filter(context, {1, &receiver.position, &toLight, &distance, &pdfDirect, &ofDiffuse, &ofSpecular});
      diffuse *= wavelengths_->FromRgb(ofDiffuse);
      specular *= wavelengths_->FromRgb(ofSpecular);
    }
  }
  return !diffuse.IsBlack() || !specular.IsBlack();
}

Color LightingServices::EmissionForCamera(const Vector3& direction, float distance, const SurfacePoint& point,
                                          float time) const {
  const int32_t index = scene_->geometry.LightAt(point.primitive, point.instance);
  if (index < 0) return Color(0.0f);
  const auto light = static_cast<uint32_t>(index);
  std::optional<LightTransform> moved;
  const Color emitted = scene_->fronts[light].light->EvaluateEmissionForCamera(
      Context(light, time, false, moved), SurfaceLightHit(direction, distance, point));
  return wavelengths_ ? Tuned(light, emitted) : emitted;
}

Color LightingServices::EscapedEmissionForCamera(size_t i, const Ray& ray) const {
  const uint32_t light = scene_->infinite[i];
  if (!scene_->fronts[light].light->Settings().cameraVisible) return Color(0.0f);
  const LightHit hit = EscapedHit(ray.origin, ray.direction);
  std::optional<LightTransform> moved;
  const Color emitted =
      scene_->fronts[light].light->EvaluateEmissionForCamera(Context(light, ray.time, false, moved), hit);
  return wavelengths_ ? Tuned(light, emitted) : emitted;
}

PdfDiscrete LightingServices::SelectionProbability(const Receiver& receiver, uint32_t light, int patch) const {
  return selector_->Probability(receiver, Selection(), light, patch);
}

}  // namespace lampyr
