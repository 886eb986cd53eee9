// Property segment: a light's estimates for a segment of a ray against brute force, and equiangular distances from
// points of the light in the range that it reports.
#include <cstdio>

#include "lights/services/equiangular.h"
#include "suite/checks.h"

namespace lampyr::suite {

namespace {

class SegmentChecker {
 public:
  SegmentChecker(const SuiteSubject& subject, const SuiteOptions& options, SuiteReport& report)
      : subject_(subject), light_(*subject.light), report_(report), rng_(MakeRngOfSegments(subject, options)) {
    const auto bounds = light_.GetEmissionBounds(subject.context);
    const BoundingSphere& scene = subject.context.scene;
    if (!bounds || bounds->box.IsEmpty()) return;
    middle_ = bounds->box.Center();
    const float radius = 0.5f * glm::length(bounds->box.Diagonal());
    size_ = radius > 0 ? radius : 0.3f * scene.radius;
  }

  void Run() {
    for (int i = 0; i < kSegments; ++i) CheckSegment(ChooseSegment(i));
    report_.AddError(subject_.name, "segment", subject_.caseName, missed_, 0.5, words_);
    CheckDistances();
  }

 private:
  static constexpr int kSegments = 96, kPoints = 32;

  // `through`: parameter on the ray of a point that is likely to be lit.
  struct Segment {
    Point3 origin{0.0f};
    Vector3 direction{0, 0, 1};
    float length = 0, through = 0;

    Point3 At(float t) const { return origin + t * direction; }
  };

  // Separate from the other checks, whose random numbers then do not depend on these.
  static Rng MakeRngOfSegments(const SuiteSubject& subject, const SuiteOptions& options) {
    SuiteOptions seeded = options;
    constexpr uint64_t kOfSegments = 0x5e91;
    seeded.seed = Hash(options.seed, kOfSegments);
    return MakeRngOfPlaces(subject, seeded);
  }

  Segment ChooseSegment(int index);
  bool Arrives(const Point3& P);
  static bool IsInOrder(const Segment& segment, const SegmentEstimate& estimate);
  void CheckSegment(const Segment& segment);
  void CheckPoint(const Segment& segment, const std::optional<SegmentEstimate>& estimate, float t);
  void CheckDistances();
  void Miss(const Segment& segment, const std::optional<SegmentEstimate>& estimate, float t, const char* what);

  const SuiteSubject& subject_;
  const Light& light_;
  SuiteReport& report_;
  Rng rng_;
  Point3 middle_ = subject_.context.scene.center;
  float size_ = subject_.context.scene.radius;
  double missed_ = 0;
  std::string words_;
};

// Chooses segments through points on the paths of photons, which a narrow beam lights, and through points anywhere
// around the light.
SegmentChecker::Segment SegmentChecker::ChooseSegment(int index) {
  Point3 point = middle_ + 6 * size_ * (Point3(rng_.NextFloat(), rng_.NextFloat(), rng_.NextFloat()) - 0.5f);
  const auto photon = light_.GenerateEmission(RandomContext(subject_, rng_));
  const float along =
      IsAtInfinity(light_.Kind()) ? 2 * size_ * rng_.NextFloat() : size_ * std::exp2(10 * rng_.NextFloat() - 6);
  if (photon && index % 2 == 0) point = photon->position + along * photon->direction;
  Segment segment;
  segment.direction = Vector3(RandomDirection(rng_));
  const float length = size_ * (0.2f + 6 * rng_.NextFloat());
  segment.through = length * rng_.NextFloat();
  segment.origin = point - segment.through * segment.direction;
  segment.length = index % 3 == 0 ? kInfinity : length;
  return segment;
}

bool SegmentChecker::Arrives(const Point3& P) {
  for (int i = 0; i < 2; ++i) {
    const auto sample = light_.GenerateSamples(RandomContext(subject_, rng_), P);
    if (sample && !IsBlack(*sample) && !sample->pdfDirect.IsZero()) return true;
  }
  return false;
}

void SegmentChecker::Miss(const Segment& segment, const std::optional<SegmentEstimate>& estimate, float t,
                          const char* what) {
  if (missed_ > 0) return;
  missed_ = 1;
  char text[256];
  std::snprintf(text, sizeof(text), "segment from (%.6g %.6g %.6g) along (%.6g %.6g %.6g) of length %g: at t = %.7g %s",
                static_cast<double>(segment.origin.x), static_cast<double>(segment.origin.y),
                static_cast<double>(segment.origin.z), static_cast<double>(segment.direction.x),
                static_cast<double>(segment.direction.y), static_cast<double>(segment.direction.z),
                static_cast<double>(segment.length), static_cast<double>(t), what);
  words_ = text;
  if (!estimate) return;
  std::snprintf(text, sizeof(text), "; the estimate is %.3g in [%.7g, %.7g]", static_cast<double>(estimate->radiance),
                static_cast<double>(estimate->minT), static_cast<double>(estimate->maxT));
  words_ += text;
}

void SegmentChecker::CheckPoint(const Segment& segment, const std::optional<SegmentEstimate>& estimate, float t) {
  constexpr float kFarthest = 1e4f;  // in sizes: a range may end at infinity
  if (!(t >= 0 && t <= std::min(segment.length, segment.through + kFarthest * size_))) return;
  if (!Arrives(segment.At(t))) return;
  if (!estimate) return Miss(segment, estimate, t, "light arrives, and there is no estimate");
  if (!(estimate->radiance > 0)) return Miss(segment, estimate, t, "light arrives, and the estimate is not positive");
  // A point is rounded by this much along the ray.
  const float rounding = 1e-6f * (t + MaxAbsComponent(segment.origin));
  if (t < estimate->minT - rounding || t > estimate->maxT + rounding)
    Miss(segment, estimate, t, "light arrives, outside of the range that the estimate gives");
}

bool SegmentChecker::IsInOrder(const Segment& segment, const SegmentEstimate& estimate) {
  return estimate.radiance < kInfinity && estimate.minT >= 0 && estimate.minT <= estimate.maxT &&
         estimate.maxT <= segment.length;
}

void SegmentChecker::CheckSegment(const Segment& segment) {
  const auto estimate =
      light_.GetIncidentRadianceEstimate(subject_.context, segment.origin, segment.direction, segment.length);
  const bool isInOrder = !estimate || IsInOrder(segment, *estimate);
  if (!isInOrder) Miss(segment, estimate, segment.through, "the estimate is not finite, or its range not in order");
  const float reach = std::min(segment.length, segment.through + 8 * size_);
  CheckPoint(segment, estimate, segment.through);
  for (int i = 0; i < kPoints; ++i)
    CheckPoint(segment, estimate, reach * (static_cast<float>(i) + rng_.NextFloat()) / kPoints);
  if (!estimate || !isInOrder) return;
  // Just outside of the ends of the range.
  for (int i = 0; i < kPoints; ++i) {
    const float beside = size_ * std::exp2(-16 * rng_.NextFloat());
    CheckPoint(segment, estimate, estimate->minT - beside);
    CheckPoint(segment, estimate, estimate->maxT + beside);
  }
}

// χ² of equiangular distances from points of the light. Cells of equal angle have borders of the same share; the
// expected count of each is the integral of the density over its distances.
void SegmentChecker::CheckDistances() {
  if (IsAtInfinity(light_.Kind())) return;
  constexpr int kApexes = 8, kCells = 16, kDraws = 512, kSteps = 32;
  std::vector<double> observed, expected, errors;
  for (int i = 0; i < kSegments && observed.size() < static_cast<size_t>(kApexes * kCells); ++i) {
    const Segment segment = ChooseSegment(i);
    const auto estimate =
        light_.GetIncidentRadianceEstimate(subject_.context, segment.origin, segment.direction, segment.length);
    const auto photon = light_.GenerateEmission(RandomContext(subject_, rng_));
    if (!estimate || !photon || !IsInOrder(segment, *estimate)) continue;
    const EquiangularDistance distances(segment.origin, segment.direction, photon->position, estimate->minT,
                                        estimate->maxT);
    if (distances.IsEmpty()) continue;
    const size_t first = observed.size();
    observed.resize(first + kCells, 0.0);
    float before = estimate->minT;
    for (int step = 1; step <= kCells * kSteps; ++step) {
      const float t = distances.Sample(static_cast<float>(step) / (kCells * kSteps));
      // Within a step of equal angle the density is nearly a power of t: the geometric mean of its ends.
      const double share = std::sqrt(static_cast<double>(distances.Density(before).value) *
                                     static_cast<double>(distances.Density(t).value)) *
                           (static_cast<double>(t) - static_cast<double>(before));
      if (step % kSteps == 1) expected.push_back(0);
      expected.back() += kDraws * share;
      before = t;
    }
    for (int draw = 0; draw < kDraws; ++draw) {
      const auto cell = static_cast<int>(kCells * distances.Invert(distances.Sample(rng_.NextFloat())));
      observed[first + static_cast<size_t>(std::clamp(cell, 0, kCells - 1))] += 1;
    }
  }
  errors.resize(observed.size(), 0.02 * kDraws / kCells);
  report_.AddProbability(subject_.name, "segment", subject_.caseName + " distances",
                         ChiSquaredTest(observed, expected, errors));
}

}  // namespace

void CheckSegments(const SuiteSubject& subject, const SuiteOptions& options, SuiteReport& report) {
  SegmentChecker(subject, options, report).Run();
}

}  // namespace lampyr::suite
