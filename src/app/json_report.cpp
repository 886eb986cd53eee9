// The only file that includes nlohmann-json.
#include "app/json_report.h"

#include <sys/resource.h>

#include <nlohmann/json.hpp>

namespace lampyr {

using Json = nlohmann::ordered_json;

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
  const Json json = {
      {"scene", report.scene},
      {"sceneHash", report.sceneHash},
      {"integrator", report.integrator},
      {"seed", report.seed},
      {"threads", report.threads},
      {"width", report.width},
      {"height", report.height},
      {"primitives", report.primitives},
      {"lights", report.lights},
      {"samplesPerPixel", outcome.samplesPerPixel},
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
  return json.dump(2) + "\n";
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
  };
  if (difference.hasBlockTest) {
    const BlockTest& test = difference.blockTest;
    json["blockTest"] = {{"blockSize", test.blockSize},   {"blocks", test.blocks},
                         {"largestZ", test.largestZ},     {"threshold", test.threshold},
                         {"chiSquared", test.chiSquared}, {"chiSquaredThreshold", test.chiSquaredThreshold},
                         {"agrees", test.Agrees()}};
  }
  return json.dump(2) + "\n";
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
                    {"worstCase", verdict.worst.caseName}});
  }
  return rows.dump(2) + "\n";
}

}  // namespace lampyr
