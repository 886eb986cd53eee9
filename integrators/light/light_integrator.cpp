// Light tracing: paths start at the lights and in media that glow, and each of their vertices is connected to the
// camera ([Veach97 §10.3.1], the techniques with t = 1; particle tracing of [Dutré93]).
//
// Finds what path tracing cannot: caustics of point, spot and distant lights on anything that is not perfectly smooth.
// Cannot find: what the camera sees in or through something perfectly smooth (a mirror, a pane, glass), because delta
// vertices cannot be connected; lights at infinity seen directly (the background), which have no point to connect; and
// light of lights with traceLightPaths off, which start no paths. These parts of the image are black; all others are
// unbiased. Objects that are small or far from the camera receive few paths, because paths follow the light and not the
// camera. Cameras that no path can be connected to (Camera::ConnectsLightPaths) are refused.
//
// Depth counts scattering events between light and camera, as for `path`. Russian roulette enters the throughput only.
#include <algorithm>
#include <limits>

#include "integrators/walk/flight_points.h"
#include "integrators/walk/integrator_type.h"
#include "integrators/walk/lens.h"
#include "integrators/walk/light_path.h"

namespace lampyr {

namespace {

// Connects where the path starts, each vertex, and a point of each flight through media to the camera.
class LensConnector final : public LightPathVisitor {
 public:
  // `points`: null: no points of flights are connected.
  LensConnector(const SampleContext& context, int maxDepth, const FlightPoints* points)
      : context_(context), maxDepth_(maxDepth), points_(points) {}
  void Emitted(const EmittedPhoton& photon) override {
    const auto seen = SeeLight(context_, photon, dimensions::kLens);
    if (seen) AddStart(*seen, context_.outputs ? context_.outputs->OfLight(photon.light) : 0);
  }
  void Glowed(LightPath&, const EmittedInMedium& emitted) override {
    const auto seen = SeeGlow(context_, emitted, dimensions::kLens);
    if (seen) AddStart(*seen, context_.outputs ? context_.outputs->OfMedia() : 0);
  }
  bool WantsFlights() const override { return points_ != nullptr; }
  void Flew(LightPath& path, const PathState& state, const Flight& flight, const EmittedPhoton* photon) override {
    const size_t count = path.vertices.Count();
    start_ = flight.line.start;
    startsAnywhere_ = count == 0 && photon && context_.scene.lighting->IsAtInfinity(photon->light);
    if (static_cast<int>(count) >= maxDepth_ || context_.IsCounted(state.isDispersed)) return;
    const auto dimension = [count](uint32_t which) {
      return PathDimensions().OfSegment(static_cast<int>(count), which);
    };
    if (!AddFlightVertex(context_, *points_, state, flight, photon, context_.sampler,
                         dimension(dimensions::kSegmentChoice), path))
      return;
    const double ratio = RatioAt(path.vertices.Last());
    if (ratio > 0) Connect(path, dimension(dimensions::kSegmentLight), 1 / (1 + 1 / Mis(ratio)));
    path.vertices.Drop();
  }
  void Arrived(LightPath& path, const PathState&) override {
    const uint32_t lens = PathDimensions().Of(static_cast<int>(path.vertices.Count()), dimensions::kLight);
    Connect(path, lens, points_ ? 1 / (1 + Mis(RatioAt(path.vertices.Last()))) : 1.0);
  }

 private:
  // `weight`: MIS weight of the technique that found the vertex: a collision, or a sampled point of a flight.
  void Connect(const LightPath& path, uint32_t lensDimension, double weight) {
    const auto seen = SeeVertex(context_, path.vertices.Last(), lensDimension);
    if (!seen) return;
    AddSplats(context_, seen->connection, seen->value * static_cast<float>(weight),
              LabelsTowardsLens(context_, path.vertices, *seen));
  }
  double RatioAt(const PathVertex& vertex) const {
    const double distance =
        startsAnywhere_ ? std::numeric_limits<double>::infinity() : glm::distance(vertex.Position(), start_);
    return points_->RatioAt(vertex, vertex.toPrevious, distance, vertex.factors.forward);
  }
  void AddStart(const SeenFromLens& seen, uint32_t source) {
    const PathLabel label[] = {{source}};
    AddSplats(context_, seen.connection, seen.value, label);
  }

  const SampleContext& context_;
  const int maxDepth_;
  const FlightPoints* points_;
  Point3d start_{0.0};           // start of the last flight
  bool startsAnywhere_ = false;  // the last flight comes from a light at infinity
};

class LightIntegrator final : public Integrator {
 public:
  LightIntegrator(int maxDepth, std::unique_ptr<const GlowingMedia> glowing,
                  std::shared_ptr<const FlightPoints> flightPoints)
      : maxDepth_(maxDepth), glowing_(std::move(glowing)), flightPoints_(std::move(flightPoints)) {}

  TracedPaths Paths() const override { return TracedPaths::Light; }
  Color Sample(const Ray*, const SampleContext& context) const override {
    thread_local LightPath path(false);
    LensConnector visitor(context, maxDepth_, flightPoints_.get());
    TraceLightPath(context, maxDepth_, {}, path, visitor, glowing_.get());
    return Color(0.0f);
  }

 private:
  int maxDepth_;
  std::unique_ptr<const GlowingMedia> glowing_;
  std::shared_ptr<const FlightPoints> flightPoints_;
};

std::vector<std::string> Hints(const RenderScene& scene) {
  std::vector<std::string> hints;
  const std::vector<PlacedLight>& lights = scene.lighting->Lights();
  const bool hasBackground = std::any_of(lights.begin(), lights.end(), [](const PlacedLight& placed) {
    return placed.light->Kind() == LightKind::Infinite && placed.light->Settings().cameraVisible;
  });
  if (hasBackground) {
    hints.push_back(
        "no path from a light behind everything can be connected to the camera, so the background stays black; "
        "--integrator path and bdpt show it");
  }
  if (HasSmoothMaterial(scene)) {
    hints.push_back(
        "no path from a light can be connected to the camera at a mirror or smooth glass, so these stay black; "
        "--integrator bdpt shows them");
  }
  if (const std::string without = LightsWithoutPaths(scene); !without.empty())
    hints.push_back("lights with \"traceLightPaths\" off (" + without +
                    " lights) start no paths, and their light is missing; --integrator path and bdpt find it");
  return hints;
}

std::string Refusal(const RenderScene& scene) {
  if (scene.camera->ConnectsLightPaths()) return "";
  return "light tracing cannot see through the elements of this camera's lens: the density with which a path leaves a "
         "light for one film point is not known there; path, bdpt, vcm and sppm can";
}

}  // namespace

IntegratorType LightIntegratorType() {
  IntegratorType type;
  type.name = "light";
  type.help = "paths from the lights, each vertex connected to the camera";
  type.settings = {&common_settings::kMaxDepth};
  type.create = [](const IntegratorInput& input) {
    return std::make_unique<LightIntegrator>(MaxDepthOf(input.settings), GlowingMediaOf(input),
                                             FlightPoints::Of(input.scene));
  };
  type.hints = Hints;
  type.refusal = Refusal;
  return type;
}

}  // namespace lampyr
