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
  std::vector<Image> pictures;     // likewise; R, G, B
  size_t last = 0;                 // milestone that was reached last: the largest budget
};

struct Run {
  std::string integrator;
  std::vector<Repeat> repeats;

  std::vector<const Image*> Pictures(size_t milestone) const {
    std::vector<const Image*> pictures;
    for (const Repeat& repeat : repeats) pictures.push_back(&repeat.pictures[milestone]);
    return pictures;
  }
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

// Mean error with its interval; absent if it does not exceed `limit`, the reference's own noise and blur.
std::optional<Estimate> Resolved(const std::vector<double>& errors, std::optional<double> limit, double noiseError) {
  auto estimate = MeanOnLogScale(errors, noiseError);
  if (estimate && limit && estimate->value < *limit) estimate.reset();
  return estimate;
}

// Factors of an error that bound its uncertainty by the blur of the reference.
//
// An integrator's own bias B and the blur b of the reference make up the part of the error that all repeats have in
// common, s² = |B - b|², so that B is within s - b … s + b.
struct Doubt {
  double down = 1, up = 1;

  Doubt() = default;
  Doubt(double error, double common, double blur) {
    if (!(error > 0) || blur == 0) return;
    const double s = std::sqrt(std::max(common, 0.0)), b = std::sqrt(blur);
    down = std::max(0.0, error - s * s + Square(std::max(0.0, s - b))) / error;
    up = (error - s * s + Square(s + b)) / error;
  }
  Estimate Of(const Estimate& estimate) const { return {estimate.value, estimate.low * down, estimate.high * up}; }

 private:
  static double Square(double x) { return x * x; }
};

// The measured errors of an integrator at one budget, in their parts.
struct Parts {
  CommonError error;
  SignificantEstimate common;  // relMSE; noise of the reference subtracted, its blur in the interval
  Doubt ofMse, ofRelMse;
};

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

// Rounding errors: they are the same in all repeats and must not count as a systematic error of an integrator.
constexpr double kRoundingOfMean = 1e-5, kRoundingOfRelMse = 1e-10;

// The part of relMSE that is common to all repeats; its error by the jackknife (each repeat left out in turn). A part
// below the reference's own noise or blur is indistinguishable from it.
SignificantEstimate CommonPart(const CommonError& error, const Reference& reference) {
  SignificantEstimate estimate = JackknifeOf(error.relMse, error.without, reference.noise.relMseError);
  if (error.relMse < std::max(reference.facts.relMse.value_or(0), kRoundingOfRelMse)) estimate.significant = false;
  const double blur = std::sqrt(reference.blur.relMseLimit);
  if (blur == 0) return estimate;
  if (estimate.low > 0) estimate.low = std::pow(std::max(0.0, std::sqrt(estimate.low) - blur), 2);
  estimate.high = std::pow(std::sqrt(std::max(0.0, estimate.high)) + blur, 2);
  estimate.significant &= estimate.low > 0;
  return estimate;
}

Parts PartsOf(const Run& run, size_t milestone, const Reference& reference) {
  Parts parts;
  parts.error = MeasureCommonError(run.Pictures(milestone), reference.image);
  parts.common = CommonPart(parts.error, reference);
  const auto mean = [&](auto value) { return MomentsOf(Collect(run.repeats, milestone, value)).mean; };
  parts.ofMse = Doubt(mean([](const ComparedRun& one) { return one.mse; }), parts.error.mse, reference.blur.mseLimit);
  parts.ofRelMse =
      Doubt(mean([](const ComparedRun& one) { return one.relMse; }), parts.error.relMse, reference.blur.relMseLimit);
  return parts;
}

// Roots of squares of relative errors.
template <class OfSquares>
OfSquares Root(const OfSquares& squares) {
  OfSquares root = squares;
  for (double* value : {&root.value, &root.low, &root.high}) *value = std::sqrt(std::max(*value, 0.0));
  return root;
}

std::optional<Estimate> NoiseOfParts(const CommonError& error) {
  if (!(error.varying > 0)) return std::nullopt;
  if (error.varyingWithout.empty())
    return Estimate{std::sqrt(error.varying), 0, std::numeric_limits<double>::infinity()};
  return Root(static_cast<const Estimate&>(JackknifeOf(error.varying, error.varyingWithout)));
}

// Root mean square of the errors that the renders state; nullopt: they state none.
std::optional<ErrorParts> MeanStatement(const std::vector<ComparedRun>& runs) {
  ErrorParts squares;
  for (const ComparedRun& run : runs) {
    if (!run.stated) return std::nullopt;
    squares.noise += run.stated->noise * run.stated->noise / static_cast<double>(runs.size());
    squares.bias += run.stated->bias * run.stated->bias / static_cast<double>(runs.size());
  }
  return ErrorParts{std::sqrt(squares.noise), std::sqrt(squares.bias)};
}

ComparedSnapshot Summarise(const Run& run, size_t milestone, const Parts& parts, const ComparisonPlan& plan,
                           const Reference& reference, const RenderSettings& settings) {
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
  const auto limit = [](std::optional<double> ofNoise, double ofBlur) {
    return ofNoise || ofBlur > 0 ? std::optional(ofNoise.value_or(0) + ofBlur) : std::nullopt;
  };
  snapshot.mse = Resolved(values([](const ComparedRun& one) { return one.mse; }),
                          limit(facts.mse, reference.blur.mseLimit), noise.mseError);
  snapshot.relMse = Resolved(values([](const ComparedRun& one) { return one.relMse; }),
                             limit(facts.relMse, reference.blur.relMseLimit), noise.relMseError);
  // Error times seconds, whose inverse is the efficiency.
  const auto cost = [&](auto error, double noiseError, const Doubt& doubt) {
    auto estimate = MeanOnLogScale(values([&](const ComparedRun& one) { return error(one) * one.seconds; }),
                                   noiseError * snapshot.seconds);
    if (estimate) estimate = doubt.Of(*estimate);
    return estimate;
  };
  if (snapshot.mse) {
    snapshot.mse = parts.ofMse.Of(*snapshot.mse);
    snapshot.efficiency = Inverse(cost([](const ComparedRun& one) { return one.mse; }, noise.mseError, parts.ofMse));
  }
  if (snapshot.relMse) {
    snapshot.relMse = parts.ofRelMse.Of(*snapshot.relMse);
    snapshot.relEfficiency =
        Inverse(cost([](const ComparedRun& one) { return one.relMse; }, noise.relMseError, parts.ofRelMse));
  }
  snapshot.bias = Root(parts.common);
  snapshot.noise = NoiseOfParts(parts.error);
  for (const Repeat& repeat : run.repeats) snapshot.runs.push_back(repeat.looks[milestone]);
  snapshot.flip = MeanOnLogScale(values([](const ComparedRun& one) { return one.flip; })).value_or(Estimate{});
  snapshot.stated = MeanStatement(snapshot.runs);
  return snapshot;
}

struct CurvePoint {
  double seconds, secondsPerSample;
  Estimate relMse;
};

// Time to reach an error: interpolated on the measured curve; beyond it, extrapolated from the nearest point by the law
// of independent samples, relMSE - floor ~ 1/time. `floor`: the part of relMSE that no number of samples reduces. Blur
// is not part of it: it falls, too, but more slowly than 1/time, so that extrapolated times of integrators that blur
// are rough.
TimeToError FindTime(const std::vector<CurvePoint>& curve, double floor, double error) {
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

SignificantEstimate MeanBias(const Run& run, size_t milestone, const Reference& reference) {
  std::vector<double> biases;
  for (const Image* picture : run.Pictures(milestone)) biases.push_back(MeanValue(*picture) / reference.facts.mean - 1);
  SignificantEstimate bias = MeanOf(biases, reference.noise.meanError);
  if (std::abs(bias.value) < std::max(kRoundingOfMean, reference.blur.meanLimit)) bias.significant = false;
  bias.low -= reference.blur.meanLimit;
  bias.high += reference.blur.meanLimit;
  bias.significant &= bias.low > 0 || bias.high < 0;
  return bias;
}

ComparedIntegrator Describe(const Run& run, const std::vector<Parts>& parts, const ComparedScene& scene,
                            const ComparisonPlan& plan, const Reference& reference, ComparisonResults& results) {
  const RenderSettings settings = VariantOf(scene.Built().settings, run.integrator);
  const size_t last = run.repeats.front().last;
  ComparedIntegrator described;
  described.name = run.integrator;
  described.blurs = GathersPhotons(settings) || IsDenoised(run.integrator);
  described.hints = IntegratorHints(scene.Built().scene, settings.integrator);
  described.meanBias = MeanBias(run, last, reference);
  described.systematic = parts[last].common;
  const auto subtracted = NoiseOf(reference.image, reference.parts);  // as measured errors have it subtracted
  described.spectrum =
      ErrorSpectrum(run.Pictures(last), reference.image, subtracted ? subtracted->relMse : 0, scene.Threads());
  std::vector<CurvePoint> curve;
  for (size_t milestone = 0; milestone < parts.size(); ++milestone) {
    ComparedSnapshot snapshot = Summarise(run, milestone, parts[milestone], plan, reference, scene.Built().settings);
    if (snapshot.relMse) {
      curve.push_back({snapshot.seconds, snapshot.seconds / snapshot.samplesPerPixel, *snapshot.relMse});
    }
    snapshot.picture = run.integrator + "-" + BudgetName(snapshot.byTime, snapshot.budget);
    snapshot.errorPicture = "error-" + snapshot.picture;
    const Image& picture = run.repeats.front().pictures[milestone];
    results.pictures.emplace_back(snapshot.picture, EncodeForDisplay(picture, plan.exposure, ToneMap::Filmic));
    results.pictures.emplace_back(snapshot.errorPicture, ErrorPicture(picture, reference, results));
    described.snapshots.push_back(std::move(snapshot));
  }
  std::sort(curve.begin(), curve.end(), [](const CurvePoint& a, const CurvePoint& b) { return a.seconds < b.seconds; });
  // Only the significant lower bound of the systematic part counts, and not that of an integrator that blurs.
  const SignificantEstimate& systematic = described.systematic;
  const double floor = systematic.significant && !described.blurs ? std::max(systematic.low, 0.0) : 0.0;
  for (const double error : kErrors) described.timeToError.push_back(FindTime(curve, floor, error));
  return described;
}

// Ratios of the efficiencies of two integrators, at every budget.
void AddRatios(const std::vector<Run>& runs, const std::vector<std::vector<Parts>>& parts, size_t i, size_t against,
               ComparisonResults& results) {
  for (size_t milestone = 0; milestone < results.integrators[i].snapshots.size(); ++milestone) {
    const ComparedSnapshot &own = results.integrators[i].snapshots[milestone],
                           &first = results.integrators[against].snapshots[milestone];
    for (const bool relative : {true, false}) {
      const bool resolved = relative ? own.relMse && first.relMse : own.mse && first.mse;
      if (!resolved) continue;
      const auto cost = [&](const ComparedRun& run) { return (relative ? run.relMse : run.mse) * run.seconds; };
      auto ratio =
          RatioOfMeans(Collect(runs[against].repeats, milestone, cost), Collect(runs[i].repeats, milestone, cost));
      if (!ratio) continue;
      const auto doubt = [&](size_t run) {
        return relative ? parts[run][milestone].ofRelMse : parts[run][milestone].ofMse;
      };
      ratio->low *= doubt(against).down / doubt(i).up;
      ratio->high =
          doubt(i).down > 0 ? ratio->high * doubt(against).up / doubt(i).down : std::numeric_limits<double>::infinity();
      results.ratios.push_back(
          {runs[i].integrator, runs[against].integrator, own.byTime, own.budget, relative, *ratio});
    }
  }
}

}  // namespace

void Compare(const ComparedScene& scene, const ComparisonPlan& plan, const Reference& reference,
             const ComparisonProgress& progress, ComparisonResults& results) {
  std::vector<Run> runs;
  for (const std::string& name : plan.integrators) runs.push_back({name, {}});
  const size_t milestones = plan.times.size() + plan.sampleCounts.size();
  const double steps = static_cast<double>(plan.repeats) * static_cast<double>(runs.size());
  double lastSeconds = plan.times.empty() ? 0 : plan.times.back();  // of one render, known once samples are counted
  int whole = 0;
  try {
    for (; whole < plan.repeats; ++whole) {
      // Integrators render in turn, so that other load of the machine affects all of them.
      for (size_t i = 0; i < runs.size(); ++i) {
        Run& run = runs[i];
        Repeat repeat;
        repeat.looks.resize(milestones);
        repeat.pictures.resize(milestones);
        double seconds = 0;
        const uint64_t seed = SeedOf(SeedUse::Compared, plan.seed + static_cast<uint64_t>(whole));
        const auto look = [&](size_t milestone, const ComparedScene::Milestone& reached, const Image& image) {
          const ImageError error = MeasureError(image, reference.image, plan.exposure);
          repeat.looks[milestone] = {seed,       reached.seconds, reached.samplesPerPixel, error.mse, error.relMse,
                                     error.flip, error.bias,      reached.stated};
          repeat.pictures[milestone] = ChannelsOf(image, {"R", "G", "B"});
          repeat.last = milestone;
        };
        const double before = whole * static_cast<double>(runs.size()) + static_cast<double>(i);
        const auto tell = [&](double now) {
          seconds = now;
          const double ofRender = lastSeconds > 0 ? std::min(now / lastSeconds, 1.0) : 0;
          progress((before + ofRender) / steps,
                   run.integrator + ", " + std::to_string(whole + 1) + " of " + std::to_string(plan.repeats));
        };
        scene.Render(run.integrator, seed, plan.times, plan.sampleCounts, look, tell, 0,
                     scene.ChoiceSeconds(run.integrator));
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
  std::vector<std::vector<Parts>> parts;
  for (const Run& run : runs) {
    parts.emplace_back();
    for (size_t milestone = 0; milestone < milestones; ++milestone)
      parts.back().push_back(PartsOf(run, milestone, reference));
    results.integrators.push_back(Describe(run, parts.back(), scene, plan, reference, results));
  }
  for (size_t i = 1; i < runs.size(); ++i) AddRatios(runs, parts, i, 0, results);
}

}  // namespace lampyr
