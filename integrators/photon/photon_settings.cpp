#include "integrators/photon/photon_settings.h"

#include <algorithm>
#include <cmath>

#include "integrators/walk/footprint.h"

namespace lampyr {

namespace {

// Radius of photons in media in the first pass by default, in pixel footprints.
constexpr double kVolumeRadiusInPixels = 1;
// As wide as pixels are so far behind the photon, in radii of the scene: photons right before the camera would
// otherwise be without bound, as 1 / distance².
constexpr double kNearInRadii = 0.25;

VolumeRadius VolumeRadiusOf(const IntegratorInput& input, double radius) {
  VolumeRadius volume;
  volume.constant = radius;
  if (radius > 0 || input.scene.media.empty()) return volume;
  const Camera& camera = *input.scene.camera;
  const Point2 middle(0.5f * static_cast<float>(input.width), 0.5f * static_cast<float>(input.height));
  const Ray ray = camera.GenerateRay(middle, Point2(0.5f), 0).ray;
  volume.eye = ray.origin;
  const double area = PixelArea(camera, ray, input.FilmPixels(), 1);
  // Of a camera whose densities are unknown: a pixel of an angle of view of 53 degrees.
  const double width = kVolumeRadiusInPixels * (area > 0 ? std::sqrt(area) : 1 / std::sqrt(input.FilmPixels()));
  if (camera.ConnectsByDirection()) {
    volume.constant = width;
  } else {
    volume.perLength = width;
    volume.constant = width * kNearInRadii * static_cast<double>(input.scene.lighting->SceneSphere().radius);
  }
  return volume;
}

}  // namespace

PhotonSettings PhotonSettingsOf(const IntegratorInput& input) {
  const Settings& settings = input.settings;
  PhotonSettings photons;
  photons.radius = settings.Number("radius");
  // Twice the scene's radius finds all photons; less than the rounding of positions finds none.
  const auto size = static_cast<double>(input.scene.lighting->SceneSphere().radius);
  if (photons.radius > 0 && size > 0) photons.radius = std::clamp(photons.radius, 1e-7 * size, 2 * size);
  photons.volume = VolumeRadiusOf(input, photons.radius);
  photons.alpha = settings.Number("alpha");
  photons.lightPaths = static_cast<uint64_t>(std::max<int64_t>(settings.Integer("photons"), 0));
  photons.mostBytes = static_cast<uint64_t>(settings.Integer("photon-memory"));
  photons.guided = settings.IsOn("guide-photons");
  return photons;
}

}  // namespace lampyr
