#include "agreement/weight_proof.h"

#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>

#include "integrators/bidirectional/beam_merge.h"
#include "integrators/bidirectional/bidirectional_integrator.h"
#include "integrators/bidirectional/full_path.h"
#include "integrators/bidirectional/subpath_weights.h"
#include "support/aimed.h"
#include "support/random_guide.h"
#include "support/render_scene.h"

namespace lampyr::test {

void InputCheck::Note(double value, double expected) {
  ++asked;
  if (!(std::abs(value - expected) <= 1e-2 * std::abs(expected))) ++wrong;
}

std::string WeightErrors::WhatIsWrong() const {
  if (!(sum < 1e-6)) return "sum";
  if (!(recursion < 1e-6)) return "recursion";
  // Densities are floats, here of the event as seen from the other end: narrow lobes amplify how directions are
  // rounded.
  if (!(reported < 5e-5)) return "reported";
  if (!(groups < 2e-4)) return "groups";
  if (!direct.Passes()) return "direct";
  if (!emission.Passes()) return "emission";
  if (!lens.Passes()) return "lens";
  if (!mergesPerDensity.Passes()) return "merges";
  if (!connections.Passes()) return "connections";
  if (!refraction.Passes()) return "refraction";
  return "";
}

namespace {

constexpr uint32_t kLightPaths = 2000;  // that leave photons

// A light path that leaves photons, kept whole, so that a merge can be unfolded: a photon is known by what it carries.
struct KeptPath {
  std::vector<PathVertex> vertices;
  LightEnd end;
  double endDistance = 0;  // of the first vertex from the light
  Point3d start{0.0};      // of a flight
};
class KeptLightPaths {
 public:
  void Keep(const LightPath& path, const LightEnd& end, double endDistance) {
    const PathVertex& last = path.vertices.Last();
    const size_t count = path.vertices.Count();
    const double distance =
        count > 1 ? glm::distance(last.Position(), path.vertices[count - 2].Position()) : endDistance;
    photons.Add(last, count, std::nullopt,
                flightPoints ? flightPoints->RatioAt(last, last.toPrevious, distance, last.factors.forward) : 0.0);
    const auto vertices = path.vertices.First(count);
    paths_[KeyOf(last.toPrevious, photons.Photons().back().diffuse, photons.Photons().back().weight,
                 static_cast<double>(WideFloat(last.previousSolidAnglePerArea.value)), count)] = {
        {vertices.begin(), vertices.end()}, end, endDistance};
  }
  const KeptPath& PathOf(const Photon& photon) const {
    return paths_.at(KeyOf(photon.toPrevious, photon.flux, photon.weight,
                           static_cast<double>(photon.previousSolidAnglePerArea), photon.depth));
  }

  // The path from whose last vertex the next flight starts.
  void KeepFlight(const LightPath& path, const LightEnd& end, double endDistance, const Point3d& start) {
    const auto vertices = path.vertices.First(path.vertices.Count());
    flights_.push_back({{vertices.begin(), vertices.end()}, end, endDistance, start});
  }
  KeptPath PathOf(const BeamVertex& beam, uint32_t flight) const {
    KeptPath path = flights_.at(flight);
    if (path.vertices.empty()) {
      path.end = beam.end;
      path.endDistance = beam.end.extent == LightEnd::Extent::Sky ? std::numeric_limits<double>::infinity()
                                                                  : glm::distance(beam.vertex.Position(), path.start);
    }
    path.vertices.push_back(beam.vertex);
    return path;
  }

  PhotonList photons;
  std::vector<SubpathDensities> densities;  // of the current path
  PathEnds ends;
  VolumeRadius volume;
  std::shared_ptr<const FlightPoints> flightPoints;

 private:
  using Key = std::array<double, 10>;
  static Key KeyOf(const Vector3& d, const Color& c, const PhotonWeight& weight, double edge, size_t depth) {
    return {d.x, d.y, d.z, c.r, c.g, c.b, weight.endsEarlier, weight.second, edge, static_cast<double>(depth)};
  }
  std::map<Key, KeptPath> paths_;
  std::vector<KeptPath> flights_;
};

class KeepsPaths final : public WeightedLightPath {
 public:
  KeepsPaths(const SampleContext& context, double lightPaths, KeptLightPaths& kept)
      : WeightedLightPath(context, true, lightPaths), kept_(kept) {}

  // For the next path.
  void Start() { flightsBelow_ = FlightsBelow(kept_.volume, context_.sampler, {2, 1}); }
  bool WantsFlights() const override { return flightsBelow_ < 1; }
  bool WantsBeams() const override { return WantsFlights(); }
  bool FirstHit(const EmittedPhoton& photon, PathVertex& first) override {
    const bool isAtInfinity = context_.scene.lighting->IsAtInfinity(photon.light);
    endDistance_ = isAtInfinity ? std::numeric_limits<double>::infinity()
                                : glm::distance(first.Position(), Point3d(photon.emission.position));
    return WeightedLightPath::FirstHit(photon, first);
  }
  void Flew(LightPath& path, const PathState& state, const Flight& flight, const EmittedPhoton* photon) override {
    const size_t before = kept_.photons.Beams().starts.size();
    SampleContext keeping = context_;
    keeping.photons = &kept_.photons;
    AddFlight(keeping, kept_.volume, flightsBelow_, path, state, flight, *photon);
    if (kept_.photons.Beams().starts.size() > before) kept_.KeepFlight(path, End(), endDistance_, flight.line.start);
    if (path.vertices.Count() == 1) SetEnds(path.vertices[0]);
  }

 private:
  void SetEnds(const PathVertex& first) {
    kept_.ends.firstIsDelta = first.scatteredDelta;
    if (kept_.ends.canBeHit) kept_.ends.hit = first.PreviousReverse(first.eventReverse).value;
  }
  void OnWeighted(const LightPath& path) override {
    AddDensities(path.vertices, kept_.volume, true, kept_.densities);
    const PathVertex& first = path.vertices[0];
    if (path.vertices.Count() == 1) {
      kept_.densities[0] = FirstDensities(End(), first.IsInMedium());
      kept_.ends = {.direct = End().direct.value, .canBeHit = End().canBeHit};
    } else if (path.vertices.Count() == 2) {
      SetEnds(first);
    }
    const PathVertex& last = path.vertices.Last();
    if (last.storesPhotons && !IsOnBeam(last, kept_.volume)) kept_.Keep(path, End(), endDistance_);
  }
  KeptLightPaths& kept_;
  double flightsBelow_ = 1;
  double endDistance_ = 0;
};

double CosineAtGeometry(const PathVertex& vertex, const Vector3& direction) {
  if (vertex.IsInMedium()) return 1;
  return std::abs(glm::dot(Vector3d(vertex.bsdf.Ng()), Vector3d(direction)));
}

class WeightChecker final : public PathObserver {
 public:
  // `pixels`: WeightProof.
  WeightChecker(const RenderScene& scene, const KeptLightPaths& kept, double mergesPerDensity, const WeightProof& proof)
      : scene_(scene),
        kept_(kept),
        mergesPerDensity_(mergesPerDensity),
        pixels_(static_cast<double>(proof.pixels)),
        counts_(proof.counts),
        isCounted_(counts_.log2LightPaths != 0 || counts_.connecting.Mean() < 1 || counts_.merging.Mean() < 1 ||
                   counts_.continuing.Mean() < 1) {}

  // Starts the sample to which the following paths belong.
  void StartSample(const Ray& cameraRay, const Point2& film, float time) {
    cameraRay_ = cameraRay;
    start_ = film;
    time_ = time;
  }
  void ObserveMerge(const ConnectedPath& path, const Photon& photon) override {
    const KeptPath& light = kept_.PathOf(photon);
    if (photon.depth != light.vertices.size()) throw std::logic_error("a photon of another path");
    ++worst_.merges;
    ObserveMerge(path, light);
  }
  void ObserveBeamMerge(const ConnectedPath& path, const BeamVertex& beam, uint32_t flight) override {
    const KeptPath light = kept_.PathOf(beam, flight);
    if (beam.photon.depth != light.vertices.size()) throw std::logic_error("a beam of another path");
    ++worst_.beams;
    ObserveMerge(path, light);
  }
  bool WantsSums() const override { return !isCounted_; }
  void Observe(const ConnectedPath& path) override {
    const FullPath full = Unfold(path);
    const std::vector<double> expected = WeightsByDensities(full), recursive = WeightsByRecursion(full);
    ++worst_.paths;
    if (!path.isMerged) ++worst_.perTechnique[{path.s, path.t}];
    double sum = 0;
    for (size_t s = 0; s < expected.size(); ++s) {
      sum += recursive[s];
      worst_.recursion = std::max(worst_.recursion, std::abs(recursive[s] - expected[s]));
    }
    worst_.sum = std::max(worst_.sum, std::abs(sum - 1));
    worst_.reported = std::max(worst_.reported, std::abs(path.weight - expected[static_cast<size_t>(full.technique)]));
    if (!isCounted_ && path.merging && full.SurfaceCount() > 0) CompareSums(path.sums, SumsByDensities(full));
    CheckInputs(path);
  }
  const WeightErrors& Result() const { return worst_; }

 private:
  void ObserveMerge(ConnectedPath path, const KeptPath& light) {
    path.light = light.vertices;
    path.end = light.end;
    path.toLight = light.vertices[0].toPrevious;
    path.endFactors = light.vertices[0].factors;
    path.endDistance = light.endDistance;
    Observe(path);
  }

  // Compares the weights of the groups by the power heuristic, and by third powers.
  void CompareSums(TechniqueSums sums, TechniqueSums expected) {
    double all = 0, allExpected = 0;
    for (size_t i = 0; i < kTechniqueGroups; ++i) {
      all += sums.groups[i].squares;
      allExpected += expected.groups[i].squares;
    }
    ++worst_.sums;
    if (sums.isBeyond != expected.isBeyond) worst_.groups = 1;
    if (!(all > 0) || !std::isfinite(all) || !(allExpected > 0)) {
      worst_.groups = 1;
      return;
    }
    for (size_t i = 0; i < kTechniqueGroups; ++i) {
      const TechniqueSums::Group &a = sums.groups[i], &b = expected.groups[i];
      worst_.groups = std::max({worst_.groups, std::abs(a.squares / all - b.squares / allExpected),
                                std::abs(a.cubes / std::pow(all, 1.5) - b.cubes / std::pow(allExpected, 1.5))});
    }
  }
  void CheckInputs(const ConnectedPath& path) {
    if (path.light.empty() && path.camera.empty()) return;
    if (path.s + path.t > 2) {
      CheckMerging(path);
      const auto connections = static_cast<double>(counts_.connecting.At(FilmOf(path)));
      const double lightPaths = counts_.LightPaths();
      worst_.connections.Note(path.connectionCount, Sqr(lightPaths > 1 ? connections / lightPaths : connections));
      worst_.connections.Note(path.continuing, static_cast<double>(counts_.continuing.At(FilmOf(path))));
    }
    // With media these have factors of estimated transmittance, which the sums and the agreement of means prove.
    if (scene_.media.empty()) CheckLens(path);
    if (scene_.media.empty() && !path.isMerged) CheckLightEnd(path);
    for (size_t i = 0; i + 1 < path.camera.size(); ++i) {
      const PathVertex& vertex = path.camera[i];
      CheckRefraction(vertex, -path.camera[i + 1].toPrevious, vertex.toPrevious, vertex.eventForward,
                      vertex.eventReverse);
    }
    for (size_t i = 0; i + 1 < path.light.size(); ++i) {
      const PathVertex& vertex = path.light[i];
      CheckRefraction(vertex, vertex.toPrevious, -path.light[i + 1].toPrevious, vertex.eventReverse,
                      vertex.eventForward);
    }
  }

  const Point2& FilmOf(const ConnectedPath& path) const {
    return path.connection ? path.connection->camera.film : start_;
  }

  // Whichever technique made the path, the radius is that of its first vertex from the camera without a delta.
  void CheckMerging(const ConnectedPath& path) {
    const double expected =
        mergesPerDensity_ * static_cast<double>(counts_.merging.At(FilmOf(path))) / counts_.LightPaths();
    if (pixels_ == 0) {
      worst_.mergesPerDensity.Note(path.merging.perDensity, expected);
      return;
    }
    const PathVertex& vertex = path.camera.empty() ? path.light.back() : path.camera.front();
    const Point3 lens = path.camera.empty() ? path.connection->camera.position : cameraRay_.origin;
    if (!scene_.camera->EvaluateRay({lens, -path.toLens}, &film_)) return;
    double area = SeenArea(vertex, path.toLens);
    if (!path.camera.empty() && !scene_.camera->ConnectsByDirection()) {
      double length = glm::distance(Vector3d(lens), Vector3d(vertex.point.position));
      const double first = length;
      // Along the rays: a vertex of merging is beside its ray.
      for (size_t i = 0; i + 1 < path.camera.size() && path.camera[i].scatteredDelta; ++i) {
        const Vector3d way = Vector3d(path.camera[i].point.position) - Vector3d(path.camera[i + 1].point.position);
        length += glm::dot(way, Vector3d(path.camera[i + 1].toPrevious));
      }
      area *= length / first * length / first;
    }
    if (area > 0) worst_.mergesPerDensity.Note(path.merging.perDensity, expected * pixels_ * pixels_ * area);
  }
  // Area of a pixel around film_ on the plane of a vertex, turned towards the camera, by rays through the corners of a
  // square. 0: unknown.
  double SeenArea(const PathVertex& vertex, const Vector3& toLens) const {
    constexpr float kSide = 0.01f;  // pixels
    const Vector3d n(vertex.IsInMedium() ? toLens : vertex.bsdf.Ng());
    Vector3d corners[3];
    // The path's point on the lens of a camera is not known.
    const CameraRay center = scene_.camera->GenerateRay(film_, Point2(0.5f), time_);
    if (glm::distance(center.ray.direction, -toLens) > 1e-4f) return 0;
    for (int i = 0; i < 3; ++i) {
      const Point2 film = film_ + kSide * Point2(i == 1 ? 0.5f : -0.5f, i == 2 ? 0.5f : -0.5f);
      const CameraRay ray = scene_.camera->GenerateRay(film, Point2(0.5f), time_);
      const double cosine = glm::dot(n, Vector3d(ray.ray.direction));
      if (ray.weight == 0 || std::abs(cosine) < 0.2) return 0;
      const Vector3d origin(ray.ray.origin);
      corners[i] =
          origin + Vector3d(ray.ray.direction) * (glm::dot(Vector3d(vertex.point.position) - origin, n) / cosine);
    }
    const double area = glm::length(glm::cross(corners[1] - corners[0], corners[2] - corners[0]));
    return area * CosineAtGeometry(vertex, toLens) / (static_cast<double>(kSide) * static_cast<double>(kSide));
  }

  // The density (area) with which the camera finds its first vertex, from where the path meets the lens.
  void CheckLens(const ConnectedPath& path) {
    if (path.camera.empty() && !path.connection) return;
    const PathVertex& vertex = path.camera.empty() ? path.light.back() : path.camera.front();
    const Point3 lens = path.camera.empty() ? path.connection->camera.position : cameraRay_.origin;
    const auto densities = scene_.camera->EvaluateRay({lens, -path.toLens}, &film_);
    if (!densities || !(path.atLens.value > 0)) return;
    const Vector3d way = Vector3d(vertex.point.position) - Vector3d(lens);
    const double cosine = CosineAtGeometry(vertex, path.toLens);
    worst_.lens.Note(path.atLens.value,
                     scene_.camera->ConnectsByDirection()
                         ? static_cast<double>(densities->pdfPosition.value) * cosine
                         : static_cast<double>(densities->pdfDirection.value) * cosine / glm::dot(way, way));
  }

  // The light as a ray from the first surface vertex finds it.
  std::optional<FoundLight> FindLight(const ConnectedPath& path, const PathVertex& first, double& distance) const {
    const LightingServices& lighting = *scene_.lighting;
    for (size_t i = 0; i < lighting.InfiniteCount(); ++i) {
      const auto found = lighting.EvaluateEscaped(i, first.receiver, path.toLight, time_, true);
      if (found && found->light == path.end.light) return found;
    }
    if (lighting.IsAtInfinity(path.end.light)) return std::nullopt;
    const Ray ray = SpawnRay(first.point, path.toLight, time_);
    RayHit hit;
    Color passed;
    if (!scene_.geometry->Intersect(ray, visibility::kIndirect, hit, passed)) return std::nullopt;
    const SurfacePoint point = scene_.geometry->GetSurfacePoint(ray, hit);
    distance = glm::distance(Vector3d(point.position), Vector3d(first.point.position));
    const auto found =
        lighting.EvaluateSamples(first.receiver, path.toLight, static_cast<float>(distance), point, time_, true);
    return found && found->light == path.end.light ? found : std::nullopt;
  }
  void CheckLightEnd(const ConnectedPath& path) {
    const LightingServices& lighting = *scene_.lighting;
    if (path.end.direct.value == 0 || path.end.emission.value == 0) return;  // one of them is not there
    const PathVertex& first = path.light.empty() ? path.camera.back() : path.light.front();
    const PlacedLight& placed = lighting.Lights()[path.end.light];
    if (IsDelta(placed.light->Kind())) {
      worst_.direct.Note(path.end.direct.value,
                         static_cast<double>(lighting.SelectionProbability(first.receiver, path.end.light, 0).value));
      return;
    }
    double distance = 1;
    const auto found = FindLight(path, first, distance);
    if (!found) return;
    const LightEvaluation& e = found->evaluation;
    if (e.pdfDirect.IsZero() || e.pdfEmit.IsZero() || e.pdfEmitDirection.IsZero()) return;
    const double cosine = CosineAtGeometry(first, path.toLight);
    if (cosine < 1e-3) return;
    worst_.direct.Note(path.end.direct.value, static_cast<double>(found->selection.value) *
                                                  static_cast<double>(e.pdfDirect.value) *
                                                  static_cast<double>(e.solidAngleToArea));
    const double chosen = static_cast<double>(lighting.EmissionSelectionProbability(path.end.light).value);
    worst_.emission.Note(path.end.emission.value, counts_.LightPaths() * chosen * static_cast<double>(e.pdfEmit.value) *
                                                      static_cast<double>(e.pdfEmitDirection.value) * cosine /
                                                      (distance * distance));
  }

  // A delta that refracts: the density towards the light over that towards the camera is how solid angles are
  // stretched, η_l² cosθ_l / (η_c² cosθ_c), and Snell's law says η.
  void CheckRefraction(const PathVertex& vertex, const Vector3& toLight, const Vector3& toCamera,
                       SolidAngleDensity densityToLight, SolidAngleDensity densityToCamera) {
    // A dispersive dielectric reflects with the mean probability of its lanes, which is not the same on both sides.
    if (!vertex.scatteredDelta || vertex.bsdf.IsDispersive()) return;
    const Vector3d n(vertex.bsdf.ShadingFrame().z);
    const double cosLight = glm::dot(n, Vector3d(toLight)), cosCamera = glm::dot(n, Vector3d(toCamera));
    if (cosLight * cosCamera > 0) return;                                                    // reflected
    const double sinLight = 1 - cosLight * cosLight, sinCamera = 1 - cosCamera * cosCamera;  // squared
    if (sinLight < 0.02 || sinCamera < 0.02 || std::abs(cosLight) < 0.05 || std::abs(cosCamera) < 0.05) return;
    worst_.refraction.Note(densityToLight / densityToCamera,
                           sinCamera / sinLight * std::abs(cosLight) / std::abs(cosCamera));
  }

  const RenderScene& scene_;
  const KeptLightPaths& kept_;
  const double mergesPerDensity_, pixels_;
  const TechniqueCounts counts_;
  const bool isCounted_;
  Point2 start_;
  Ray cameraRay_;
  float time_ = 0;
  Point2 film_;
  WeightErrors worst_;
};

}  // namespace

namespace {

// Data of the photons, if the proof merges.
struct Photons {
  KeptLightPaths kept;
  PhotonPass gather;
};

void TracePhotons(const RenderScene& scene, int maxDepth, float radius, double lightPaths, Sampler& sampler,
                  Photons& photons) {
  photons.gather.lightPaths = kLightPaths;
  photons.gather.radius = radius;
  RenderCounts counts;
  LightPath path;
  SampleContext context{scene, sampler, 0.5f, counts};
  KeepsPaths visitor(context, lightPaths, photons.kept);
  for (uint32_t i = 0; i < kLightPaths; ++i) {
    sampler.StartPixelSample(1, 0, i);
    photons.kept.photons.StartPath();
    visitor.Start();
    context.lane = static_cast<int>(i % Wavelengths::kLanes);
    photons.kept.densities.clear();
    TraceLightPath(context, maxDepth, {2, 1}, path, visitor);
    photons.kept.photons.KeepDensities(photons.kept.ends, photons.kept.densities);
  }
  photons.gather.map =
      std::make_shared<PhotonMap>(std::span(&photons.kept.photons, 1), 1, nullptr, photons.gather.volume);
}

}  // namespace

WeightErrors CheckWeights(const std::string& sceneText, const WeightProof& proof) {
  Diagnostics diagnostics(Diagnostics::Mode::Collect);
  const std::filesystem::path file = std::filesystem::path(LAMPYR_SOURCE_DIR) / "scenes" / "test.pbrt";
  const BuiltScene built = BuildScene(ParseScene(sceneText, file, diagnostics), {}, true, diagnostics);
  const BoundingSphere& sphere = built.scene.lighting->SceneSphere();
  const auto guide = AimAt(*built.scene.lighting, sphere.center, 0.2f * sphere.radius);
  RenderScene scene = built.scene;
  if (scene.isSpectral) scene = scene.AtWavelengths(std::make_shared<const Wavelengths>(Wavelengths::OfPass(0, 1)), {});
  if (proof.aimed)
    scene.lighting = std::make_shared<const LightingServices>(scene.lighting->With(nullptr, guide.get()));
  if (proof.isGuided) scene.guide = RandomGuide(sphere);
  BidirectionalSettings settings;
  settings.maxDepth = built.settings.MaxDepth();
  const int width = built.settings.width, height = built.settings.height;
  settings.filmPixels = static_cast<double>(width) * static_cast<double>(height);
  settings.splatCount = proof.splatCount;
  settings.merges = proof.radius > 0 || proof.pixels > 0;
  settings.counts = proof.counts;
  settings.photons.radius = static_cast<double>(proof.radius * sphere.radius);
  settings.photons.volume.constant = 0.02 * static_cast<double>(sphere.radius);
  if (proof.beamShare > 0) {
    for (const auto& medium : scene.media) settings.photons.volume.usesBeams.push_back(medium->IsHomogeneous());
    settings.photons.volume.beamShare = static_cast<double>(proof.beamShare);
    settings.photons.volume.scatteredBeamShare = std::min(2 * static_cast<double>(proof.beamShare), 1.0);
  }
  settings.flightPoints = FlightPoints::Of(scene);
  const auto integrator = MakeBidirectionalIntegrator(settings);
  Sampler sampler(SamplerKind::Independent, 5);
  Photons photons;
  double mergesPerDensity = 0;
  if (settings.merges) {
    photons.kept.volume = settings.photons.volume;
    photons.kept.flightPoints = settings.flightPoints;
    photons.gather.radiusScale = proof.pixels > 0 ? proof.pixels : 1;
    photons.gather.volume = settings.photons.volume.Scaled(static_cast<double>(photons.gather.radiusScale));
    TracePhotons(scene, settings.maxDepth, proof.radius * sphere.radius, proof.counts.LightPaths(), sampler, photons);
    const double radius = proof.radius > 0 ? static_cast<double>(photons.gather.radius) : 1.0;
    mergesPerDensity = kLightPaths * 3.14159265358979323846 * radius * radius;
  }
  WeightChecker checker(scene, photons.kept, mergesPerDensity, proof);
  RenderCounts counts;
  SplatList splats({0, 0}, {static_cast<float>(width), static_cast<float>(height)}, 1);
  for (uint32_t index = 0; checker.Result().paths < proof.paths && index < 100000; ++index) {
    sampler.StartPixelSample(0, 0, index);
    splats.Clear();
    splats.StartPath();
    sampler.SetDimension(dimensions::kFilm);
    const Point2 u = sampler.Get2D(), lens = sampler.Get2D();
    const float time = scene.hasMotion ? sampler.Get1D() : 0.0f;
    const Point2 film(u.x * static_cast<float>(width), u.y * static_cast<float>(height));
    const CameraRay ray = scene.camera->GenerateRay(film, lens, time);
    if (ray.weight == 0) continue;
    checker.StartSample(ray.ray, film, time);
    SampleContext context{scene, sampler, time, counts};
    context.lane = static_cast<int>(index % Wavelengths::kLanes);
    context.film = film;
    context.splats = &splats;
    context.observer = &checker;
    context.gather = settings.merges ? &photons.gather : nullptr;
    integrator->Sample(&ray.ray, context);
    if (proof.stopsAtFirst && !checker.Result().WhatIsWrong().empty()) break;
  }
  return checker.Result();
}

}  // namespace lampyr::test
