// The suite's properties of lights without a surface: points, and light from infinity.
#include "lights/suite/checks.h"
#include "lights/suite/statistics.h"
#include "math/frame.h"

namespace lampyr::suite {

namespace {

constexpr double kPiDouble = 3.14159265358979323846;

LightContext RandomContext(const SuiteSubject& subject, Rng& rng) {
  LightContext context = subject.context;
  context.u = rng.NextPoint2();
  context.uDirection = rng.NextPoint2();
  return context;
}

Rng MakeRng(const SuiteSubject& subject, const SuiteOptions& options) {
  return Rng(options.seed, Hash(std::hash<std::string>{}(subject.name + subject.caseName)));
}

void CheckPowerEstimate(const SuiteSubject& subject, const RunningMean& emitted, SuiteReport& report) {
  const auto estimate = static_cast<double>(subject.light->GetPowerEstimate(subject.context).Average());
  if (subject.isPowerExact) {
    report.AddProbability(subject.name, "power-estimate", subject.caseName,
                          EqualMeans(emitted.Mean(), emitted.StandardError(), estimate, 0, 1e-3));
  } else {
    // Without a closed form only the order of magnitude is promised.
    const double ratio = estimate / emitted.Mean();
    report.AddError(subject.name, "power-estimate", subject.caseName, std::abs(std::log(ratio)), std::log(10.0));
  }
}

}  // namespace

namespace {

// The largest difference of two quantities that should be the same, relative to the largest value that occurs: in a
// narrow cone the rounding of a direction is a visible part of its soft edge.
struct LargestDifference {
  double difference = 0, largest = 0;
  void Note(double a, double b) {
    difference = std::max(difference, std::abs(a - b));
    largest = std::max(largest, std::max(std::abs(a), std::abs(b)));
  }
  double Relative() const { return largest > 0 ? difference / largest : 0.0; }
};

}  // namespace

void CheckPointLight(const SuiteSubject& subject, const SuiteOptions& options, SuiteReport& report) {
  const Light& light = *subject.light;
  Rng rng = MakeRng(subject, options);
  std::vector<Vector3> directions;
  RunningMean emitted, direct;
  Point3 position(0.0f);
  const std::optional<EmissionBounds> bounds = light.GetEmissionBounds(subject.context);
  const float distance = subject.context.scene.radius;
  double edge = 0, outside = bounds ? 0 : 1, missed = 0;
  LargestDifference density, intensity;
  for (int i = 0; i < options.photons; ++i) {
    const auto photon = light.GenerateEmission(RandomContext(subject, rng));
    emitted.Add(photon ? Flux(*photon) : 0.0);
    if (!photon) continue;
    position = photon->position;
    directions.push_back(photon->direction);
    const Point3 P = position + distance * photon->direction;
    const auto sample = light.GenerateSamples(subject.context, P);
    // On the rim of a cone the two roundings of the direction may fall on either side.
    if (!sample) continue;
    const auto d2 = static_cast<double>(sample->distance) * static_cast<double>(sample->distance);
    density.Note(static_cast<double>(photon->pdfEmitDirection.value),
                 static_cast<double>(sample->pdfEmitDirection.value));
    intensity.Note(static_cast<double>(photon->diffuse.Average()), d2 * static_cast<double>(sample->diffuse.Average()));
    edge = std::max(edge, RelativeDifference(static_cast<double>(photon->pdfEmit.value),
                                             static_cast<double>(sample->pdfEmit.value)));
    edge = std::max(edge, static_cast<double>(glm::length(sample->direction + photon->direction)) > 1e-3 ? 1.0 : 0.0);
    if (sample->pdfDirect.value != 1 || light.EvaluateSamples(subject.context, {}, P)) edge = 1;
    if (!(light.GetIncidentRadianceEstimate(subject.context, P) > 0)) missed = 1;
    const Vector3 along =
        Cap{}.Direction(2 * static_cast<double>(rng.NextFloat()), static_cast<double>(rng.NextFloat()));
    const float before = distance * rng.NextFloat();
    const auto segment = light.GetIncidentRadianceEstimate(subject.context, P - before * along, along, 2 * distance);
    if (!segment || !(segment->radiance > 0) || !(segment->minT <= before * 1.001f && before * 0.999f <= segment->maxT))
      missed = 1;
    if (bounds && bounds->cosThetaO > -1 && glm::dot(bounds->axis, photon->direction) < bounds->cosThetaE - 1e-4f)
      outside = 1;
    if (bounds && glm::length(position - bounds->box.Center()) > 1e-5f * (distance + glm::length(position)))
      outside = 1;
  }
  if (directions.empty()) return;
  const Cap cap = CapAround(directions);
  DirectionTest test;
  test.integralProperty = "emission-integral";
  test.chiSquaredProperty = "emission-directions";
  test.samples = options.photons;
  test.subdivisions = 48;
  test.density = [&](const Vector3& direction) {
    const auto sample = light.GenerateSamples(subject.context, position + distance * direction);
    return sample ? static_cast<double>(sample->pdfEmitDirection.value) : 0.0;
  };
  test.sample = [&](Rng& r) -> std::optional<Vector3> {
    const auto photon = light.GenerateEmission(RandomContext(subject, r));
    if (!photon) return std::nullopt;
    return photon->direction;
  };
  CheckDirections(subject, "", cap, test, rng, report);
  for (int i = 0; i < 4 * options.photons; ++i) {
    const Vector3 outward =
        cap.Direction(cap.wMax * static_cast<double>(rng.NextFloat()), static_cast<double>(rng.NextFloat()));
    const auto sample = light.GenerateSamples(subject.context, position + distance * outward);
    const auto d2 = sample ? static_cast<double>(sample->distance) * static_cast<double>(sample->distance) : 0.0;
    direct.Add(sample ? static_cast<double>(sample->diffuse.Average()) * d2 * cap.SolidAngle() : 0.0);
  }
  report.AddProbability(
      subject.name, "power", subject.caseName,
      EqualMeans(emitted.Mean(), emitted.StandardError(), direct.Mean(), direct.StandardError(), 3e-3));
  CheckPowerEstimate(subject, emitted, report);
  report.AddError(subject.name, "emission-edge", subject.caseName,
                  std::max(edge, std::max(density.Relative(), intensity.Relative())), 2e-2);
  report.AddError(subject.name, "bounds", subject.caseName, outside, 0.5);
  report.AddError(subject.name, "estimate", subject.caseName, missed, 0.5);
}

namespace {

// Photons from infinity: positions on the disk, given the direction of each, gathered in that direction's own frame.
void CheckEmissionDisk(const SuiteSubject& subject, const SuiteOptions& options, Rng& rng, RunningMean& emitted,
                       SuiteReport& report) {
  constexpr int kRings = 4, kSectors = 8;
  const Light& light = *subject.light;
  const BoundingSphere& scene = subject.context.scene;
  std::vector<double> observed(kRings * kSectors, 0.0), expected(kRings * kSectors, 0.0),
      errors(kRings * kSectors, 0.0);
  double edge = 0, integral = 0, found = 0;
  for (int i = 0; i < options.photons; ++i) {
    const auto photon = light.GenerateEmission(RandomContext(subject, rng));
    emitted.Add(photon ? Flux(*photon) : 0.0);
    if (!photon) continue;
    ++found;
    const Vector3d toLight = -Vector3d(photon->direction), offset = Vector3d(photon->position) - Vector3d(scene.center);
    const auto radius = static_cast<double>(scene.radius);
    // It starts on the plane that touches the sphere on the light's side.
    if (std::abs(glm::dot(offset, toLight) / radius - 1) > 1e-4) edge = 1;
    const Frame frame = Frame::FromNormal(Vector3(toLight));
    const double x = glm::dot(offset, Vector3d(frame.x)) / radius, y = glm::dot(offset, Vector3d(frame.y)) / radius;
    const double turns = std::atan2(y, x) / (2 * kPiDouble);
    const int ring = std::clamp(static_cast<int>((x * x + y * y) * kRings), 0, kRings - 1);
    const int sector = std::clamp(static_cast<int>((turns < 0 ? turns + 1 : turns) * kSectors), 0, kSectors - 1);
    if (x * x + y * y > 1.0001) edge = 1;
    ++observed[static_cast<size_t>(ring * kSectors + sector)];
    LightContext context = subject.context;
    LightHit hit;
    hit.direction = Vector3(toLight);
    if (light.Kind() == LightKind::Infinite) {
      const auto e = light.EvaluateSamples(context, hit, scene.center);
      edge = std::max(edge, e ? RelativeDifference(static_cast<double>(e->pdfEmit.value),
                                                   static_cast<double>(photon->pdfEmit.value))
                              : 1.0);
      edge = std::max(edge, e ? RelativeDifference(static_cast<double>(e->pdfEmitDirection.value),
                                                   static_cast<double>(photon->pdfEmitDirection.value))
                              : 1.0);
      edge = std::max(edge, e ? RelativeDifference(e->diffuse, photon->diffuse) : 1.0);
    } else {
      const auto e = light.GenerateSamples(context, scene.center);
      edge = std::max(edge, e ? RelativeDifference(static_cast<double>(e->pdfEmit.value),
                                                   static_cast<double>(photon->pdfEmit.value))
                              : 1.0);
      if (e && glm::length(e->direction + photon->direction) > 1e-5f) edge = 1;
      if (photon->pdfEmitDirection.value != 1 || light.EvaluateSamples(context, hit, scene.center)) edge = 1;
    }
    integral = static_cast<double>(photon->pdfEmit.value) * kPiDouble * radius * radius;
  }
  if (found == 0) return;
  for (double& e : expected) e = found / (kRings * kSectors);
  report.AddProbability(subject.name, "emission-positions", subject.caseName,
                        ChiSquaredTest(observed, expected, errors));
  report.AddError(subject.name, "emission-integral", subject.caseName + " disk", std::abs(integral - 1), 1e-4);
  report.AddError(subject.name, "emission-edge", subject.caseName, edge, 1e-4);
}

double SampleAndCompare(const Light& light, const LightContext& context, const Point3& P, RunningMean& fluence) {
  const auto sample = light.GenerateSamples(context, P);
  fluence.Add(sample ? static_cast<double>(sample->diffuse.Average()) / static_cast<double>(sample->pdfDirect.value)
                     : 0.0);
  if (!sample) return 0;
  if (light.Kind() == LightKind::DeltaDirection) return sample->pdfDirect.value == 1 ? 0 : 1;
  LightHit hit;
  hit.direction = sample->direction;
  const auto e = light.EvaluateSamples(context, hit, P);
  if (!e) return 1;
  double worst = RelativeDifference(sample->diffuse, e->diffuse);
  worst = std::max(
      worst, RelativeDifference(static_cast<double>(sample->pdfDirect.value), static_cast<double>(e->pdfDirect.value)));
  worst = std::max(
      worst, RelativeDifference(static_cast<double>(sample->pdfEmit.value), static_cast<double>(e->pdfEmit.value)));
  worst = std::max(worst, RelativeDifference(static_cast<double>(sample->pdfEmitDirection.value),
                                             static_cast<double>(e->pdfEmitDirection.value)));
  worst = std::max(worst, RelativeDifference(static_cast<double>(sample->solidAngleToArea),
                                             static_cast<double>(e->solidAngleToArea)));
  return worst;
}

void CheckInfiniteDirections(const SuiteSubject& subject, const SuiteOptions& options, Rng& rng, SuiteReport& report) {
  const Light& light = *subject.light;
  DirectionTest test;
  test.integralProperty = "integral";
  test.chiSquaredProperty = "directions";
  test.samples = options.photons;
  test.subdivisions = 64;
  test.expectationError = 1e-2;
  LightHit hit;
  test.density = [&](const Vector3& direction) {
    hit.direction = glm::normalize(direction);
    const auto e = light.EvaluateSamples(subject.context, hit, subject.context.scene.center);
    return e && !e->diffuse.IsBlack() ? static_cast<double>(e->pdfDirect.value) : 0.0;
  };
  test.sample = [&](Rng& r) -> std::optional<Vector3> {
    const auto sample = light.GenerateSamples(RandomContext(subject, r), subject.context.scene.center);
    if (!sample) return std::nullopt;
    return sample->direction;
  };
  CheckDirections(subject, "", Cap{}, test, rng, report);
  test.integralProperty = "emission-integral";
  test.chiSquaredProperty = "emission-directions";
  test.density = [&](const Vector3& direction) {
    hit.direction = glm::normalize(direction);
    const auto e = light.EvaluateSamples(subject.context, hit, subject.context.scene.center);
    return e && !e->diffuse.IsBlack() ? static_cast<double>(e->pdfEmitDirection.value) : 0.0;
  };
  test.sample = [&](Rng& r) -> std::optional<Vector3> {
    const auto photon = light.GenerateEmission(RandomContext(subject, r));
    if (!photon) return std::nullopt;
    return -photon->direction;
  };
  CheckDirections(subject, " directions", Cap{}, test, rng, report);
}

}  // namespace

void CheckInfiniteLight(const SuiteSubject& subject, const SuiteOptions& options, SuiteReport& report) {
  const Light& light = *subject.light;
  Rng rng = MakeRng(subject, options);
  RunningMean emitted, fluence;
  CheckEmissionDisk(subject, options, rng, emitted, report);
  double consistency = 0;
  for (int i = 0; i < options.photons; ++i) {
    consistency = std::max(consistency,
                           SampleAndCompare(light, RandomContext(subject, rng), subject.context.scene.center, fluence));
  }
  const auto radius = static_cast<double>(subject.context.scene.radius);
  const double disk = kPiDouble * radius * radius;
  report.AddError(subject.name, "consistency", subject.caseName, consistency, 1e-4);
  report.AddProbability(
      subject.name, "power", subject.caseName,
      EqualMeans(emitted.Mean(), emitted.StandardError(), disk * fluence.Mean(), disk * fluence.StandardError(), 1e-3));
  const bool shines = emitted.Mean() > 0;
  if (shines) CheckPowerEstimate(subject, emitted, report);
  const auto segment =
      light.GetIncidentRadianceEstimate(subject.context, subject.context.scene.center, Vector3(0, 0, 1), 1.0f);
  const bool estimated = light.GetIncidentRadianceEstimate(subject.context, subject.context.scene.center) > 0 &&
                         segment && segment->radiance > 0 && segment->minT <= 0 && segment->maxT >= 1;
  report.AddError(subject.name, "estimate", subject.caseName, shines && !estimated ? 1.0 : 0.0, 0.5);
  if (light.Kind() != LightKind::Infinite) return;
  CheckInfiniteDirections(subject, options, rng, report);
  // By directions that know nothing of the light: only where no single texel holds all of the power.
  RunningMean uniform;
  for (int i = 0; i < 8 * options.photons; ++i) {
    LightHit hit;
    hit.direction =
        glm::normalize(Cap{}.Direction(2 * static_cast<double>(rng.NextFloat()), static_cast<double>(rng.NextFloat())));
    const auto e = light.EvaluateSamples(subject.context, hit, subject.context.scene.center);
    uniform.Add(e ? static_cast<double>(e->diffuse.Average()) * 4 * kPiDouble : 0.0);
  }
  if (uniform.StandardError() > 0.02 * uniform.Mean()) return;
  report.AddProbability(
      subject.name, "irradiance", subject.caseName,
      EqualMeans(fluence.Mean(), fluence.StandardError(), uniform.Mean(), uniform.StandardError(), 1e-3));
}

}  // namespace lampyr::suite
