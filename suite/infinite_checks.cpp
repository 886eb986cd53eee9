// Properties of infinite lights. Their radiance may differ from place to place (a window does that), and pdfDirect with
// the normal of the receiver: densities of directions are tested at several receivers, those of emission along the
// lines that photons take.
#include "math/frame.h"
#include "suite/checks.h"
#include "suite/direction_source.h"

namespace lampyr::suite {

namespace {

Vector3 Rounded(const Vector3d& direction) {
  return glm::normalize(Vector3(direction));
}

class InfiniteChecker {
 public:
  InfiniteChecker(const SuiteSubject& subject, const SuiteOptions& options, SuiteReport& report)
      : subject_(subject),
        light_(*subject.light),
        scene_(subject_.context.scene),
        radius_(static_cast<double>(subject.context.scene.radius)),
        isDelta_(subject.light->Kind() == LightKind::DeltaDirection),
        options_(options),
        report_(report),
        rng_(MakeRng(subject, options)),
        places_(MakeRngOfPlaces(subject, options)) {}

  void Run() {
    for (const auto& [receiver, normal, isTransmissive] : Receivers()) {
      subject_.context.receiverNormal = normal;
      subject_.context.receiverIsTransmissive = isTransmissive;
      CheckReceiver(receiver);
    }
    subject_.context.receiverNormal = Normal3(0.0f);
    subject_.context.receiverIsTransmissive = false;
    CheckPhotons();
    for (int i = 0; i < 6; ++i) CheckStartsGivenDirection(i);
    if (!isDelta_) CheckEmissionDirections();
    CheckPower();
  }

 private:
  struct OrientedReceiver {
    Receiver place;
    Normal3 normal{0.0f};
    bool isTransmissive = false;
  };
  std::vector<OrientedReceiver> Receivers() const;
  // Cosine by which light from there counts at the receiver; 1 without a normal.
  double CosineTo(const Vector3d& direction) const {
    const Normal3& normal = subject_.context.receiverNormal;
    if (!(LengthSquared(normal) > 0)) return 1;
    const double cosine = glm::dot(Vector3d(normal), direction);
    return subject_.context.receiverIsTransmissive ? std::abs(cosine) : std::max(cosine, 0.0);
  }
  void CheckReceiver(const Receiver& receiver);
  void CheckDirectionsAt(const Receiver& receiver);
  void CheckEstimates(const Receiver& receiver, bool arrives);
  void CheckPhotons();
  void CheckStartsGivenDirection(int index);
  void CheckEmissionDirections();
  void CheckPower();
  double SampleMismatch(const LightSample& sample, const Point3& P) const;
  // The point where the photon's line leaves the scene, beyond every surface that the photon may hit.
  Point3 FarEnd(const EmissionSample& photon) const { return photon.position + 2 * scene_.radius * photon.direction; }
  static LightHit HitAlong(const Vector3& toLight, const Point3& P) {
    LightHit hit;
    hit.direction = toLight;
    hit.position = P;
    return hit;
  }
  std::string Case(const std::string& suffix) const { return subject_.caseName + suffix; }

  SuiteSubject subject_;  // with the normal of the receiver
  const Light& light_;
  const BoundingSphere& scene_;
  double radius_;
  bool isDelta_;
  const SuiteOptions& options_;
  SuiteReport& report_;
  Rng rng_, places_;
};

// Receivers throughout the scene: before and behind a window, near its plane and far from it.
std::vector<InfiniteChecker::OrientedReceiver> InfiniteChecker::Receivers() const {
  const auto at = [&](double x, double y, double z) {
    return Point3(Point3d(scene_.center) + radius_ * Vector3d(x, y, z));
  };
  const auto unit = [](double x, double y, double z) { return Normal3(glm::normalize(Vector3d(x, y, z))); };
  return {{{"centre", scene_.center}},
          {{"above", at(0.02, 0.03, 0.6)}, unit(0.1, -0.2, 1)},
          {{"below", at(-0.05, 0.04, -0.7)}, unit(0.2, 0.1, -1)},
          {{"right", at(0.55, -0.1, 0.2)}, unit(1, 0.6, 0.3), true},
          {{"left", at(-0.6, 0.15, -0.1)}, unit(-1, 0.3, -0.2)},
          {{"front", at(0.1, -0.5, -0.3)}},
          {{"behind", at(-0.2, 0.65, 0.3)}, unit(0.1, -0.3, -0.8), true},
          {{"rim", at(0.57, 0.57, -0.57)}},
          {{"near", at(0.03, -0.02, 0.04)}, unit(0.4, 1, 0.5)}};
}

double InfiniteChecker::SampleMismatch(const LightSample& sample, const Point3& P) const {
  const LightHit hit = HitAlong(sample.direction, P);
  const auto evaluation = light_.EvaluateSamples(subject_.context, hit, P);
  if (sample.solidAngleToArea != 1) return 1;
  if (isDelta_) return sample.pdfDirect.value == 1 && sample.pdfEmitDirection.value == 1 && !evaluation ? 0 : 1;
  return evaluation ? Mismatch(sample, *evaluation) : 1.0;
}

void InfiniteChecker::CheckReceiver(const Receiver& receiver) {
  const Point3& P = receiver.position;
  double consistency = 0, multipliers = 0, camera = 0;
  bool arrives = false;
  for (int i = 0; i < options_.samples / 2; ++i) {
    const auto sample = light_.GenerateSamples(RandomContext(subject_, rng_), P);
    if (!sample) continue;
    arrives = arrives || CosineTo(Vector3d(sample->direction)) > 0;
    consistency = std::max(consistency, SampleMismatch(*sample, P));
    multipliers = std::max(multipliers, MultiplierMismatch(subject_, *sample));
    const LightHit hit = HitAlong(sample->direction, P);
    camera =
        std::max(camera, CameraMismatch(subject_, hit, light_.EvaluateSamples(subject_.context, hit, P)).value_or(0.0));
  }
  const std::string where = Case(" " + receiver.name);
  report_.AddError(subject_.name, "consistency", where, consistency, 1e-4);
  report_.AddError(subject_.name, "multipliers", where, multipliers, 1e-5);
  report_.AddError(subject_.name, "camera", where, camera, 1e-4);
  CheckEstimates(receiver, arrives);
  if (!isDelta_) CheckDirectionsAt(receiver);
}

void InfiniteChecker::CheckDirectionsAt(const Receiver& receiver) {
  const Point3& P = receiver.position;
  const auto draw = [&](Rng& rng) -> std::optional<Vector3> {
    const auto sample = light_.GenerateSamples(RandomContext(subject_, rng), P);
    if (!sample) return std::nullopt;
    return sample->direction;
  };
  const std::vector<Vector3d> directions = DrawDirections(rng_, options_.samples, draw);
  const std::vector<Vector3d> hints = DrawDirections(rng_, kHints, draw);
  // Directions behind a receiver need not be sampled.
  DirectionQuadrature quadrature(
      CapAround(hints), hints,
      [&](const Vector3d& direction) -> Integrands {
        const auto e = light_.EvaluateSamples(subject_.context, HitAlong(Rounded(direction), P), P);
        if (!e || IsBlack(*e)) return {};
        const bool counts = CosineTo(direction) > 0 || !e->pdfDirect.IsZero();
        return {Value(e->pdfDirect), counts ? Emitted(subject_, *e) : 0.0};
      },
      rng_, options_.effort* DirectionQuadrature::kBudget);
  Estimate share, fluence;
  share = LatticeMean(rng_, 128, 32, [&](const float(&x)[4]) {
    LightContext context = subject_.context;
    context.u = {x[0], x[1]};
    context.uDirection = {x[2], x[3]};
    return light_.GenerateSamples(context, P) ? 1.0 : 0.0;
  });
  fluence = LatticeMean(rng_, 128, 32, [&](const float(&x)[4]) {
    LightContext context = subject_.context;
    context.u = {x[0], x[1]};
    context.uDirection = {x[2], x[3]};
    const auto sample = light_.GenerateSamples(context, P);
    return sample ? Emitted(subject_, *sample) / Value(sample->pdfDirect) : 0.0;
  });
  const std::string where = Case(" " + receiver.name);
  const std::string words = "receiver \"" + receiver.name + "\": ";
  report_.AddProbability(subject_.name, "integral", where, EqualMeans(quadrature.Density(), share, 1e-3),
                         InWords(words + "the integral of pdfDirect", quadrature.Density(), share));
  CheckDarkDensity(
      subject_, where, quadrature.Density(), Cap{},
      [&](const Vector3d& direction) {
        const auto e = light_.EvaluateSamples(subject_.context, HitAlong(Rounded(direction), P), P);
        return e && IsBlack(*e) ? Value(e->pdfDirect) : 0.0;
      },
      rng_, report_);
  std::string worst;
  const double p = quadrature.Test(directions, options_.samples, 48, &worst);
  report_.AddProbability(subject_.name, "directions", where, p, words + worst);
  report_.AddProbability(subject_.name, "irradiance", where, EqualMeans(quadrature.Radiance(), fluence, 1e-3),
                         InWords(words + "what light sampling brings", fluence, quadrature.Radiance()));
}

void InfiniteChecker::CheckEstimates(const Receiver& receiver, bool arrives) {
  if (!arrives) return;
  const Point3& P = receiver.position;
  double missed = light_.GetIncidentRadianceEstimate(subject_.context, P) > 0 ? 0 : 1;
  for (int i = 0; i < 8; ++i) {
    const float length = scene_.radius * (0.2f + rng_.NextFloat()), t = length * (0.1f + 0.8f * rng_.NextFloat());
    const Vector3 direction(RandomDirection(rng_));
    const auto segment = light_.GetIncidentRadianceEstimate(subject_.context, P - t * direction, direction, length);
    if (!segment || !(segment->radiance > 0) || !(segment->minT <= t && t <= segment->maxT)) missed = 1;
  }
  report_.AddError(subject_.name, "estimate", Case(" " + receiver.name), missed, 0.5);
}

// Checks that each photon's densities are those of the edge from its origin to where it may land.
void InfiniteChecker::CheckPhotons() {
  double edge = 0, multipliers = 0, plane = 0;
  for (int i = 0; i < options_.photons; ++i) {
    const auto photon = light_.GenerateEmission(RandomContext(subject_, rng_));
    if (!photon) continue;
    const Vector3d direction(photon->direction), offset = Vector3d(photon->position) - Vector3d(scene_.center);
    plane = std::max(plane, std::abs(glm::dot(offset, direction) / radius_ + 1));
    multipliers = std::max(multipliers, MultiplierMismatch(subject_, *photon));
    edge = std::max(edge, std::abs(static_cast<double>(photon->emissionCosine) - 1));
    const Point3 P = FarEnd(*photon);
    const auto e = light_.EvaluateSamples(subject_.context, HitAlong(-photon->direction, P), P);
    if (!isDelta_) {
      edge = std::max(edge, e ? Mismatch(*photon, *e) : 1.0);
      continue;
    }
    const auto sample = light_.GenerateSamples(subject_.context, P);
    edge = std::max(edge, sample ? RelativeDifference(Value(sample->pdfEmit), Value(photon->pdfEmit)) : 1.0);
    if (sample && glm::length(sample->direction + photon->direction) > 1e-5f) edge = 1;
    if (sample) edge = std::max(edge, RelativeDifference(sample->diffuse, photon->diffuse));
    if (sample) edge = std::max(edge, RelativeDifference(sample->specular, photon->specular));
    if (photon->pdfEmitDirection.value != 1 || e) edge = 1;
  }
  report_.AddError(subject_.name, "emission-edge", subject_.caseName, edge, 1e-4);
  report_.AddError(subject_.name, "multipliers", Case(" photons"), multipliers, 1e-5);
  // Photons start on the plane that touches the scene's sphere on the light's side.
  report_.AddError(subject_.name, "emission-positions", Case(" start plane"), plane, 1e-4);
}

// Checks positions on the scene's disk, given a direction.
void InfiniteChecker::CheckStartsGivenDirection(int index) {
  const auto start = FindFixedStart(subject_, FixedPart::Direction, 1e-5, places_);
  const std::string where = Case(" disk " + std::to_string(index));
  if (!start) {
    // Nothing is emitted, or no single random number determines the direction.
    const bool emits = light_.GetPowerEstimate(subject_.context).Average() > 0;
    report_.AddError(subject_.name, "emission-positions", where, emits ? 1 : 0, 0.5);
    return;
  }
  const Vector3d direction(start->photon.direction);
  const Frame frame = Frame::FromNormal(start->photon.direction);
  const Vector3d x(frame.x), y(frame.y);
  const auto pdfAt = [&](double squared, double turns) -> Integrands {
    const double r = radius_ * std::sqrt(squared), phi = 2 * kPiDouble * turns;
    const Point3 P(Point3d(scene_.center) + direction * radius_ + x * (r * std::cos(phi)) + y * (r * std::sin(phi)));
    if (isDelta_) {
      const auto sample = light_.GenerateSamples(subject_.context, P);
      return {sample ? Value(sample->pdfEmit) : 0.0, 0};
    }
    const auto e = light_.EvaluateSamples(subject_.context, HitAlong(Rounded(-direction), P), P);
    return {e && !IsBlack(*e) ? Value(e->pdfEmit) : 0.0, 0};
  };
  const auto onDisk = [&](const std::optional<EmissionSample>& photon) -> std::optional<Point2d> {
    if (!photon) return std::nullopt;
    const Vector3d offset = (Vector3d(photon->position) - Vector3d(scene_.center)) / radius_;
    const double a = glm::dot(offset, x), b = glm::dot(offset, y), turns = std::atan2(b, a) / (2 * kPiDouble);
    // Photons that start outside the disk hit nothing. The tolerance at the rim is for rounding.
    if (a * a + b * b > 1.0001) return std::nullopt;
    return Point2d(std::min(a * a + b * b, 0x1.fffffep-1), turns < 0 ? turns + 1 : turns);
  };
  std::vector<Point2d> hints;
  for (int i = 0; i < kHints; ++i) {
    if (const auto p = onDisk(light_.GenerateEmission(start->Draw(rng_.NextPoint2())))) hints.push_back(*p);
  }
  AdaptiveSquare quadrature(kPiDouble * radius_ * radius_, hints, pdfAt, rng_,
                            options_.effort * DirectionQuadrature::kBudget);
  const Estimate share = LatticeMean(rng_, 128, 32, [&](const float(&v)[4]) {
    return onDisk(light_.GenerateEmission(start->Draw({v[0], v[1]}))) ? 1.0 : 0.0;
  });
  report_.AddProbability(subject_.name, "emission-integral", where, EqualMeans(quadrature.Density(), share, 1e-3));
  const size_t cells = quadrature.MakeCells(48);
  std::vector<double> observed(cells + 1, 0.0), expected, errors;
  for (const Estimate& cell : quadrature.Cells()) {
    expected.push_back(options_.samples * cell.value);
    errors.push_back(options_.samples * cell.error);
  }
  expected.push_back(options_.samples * std::max(1 - quadrature.Density().value, 0.0));
  errors.push_back(options_.samples * (quadrature.Density().error + 1e-3));
  for (int i = 0; i < options_.samples; ++i) {
    const auto p = onDisk(light_.GenerateEmission(start->Draw(rng_.NextPoint2())));
    ++observed[p ? quadrature.CellOf(p->x, p->y) : cells];
  }
  report_.AddProbability(subject_.name, "emission-positions", where, ChiSquaredTest(observed, expected, errors));
}

void InfiniteChecker::CheckEmissionDirections() {
  DirectionEffort effort;
  effort.draws = options_.photons;
  effort.budget *= options_.effort;
  CheckDirectionsOf(subject_, DirectionsFromInfinity(subject_, options_.photons, places_), Case(" directions"), effort,
                    rng_, report_);
}

// Checks the power of emission against the power that leaves the scene's sphere, by direct sampling at points of the
// sphere.
void InfiniteChecker::CheckPower() {
  const auto contextFor = [&](const float(&x)[4]) {
    LightContext context = subject_.context;
    context.u = {x[0], x[1]};
    context.uDirection = {x[2], x[3]};
    return context;
  };
  const Estimate emitted = SharpMean(rng_, subject_.powerError, [&](const float(&x)[4]) {
    const auto photon = light_.GenerateEmission(contextFor(x));
    return photon ? Flux(subject_, *photon) : 0.0;
  });
  const double area = 4 * kPiDouble * radius_ * radius_;
  const Estimate direct = SharpMean(rng_, subject_.powerError, [&](const float(&x)[4]) {
    const Vector3d outward = Cap{}.Direction(2 * static_cast<double>(x[2]), static_cast<double>(x[3]));
    const Point3 P(Point3d(scene_.center) + radius_ * outward);
    const auto sample = light_.GenerateSamples(contextFor(x), P);
    if (!sample) return 0.0;
    const double leaving = std::max(-glm::dot(outward, Vector3d(sample->direction)), 0.0);
    return area * leaving * Emitted(subject_, *sample) / Value(sample->pdfDirect);
  });
  report_.AddProbability(subject_.name, "power", subject_.caseName, EqualMeans(emitted, direct, 1e-3),
                         InWords("the power that photons carry, in W,", emitted, direct));
  CheckPowerEstimate(subject_, emitted, report_);
}

}  // namespace

void CheckInfiniteLight(const SuiteSubject& subject, const SuiteOptions& options, SuiteReport& report) {
  InfiniteChecker(subject, options, report).Run();
}

}  // namespace lampyr::suite
