// The layers of Film "gbuffer": position, normals, texture coordinates and albedo of the surface that the camera sees
// first. They do not depend on the integrator, nor on the number of samples of the picture, so that all parts of a
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
//   dzdx, dzdy        change of its z over a pixel to the right, and down, in the plane of the surface
//   N.X, .Y, .Z       geometric normal, unit, on the side of the camera;  Ns.X, .Y, .Z: shading normal
//   u, v              texture coordinates
const std::vector<std::string>& FirstHitChannels();

// An image of FirstHitChannels() over the crop: means over the rays of up to 16 samples of each pixel, by the pixel
// filter, of those that hit something; 0 where none does. `interrupted` is looked at from row to row, and what is left
// is then 0.
Image FirstHitLayers(const BuiltScene& built, int threads, const std::atomic<bool>& interrupted);

}  // namespace lampyr
