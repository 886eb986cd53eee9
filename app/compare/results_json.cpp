// The results of `lampyr compare` as JSON: for machines, and for the page.
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "app/compare/report.h"
#include "base/version.h"

namespace lampyr {

using Json = nlohmann::ordered_json;

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
          {"noiseIsLimit", reference.noiseIsLimit},
          {"bias", OrNull(reference.bias)},
          {"biasIsLimit", reference.biasIsLimit},
          {"radius", OrNull(reference.radius)}};
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

Json OrNull(const std::optional<ErrorParts>& stated) {
  if (!stated) return nullptr;
  return {{"error", Number(stated->Both())}, {"noise", Number(stated->noise)}, {"bias", Number(stated->bias)}};
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
                    {"meanBias", Number(run.meanBias)},
                    {"stated", OrNull(run.stated)}});
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
          {"bias", Interval(snapshot.bias)},
          {"noise", OrNull(snapshot.noise)},
          {"stated", OrNull(snapshot.stated)},
          {"efficiency", OrNull(snapshot.efficiency)},
          {"relEfficiency", OrNull(snapshot.relEfficiency)},
          {"picture", OrNull(snapshot.picture)},
          {"errorPicture", OrNull(snapshot.errorPicture)},
          {"runs", ToTree(snapshot.runs)}};
}

Json ToTree(const std::vector<SpectrumRing>& spectrum) {
  Json rings = Json::array();
  for (const SpectrumRing& ring : spectrum) {
    rings.push_back({{"frequency", ring.frequency},
                     {"share", Number(ring.share)},
                     {"density", Number(ring.density)},
                     {"low", Number(ring.low)},
                     {"high", Number(ring.high)},
                     {"deviation", Number(ring.deviation)},
                     {"common", Number(ring.common)}});
  }
  return rings;
}

Json ToTree(const ComparedIntegrator& integrator) {
  Json json = {{"name", integrator.name},
               {"hints", integrator.hints},
               {"blurs", integrator.blurs},
               {"meanBias", Interval(integrator.meanBias)},
               {"systematic", Interval(integrator.systematic)},
               {"timeToError", Json::array()},
               {"snapshots", Json::array()},
               {"spectrum", ToTree(integrator.spectrum)}};
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
               {"secondsOf", results.ofProcessor ? "processor" : "clock"},
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
                              {"bias", Number(pilot.bias)},
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
  // File names may not be valid UTF-8.
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace lampyr
