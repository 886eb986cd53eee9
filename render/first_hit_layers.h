// The layers of Film "gbuffer": position, normals, texture coordinates and albedo of the surface that the camera sees
// first. They do not depend on the integrator, nor on which samples of the picture are rendered, so that all parts of a
// picture have the same.
#pragma once

#include <atomic>
#include <string>
#include <vector>

#include "film/image.h"
#include "render/build/scene_builder.h"

namespace lampyr {

// The channels, as pbrt-v4 names them:
//   Albedo.R, .G, .B  reflectance and transmittance towards the camera, in [0, 1]
//   P.X, .Y, .Z       position, in the space that the film asks for (RenderSettings::firstHit)
//   dzdx, dzdy        magnitude of the change of its z over a pixel to the right, and down, in the plane of the surface
//   N.X, .Y, .Z       geometric normal, unit, on the side of the camera;  Ns.X, .Y, .Z: shading normal, unit
//   u, v              texture coordinates
const std::vector<std::string>& FirstHitChannels();

// Name of the metadata of a picture that is to have these layers; its value is their space, "camera" or "world".
inline constexpr const char* kFirstHitMetadata = "lampyr.firstHit";

// An image of FirstHitChannels() over the crop: means over the rays of the samples of each pixel, 16 of them at most,
// that hit something, by the magnitude of the pixel filter; 0 where none does. Without channels if `interrupted` was
// set, which is looked at from row to row.
Image FirstHitLayers(const BuiltScene& built, int threads, const std::atomic<bool>& interrupted);

}  // namespace lampyr
