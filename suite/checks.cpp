#include "suite/checks.h"

#include <cstdio>
#include <exception>
#include <mutex>
#include <new>

#include "base/parallel.h"

namespace lampyr::suite {

Rng MakeRngOfPlaces(const SuiteSubject& subject, const SuiteOptions& options) {
  uint64_t hash = 0;
  for (const char c : subject.name + "|" + subject.caseName) hash = Hash(hash, static_cast<uint64_t>(c));
  return Rng(options.seed, hash);
}

Rng MakeRng(const SuiteSubject& subject, const SuiteOptions& options) {
  SuiteOptions seeded = options;
  seeded.seed = Hash(options.seed, 0);
  return MakeRngOfPlaces(subject, seeded);
}

LightContext RandomContext(const SuiteSubject& subject, Rng& rng) {
  LightContext context = subject.context;
  context.u = rng.NextPoint2();
  context.uDirection = rng.NextPoint2();
  return context;
}

Vector3d RandomDirection(Rng& rng) {
  const auto w = 2 * static_cast<double>(rng.NextFloat());
  return Cap{}.Direction(w, static_cast<double>(rng.NextFloat()));
}

double RelativeDifference(double a, double b) {
  if (!(std::abs(a) < 1e300) || !(std::abs(b) < 1e300)) return 1;
  const double largest = std::max(std::abs(a), std::abs(b));
  return largest > 0 ? std::abs(a - b) / largest : 0.0;
}

double RelativeDifference(const Color& a, const Color& b) {
  return std::max(RelativeDifference(static_cast<double>(a.r), static_cast<double>(b.r)),
                  std::max(RelativeDifference(static_cast<double>(a.g), static_cast<double>(b.g)),
                           RelativeDifference(static_cast<double>(a.b), static_cast<double>(b.b))));
}

double Mismatch(const LightSample& sample, const LightEvaluation& evaluation, float opacity) {
  double worst = std::max(RelativeDifference(sample.diffuse, evaluation.diffuse * opacity),
                          RelativeDifference(sample.specular, evaluation.specular * opacity));
  const auto note = [&](double a, double b) { worst = std::max(worst, RelativeDifference(a, b)); };
  note(Value(sample.pdfDirect), Value(evaluation.pdfDirect));
  note(Value(sample.pdfEmit), Value(evaluation.pdfEmit));
  note(Value(sample.pdfEmitDirection), Value(evaluation.pdfEmitDirection));
  note(static_cast<double>(sample.solidAngleToArea), static_cast<double>(evaluation.solidAngleToArea));
  for (const float off : {glm::length(sample.normal - evaluation.normal), std::abs(glm::length(sample.direction) - 1)})
    worst = std::isnan(off) ? 1 : std::max(worst, static_cast<double>(off));
  return worst;
}

double Mismatch(const EmissionSample& photon, const LightEvaluation& evaluation, float opacity) {
  double worst = std::max(RelativeDifference(photon.diffuse, evaluation.diffuse * opacity),
                          RelativeDifference(photon.specular, evaluation.specular * opacity));
  worst = std::max(worst, RelativeDifference(Value(photon.pdfEmit), Value(evaluation.pdfEmit)));
  return std::max(worst, RelativeDifference(Value(photon.pdfEmitDirection), Value(evaluation.pdfEmitDirection)));
}

LightHit HitOf(const LightSample& sample, const Point3& P) {
  LightHit hit;
  hit.direction = sample.direction;
  hit.distance = sample.distance;
  hit.position = sample.distance < kInfinity ? sample.position : P;
  hit.normal = sample.normal;
  hit.uv = Point2(sample.uvw.x, sample.uvw.y);
  hit.patchIndex = sample.patchIndex;
  return hit;
}

LightHit HitOf(const EmissionSample& photon, float distance) {
  LightHit hit;
  hit.direction = -photon.direction;
  hit.distance = distance;
  hit.position = photon.position;
  hit.normal = photon.normal;
  hit.uv = Point2(photon.uvw.x, photon.uvw.y);
  hit.patchIndex = photon.patchIndex;
  return hit;
}

std::optional<double> CameraMismatch(const SuiteSubject& subject, const LightHit& hit,
                                     const std::optional<LightEvaluation>& evaluation) {
  const Color seen = subject.light->EvaluateEmissionForCamera(subject.context, hit);
  if (!subject.light->Settings().cameraVisible) return seen.IsBlack() ? 0.0 : 1.0;
  if (!evaluation) return seen.IsBlack() ? 0.0 : 1.0;
  if (subject.diffuseMultiplier > 0) {
    return RelativeDifference(seen * static_cast<float>(subject.diffuseMultiplier), evaluation->diffuse);
  }
  if (subject.specularMultiplier > 0) {
    return RelativeDifference(seen * static_cast<float>(subject.specularMultiplier), evaluation->specular);
  }
  return std::nullopt;
}

double EqualMeans(const Estimate& a, const Estimate& b, double tolerance, double absolute) {
  const double slack = tolerance * std::max(std::abs(a.value), std::abs(b.value)) + absolute;
  const double excess = std::max(std::abs(a.value - b.value) - slack, 0.0);
  if (excess == 0) return 1;
  const double error = std::hypot(a.error, b.error);
  return error > 0 ? NormalTail(excess / error) : 0.0;
}

std::string InWords(const std::string& what, const Estimate& got, const Estimate& expected) {
  char numbers[160];
  std::snprintf(numbers, sizeof(numbers), " is %.5g ± %.1g; expected %.5g ± %.1g", got.value, got.error, expected.value,
                expected.error);
  return what + numbers;
}

double Flux(const SuiteSubject& subject, const EmissionSample& photon) {
  if (photon.pdfEmitDirection.IsZero()) return 0;  // dark in this direction
  return Emitted(subject, photon) * static_cast<double>(photon.emissionCosine) /
         (Value(photon.pdfEmit) * Value(photon.pdfEmitDirection));
}

void CheckPowerEstimate(const SuiteSubject& subject, const Estimate& emitted, SuiteReport& report) {
  if (!(emitted.value > 0)) return;
  const auto estimate = static_cast<double>(subject.light->GetPowerEstimate(subject.context).Average());
  if (subject.isPowerExact) {
    report.AddProbability(subject.name, "power-estimate", subject.caseName, EqualMeans(emitted, {estimate, 0}, 1e-3),
                          InWords("GetPowerEstimate in W", {estimate, 0}, emitted));
  } else {
    // Without a closed form only the order of magnitude is guaranteed.
    report.AddError(subject.name, "power-estimate", subject.caseName, std::abs(std::log(estimate / emitted.value)),
                    std::log(10.0), InWords("GetPowerEstimate in W", {estimate, 0}, emitted));
  }
}

std::optional<FixedStart> FindFixedStart(const SuiteSubject& subject, FixedPart part, double tolerance, Rng& rng) {
  const auto differs = [&](const EmissionSample& a, const EmissionSample& b) {
    const Vector3 difference = part == FixedPart::Position ? a.position - b.position : a.direction - b.direction;
    return static_cast<double>(glm::length(difference)) > tolerance;
  };
  constexpr int kAttempts = 1000;  // a narrow beam leaves from a small part of a surface
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    FixedStart start;
    start.context = RandomContext(subject, rng);
    const auto photon = subject.light->GenerateEmission(start.context);
    if (!photon || photon->pdfEmitDirection.IsZero()) continue;
    start.photon = *photon;
    for (const bool byDirection : {false, true}) {
      start.byDirection = byDirection;
      bool isFixed = true;
      for (int i = 0; i < 16 && isFixed; ++i) {
        const auto other = subject.light->GenerateEmission(start.Draw(rng.NextPoint2()));
        isFixed = !other || !differs(*photon, *other);
      }
      if (isFixed) return start;
    }
    return std::nullopt;
  }
  return std::nullopt;
}

void WithoutExceptions(const std::string& name, const std::string& caseName, SuiteReport& report,
                       const std::function<void()>& check) {
  try {
    check();
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    const auto* located = dynamic_cast<const Error*>(&error);
    if (located && located->Where().line > 0) throw;
    report.AddError(name, "exceptions", caseName + ": it has thrown: " + error.what(), 1, 0.5);
  }
}

SuiteReport RunCases(size_t count, const SuiteOptions& options,
                     const std::function<void(size_t index, SuiteReport& report)>& check) {
  std::vector<SuiteReport> reports(count);
  std::mutex counting;
  size_t done = 0;
  const int threads = options.threads > 0 ? options.threads : HardwareThreads();
  ParallelFor(static_cast<int>(count), threads, [&](int i) {
    const auto index = static_cast<size_t>(i);
    check(index, reports[index]);
    const std::scoped_lock lock(counting);
    ++done;
    if (options.progress) options.progress(static_cast<double>(done) / static_cast<double>(count));
  });
  SuiteReport all;
  for (const SuiteReport& report : reports) all.Add(report);
  return all;
}

}  // namespace lampyr::suite
