#include "suite/area_common.h"

#include "suite/direction_source.h"

namespace lampyr::suite {

std::vector<Receiver> ReceiversAround(const Enclosure& enclosure, const Point3d& position, const Vector3d& normal) {
  const Vector3d n = normal;
  const Vector3d t = glm::normalize(glm::cross(n, std::abs(n.x) < 0.7 ? Vector3d(1, 0, 0) : Vector3d(0, 1, 0)));
  const Vector3d s = glm::cross(n, t);
  const double r = enclosure.radius;
  const Point3d& m = enclosure.middle;
  return {
      {"near", Point3(position + n * (0.3 * r) + t * (0.05 * r))},
      {"far", Point3(m + (n * 0.8 + t * 0.5 - s * 0.3) * (100 * r))},
      {"grazing", Point3(m + t * (2 * r) + n * (0.05 * r))},
      {"behind", Point3(m - n * (3 * r) + s * (0.2 * r))},
      {"on-plane", Point3(position + s * (3 * r))},
      {"inside", Point3(m + (t * 0.11 + s * 0.07 + n * 0.09) * r)},
      {"on the axis", Point3(m + n * (2.5 * r))},
      {"oblique", Point3(m + (n * 0.9 - t * 0.7 + s * 0.8) * r)},
      {"beside", Point3(m + (s * 1.7 - n * 0.6 + t * 0.4) * r)},
  };
}

std::string InWords(const Enclosure& enclosure, const Receiver& receiver) {
  char text[160];
  std::snprintf(text, sizeof(text), "receiver \"%s\", %.3g sizes from the light's middle: ", receiver.name.c_str(),
                glm::length(Point3d(receiver.position) - enclosure.middle) / enclosure.radius);
  return text;
}

void CheckAreaEmissionDirections(const SuiteSubject& subject, const SuiteOptions& options, const Enclosure& enclosure,
                                 Rng& rng, SuiteReport& report) {
  Rng places = MakeRngOfPlaces(subject, options);
  for (int i = 0; i < 3; ++i) {
    const std::string where = subject.caseName + " from point " + std::to_string(i);
    const auto start = FindFixedStart(subject, FixedPart::Position, 1e-5 * enclosure.radius, places);
    if (!start) {
      // Nothing is emitted, or no single random number determines the position.
      const bool emits = subject.light->GetPowerEstimate(subject.context).Average() > 0;
      report.AddError(subject.name, "emission-directions", where, emits ? 1 : 0, 0.5);
      continue;
    }
    DirectionEffort effort;
    effort.draws = options.photons / 2;
    effort.budget *= options.effort;
    CheckDirectionsOf(subject, DirectionsFrom(subject, *start, static_cast<float>(2 * enclosure.radius)), where, effort,
                      rng, report);
  }
}

void CheckAreaPower(const SuiteSubject& subject, const Enclosure& enclosure, const Visibility& visibility, Rng& rng,
                    SuiteReport& report) {
  const Light& light = *subject.light;
  const auto contextFor = [&](const float(&x)[4]) {
    LightContext context = subject.context;
    context.u = {x[0], x[1]};
    context.uDirection = {x[2], x[3]};
    return context;
  };
  bool stopsSome = false;
  double stopped = 0;  // largest flux of a photon that the light itself blocked
  const Estimate escaping = SharpMean(rng, subject.powerError, [&](const float(&x)[4]) {
    const auto photon = light.GenerateEmission(contextFor(x));
    if (!photon) return 0.0;
    const double flux = Flux(subject, *photon);
    if (visibility.escapes(*photon)) return flux;
    stopsSome = true;
    stopped = std::max(stopped, flux);
    return 0.0;
  });
  const double radius = 2.5 * enclosure.radius, area = 4 * kPiDouble * radius * radius;
  const Estimate direct = SharpMean(rng, subject.powerError, [&](const float(&x)[4]) {
    const Vector3d outward = Cap{}.Direction(2 * static_cast<double>(x[2]), static_cast<double>(x[3]));
    const Point3 P(enclosure.middle + outward * radius);
    const auto sample = light.GenerateSamples(contextFor(x), P);
    if (!sample || !visibility.sees(*sample, P)) return 0.0;
    return -glm::dot(outward, Vector3d(sample->direction)) * area * Emitted(subject, *sample) /
           Value(sample->pdfDirect);
  });
  // Rounding lets some photons slip through the light's seams.
  constexpr double kSeams = 1e-4;
  report.AddProbability(subject.name, "power", subject.caseName, EqualMeans(escaping, direct, 1e-3, kSeams * stopped),
                        InWords("the power that photons carry away, in W,", escaping, direct));
  // GetPowerEstimate covers all photons that the surface emits, including those that it blocks itself.
  const Estimate emitted = !stopsSome ? escaping : SharpMean(rng, subject.powerError, [&](const float(&x)[4]) {
    const auto photon = light.GenerateEmission(contextFor(x));
    return photon ? Flux(subject, *photon) : 0.0;
  });
  CheckPowerEstimate(subject, emitted, report);
}

double PatchMismatch(const SuiteSubject& subject, const LightHit& hit, const Point3& P) {
  const Light& light = *subject.light;
  if (light.PatchCount() < 2) return 0;
  const auto whole = light.EvaluateSamples(subject.context, hit, P);
  LightContext given = subject.context;
  given.patch = hit.patchIndex;
  const auto part = light.EvaluateSamples(given, hit, P);
  given.patch = (hit.patchIndex + 1) % light.PatchCount();
  const auto other = light.EvaluateSamples(given, hit, P);
  if (!whole || !part) return whole || part ? 1 : 0;
  if (other && !(other->pdfDirect.IsZero() && other->pdfEmit.IsZero())) return 1;
  const auto choice = static_cast<double>(light.PatchProbability(hit.patchIndex).value);
  return std::max(RelativeDifference(choice * Value(part->pdfDirect), Value(whole->pdfDirect)),
                  RelativeDifference(choice * Value(part->pdfEmit), Value(whole->pdfEmit)));
}

double SolidAngleToAreaMismatch(const LightSample& sample) {
  const double cosine = std::abs(glm::dot(Vector3d(sample.normal), glm::normalize(Vector3d(sample.direction))));
  const auto distance = static_cast<double>(sample.distance);
  return RelativeDifference(static_cast<double>(sample.solidAngleToArea), cosine / (distance * distance));
}

void CheckAreaEstimates(const SuiteSubject& subject, const Enclosure& enclosure, const Receiver& receiver, Rng& rng,
                        SuiteReport& report) {
  const Light& light = *subject.light;
  double missed = light.GetIncidentRadianceEstimate(subject.context, receiver.position) > 0 ? 0 : 1;
  for (int i = 0; i < 8; ++i) {
    const float length = static_cast<float>(enclosure.radius) * (0.2f + 4 * rng.NextFloat());
    const float t = length * (0.1f + 0.8f * rng.NextFloat());
    const Vector3 direction(RandomDirection(rng));
    const auto segment =
        light.GetIncidentRadianceEstimate(subject.context, receiver.position - t * direction, direction, length);
    if (!segment || !(segment->radiance > 0) || !(segment->minT <= t && t <= segment->maxT)) missed = 1;
  }
  report.AddError(subject.name, "estimate", subject.caseName + " " + receiver.name, missed, 0.5);
}

double EmittingSide(const EmissionBounds& bounds, const Vector3d& normal) {
  return !bounds.twoSided && bounds.cosThetaO >= 1 && glm::dot(normal, Vector3d(bounds.axis)) < 0 ? -1 : 1;
}

bool LeavesBounds(const EmissionBounds& bounds, const Enclosure& enclosure, const EmissionSample& photon) {
  const Vector3 slack = Vector3(1e-4f * static_cast<float>(enclosure.radius)) + 4.0f * photon.positionError;
  const bool inBox = glm::all(glm::greaterThanEqual(photon.position, bounds.box.min - slack)) &&
                     glm::all(glm::lessThanEqual(photon.position, bounds.box.max + slack));
  const Normal3 normal = photon.normal * static_cast<float>(EmittingSide(bounds, Vector3d(photon.normal)));
  float cosine = glm::dot(normal, bounds.axis);
  if (bounds.twoSided) cosine = std::abs(cosine);
  if (!inBox || cosine < bounds.cosThetaO - 1e-3f) return true;
  if (IsBlack(photon)) return false;  // a sampled direction without emission
  // Within θe of the normal on its emitting side.
  float emission = glm::dot(normal, photon.direction);
  if (bounds.twoSided) emission = std::abs(emission);
  return emission < bounds.cosThetaE - 1e-3f;
}

}  // namespace lampyr::suite
