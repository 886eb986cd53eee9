// Densities where few samples fall: receivers from very near to very far and at the light's edge, with directions in
// strata of the cosine at the light. A density that is wrong in one stratum only does not show in the integral over
// all.
//
// In each stratum the share of the samples must equal the integral of the density. Delta lights have no strata: their
// discrete density and the law of distance are checked, near and far.
#include "suite/exact_surface.h"

namespace lampyr::suite {

namespace {

// Edges of the strata: cosines at the light. Below the first one, the effect of rounding on a cosine exceeds the
// tolerance.
constexpr double kEdges[] = {1e-3, 0.01, 0.05, 0.2, 0.5, 1.01};
constexpr int kStrata = static_cast<int>(std::size(kEdges)) - 1;

int StratumOf(double cosine) {
  const double c = std::abs(cosine);
  if (!(c >= kEdges[0])) return -1;
  int stratum = 0;
  while (c >= kEdges[stratum + 1]) ++stratum;
  return stratum;
}

struct Shares {
  Estimate of[kStrata];
  double hits[kStrata] = {};
  std::vector<LightSample> some[kStrata];  // samples drawn in the stratum
};

class StrataChecker {
 public:
  StrataChecker(const SuiteSubject& subject, const SuiteOptions& options, SuiteReport& report)
      : subject_(subject),
        light_(*subject.light),
        effort_(options.effort),
        report_(report),
        rng_(MakeRng(subject, options)),
        places_(MakeRngOfPlaces(subject, options)),
        surface_(subject) {}

  void Run() {
    for (const Receiver& receiver : Receivers()) CheckReceiver(receiver);
  }

 private:
  static constexpr double kTolerance = 2e-3;  // relative error allowed for the quadrature
  static constexpr int kLattices = 128, kFewest = 128, kMost = 2048;
  static constexpr double kEnough = 400;
  static constexpr double kFar = 100, kStrip = 0.03;  // sizes of the light; share of the samples
  static constexpr int kBudget = 20000;               // of a quadrature

  std::vector<Receiver> Receivers();
  void CheckReceiver(const Receiver& receiver);
  Shares Draw(const Point3& P);
  // ∫ pdfDirect dω over the two strata from `first` on, written to `promised`.
  void Integrate(const Point3& P, int first, const Shares& seen, Shares& promised);
  int StratumOfSample(const LightSample& sample, const Point3& P) const;
  double DensityOf(const LightHit& hit, const Point3& P) const;
  // The integral of one stratum by random points of the surface, averaged over `times` runs.
  Estimate IntegrateSurface(const Point3& P, int stratum, int times);
  std::string Words(const Receiver& receiver, int stratum, const Estimate& promised, const Shares& seen) const;

  const SuiteSubject& subject_;
  const Light& light_;
  int effort_;
  SuiteReport& report_;
  Rng rng_, places_;
  ExactSurface surface_;
};

std::vector<Receiver> StrataChecker::Receivers() {
  // A point that emits: the origin of some photon, on the side to which it leaves.
  std::optional<EmissionSample> photon;
  for (int i = 0; i < 256 && !photon; ++i) {
    photon = light_.GenerateEmission(RandomContext(subject_, places_));
    if (photon && (photon->pdfEmitDirection.IsZero() || IsBlack(*photon))) photon.reset();
  }
  if (!photon) return {};
  Vector3d n = glm::normalize(Vector3d(photon->normal));
  if (glm::dot(n, Vector3d(photon->direction)) < 0) n = -n;
  const Vector3d t = glm::normalize(glm::cross(n, std::abs(n.x) < 0.7 ? Vector3d(1, 0, 0) : Vector3d(0, 1, 0)));
  const Vector3d s = glm::cross(n, t);
  const Point3d base(photon->position), m = surface_.Around().middle;
  const double r = surface_.Around().radius;
  return {
      {"very near", Point3(base + n * (0.02 * r))},
      {"grazing", Point3(base + (t * 2.0 + s * 0.7 + n * 0.25) * r)},
      {"edge-on", Point3(base + (t * 1.6 - s * 1.2 + n * 0.01) * r)},
      {"in the middle", Point3(m + (n * 1.9 - t * 0.5 + s * 0.6) * r)},
      {"far", Point3(m + (n * 0.7 + t * 0.5 - s * 0.5) * (300 * r))},
      {"very far", Point3(m + (n * 0.8 - t * 0.4 + s * 0.45) * (3000 * r))},
  };
}

int StrataChecker::StratumOfSample(const LightSample& sample, const Point3& P) const {
  const int stratum = StratumOf(glm::dot(Vector3d(sample.normal), glm::normalize(Vector3d(sample.direction))));
  return stratum >= 0 && surface_.Sees(P, sample) ? stratum : -1;
}

// Draws more and more points until the shares of all visible strata are known precisely.
Shares StrataChecker::Draw(const Point3& P) {
  Shares shares;
  for (int points = kFewest; points <= kMost; points *= 4) {
    RunningMean means[kStrata];
    shares = Shares();
    for (int lattice = 0; lattice < kLattices; ++lattice) {
      double hits[kStrata] = {};
      LatticeMean(rng_, 1, points, [&](const float(&x)[4]) {
        LightContext context = subject_.context;
        context.u = {x[0], x[1]};
        context.uDirection = {x[2], x[3]};
        const auto sample = light_.GenerateSamples(context, P);
        const int stratum = sample ? StratumOfSample(*sample, P) : -1;
        if (stratum >= 0) {
          ++hits[stratum];
          if (shares.some[stratum].size() < kHints / 2) shares.some[stratum].push_back(*sample);
        }
        return 0.0;
      });
      for (int i = 0; i < kStrata; ++i) {
        means[i].Add(hits[i] / points);
        shares.hits[i] += hits[i];
      }
    }
    bool isSharp = true;
    for (int i = 0; i < kStrata; ++i) {
      shares.of[i] = EstimateOf(means[i]);
      isSharp = isSharp && !(shares.of[i].error > kTolerance * shares.of[i].value);
    }
    if (isSharp && points > kFewest) break;
  }
  return shares;
}

void StrataChecker::Integrate(const Point3& P, int first, const Shares& seen, Shares& promised) {
  std::vector<LightSample> hints = seen.some[first];
  if (first + 1 < kStrata) hints.insert(hints.end(), seen.some[first + 1].begin(), seen.some[first + 1].end());
  const auto density = [&](const LightHit& hit, double cosine) -> Integrands {
    const int stratum = StratumOf(cosine);
    if (stratum != first && stratum != first + 1) return {};
    const double pdf = DensityOf(hit, P);
    return stratum == first ? Integrands{pdf, 0} : Integrands{0, pdf};
  };
  const auto [one, other] = surface_.IntegrateDirections(P, hints, density, rng_, effort_ * kBudget);
  promised.of[first] = one;
  if (first + 1 < kStrata) promised.of[first + 1] = other;
  // A strip, as around round shapes, or in a corner, may be missed by a quadrature over directions: it is then
  // integrated over the surface.
  if (subject_.model) return;
  for (const int stratum : {first, first + 1}) {
    if (stratum >= kStrata || (stratum > 0 && promised.of[stratum].value > 0)) continue;
    promised.of[stratum] = IntegrateSurface(P, stratum, 1);
  }
}

Estimate StrataChecker::IntegrateSurface(const Point3& P, int stratum, int times) {
  RunningMean values;
  double variance = 0;
  for (int i = 0; i < times; ++i) {
    const Estimate one = surface_.IntegrateSurface(
        P,
        [&](const LightHit& hit, double cosine) -> Integrands {
          return {StratumOf(cosine) == stratum ? DensityOf(hit, P) : 0.0, 0};
        },
        rng_);
    values.Add(one.value);
    variance += one.error * one.error;
  }
  return {EstimateOf(values).value, std::sqrt(variance) / times};
}

// pdfDirect if light arrives, else 0.
double StrataChecker::DensityOf(const LightHit& hit, const Point3& P) const {
  const auto e = light_.EvaluateSamples(subject_.context, hit, P);
  return !e || IsBlack(*e) ? 0.0 : Value(e->pdfDirect);
}

std::string StrataChecker::Words(const Receiver& receiver, int i, const Estimate& promised, const Shares& seen) const {
  const double distance = glm::length(Point3d(receiver.position) - surface_.Around().middle) / surface_.Around().radius;
  char text[320];
  std::snprintf(text, sizeof(text),
                "receiver \"%s\" %.3g sizes from the light's middle, cosine at the light %.3g to %.3g: pdfDirect "
                "promises %.4g ± %.1g of the samples, %.4g ± %.1g came",
                receiver.name.c_str(), distance, kEdges[i], std::min(kEdges[i + 1], 1.0), promised.value,
                promised.error, seen.of[i].value, seen.of[i].error);
  return text;
}

void StrataChecker::CheckReceiver(const Receiver& receiver) {
  const Shares seen = Draw(receiver.position);
  Shares promised;
  for (int first = 0; first < kStrata; first += 2) {
    const double hits = seen.hits[first] + (first + 1 < kStrata ? seen.hits[first + 1] : 0.0);
    // If no sample falls into these strata at all, property "irradiance" detects whether one should.
    if (hits >= kEnough) Integrate(receiver.position, first, seen, promised);
  }
  const bool isFar =
      glm::length(Point3d(receiver.position) - surface_.Around().middle) > kFar * surface_.Around().radius;
  for (int i = 0; i < kStrata; ++i) {
    // A strip that few samples hit is too thin for the quadrature, too. From afar a flat part has a single cosine: if
    // an edge between strata crosses it, only a strip of it lies in one of them.
    if (seen.hits[i] < kEnough || (isFar && seen.of[i].value < kStrip)) continue;
    char where[96];
    std::snprintf(where, sizeof(where), " %s, cosine from %g", receiver.name.c_str(), kEdges[i]);
    double p = EqualMeans(promised.of[i], seen.of[i], kTolerance);
    // The strip of such cosines beside a silhouette is thin among directions, and the quadrature then underestimates
    // its own error. On the surface the strip is not thin.
    constexpr double kDoubtful = 1e-4;
    constexpr int kThinStrata = 2, kTimes = 16;
    if (i < kThinStrata && p < kDoubtful && !subject_.model) {
      promised.of[i] = IntegrateSurface(receiver.position, i, kTimes);
      p = EqualMeans(promised.of[i], seen.of[i], kTolerance);
    }
    report_.AddProbability(subject_.name, "strata", subject_.caseName + where, p,
                           Words(receiver, i, promised.of[i], seen));
  }
}

// Checks of a delta light that pdfDirect is 1, and that its radiance follows the law of distance, from 1e-4 to 1e4
// sizes of the scene.
void CheckDistances(const SuiteSubject& subject, const SuiteOptions& options, SuiteReport& report) {
  const Light& light = *subject.light;
  const bool isPoint = light.Kind() == LightKind::DeltaPosition;
  Rng rng = MakeRng(subject, options);
  double density = 0, law = 0;
  std::string densityWords, lawWords;
  for (int i = 0; i < 512; ++i) {
    const auto photon = light.GenerateEmission(RandomContext(subject, rng));
    if (!photon) continue;
    const auto radius = static_cast<double>(subject.context.scene.radius);
    const double away = std::pow(10.0, 8 * static_cast<double>(rng.NextFloat()) - 4);
    const auto sampleAt = [&](double distance) {
      return light.GenerateSamples(RandomContext(subject, rng),
                                   Point3(Point3d(photon->position) + distance * Vector3d(photon->direction)));
    };
    const auto sample = sampleAt(away * radius), other = sampleAt(radius);
    char text[160];
    if (sample && sample->pdfDirect.value != 1) {
      std::snprintf(text, sizeof(text), "receiver %.3g scene sizes away: pdfDirect is %.6g; expected 1, of a delta",
                    away, Value(sample->pdfDirect));
      densityWords = text;
      density = 1;
    }
    if (!sample || !other || IsBlack(*other)) continue;
    // Receivers are rounded, so that they are not exactly in the photon's direction.
    const double nearest = std::min(away, 1.0) * radius;
    if (4e-7 * (glm::length(Point3d(photon->position)) + nearest) > 1e-5 * nearest) continue;
    const double fall = isPoint ? Sqr(static_cast<double>(other->distance) / static_cast<double>(sample->distance)) : 1;
    const double expected = Emitted(subject, *other) * fall,
                 difference = RelativeDifference(Emitted(subject, *sample), expected);
    // On the edge of a texel, or of a beam, rounded directions may fall on either side.
    if (difference < 2e-2) continue;
    law += 1.0 / 512;
    std::snprintf(text, sizeof(text), "receiver %.3g scene sizes away gets %.6g; expected %.6g by the law of distance",
                  away, Emitted(subject, *sample), expected);
    lawWords = text;
  }
  report.AddError(subject.name, "consistency", subject.caseName + " near and far", density, 0.5, densityWords);
  report.AddError(subject.name, "irradiance", subject.caseName + " near and far", law, 5e-2, lawWords);
}

}  // namespace

void CheckStrata(const SuiteSubject& subject, const SuiteOptions& options, SuiteReport& report) {
  if (IsDelta(subject.light->Kind())) {
    CheckDistances(subject, options, report);
  } else if (subject.light->Kind() == LightKind::Area && (subject.model || subject.light->Surface())) {
    StrataChecker(subject, options, report).Run();
  }
}

}  // namespace lampyr::suite
