// Attributes of samples and photons besides radiance and densities, on which integrators rely too: position errors,
// coordinates, shinesFrom, the energy of the bounds, patches.
#include "suite/exact_surface.h"

namespace lampyr::suite {

namespace {

std::string Text(const char* format, double a, double b, double c = 0) {
  char text[256];
  std::snprintf(text, sizeof(text), format, a, b, c);
  return text;
}

// The largest error noted, with its description.
struct Worst {
  double error = 0;
  std::string words;
  template <class Words>
  void Note(double e, const Words& describe) {
    if (!(e > error) && !(std::isnan(e) && error < 1e300)) return;
    error = std::isnan(e) ? 1e300 : e;
    words = describe();
  }
};

class AttributeChecker {
 public:
  AttributeChecker(const SuiteSubject& subject, const SuiteOptions& options, SuiteReport& report)
      : subject_(subject), light_(*subject.light), report_(report), rng_(MakeRng(subject, options)) {
    if (light_.Kind() == LightKind::Area && (subject.model || light_.Surface())) surface_.emplace(subject);
  }

  void Run() {
    for (int i = 0; i < kDraws; ++i) {
      const auto photon = light_.GenerateEmission(RandomContext(subject_, rng_));
      if (!photon) continue;
      ++photons_;
      CheckShinesFrom(*photon);
      CheckPlace("a photon", photon->position, photon->normal, photon->positionError, photon->patchIndex, photon->uvw);
      if (IsAtInfinity(light_.Kind())) CheckStart(*photon);
      // A receiver on the photon's path.
      const LightContext context = RandomContext(subject_, rng_);
      const float distance = subject_.context.scene.radius * std::exp2(8 * (rng_.NextFloat() - 0.75f));
      if (IsAtInfinity(light_.Kind())) continue;
      const auto sample = light_.GenerateSamples(context, photon->position + distance * photon->direction);
      if (sample)
        CheckPlace("a sample", sample->position, sample->normal, sample->positionError, sample->patchIndex,
                   sample->uvw);
    }
    CheckEnergy();
    CheckPatches();
    Report();
  }

 private:
  static constexpr int kDraws = 512;
  // A larger bound is useless: rays would start inside other geometry.
  static constexpr double kLargestError = 1e-4;  // relative to the light's size and distance from the origin

  void CheckShinesFrom(const EmissionSample& photon);
  bool IsLit(const EmissionSample& photon, const Point3& P, double t) const;
  bool IsAsExpected(const EmissionSample& photon, double t, bool isLit) const;
  void CheckPlace(const char* what, const Point3& position, const Normal3& normal, const Vector3& error, int patch,
                  const Point3& uvw);
  void CheckStart(const EmissionSample& photon);
  void CheckEnergy();
  void CheckPatches();
  void Report();
  void Add(const char* property, const Worst& worst, double tolerance) {
    report_.AddError(subject_.name, property, subject_.caseName, worst.error, tolerance, worst.words);
  }

  const SuiteSubject& subject_;
  const Light& light_;
  SuiteReport& report_;
  Rng rng_;
  std::optional<ExactSurface> surface_;
  int photons_ = 0, points_ = 0, otherUv_ = 0, unsetUv_ = 0;
  std::string uvWords_;
  Worst shinesFrom_, tooSmall_, tooLarge_;
};

// True if the photon's origin lights a receiver at P, which is at distance `t` along the photon's path.
bool AttributeChecker::IsLit(const EmissionSample& photon, const Point3& P, double t) const {
  if (light_.Kind() == LightKind::DeltaPosition || light_.Kind() == LightKind::DeltaDirection) {
    return light_.GenerateSamples(subject_.context, P).has_value();
  }
  LightHit hit = HitOf(photon, static_cast<float>(t));
  if (light_.Kind() == LightKind::Infinite) {
    hit.distance = kInfinity;
    hit.position = P;
  }
  const auto e = light_.EvaluateSamples(subject_.context, hit, P);
  return e && !IsBlack(*e);
}

// True if the point at distance `t` along the photon's path is lit, or not, as `isLit` requires, there or within the
// rounding of positions. A photon that comes through a window at a grazing angle stays within rounding of the window's
// plane for a while.
bool AttributeChecker::IsAsExpected(const EmissionSample& photon, double t, bool isLit) const {
  const Point3d P = Point3d(photon.position) + t * Vector3d(photon.direction);
  if (IsLit(photon, Point3(P), t) == isLit) return true;
  const double rounding = 4e-7 * (glm::length(P) + glm::length(Point3d(photon.position)));
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-rounding, rounding}) {
      Point3d near = P;
      near[axis] += side;
      if (IsLit(photon, Point3(near), t) == isLit) return true;
    }
  }
  return false;
}

void AttributeChecker::CheckShinesFrom(const EmissionSample& photon) {
  const auto from = static_cast<double>(photon.shinesFrom);
  if (!(from >= 0) || (from > 0 && light_.CanBeAimed())) {
    shinesFrom_.Note(1, [&] {
      return Text("photons shine from %.3g on; expected 0: only where CanBeAimed is false something may be in the way",
                  from, 0);
    });
    return;
  }
  if (IsBlack(photon) || photon.pdfEmitDirection.IsZero() || !IsAtInfinity(light_.Kind())) return;
  const auto radius = static_cast<double>(subject_.context.scene.radius), slack = 2e-3 * radius;
  for (const double t : {from - slack, from + slack, 2 * radius * static_cast<double>(rng_.NextFloat())}) {
    // Photon paths end where they leave the scene.
    if (t < 0 || t > 2 * radius + slack || std::abs(t - from) < 0.5 * slack || IsAsExpected(photon, t, t > from))
      continue;
    shinesFrom_.Note(1, [&] {
      return Text(t > from ? "nothing is lit at %.4g on a photon's way that shines from %.4g on"
                           : "what stands at %.4g on a photon's way is lit, which shines from %.4g on only",
                  t, from);
    });
  }
}

// Checks a position on the light's surface, or that of a point light.
void AttributeChecker::CheckPlace(const char* what, const Point3& position, const Normal3& normal, const Vector3& error,
                                  int patch, const Point3& uvw) {
  if (IsAtInfinity(light_.Kind())) return;
  const Point3d p(position);
  const double largest = static_cast<double>(MaxAbsComponent(error));
  double size = surface_ ? surface_->Around().radius : 0.0;
  size += glm::length(Point3d(subject_.context.transform->toRender.translation)) + glm::length(p);
  tooLarge_.Note(size > 0 ? largest / size : (largest > 0 ? 1.0 : 0.0), [&] {
    return Text((std::string(what) + " is said to be off by up to %.3g, with a size and distance of %.3g").c_str(),
                largest, size);
  });
  if (!surface_) return;
  const auto exact = surface_->At(position, normal, patch);
  if (!exact) return;
  const double off = std::abs(glm::dot(p - exact->position, exact->normal));
  const double bound = glm::dot(Abs(exact->normal), Vector3d(error)), least = 1e-11 * size;
  tooSmall_.Note(off > least ? off / std::max(bound, 1e-300) : 0.0, [&] {
    return Text((std::string(what) + " lies %.3g off the surface, its positionError allows for %.3g").c_str(), off,
                bound);
  });
  ++points_;
  if (uvw.x == 0 && uvw.y == 0) ++unsetUv_;
  const Vector2 difference = Abs(Point2(uvw.x, uvw.y) - exact->uv);
  // u wraps around at a seam or a pole, where a full turn equals none.
  const float across = std::min(difference.x, std::abs(1 - difference.x));
  if (std::max(across, difference.y) > 2e-3f) {
    ++otherUv_;
    uvWords_ = std::string(what) + " has uvw " +
               Text("%.4g %.4g", static_cast<double>(uvw.x), static_cast<double>(uvw.y)) +
               Text(" where a ray finds %.4g %.4g", static_cast<double>(exact->uv.x), static_cast<double>(exact->uv.y));
  }
}

// Checks that a photon starts on the plane that touches the scene's sphere on the light's side.
void AttributeChecker::CheckStart(const EmissionSample& photon) {
  const Point3d center(subject_.context.scene.center), p(photon.position);
  const Vector3d direction = glm::normalize(Vector3d(photon.direction));
  const auto radius = static_cast<double>(subject_.context.scene.radius);
  const double off = std::abs(glm::dot(p - center, direction) + radius), least = 1e-11 * radius;
  const double bound = glm::dot(Abs(direction), Vector3d(photon.positionError));
  tooSmall_.Note(off > least ? off / std::max(bound, 1e-300) : 0.0, [&] {
    return Text("a photon starts %.3g off the plane before the scene, its positionError allows for %.3g", off, bound);
  });
  const double size = radius + glm::length(center) + glm::length(p);
  const auto largest = static_cast<double>(MaxAbsComponent(photon.positionError));
  tooLarge_.Note(largest / size, [&] {
    return Text("a photon is said to be off by up to %.3g, with a size and distance of %.3g", largest, size);
  });
}

// Checks the energy of the bounds, on which light selection is based.
void AttributeChecker::CheckEnergy() {
  const auto energyOf = [&](int patch) {
    LightContext context = subject_.context;
    context.patch = patch;
    const auto bounds = light_.GetEmissionBounds(context);
    return bounds ? static_cast<double>(bounds->energy) : 0.0;
  };
  if (IsAtInfinity(light_.Kind())) return;
  const auto importance = static_cast<double>(light_.Settings().importanceMultiplier);
  const double power = static_cast<double>(light_.GetPowerEstimate(subject_.context).Average()) * importance;
  const auto compare = [&](const char* what, double energy) {
    Worst worst;
    const double ratio = power > 0 && energy > 0 ? std::abs(std::log(energy / power)) : (power == energy ? 0.0 : 1e300);
    worst.Note(ratio, [&] {
      return Text((std::string(what) + " is %.4g W, the power times importanceMultiplier %.4g W").c_str(), energy,
                  power);
    });
    Add("energy", worst, std::log(2.0));
  };
  compare("the energy of the bounds", energyOf(kAnyPatch));
  if (light_.PatchCount() < 2) return;
  double sum = 0;
  for (int i = 0; i < light_.PatchCount(); ++i) sum += energyOf(i);
  compare("the energy of all patches together", sum);
}

void AttributeChecker::CheckPatches() {
  Worst worst;
  const int count = light_.PatchCount();
  if (count < 1 || (count > 1 && !subject_.model)) {
    worst.Note(1, [&] {
      return Text("the light has %.0f patches; expected 1: only a shape tells which of its patches a ray has hit",
                  count, 0);
    });
  }
  double sum = 0;
  for (int i = 0; i < count; ++i) sum += static_cast<double>(light_.PatchProbability(i).value);
  if (photons_ > 0 && std::abs(sum - 1) > 1e-4) {
    worst.Note(1, [&] { return Text("the probabilities of %.0f patches sum to %.6g; expected 1", count, sum); });
  }
  Add("patches", worst, 0.5);
}

void AttributeChecker::Report() {
  Add("shines-from", shinesFrom_, 0.5);
  if (surface_ || IsAtInfinity(light_.Kind())) Add("position-error", tooSmall_, 1);
  Add("position-error", tooLarge_, kLargestError);
  if (!surface_) return;
  // A uniform light may leave the coordinates at 0.
  Worst uv;
  if (points_ > 0 && unsetUv_ < points_) {
    uv.Note(static_cast<double>(otherUv_) / points_, [&] { return uvWords_; });
  }
  Add("uvw", uv, 2e-2);
}

}  // namespace

void CheckAttributes(const SuiteSubject& subject, const SuiteOptions& options, SuiteReport& report) {
  AttributeChecker(subject, options, report).Run();
}

}  // namespace lampyr::suite
