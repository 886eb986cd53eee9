// Connecting a vertex of a light path to the camera, and splatting what it carries ([Veach97 §10.3.4.1]; the weight of
// a connection is in camera/camera.h).
#pragma once

#include <optional>

#include "camera/camera.h"
#include "film/splats.h"
#include "integrators/integrator.h"

namespace lampyr {

// A connection that lands on film that is wanted.
struct FilmConnection {
  CameraConnection camera;
  FilmCopies copies;  // where else it lands

  // What the measured value of unit radiance along the connection is, per pixel² and per 1/(m² sr) of density.
  float Weight() const { return camera.importance / camera.pdfLensSolidAngle; }
};

// The position on the lens is chosen by `dimension`; nothing is drawn for a pinhole.
inline std::optional<FilmConnection> ConnectToCamera(const Camera& camera, const Point3& position, uint32_t dimension,
                                                     Sampler& sampler, const SplatList& splats) {
  Point2 lens(0.5f);
  if (!camera.HasPinhole()) {
    sampler.SetDimension(dimension);
    lens = sampler.Get2D();
  }
  const auto connection = camera.Connect(position, lens);
  if (!connection) return std::nullopt;
  FilmConnection result{*connection, camera.CopiesOf(connection->film)};
  bool reaches = splats.Reaches(connection->film);
  for (int i = 0; i < result.copies.count; ++i) {
    reaches = reaches || splats.Reaches(result.copies.points[static_cast<size_t>(i)]);
  }
  if (!reaches) return std::nullopt;
  return result;
}

// Adds `value`, of a light of `group`, wherever the connection lands. A value that is not finite or negative is dropped
// and counted.
inline void AddSplats(const FilmConnection& connection, const Color& value, uint32_t group, SplatList& splats,
                      RenderCounts& counts) {
  bool isValid = splats.Add(connection.camera.film, value, group);
  for (int i = 0; i < connection.copies.count; ++i) {
    isValid &= splats.Add(connection.copies.points[static_cast<size_t>(i)], value, group);
  }
  if (!isValid) ++counts.droppedSamples;
}

}  // namespace lampyr
