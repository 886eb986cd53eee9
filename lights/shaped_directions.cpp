#include "lights/shaped_directions.h"

#include "lights/direction_map.h"
#include "math/frame.h"
#include "sampling/warp.h"

namespace lampyr {

ShapedDirections::ShapedDirections(std::shared_ptr<const Shaping> shaping, Shaping::Emitter emitter, bool twoSided,
                                   bool isBackDark, const LightTransform& axes)
    : shaping_(std::move(shaping)),
      guides_(shaping_->GuidesEmission()),
      isBackDark_(isBackDark),
      hasAxes_(axes.toRender.linear != glm::mat3(1.0f)),
      axes_(axes) {
  if (emitter == Shaping::Emitter::Flat && twoSided && !IsBackDark()) frontShare_ = 0.5f;
}

LightTransform ShapedDirections::AxesUnder(const LightTransform& transform) const {
  if (!hasAxes_) return transform;
  LightTransform result;
  result.toRender.linear = transform.toRender.linear * axes_.toRender.linear;
  result.toLocal.linear = axes_.toLocal.linear * transform.toLocal.linear;
  return result;
}

bool ShapedDirections::KeepsAngles(const LightTransform& transform) const {
  return IsSimilarity(AxesUnder(transform).toRender.linear);
}

Color ShapedDirections::Factor(const LightTransform& transform, const Normal3& normal, const Vector3& outgoing) const {
  return shaping_->Factor(ToLocalDirection(AxesUnder(transform), outgoing), glm::dot(normal, outgoing));
}

Vector3 ShapedDirections::Sample(const LightTransform& transform, const Normal3& normal, const Point2& u) const {
  if (u.x < frontShare_) {
    const Point2 stretched(std::min(u.x / frontShare_, kOneMinusEpsilon), u.y);
    return ToRenderDirection(AxesUnder(transform), shaping_->SampleDirection(stretched));
  }
  const Point2 stretched(std::min((u.x - frontShare_) / (1 - frontShare_), kOneMinusEpsilon), u.y);
  return Frame::FromNormal(-normal).ToWorld(SampleCosineHemisphere(stretched));
}

PdfSolidAngle ShapedDirections::Density(const LightTransform& transform, const Normal3& normal,
                                        const Vector3& outgoing) const {
  const float cosine = glm::dot(normal, outgoing);
  if (frontShare_ < 1 && cosine < 0) return (1 - frontShare_) * CosineHemispherePdf(-cosine);
  const LightTransform axes = AxesUnder(transform);
  const PdfSolidAngle local = shaping_->Density(ToLocalDirection(axes, outgoing));
  const PdfSolidAngle density = frontShare_ * LocalSolidAngleFactor(axes, outgoing) * local;
  return density.value < kInfinity ? density : PdfSolidAngle(0);
}

}  // namespace lampyr
