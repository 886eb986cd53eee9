// Properties of lights that are their own surface at receivers: rays are traced to the surface.
#include "suite/surface_checks.h"

#include <cstdio>
#include <limits>

namespace lampyr::suite {

namespace {

// Below this cosine, the effect of rounding exceeds what the test tolerates: such points count as not sampled, and the
// quadrature leaves them out too.
constexpr double kEdgeOn = 0.01;
constexpr double kFlat = 0.03;  // smallest cosine at which the densities of one point are compared

class SurfaceReceiverChecker {
 public:
  SurfaceReceiverChecker(const SuiteSubject& subject, const SuiteOptions& options, const SurfaceTracer& tracer,
                         Rng& rng, SuiteReport& report)
      : subject_(subject), light_(*subject.light), options_(options), tracer_(tracer), rng_(rng), report_(report) {
    bounds_ = light_.GetEmissionBounds(subject.context);
  }

  void Check(const Receiver& receiver);

 private:
  struct SampleErrors {
    double consistency = 0, surface = 0, multipliers = 0;
    int compared = 0, differing = 0;
  };
  // The hit of the ray to a sample; nullopt: it is hidden, edge-on, or does not lie on the surface.
  std::optional<SurfaceHit> Seen(const LightSample& sample, const Point3& P) const;
  bool IsFoundBeside(const LightSample& sample, const Point3& P, const Vector3d& direction) const;
  void Compare(const LightSample& sample, const Point3& P, SampleErrors& errors) const;
  std::vector<Vector3d> CompareSamples(const Point3& P, SampleErrors& errors);
  Counted CountSamples(const Point3& P, double& hidden);
  double DarkDensity(const Point3& P, const Vector3d& direction) const;
  Integrands At(const Point3& P, const Vector3d& direction);

  const SuiteSubject& subject_;
  const Light& light_;
  const SuiteOptions& options_;
  const SurfaceTracer& tracer_;
  Rng& rng_;
  SuiteReport& report_;
  std::optional<EmissionBounds> bounds_;
  double leak_ = 0, compared_ = 0, cameraDiffers_ = 0;  // by rounding, on the edge of a beam
  // Largest contributions, radiance over pdfDirect: of the directions of the quadrature, and of the samples.
  double brightest_ = 0, brightestMet_ = 0;
};

Integrands SurfaceReceiverChecker::At(const Point3& P, const Vector3d& direction) {
  const auto found = tracer_.Trace(Point3d(P), direction);
  if (!found) return {};
  const LightHit hit = HitFrom(*found, direction);
  const auto e = light_.EvaluateSamples(subject_.context, hit, P);
  const double cosine = -glm::dot(found->normal, direction);
  if (std::abs(cosine) > 1e-4) {
    ++compared_;
    cameraDiffers_ += CameraMismatch(subject_, hit, e).value_or(0.0) > 1e-4 ? 1 : 0;
    // A two-sided surface may be dark on one side, and may nevertheless be sampled there.
    const bool isBack = bounds_ && !bounds_->twoSided && cosine * EmittingSide(*bounds_, found->normal) < 0;
    if (isBack && e && !IsBlack(*e)) leak_ = 1;
  }
  if (!e || IsBlack(*e) || std::abs(cosine) < kEdgeOn) return {};
  if (!e->pdfDirect.IsZero()) brightest_ = std::max(brightest_, Emitted(subject_, *e) / Value(e->pdfDirect));
  return {Value(e->pdfDirect), Emitted(subject_, *e)};
}

std::optional<SurfaceHit> SurfaceReceiverChecker::Seen(const LightSample& sample, const Point3& P) const {
  const Vector3d direction = glm::normalize(Vector3d(sample.direction));
  const auto found = tracer_.Find(Point3d(P), direction, Point3d(sample.position));
  if (!found || !found->isFirst || std::abs(glm::dot(found->hit.normal, direction)) < kEdgeOn) return std::nullopt;
  // The hit is on another part of the surface, next to the sample.
  const double scale = tracer_.Around().radius + 1e-2 * glm::length(Point3d(sample.position) - Point3d(P));
  if (glm::length(found->hit.position - Point3d(sample.position)) > 1e-2 * scale) return std::nullopt;
  return found->hit;
}

// True if a ray beside `direction` finds the sample. A ray to a sample on the very rim may miss it: the direction is
// rounded to 6e-8.
bool SurfaceReceiverChecker::IsFoundBeside(const LightSample& sample, const Point3& P,
                                           const Vector3d& direction) const {
  constexpr int kWays = 8;
  constexpr double kAside = 1e-6;  // rad
  const Cap around{direction, 0.5 * kAside * kAside};
  for (int i = 0; i < kWays; ++i) {
    const Vector3d beside = glm::normalize(around.Direction(around.wMax, static_cast<double>(i) / kWays));
    if (tracer_.Find(Point3d(P), beside, Point3d(sample.position))) return true;
  }
  return false;
}

void SurfaceReceiverChecker::Compare(const LightSample& sample, const Point3& P, SampleErrors& errors) const {
  const LightHit ownHit = HitOf(sample, P);
  const auto own = light_.EvaluateSamples(subject_.context, ownHit, P);
  errors.consistency = std::max(errors.consistency, own ? Mismatch(sample, *own, light_.Opacity(ownHit)) : 1.0);
  errors.multipliers = std::max(errors.multipliers, MultiplierMismatch(subject_, sample));
  const Vector3d direction = glm::normalize(Vector3d(sample.direction));
  const double cosine = std::abs(glm::dot(Vector3d(sample.normal), direction));
  if (cosine < kFlat) return;  // a ray to the sample may miss it
  errors.surface = std::max(errors.surface, SolidAngleToAreaMismatch(sample));
  const auto found = tracer_.Find(Point3d(P), direction, Point3d(sample.position));
  if (!found) {
    if (!IsFoundBeside(sample, P, direction)) errors.surface = 1;
    return;
  }
  const SurfaceHit& hit = found->hit;
  const auto distance = static_cast<double>(sample.distance);
  const double scale = tracer_.Around().radius + 1e-2 * (distance + glm::length(hit.position));
  errors.surface = std::max(errors.surface, glm::length(hit.position - Point3d(sample.position)) * cosine / scale);
  errors.surface = std::max(errors.surface, std::abs(hit.distance - distance) * cosine / scale);
  // Rounding shifts the hit along the surface by 1 / cosine, where the normal differs too.
  errors.surface = std::max(errors.surface, glm::length(hit.normal - Vector3d(sample.normal)) * cosine);
  // The edge of a texel, or of a beam, may lie between the two: a few samples may differ.
  ++errors.compared;
  const LightHit traced = HitFrom(hit, direction);
  const auto e = light_.EvaluateSamples(subject_.context, traced, P);
  if (!e || Mismatch(sample, *e, light_.Opacity(traced)) > 2e-2) ++errors.differing;
}

// Compares the light's own samples with the traced surface. Returns the directions of the visible ones.
std::vector<Vector3d> SurfaceReceiverChecker::CompareSamples(const Point3& P, SampleErrors& errors) {
  std::vector<Vector3d> directions;
  for (int i = 0; i < options_.samples; ++i) {
    const auto sample = light_.GenerateSamples(RandomContext(subject_, rng_), P);
    if (!sample) continue;
    if (i % 4 == 0) Compare(*sample, P, errors);
    if (Seen(*sample, P)) directions.push_back(glm::normalize(Vector3d(sample->direction)));
  }
  return directions;
}

// Irradiance, without the cosine, by light sampling. `hidden`: the largest contribution of a sample that the light
// itself hides.
Counted SurfaceReceiverChecker::CountSamples(const Point3& P, double& hidden) {
  return CountedMean(rng_, [&](const float(&x)[4]) -> std::optional<double> {
    LightContext context = subject_.context;
    context.u = {x[0], x[1]};
    context.uDirection = {x[2], x[3]};
    const auto sample = light_.GenerateSamples(context, P);
    if (!sample) return std::nullopt;
    const double brought = Emitted(subject_, *sample) / Value(sample->pdfDirect);
    brightestMet_ = std::max(brightestMet_, brought);
    if (Seen(*sample, P)) return brought;
    hidden = std::max(hidden, brought);
    return std::nullopt;
  });
}

// pdfDirect in directions from which the light is black, else 0.
double SurfaceReceiverChecker::DarkDensity(const Point3& P, const Vector3d& direction) const {
  const auto found = tracer_.Trace(Point3d(P), direction);
  if (!found || std::abs(glm::dot(found->normal, direction)) < kEdgeOn) return 0;
  const auto e = light_.EvaluateSamples(subject_.context, HitFrom(*found, direction), P);
  return e && IsBlack(*e) ? Value(e->pdfDirect) : 0.0;
}

void SurfaceReceiverChecker::Check(const Receiver& receiver) {
  const Point3& P = receiver.position;
  leak_ = compared_ = cameraDiffers_ = brightest_ = brightestMet_ = 0;
  const std::vector<Vector3d> hints = DrawDirections(rng_, kHints, [&](Rng& rng) -> std::optional<Vector3> {
    const auto sample = light_.GenerateSamples(RandomContext(subject_, rng), P);
    if (!sample) return std::nullopt;
    return sample->direction;
  });
  DirectionQuadrature quadrature(
      CapTowards(tracer_.Around(), P), hints, [&](const Vector3d& direction) { return At(P, direction); }, rng_,
      options_.effort * DirectionQuadrature::kBudget);
  SampleErrors errors;
  const std::vector<Vector3d> directions = CompareSamples(P, errors);
  double hidden = 0;
  const Counted counted = CountSamples(P, hidden);
  const std::string where = subject_.caseName + " " + receiver.name;
  const std::string words = InWords(tracer_.Around(), receiver);
  const auto probability = [&](const char* property, double p, const std::string& text) {
    report_.AddProbability(subject_.name, property, where, p, words + text);
  };
  const auto error = [&](const char* property, double e, double tolerance) {
    report_.AddError(subject_.name, property, where, e, tolerance,
                     words + "the largest error is above what is allowed");
  };
  // Rounding lets less than one ray in ten thousand slip through a seam of the light.
  constexpr double kSeams = 1e-4;
  probability("integral", EqualMeans(quadrature.Density(), counted.share, 1e-3, kSeams),
              InWords("the integral of pdfDirect", quadrature.Density(), counted.share));
  CheckDarkDensity(
      subject_, where, quadrature.Density(), CapTowards(tracer_.Around(), P),
      [&](const Vector3d& direction) { return DarkDensity(P, direction); }, rng_, report_);
  std::string worst;
  const double p = quadrature.Test(directions, options_.samples, 48, &worst);
  probability("directions", p, worst);
  // Close to a surface, most of the light may come from points that no sample has hit. Neither the samples' mean nor
  // its error estimate is meaningful then.
  constexpr double kUnmet = 8;
  if (brightest_ <= kUnmet * brightestMet_) {
    probability("irradiance", EqualMeans(quadrature.Radiance(), counted.sum, 1e-3, kSeams * hidden),
                InWords("what light sampling brings", counted.sum, quadrature.Radiance()));
  }
  error("consistency", errors.consistency, 1e-4);
  error("multipliers", errors.multipliers, 1e-5);
  error("surface", errors.surface, 1e-3);
  if (errors.compared > 0) {
    constexpr double kMostDiffering = 1e-2, kSigmas = 5;
    const double part = static_cast<double>(errors.differing) / errors.compared;
    error("surface", part, kMostDiffering + kSigmas * std::sqrt(kMostDiffering / errors.compared));
  }
  error("one-sided", leak_, 0.5);
  error("camera", compared_ > 0 ? cameraDiffers_ / compared_ : 0.0, 1e-2);
  if (!directions.empty()) CheckAreaEstimates(subject_, tracer_.Around(), receiver, rng_, report_);
}

}  // namespace

void CheckSurfaceReceivers(const SuiteSubject& subject, const SuiteOptions& options, const SurfaceTracer& tracer,
                           Rng& rng, SuiteReport& report) {
  // Some point of the surface, by lines through its box.
  std::optional<SurfaceHit> some;
  Rng places = MakeRngOfPlaces(subject, options);
  tracer.IntegrateOver(
      1, [](const SurfaceHit&) { return 0; },
      [&](const SurfaceHit& hit) {
        if (!some) some = hit;
        return 0.0;
      },
      places);
  if (!some) return;
  SurfaceReceiverChecker checker(subject, options, tracer, rng, report);
  for (const Receiver& receiver : ReceiversAround(tracer.Around(), Point3(some->position), some->normal)) {
    checker.Check(receiver);
  }
}

namespace {

// Checks that hits of lines through the box are on the line, in the box, and the nearest ones in (tMin, tMax].
void CheckIntersection(const SuiteSubject& subject, const SurfaceTracer& tracer, Rng& rng, SuiteReport& report) {
  constexpr int kLines = 512;
  constexpr double kTolerance = 5e-3;  // of the lines: a grazing hit may be found by one ray and not by another
  const IntersectableLight& surface = *subject.light->Surface();
  const Bounds3d& box = tracer.LocalBox();
  const double size = glm::length(box.max - box.min);
  std::string words;
  double wrong = 0;
  const auto note = [&](const char* format, double a, double b) {
    char text[160];
    std::snprintf(text, sizeof(text), format, a, b);
    words = text;
    return true;
  };
  const auto hitOf = [&](LocalRay ray, double tMin, double tMax) {
    ray.tMin = tMin;
    ray.tMax = tMax;
    return surface.Intersect(ray);
  };
  const auto isWrong = [&](const LocalRay& ray) {
    constexpr double kInfinite = std::numeric_limits<double>::infinity(), kSlack = 1e-6;
    const auto hit = hitOf(ray, 0, kInfinite);
    if (!hit) return false;
    if (!(hit->t > 0)) return note("a ray with tMin %g is hit at %g", 0, hit->t);
    if (const double length = glm::length(hit->normal); !(std::abs(length - 1) < kSlack))
      return note("a hit at t = %g has a normal of length %g", hit->t, length);
    if (const double off = glm::length(ray.origin + hit->t * ray.direction - hit->position); !(off < kSlack * size))
      return note("a hit at t = %g is %g off the ray", hit->t, off);
    for (int axis = 0; axis < 3; ++axis) {
      const double outside = std::max(box.min[axis] - hit->position[axis], hit->position[axis] - box.max[axis]);
      if (outside > kSlack * size) return note("a hit is %g outside of GetBounds, whose diagonal is %g", outside, size);
    }
    if (hitOf(ray, 0, 0.5 * hit->t))
      return note("a ray that ends at tMax = %g is hit, and a longer one at %g", 0.5 * hit->t, hit->t);
    const auto again = hitOf(ray, 0, hit->t * (1 + kSlack));
    if (!again || std::abs(again->t - hit->t) > kSlack * hit->t)
      return note("a hit at %g is not found by a ray that ends at tMax = %g", hit->t, hit->t * (1 + kSlack));
    const double beyond = hit->t * (1 + kSlack);
    const auto next = hitOf(ray, beyond, kInfinite);
    return next && !(next->t > beyond) && note("a ray with tMin %g is hit at %g", beyond, next->t);
  };
  // Also beyond the box, to hit a surface that is larger than its box.
  const auto across = [](Rng& from) { return 1.5 * static_cast<double>(from.NextFloat()) - 0.25; };
  for (int i = 0; i < kLines; ++i) {
    LocalRay ray;
    ray.direction = RandomDirection(rng);
    Point3d through;
    for (int axis = 0; axis < 3; ++axis) through[axis] = box.min[axis] + across(rng) * (box.max[axis] - box.min[axis]);
    ray.origin = through - (0.5 + 2 * static_cast<double>(rng.NextFloat())) * size * ray.direction;
    wrong += isWrong(ray) ? 1.0 / kLines : 0.0;
  }
  report.AddError(subject.name, "intersect", subject.caseName, wrong, kTolerance, words);
}

}  // namespace

void CheckSurfaceLight(const SuiteSubject& subject, const SuiteOptions& options, SuiteReport& report) {
  const SurfaceTracer tracer(*subject.light->Surface(), *subject.context.transform);
  Rng rng = MakeRng(subject, options);
  Rng lines = MakeRngOfPlaces(subject, options);
  CheckIntersection(subject, tracer, lines, report);
  CheckSurfaceReceivers(subject, options, tracer, rng, report);
  CheckSurfaceEmission(subject, options, tracer, rng, report);
}

}  // namespace lampyr::suite
