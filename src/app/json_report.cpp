// The only file that includes nlohmann-json.
#include "app/json_report.h"

#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/version.h"
#include "lights/suite/properties.h"

namespace lampyr {

using Json = nlohmann::ordered_json;

namespace {

// Names of files may be no UTF-8.
std::string Dump(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace

double PeakMemoryMiB() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

double CpuSeconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

std::string ToJson(const RenderReport& report) {
  const RenderOutcome& outcome = report.outcome;
  const RenderCounts& counts = outcome.counts;
  const double samples = static_cast<double>(report.pixels) * outcome.samplesPerPixel;
  const double seconds = outcome.seconds > 0 ? outcome.seconds : 1e-9;
  Json json = {
      {"scene", report.scene},
      {"sceneHash", report.sceneHash},
      {"integrator", report.integrator},
      {"seed", report.seed},
      {"threads", report.threads},
      {"width", report.width},
      {"height", report.height},
      {"primitives", report.primitives},
      {"lights", report.lights},
      {"lightGroups", report.lightGroups},
      {"samplesPerPixel", outcome.samplesPerPixel},
      {"resumedSamplesPerPixel", report.resumedSamples},
      {"samples", samples},
      {"samplesPerSecond", samples / seconds},
      {"droppedSamples", counts.droppedSamples},
      {"rejectedRays", report.rejectedRays},
      {"relativeError", outcome.relativeError},
      {"interrupted", outcome.interrupted},
      {"rays",
       {{"camera", counts.cameraRays},
        {"indirect", counts.indirectRays},
        {"shadow", counts.shadowRays},
        {"perSecond", static_cast<double>(counts.Rays()) / seconds}}},
      {"seconds",
       {{"parse", report.parseSeconds},
        {"build", report.buildSeconds},
        {"render", outcome.seconds},
        {"write", report.writeSeconds},
        {"cpu", CpuSeconds()}}},
      {"peakMemoryMiB", PeakMemoryMiB()},
  };
  if (const std::optional<PhotonStatistics>& photons = outcome.photons) {
    json["photons"] = {{"passes", photons->passes},
                       {"stored", photons->photons},
                       {"mostInAPass", photons->mostPhotons},
                       {"mostBytes", photons->mostBytes},
                       {"rejected", photons->rejected},
                       {"lookups", counts.lookups},
                       {"found", counts.foundPhotons},
                       {"buildSeconds", photons->buildSeconds},
                       {"nanosecondsPerLookup",
                        1e9 * counts.lookupSeconds / static_cast<double>(std::max<uint64_t>(counts.timedLookups, 1))},
                       {"guideGain", photons->guideGain},
                       {"guideTargets", photons->guideTargets},
                       {"firstRadius", photons->firstRadius},
                       {"lastRadius", photons->lastRadius}};
  }
  return Dump(json);
}

std::string ToJson(const ImageDifference& difference) {
  Json json = {
      {"mse", difference.mse},
      {"relMse", difference.relMse},
      {"flip", difference.flip},
      {"meanA", difference.meanA},
      {"meanB", difference.meanB},
      {"bias", difference.bias},
      {"biasInterval95", difference.biasInterval},
      {"verdict", NameOf(difference.verdict)},
      {"reason", difference.reason.empty() ? Json(nullptr) : Json(difference.reason)},
  };
  if (difference.hasBlockTest) {
    const BlockTest& test = difference.blockTest;
    json["blockTest"] = {{"blockSize", test.blockSize},   {"blocks", test.blocks},
                         {"largestZ", test.largestZ},     {"threshold", test.threshold},
                         {"chiSquared", test.chiSquared}, {"chiSquaredThreshold", test.chiSquaredThreshold},
                         {"agrees", test.Agrees()}};
  }
  return Dump(json);
}

std::string ToJson(const std::vector<LightVerdict>& verdicts) {
  Json rows = Json::array();
  for (const LightVerdict& verdict : verdicts) {
    rows.push_back({{"light", verdict.light},
                    {"property", verdict.property},
                    {"cases", verdict.cases},
                    {"passed", verdict.passed},
                    {"statistic", verdict.worst.isProbability ? "p-value" : "error"},
                    {"worst", verdict.worst.statistic},
                    {"threshold", verdict.worst.threshold},
                    {"worstCase", verdict.worst.caseName},
                    {"meaning", MeaningOf(verdict.property)},
                    {"words", verdict.worst.words}});
  }
  return Dump(rows);
}

namespace {

Json Number(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

Json OrNull(const std::optional<double>& value) {
  return value ? Number(*value) : Json(nullptr);
}

Json OrNull(const std::string& text) {
  return text.empty() ? Json(nullptr) : Json(text);
}

Json Interval(const Estimate& estimate) {
  return {{"value", Number(estimate.value)}, {"low", Number(estimate.low)}, {"high", Number(estimate.high)}};
}

Json OrNull(const std::optional<Estimate>& estimate) {
  return estimate ? Interval(*estimate) : Json(nullptr);
}

Json Interval(const SignificantEstimate& estimate) {
  Json json = Interval(static_cast<const Estimate&>(estimate));
  json["significant"] = estimate.significant;
  return json;
}

const char* KindName(bool byTime) {
  return byTime ? "time" : "samples";
}

Json ToTree(const ComparisonReference& reference) {
  using Origin = ComparisonReference::Origin;
  const char* origin = reference.origin == Origin::Given    ? "given"
                       : reference.origin == Origin::Cached ? "cached"
                                                            : "made";
  return {{"origin", origin},
          {"file", reference.file},
          {"integrator", OrNull(reference.integrator)},
          {"samplesPerPixel", reference.samplesPerPixel > 0 ? Json(reference.samplesPerPixel) : Json(nullptr)},
          {"seconds", reference.seconds > 0 ? Json(reference.seconds) : Json(nullptr)},
          {"mean", Number(reference.mean)},
          {"relativeError", OrNull(reference.relativeError)},
          {"mse", OrNull(reference.mse)},
          {"relMse", OrNull(reference.relMse)},
          {"noiseIsLimit", reference.noiseIsLimit}};
}

Json ToTree(const TimeToError& time) {
  using Kind = TimeToError::Kind;
  const char* names[] = {"measured", "extrapolated", "never", "unresolved"};
  const char* kind = names[static_cast<int>(time.kind)];
  const bool never = time.kind == Kind::Never || time.kind == Kind::Unresolved;
  return {{"error", time.error},
          {"seconds", never ? Json(nullptr) : Number(time.seconds.value)},
          {"low", never ? Json(nullptr) : Number(time.seconds.low)},
          {"high", never ? Json(nullptr) : Number(time.seconds.high)},
          {"kind", kind}};
}

Json ToTree(const std::vector<ComparedRun>& runs) {
  Json rows = Json::array();
  for (const ComparedRun& run : runs) {
    rows.push_back({{"seed", run.seed},
                    {"seconds", run.seconds},
                    {"samplesPerPixel", run.samplesPerPixel},
                    {"mse", Number(run.mse)},
                    {"relMse", Number(run.relMse)},
                    {"flip", Number(run.flip)},
                    {"bias", Number(run.bias)}});
  }
  return rows;
}

Json ToTree(const ComparedSnapshot& snapshot) {
  return {{"kind", KindName(snapshot.byTime)},
          {"budget", snapshot.budget},
          {"seconds", snapshot.seconds},
          {"samplesPerPixel", snapshot.samplesPerPixel},
          {"samplesPerSecond", snapshot.samplesPerSecond},
          {"mse", OrNull(snapshot.mse)},
          {"relMse", OrNull(snapshot.relMse)},
          {"flip", Interval(snapshot.flip)},
          {"efficiency", OrNull(snapshot.efficiency)},
          {"relEfficiency", OrNull(snapshot.relEfficiency)},
          {"picture", OrNull(snapshot.picture)},
          {"errorPicture", OrNull(snapshot.errorPicture)},
          {"runs", ToTree(snapshot.runs)}};
}

Json ToTree(const ComparedIntegrator& integrator) {
  Json json = {{"name", integrator.name},           {"hints", integrator.hints},
               {"bias", Interval(integrator.bias)}, {"systematic", Interval(integrator.systematic)},
               {"timeToError", Json::array()},      {"snapshots", Json::array()}};
  for (const TimeToError& time : integrator.timeToError) json["timeToError"].push_back(ToTree(time));
  for (const ComparedSnapshot& snapshot : integrator.snapshots) json["snapshots"].push_back(ToTree(snapshot));
  return json;
}

}  // namespace

std::string ToJson(const ComparisonResults& results) {
  Json json = {{"lampyr", kVersion},
               {"scene", results.scene},
               {"sceneHash", results.sceneHash},
               {"width", results.width},
               {"height", results.height},
               {"maxDepth", results.maxDepth},
               {"threads", results.threads},
               {"repeats", results.repeats},
               {"confidence", 0.95},
               {"command", results.command},
               {"reference", ToTree(results.reference)},
               {"pilots", Json::array()},
               {"errorScale", {{"lowest", results.lowestError}, {"highest", results.highestError}}},
               {"integrators", Json::array()},
               {"ratios", Json::array()}};
  for (const Pilot& pilot : results.pilots) {
    json["pilots"].push_back({{"integrator", pilot.integrator},
                              {"seconds", pilot.seconds},
                              {"samplesPerPixel", pilot.samplesPerPixel},
                              {"mean", Number(pilot.mean)},
                              {"relMse", Number(pilot.relMse)},
                              {"chosen", pilot.chosen},
                              {"note", pilot.note}});
  }
  for (const ComparedIntegrator& integrator : results.integrators) json["integrators"].push_back(ToTree(integrator));
  for (const EfficiencyRatio& ratio : results.ratios) {
    Json row = {{"integrator", ratio.integrator},
                {"against", ratio.against},
                {"kind", KindName(ratio.byTime)},
                {"budget", ratio.budget},
                {"metric", ratio.relative ? "relMse" : "mse"}};
    row.update(Interval(ratio.ratio));
    json["ratios"].push_back(row);
  }
  return Dump(json);
}

}  // namespace lampyr
