// What the lights that are a sky read from their parameters: "infinite" and "dome", and the portals through which one
// shines.
#pragma once

#include <optional>

#include "lights/light_base.h"
#include "lights/types/image_sky.h"
#include "sampling/warp.h"

namespace lampyr {

// The same radiance everywhere.
struct EvenSky {
  Color radiance;

  Color Radiance(const Vector3&) const { return radiance; }
  SkySample Sample(const Point2& u) const { return {SampleUniformSphere(u), Look({}), true}; }
  SkyPoint Look(const Vector3&) const { return {radiance, UniformSpherePdf()}; }
  Color Mean() const { return radiance; }
  float FacingIrradiance() const { return kPi * radiance.Average(); }
};

// An image, or else the even radiance. Both with scale, illuminance and the tint's colour.
struct SkyChoice {
  std::optional<ImageSky> image;
  EvenSky even;

  Color Mean() const { return image ? image->Mean() : even.radiance; }
  Color Radiance(const Vector3& local) const { return image ? image->Radiance(local) : even.radiance; }
};

// L, filename, scale and illuminance, as "infinite" has them; pbrt-v4's orientation.
SkyChoice ReadInfiniteSky(const ParameterList& parameters, const LightBuildContext& build);

// texture:file, texture:format and poleAxis, as "dome" has them.
SkyChoice ReadDomeSky(const ParameterList& parameters, const LightBuildContext& build);
std::vector<ParameterInfo> DomeSkyParameters();

}  // namespace lampyr
