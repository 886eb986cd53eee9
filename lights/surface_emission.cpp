#include "lights/surface_emission.h"

#include "lights/light_base.h"

namespace lampyr {

SurfaceEmission::SurfaceEmission(const ParameterList& parameters, const LightBuildContext& build, double area)
    : twoSided_(parameters.GetBool("twosided", false)), image_(parameters, build), alpha_(build.alpha) {
  if (HasImage() && parameters.Find("L")) {
    throw Error(parameters.WhereOf("L"), parameters.Owner() + ": both \"L\" and \"filename\" are given, one is enough");
  }
  double scale = parameters.GetFloat("scale", 1);
  const double power = parameters.GetFloat("power", -1);
  if (power > 0) {
    // The colour keeps its own magnitude: `power` is what a surface of radiance 1, or of the image, would emit.
    const double mean = HasImage() ? static_cast<double>(image_.Mean().Luminance()) : 1.0;
    const double emitted = mean * area * static_cast<double>(kPi) * (twoSided_ ? 2 : 1);
    scale = emitted > 0 ? scale * power / emitted : 0.0;
  }
  radiance_ = (HasImage() ? Color(1.0f) : ReadEmissionColor(parameters, "L")) * static_cast<float>(scale);
  if (!radiance_.IsValid())
    throw Error(parameters.Where(), parameters.Owner() + ": the emitted radiance is not finite");
}

std::optional<LightSample> SurfaceEmission::Sample(const LightContext& context, const Point3& P,
                                                   const EmittingPoint& point) const {
  if (point.density.IsZero()) return std::nullopt;
  const Vector3 toLight = point.position - P;
  const float squared = LengthSquared(toLight);
  if (!(squared > 0)) return std::nullopt;
  std::optional<LightSample> sample(std::in_place);
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
  sample.diffuse = Radiance(uv);
  if (alpha_) sample.diffuse *= Opacity(uv, sample.position);
  if (sample.diffuse.IsBlack()) return false;
  sample.specular = sample.diffuse;
  if (context.bidirectional) {
    const float cosine = EmittedCosine(-glm::dot(sample.normal, sample.direction));
    sample.pdfEmit = density;
    sample.pdfEmitDirection = EmissionDirectionDensity(cosine);
    sample.solidAngleToArea = SolidAngleToArea(Sqr(sample.distance), cosine);
  }
  return true;
}

Color SurfaceEmission::FoundRadiance(const LightHit& hit) const {
  if (alpha_ && Opacity(hit.uv, hit.position) == 0) return Color(0.0f);
  return Radiance(hit.uv);
}

std::optional<LightEvaluation> SurfaceEmission::Evaluate(const LightContext& context, const LightHit& hit,
                                                         PdfArea density, PdfSolidAngle pdfDirect) const {
  const float cosine = EmittedCosine(-glm::dot(hit.normal, hit.direction));
  if (!(cosine > 0)) return std::nullopt;
  std::optional<LightEvaluation> evaluation(std::in_place);
  evaluation->normal = hit.normal;
  evaluation->diffuse = evaluation->specular = FoundRadiance(hit);
  evaluation->pdfDirect = pdfDirect;
  if (context.bidirectional) {
    evaluation->pdfEmit = density;
    evaluation->pdfEmitDirection = EmissionDirectionDensity(cosine);
    evaluation->solidAngleToArea = SolidAngleToArea(Sqr(hit.distance), cosine);
  }
  return evaluation;
}

std::optional<LightEvaluation> SurfaceEmission::Evaluate(const LightContext& context, const LightHit& hit,
                                                         PdfArea density) const {
  const float cosine = EmittedCosine(-glm::dot(hit.normal, hit.direction));
  return Evaluate(context, hit, density, DirectDensity(density, Sqr(hit.distance), cosine));
}

std::optional<EmissionSample> SurfaceEmission::Emit(const LightContext& context, const EmittingPoint& point) const {
  if (point.density.IsZero()) return std::nullopt;
  // Two-sided: the first random number chooses the side, and is stretched again.
  Point2 u = context.uDirection;
  float side = 1;
  if (twoSided_) {
    side = u.x < 0.5f ? 1.0f : -1.0f;
    u.x = std::min(u.x < 0.5f ? 2 * u.x : 2 * u.x - 1, kOneMinusEpsilon);
  }
  EmissionSample sample;
  sample.direction = Frame::FromNormal(side * point.normal).ToWorld(SampleCosineHemisphere(u));
  sample.emissionCosine = EmittedCosine(glm::dot(point.normal, sample.direction));
  sample.diffuse = Radiance(point.uv);
  if (alpha_) sample.diffuse *= Opacity(point.uv, point.position);
  if (!(sample.emissionCosine > 0) || sample.diffuse.IsBlack()) return std::nullopt;
  sample.specular = sample.diffuse;
  sample.position = point.position;
  sample.positionError = point.positionError;
  sample.normal = point.normal;
  sample.uvw = Point3(point.uv, 0.0f);
  sample.patchIndex = point.patch;
  sample.pdfEmit = point.density;
  sample.pdfEmitDirection = EmissionDirectionDensity(sample.emissionCosine);
  return sample;
}

Color SurfaceEmission::ForCamera(const LightHit& hit, bool cameraVisible) const {
  const float cosine = EmittedCosine(-glm::dot(hit.normal, hit.direction));
  return cameraVisible && cosine > 0 ? FoundRadiance(hit) : Color(0.0f);
}

}  // namespace lampyr
