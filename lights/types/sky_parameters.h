// Parameters of lights that are a sky: "infinite" and "dome", and the portals through which a sky is seen.
#pragma once

#include <optional>

#include "lights/light_base.h"
#include "lights/types/image_sky.h"
#include "sampling/warp.h"

namespace lampyr {

// A sky of constant radiance.
struct EvenSky {
  Color radiance;

  Color Radiance(const Vector3&) const { return radiance; }
  SkySample Sample(const Point2& u) const { return {SampleUniformSphere(u), Look({}), true}; }
  SkyPoint Look(const Vector3&) const { return {radiance, UniformSpherePdf()}; }
  Color Mean() const { return radiance; }
  float FacingIrradiance() const { return kPi * radiance.Average(); }
};

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
