// Parameters of lights that are a sky: "infinite" and "dome", and the portals through which a sky is seen.
#pragma once

#include <optional>

#include "lights/light_base.h"
#include "lights/types/image_sky.h"
#include "math/frame.h"
#include "sampling/warp.h"

namespace lampyr {

// A sky of constant radiance. Receivers with a normal sample it by the cosine.
struct EvenSky {
  Color radiance;

  Color Radiance(const Vector3&) const { return radiance; }
  SkySample Sample(const SkyReceiver& receiver, const Point2& u) const;
  SkyPoint Look(const SkyReceiver& receiver, const Vector3& local) const {
    if (!receiver.HasNormal()) return {radiance, UniformSpherePdf(), UniformSpherePdf()};
    const float cosine = glm::dot(receiver.normal, local);
    const float density = receiver.isTransmissive ? 0.5f * std::abs(cosine) : std::max(cosine, 0.0f);
    return {radiance, UniformSpherePdf(), PdfSolidAngle(density * kInvPi)};
  }
  Color Mean() const { return radiance; }
  float Irradiance(const SkyReceiver& receiver) const {
    return (receiver.isTransmissive ? 2 : 1) * kPi * radiance.Average();
  }
};

inline SkySample EvenSky::Sample(const SkyReceiver& receiver, const Point2& u) const {
  if (!receiver.HasNormal()) return {SampleUniformSphere(u), Look(receiver, {}), true};
  // Each side of a transmissive receiver has one half of u.x.
  const bool isBehind = receiver.isTransmissive && u.x >= 0.5f;
  const Point2 own = receiver.isTransmissive ? Point2(2 * u.x - (isBehind ? 1.0f : 0.0f), u.y) : u;
  const Vector3 local = Frame::FromNormal(receiver.normal).ToWorld(SampleCosineHemisphere(own));
  return {isBehind ? -local : local, {}, false};
}

// The sky as read: an image, or otherwise a constant radiance. Both include scale, illuminance and the tint's colour.
struct SkyChoice {
  std::optional<ImageSky> image;
  EvenSky even;

  Color Mean() const { return image ? image->Mean() : even.radiance; }
  Color Radiance(const Vector3& local) const { return image ? image->Radiance(local) : even.radiance; }
};

// Reads L, filename, scale and illuminance, the parameters of "infinite"; pbrt-v4's orientation.
SkyChoice ReadInfiniteSky(const ParameterList& parameters, const LightBuildContext& build);

// Reads texture:file, texture:format and poleAxis, the parameters of "dome".
SkyChoice ReadDomeSky(const ParameterList& parameters, const LightBuildContext& build);
std::vector<ParameterInfo> DomeSkyParameters();

}  // namespace lampyr
