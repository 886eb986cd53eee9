#include "app/compare/comparison.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "app/compare/estimate.h"
#include "film/metrics.h"
#include "render/settings/integrator_choice.h"

namespace lampyr {

namespace {

constexpr double kErrors[] = {0.1, 0.05, 0.01};

struct Repeat {
  std::vector<ComparedRun> looks;  // by milestone
  Image last;
};

struct Run {
  std::string integrator;
  std::vector<Repeat> repeats;
  std::vector<Image> pictures;  // of the first repeat, by milestone
};

template <class Value>
std::vector<double> Collect(const std::vector<Repeat>& repeats, size_t milestone, Value value) {
  std::vector<double> values;
  for (const Repeat& repeat : repeats) values.push_back(value(repeat.looks[milestone]));
  return values;
}

std::string BudgetName(bool byTime, double budget) {
  char text[40];
  std::snprintf(text, sizeof text, byTime ? "%gs" : "%.0fspp", budget);
  return text;
}

std::optional<Estimate> Inverse(const std::optional<Estimate>& cost) {
  if (!cost) return std::nullopt;
  return Estimate{1 / cost->value, 1 / cost->high,
                  cost->low > 0 ? 1 / cost->low : std::numeric_limits<double>::infinity()};
}

// Mean error with its interval; absent if it does not exceed the reference's own noise.
std::optional<Estimate> Resolved(const std::vector<double>& errors, std::optional<double> noise, double noiseError) {
  auto estimate = MeanOnLogScale(errors, noiseError);
  if (estimate && noise && estimate->value < *noise) estimate.reset();
  return estimate;
}

// Gray levels by the logarithm of each pixel's relative error.
std::vector<unsigned char> ErrorPicture(const Image& image, const Reference& reference,
                                        const ComparisonResults& results) {
  const std::vector<float> map = RelativeErrorMap(image, reference.image);
  std::vector<unsigned char> rgb;
  rgb.reserve(3 * map.size());
  const double scale = 255 / std::log(results.highestError / results.lowestError);
  for (const float error : map) {
    const double level =
        scale * std::log(std::max(static_cast<double>(error), results.lowestError) / results.lowestError);
    rgb.insert(rgb.end(), 3, static_cast<unsigned char>(std::lround(std::min(level, 255.0))));
  }
  return EncodePng(image.width, image.height, rgb);
}

// Rounding errors, which are the same in all repeats and must not count as a systematic error of an integrator.
constexpr double kRoundingOfMean = 1e-5, kRoundingOfRelMse = 1e-10;

// The part of relMSE that is common to all repeats; its error by the jackknife (each repeat left out in turn). A part
// below the reference's own noise is indistinguishable from it.
SignificantEstimate SystematicPart(const std::vector<Repeat>& repeats, const Reference& reference) {
  std::vector<const Image*> images;
  for (const Repeat& repeat : repeats) images.push_back(&repeat.last);
  const CommonError common = MeasureCommonError(images, reference.image);
  const double n = static_cast<double>(repeats.size());
  std::vector<double> pseudoValues;  // their mean's error is the jackknife's
  for (const double without : common.without) pseudoValues.push_back(n * common.relMse - (n - 1) * without);
  if (pseudoValues.empty()) pseudoValues.push_back(common.relMse);  // a single pair, whose error is unknown
  SignificantEstimate estimate = MeanOf(pseudoValues, reference.noise.relMseError);
  estimate.value = common.relMse;
  if (common.relMse < std::max(reference.facts.relMse.value_or(0), kRoundingOfRelMse)) estimate.significant = false;
  return estimate;
}

ComparedSnapshot Summarise(const Run& run, size_t milestone, const ComparisonPlan& plan, const Reference& reference,
                           const RenderSettings& settings) {
  ComparedSnapshot snapshot;
  snapshot.byTime = milestone < plan.times.size();
  snapshot.budget = snapshot.byTime ? plan.times[milestone] : plan.sampleCounts[milestone - plan.times.size()];
  const auto values = [&](auto value) { return Collect(run.repeats, milestone, value); };
  snapshot.seconds = MomentsOf(values([](const ComparedRun& one) { return one.seconds; })).mean;
  snapshot.samplesPerPixel =
      MomentsOf(values([](const ComparedRun& one) { return static_cast<double>(one.samplesPerPixel); })).mean;
  const double pixels = static_cast<double>(settings.crop.Width()) * settings.crop.Height();
  snapshot.samplesPerSecond = pixels * snapshot.samplesPerPixel / std::max(snapshot.seconds, 1e-9);
  const ComparisonReference& facts = reference.facts;
  const ImageNoise& noise = reference.noise;
  snapshot.mse = Resolved(values([](const ComparedRun& one) { return one.mse; }), facts.mse, noise.mseError);
  snapshot.relMse =
      Resolved(values([](const ComparedRun& one) { return one.relMse; }), facts.relMse, noise.relMseError);
  if (snapshot.mse) {
    snapshot.efficiency = Inverse(MeanOnLogScale(values([](const ComparedRun& one) { return one.mse * one.seconds; }),
                                                 noise.mseError * snapshot.seconds));
  }
  if (snapshot.relMse) {
    snapshot.relEfficiency = Inverse(MeanOnLogScale(
        values([](const ComparedRun& one) { return one.relMse * one.seconds; }), noise.relMseError * snapshot.seconds));
  }
  for (const Repeat& repeat : run.repeats) snapshot.runs.push_back(repeat.looks[milestone]);
  snapshot.flip = MeanOnLogScale(values([](const ComparedRun& one) { return one.flip; })).value_or(Estimate{});
  return snapshot;
}

struct CurvePoint {
  double seconds, secondsPerSample;
  Estimate relMse;
};

// Time to reach an error: interpolated on the measured curve; beyond it, extrapolated from the nearest point by the law
// of independent samples, relMSE - systematic part ~ 1/time. Only the significant lower bound of the systematic part
// counts.
TimeToError FindTime(const std::vector<CurvePoint>& curve, const SignificantEstimate& systematic, double error) {
  TimeToError result;
  result.error = error;
  if (curve.empty()) {
    result.kind = TimeToError::Kind::Unresolved;
    return result;
  }
  const double target = error * error;
  for (size_t i = 1; i < curve.size(); ++i) {
    const CurvePoint &a = curve[i - 1], &b = curve[i];
    if (a.relMse.value <= target || b.relMse.value > target) continue;
    const double run = std::log(b.seconds / a.seconds), fall = std::log(a.relMse.value / b.relMse.value);
    const double slope = std::max(run > 0 ? fall / run : 1, 0.5);
    const double seconds = a.seconds * std::exp(run * std::log(a.relMse.value / target) / fall);
    result.kind = TimeToError::Kind::Measured;
    result.seconds = {seconds, seconds * std::pow(b.relMse.low / b.relMse.value, 1 / slope),
                      seconds * std::pow(b.relMse.high / b.relMse.value, 1 / slope)};
    return result;
  }
  const bool isBefore = curve.front().relMse.value <= target;
  const CurvePoint& nearest = isBefore ? curve.front() : curve.back();
  const double floor = systematic.significant ? std::max(systematic.low, 0.0) : 0.0;
  if (target <= floor) return result;
  result.kind = TimeToError::Kind::Extrapolated;
  // Lower bound of the time: one sample per pixel, or the longest measured time if the error was not reached there.
  const double least = isBefore ? nearest.secondsPerSample : nearest.seconds;
  const auto timeFrom = [&](double relMse) {
    return std::max(nearest.seconds * std::max(relMse - floor, 0.0) / (target - floor), least);
  };
  result.seconds = {timeFrom(nearest.relMse.value), timeFrom(nearest.relMse.low), timeFrom(nearest.relMse.high)};
  return result;
}

ComparedIntegrator Describe(const Run& run, const ComparedScene& scene, const ComparisonPlan& plan,
                            const Reference& reference, ComparisonResults& results) {
  ComparedIntegrator described;
  described.name = run.integrator;
  described.hints = IntegratorHints(scene.Built().scene, VariantOf(scene.Built().settings, run.integrator).integrator);
  std::vector<double> biases;
  for (const Repeat& repeat : run.repeats) biases.push_back(MeanValue(repeat.last) / reference.facts.mean - 1);
  described.bias = MeanOf(biases, reference.noise.meanError);
  if (std::abs(described.bias.value) < kRoundingOfMean) described.bias.significant = false;
  described.systematic = SystematicPart(run.repeats, reference);
  std::vector<CurvePoint> curve;
  for (size_t milestone = 0; milestone < plan.times.size() + plan.sampleCounts.size(); ++milestone) {
    ComparedSnapshot snapshot = Summarise(run, milestone, plan, reference, scene.Built().settings);
    if (snapshot.relMse) {
      curve.push_back({snapshot.seconds, snapshot.seconds / snapshot.samplesPerPixel, *snapshot.relMse});
    }
    snapshot.picture = run.integrator + "-" + BudgetName(snapshot.byTime, snapshot.budget);
    snapshot.errorPicture = "error-" + snapshot.picture;
    const Image& picture = run.pictures[milestone];
    results.pictures.emplace_back(snapshot.picture, EncodeForDisplay(picture, plan.exposure, ToneMap::Filmic));
    results.pictures.emplace_back(snapshot.errorPicture, ErrorPicture(picture, reference, results));
    described.snapshots.push_back(std::move(snapshot));
  }
  std::sort(curve.begin(), curve.end(), [](const CurvePoint& a, const CurvePoint& b) { return a.seconds < b.seconds; });
  for (const double error : kErrors) described.timeToError.push_back(FindTime(curve, described.systematic, error));
  return described;
}

// Ratios of each integrator to the first.
void AddRatios(const std::vector<Run>& runs, ComparisonResults& results) {
  for (size_t i = 1; i < runs.size(); ++i) {
    for (size_t milestone = 0; milestone < results.integrators[i].snapshots.size(); ++milestone) {
      const ComparedSnapshot &own = results.integrators[i].snapshots[milestone],
                             &first = results.integrators[0].snapshots[milestone];
      for (const bool relative : {true, false}) {
        const bool resolved = relative ? own.relMse && first.relMse : own.mse && first.mse;
        if (!resolved) continue;
        const auto cost = [&](const ComparedRun& run) { return (relative ? run.relMse : run.mse) * run.seconds; };
        const auto ratio =
            RatioOfMeans(Collect(runs[0].repeats, milestone, cost), Collect(runs[i].repeats, milestone, cost));
        if (!ratio) continue;
        results.ratios.push_back({runs[i].integrator, runs[0].integrator, own.byTime, own.budget, relative, *ratio});
      }
    }
  }
}

}  // namespace

void Compare(const ComparedScene& scene, const ComparisonPlan& plan, const Reference& reference,
             const ComparisonProgress& progress, ComparisonResults& results) {
  std::vector<Run> runs;
  for (const std::string& name : plan.integrators) runs.push_back({name, {}, {}});
  const size_t milestones = plan.times.size() + plan.sampleCounts.size();
  const double steps = static_cast<double>(plan.repeats) * static_cast<double>(runs.size());
  double lastSeconds = plan.times.empty() ? 0 : plan.times.back();  // of one render, learnt when samples are counted
  int whole = 0;
  try {
    for (; whole < plan.repeats; ++whole) {
      // Integrators render in turn, so that other load of the machine affects all of them.
      for (size_t i = 0; i < runs.size(); ++i) {
        Run& run = runs[i];
        Repeat repeat;
        repeat.looks.resize(milestones);
        double seconds = 0;
        const uint64_t seed = SeedOf(SeedUse::Compared, plan.seed + static_cast<uint64_t>(whole));
        const auto look = [&](size_t milestone, const ComparedScene::Milestone& reached, const Image& image) {
          const ImageError error = MeasureError(image, reference.image, plan.exposure);
          repeat.looks[milestone] = {seed,       reached.seconds, reached.samplesPerPixel, error.mse, error.relMse,
                                     error.flip, error.bias};
          repeat.last = image;
          if (whole == 0) {
            run.pictures.resize(milestones);
            run.pictures[milestone] = image;
          }
        };
        const double before = whole * static_cast<double>(runs.size()) + static_cast<double>(i);
        scene.Render(run.integrator, seed, plan.times, plan.sampleCounts, look, [&](double now) {
          seconds = now;
          const double ofRender = lastSeconds > 0 ? std::min(now / lastSeconds, 1.0) : 0;
          progress((before + ofRender) / steps,
                   run.integrator + ", " + std::to_string(whole + 1) + " of " + std::to_string(plan.repeats));
        });
        lastSeconds = std::max(lastSeconds, seconds);
        run.repeats.push_back(std::move(repeat));
      }
    }
  } catch (const ComparisonInterrupted&) {
    if (whole < 2) throw;
    for (Run& run : runs) run.repeats.resize(static_cast<size_t>(whole));
  }
  results.repeats = whole;
  results.pictures.emplace_back("reference", EncodeForDisplay(reference.image, plan.exposure, ToneMap::Filmic));
  for (const Run& run : runs) results.integrators.push_back(Describe(run, scene, plan, reference, results));
  AddRatios(runs, results);
}

}  // namespace lampyr
