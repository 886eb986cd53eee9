#include "integrators/photon/emission_learning.h"

#include <algorithm>
#include <numeric>

#include "base/byte_stream.h"
#include "base/error.h"
#include "geometry/rounding.h"
#include "integrators/walk/footprint.h"

namespace lampyr {

namespace {

// Useful photons to keep, and to take from one pass. Of more, a subset is kept with proportionally larger weights.
constexpr size_t kMostUseful = size_t{1} << 14;
constexpr size_t kMostOfAPass = size_t{1} << 13;
constexpr size_t kMostRemembered = 2 * kMostUseful + 2 * kMostOfAPass;
// Smallest gain for which a guide is used. It must outweigh the cost of evaluating the guide's density for every light
// path, shadow ray and hit.
constexpr double kWorthwhile = 2;
// A gain below which none is expected.
constexpr double kUseless = 1.2;
// Smallest effective number of photons for a verdict: a sum of squares may be dominated by a few.
constexpr double kFewestTested = 8;
// Samples per pixel at which recording ends: with a verdict, when most of what can be learned is known, and without
// one.
constexpr uint32_t kLearned = 64, kLastLearned = 4096;
// The same with the verdict that guiding would increase the error.
constexpr uint32_t kHopeless = 8;

// Useful photons of a light from which on its guess is no longer used; and of all lights, for a verdict to be trusted.
constexpr size_t kManyUseful = 256;
// The initial guess:
constexpr float kRare = 5;        // guide if more than a third of the photons are sent more than so many times as often
constexpr int kSeenAcross = 32;   // camera rays along each side of the grid
constexpr int kGuessed = 4096;    // emitted photons
constexpr size_t kBrightest = 8;  // lights that are guided

}  // namespace

EmissionLearning::EmissionLearning(const RenderScene& scene, int width, int height) : lighting_(*scene.lighting) {
  Guess(scene, width, height);
}

std::shared_ptr<const EmissionGuide> EmissionLearning::MakeGuide(std::span<const UsefulPhoton> photons) const {
  return std::make_shared<const EmissionGuide>(photons, lighting_.Lights(), lighting_.EmissionSelector(),
                                               lighting_.SceneSphere());
}

void EmissionLearning::Guess(const RenderScene& scene, int width, int height) {
  std::vector<Point3> seen;
  SceneProbe probe(scene);
  probe.ForEachVisible(width, height, kSeenAcross, [&](const Ray&, SeenVertex& first) {
    seen.push_back(first.vertex.point.position);
    PathState state;
    SeenVertex next;
    if (probe.Bounce(first, 0, state, next)) seen.push_back(next.vertex.point.position);
  });
  std::vector<uint32_t> counts(lighting_.Lights().size());
  const auto emit = [&](const LightingServices& lighting, const auto& visit) {
    Sampler sampler(SamplerKind::Sobol, 0);
    for (uint32_t i = 0; i < kGuessed; ++i) {
      sampler.StartPixelSample(0, 0, i);
      const float uSelect = sampler.Get1D();
      const Point2 u = sampler.Get2D(), uDirection = sampler.Get2D();
      if (const auto photon = lighting.GenerateEmission(uSelect, u, uDirection, 0)) visit(*photon);
    }
  };
  emit(lighting_, [&](const EmittedPhoton& photon) { ++counts[photon.light]; });
  // The lights that emit most photons.
  std::vector<uint32_t> brightest(counts.size());
  std::iota(brightest.begin(), brightest.end(), 0u);
  std::stable_sort(brightest.begin(), brightest.end(), [&](uint32_t a, uint32_t b) { return counts[a] > counts[b]; });
  if (brightest.size() > kBrightest) brightest.resize(kBrightest);
  const auto radius = static_cast<double>(lighting_.SceneSphere().radius);
  const double across = 1 / (static_cast<double>(kPi) * radius * radius), part = 1 / static_cast<double>(seen.size());
  for (const uint32_t light : brightest) {
    if (counts[light] == 0) continue;
    for (const Point3& place : seen) guessed_.push_back({light, place, part, part, across});
  }
  const auto guess = MakeGuide(guessed_);
  int photons = 0, rare = 0;
  const LightingServices aimed = lighting_.With(nullptr, guess.get());
  emit(aimed, [&](const EmittedPhoton& photon) {
    ++photons;
    rare += aimed.EmissionGain(photon) > kRare ? 1 : 0;
  });
  if (3 * rare > photons) {
    guide_ = guess;
  } else {
    guessed_.clear();
  }
}

// The useful photons, and the guess for lights of which few photons were useful.
std::vector<UsefulPhoton> EmissionLearning::Evidence() const {
  std::vector<UsefulPhoton> evidence = useful_;
  if (guessed_.empty()) return evidence;
  struct Known {
    uint64_t count = 0;
    double contribution = 0, secondMoment = 0;
  };
  std::vector<Known> known(lighting_.Lights().size());
  Known all;
  for (const UsefulPhoton& photon : useful_) {
    for (Known* one : {&known[photon.light], &all}) {
      ++one->count;
      one->contribution += photon.contribution;
      one->secondMoment += photon.secondMoment;
    }
  }
  for (const UsefulPhoton& photon : guessed_) {
    const Known& of = known[photon.light];
    if (of.count >= kManyUseful) continue;
    // A light without useful photons is taken to be like all lights.
    const Known& like = of.count > 0 || all.count == 0 ? of : all;
    evidence.push_back(photon);
    if (all.count == 0) continue;
    evidence.back().contribution *= like.contribution;
    evidence.back().secondMoment *= like.secondMoment;
  }
  return evidence;
}

bool EmissionLearning::SeemsUseless() const {
  return hasVerdict_ && gain_ < kUseless && !guide_ && useful_.size() >= kManyUseful;
}

void EmissionLearning::Learn(const PhotonUse& use) {
  const std::vector<PathOrigin>& origins = use.Origins();
  std::vector<uint32_t> ofUse;
  for (size_t i = 0; i < origins.size(); ++i) {
    if (use.Sum(i) > 0 && origins[i].flux > 0) ofUse.push_back(static_cast<uint32_t>(i));
  }
  // At most kMostOfAPass photons: every step-th, with `step` times its weight.
  const size_t step = 1 + ofUse.size() / kMostOfAPass;
  const auto share = static_cast<double>(step);
  for (size_t k = 0; k < ofUse.size(); k += step) {
    const PathOrigin& origin = origins[ofUse[k]];
    const double brought = use.Sum(ofUse[k]) * static_cast<double>(origin.flux);
    // The density of the photon was `gain` times the unguided one.
    const double squared = share * brought * brought * static_cast<double>(origin.gain);
    const Vector3 way = origin.firstHit - origin.start;
    const bool isAtInfinity = lighting_.IsAtInfinity(origin.light);
    const double across = static_cast<double>(isAtInfinity ? 1.0f : LengthSquared(way));
    const double own = across > 0 ? static_cast<double>(origin.pdfUnguided) / across : 0.0;
    useful_.push_back({origin.light, origin.firstHit, share * brought, squared, own});
    if (!tried_) continue;
    const Vector3 direction = SafeNormalize(way, Vector3(0.0f));
    const Point3& on = isAtInfinity ? origin.firstHit : origin.start;
    unguided_.Add(squared);
    aimed_.Add(squared / tried_->Gain(origin.light, on, direction, static_cast<double>(origin.pdfUnguided)));
  }
  Thin();
}

// Resamples the useful photons systematically to kMostUseful, in proportion to their contribution.
void EmissionLearning::Thin() {
  if (useful_.size() <= 2 * kMostUseful) return;
  double total = 0;
  for (const UsefulPhoton& photon : useful_) total += photon.contribution;
  const double step = total / static_cast<double>(kMostUseful);
  std::vector<UsefulPhoton> kept;
  double at = 0, next = 0.5 * step;
  for (const UsefulPhoton& photon : useful_) {
    at += photon.contribution;
    int times = 0;
    for (; next < at; next += step) ++times;
    if (times == 0) continue;
    kept.push_back(photon);
    kept.back().contribution = times * step;
    kept.back().secondMoment *= times * step / photon.contribution;
  }
  useful_ = std::move(kept);
}

bool EmissionLearning::Decide(uint32_t samples) {
  const bool wasInUse = guide_ != nullptr;
  const double gain = aimed_.sum > 0 ? unguided_.sum / aimed_.sum : 1;
  // The sum with the candidate is more likely to be too large than too small, because photons that the candidate has
  // overlooked enter it with a large factor. So it needs to be certain only if the verdict is against the candidate.
  const double sureness = gain > kWorthwhile ? unguided_.Count() : std::min(unguided_.Count(), aimed_.Count());
  if (tried_ && tried_->LightCount() > 0 && sureness >= kFewestTested) {
    gain_ = gain;
    unguided_ = aimed_ = Sum();
    hasVerdict_ = true;
  }
  evidence_ = Evidence();
  tried_ = MakeGuide(evidence_);
  // The guide put to use is made of more photons than the one that was tested.
  const bool isWorthwhile = hasVerdict_ ? gain_ > kWorthwhile : wasInUse;
  guide_ = isWorthwhile ? tried_ : nullptr;
  const uint32_t last = !hasVerdict_ ? kLastLearned : gain_ < 1 ? kHopeless : kLearned;
  if (samples >= last) isRecording_ = false;
  return wasInUse || guide_;
}

// A guide is saved as the photons it was made of. The guide in use is the candidate, the initial guess, or none.
void EmissionLearning::Save(ByteWriter& bytes) const {
  bytes.Value<uint8_t>(isRecording_ ? 1 : 0);
  bytes.Value<uint8_t>(tried_ ? 1 : 0);
  bytes.Value<uint8_t>(guide_ ? 1 : 0);
  bytes.Value<uint8_t>(hasVerdict_ ? 1 : 0);
  bytes.Value(gain_);
  bytes.Value(unguided_);
  bytes.Value(aimed_);
  bytes.List(std::span(useful_));
  bytes.List(std::span(evidence_));
}

namespace {

// Limited so that the product of two values is finite.
bool IsSensible(double value) {
  return value >= 0 && value < 1e150;
}

}  // namespace

void EmissionLearning::Load(ByteReader& bytes) {
  isRecording_ = bytes.Flag();
  const bool hasTried = bytes.Flag(), hasGuide = bytes.Flag();
  hasVerdict_ = bytes.Flag();
  gain_ = bytes.Value<double>();
  unguided_ = bytes.Value<Sum>();
  aimed_ = bytes.Value<Sum>();
  useful_ = bytes.List<UsefulPhoton>(kMostRemembered);
  evidence_ = bytes.List<UsefulPhoton>(kMostRemembered + guessed_.size());
  for (const std::vector<UsefulPhoton>* photons : {&useful_, &evidence_}) {
    for (const UsefulPhoton& photon : *photons) {
      const bool isOne = photon.light < lighting_.Lights().size() && IsFinite(photon.firstHit) &&
                         IsSensible(photon.contribution) && IsSensible(photon.secondMoment) &&
                         IsSensible(photon.unguidedDensity);
      if (!isOne) throw Error("it holds a photon that cannot be");
    }
  }
  if (!hasTried) return;
  tried_ = MakeGuide(evidence_);
  guide_ = hasGuide ? tried_ : nullptr;
}

}  // namespace lampyr
