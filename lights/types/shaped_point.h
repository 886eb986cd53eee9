// A point light's profile times a shaping (UsdLux's ShapingAPI: cone, focus, IES profile) about an axis of the light.
//
// The product is sampled by one of its factors or by half of each: whichever has the smallest second moment, estimated
// once. Each is valid, because the density of a factor is positive wherever the product is.
#pragma once

#include <type_traits>

#include "lights/cone_bound.h"
#include "lights/direction_map.h"
#include "lights/point_light.h"
#include "lights/types/shaping.h"
#include "math/frame.h"

namespace lampyr {

// `Base` is a profile (point_light.h). One that is 1 in all directions has a constant kIsEven.
template <class Base>
class ShapedPointProfile {
 public:
  // The axis of shaping, -z, is rotated to the local `axis`, with φ = 0 as near to the light's +x as possible.
  ShapedPointProfile(Base base, std::shared_ptr<const Shaping> shaping, const Vector3& axis)
      : base_(std::move(base)),
        shaping_(std::move(shaping)),
        frame_(Frame::FromNormalAndTangent(-axis, Vector3(1, 0, 0))) {
    if constexpr (kBaseIsEven) {
      baseShare_ = 0;
      solidAngle_ = shaping_->Integral();
    } else {
      baseShare_ = BestShare();
      solidAngle_ = Integrate(LightTransform{}, 1 << 16);
    }
  }

  Color Shape(const LightTransform& transform, const Vector3& direction) const {
    const auto shape = base_.Shape(transform, direction);
    if constexpr (std::is_same_v<decltype(shape), const Color>) {
      if (shape.IsBlack()) return shape;
    } else {
      if (shape == 0) return Color(0.0f);
    }
    return shaping_->Factor(ToShaping(transform, direction)) * shape;
  }
  float Largest() const { return base_.Largest() * shaping_->Largest(); }

  Vector3 Sample(const LightTransform& transform, const Point2& u) const {
    if (u.x < baseShare_) return base_.Sample(transform, {std::min(u.x / baseShare_, kOneMinusEpsilon), u.y});
    const float x = std::min((u.x - baseShare_) / (1 - baseShare_), kOneMinusEpsilon);
    return ToRenderDirection(transform, frame_.ToWorld(shaping_->SampleDirection({x, u.y})));
  }

  // Density of the mixture of both techniques.
  PdfSolidAngle Density(const LightTransform& transform, const Vector3& direction) const {
    PdfSolidAngle density(0);
    if (baseShare_ > 0) density = baseShare_ * base_.Density(transform, direction);
    if (baseShare_ < 1) {
      const float factor = (1 - baseShare_) * LocalSolidAngleFactor(transform, direction);
      density = density + factor * shaping_->Density(ToShaping(transform, direction));
    }
    return density;
  }

  Color SolidAngle(const LightTransform& transform) const {
    return IsSimilarity(transform.toRender.linear) ? solidAngle_ : Integrate(transform, 1 << 13);
  }

  // Each factor bounds the product; the narrower cone is used.
  void SetCones(const LightTransform& transform, EmissionBounds& bounds) const {
    base_.SetCones(transform, bounds);
    EmissionBounds ours;
    SetConeBounds(transform, -frame_.z, 1 - shaping_->CosWidest(), ours);
    if (bounds.cosThetaO > -1 && bounds.cosThetaE >= ours.cosThetaE) return;
    if (ours.cosThetaE <= -1) return;
    bounds.axis = ours.axis;
    bounds.cosThetaO = ours.cosThetaO;
    bounds.cosThetaE = ours.cosThetaE;
  }
  bool Clip(const LightTransform& transform, const Point3& from, const Point3& origin, const Vector3& direction,
            float& minT, float& maxT) const {
    return base_.Clip(transform, from, origin, direction, minT, maxT) &&
           ClipToCone(transform, from, -frame_.z, 1 - shaping_->CosWidest(), origin, direction, minT, maxT);
  }

 private:
  static constexpr bool kBaseIsEven = requires { Base::kIsEven; };

  Vector3 ToShaping(const LightTransform& transform, const Vector3& direction) const {
    return frame_.ToLocal(ToLocalDirection(transform, direction));
  }

  // Calls function(local direction, density, product) for photons of an untransformed light, on a lattice
  // ([Roberts18]).
  template <class Function>
  void ForPhotons(int count, const Function& function) const {
    const LightTransform identity;
    for (int i = 0; i < count; ++i) {
      const double x = 0.5 + 0.7548776662466927 * i, y = 0.5 + 0.5698402909980532 * i;
      const Point2 u(static_cast<float>(x - std::floor(x)), static_cast<float>(y - std::floor(y)));
      const Vector3 local = Sample(identity, {std::min(u.x, kOneMinusEpsilon), std::min(u.y, kOneMinusEpsilon)});
      const auto density = static_cast<double>(Density(identity, local).value);
      if (density > 0) function(local, density, Shape(identity, local));
    }
  }

  // ∫ Shape dω in render space.
  Color Integrate(const LightTransform& transform, int points) const {
    double sum[3] = {0, 0, 0};
    ForPhotons(points, [&](const Vector3& local, double density, const Color& shape) {
      const auto factor = static_cast<double>(LocalSolidAngleFactor(transform, ToRenderDirection(transform, local)));
      const double weight = 1 / (density * factor * points);
      sum[0] += weight * static_cast<double>(shape.r);
      sum[1] += weight * static_cast<double>(shape.g);
      sum[2] += weight * static_cast<double>(shape.b);
    });
    return {static_cast<float>(sum[0]), static_cast<float>(sum[1]), static_cast<float>(sum[2])};
  }

  // The fraction of photons sampled by the base, of 0, 1/2 and 1: the one with the smallest ∫ Shape²/density.
  float BestShare() {
    const LightTransform identity;
    double moments[3] = {0, 0, 0};
    baseShare_ = 0.5f;
    ForPhotons(1 << 12, [&](const Vector3& local, double density, const Color& shape) {
      const auto byBase = static_cast<double>(base_.Density(identity, local).value);
      const double byShaping = 2 * density - byBase;
      const double squared = static_cast<double>(shape.Average()) * static_cast<double>(shape.Average());
      if (!(squared > 0)) return;
      moments[0] += squared / (density * std::max(byShaping, 1e-30));
      moments[1] += squared / (density * density);
      moments[2] += squared / (density * std::max(byBase, 1e-30));
    });
    if (moments[0] <= moments[1] && moments[0] <= moments[2]) return 0.0f;
    return moments[2] <= moments[1] ? 1.0f : 0.5f;
  }

  Base base_;
  std::shared_ptr<const Shaping> shaping_;
  Frame frame_;  // of the shaping in the light's local space: its z is opposite to the axis
  float baseShare_ = 0;
  Color solidAngle_;  // ∫ Shape dω, untransformed
};

// A point light with this profile, shaped around the local `axis` if the parameters ask for it.
template <class Profile>
std::unique_ptr<Light> MakePointLight(LightTypeFunction type, const ParameterList& parameters,
                                      const LightBuildContext& build, Profile profile, const PointSource& source,
                                      const Vector3& axis) {
  const auto shaping = Shaping::Read(parameters, build, Shaping::Emitter::Point);
  if (!shaping) return std::make_unique<PointLightWith<Profile>>(type, parameters, build, std::move(profile), source);
  return std::make_unique<PointLightWith<ShapedPointProfile<Profile>>>(
      type, parameters, build, ShapedPointProfile<Profile>(std::move(profile), shaping, axis), source);
}

// Parameter rows of a type, of shaping and of all lights.
inline std::vector<ParameterInfo> WithShapingParameters(std::vector<ParameterInfo> parameters) {
  const std::vector<ParameterInfo> shaping = ShapingParameters();
  parameters.insert(parameters.end(), shaping.begin(), shaping.end());
  return WithCommonParameters(std::move(parameters));
}

}  // namespace lampyr
