// What the camera sees of a light path: its vertices, and the point of the light that it left from, joined to the lens.
#pragma once

#include <optional>

#include "integrators/common/camera_connection.h"
#include "integrators/common/path_vertex.h"

namespace lampyr {

// A join that nothing is in the way of.
struct SeenFromLens {
  FilmConnection connection;
  Vector3 toCamera{0.0f};  // unit
  Color value;             // of the whole path, unweighted
  float cosTheta = 0;      // at the point, to its geometric normal
  BsdfEvaluation f;        // of a surface vertex
};

// A point of an area light as the camera sees it. The ray goes from the camera, so that cut-outs and what is invisible
// to cameras are met as any camera ray meets them. `lensDimension` chooses the point of the lens.
std::optional<SeenFromLens> SeeLight(const RenderScene& scene, const EmittedPhoton& photon, float time,
                                     uint32_t lensDimension, Sampler& sampler, const SplatList& splats,
                                     RenderCounts& counts);

// The last vertex of a light path. Nothing where it is a delta, or the camera does not see its surface.
std::optional<SeenFromLens> SeeVertex(const RenderScene& scene, const PathVertex& vertex, float time,
                                      uint32_t lensDimension, Sampler& sampler, const SplatList& splats,
                                      RenderCounts& counts);

}  // namespace lampyr
