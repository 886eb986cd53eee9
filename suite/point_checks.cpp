// Properties of point lights.
#include "math/frame.h"
#include "suite/checks.h"

namespace lampyr::suite {

namespace {

// The largest difference of two quantities that should be the same, relative to the largest value that occurs: in a
// narrow cone the rounding of a direction is a significant part of its soft edge.
struct LargestDifference {
  double difference = 0, largest = 0;
  void Note(double a, double b) {
    difference = std::max(difference, std::abs(a - b));
    largest = std::max(largest, std::max(std::abs(a), std::abs(b)));
  }
  void Note(const Color& a, const Color& b, double factorOfB) {
    Note(static_cast<double>(a.r), factorOfB * static_cast<double>(b.r));
    Note(static_cast<double>(a.g), factorOfB * static_cast<double>(b.g));
    Note(static_cast<double>(a.b), factorOfB * static_cast<double>(b.b));
  }
  double Relative() const { return largest > 0 ? difference / largest : 0.0; }
};

class PointChecker {
 public:
  PointChecker(const SuiteSubject& subject, const SuiteOptions& options, SuiteReport& report)
      : subject_(subject),
        light_(*subject.light),
        distance_(subject.context.scene.radius),
        options_(options),
        report_(report),
        rng_(MakeRng(subject, options)) {}

  void Run() {
    for (int i = 0; i < options_.photons; ++i) {
      const auto photon = light_.GenerateEmission(RandomContext(subject_, rng_));
      if (photon) photons_.push_back(*photon);
    }
    if (photons_.empty()) {
      const bool emits = light_.GetPowerEstimate(subject_.context).Average() > 0;
      report_.AddError(subject_.name, "power", subject_.caseName, emits ? 1 : 0, 0.5);
      return;
    }
    position_ = photons_[0].position;
    for (const Receiver& receiver : Receivers()) CheckReceiver(receiver);
    CheckPhotons();
    CheckEmissionDirections();
  }

 private:
  std::vector<Receiver> Receivers();
  void CheckReceiver(const Receiver& receiver);
  void CheckPhotons();
  void CheckEstimatesAt(const Point3& P, double& missed);
  void CheckEmissionDirections();
  std::optional<LightSample> SampleAt(const Vector3d& outward) const {
    return light_.GenerateSamples(subject_.context, position_ + distance_ * Vector3(outward));
  }
  std::optional<LightSample> SampleOnPhotonsWay(const EmissionSample& photon) const;
  double IntensityError(double intensity, const Vector3d& outward, double rounding) const;
  // Intensity of a sample, mean of the channels.
  double Intensity(const std::optional<LightSample>& sample) const {
    if (!sample) return 0;
    const auto distance = static_cast<double>(sample->distance);
    return Emitted(subject_, *sample) * distance * distance;
  }
  std::string Case(const std::string& suffix) const { return subject_.caseName + suffix; }

  const SuiteSubject& subject_;
  const Light& light_;
  float distance_;
  const SuiteOptions& options_;
  SuiteReport& report_;
  Rng rng_;
  std::vector<EmissionSample> photons_;
  Point3 position_{0.0f};
};

// Receivers around the light. The mean direction of its photons is taken as the axis of its beam.
std::vector<Receiver> PointChecker::Receivers() {
  Vector3d mean(0.0);
  for (const EmissionSample& photon : photons_) mean += Vector3d(photon.direction);
  const Vector3d first(photons_[0].direction);
  const Vector3d axis = glm::length(mean) > 0.05 * static_cast<double>(photons_.size()) ? glm::normalize(mean) : first;
  const Vector3d across =
      glm::normalize(glm::cross(axis, std::abs(axis.x) < 0.7 ? Vector3d(1, 0, 0) : Vector3d(0, 1, 0)));
  const auto at = [&](const Vector3d& direction, double distance) {
    return Point3(Point3d(position_) + glm::normalize(direction) * (distance * static_cast<double>(distance_)));
  };
  const Vector3d other(photons_[photons_.size() / 2].direction), last(photons_.back().direction);
  return {
      {"on the axis", at(axis, 1)},         {"near", at(first, 0.02)},      {"far", at(other, 300)},
      {"at 1e-4", at(last, 1e-4)},          {"beside", at(across, 0.7)},    {"behind the beam", at(-axis, 0.9)},
      {"at the rim", at(axis + across, 2)}, {"in the beam", at(last, 0.5)}, {"oblique", at(axis * 0.3 + across, 1.3)}};
}

void PointChecker::CheckEstimatesAt(const Point3& P, double& missed) {
  if (!(light_.GetIncidentRadianceEstimate(subject_.context, P) > 0)) missed = 1;
  const Vector3 along(RandomDirection(rng_));
  const float before = distance_ * rng_.NextFloat();
  const auto segment = light_.GetIncidentRadianceEstimate(subject_.context, P - before * along, along, 2 * distance_);
  if (!segment || !(segment->radiance > 0) || !(segment->minT <= before * 1.001f && before * 0.999f <= segment->maxT))
    missed = 1;
}

// Deviation of `intensity` from the intensities that the light emits along `outward`, or along directions that rounding
// does not distinguish from it: a beam may end within less than that.
double PointChecker::IntensityError(double intensity, const Vector3d& outward, double rounding) const {
  const double there = Intensity(SampleAt(outward));
  double least = there, most = there;
  if (std::abs(intensity - there) > 1e-3 * std::max(intensity, there)) {
    const Frame frame = Frame::FromNormal(Vector3(outward));
    for (int i = 0; i < 8; ++i) {
      const double turn = 0.25 * kPiDouble * i;
      const Vector3d around = std::cos(turn) * Vector3d(frame.x) + std::sin(turn) * Vector3d(frame.y);
      const double beside = Intensity(SampleAt(glm::normalize(outward + rounding * around)));
      least = std::min(least, beside);
      most = std::max(most, beside);
    }
  }
  return std::max({least - intensity, intensity - most, 0.0});
}

// Checks the sample's geometry, its discrete densities and the inverse-square law: along one direction the intensity is
// the same at every distance.
void PointChecker::CheckReceiver(const Receiver& receiver) {
  const Point3& P = receiver.position;
  const Vector3d toLight = Point3d(position_) - Point3d(P);
  const double distance = glm::length(toLight), scale = distance + glm::length(Point3d(position_));
  const auto sample = light_.GenerateSamples(RandomContext(subject_, rng_), P);
  double consistency = 0, multipliers = 0, missed = 0;
  LightHit hit;
  hit.direction = Vector3(toLight / distance);
  hit.distance = static_cast<float>(distance);
  hit.position = position_;
  const auto found = light_.EvaluateSamples(subject_.context, hit, P);
  if (found) consistency = 1;  // deltas are never found
  if (sample) {
    const double rounding = 4e-7 * scale / distance;
    const auto note = [&](double error) { consistency = std::max(consistency, error); };
    note(std::max(std::abs(static_cast<double>(sample->distance) / distance - 1) - rounding, 0.0));
    note(std::max(glm::length(Vector3d(sample->direction) - toLight / distance) - rounding, 0.0));
    note(glm::length(Point3d(sample->position) - Point3d(position_)) / scale);
    note(sample->pdfDirect.value == 1 ? 0 : 1);
    note(RelativeDifference(static_cast<double>(sample->solidAngleToArea), 1));
    note(RelativeDifference(Value(sample->pdfEmit), Value(photons_[0].pdfEmit)));
    multipliers = MultiplierMismatch(subject_, *sample);
    CheckEstimatesAt(P, missed);
  }
  const std::string where = Case(" " + receiver.name);
  report_.AddError(subject_.name, "consistency", where, consistency, 1e-5);
  report_.AddError(subject_.name, "camera", where, CameraMismatch(subject_, hit, found).value_or(0.0), 1e-4);
  report_.AddError(subject_.name, "multipliers", where, multipliers, 1e-5);
  report_.AddError(subject_.name, "estimate", where, missed, 0.5);
  // Intensity in the same direction, measured at another distance.
  const Vector3d outward = glm::normalize(-toLight);
  const double here = Intensity(sample), error = IntensityError(here, outward, 4e-7 * scale / distance);
  double largest = std::max(here, Intensity(SampleAt(outward)));
  for (const EmissionSample& photon : photons_) largest = std::max(largest, Emitted(subject_, photon));
  report_.AddError(subject_.name, "irradiance", where, largest > 0 ? error / largest : 0.0, 5e-3);
}

// The light's sample in the direction of the photon. Where its intensity or its density jumps (on the edge of a texel),
// the two roundings of the direction may fall on either side: the most similar sample within rounding is returned.
std::optional<LightSample> PointChecker::SampleOnPhotonsWay(const EmissionSample& photon) const {
  const Point3 P = position_ + distance_ * photon.direction;
  const auto difference = [&](const std::optional<LightSample>& sample) {
    if (!sample) return 2.0;
    return std::max(RelativeDifference(Emitted(subject_, photon), Intensity(sample)),
                    RelativeDifference(Value(photon.pdfEmitDirection), Value(sample->pdfEmitDirection)));
  };
  std::optional<LightSample> best = light_.GenerateSamples(subject_.context, P);
  if (!best || difference(best) < 1e-2) return best;
  const float rounding = 4e-7f * (glm::length(P) + glm::length(position_));
  const Frame frame = Frame::FromNormal(photon.direction);
  for (int i = 0; i < 8; ++i) {
    const double turn = 0.25 * kPiDouble * i;
    const Vector3 around = static_cast<float>(std::cos(turn)) * frame.x + static_cast<float>(std::sin(turn)) * frame.y;
    const auto near = light_.GenerateSamples(subject_.context, P + rounding * around);
    if (difference(near) < difference(best)) best = near;
  }
  return best;
}

void PointChecker::CheckPhotons() {
  const std::optional<EmissionBounds> bounds = light_.GetEmissionBounds(subject_.context);
  double edge = 0, outside = bounds ? 0 : 1, missed = 0, multipliers = 0;
  LargestDifference density, diffuse, specular;
  for (const EmissionSample& photon : photons_) {
    const Point3 P = position_ + distance_ * photon.direction;
    multipliers = std::max(multipliers, MultiplierMismatch(subject_, photon));
    if (glm::length(photon.position - position_) > 0) edge = 1;
    if (bounds && bounds->cosThetaO > -1 && glm::dot(bounds->axis, photon.direction) < bounds->cosThetaE - 1e-4f)
      outside = 1;
    if (bounds && glm::length(position_ - bounds->box.Center()) > 1e-5f * (distance_ + glm::length(position_)))
      outside = 1;
    const auto sample = SampleOnPhotonsWay(photon);
    if (!sample) continue;
    const auto d2 = static_cast<double>(sample->distance) * static_cast<double>(sample->distance);
    density.Note(Value(photon.pdfEmitDirection), Value(sample->pdfEmitDirection));
    diffuse.Note(photon.diffuse, sample->diffuse, d2);
    specular.Note(photon.specular, sample->specular, d2);
    edge = std::max(edge, RelativeDifference(Value(photon.pdfEmit), Value(sample->pdfEmit)));
    edge = std::max(edge, static_cast<double>(glm::length(sample->direction + photon.direction)) > 1e-3 ? 1.0 : 0.0);
    edge = std::max(edge, std::abs(static_cast<double>(photon.emissionCosine) - 1));
    CheckEstimatesAt(P, missed);
  }
  report_.AddError(subject_.name, "emission-edge", subject_.caseName,
                   std::max({edge, density.Relative(), diffuse.Relative(), specular.Relative()}), 2e-2);
  report_.AddError(subject_.name, "multipliers", Case(" photons"), multipliers, 1e-5);
  report_.AddError(subject_.name, "bounds", subject_.caseName, outside, 0.5);
  report_.AddError(subject_.name, "estimate", Case(" photons"), missed, 0.5);
}

// χ² of directions and, by the same quadrature, the power by direct sampling: ∫ I dω over the whole sphere.
void PointChecker::CheckEmissionDirections() {
  std::vector<Vector3d> directions;
  for (const EmissionSample& photon : photons_) directions.push_back(glm::normalize(Vector3d(photon.direction)));
  const std::vector<Vector3d> hints = DrawDirections(rng_, kHints, [&](Rng& rng) -> std::optional<Vector3> {
    const auto photon = light_.GenerateEmission(RandomContext(subject_, rng));
    if (!photon) return std::nullopt;
    return photon->direction;
  });
  DirectionQuadrature quadrature(
      CapAround(hints), hints,
      [&](const Vector3d& outward) -> Integrands {
        const auto sample = SampleAt(outward);
        return {sample ? Value(sample->pdfEmitDirection) : 0.0, Intensity(sample)};
      },
      rng_, 4 * options_.effort * DirectionQuadrature::kBudget);
  const auto contextFor = [&](const float(&x)[4]) {
    LightContext context = subject_.context;
    context.u = {x[0], x[1]};
    context.uDirection = {x[2], x[3]};
    return context;
  };
  const Estimate share = LatticeMean(
      rng_, 128, 32, [&](const float(&x)[4]) { return light_.GenerateEmission(contextFor(x)) ? 1.0 : 0.0; });
  report_.AddProbability(subject_.name, "emission-integral", subject_.caseName,
                         EqualMeans(quadrature.Density(), share, 1e-3),
                         InWords("the integral of pdfEmitDirection", quadrature.Density(), share));
  std::string worst;
  const double p = quadrature.Test(directions, options_.photons, 48, &worst);
  report_.AddProbability(subject_.name, "emission-directions", subject_.caseName, p, worst);
  const Estimate emitted = SharpMean(rng_, subject_.powerError, [&](const float(&x)[4]) {
    const auto photon = light_.GenerateEmission(contextFor(x));
    return photon ? Flux(subject_, *photon) : 0.0;
  });
  report_.AddProbability(subject_.name, "power", subject_.caseName, EqualMeans(emitted, quadrature.Radiance(), 1e-3),
                         InWords("the power that photons carry, in W,", emitted, quadrature.Radiance()));
  CheckPowerEstimate(subject_, emitted, report_);
}

}  // namespace

void CheckPointLight(const SuiteSubject& subject, const SuiteOptions& options, SuiteReport& report) {
  PointChecker(subject, options, report).Run();
}

}  // namespace lampyr::suite
