#include "materials/shading_normal.h"

#include "scene/parameters.h"
#include "textures/texture_library.h"

namespace lampyr {

namespace {

constexpr float kBumpStep = 5e-4f;  // in uv, for finite differences

// The frame around n (any length, NaN or 0 allowed), flipped to the side of Ng; the surface's own frame if n is
// unusable.
Frame FrameAround(const Vector3& n, const SurfacePoint& point, const Vector3& tangent) {
  const float lengthSquared = LengthSquared(n);
  if (!(lengthSquared > 0) || !(lengthSquared < kInfinity)) return Frame::FromNormalAndTangent(point.Ns, point.dpdu);
  const Vector3 unit = n / std::sqrt(lengthSquared);
  return Frame::FromNormalAndTangent(glm::dot(unit, point.Ng) < 0 ? -unit : unit, tangent);
}

}  // namespace

ShadingNormal::ShadingNormal(const ParameterList& parameters, const TextureLibrary& textures,
                             Diagnostics& diagnostics) {
  displacement_ = textures.FindFloat(parameters, "displacement");
  const std::string file = parameters.GetFile("normalmap");
  if (file.empty()) return;
  if (displacement_) {
    diagnostics.Warn(parameters.WhereOf("displacement"),
                     "\"displacement\" is ignored: the material has a \"normalmap\"");
  }
  const auto image = textures.GetImage(file, ImageEncoding::Linear, parameters.WhereOf("normalmap"));
  if (!image->HasRgb() || image->width < 1 || image->height < 1) {
    throw Error(parameters.WhereOf("normalmap"), "normal map " + file + " has no R, G and B channels");
  }
  normalMap_.emplace(image, WrapMode::Repeat, true);
}

Frame ShadingNormal::GetFrame(const SurfacePoint& point) const {
  return normalMap_ ? FromNormalMap(point) : FromDisplacement(point);
}

Frame ShadingNormal::FromNormalMap(const SurfacePoint& point) const {
  const Color texel = normalMap_->LookupColor(point.uv);
  const Frame frame = Frame::FromNormalAndTangent(point.Ns, point.dpdu);
  return FrameAround(frame.ToWorld({2 * texel.r - 1, 2 * texel.g - 1, 2 * texel.b - 1}), point, point.dpdu);
}

Frame ShadingNormal::FromDisplacement(const SurfacePoint& point) const {
  // Tangents of the smooth surface whose normal is Ns.
  const Vector3 dpdu = point.dpdu - point.Ns * glm::dot(point.Ns, point.dpdu);
  const Vector3 dpdv = point.dpdv - point.Ns * glm::dot(point.Ns, point.dpdv);
  const float here = displacement_->Evaluate({point.uv, point.position, point.Ng});
  const float alongU =
      displacement_->Evaluate({point.uv + Point2(kBumpStep, 0), point.position + kBumpStep * point.dpdu, point.Ng});
  const float alongV =
      displacement_->Evaluate({point.uv + Point2(0, kBumpStep), point.position + kBumpStep * point.dpdv, point.Ng});
  const Vector3 bumpedU = dpdu + ((alongU - here) / kBumpStep) * point.Ns;
  const Vector3 bumpedV = dpdv + ((alongV - here) / kBumpStep) * point.Ns;
  // In double: the square of an area leaves the range of float where scenes are large or small.
  const Vector3d across = glm::cross(Vector3d(bumpedU), Vector3d(bumpedV));
  const double length = glm::length(across);
  return FrameAround(length > 0 ? Vector3(across / length) : Vector3(0.0f), point, bumpedU);
}

}  // namespace lampyr
