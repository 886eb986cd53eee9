// The suite's properties of lights with a surface. Integrals run over the surface's own parameters: every point that a
// direction meets counts, the hidden ones of a closed convex shape excepted.
#include "lights/suite/checks.h"
#include "lights/suite/statistics.h"

namespace lampyr::suite {

namespace {

using Element = EmitterModel::SurfaceElement;

// Cells of the surface: `side`² per patch, and a last one for what is not sampled at all.
struct Cells {
  int patches, side;

  explicit Cells(const EmitterModel& model)
      : patches(model.PatchCount()), side(std::max(2, static_cast<int>(std::lround(std::sqrt(64.0 / patches))))) {}
  size_t Count() const { return static_cast<size_t>(patches) * side * side; }
  size_t Of(const EmitterModel& model, int patch, const Point3& position) const {
    const Point2d p = model.Invert(patch, Point3d(position));
    const int i = std::clamp(static_cast<int>(p.x * side), 0, side - 1);
    const int j = std::clamp(static_cast<int>(p.y * side), 0, side - 1);
    return (static_cast<size_t>(patch) * side + j) * side + i;
  }
  // Calls function(cell, patch, element, dA) at the midpoints of n² parts of every cell.
  template <class Function>
  void ForAll(const EmitterModel& model, int n, const Function& function) const {
    const int across = side * n;
    for (int patch = 0; patch < patches; ++patch) {
      for (int k = 0; k < across * across; ++k) {
        const int i = k % across, j = k / across;
        const Element element = model.At(patch, (i + 0.5) / across, (j + 0.5) / across);
        const double area = element.area / (static_cast<double>(across) * across);
        if (area > 0) function((static_cast<size_t>(patch) * side + j / n) * side + i / n, patch, element, area);
      }
    }
  }
  int Subdivisions(int points) const {
    return std::max(4, 2 * static_cast<int>(std::sqrt(points / static_cast<double>(Count())) / 2));
  }
};

struct Quadrature {
  std::vector<double> cells;  // ∫ pdfDirect dω, where light arrives
  double integral = 0, fluence = 0;
  double leak = 0;  // radiance or density behind a one-sided surface
};

// Seen from nearer to its plane than this, a surface's cosine is rounding: such points count as not sampled.
constexpr double kEdgeOn = 1e-4;

struct Receiver {
  std::string name;
  Point3 position;
};

class AreaChecker {
 public:
  AreaChecker(const SuiteSubject& subject, const SuiteOptions& options, SuiteReport& report)
      : subject_(subject),
        light_(*subject.light),
        model_(*subject.model),
        options_(options),
        report_(report),
        cells_(model_),
        extent_(model_.Measure()),
        rng_(options.seed, Hash(std::hash<std::string>{}(subject.name + subject.caseName))) {
    const std::optional<EmissionBounds> bounds = light_.GetEmissionBounds(subject.context);
    oneSided_ = bounds && !bounds->twoSided;
  }

  void Run() {
    for (const Receiver& receiver : Receivers()) CheckReceiver(receiver);
    CheckEmission();
    CheckEmissionDirections();
    CheckPower();
  }

 private:
  std::vector<Receiver> Receivers() const;
  void CheckReceiver(const Receiver& receiver);
  void CheckSample(const LightSample& sample, const Point3& P, double& consistency, double& surface) const;
  void CheckEstimates(const Receiver& receiver, bool arrives);
  void CheckEmission();
  void CheckEmissionDirections();
  void CheckPower();
  Quadrature Integrate(const Point3& P, int subdivisions) const;
  bool IsHidden(const Element& element, const Point3& P, bool inside) const;
  bool IsInside(const Point3& P) const;
  // Neither hidden nor edge-on: one of the points that Integrate counts.
  bool Arrives(const LightSample& sample, const Point3& P, bool inside) const {
    if (static_cast<double>(AbsDot(sample.normal, sample.direction)) < kEdgeOn) return false;
    Element element;
    element.position = Point3d(sample.position);
    element.normal = Vector3d(sample.normal);
    return !IsHidden(element, P, inside);
  }
  // Mean of function(context, v) over all random numbers, from randomly shifted lattices: far less noise than
  // independent numbers, and the spread of the lattices' means is the error.
  template <class Function>
  RunningMean StratifiedMean(const Function& function) {
    constexpr int kLattices = 64;
    // Powers of the inverse of the root of x⁵ = x + 1 ([Roberts18]).
    constexpr double steps[4] = {0.8566748838545029, 0.7338918566271260, 0.6287067210378087, 0.5385972572236101};
    RunningMean means;
    for (int lattice = 0; lattice < kLattices; ++lattice) {
      double shift[4], sum = 0;
      for (double& s : shift) s = static_cast<double>(rng_.NextFloat());
      const int points = std::max(1, options_.photons / kLattices);
      for (int i = 0; i < points; ++i) {
        float x[4];
        for (int k = 0; k < 4; ++k) {
          const double value = shift[k] + i * steps[k];
          x[k] = std::min(static_cast<float>(value - std::floor(value)), kOneMinusEpsilon);
        }
        LightContext context = subject_.context;
        context.u = {x[0], x[1]};
        context.uDirection = {x[2], x[3]};
        sum += function(context, context.uDirection);
      }
      means.Add(sum / points);
    }
    return means;
  }
  LightContext RandomContext() {
    LightContext context = subject_.context;
    context.u = rng_.NextPoint2();
    context.uDirection = rng_.NextPoint2();
    return context;
  }
  std::string Case(const std::string& suffix) const { return subject_.caseName + suffix; }

  const SuiteSubject& subject_;
  const Light& light_;
  const EmitterModel& model_;
  const SuiteOptions& options_;
  SuiteReport& report_;
  Cells cells_;
  EmitterModel::Extent extent_;
  Rng rng_;
  bool oneSided_ = false;
};

std::vector<Receiver> AreaChecker::Receivers() const {
  const Element e = model_.At(0, 0.4, 0.55);
  const Vector3d n = e.normal;
  const Vector3d t = glm::normalize(glm::cross(n, std::abs(n.x) < 0.7 ? Vector3d(1, 0, 0) : Vector3d(0, 1, 0)));
  const Vector3d s = glm::cross(n, t);
  const double r = extent_.radius;
  return {
      {"near", Point3(e.position + n * (0.3 * r) + t * (0.05 * r))},
      {"far", Point3(extent_.middle + (n * 0.8 + t * 0.5 - s * 0.3) * (100 * r))},
      {"grazing", Point3(extent_.middle + t * (2 * r) + n * (0.05 * r))},
      {"behind", Point3(extent_.middle - n * (3 * r) + s * (0.2 * r))},
      {"on-plane", Point3(e.position + s * (3 * r))},
      {"inside", Point3(extent_.middle + (t * 0.11 + s * 0.07 + n * 0.09) * r)},
  };
}

bool AreaChecker::IsInside(const Point3& P) const {
  if (!model_.IsClosedConvex()) return false;
  for (int i = 0; i < 256; ++i) {
    const Element e = model_.At(0, (i % 16 + 0.5) / 16, (i / 16 + 0.5) / 16);
    const double outward = glm::dot(e.normal, e.position - extent_.middle) > 0 ? 1 : -1;
    if (outward * glm::dot(e.normal, Point3d(P) - e.position) > 0) return false;
  }
  return true;
}

bool AreaChecker::IsHidden(const Element& e, const Point3& P, bool inside) const {
  if (!model_.IsClosedConvex() || inside) return false;
  const double outward = glm::dot(e.normal, e.position - extent_.middle) > 0 ? 1 : -1;
  return outward * glm::dot(e.normal, Point3d(P) - e.position) <= 0;
}

Quadrature AreaChecker::Integrate(const Point3& P, int subdivisions) const {
  Quadrature result;
  result.cells.resize(cells_.Count());
  const bool inside = IsInside(P);
  cells_.ForAll(model_, subdivisions, [&](size_t cell, int patch, const Element& element, double area) {
    const LightHit hit = model_.HitFrom(patch, element, P);
    const Vector3d way = element.position - Point3d(P);
    const double squared = glm::dot(way, way), cosine = -glm::dot(way, element.normal) / std::sqrt(squared);
    const auto evaluation = light_.EvaluateSamples(subject_.context, hit, P);
    if (!evaluation) return;
    const auto radiance = static_cast<double>(evaluation->diffuse.Average());
    const auto pdf = static_cast<double>(evaluation->pdfDirect.value);
    if (oneSided_ && cosine < -1e-4) result.leak = std::max(result.leak, radiance > 0 ? 1.0 : 0.0);
    if (IsHidden(element, P, inside) || radiance == 0 || std::abs(cosine) < kEdgeOn) return;
    const double solidAngle = std::abs(cosine) / squared * area;
    result.cells[cell] += pdf * solidAngle;
    result.integral += pdf * solidAngle;
    result.fluence += radiance * solidAngle;
  });
  return result;
}

// Largest relative differences of a sample against EvaluateSamples for the very same point, and for the same point as
// the shape itself has it.
void AreaChecker::CheckSample(const LightSample& sample, const Point3& P, double& consistency, double& surface) const {
  LightHit hit;
  hit.direction = sample.direction;
  hit.distance = sample.distance;
  hit.position = sample.position;
  hit.normal = sample.normal;
  hit.uv = Point2(sample.uvw.x, sample.uvw.y);
  hit.patchIndex = sample.patchIndex;
  const auto e = light_.EvaluateSamples(subject_.context, hit, P);
  if (!e) {
    consistency = 1;
    return;
  }
  const auto note = [&](double a, double b) { consistency = std::max(consistency, RelativeDifference(a, b)); };
  note(static_cast<double>(sample.pdfDirect.value), static_cast<double>(e->pdfDirect.value));
  note(static_cast<double>(sample.pdfEmit.value), static_cast<double>(e->pdfEmit.value));
  note(static_cast<double>(sample.pdfEmitDirection.value), static_cast<double>(e->pdfEmitDirection.value));
  note(static_cast<double>(sample.solidAngleToArea), static_cast<double>(e->solidAngleToArea));
  consistency = std::max(consistency, RelativeDifference(sample.diffuse, e->diffuse));
  consistency = std::max(consistency, static_cast<double>(glm::length(sample.normal - e->normal)));
  consistency = std::max(consistency, static_cast<double>(std::abs(glm::length(sample.direction) - 1)));

  const Point2d p = model_.Invert(sample.patchIndex, Point3d(sample.position));
  const Element element = model_.At(sample.patchIndex, p.x, p.y);
  const double scale = glm::length(Point3d(sample.position)) + extent_.radius;
  surface = std::max(surface, glm::length(element.position - Point3d(sample.position)) / scale);
  surface = std::max(surface, glm::length(element.normal - Vector3d(sample.normal)));
  const LightHit own = model_.HitFrom(sample.patchIndex, element, P);
  // Where the light is seen edge-on, rounding of the position turns the cosine.
  if (std::abs(glm::dot(own.normal, own.direction)) < 0.02f) return;
  const auto other = light_.EvaluateSamples(subject_.context, own, P);
  surface = std::max(surface, other ? 0.1 * RelativeDifference(static_cast<double>(sample.pdfDirect.value),
                                                               static_cast<double>(other->pdfDirect.value))
                                    : 1.0);
}

void AreaChecker::CheckReceiver(const Receiver& receiver) {
  const int n = cells_.Subdivisions(9216);
  const Point3& P = receiver.position;
  const Quadrature fine = Integrate(P, n), coarse = Integrate(P, n / 2);
  const double error = std::abs(fine.integral - coarse.integral);
  const size_t count = cells_.Count();
  std::vector<double> observed(count + 1, 0.0), expected(count + 1, 0.0), errors(count + 1, 0.0);
  RunningMean fluence;
  const bool inside = IsInside(P);
  double found = 0, consistency = 0, surface = 0;
  for (int i = 0; i < options_.samples; ++i) {
    const auto sample = light_.GenerateSamples(RandomContext(), P);
    if (sample && i % 4 == 0) CheckSample(*sample, P, consistency, surface);
    if (!sample || !Arrives(*sample, P, inside)) {
      fluence.Add(0);
      ++observed[count];
      continue;
    }
    ++found;
    ++observed[cells_.Of(model_, sample->patchIndex, sample->position)];
    fluence.Add(static_cast<double>(sample->diffuse.Average()) / static_cast<double>(sample->pdfDirect.value));
  }
  const double share = found / options_.samples;
  const std::string where = Case(" " + receiver.name);
  const double statistical = 5.5 * std::sqrt(share * (1 - share) / options_.samples);
  report_.AddError(subject_.name, "integral", where, std::abs(fine.integral - share), 2e-3 + 2 * error + statistical);
  for (size_t i = 0; i < count; ++i) {
    expected[i] = options_.samples * fine.cells[i];
    // The last term: a cell that the horizon touches between the quadrature's points.
    errors[i] = options_.samples * (2 * std::abs(fine.cells[i] - coarse.cells[i]) + 1e-3 * fine.cells[i] + 2e-4);
  }
  expected[count] = options_.samples * std::max(1 - fine.integral, 0.0);
  errors[count] = options_.samples * (2 * error + 1e-3);
  report_.AddProbability(subject_.name, "directions", where, ChiSquaredTest(observed, expected, errors));
  report_.AddProbability(subject_.name, "irradiance", where,
                         EqualMeans(fluence.Mean(), fluence.StandardError(), fine.fluence,
                                    2 * std::abs(fine.fluence - coarse.fluence), 1e-3));
  report_.AddError(subject_.name, "consistency", where, consistency, 1e-4);
  report_.AddError(subject_.name, "surface", where, surface, 2e-3);
  report_.AddError(subject_.name, "one-sided", where, fine.leak, 0.5);
  CheckEstimates(receiver, found > 0);
}

void AreaChecker::CheckEstimates(const Receiver& receiver, bool arrives) {
  if (!arrives) return;
  double missed = light_.GetIncidentRadianceEstimate(subject_.context, receiver.position) > 0 ? 0 : 1;
  for (int i = 0; i < 8; ++i) {
    const float length = static_cast<float>(extent_.radius) * (0.2f + 4 * rng_.NextFloat());
    const float t = length * (0.1f + 0.8f * rng_.NextFloat());
    const Vector3 direction =
        Cap{}.Direction(2 * static_cast<double>(rng_.NextFloat()), static_cast<double>(rng_.NextFloat()));
    const auto segment =
        light_.GetIncidentRadianceEstimate(subject_.context, receiver.position - t * direction, direction, length);
    if (!segment || !(segment->radiance > 0) || !(segment->minT <= t && t <= segment->maxT)) missed = 1;
  }
  report_.AddError(subject_.name, "estimate", Case(" " + receiver.name), missed, 0.5);
}

void AreaChecker::CheckEmission() {
  const size_t count = cells_.Count();
  const int n = cells_.Subdivisions(4096);
  std::vector<double> expected(count + 1, 0.0), errors(count + 1, 0.0), observed(count + 1, 0.0);
  double integral = 0;
  cells_.ForAll(model_, n, [&](size_t cell, int patch, const Element& element, double area) {
    const Point3 P(element.position + element.normal * (3 * extent_.radius));
    const auto evaluation = light_.EvaluateSamples(subject_.context, model_.HitFrom(patch, element, P), P);
    if (!evaluation || evaluation->diffuse.IsBlack()) return;
    expected[cell] += static_cast<double>(evaluation->pdfEmit.value) * area;
    integral += static_cast<double>(evaluation->pdfEmit.value) * area;
  });
  const std::optional<EmissionBounds> bounds = light_.GetEmissionBounds(subject_.context);
  double edge = 0, outside = 0, found = 0;
  for (int i = 0; i < options_.photons; ++i) {
    const auto photon = light_.GenerateEmission(RandomContext());
    if (!photon) {
      ++observed[count];
      continue;
    }
    ++found;
    ++observed[cells_.Of(model_, photon->patchIndex, photon->position)];
    // The edge to where the photon may land.
    LightHit hit;
    hit.direction = -photon->direction;
    hit.distance = static_cast<float>(2 * extent_.radius);
    hit.position = photon->position;
    hit.normal = photon->normal;
    hit.uv = Point2(photon->uvw.x, photon->uvw.y);
    hit.patchIndex = photon->patchIndex;
    const auto e = light_.EvaluateSamples(subject_.context, hit, photon->position + hit.distance * photon->direction);
    edge = std::max(
        edge, e ? RelativeDifference(static_cast<double>(photon->pdfEmit.value), static_cast<double>(e->pdfEmit.value))
                : 1.0);
    if (e) {
      edge = std::max(edge, RelativeDifference(static_cast<double>(photon->pdfEmitDirection.value),
                                               static_cast<double>(e->pdfEmitDirection.value)));
      edge = std::max(edge, RelativeDifference(photon->diffuse, e->diffuse));
    }
    if (bounds) {
      const Vector3 slack = Vector3(1e-4f * static_cast<float>(extent_.radius)) + 4.0f * photon->positionError;
      const bool inBox = glm::all(glm::greaterThanEqual(photon->position, bounds->box.min - slack)) &&
                         glm::all(glm::lessThanEqual(photon->position, bounds->box.max + slack));
      float cosine = glm::dot(photon->normal, bounds->axis);
      if (bounds->twoSided) cosine = std::abs(cosine);
      if (!inBox || cosine < bounds->cosThetaO - 1e-3f) outside = 1;
    }
  }
  const double share = found / options_.photons;
  for (size_t i = 0; i < count; ++i) {
    expected[i] *= options_.photons;
    errors[i] = 2e-3 * expected[i];
  }
  expected[count] = options_.photons * std::max(1 - integral, 0.0);
  errors[count] = 2e-3 * options_.photons;
  const double statistical = 5.5 * std::sqrt(share * (1 - share) / options_.photons);
  report_.AddError(subject_.name, "emission-integral", Case(" positions"), std::abs(integral - share),
                   3e-3 + statistical);
  report_.AddProbability(subject_.name, "emission-positions", Case(""), ChiSquaredTest(observed, expected, errors));
  report_.AddError(subject_.name, "emission-edge", Case(""), edge, 1e-4);
  report_.AddError(subject_.name, "bounds", Case(""), bounds ? outside : 1.0, 0.5);
}

// Given one position, the directions.
void AreaChecker::CheckEmissionDirections() {
  LightContext fixed = RandomContext();
  std::optional<EmissionSample> start;
  for (int i = 0; i < 100 && !start; ++i) {
    fixed = RandomContext();
    start = light_.GenerateEmission(fixed);
  }
  if (!start) return;
  LightHit hit;
  hit.distance = static_cast<float>(2 * extent_.radius);
  hit.position = start->position;
  hit.normal = start->normal;
  hit.uv = Point2(start->uvw.x, start->uvw.y);
  hit.patchIndex = start->patchIndex;
  DirectionTest test;
  test.integralProperty = "emission-integral";
  test.chiSquaredProperty = "emission-directions";
  test.samples = options_.photons / 2;
  test.density = [&](const Vector3& direction) {
    hit.direction = -direction;
    const auto e = light_.EvaluateSamples(subject_.context, hit, start->position + hit.distance * direction);
    return e ? static_cast<double>(e->pdfEmitDirection.value) : 0.0;
  };
  test.sample = [&](Rng& rng) -> std::optional<Vector3> {
    LightContext context = fixed;
    context.uDirection = rng.NextPoint2();
    const auto photon = light_.GenerateEmission(context);
    if (!photon) return std::nullopt;
    return photon->direction;
  };
  CheckDirections(subject_, " directions", Cap{Vector3d(start->normal), 2}, test, rng_, report_);
}

void AreaChecker::CheckPower() {
  const RunningMean emitted = StratifiedMean([&](const LightContext& context, const Point2&) {
    const auto photon = light_.GenerateEmission(context);
    return photon ? Flux(*photon) : 0.0;
  });
  // What arrives at a sphere around it; a closed surface that emits inwards keeps that part to itself.
  const double radius = 2.5 * extent_.radius, area = 4 * 3.14159265358979323846 * radius * radius;
  const RunningMean direct = StratifiedMean([&](const LightContext& context, const Point2& v) {
    const Vector3d outward(Cap{}.Direction(2 * static_cast<double>(v.x), static_cast<double>(v.y)));
    const auto sample = light_.GenerateSamples(context, Point3(extent_.middle + outward * radius));
    return sample ? -glm::dot(outward, Vector3d(sample->direction)) * area *
                        static_cast<double>(sample->diffuse.Average()) / static_cast<double>(sample->pdfDirect.value)
                  : 0.0;
  });
  const auto estimate = static_cast<double>(light_.GetPowerEstimate(subject_.context).Average());
  if (!model_.IsClosedConvex() || oneSided_) {
    const bool emitsInwards = model_.IsClosedConvex() && direct.Mean() == 0;
    if (!emitsInwards) {
      report_.AddProbability(
          subject_.name, "power", Case(""),
          EqualMeans(emitted.Mean(), emitted.StandardError(), direct.Mean(), direct.StandardError(), 1e-3));
    }
  }
  if (subject_.isPowerExact) {
    report_.AddProbability(subject_.name, "power-estimate", Case(""),
                           EqualMeans(emitted.Mean(), emitted.StandardError(), estimate, 0, 1e-3));
  } else {
    report_.AddError(subject_.name, "power-estimate", Case(""), RelativeDifference(emitted.Mean(), estimate), 0.2);
  }
}

}  // namespace

void CheckAreaLight(const SuiteSubject& subject, const SuiteOptions& options, SuiteReport& report) {
  AreaChecker(subject, options, report).Run();
}

}  // namespace lampyr::suite
