#include "lights/shaped_directions.h"

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
      builtAxes_(Compose(axes, built)) {
  if (emitter == Shaping::Emitter::Flat && twoSided && !IsBackDark()) frontShare_ = 0.5f;
}

const LightTransform& ShapedDirections::AxesUnder(const LightTransform& transform, LightTransform& scratch) const {
  if (!hasAxes_) return transform;
  if (SamePlacement(transform, built_)) return builtAxes_;
  scratch = Compose(axes_, transform);
  return scratch;
}

bool ShapedDirections::KeepsAngles(const LightTransform& transform) const {
  LightTransform scratch;
  return IsSimilarity(AxesUnder(transform, scratch).toRender.linear);
}

Color ShapedDirections::Factor(const LightTransform& transform, const Vector3& outgoing) const {
  LightTransform scratch;
  return shaping_->Factor(ToLocalDirection(AxesUnder(transform, scratch), outgoing));
}

Vector3 ShapedDirections::Sample(const LightTransform& transform, const Normal3& normal, const Point2& u) const {
  if (u.x < frontShare_) {
    const Point2 stretched(std::min(u.x / frontShare_, kOneMinusEpsilon), u.y);
    LightTransform scratch;
    return ToRenderDirection(AxesUnder(transform, scratch), shaping_->SampleDirection(stretched));
  }
  const Point2 stretched(std::min((u.x - frontShare_) / (1 - frontShare_), kOneMinusEpsilon), u.y);
  return Frame::FromNormal(-normal).ToWorld(SampleCosineHemisphere(stretched));
}

PdfSolidAngle ShapedDirections::Density(const LightTransform& transform, const Normal3& normal,
                                        const Vector3& outgoing) const {
  const float cosine = glm::dot(normal, outgoing);
  if (frontShare_ < 1 && cosine < 0) return (1 - frontShare_) * CosineHemispherePdf(-cosine);
  LightTransform scratch;
  const LightTransform& axes = AxesUnder(transform, scratch);
  const PdfSolidAngle local = shaping_->Density(ToLocalDirection(axes, outgoing));
  const PdfSolidAngle density = frontShare_ * LocalSolidAngleFactor(axes, outgoing) * local;
  return density.value < kInfinity ? density : PdfSolidAngle(0);
}

}  // namespace lampyr
