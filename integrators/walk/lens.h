// What the camera sees of a light path: its vertices, and the point of the light that it left from, connected to the
// lens ([Veach97 §10.3.4.1]; the weight of a connection is in camera/camera.h). And what it sees without one: lights
// at infinity.
#pragma once

#include <optional>

#include "integrators/walk/integrator.h"
#include "integrators/walk/vertex.h"

namespace lampyr {

// A connection that lands on film that is wanted.
struct FilmConnection {
  CameraConnection camera;
  FilmCopies copies;  // where else it lands

  // The measured value of unit radiance along the connection, per pixel² and per 1/(m² sr) of density.
  float Weight() const { return camera.importance / camera.pdfLensSolidAngle; }
};

// A connection that nothing is in the way of.
struct SeenFromLens {
  FilmConnection connection;
  Vector3 toCamera{0.0f};  // unit
  Color value;             // of the whole path, unweighted
  float geometryTerm = 0;  // of the point
  BsdfEvaluation f;        // of a surface vertex
};

// A point of an area light as the camera sees it. The ray goes from the camera, so that cut-outs and what is invisible
// to cameras are met as any camera ray meets them. The point of the lens is chosen by `lensDimension`; nothing is drawn
// for a pinhole.
std::optional<SeenFromLens> SeeLight(const SampleContext& context, const EmittedPhoton& photon, uint32_t lensDimension);

// A vertex of a light path. Nothing where it is a delta, or the camera does not see its surface.
std::optional<SeenFromLens> SeeVertex(const SampleContext& context, const PathVertex& vertex, uint32_t lensDimension);

// Adds `value`, of a light of `group`, wherever the connection lands. A value that is not finite or negative is dropped
// and counted.
void AddSplats(const FilmConnection& connection, const Color& value, uint32_t group, SplatList& splats,
               RenderCounts& counts);

// All lights at infinity that a camera ray sees that meets nothing, times `throughput`: what is left of them on their
// way.
Color EscapedEmissionForCamera(const SampleContext& context, const Ray& ray, const Color& throughput);

}  // namespace lampyr
