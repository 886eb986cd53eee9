// The layers of what the camera sees first: position, normals, texture coordinates, albedo, object and material; those
// of Film "gbuffer", and the requested pixel layers (settings/output_layers.h). They do not depend on the integrator,
// nor on which samples of the picture are rendered, so that all parts of a picture have the same.
#pragma once

#include <atomic>
#include <string>
#include <vector>

#include "film/image.h"
#include "render/build/scene_builder.h"

namespace lampyr {

// The channels of Film "gbuffer", as pbrt-v4 names them:
//   Albedo.R, .G, .B  reflectance and transmittance towards the camera, in [0, 1]
//   P.X, .Y, .Z       position, in the space that the film asks for (RenderSettings::firstHit)
//   dzdx, dzdy        magnitude of the change of its z over a pixel to the right, and down, in the plane of the surface
//   N.X, .Y, .Z       geometric normal, unit, on the side of the camera;  Ns.X, .Y, .Z: shading normal, unit
//   u, v              texture coordinates
// and then those of the pixel layers:
//   N.X, .Y, .Z       shading normal, unit, on the side of the camera, in world space; not with Film "gbuffer"
//   Z                 depth along the axis of the camera
//   CryptoObject00.R, …, CryptoMaterial00.R, …: names and coverages (cryptomatte.h)
std::vector<std::string> FirstHitChannels(const RenderSettings& settings);

// Name of the metadata of a picture that is to have these layers; its value is their space, "camera" or "world".
// Another one lists the channels.
inline constexpr const char* kFirstHitMetadata = "lampyr.firstHit";
inline constexpr const char* kFirstHitChannelsMetadata = "lampyr.firstHitChannels";
// The metadata of a picture with these layers.
std::map<std::string, std::string> FirstHitMetadata(const BuiltScene& built);

// An image of FirstHitChannels() over the crop: means over the rays of the samples of each pixel, 16 of them at most,
// that hit something, by the magnitude of the pixel filter; 0 where none does. Perfectly smooth surfaces are followed
// if the settings ask for it. Without channels if `interrupted` was set, which is checked at each row.
Image FirstHitLayers(const BuiltScene& built, int threads, const std::atomic<bool>& interrupted);

}  // namespace lampyr
