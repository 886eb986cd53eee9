#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

#include "detection/baseline_render.h"
#include "suite/statistics.h"

namespace lampyr::test {

namespace {

constexpr int kAcross = 101, kDown = 51, kInner = 4;  // cells, and points of a cell along each side
constexpr double kTwoPi = 6.283185307179586;

// A cap around where samples are, in azimuth and 1 - cosθ, which has equal areas.
struct Domain {
  Vector3d axis{0, 0, 1}, x{1, 0, 0}, y{0, 1, 0};
  double height = 2;

  Domain() = default;
  explicit Domain(std::span<const Vector3d> directions) {
    Vector3d sum(0.0);
    for (const Vector3d& d : directions) sum += d;
    if (glm::length(sum) < 0.05 * static_cast<double>(directions.size())) return;
    axis = glm::normalize(sum);
    x = glm::normalize(glm::cross(axis, std::abs(axis.x) < 0.7 ? Vector3d(1, 0, 0) : Vector3d(0, 1, 0)));
    y = glm::cross(axis, x);
    double farthest = 0;
    for (const Vector3d& d : directions) farthest = std::max(farthest, 1 - glm::dot(axis, d));
    height = farthest > 0.6 ? 2.0 : 1.3 * farthest;
  }
  Vector3 Direction(double u, double v) const {
    const double c = 1 - height * v, s = std::sqrt(std::max(1 - c * c, 0.0)), phi = kTwoPi * u;
    return Vector3(glm::normalize(s * std::cos(phi) * x + s * std::sin(phi) * y + c * axis));
  }
  // The cell of a direction; the last one is outside.
  size_t CellOf(const Vector3d& d) const {
    const double v = (1 - glm::dot(axis, d)) / height;
    double u = std::atan2(glm::dot(d, y), glm::dot(d, x)) / kTwoPi;
    u -= std::floor(u);
    if (v >= 1) return kAcross * kDown;
    const auto i = std::min(static_cast<size_t>(u * kAcross), size_t{kAcross - 1});
    return std::min(static_cast<size_t>(std::max(v, 0.0) * kDown), size_t{kDown - 1}) * kAcross + i;
  }
};

using Draw = std::function<std::optional<Vector3>(Rng&)>;
using Density = std::function<double(const Vector3&)>;

// One sampling function and its density.
struct Sampled {
  std::string name;
  Draw draw;
  Density density;
};

// ∫ density over each cell by the trapezoid rule.
std::vector<double> Tabulate(const Domain& domain, const Density& density) {
  std::vector<double> cells(kAcross * kDown + 1, 0.0);
  const double area = kTwoPi * domain.height / (kAcross * kDown);
  for (size_t cell = 0; cell + 1 < cells.size(); ++cell) {
    for (int k = 0; k < kInner * kInner; ++k) {
      const int i = k % kInner, j = k / kInner;
      const auto inside = [](int n) { return (n + 1e-4) / (kInner - 1) * (1 - 2e-4); };
      const double u = (static_cast<double>(cell % kAcross) + inside(i)) / kAcross;
      const double v = (static_cast<double>(cell / kAcross) + inside(j)) / kDown;
      const double weight = (i == 0 || i == kInner - 1 ? 0.5 : 1) * (j == 0 || j == kInner - 1 ? 0.5 : 1);
      cells[cell] += weight * area / ((kInner - 1) * (kInner - 1)) * density(domain.Direction(u, v));
    }
  }
  return cells;
}

// The χ² test of a histogram of sampled directions against the density.
struct Histogram {
  Domain domain;
  std::vector<double> pdf;

  bool IsRefuted(const Sampled& sampled, uint64_t draws, double level, Rng& rng) const {
    std::vector<double> observed(pdf.size(), 0.0), expected, errors(pdf.size(), 0.0);
    for (uint64_t i = 0; i < draws; ++i) {
      if (const auto direction = sampled.draw(rng)) ++observed[domain.CellOf(glm::normalize(Vector3d(*direction)))];
    }
    double sum = 0;
    for (const double p : pdf) {
      if (!(p >= 0)) return true;
      sum += p;
      expected.push_back(p * static_cast<double>(draws));
    }
    if (!(sum < 1.1)) return true;
    return ChiSquaredTest(observed, expected, errors) < level;
  }
};

// The only light of a scene, and a receiver.
class Sampling {
 public:
  explicit Sampling(const BuiltScene& built)
      : lighting_(*built.scene.lighting), geometry_(*built.scene.geometry), light_(lighting_.Lights().at(0)) {
    context_.transform = &light_.transform;
    context_.scene = lighting_.SceneSphere();
    context_.bidirectional = true;
    receiver_.position = context_.scene.center;
    // Before the light, a little off its axis.
    if (const auto bounds = light_.light->GetEmissionBounds(context_)) {
      const float size = std::max(0.5f * glm::length(bounds->box.Diagonal()), 0.1f);
      const Vector3 aside = std::abs(bounds->axis.x) < 0.7f ? Vector3(1, 0, 0) : Vector3(0, 1, 0);
      receiver_.position = bounds->box.Center() + size * (1.6f * bounds->axis + 0.4f * glm::cross(bounds->axis, aside));
    }
  }

  Sampled Direct() const {
    return {"next-event estimation",
            [this](Rng& rng) -> std::optional<Vector3> {
              LightChoices choices;
              lighting_.SelectLights(receiver_, rng.NextFloat(), choices);
              if (choices.count == 0) return std::nullopt;
              const auto direct = lighting_.GenerateSamples(receiver_, choices.of[0], rng.NextPoint2(), 0, false);
              return direct ? std::optional(direct.sample->direction) : std::nullopt;
            },
            [this](const Vector3& direction) { return DensityToward(direction); }};
  }
  // Photons from one place, by the light's own word.
  std::optional<Sampled> Emission(Rng& rng) const {
    LightContext context = context_;
    std::optional<EmissionSample> first;
    for (int i = 0; i < 100 && (!first || first->pdfEmitDirection.IsZero()); ++i) {
      context.u = rng.NextPoint2();
      context.uDirection = rng.NextPoint2();
      first = light_.light->GenerateEmission(context);
    }
    if (!first || light_.light->Kind() == LightKind::DeltaDirection) return std::nullopt;
    const bool hasPlace = light_.light->Kind() == LightKind::Area;
    return Sampled{"photons",
                   [this, context, hasPlace](Rng& r) -> std::optional<Vector3> {
                     LightContext drawn = context;
                     if (!hasPlace) drawn.u = r.NextPoint2();
                     drawn.uDirection = r.NextPoint2();
                     const auto photon = light_.light->GenerateEmission(drawn);
                     if (!photon || photon->pdfEmitDirection.IsZero()) return std::nullopt;
                     return photon->direction;
                   },
                   [this, photon = *first](const Vector3& direction) { return EmissionDensity(photon, direction); }};
  }

 private:
  double DensityToward(const Vector3& direction) const {
    const Ray ray{receiver_.position, direction};
    std::optional<FoundLight> found;
    if (lighting_.InfiniteCount() > 0) {
      found = lighting_.EvaluateEscaped(0, receiver_, direction, 0, false);
    } else {
      RayHit hit;
      Color passed;
      if (!geometry_.Intersect(ray, visibility::kIndirect, hit, passed)) return 0;
      found = lighting_.EvaluateSamples(receiver_, direction, hit.t, geometry_.GetSurfacePoint(ray, hit), 0, false);
    }
    if (!found) return 0;
    return static_cast<double>(found->selection.value) * static_cast<double>(found->evaluation.pdfDirect.value);
  }
  double EmissionDensity(const EmissionSample& photon, const Vector3& direction) const {
    const Light& light = *light_.light;
    if (light.Kind() == LightKind::DeltaPosition) {
      const auto sample = light.GenerateSamples(context_, photon.position + direction);
      return sample ? static_cast<double>(sample->pdfEmitDirection.value) : 0.0;
    }
    LightHit hit;
    hit.direction = -direction;
    hit.position = receiver_.position;
    if (light.Kind() == LightKind::Area) {
      hit.position = photon.position;
      hit.distance = 1;
      hit.normal = photon.normal;
      hit.uv = Point2(photon.uvw.x, photon.uvw.y);
      hit.patchIndex = photon.patchIndex;
    }
    const auto e = light.EvaluateSamples(context_, hit, hit.position + direction);
    return e ? static_cast<double>(e->pdfEmitDirection.value) : 0.0;
  }

  const LightingServices& lighting_;
  const GeometryScene& geometry_;
  const PlacedLight& light_;
  Receiver receiver_;
  LightContext context_;
};

}  // namespace

Finding FindByChiSquared(const BaselineScene& scene, uint64_t mostSamples, double seconds, const Counter& counter) {
  constexpr int kMostLooks = 16;
  constexpr uint64_t kFirst = 1000;
  Finding finding;
  const double start = CpuSeconds();
  const BuiltScene built = BuildFor(scene, "path");
  const Sampling sampling(built);
  Rng rng(7);
  std::vector<Sampled> functions;
  if (!IsDelta(built.scene.lighting->Lights().at(0).light->Kind())) functions.push_back(sampling.Direct());
  if (auto emission = sampling.Emission(rng)) functions.push_back(*emission);
  finding.applies = !functions.empty();
  std::vector<Histogram> tables;
  for (const Sampled& function : functions) {
    std::vector<Vector3d> hints;
    for (int i = 0; i < 2000; ++i) {
      if (const auto direction = function.draw(rng)) hints.push_back(glm::normalize(Vector3d(*direction)));
    }
    const Domain domain = hints.empty() ? Domain() : Domain(hints);
    tables.push_back({domain, Tabulate(domain, function.density)});
  }
  finding.seconds = CpuSeconds() - start;
  const double level = SidakLevel(kFamilyWise, kMostLooks * 2);
  uint64_t draws = kFirst;
  for (int look = 0; look < kMostLooks && draws <= mostSamples && !finding.found && finding.seconds < seconds;
       ++look, draws *= 2) {
    const uint64_t before = counter();
    for (size_t i = 0; i < functions.size(); ++i) {
      if (!tables[i].IsRefuted(functions[i], draws, level, rng)) continue;
      finding.found = true;
      finding.property = functions[i].name;
    }
    finding.samples = counter() - before;
    finding.draws = draws;
    finding.seconds = CpuSeconds() - start;
  }
  return finding;
}

}  // namespace lampyr::test
