// The techniques of a bidirectional sample. Each function makes paths by one technique, weights them (weights.h), and
// returns their contribution to the sample's own pixel or splats it.
#pragma once

#include <limits>

#include "integrators/bidirectional/beam_merge.h"
#include "integrators/bidirectional/bidirectional_integrator.h"
#include "integrators/bidirectional/connected_path.h"
#include "integrators/bidirectional/path_densities.h"
#include "integrators/bidirectional/subpath_weights.h"
#include "integrators/photon/photon_map.h"
#include "integrators/walk/next_event.h"

namespace lampyr {

// The two subpaths of a sample use alternating blocks of sampler dimensions, so that neither uses the other's.
inline constexpr PathDimensions kCameraDimensions{2, 0}, kLightDimensions{2, 1};

// The start of a flight of a light path: a vertex, the point of a light, or a light at infinity.
struct FlightStartPoint {
  Point3d position{0.0};
  bool isAnywhere = false;  // on its line: it comes from a light at infinity

  double DistanceTo(const Vertex& vertex) const {
    return isAnywhere ? std::numeric_limits<double>::infinity() : glm::distance(vertex.Position(), position);
  }
};

// State of a sample: both subpaths, and the radiance that the camera subpath has gathered so far.
struct BidirectionalSample {
  const SampleContext& context;
  const BidirectionalSettings& settings;
  const LightPath& light;
  LightEnd lightEnd{};  // of `light`
  Subpath& camera;
  PhotonLookup& lookup;
  PathDensities& whole;  // of the path that is weighted
  std::vector<SubpathDensities>&lightDensities, &cameraDensities;
  Merging merging{};  // of what the camera subpath sees
  // TechniqueCounts at the film point of the camera path: light paths for each camera path; connections for each light
  // path, squared; true if this camera path is connected, and if it is merged where it can be.
  double lightPaths = 1, connectionCount = 1;
  double connectionsPerSample = 1;  // of a camera vertex to the same vertex of a light path, on average
  bool isConnected = true, isMerged = true;
  float continuing = 1;      // TechniqueCounts::continuing where the camera path starts
  double continuesHere = 1;  // the same, if the last vertex of the camera subpath is where the path may end; else 1
  Point2 film{0.0f};         // where it starts, as a connection to the lens finds it: pixels
  float mergeRadius = 0;     // scene units
  float perArea = 1;         // proportional to 1 / mergeRadius², where radii differ: that of the scene's radius is 1
  double seenDensity = 0;    // of the first vertex of the camera subpath, as in P_C
  double flightRatio = 0;    // FlightPoints::RatioAt of the first vertex, once there is a second one
  bool lensSeesIt = false;   // light paths that reach the first vertex of the camera subpath are connected to the lens
  bool couldMerge = false;   // merging was possible at a vertex of the camera subpath
  Color radiance{};

  const LightingServices& Lighting() const { return *context.scene.lighting; }
  // Merging on the paths that a pixel sees at a path length of `distance`, where its footprint has the area
  // `footprint`, perpendicular to the path. Both are those of the first vertex from the camera that scatters by another
  // event than a delta: all techniques of a path share it, and before it nothing can be merged.
  // `film`: where it is on the film.
  Merging MergingAt(double distance, double footprint, const Point2& film) const;
  float MergeRadiusAt(double footprint) const;  // 0: nothing is merged
  // Connections for each light path in a pixel.
  double ConnectionsPerLightPathAt(const Point2& film) const {
    return settings.connects ? settings.counts.ConnectionsPerLightPath(film) : 0.0;
  }
  // Footprint at a first hit that is seen at `cosTheta` to its geometric normal and has the density `atLens` by a
  // camera ray (DensityAtLens).
  double FootprintAt(float cosTheta, AreaDensity atLens) const {
    return EdgeDensity(cosTheta, 1).value / (atLens.value * settings.filmPixels);
  }
  // Σ (p_i / p)^β over the techniques that merge, for s = 0 or 1 of the density `technique`, and for a connection.
  double MergingOfLight(const LightEnd& end, const Joint& joint, AreaDensity technique) const {
    if (!merging) return 0;
    whole.Set({}, cameraDensities, joint, end.emission.value, end.extent, merging);
    return whole.ForLight(technique.value);
  }
  double MergingOfConnection(size_t lightCount, const Joint& joint) const {
    if (!merging) return 0;
    whole.Set(std::span(lightDensities).first(lightCount), cameraDensities, joint, lightEnd.emission.value,
              lightEnd.extent, merging);
    return whole.ForConnection(lightCount);
  }
  // FlightPoints::RatioAt of the vertex that the camera sees, on a path that goes on from the camera subpath's last
  // vertex `toLight`, over an edge of the length `distance`. `collision`: of a walk that arrives there from the light.
  double FlightRatio(const Vector3& toLight, double distance, double collision) const {
    if (!settings.flightPoints) [[likely]]
      return 0;
    return camera.Count() > 1 ? flightRatio
                              : settings.flightPoints->RatioAt(camera.Last(), toLight, distance, collision);
  }
  // The partial weight of the camera subpath's last vertex. `ratio`: FlightRatio; the weights of later vertices have
  // it.
  PartialWeight CameraWeight(double ratio) const {
    return ratio > 0 && camera.Count() == 1 ? camera.Last().weight.WithFlights(ratio) : camera.Last().weight;
  }
  // TechniqueSums of the path that was weighted last. `end`, `hit`: the light's end of it, and the density with which a
  // camera path hits the light. `ratio`: FlightRatio.
  bool WantsSums() const { return merging && context.observer && context.observer->WantsSums(); }
  TechniqueSums Sums(const LightEnd& end, AreaDensity hit, bool firstIsDelta, size_t s, double ratio) const {
    return whole.Sums({.direct = end.direct.value,
                       .hit = end.canBeHit ? hit.value : 0.0,
                       .firstIsDelta = firstIsDelta,
                       .splatCount = lensSeesIt ? settings.splatCount : 0.0,
                       .flightRatio = ratio},
                      s, 0);
  }
  // TechniqueSums of a connection. `reverse`: densities of the light subpath's last vertices. `ratio`: FlightRatio.
  TechniqueSums SumsOfConnection(size_t lightCount, const ReverseDensities& reverse, double ratio) const {
    return whole.Sums(EndsOfConnection(lightCount, reverse, lensSeesIt, ratio), lightCount + 1, 0);
  }
  // The ends of such a path. `isSeen`: t = 1 may make it.
  PathEnds EndsOfConnection(size_t lightCount, const ReverseDensities& reverse, bool isSeen, double ratio) const;
  bool IsObserved() const { return context.observer != nullptr; }
  // Roulette of shadow rays; off with an observer, which receives all paths.
  ShadowRays WantedShadowRays() const { return IsObserved() ? ShadowRays{0, 0} : settings.shadowRays; }

  // Set the camera's end of `path` from the camera subpath, and its light's end from the first `count` vertices of the
  // light subpath.
  void SetCamera(ConnectedPath& path) const;
  void SetLight(ConnectedPath& path, size_t count) const;
  // Reports the path to the observer, if any. A ConnectedPath is large, so that techniques that make many of them set
  // one only for an observer.
  void Report(ConnectedPath& path) const;
};

// Area density of the vertex that a camera ray hits, over the density of the lens point: the factor of t = 2 that t = 1
// does not have.
AreaDensity DensityAtLens(const Camera& camera, const Ray& ray, float geometryTerm, double distanceSquared);

// (0,2): the camera sees an area light, or lights at infinity.
Color SeeLightAt(const BidirectionalSample& sample, const PathState& state, const RayHit& hit,
                 const SurfacePoint& point);
Color SeeBackground(const BidirectionalSample& sample, const PathState& state);
// s = 0, t > 2: after scattering, the camera subpath hits an area light at `point`, or escapes to lights at infinity.
Color HitLightAt(const BidirectionalSample& sample, const PathState& state, const SurfacePoint& point);
Color HitInfiniteLights(const BidirectionalSample& sample, const PathState& state);

// s = 1: next-event estimation at the camera subpath's last vertex.
Color EstimateDirectLight(const BidirectionalSample& sample);

// s > 1, t > 1: the first `lightCount` vertices of the light subpath, connected to the camera subpath's last.
Color Connect(const BidirectionalSample& sample, size_t lightCount);

// t = 1: the light, or the last vertex of the light subpath, connected to the lens. `start`: where its last flight
// started.
void SplatLight(const BidirectionalSample& sample, const EmittedPhoton& photon);
void SplatVertex(const BidirectionalSample& sample, const FlightStartPoint& start);
// Samples a point of the flight along the ray of `state` and connects it to the lens. `path`: the light subpath of
// `sample`, unchanged on return.
void SplatFlight(BidirectionalSample& sample, const FlightStartPoint& start, const PathState& state,
                 const Flight& flight, const EmittedPhoton& photon, Sampler& sampler, LightPath& path);

// A photon that a camera ray passes in a medium.
struct VolumeMerge {
  const Photon* photon = nullptr;
  std::span<const SubpathDensities> light;  // of its path
  // Throughput of the camera path at the photon, over the probability of passing there; without scattering.
  Color throughput;
  double kernel = 0;                  // density of the kernel, without the number of light paths
  float biasFactor = 0;               // merge_bias.h
  uint32_t use = kUnused;             // its index for PhotonUse
  std::span<const PathLabel> labels;  // of its path; empty without layers
  const BeamVertex* beam = nullptr;   // of a beam
  double flightRatio = 0;             // FlightPoints::RatioAt of its vertex
  uint32_t flight = 0;                // index of the beam's FlightStart

  static constexpr uint32_t kUnused = 0xffffffffu;
};
// Make the vertex at which the ray of `state` passes a photon, or the line of a beam. False: none, because another
// medium is there.
bool SetPointVertex(const SampleContext& context, const PathState& state, const Flight& flight, const BeamHit& hit,
                    PathVertex& vertex, VolumeMerge& merge);
bool SetCrossingVertex(const SampleContext& context, const PathState& state, const Flight& flight,
                       const BeamCrossing& crossing, PathVertex& vertex, VolumeMerge& merge);
// Sets the photon of a beam for the camera subpath's last vertex, made by SetCrossingVertex. False: it carries nothing.
bool SetBeamOf(const BidirectionalSample& sample, const BeamCrossing& crossing, BeamVertex& beam, VolumeMerge& merge);
// Merging of the camera subpath's last vertex, made by one of these, with its photon ([Křivánek14]: point–beam in two
// dimensions, beam–beam in one; the kernels are constant).
Color MergeInMedium(const BidirectionalSample& sample, const VolumeMerge& merge);

// Vertex merging: photons near the camera subpath's last vertex ([Georgiev12 §3]). Photons and the densities of their
// paths are scattered in memory, and reading them takes longer than weighting them. So photons are looked up first,
// fetched into the cache while the other techniques of the vertex are at work, and merged last.
//
// True if photons can be merged with the last vertex.
bool CanMergePhotons(const BidirectionalSample& sample);
// Indices of the photons; valid until the next lookup.
std::span<const uint32_t> FindPhotonsToMerge(const BidirectionalSample& sample);
// Fetches the densities of the photons' paths, and where their use is counted. Reads the photons themselves.
void FetchPathsOf(const BidirectionalSample& sample, std::span<const uint32_t> found);
Color Merge(const BidirectionalSample& sample, std::span<const uint32_t> found);

}  // namespace lampyr
