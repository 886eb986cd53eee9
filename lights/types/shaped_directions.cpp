#include "lights/types/shaped_directions.h"

#include "lights/direction_map.h"
#include "math/frame.h"
#include "sampling/warp.h"

namespace lampyr {

namespace {

// Directions only: the translation is left out.
LightTransform Compose(const LightTransform& first, const LightTransform& second) {
  LightTransform result;
  result.toRender.linear = second.toRender.linear * first.toRender.linear;
  result.toLocal.linear = first.toLocal.linear * second.toLocal.linear;
  return result;
}

}  // namespace

ShapedDirections::ShapedDirections(std::shared_ptr<const Shaping> shaping, Shaping::Emitter emitter, bool twoSided,
                                   bool isBackDark, const LightTransform& axes, const LightTransform& built)
    : shaping_(std::move(shaping)),
      guides_(shaping_->GuidesEmission()),
      isBackDark_(isBackDark),
      hasAxes_(axes.toRender.linear != glm::mat3(1.0f)),
      axes_(axes),
      built_(built),
      builtAxes_(hasAxes_ ? Compose(axes, built) : built) {
  if (IsSimilarity(builtAxes_.toRender.linear)) builtScale_ = glm::length(builtAxes_.toRender.linear[0]);
  if (emitter == Shaping::Emitter::Flat && twoSided && !IsBackDark()) frontShare_ = 0.5f;
}

ShapedDirections::Axes ShapedDirections::AxesUnder(const LightTransform& transform, LightTransform& scratch) const {
  if (SamePlacement(transform, built_)) return {builtAxes_, builtScale_};
  if (!hasAxes_) return {transform, 0};
  scratch = Compose(axes_, transform);
  return {scratch, 0};
}

bool ShapedDirections::KeepsAngles(const LightTransform& transform) const {
  LightTransform scratch;
  return IsSimilarity(AxesUnder(transform, scratch).map.toRender.linear);
}

Vector3 ShapedDirections::PrimaryAxis(const LightTransform& transform) const {
  LightTransform scratch;
  return ToRenderDirection(AxesUnder(transform, scratch).map, Vector3(0, 0, -1));
}

bool ShapedDirections::IsAlong(const LightTransform& transform, const Normal3& normal) const {
  LightTransform scratch;
  const Vector3 local = normal * AxesUnder(transform, scratch).map.toRender.linear;  // of the plane: Mᵀ n
  constexpr float kRounding = 1e-4f;
  return std::max(std::abs(local.x), std::abs(local.y)) < kRounding * std::abs(local.z);
}

Color ShapedDirections::Factor(const LightTransform& transform, const Vector3& outgoing) const {
  LightTransform scratch;
  return shaping_->Factor(AxesUnder(transform, scratch).ToLocal(outgoing));
}

Vector3 ShapedDirections::Sample(const LightTransform& transform, const Normal3& normal, const Point2& u) const {
  if (u.x < frontShare_) {
    const Point2 stretched(std::min(u.x / frontShare_, kOneMinusEpsilon), u.y);
    LightTransform scratch;
    return ToRenderDirection(AxesUnder(transform, scratch).map, shaping_->SampleDirection(stretched));
  }
  const Point2 stretched(std::min((u.x - frontShare_) / (1 - frontShare_), kOneMinusEpsilon), u.y);
  return Frame::FromNormal(-normal).ToWorld(SampleCosineHemisphere(stretched));
}

ShapedDirections::Leaving ShapedDirections::Look(const LightTransform& transform, const Normal3& normal,
                                                 const Vector3& outgoing) const {
  LightTransform scratch;
  const Axes axes = AxesUnder(transform, scratch);
  const Vector3 local = axes.ToLocal(outgoing);
  Leaving leaving{shaping_->Factor(local), PdfSolidAngle(0)};
  if (!guides_ || leaving.factor.IsBlack()) return leaving;
  const float cosine = glm::dot(normal, outgoing);
  if (frontShare_ < 1 && cosine < 0) {
    leaving.density = (1 - frontShare_) * CosineHemispherePdf(-cosine);
    return leaving;
  }
  const float stretch = axes.scale > 0 ? 1.0f : LocalSolidAngleFactor(axes.map, outgoing);
  const PdfSolidAngle density = frontShare_ * stretch * shaping_->Density(local);
  if (density.value < kInfinity) leaving.density = density;
  return leaving;
}

}  // namespace lampyr
