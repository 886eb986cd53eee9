#include "lights/suite/pdf_suite.h"

#include "lights/suite/checks.h"
#include "lights/suite/statistics.h"

namespace lampyr {

void SuiteReport::AddProbability(const std::string& light, const std::string& property, const std::string& caseName,
                                 double pValue) {
  results_.push_back({light, property, caseName, true, pValue, 0, false});
}

void SuiteReport::AddError(const std::string& light, const std::string& property, const std::string& caseName,
                           double error, double tolerance) {
  results_.push_back({light, property, caseName, false, error, tolerance, error <= tolerance});
}

std::vector<SuiteResult> SuiteReport::Finish(double familyWise) {
  int tests = 0;
  for (const SuiteResult& result : results_) tests += result.isProbability ? 1 : 0;
  const double level = SidakLevel(familyWise, tests);
  for (SuiteResult& result : results_) {
    if (!result.isProbability) continue;
    result.threshold = level;
    result.passed = result.statistic >= level;
  }
  return results_;
}

void CheckLight(const SuiteSubject& subject, const SuiteOptions& options, SuiteReport& report) {
  switch (subject.light->Kind()) {
    case LightKind::Area:
      suite::CheckAreaLight(subject, options, report);
      break;
    case LightKind::DeltaPosition:
      suite::CheckPointLight(subject, options, report);
      break;
    case LightKind::DeltaDirection:
    case LightKind::Infinite:
      suite::CheckInfiniteLight(subject, options, report);
      break;
  }
}

namespace suite {

namespace {
constexpr int kRings = 8, kSectors = 6;
}

double Cap::SolidAngle() const {
  return 2 * 3.14159265358979323846 * wMax;
}

Vector3 Cap::Direction(double w, double turns) const {
  const Vector3d helper = std::abs(axis.x) < 0.7 ? Vector3d(1, 0, 0) : Vector3d(0, 1, 0);
  const Vector3d x = glm::normalize(glm::cross(helper, axis)), y = glm::cross(axis, x);
  const double r = std::sqrt(std::max(w * (2 - w), 0.0)), phi = 2 * 3.14159265358979323846 * turns;
  return Vector3(x * (r * std::cos(phi)) + y * (r * std::sin(phi)) + axis * (1 - w));
}

Point2d Cap::Invert(const Vector3& direction) const {
  const Vector3d helper = std::abs(axis.x) < 0.7 ? Vector3d(1, 0, 0) : Vector3d(0, 1, 0);
  const Vector3d x = glm::normalize(glm::cross(helper, axis)), y = glm::cross(axis, x);
  const Vector3d d(direction), chord = d - axis;
  const double turns = std::atan2(glm::dot(d, y), glm::dot(d, x)) / (2 * 3.14159265358979323846);
  return {0.5 * glm::dot(chord, chord) / wMax, turns < 0 ? turns + 1 : turns};
}

Cap CapAround(const std::vector<Vector3>& directions) {
  Vector3d sum(0.0);
  for (const Vector3& d : directions) sum += Vector3d(d);
  Cap cap;
  if (!(glm::length(sum) > 0)) return cap;
  cap.axis = glm::normalize(sum);
  double widest = 0;
  for (const Vector3& d : directions) {
    const Vector3d chord = Vector3d(d) - cap.axis;
    widest = std::max(widest, 0.5 * glm::dot(chord, chord));
  }
  cap.wMax = widest < 0.5 ? std::max(1.002 * widest, 1e-14) : 2.0;
  return cap;
}

void CheckDirections(const SuiteSubject& subject, const std::string& suffix, const Cap& cap, const DirectionTest& test,
                     Rng& rng, SuiteReport& report) {
  constexpr size_t cells = kRings * kSectors;
  std::vector<double> expected(cells + 1, 0.0), coarse(cells + 1, 0.0), observed(cells + 1, 0.0),
      errors(cells + 1, 0.0);
  // Two quadratures, the second with half as many points a side: their difference bounds the error.
  const auto integrate = [&](int n, std::vector<double>& into) {
    const double element = cap.SolidAngle() / (static_cast<double>(cells) * n * n);
    for (size_t cell = 0; cell < cells; ++cell) {
      for (int i = 0; i < n * n; ++i) {
        const double ring = static_cast<double>(cell / kSectors) + (i / n + 0.5) / n;
        const double sector = static_cast<double>(cell % kSectors) + (i % n + 0.5) / n;
        into[cell] += element * test.density(cap.Direction(cap.wMax * ring / kRings, sector / kSectors));
      }
    }
  };
  integrate(test.subdivisions, expected);
  integrate(test.subdivisions / 2, coarse);
  double integral = 0, coarseIntegral = 0, found = 0;
  for (size_t i = 0; i < cells; ++i) integral += expected[i], coarseIntegral += coarse[i];
  for (int i = 0; i < test.samples; ++i) {
    const std::optional<Vector3> direction = test.sample(rng);
    if (!direction) {
      ++observed[cells];
      continue;
    }
    ++found;
    const Point2d p = cap.Invert(*direction);
    const auto ring = static_cast<size_t>(std::clamp(p.x * kRings, 0.0, kRings - 1.0));
    const auto sector = static_cast<size_t>(std::clamp(p.y * kSectors, 0.0, kSectors - 1.0));
    ++observed[ring * kSectors + sector];
  }
  const double share = found / test.samples, difference = std::abs(integral - coarseIntegral);
  const std::string caseName = subject.caseName + suffix;
  const double statistical = 5.5 * std::sqrt(share * (1 - share) / test.samples);
  report.AddError(subject.name, test.integralProperty, caseName, std::abs(integral - share),
                  3e-3 + 2 * difference + statistical);
  for (size_t i = 0; i < cells; ++i) {
    errors[i] = test.samples * (2 * std::abs(expected[i] - coarse[i]) + test.expectationError * expected[i]);
    expected[i] *= test.samples;
  }
  expected[cells] = test.samples * std::max(1 - integral, 0.0);
  errors[cells] = test.samples * (difference + 1e-3);
  report.AddProbability(subject.name, test.chiSquaredProperty, caseName, ChiSquaredTest(observed, expected, errors));
}

double RelativeDifference(double a, double b) {
  const double largest = std::max(std::abs(a), std::abs(b));
  if (!(largest < 1e300)) return 1;
  return largest > 0 ? std::abs(a - b) / largest : 0.0;
}

double RelativeDifference(const Color& a, const Color& b) {
  return std::max(RelativeDifference(static_cast<double>(a.r), static_cast<double>(b.r)),
                  std::max(RelativeDifference(static_cast<double>(a.g), static_cast<double>(b.g)),
                           RelativeDifference(static_cast<double>(a.b), static_cast<double>(b.b))));
}

double EqualMeans(double a, double errorA, double b, double errorB, double tolerance) {
  const double slack = tolerance * std::max(std::abs(a), std::abs(b));
  const double excess = std::max(std::abs(a - b) - slack, 0.0);
  if (excess == 0) return 1;
  const double error = std::sqrt(errorA * errorA + errorB * errorB);
  return error > 0 ? NormalTail(excess / error) : 0.0;
}

double Flux(const EmissionSample& photon) {
  return static_cast<double>(photon.diffuse.Average()) * static_cast<double>(photon.emissionCosine) /
         (static_cast<double>(photon.pdfEmit.value) * static_cast<double>(photon.pdfEmitDirection.value));
}

}  // namespace suite

}  // namespace lampyr
