// Properties of the photons of lights that are their own surface.
#include "suite/surface_checks.h"

namespace lampyr::suite {

namespace {

// Cells of the light's box in its own space: 8×8 if it is flat, otherwise 4×4×4.
class BoxCells {
 public:
  explicit BoxCells(const Bounds3d& box) : box_(box), size_(box.Diagonal()) {
    const double largest = std::max({size_.x, size_.y, size_.z});
    int flat = 0;
    for (int i = 0; i < 3; ++i) flat += size_[i] > 1e-5 * largest ? 0 : 1;
    for (int i = 0; i < 3; ++i) count_[i] = size_[i] > 1e-5 * largest ? (flat == 0 ? 4 : flat == 1 ? 8 : 64) : 1;
  }
  size_t Count() const { return static_cast<size_t>(count_[0] * count_[1] * count_[2]); }
  size_t Of(const Point3d& local) const {
    int index = 0;
    for (int i = 0; i < 3; ++i) {
      const double part = count_[i] > 1 ? (local[i] - box_.min[i]) / size_[i] : 0.0;
      index = index * count_[i] + std::clamp(static_cast<int>(part * count_[i]), 0, count_[i] - 1);
    }
    return static_cast<size_t>(index);
  }
  bool Holds(const Point3d& local) const {
    const double slack = 1e-4 * glm::length(size_);
    for (int i = 0; i < 3; ++i) {
      if (!(local[i] > box_.min[i] - slack && local[i] < box_.max[i] + slack)) return false;
    }
    return true;
  }

 private:
  Bounds3d box_;
  Vector3d size_;
  int count_[3];
};

// pdfEmit at a point, evaluated in directions on either side of the surface and in those of photons.
double EmitDensityAt(const SuiteSubject& subject, const SurfaceTracer& tracer, const SurfaceHit& point,
                     const std::vector<Vector3d>& tried) {
  const auto distance = static_cast<float>(2 * tracer.Around().radius);
  LightHit hit;
  hit.distance = distance;
  hit.position = Point3(point.position);
  hit.normal = Normal3(point.normal);
  hit.uv = point.uv;
  const auto densityTowards = [&](const Vector3d& outward) {
    hit.direction = -glm::normalize(Vector3(outward));
    const Point3 P = hit.position - distance * hit.direction;
    const auto e = subject.light->EvaluateSamples(subject.context, hit, P);
    return e ? Value(e->pdfEmit) : 0.0;
  };
  for (const double sign : {1.0, -1.0}) {
    if (const double density = densityTowards(sign * point.normal); density > 0) return density;
  }
  for (const Vector3d& direction : tried) {
    if (std::abs(glm::dot(direction, point.normal)) < 1e-3) continue;
    if (const double density = densityTowards(direction); density > 0) return density;
  }
  return 0;
}

bool Escapes(const SurfaceTracer& tracer, const EmissionSample& photon) {
  // From a little before the surface, on the photon's side.
  const Vector3d normal(photon.normal), direction = glm::normalize(Vector3d(photon.direction));
  const double side = glm::dot(normal, direction) > 0 ? 1e-5 : -1e-5;
  return !tracer.Trace(Point3d(photon.position) + side * tracer.Around().radius * normal, direction);
}

bool Sees(const SurfaceTracer& tracer, const LightSample& sample, const Point3& P) {
  const auto distance = static_cast<double>(sample.distance);
  return !tracer.Trace(Point3d(P), glm::normalize(Vector3d(sample.direction)), 0,
                       distance - 1e-4 * (tracer.Around().radius));
}

struct PhotonErrors {
  double edge = 0, surface = 0, outside = 0, multipliers = 0;
};

// Compares a photon with the edge to where it may land, and with the surface where it starts.
void ComparePhoton(const SuiteSubject& subject, const SurfaceTracer& tracer, const BoxCells& cells,
                   const EmissionSample& photon, PhotonErrors& errors) {
  const auto reach = static_cast<float>(2 * tracer.Around().radius);
  const LightHit hit = HitOf(photon, reach);
  const auto e = subject.light->EvaluateSamples(subject.context, hit, photon.position + reach * photon.direction);
  if (photon.pdfEmitDirection.IsZero()) {
    if (!IsBlack(photon) || (e && !IsBlack(*e))) errors.edge = 1;
    return;
  }
  errors.edge = std::max(errors.edge, e ? Mismatch(photon, *e, subject.light->Opacity(hit)) : 1.0);
  const auto cosine = std::abs(static_cast<double>(glm::dot(photon.normal, photon.direction)));
  errors.edge = std::max(errors.edge, std::abs(cosine - static_cast<double>(photon.emissionCosine)));
  errors.multipliers = std::max(errors.multipliers, MultiplierMismatch(subject, photon));
  if (!cells.Holds(tracer.ToLocal(Point3d(photon.position)))) errors.outside = 1;
  // A ray along the normal, from outside, must find the photon's own point.
  const Vector3d normal(photon.normal);
  const Point3d from = Point3d(photon.position) + normal * tracer.Around().radius;
  const auto found = tracer.Find(from, -normal, Point3d(photon.position));
  if (!found) {
    errors.surface = 1;
    return;
  }
  const double scale = tracer.Around().radius + 1e-2 * glm::length(found->hit.position);
  errors.surface = std::max(errors.surface, glm::length(found->hit.position - Point3d(photon.position)) / scale);
  errors.surface = std::max(errors.surface, glm::length(found->hit.normal - normal));
}

void CheckPositions(const SuiteSubject& subject, const SuiteOptions& options, const SurfaceTracer& tracer, Rng& rng,
                    SuiteReport& report) {
  const Light& light = *subject.light;
  const BoxCells cells(tracer.LocalBox());
  const std::optional<EmissionBounds> bounds = light.GetEmissionBounds(subject.context);
  std::vector<double> observed(cells.Count() + 1, 0.0), expected, deviations;
  std::vector<Vector3d> tried;
  PhotonErrors errors;
  errors.outside = bounds ? 0 : 1;
  for (int i = 0; i < options.photons; ++i) {
    const auto photon = light.GenerateEmission(RandomContext(subject, rng));
    if (!photon) {
      ++observed[cells.Count()];
      continue;
    }
    ++observed[cells.Of(tracer.ToLocal(Point3d(photon->position)))];
    if (tried.size() < 16) tried.emplace_back(photon->direction);
    if (i % 4 == 0) ComparePhoton(subject, tracer, cells, *photon, errors);
    if (bounds && LeavesBounds(*bounds, tracer.Around(), *photon)) errors.outside = 1;
  }
  const std::vector<Estimate> densities = tracer.IntegrateOver(
      cells.Count(), [&](const SurfaceHit& hit) { return cells.Of(hit.local); },
      [&](const SurfaceHit& hit) { return EmitDensityAt(subject, tracer, hit, tried); }, rng);
  Estimate integral;
  for (const Estimate& cell : densities) {
    integral = integral + cell;
    expected.push_back(options.photons * cell.value);
    deviations.push_back(options.photons * cell.error);
  }
  const Estimate share = LatticeMean(rng, 128, 64, [&](const float(&x)[4]) {
    LightContext context = subject.context;
    context.u = {x[0], x[1]};
    context.uDirection = {x[2], x[3]};
    return light.GenerateEmission(context) ? 1.0 : 0.0;
  });
  expected.push_back(options.photons * std::max(1 - integral.value, 0.0));
  deviations.push_back(options.photons * (integral.error + 1e-3));
  const auto& name = subject.caseName;
  report.AddProbability(subject.name, "emission-integral", name + " positions", EqualMeans(integral, share, 1e-3));
  report.AddProbability(subject.name, "emission-positions", name, ChiSquaredTest(observed, expected, deviations));
  report.AddError(subject.name, "emission-edge", name, errors.edge, 1e-4);
  report.AddError(subject.name, "surface", name + " photons", errors.surface, 1e-3);
  report.AddError(subject.name, "multipliers", name + " photons", errors.multipliers, 1e-5);
  report.AddError(subject.name, "bounds", name, errors.outside, 0.5);
  report.AddError(subject.name, "emission-origin", name, WorstPhotonOrigin(subject, rng), 0.5);
}

}  // namespace

void CheckSurfaceEmission(const SuiteSubject& subject, const SuiteOptions& options, const SurfaceTracer& tracer,
                          Rng& rng, SuiteReport& report) {
  CheckPositions(subject, options, tracer, rng, report);
  CheckAreaEmissionDirections(subject, options, tracer.Around(), rng, report);
  const Visibility visibility{[&](const EmissionSample& photon) { return Escapes(tracer, photon); },
                              [&](const LightSample& sample, const Point3& P) { return Sees(tracer, sample, P); }};
  CheckAreaPower(subject, tracer.Around(), visibility, rng, report);
}

}  // namespace lampyr::suite
