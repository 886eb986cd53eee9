#include "integrators/photon/photon_settings.h"

#include <algorithm>
#include <cmath>

#include "integrators/walk/flight_points.h"
#include "integrators/walk/footprint.h"

namespace lampyr {

namespace {

// Radius of photons in media in the first pass by default, in pixel footprints.
constexpr double kVolumeRadiusInPixels = 1;
// A photon's radius is that of a pixel at this distance behind it, in radii of the media that scatter: contributions of
// photons near the camera would otherwise be without bound, as 1 / distance². In radii of the scene, which may be much
// larger than the media, photons would fall outside of them.
constexpr double kNearInRadii = 0.25;

BoundingSphere MediaSphereOf(const RenderScene& scene) {
  return SphereOfMedia(scene, false).value_or(scene.lighting->SceneSphere());
}

VolumeRadius VolumeRadiusOf(const IntegratorInput& input, double radius) {
  VolumeRadius volume;
  volume.constant = radius;
  if (radius > 0 || input.scene.media.empty()) return volume;
  const Camera& camera = *input.scene.camera;
  const Point2 middle(0.5f * static_cast<float>(input.width), 0.5f * static_cast<float>(input.height));
  const Ray ray = camera.GenerateRay(middle, Point2(0.5f), 0).ray;
  volume.eye = ray.origin;
  const double area = PixelArea(camera, ray, input.FilmPixels(), 1);
  // For a camera whose densities are unknown: a pixel with an angle of view of 53 degrees.
  const double width = kVolumeRadiusInPixels * (area > 0 ? std::sqrt(area) : 1 / std::sqrt(input.FilmPixels()));
  if (camera.ConnectsByDirection()) {
    volume.constant = width;
  } else {
    volume.perLength = width;
    volume.constant = width * kNearInRadii * static_cast<double>(MediaSphereOf(input.scene).radius);
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
  if (photons.radius > 0 && size > 0) photons.radius = std::clamp(photons.radius, kLeastRadius * size, 2 * size);
  photons.volume = VolumeRadiusOf(input, photons.radius);
  photons.alpha = settings.Number("alpha");
  photons.lightPaths = static_cast<uint64_t>(std::max<int64_t>(settings.Integer("photons"), 0));
  photons.mostBytes = static_cast<uint64_t>(settings.Integer("photon-memory"));
  photons.guided = settings.IsOn("guide-photons");
  return photons;
}

namespace {

// Photons in a medium are beams if the radius is below this number of mean free paths. The density of merging with
// beams is 2 sinθ / (π r σ_t) times that with points, and the share of paths that leave beams costs some of that.
constexpr double kMostRadiusInMeanFreePaths = 0.02;
// Beams that a camera ray across the picture is to pass, by their share: each merge takes longer than next-event
// estimation.
constexpr double kBeamsPerRay = 4;
// Width of the kernel between beams, relative to that of other photons in media: a narrower kernel needs more beams for
// as many merges, and blurs less. Blur is visible where beams start in the medium.
constexpr double kBeamWidth = 0.5;

}  // namespace

void UseBeams(const IntegratorInput& input, PhotonSettings& photons) {
  VolumeRadius& volume = photons.volume;
  const RenderScene& scene = input.scene;
  const BoundingSphere sphere = MediaSphereOf(scene);
  const auto radius = static_cast<double>(volume.At(sphere.center));
  volume.usesBeams.assign(scene.media.size(), 0);
  bool isUsed = false;
  double depth = 0;  // optical, of half a flight across the media
  for (size_t i = 0; i < scene.media.size(); ++i) {
    const Medium& medium = *scene.media[i];
    if (!medium.IsHomogeneous() || !medium.Scatters()) continue;
    const auto extinction = static_cast<double>(medium.At(Point3(0.0f)).Extinction().Max());
    if (!(radius * extinction < kMostRadiusInMeanFreePaths)) continue;
    volume.usesBeams[i] = 1;
    isUsed = true;
    depth = std::max(depth, extinction * static_cast<double>(sphere.radius));
  }
  if (!isUsed) volume.usesBeams.clear();
  // A beam across the picture is in the pixels of a row, twice as wide as one; of as many light paths as pixels. Where
  // there are fewer paths, more of them leave beams, which are as much narrower.
  const double pixels = input.FilmPixels();
  const double paths = photons.lightPaths > 0 ? static_cast<double>(photons.lightPaths) : pixels;
  const double share = std::min(kBeamsPerRay * std::sqrt(pixels) / (2 * kBeamWidth * paths), 1.0);
  volume.beamShare = std::min(share * input.fewer, 1.0);
  volume.beamScale = kBeamWidth * share / volume.beamShare;
  // A light path leaves a second beam only if it collides.
  volume.scatteredBeamShare = std::min(volume.beamShare / std::min(std::max(depth, 1e-3), 1.0), 1.0);
}

}  // namespace lampyr
