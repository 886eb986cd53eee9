// Properties of lights on a shape, for which there is a model. Integrals run over the surface's own parameters: every
// point that a direction hits counts, except the hidden ones of a closed convex shape.
#include "suite/area_common.h"

namespace lampyr::suite {

namespace {

using Element = EmitterModel::SurfaceElement;

// Cells of the surface: `side`² per patch, and a last one for draws without a counted sample.
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
  double dark = 0;    // ∫ pdfDirect dω, where no light arrives
  double leak = 0;    // radiance behind a one-sided surface
  double camera = 0;  // largest difference between a camera's radiance and the evaluation
};

// Below this value, a surface's cosine is dominated by rounding: such points count as not sampled.
constexpr double kEdgeOn = 1e-4;

class ShapeChecker {
 public:
  ShapeChecker(const SuiteSubject& subject, const SuiteOptions& options, SuiteReport& report)
      : subject_(subject),
        light_(*subject.light),
        model_(*subject.model),
        options_(options),
        report_(report),
        cells_(model_),
        extent_(model_.Measure()),
        enclosure_{extent_.middle, extent_.radius},
        rng_(MakeRng(subject, options)) {
    bounds_ = light_.GetEmissionBounds(subject.context);
  }

  void Run() {
    const Element element = model_.At(0, 0.4, 0.55);
    for (const Receiver& receiver : ReceiversAround(enclosure_, element.position, element.normal)) {
      CheckReceiver(receiver);
    }
    CheckEmission();
    CheckAreaEmissionDirections(subject_, options_, enclosure_, rng_, report_);
    const Visibility visibility{
        [&](const EmissionSample& photon) { return !model_.IsClosedConvex() || LeavesOutwards(photon); },
        [&](const LightSample& sample, const Point3& P) { return Arrives(sample, P, false); }};
    CheckAreaPower(subject_, enclosure_, visibility, rng_, report_);
  }

 private:
  void CheckReceiver(const Receiver& receiver);
  void CheckSample(const LightSample& sample, const Point3& P, double& consistency, double& surface) const;
  double DensityMismatch(const LightSample& sample, const Point3& P, const Point2d& p) const;
  void CheckEmission();
  Quadrature Integrate(const Point3& P, int subdivisions) const;
  bool IsHidden(const Element& element, const Point3& P, bool inside) const;
  bool IsInside(const Point3& P) const;
  // True if the sample is neither hidden nor edge-on: one of the points that Integrate counts.
  bool Arrives(const LightSample& sample, const Point3& P, bool inside) const {
    if (static_cast<double>(AbsDot(sample.normal, sample.direction)) < kEdgeOn) return false;
    Element element;
    element.position = Point3d(sample.position);
    element.normal = Vector3d(sample.normal);
    return !IsHidden(element, P, inside);
  }
  bool LeavesOutwards(const EmissionSample& photon) const {
    const double side = glm::dot(Vector3d(photon.normal), Point3d(photon.position) - extent_.middle);
    return side * glm::dot(Vector3d(photon.normal), Vector3d(photon.direction)) > 0;
  }
  std::string Case(const std::string& suffix) const { return subject_.caseName + suffix; }

  const SuiteSubject& subject_;
  const Light& light_;
  const EmitterModel& model_;
  const SuiteOptions& options_;
  SuiteReport& report_;
  Cells cells_;
  EmitterModel::Extent extent_;
  Enclosure enclosure_;
  Rng rng_;
  std::optional<EmissionBounds> bounds_;
};

bool ShapeChecker::IsInside(const Point3& P) const {
  if (!model_.IsClosedConvex()) return false;
  for (int i = 0; i < 256; ++i) {
    const Element e = model_.At(0, (i % 16 + 0.5) / 16, (i / 16 + 0.5) / 16);
    const double outward = glm::dot(e.normal, e.position - extent_.middle) > 0 ? 1 : -1;
    if (outward * glm::dot(e.normal, Point3d(P) - e.position) > 0) return false;
  }
  return true;
}

bool ShapeChecker::IsHidden(const Element& e, const Point3& P, bool inside) const {
  if (!model_.IsClosedConvex() || inside) return false;
  const double outward = glm::dot(e.normal, e.position - extent_.middle) > 0 ? 1 : -1;
  return outward * glm::dot(e.normal, Point3d(P) - e.position) <= 0;
}

Quadrature ShapeChecker::Integrate(const Point3& P, int subdivisions) const {
  Quadrature result;
  result.cells.resize(cells_.Count());
  const bool inside = IsInside(P);
  cells_.ForAll(model_, subdivisions, [&](size_t cell, int patch, const Element& element, double area) {
    const LightHit hit = model_.HitFrom(patch, element, P);
    const Vector3d way = element.position - Point3d(P);
    const double squared = glm::dot(way, way), cosine = -glm::dot(way, element.normal) / std::sqrt(squared);
    const auto evaluation = light_.EvaluateSamples(subject_.context, hit, P);
    result.camera = std::max(result.camera, CameraMismatch(subject_, hit, evaluation).value_or(0.0));
    if (!evaluation) return;
    const double radiance = Emitted(subject_, *evaluation), pdf = Value(evaluation->pdfDirect);
    if (bounds_ && !bounds_->twoSided && cosine * EmittingSide(*bounds_, element.normal) < -1e-4)
      result.leak = std::max(result.leak, radiance > 0 ? 1.0 : 0.0);
    if (IsHidden(element, P, inside) || std::abs(cosine) < kEdgeOn) return;
    const double solidAngle = std::abs(cosine) / squared * area;
    if (radiance == 0) {
      result.dark += pdf * solidAngle;
      return;
    }
    result.cells[cell] += pdf * solidAngle;
    result.integral += pdf * solidAngle;
    result.fluence += radiance * solidAngle;
  });
  return result;
}

// Largest relative differences between a sample and EvaluateSamples: for the sample's own point (`consistency`), and
// for the same point on the shape's model (`surface`).
void ShapeChecker::CheckSample(const LightSample& sample, const Point3& P, double& consistency, double& surface) const {
  const LightHit hit = HitOf(sample, P);
  const auto e = light_.EvaluateSamples(subject_.context, hit, P);
  consistency = std::max(consistency, e ? Mismatch(sample, *e, light_.Opacity(hit)) : 1.0);
  if (!e) return;

  const Point2d p = model_.Invert(sample.patchIndex, Point3d(sample.position));
  const Element element = model_.At(sample.patchIndex, p.x, p.y);
  const double scale = glm::length(Point3d(sample.position)) + extent_.radius;
  surface = std::max(surface, glm::length(element.position - Point3d(sample.position)) / scale);
  surface = std::max(surface, glm::length(element.normal - Vector3d(sample.normal)));
  const LightHit own = model_.HitFrom(sample.patchIndex, element, P);
  // Seen edge-on, the cosine is too sensitive to rounding of the position.
  if (std::abs(glm::dot(own.normal, own.direction)) < 0.02f) return;
  surface = std::max(surface, SolidAngleToAreaMismatch(sample));
  surface = std::max(surface, DensityMismatch(sample, P, p));
}

// A tenth of the relative difference between a sample's pdfDirect and that of the surface point at parameters p. Where
// the density jumps (on the edge of a texel), roundings may fall on either side: the smallest difference within
// rounding is taken.
double ShapeChecker::DensityMismatch(const LightSample& sample, const Point3& P, const Point2d& p) const {
  const auto mismatchAt = [&](const Point2d& q) {
    const LightHit own = model_.HitFrom(sample.patchIndex, model_.At(sample.patchIndex, q.x, q.y), P);
    const auto e = light_.EvaluateSamples(subject_.context, own, P);
    return e ? 0.1 * RelativeDifference(Value(sample.pdfDirect), Value(e->pdfDirect)) : 1.0;
  };
  double least = mismatchAt(p);
  constexpr double kSuspicious = 1e-3, kRounding = 1e-6;
  if (least < kSuspicious) return least;
  for (const double u : {-kRounding, kRounding}) {
    for (const double v : {-kRounding, kRounding}) {
      const Point2d near(std::clamp(p.x + u, 0.0, 1.0), std::clamp(p.y + v, 0.0, 1.0));
      least = std::min(least, mismatchAt(near));
    }
  }
  return least;
}

void ShapeChecker::CheckReceiver(const Receiver& receiver) {
  const int n = cells_.Subdivisions(9216 * options_.effort);
  const Point3& P = receiver.position;
  const Quadrature fine = Integrate(P, n), coarse = Integrate(P, n / 2);
  const double error = std::abs(fine.integral - coarse.integral);
  const size_t count = cells_.Count();
  std::vector<double> observed(count + 1, 0.0), expected(count + 1, 0.0), errors(count + 1, 0.0);
  const bool inside = IsInside(P);
  double consistency = 0, surface = 0, multipliers = 0, patches = 0;
  for (int i = 0; i < options_.samples; ++i) {
    const auto sample = light_.GenerateSamples(RandomContext(subject_, rng_), P);
    if (sample && i % 4 == 0) CheckSample(*sample, P, consistency, surface);
    if (sample && i % 16 == 0) patches = std::max(patches, PatchMismatch(subject_, HitOf(*sample, P), P));
    if (sample) multipliers = std::max(multipliers, MultiplierMismatch(subject_, *sample));
    const bool arrives = sample && Arrives(*sample, P, inside);
    ++observed[arrives ? cells_.Of(model_, sample->patchIndex, sample->position) : count];
  }
  const auto meanOf = [&](const auto& function) {
    return LatticeMean(rng_, 128, 32, [&](const float(&x)[4]) {
      LightContext context = subject_.context;
      context.u = {x[0], x[1]};
      context.uDirection = {x[2], x[3]};
      const auto sample = light_.GenerateSamples(context, P);
      return sample && Arrives(*sample, P, inside) ? function(*sample) : 0.0;
    });
  };
  const Estimate share = meanOf([](const LightSample&) { return 1.0; });
  const Estimate fluence =
      meanOf([&](const LightSample& sample) { return Emitted(subject_, sample) / Value(sample.pdfDirect); });
  const std::string where = Case(" " + receiver.name), words = InWords(enclosure_, receiver);
  // The quadrature's error is bounded, not random: it is added to the statistical error of the share.
  report_.AddError(subject_.name, "integral", where, std::abs(fine.integral - share.value),
                   2e-3 + 2 * error + 5.5 * share.error,
                   InWords(words + "the integral of pdfDirect", {fine.integral, error}, share));
  const double all = fine.integral + fine.dark, allError = error + std::abs(fine.dark - coarse.dark);
  report_.AddError(subject_.name, "integral", where + " with what is dark", std::max(all - 1, 0.0), 2e-3 + 2 * allError,
                   InWords(words + "the integral of pdfDirect, dark directions included,", {all, allError}, {1, 0}));
  for (size_t i = 0; i < count; ++i) {
    expected[i] = options_.samples * fine.cells[i];
    // The last term covers cells that the horizon touches between the quadrature's points.
    errors[i] = options_.samples * (2 * std::abs(fine.cells[i] - coarse.cells[i]) + 1e-3 * fine.cells[i] + 2e-4);
  }
  expected[count] = options_.samples * std::max(1 - fine.integral, 0.0);
  errors[count] = options_.samples * (2 * error + 1e-3);
  report_.AddProbability(subject_.name, "directions", where, ChiSquaredTest(observed, expected, errors));
  const Estimate arriving{fine.fluence, 2 * std::abs(fine.fluence - coarse.fluence)};
  report_.AddProbability(subject_.name, "irradiance", where, EqualMeans(fluence, arriving, 1e-3),
                         InWords(words + "what light sampling brings", fluence, arriving));
  report_.AddError(subject_.name, "consistency", where, consistency, 1e-4,
                   words + "largest relative difference of a sample and its evaluation");
  report_.AddError(subject_.name, "multipliers", where, multipliers, 1e-5);
  if (light_.PatchCount() > 1) report_.AddError(subject_.name, "patches", where, patches, 1e-4);
  report_.AddError(subject_.name, "surface", where, surface, 2e-3);
  report_.AddError(subject_.name, "one-sided", where, fine.leak, 0.5);
  report_.AddError(subject_.name, "camera", where, fine.camera, 1e-4);
  if (share.value > 0) CheckAreaEstimates(subject_, enclosure_, receiver, rng_, report_);
}

void ShapeChecker::CheckEmission() {
  const size_t count = cells_.Count();
  const int n = cells_.Subdivisions(4096 * options_.effort);
  std::vector<double> expected(count + 1, 0.0), errors(count + 1, 0.0), observed(count + 1, 0.0);
  double integral = 0;
  cells_.ForAll(model_, n, [&](size_t cell, int patch, const Element& element, double area) {
    const Point3 P(element.position + element.normal * (3 * extent_.radius));
    const auto evaluation = light_.EvaluateSamples(subject_.context, model_.HitFrom(patch, element, P), P);
    if (!evaluation) return;
    expected[cell] += Value(evaluation->pdfEmit) * area;
    integral += Value(evaluation->pdfEmit) * area;
  });
  const std::optional<EmissionBounds> bounds = light_.GetEmissionBounds(subject_.context);
  double edge = 0, outside = bounds ? 0 : 1, multipliers = 0;
  for (int i = 0; i < options_.photons; ++i) {
    const auto photon = light_.GenerateEmission(RandomContext(subject_, rng_));
    if (!photon) {
      ++observed[count];
      continue;
    }
    ++observed[cells_.Of(model_, photon->patchIndex, photon->position)];
    // The edge to the point where the photon may land.
    const LightHit hit = HitOf(*photon, static_cast<float>(2 * extent_.radius));
    const auto e = light_.EvaluateSamples(subject_.context, hit, photon->position + hit.distance * photon->direction);
    if (bounds && LeavesBounds(*bounds, enclosure_, *photon)) outside = 1;
    if (photon->pdfEmitDirection.IsZero()) {
      if (!IsBlack(*photon) || (e && !IsBlack(*e))) edge = 1;
      continue;
    }
    edge = std::max(edge, e ? Mismatch(*photon, *e, light_.Opacity(hit)) : 1.0);
    const auto cosine = std::abs(static_cast<double>(glm::dot(photon->normal, photon->direction)));
    edge = std::max(edge, std::abs(cosine - static_cast<double>(photon->emissionCosine)));
    multipliers = std::max(multipliers, MultiplierMismatch(subject_, *photon));
  }
  const Estimate share = LatticeMean(rng_, 128, 64, [&](const float(&x)[4]) {
    LightContext context = subject_.context;
    context.u = {x[0], x[1]};
    context.uDirection = {x[2], x[3]};
    return light_.GenerateEmission(context) ? 1.0 : 0.0;
  });
  for (size_t i = 0; i < count; ++i) {
    expected[i] *= options_.photons;
    errors[i] = 2e-3 * expected[i];
  }
  expected[count] = options_.photons * std::max(1 - integral, 0.0);
  errors[count] = 2e-3 * options_.photons;
  report_.AddError(subject_.name, "emission-integral", Case(" positions"), std::abs(integral - share.value),
                   2e-3 + 5.5 * share.error);
  report_.AddProbability(subject_.name, "emission-positions", Case(""), ChiSquaredTest(observed, expected, errors));
  report_.AddError(subject_.name, "emission-edge", Case(""), edge, 1e-4);
  report_.AddError(subject_.name, "multipliers", Case(" photons"), multipliers, 1e-5);
  report_.AddError(subject_.name, "bounds", Case(""), outside, 0.5);
  report_.AddError(subject_.name, "emission-origin", Case(""), WorstPhotonOrigin(subject_, rng_), 0.5);
}

}  // namespace

void CheckShapeLight(const SuiteSubject& subject, const SuiteOptions& options, SuiteReport& report) {
  ShapeChecker(subject, options, report).Run();
}

}  // namespace lampyr::suite
