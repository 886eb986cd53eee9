// The only file that includes nlohmann-json.
#include "app/json_report.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/memory.h"
#include "base/version.h"
#include "suite/properties.h"

namespace lampyr {

using Json = nlohmann::ordered_json;

namespace {

// File names may not be valid UTF-8.
std::string Dump(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

Json ToTree(const std::vector<std::pair<std::string, SettingValue>>& settings) {
  Json tree = Json::object();
  for (const auto& [name, value] : settings) std::visit([&](const auto& own) { tree[name] = own; }, value);
  return tree;
}

Json Layers(const RenderReport& report) {
  Json layers = Json::array();
  for (const auto& [name, expression] : report.layers) layers.push_back({{"name", name}, {"expression", expression}});
  return layers;
}

Json Photons(const PhotonStatistics& photons, const RenderCounts& counts) {
  return {{"passes", photons.passes},
          {"stored", photons.photons},
          {"mostInAPass", photons.mostPhotons},
          {"mostBytes", photons.mostBytes},
          {"rejected", photons.rejected},
          {"lookups", counts.lookups},
          {"found", counts.foundPhotons},
          {"buildSeconds", photons.buildSeconds},
          {"nanosecondsPerLookup",
           1e9 * counts.lookupSeconds / static_cast<double>(std::max<uint64_t>(counts.timedLookups, 1))},
          {"guideGain", photons.guideGain},
          {"guideComponents", photons.guideComponents},
          {"firstRadius", photons.firstRadius},
          {"lastRadius", photons.lastRadius}};
}

}  // namespace

std::string ToJson(const RenderReport& report) {
  const RenderOutcome& outcome = report.outcome;
  const RenderCounts& counts = outcome.counts;
  const double samples = static_cast<double>(report.pixels) * outcome.samplesPerPixel;
  const double seconds = outcome.seconds > 0 ? outcome.seconds : 1e-9;
  Json json = {
      {"scene", report.scene},
      {"sceneHash", report.sceneHash},
      {"integrator", report.integrator},
      {"settings", ToTree(report.settings)},
      {"seed", report.seed},
      {"threads", report.threads},
      {"width", report.width},
      {"height", report.height},
      {"primitives", report.primitives},
      {"lights", report.lights},
      {"lightGroups", report.lightGroups},
      {"layers", Layers(report)},
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
  if (outcome.parts) json["errorParts"] = {{"noise", outcome.parts->noise}, {"bias", outcome.parts->bias}};
  if (outcome.pixelError) json["pixelError"] = *outcome.pixelError;
  if (report.adaptive) {
    json["adaptive"] = {{"ofPixels", report.adaptive->share},
                        {"fewestSamples", report.adaptive->fewestSamples},
                        {"mostSamples", report.adaptive->mostSamples}};
  }
  if (const std::optional<UsedCounts>& decided = report.decided) {
    json["auto"] = {{"lightPaths", decided->lightPaths},
                    {"connecting", decided->connecting},
                    {"merging", decided->merging},
                    {"continuing", decided->continuing},
                    {"lightSamples", decided->lightSamples}};
  }
  if (outcome.guiding.regions > 0)
    json["guiding"] = {{"gain", outcome.guiding.gain}, {"regions", outcome.guiding.regions}};
  if (outcome.guiding.usesLearnedLights) json["lightLearning"] = {{"gain", outcome.guiding.lightGain}};
  if (outcome.photons) json["photons"] = Photons(*outcome.photons, outcome.counts);
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
                    {"meaning", MeaningOfVerdict(verdict)},
                    {"words", verdict.worst.words}});
  }
  return Dump(rows);
}

}  // namespace lampyr
