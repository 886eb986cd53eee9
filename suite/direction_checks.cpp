// Directions of photons against their density: the integral, χ² in cells, and moments. A tilt moves the mean, a stretch
// the second moments. A ripple finer than the cells shows in the mean ratio of the density to that of adjacent
// directions: if photons do not follow the ripple, the ratio is lower than the density implies.
#include "suite/area_common.h"
#include "suite/direction_source.h"
#include "suite/exact_surface.h"

namespace lampyr::suite {

namespace {

// Statistics of a direction d: d normalised to mean 0 and variance 1, products of its components, and the ratio of the
// density to that of adjacent directions at two scales.
class Moments {
 public:
  static constexpr size_t kCount = 11;

  Moments(const DirectionSource& source, std::span<const Vector3d> directions) : source_(source) {
    const double n = std::max<double>(static_cast<double>(directions.size()), 1);
    for (const Vector3d& d : directions) mean_ += d / n;
    Vector3d squares(0.0);
    for (const Vector3d& d : directions) squares += (d - mean_) * (d - mean_) / n;
    for (int i = 0; i < 3; ++i) deviation_[i] = std::max(std::sqrt(squares[i]), 1e-5);
    spread_ = glm::length(deviation_);
  }

  void Of(const Vector3d& d, double density, std::span<double> values) const {
    const Vector3d f = (d - mean_) / deviation_;
    const double all[kCount] = {f.x,
                                f.y,
                                f.z,
                                f.x * f.x,
                                f.y * f.y,
                                f.z * f.z,
                                f.x * f.y,
                                f.y * f.z,
                                f.z * f.x,
                                AboveBeside(d, density, 0.06 * spread_),
                                AboveBeside(d, density, 0.2 * spread_)};
    std::copy(std::begin(all), std::end(all), values.begin());
  }

  // Allows for the rounding of directions, whose effect on the mean of a statistic is far less than this.
  double Tolerance(size_t i) const {
    constexpr double kLeast = 2e-4, kRounding = 1e-6;
    constexpr int axes[9][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {2, 0}};
    if (i >= 9) return kLeast + 10 * kRounding / spread_;
    const double deviation = std::min(deviation_[axes[i][0]], deviation_[axes[i][1]]);
    return kLeast + (i < 3 ? 1 : 4) * kRounding / deviation;
  }
  static const char* Name(size_t i) {
    static constexpr const char* names[kCount] = {"mean of x",        "mean of y",        "mean of z",
                                                  "spread along x",   "spread along y",   "spread along z",
                                                  "slant of x and y", "slant of y and z", "slant of z and x",
                                                  "fine ripple",      "coarse ripple"};
    return names[i];
  }

 private:
  // The density divided by the mean of four adjacent ones; 1 if the ratio is so far from 1 that there is an edge.
  double AboveBeside(const Vector3d& d, double density, double step) const {
    const Vector3d x = glm::normalize(glm::cross(d, std::abs(d.x) < 0.7 ? Vector3d(1, 0, 0) : Vector3d(0, 1, 0)));
    const Vector3d y = glm::cross(d, x);
    double beside = 0;
    for (const Vector3d& way : {x, -x, y, -y}) beside += 0.25 * source_.density(glm::normalize(d + step * way));
    const double ratio = beside > 0 ? density / beside : 0.0;
    return ratio > 0.7 && ratio < 1.4 ? ratio : 1.0;
  }

  const DirectionSource& source_;
  Vector3d mean_{0.0}, deviation_{1.0};
  double spread_;
};

void CheckMoments(const SuiteSubject& subject, const DirectionSource& source, const std::string& where,
                  const DirectionEffort& effort, const DirectionQuadrature& quadrature, std::span<const Vector3d> hints,
                  Rng& rng, SuiteReport& report) {
  constexpr size_t kCount = Moments::kCount;
  const Moments moments(source, hints);
  const std::vector<Estimate> promised = quadrature.Integrate(
      kCount,
      [&](const Vector3d& direction, std::span<double> out) {
        double values[kCount] = {};
        const double density = source.density(direction);
        if (density > 0) moments.Of(direction, density, values);
        for (size_t i = 0; i < kCount; ++i) out[i] = density * values[i];
      },
      rng);
  RunningMean means[kCount];
  constexpr int kLattices = 128;
  for (int lattice = 0; lattice < kLattices; ++lattice) {
    double sums[kCount] = {};
    LatticeMean(rng, 1, effort.points, [&](const float(&x)[4]) {
      const auto drawn = source.draw(x);
      if (!drawn) return 0.0;
      const Vector3d direction = glm::normalize(Vector3d(*drawn));
      double values[kCount];
      moments.Of(direction, source.density(direction), values);
      for (size_t i = 0; i < kCount; ++i) sums[i] += values[i];
      return 0.0;
    });
    for (size_t i = 0; i < kCount; ++i) means[i].Add(sums[i] / effort.points);
  }
  for (size_t i = 0; i < kCount; ++i) {
    const Estimate seen = EstimateOf(means[i]);
    char text[200];
    std::snprintf(text, sizeof(text),
                  "%s of the photons' directions: pdfEmitDirection promises %.5f ± %.1g, %.5f ± %.1g came",
                  Moments::Name(i), promised[i].value, promised[i].error, seen.value, seen.error);
    report.AddProbability(subject.name, "emission-directions", where + " " + Moments::Name(i),
                          EqualMeans(promised[i], seen, 0, moments.Tolerance(i)), text);
  }
}

}  // namespace

void CheckDirectionsOf(const SuiteSubject& subject, const DirectionSource& source, const std::string& where,
                       const DirectionEffort& effort, Rng& rng, SuiteReport& report) {
  const auto draw = [&](Rng& r) {
    const Point2 u = r.NextPoint2(), v = r.NextPoint2();
    return source.draw({u.x, u.y, v.x, v.y});
  };
  const std::vector<Vector3d> directions = DrawDirections(rng, effort.draws, draw);
  const std::vector<Vector3d> hints = DrawDirections(rng, kHints, draw);
  const Estimate share =
      LatticeMean(rng, 128, effort.points, [&](const float(&x)[4]) { return source.draw(x) ? 1.0 : 0.0; });
  DirectionQuadrature quadrature(
      CapAround(hints), hints,
      [&](const Vector3d& direction) -> Integrands {
        return {source.density(direction), 0};
      },
      rng, effort.budget);
  const Estimate density = quadrature.Density();
  char text[200];
  std::snprintf(text, sizeof(text), "pdfEmitDirection integrates to %.5f ± %.1g; %.5f of the photons have a direction",
                density.value, density.error, share.value);
  report.AddProbability(subject.name, "emission-integral", where, EqualMeans(density, share, 1e-3), text);
  std::string worst;
  const double p = quadrature.Test(directions, effort.draws, effort.cells, &worst);
  report.AddProbability(subject.name, "emission-directions", where, p, worst);
  if (effort.moments && !hints.empty()) {
    CheckMoments(subject, source, where, effort, quadrature, hints, rng, report);
  }
}

void CheckDirectionsFinely(const SuiteSubject& subject, const SuiteOptions& options, SuiteReport& report) {
  const Light& light = *subject.light;
  Rng rng = MakeRng(subject, options), places = MakeRngOfPlaces(subject, options);
  DirectionEffort effort;
  effort.draws = 200000;
  effort.cells = 400;
  effort.points = 2048;
  effort.budget = 3 * options.effort * DirectionQuadrature::kBudget;
  effort.moments = true;
  const std::string where = subject.caseName + " finely";
  if (light.Kind() == LightKind::Area && (subject.model || light.Surface())) {
    const double radius = ExactSurface(subject).Around().radius;
    const auto start = FindFixedStart(subject, FixedPart::Position, 1e-5 * radius, places);
    if (!start) return;  // the ordinary test reports it
    CheckDirectionsOf(subject, DirectionsFrom(subject, *start, static_cast<float>(2 * radius)), where, effort, rng,
                      report);
  } else if (light.Kind() == LightKind::DeltaPosition) {
    const auto photon = light.GenerateEmission(RandomContext(subject, rng));
    if (photon) CheckDirectionsOf(subject, DirectionsOfPoint(subject, photon->position), where, effort, rng, report);
  } else if (light.Kind() == LightKind::Infinite) {
    CheckDirectionsOf(subject, DirectionsFromInfinity(subject, options.photons, places), where, effort, rng, report);
  }
}

}  // namespace lampyr::suite
