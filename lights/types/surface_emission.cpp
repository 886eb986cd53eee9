#include "lights/types/surface_emission.h"

#include "lights/direction_map.h"

namespace lampyr {

SurfaceEmission::SurfaceEmission(const ParameterList& parameters, const LightBuildContext& build, const Area& area)
    : tint_(ReadLightTint(parameters)),
      normalize_(tint_.normalize),
      alpha_(build.alpha),
      built_(build.transform),
      area_(area),
      quickBuilt_(normalize_ ? area.quick(build.transform) : 0) {}

// Sets the radiance: tinted, and divided by the area if it is normalised. A surface without area emits nothing.
void SurfaceEmission::SetRadiance(const ParameterList& parameters, const Color& radiance) {
  const double divisor = normalize_ ? area_.built : 1.0;
  const Color tinted = radiance * tint_.color;
  const auto divide = [&](float channel) {
    return divisor > 0 ? static_cast<float>(static_cast<double>(channel) / divisor) : 0.0f;
  };
  radiance_ = Color(divide(tinted.r), divide(tinted.g), divide(tinted.b));
  if (!radiance_.IsValid())
    throw Error(parameters.Where(), parameters.Owner() + ": the emitted radiance is not finite");
}

SurfaceEmission SurfaceEmission::ReadDiffuse(const ParameterList& parameters, const LightBuildContext& build,
                                             const Area& area) {
  SurfaceEmission emission(parameters, build, area);
  emission.twoSided_ = parameters.GetBool("twosided", false);
  emission.image_ = EmissionImage(parameters, "filename", build);
  if (emission.HasImage() && parameters.Find("L")) {
    throw Error(parameters.WhereOf("L"), parameters.Owner() + ": both \"L\" and \"filename\" are given, one is enough");
  }
  double scale = parameters.GetFloat("scale", 1);
  const double power = parameters.GetFloat("power", -1);
  if (power > 0) {
    // `power` scales for the power of a surface of radiance 1, or of the image; the magnitude of the colour is kept.
    const double mean = emission.HasImage() ? static_cast<double>(emission.image_.Mean().Luminance()) : 1.0;
    const double emitted = mean * emission.area_.built * static_cast<double>(kPi) * (emission.twoSided_ ? 2 : 1);
    scale = emitted > 0 ? scale * power / emitted : 0.0;
  }
  const Color L = emission.HasImage() ? Color(1.0f) : ReadEmissionColor(parameters, "L");
  emission.SetRadiance(parameters, L * static_cast<float>(scale));
  return emission;
}

SurfaceEmission SurfaceEmission::ReadUsdLux(const ParameterList& parameters, const LightBuildContext& build,
                                            const Area& area, Shaping::Emitter emitter) {
  SurfaceEmission emission(parameters, build, area);
  emission.twoSided_ = parameters.GetBool("twoSided", false);
  emission.image_ = EmissionImage(parameters, "texture:file", build);
  emission.SetRadiance(parameters, Color(1.0f));
  if (auto shaping = Shaping::Read(parameters, build, emitter)) {
    if (!build.shapePlacement.IsAffine())
      throw Error(parameters.Where(), parameters.Owner() + ": shaping cannot follow a perspective transform");
    const LightTransform axes{build.shapePlacement.ToAffine(), build.shapePlacement.Inverse().ToAffine()};
    const bool hasCone = parameters.Find("shaping:cone:angle") || parameters.Find("shaping:cone:softness");
    const bool isBackDark = hasCone && parameters.GetFloat("shaping:cone:angle", 90) <= 90;
    emission.shaped_ = std::make_shared<const ShapedDirections>(std::move(shaping), emitter, emission.twoSided_,
                                                                isBackDark, axes, build.transform);
  }
  return emission;
}

float SurfaceEmission::NormalizedStrength(const LightTransform& transform) const {
  if (SamePlacement(transform, built_)) return 1;
  if (const auto scaleSquared = RelativeScaleSquared(built_, transform)) return 1 / *scaleSquared;
  const double area = area_.quick(transform);
  return area > 0 ? static_cast<float>(quickBuilt_ / area) : 0.0f;
}

Color SurfaceEmission::Exitance(const LightTransform& transform, const Normal3& normal) const {
  if (!shaped_) return Color(kPi * SideCount());
  constexpr int n = 32;
  Color sum;
  for (int i = 0; i < n * n; ++i) {
    const Point2 u((static_cast<float>(i % n) + 0.5f) / n, (static_cast<float>(i / n) + 0.5f) / n);
    const Vector3 outgoing = SampleEmissionDirection(transform, normal, u);
    const float cosine = EmittedCosine(glm::dot(normal, outgoing));
    if (!(cosine > 0)) continue;
    const ShapedDirections::Leaving shaped = shaped_->Look(transform, normal, outgoing);
    if (shaped.factor.IsBlack()) continue;
    const PdfSolidAngle density = shaped_->GuidesEmission() ? shaped.density : CosineLaw(cosine);
    if (!density.IsZero()) sum += shaped.factor * (cosine / density.value);
  }
  return sum / static_cast<float>(n * n);
}

float SurfaceEmission::ApparentPower(const LightContext& context, const EmissionBounds& bounds, float unshaped,
                                     const Point3& P) const {
  if (!shaped_) return unshaped;
  const float largest = shaped_->Largest();
  const Vector3 toPoint = P - bounds.box.Center();
  const float squared = LengthSquared(toPoint);
  if (!(squared > 0.25f * LengthSquared(bounds.box.Diagonal()))) return unshaped * largest;
  const Vector3 outgoing = toPoint / std::sqrt(squared);
  // Points of the light other than its centre may be brighter.
  const float towards = shaped_->Factor(*context.transform, outgoing).Average();
  return unshaped * std::max(towards, 0.02f * largest);
}

void SurfaceEmission::NarrowFlat(const LightTransform& transform, EmissionBounds& bounds) const {
  // About an oblique axis a cone may reach both sides, and beyond its own angle from the normal.
  if (!shaped_ || !shaped_->IsAlong(transform, bounds.axis)) return;
  if (shaped_->IsBackDark() && bounds.twoSided) {
    // The emitting side is that of the primary axis, which may be the inner one.
    if (glm::dot(bounds.axis, shaped_->PrimaryAxis(transform)) < 0) bounds.axis = -bounds.axis;
    bounds.twoSided = false;
  }
  // Slightly wider than the cone, for the rounding of directions. Under shear the angles are not those of the cone.
  if (shaped_->KeepsAngles(transform)) {
    const float widest = std::acos(std::clamp(shaped_->Parts().CosWidest(), -1.0f, 1.0f)) + 1e-3f;
    bounds.cosThetaE = std::max(std::cos(std::min(widest, kPi)), 0.0f);
  }
}

// Here and below every return statement returns the same variable, so that it is constructed in the caller's storage
// (NRVO): copying what was just written field by field stalls on store forwarding.
std::optional<LightSample> SurfaceEmission::Sample(const LightContext& context, const Point3& P,
                                                   const EmittingPoint& point) const {
  std::optional<LightSample> sample;
  if (point.density.IsZero()) return sample;
  const Vector3 toLight = point.position - P;
  const float squared = LengthSquared(toLight);
  if (!(squared > 0)) return sample;
  sample.emplace();
  sample->distance = std::sqrt(squared);
  sample->direction = toLight / sample->distance;
  sample->position = point.position;
  sample->positionError = point.positionError;
  sample->normal = point.normal;
  sample->uvw = Point3(point.uv, 0.0f);
  sample->patchIndex = point.patch;
  sample->pdfDirect = DirectDensity(point.density, squared, EmittedCosine(-glm::dot(point.normal, sample->direction)));
  if (!Complete(context, point.density, *sample)) sample.reset();
  return sample;
}

bool SurfaceEmission::Complete(const LightContext& context, PdfArea density, LightSample& sample) const {
  if (sample.pdfDirect.IsZero()) return false;
  const Point2 uv(sample.uvw.x, sample.uvw.y);
  Color radiance;
  if (context.bidirectional) {
    const float cosine = EmittedCosine(-glm::dot(sample.normal, sample.direction));
    const Leaving leaving = Leave(context, uv, sample.normal, -sample.direction, cosine);
    radiance = leaving.radiance;
    sample.pdfEmit = density;
    sample.pdfEmitDirection = leaving.density;
    sample.solidAngleToArea = SolidAngleToArea(Sqr(sample.distance), cosine);
  } else {
    radiance = Emitted(context, uv, -sample.direction);
  }
  if (alpha_) radiance *= Opacity(uv, sample.position, sample.normal);
  return tint_.Split(radiance, sample);
}

std::optional<LightEvaluation> SurfaceEmission::Evaluate(const LightContext& context, const LightHit& hit,
                                                         PdfArea density, PdfSolidAngle pdfDirect) const {
  std::optional<LightEvaluation> evaluation;
  const float cosine = EmittedCosine(-glm::dot(hit.normal, hit.direction));
  if (!(cosine > 0)) return evaluation;
  evaluation.emplace();
  evaluation->normal = hit.normal;
  evaluation->pdfDirect = pdfDirect;
  Color radiance;
  if (context.bidirectional) {
    const Leaving leaving = Leave(context, hit.uv, hit.normal, -hit.direction, cosine);
    radiance = leaving.radiance;
    evaluation->pdfEmit = density;
    evaluation->pdfEmitDirection = leaving.density;
    evaluation->solidAngleToArea = SolidAngleToArea(Sqr(hit.distance), cosine);
  } else {
    radiance = Emitted(context, hit.uv, -hit.direction);
  }
  if (!IsCutOut(hit)) tint_.Split(radiance, *evaluation);
  return evaluation;
}

std::optional<LightEvaluation> SurfaceEmission::Evaluate(const LightContext& context, const LightHit& hit,
                                                         PdfArea density) const {
  const float cosine = EmittedCosine(-glm::dot(hit.normal, hit.direction));
  return Evaluate(context, hit, density, DirectDensity(density, Sqr(hit.distance), cosine));
}

Vector3 SurfaceEmission::SampleCosineLaw(const Normal3& normal, Point2 u) const {
  float side = 1;
  if (twoSided_) {
    side = u.x < 0.5f ? 1.0f : -1.0f;
    u.x = std::min(u.x < 0.5f ? 2 * u.x : 2 * u.x - 1, kOneMinusEpsilon);
  }
  return Frame::FromNormal(side * normal).ToWorld(SampleCosineHemisphere(u));
}

Vector3 SurfaceEmission::SampleEmissionDirection(const LightTransform& transform, const Normal3& normal,
                                                 const Point2& u) const {
  return shaped_ && shaped_->GuidesEmission() ? shaped_->Sample(transform, normal, u) : SampleCosineLaw(normal, u);
}

std::optional<EmissionSample> SurfaceEmission::Emit(const LightContext& context, const EmittingPoint& point) const {
  std::optional<EmissionSample> sample;
  if (point.density.IsZero()) return sample;
  sample.emplace();
  sample->position = point.position;
  sample->positionError = point.positionError;
  sample->normal = point.normal;
  sample->uvw = Point3(point.uv, 0.0f);
  sample->patchIndex = point.patch;
  sample->pdfEmit = point.density;
  sample->direction = SampleEmissionDirection(*context.transform, point.normal, context.uDirection);
  sample->emissionCosine = EmittedCosine(glm::dot(point.normal, sample->direction));
  // No emission in this direction: a black sample with a valid position.
  if (!(sample->emissionCosine > 0)) return sample;
  Leaving leaving = Leave(context, point.uv, point.normal, sample->direction, sample->emissionCosine);
  sample->pdfEmitDirection = leaving.density;
  if (sample->pdfEmitDirection.IsZero()) return sample;
  if (alpha_) leaving.radiance *= Opacity(point.uv, point.position, point.normal);
  tint_.Split(leaving.radiance, *sample);
  return sample;
}

Color SurfaceEmission::ForCamera(const LightContext& context, const LightHit& hit, bool cameraVisible) const {
  const float cosine = EmittedCosine(-glm::dot(hit.normal, hit.direction));
  return cameraVisible && cosine > 0 && !IsCutOut(hit) ? Emitted(context, hit.uv, -hit.direction) : Color(0.0f);
}

}  // namespace lampyr
