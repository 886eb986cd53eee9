#include "integrators/guide/path_learning.h"

#include <algorithm>
#include <cmath>

#include "base/byte_stream.h"
#include "base/error.h"
#include "geometry/rounding.h"
#include "integrators/guide/gain_estimate.h"

namespace lampyr {

namespace {

// Most paths recorded between two milestones, and events kept of all.
constexpr double kMostPaths = 1 << 17;
constexpr size_t kMostKept = size_t{1} << 17;
constexpr size_t kMostEvents = size_t{1} << 25;  // of a file
// Paths recorded in the first sample per pixel, for a candidate that is worth a test; and for each later one, or this
// share of all paths, if that is more. A recorded path that found light at each vertex costs about half as much again
// as tracing it, so that learning is a few percent of a short render, and less of a long one. A guide in use gets more:
// better ones pay for more records.
constexpr double kFirstPaths = 6144, kPathsPerSample = 1024, kShareOfPaths = 1.0 / 48, kMoreInUse = 6;
// Largest share of the paths after the first sample, for pictures that are not tiny.
constexpr double kLargestShare = 0.25;
// Events kept of a path where those numbers apply. Fitting them is most of what a path costs; where paths keep fewer,
// more paths are recorded: so many times at most.
constexpr double kEventsOfPath = 2, kMostMore = 6;
// Least gain in variance of camera paths for which a guide is used. Guided samples take 1.2 to 1.5 times as long, and
// the test sees independent samples, where a guide gains more than with Sobol points: in a Cornell box 1.4 as tested
// is 1.1 to 1.26. Where light paths are guided, too, the gain is larger than what is tested: weights leave to camera
// paths what those do well, and would leave them more with a guide. Measured in bdpt, the gain as tested and the true
// one: 1.3 and 2.4 in door, 1.05 and 1.1 in lamp, ring and still-life.
constexpr double kWorthwhile = 1.6, kWorthwhileForBoth = 1.2;
// Standard deviations by which the gain is above what is worthwhile before a guide is used, and by which it is above 1,
// so that one path of all cannot decide; and below what is promising before recording ends.
constexpr double kSure = 1, kSurelyGains = 2, kSurelyNot = 2;
// Smallest effective number of paths for a verdict.
constexpr double kFewestTested = 16;
// Samples per pixel at which recording ends when guiding would not help.
constexpr uint32_t kHopeless = 8;
// Fraction of the worthwhile gain from which on a guide that is not used yet is given more samples.
constexpr double kPromising = 0.3;
// A guide is fitted anew when at least this share of the events is new.
constexpr double kEnoughNew = 0.25;

}  // namespace

PathLearning::PathLearning(int width, int height, size_t recorded, bool forLight, bool always)
    : width_(width),
      height_(height),
      recorded_(recorded),
      forLight_(forLight),
      always_(always),
      blocks_(width, height),
      roulette_(blocks_.Layout()) {}

bool PathLearning::IsPromising(double gain) const {
  return gain - 1 > kPromising * (Worthwhile() - 1);
}

double PathLearning::Worthwhile() const {
  return forLight_ ? kWorthwhileForBoth : kWorthwhile;
}

double PathLearning::Fraction() const {
  const uint32_t passes = std::max(samples_, 1u);  // until the next milestone
  const auto pixels = static_cast<double>(recorded_);
  const bool isUsed = always_ || guide_;
  double perSample = kShareOfPaths * pixels;
  if (samples_ == 0) {
    perSample = std::max(perSample, kFirstPaths);
  } else if (isUsed || !seemsHopeless_) {
    const double more = kEventsOfPath * blocks_.AllSamples() / static_cast<double>(kept_.size() + 1);
    perSample = std::max(perSample, kPathsPerSample * std::clamp(more, 1.0, kMostMore));
  }
  if (isUsed) perSample *= kMoreInUse;
  if (samples_ > 0) perSample = std::min(perSample, std::max(kLargestShare * pixels, kPathsPerSample));
  return std::min(passes * perSample, kMostPaths) / (passes * pixels);
}

void PathLearning::Learn(std::span<const PathRecords> records) {
  for (const PathRecords& list : records) latest_.Append(list);
}

// Tests the candidate on the latest paths. A path found X = Σ c_k, c_k after k events. Sampled with other densities,
// r_j times those that it had up to its j-th event, it would have found c_k / r_k, and
//   E[X²] = E[Σ_k c_k² / r_k + 2 Σ_(j<k) c_j c_k / r_j].
GainEstimate PathLearning::Test(const std::vector<double>& scales) const {
  GainEstimate gain;
  double ofMeans = 0;
  for (size_t i = 0; i < latest_.Paths().size(); ++i) {
    const RecordedPath& path = latest_.Paths()[i];
    if (path.found == 0) {
      gain.Add(0, 0);
      continue;
    }
    const double scale = scales[blocks_.Of(path.pixel)];
    double before = 0;
    double ratioUnguided = 1, ratioAimed = 1;
    double earlierUnguided = 0, earlierAimed = 0;  // 2 Σ c_j / r_j
    double sumUnguided = 0, sumAimed = 0;
    const auto add = [&](double until) {
      const double c = scale * (until - before);
      before = until;
      sumUnguided += c * (c / ratioUnguided + earlierUnguided);
      sumAimed += c * (c / ratioAimed + earlierAimed);
      earlierUnguided += 2 * c / ratioUnguided;
      earlierAimed += 2 * c / ratioAimed;
    };
    for (const RecordedEvent& event : latest_.EventsOf(i)) {
      add(static_cast<double>(event.foundBefore));
      const auto guidance = static_cast<double>(event.guidance);
      ratioUnguided /= guidance;
      const GuideRegion* region = tried_->Find(event.position, event.side);
      double candidate = 1;
      if (region && region->radiance.share > 0) {
        const auto share = static_cast<double>(region->radiance.share);
        candidate = 1 - share;
        if (event.unguided > 0)
          candidate += share *
                       static_cast<double>(region->radiance.mixture.Density(event.position, event.direction).value) /
                       static_cast<double>(event.unguided);
      }
      ratioAimed *= candidate / guidance;
    }
    add(static_cast<double>(path.found));
    gain.Add(sumUnguided, sumAimed);
  }
  std::vector<double> counts(blocks_.Count());
  for (const RecordedPath& path : latest_.Paths()) ++counts[blocks_.Of(path.pixel)];
  for (size_t i = 0; i < blocks_.Count(); ++i) ofMeans += counts[i] * scales[i] * scales[i] * blocks_.SquaredMean(i);
  gain.SetSquaredMeans(ofMeans);
  return gain;
}

namespace {

// Resamples events systematically to kMostKept, in proportion to their weight.
void Thin(std::vector<PlacedEvent>& kept) {
  if (kept.size() <= kMostKept) return;
  double total = 0;
  for (const PlacedEvent& event : kept) total += static_cast<double>(event.weight);
  const double step = total / static_cast<double>(kMostKept);
  std::vector<PlacedEvent> thinned;
  double at = 0, next = 0.5 * step;
  for (const PlacedEvent& event : kept) {
    at += static_cast<double>(event.weight);
    int times = 0;
    for (; next < at; next += step) ++times;
    if (times == 0) continue;
    thinned.push_back(event);
    thinned.back().weight = static_cast<float>(times * step);
  }
  kept = std::move(thinned);
}

}  // namespace

// Adds the latest events to those kept. True if they are enough to fit a guide anew.
bool PathLearning::Keep(const std::vector<double>& scales) {
  const size_t before = kept_.size();
  for (size_t i = 0; i < latest_.Paths().size(); ++i) {
    const RecordedPath& path = latest_.Paths()[i];
    const auto scale = static_cast<float>(scales[blocks_.Of(path.pixel)]);
    for (const RecordedEvent& event : latest_.EventsOf(i)) {
      const float weight = scale * (path.found - event.foundBefore);
      if (weight > 0) {
        kept_.push_back(event);
        kept_.back().weight = weight;
      }
      const float weightOfLight = scale * (path.found - event.foundOnArrival);
      if (forLight_ && weightOfLight > 0 && event.previousDistance > 0) {
        keptOfLight_.push_back(event);
        PlacedEvent& reversed = keptOfLight_.back();
        reversed.direction = event.toPrevious;
        reversed.distance = event.previousDistance;
        reversed.unguided = event.unguidedReverse;
        reversed.weight = weightOfLight;
      }
    }
  }
  const size_t all = kept_.size();
  Thin(kept_);
  Thin(keptOfLight_);
  return static_cast<double>(all - before) > kEnoughNew * static_cast<double>(all);
}

bool PathLearning::Decide(uint32_t samples, int threads, bool mayUse) {
  const std::shared_ptr<const PathGuide> before = guide_;
  samples_ = samples;
  latest_ = latest_.Sorted();
  for (const RecordedPath& path : latest_.Paths()) blocks_.Add(path.pixel, static_cast<double>(path.found));
  const std::vector<double> scales = blocks_.Scales();
  bool isWorthwhile = guide_ != nullptr;
  // MIS weights of guided light paths differ from those without a guide, whose second moment is then unknown.
  if (tried_ && mayUse && !(forLight_ && guide_)) {
    const GainEstimate gain = Test(scales);
    if (gain.EffectiveCount() >= kFewestTested) {
      gain_ = gain.Ratio();
      isWorthwhile = guide_ ? gain_ > Worthwhile() : gain.Bound(-kSure) > Worthwhile() && gain.Bound(-kSurelyGains) > 1;
      seemsHopeless_ = !isWorthwhile && !IsPromising(gain.Bound(kSurelyNot));
    }
  }
  roulette_.Learn(latest_, scales);
  const bool hasNews = Keep(scales);
  latest_.Clear();
  if (!always_ && !isWorthwhile && samples >= (seemsHopeless_ ? kHopeless : kLastMilestone)) {
    tried_ = nullptr;
  } else if (hasNews || !tried_) {
    // The guide put to use is made of more events than the one that was tested.
    tried_ = std::make_shared<const PathGuide>(kept_, keptOfLight_, threads);
  }
  guide_ = always_ || isWorthwhile ? tried_ : nullptr;
  if (!tried_ || samples >= kLastMilestone) {
    isRecording_ = false;
    kept_ = keptOfLight_ = {};
    roulette_.End();
  }
  return guide_ != before;
}

void PathLearning::Save(ByteWriter& bytes) const {
  bytes.Value<uint8_t>(isRecording_ ? 1 : 0);
  bytes.Value<uint8_t>(seemsHopeless_ ? 1 : 0);
  bytes.Value<uint8_t>(tried_ ? 1 : 0);
  bytes.Value<uint8_t>(guide_ ? 1 : 0);
  bytes.Value(samples_);
  bytes.Value(gain_);
  if (tried_) tried_->Save(bytes);
  roulette_.Save(bytes);
  bytes.List(blocks_.All());
  bytes.List(latest_.Paths());
  bytes.List(latest_.Events());
  bytes.List(std::span(kept_));
  bytes.List(std::span(keptOfLight_));
}

namespace {

bool IsSound(const PlacedEvent& event) {
  return IsFinite(event.position) && IsFinite(event.direction) && event.distance >= 0 &&
         std::isfinite(event.unguided) && event.unguided >= 0 && std::isfinite(event.weight) && event.weight >= 0 &&
         event.side < kGuideSides;
}

}  // namespace

void PathLearning::Load(ByteReader& bytes) {
  isRecording_ = bytes.Flag();
  seemsHopeless_ = bytes.Flag();
  const bool hasTried = bytes.Flag(), hasGuide = bytes.Flag();
  samples_ = bytes.Value<uint32_t>();
  gain_ = bytes.Value<double>();
  if (hasTried) {
    auto tried = std::make_shared<PathGuide>();
    tried->Load(bytes);
    tried_ = tried;
    if (hasGuide) guide_ = tried_;
  }
  roulette_.Load(bytes);
  std::vector<PixelBlocks::Block> blocks = bytes.List<PixelBlocks::Block>(blocks_.Count());
  std::vector<RecordedPath> paths = bytes.List<RecordedPath>(kMostEvents);
  std::vector<RecordedEvent> events = bytes.List<RecordedEvent>(kMostEvents);
  kept_ = bytes.List<PlacedEvent>(kMostKept);
  keptOfLight_ = bytes.List<PlacedEvent>(kMostKept);
  bool isSound = blocks_.Set(std::move(blocks)) && std::isfinite(gain_) && gain_ >= 0 && (hasTried || !hasGuide);
  for (const std::vector<PlacedEvent>* kept : {&kept_, &keptOfLight_})
    for (const PlacedEvent& event : *kept) isSound = isSound && IsSound(event);
  for (const RecordedEvent& event : events)
    isSound = isSound && IsSound(event) && event.guidance > 0 && std::isfinite(event.guidance) &&
              std::isfinite(event.foundBefore) && std::isfinite(event.foundOnArrival) && IsFinite(event.toPrevious) &&
              event.previousDistance >= 0 && event.unguidedReverse >= 0 && std::isfinite(event.unguidedReverse) &&
              std::isfinite(event.throughput) && event.survival > 0 && event.survival <= 1;
  const uint64_t pixels = static_cast<uint64_t>(width_) * static_cast<uint64_t>(height_);
  for (size_t i = 0; i < paths.size(); ++i) {
    const uint32_t before = i > 0 ? paths[i - 1].firstEvent : 0;
    isSound = isSound && paths[i].pixel < pixels && paths[i].firstEvent >= before &&
              paths[i].firstEvent <= events.size() && std::isfinite(paths[i].found);
  }
  if (!isSound) throw Error("it holds a path that cannot be");
  latest_.Set(paths, events);
}

}  // namespace lampyr
