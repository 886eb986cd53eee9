// Connections of light paths to the lens (t = 1), from their vertices and from their starting point on a light or in a
// participating medium ([Veach97 §10.3.4.1]; the weight of a connection is in camera/camera.h). Also the emission of
// lights at infinity, which the camera sees without a connection.
#pragma once

#include <optional>

#include "integrators/walk/integrator.h"
#include "integrators/walk/light_path.h"
#include "integrators/walk/vertex.h"

namespace lampyr {

// A camera connection with at least one film point that the rendered crop covers.
struct FilmConnection {
  FilmConnection() {}  // without values for the points of `copies`, which would take longer than all else

  CameraConnection camera;
  FilmCopies copies;  // further film points that it contributes to

  // Measured pixel value of unit radiance along the connection, per pixel² and per unit of path density, 1/(m² sr).
  float Weight() const { return camera.importance / camera.pdfLensSolidAngle; }
};

// An unoccluded connection to the lens.
struct SeenFromLens {
  FilmConnection connection;
  Vector3 toCamera{0.0f};  // unit
  Color value;             // contribution of the whole path, before its MIS weight
  float geometryTerm = 0;  // at the connected point, towards the camera
  BsdfEvaluation f;        // scattering at the vertex, towards the camera
  EdgeFactors factors{};   // of the edge from the lens to the point, by participating media
};

// Connects the starting point of an emitted path on an area light to the lens; nullopt if the camera does not see it.
// The ray is traced from the camera, so that cut-outs and camera visibility apply as for any camera ray.
// `lensDimension`: sampler dimension of the lens point; not used with a pinhole.
std::optional<SeenFromLens> SeeLight(const SampleContext& context, const EmittedPhoton& photon, uint32_t lensDimension);

// Connects a vertex of a light path to the lens; nullopt if it is a delta, or the camera does not see it.
std::optional<SeenFromLens> SeeVertex(const SampleContext& context, const PathVertex& vertex, uint32_t lensDimension);

// Connects a point of a participating medium that emits to the lens: the glow that the camera sees. nullopt if it does
// not see the point.
std::optional<SeenFromLens> SeeGlow(const SampleContext& context, const EmittedInMedium& emitted,
                                    uint32_t lensDimension);

// Adds `value` at all film points of the connection. False: it is negative or not finite somewhere, and left out there.
bool AddSplats(const FilmConnection& connection, const Color& value, SplatList& splats);
// Adds them to the splats of a sample and to their layers. `labels`: of the light path on its way to the lens; empty
// without layers. Values that are left out are counted.
void AddSplats(const SampleContext& context, const FilmConnection& connection, const Color& value,
               std::span<const PathLabel> labels);
// Labels of `path` on the way from its last vertex to the lens. Valid until the next call in the thread.
std::span<const PathLabel> LabelsTowardsLens(const SampleContext& context, const Subpath& path,
                                             const SeenFromLens& seen);

// Emission of all lights at infinity along a camera ray that has left the scene, times `throughput`: the transmittance
// of what the ray crossed. Also added to SampleContext::layers.
Color EscapedEmissionForCamera(const SampleContext& context, const Ray& ray, const Color& throughput);

}  // namespace lampyr
