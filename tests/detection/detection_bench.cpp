// How many samples each method takes to find a planted fault. Prints a line of JSON for each fault; tests/detection/run
// makes docs/detection.md of them.
//
//   detection_bench list                            what there is to run
//   detection_bench lights|filters SUBJECT [NAME…]  the faults of a subject, or those named, and the sound one
//   detection_bench weights BUDGET.json [record]    the integrators as they were built; `record` writes the budget and
//                                                   the truth, of sound ones
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <iostream>

#include "detection/baselines.h"
#include "detection/weight_search.h"
#include "lights/suite/suite_inputs.h"
#include "support/temporary_folder.h"

namespace lampyr::test {
namespace {

using Json = nlohmann::json;

Json ToJson(const Finding& finding) {
  return {{"found", finding.found},     {"applies", finding.applies}, {"samples", finding.samples},
          {"seconds", finding.seconds}, {"draws", finding.draws},     {"property", finding.property}};
}

void Print(const Json& line) {
  std::cout << line.dump() << std::endl;
}

// What the baselines are given of a sound light or filter.
struct Help {
  double seconds = 0;  // that the suite takes
  double truth = 0;    // mean of the furnace
  uint64_t draws = 0;  // at which the χ² test still passes
};

double TrueMean(const BaselineScene& scene) {
  MeanRadiance mean;
  for (int samples = 16; samples <= 1024; samples *= 4) {
    mean = RenderMean(scene, "path", samples, 77);
    if (mean.error < 2e-3 * mean.mean) break;
  }
  return mean.mean;
}

uint64_t Queries() {
  return LightQueries();
}
uint64_t Edges() {
  return FilteredEdges();
}

const std::vector<std::string> kIntegrators = {"path", "bdpt"};

void RunLights(const std::string& name, const std::vector<std::string>& only, const std::filesystem::path& scratch) {
  const LightSubject& subject = FindLightSubject(name);
  const auto furnace = [&](const LightFault* fault) {
    return SceneOf(FurnaceScene(subject, "planted"), scratch, PlantedType(name, fault));
  };
  const auto tiles = [&](const LightFault* fault) {
    return SceneOf(TileScene(subject, "planted"), scratch, PlantedType(name, fault));
  };
  // The sound light: what each method takes, and that none rejects it.
  Help help;
  const Finding suite = FindBySuite(subject, nullptr, scratch, true);
  help.seconds = suite.seconds;
  help.truth = TrueMean(furnace(nullptr));
  const Finding directions = FindByChiSquared(tiles(nullptr), ~uint64_t{0}, 2 * help.seconds, Queries);
  help.draws = directions.found ? directions.draws / 4 : directions.draws;
  const Finding looks = FindBySuite(subject, nullptr, scratch);
  Print({{"kind", "sound"},
         {"subject", name},
         {"name", name},
         {"budget", help.seconds},
         {"full", suite.samples},
         {"ours", ToJson(looks)},
         {"furnace", ToJson(FindByFurnace(furnace(nullptr), kIntegrators, help.truth, help.seconds, Queries))},
         {"chi2", ToJson(FindByChiSquared(tiles(nullptr), help.draws, help.seconds, Queries))},
         {"chi2Limit", help.draws},
         {"ttest", ToJson(FindByTiles(tiles(nullptr), "path", "bdpt", help.seconds, Queries))}});
  for (const LightFault& fault : LightFaults()) {
    if (fault.subject != name) continue;
    if (!only.empty() && std::find(only.begin(), only.end(), fault.name) == only.end()) continue;
    Print({{"kind", "light"},
           {"subject", name},
           {"name", fault.name},
           {"what", fault.what},
           {"budget", help.seconds},
           {"ours", ToJson(FindBySuite(subject, &fault, scratch))},
           {"furnace", ToJson(FindByFurnace(furnace(&fault), kIntegrators, help.truth, help.seconds, Queries))},
           {"chi2", ToJson(FindByChiSquared(tiles(&fault), help.draws, help.seconds, Queries))},
           {"ttest", ToJson(FindByTiles(tiles(&fault), "path", "bdpt", help.seconds, Queries))}});
  }
}

void RunFilters(const std::string& name, const std::vector<std::string>& only, const std::filesystem::path& scratch) {
  const FilterSubject& subject = FindFilterSubject(name);
  const LightSubject& light = FindLightSubject("rect");
  const auto statement = [&](const std::string& more) {
    return "LightFilter \"planted\" " + subject.parameters + more + "\n";
  };
  const auto furnace = [&](const FilterFault* fault, const std::string& more) {
    return SceneOf(FurnaceScene(light, "rect", statement(more)), scratch, PlantedFilterType(name, fault));
  };
  const auto tiles = [&](const FilterFault* fault, const std::string& more) {
    return SceneOf(TileScene(light, "rect", statement(more)), scratch, PlantedFilterType(name, fault));
  };
  const Finding suite = FindBySuite(subject, nullptr, scratch);
  const double truth = TrueMean(furnace(nullptr, ""));
  const double seconds = suite.seconds;
  Finding nothing;
  nothing.applies = false;
  Print({{"kind", "sound"},
         {"subject", name},
         {"name", "filter " + name},
         {"budget", seconds},
         {"full", suite.samples},
         {"ours", ToJson(suite)},
         {"furnace", ToJson(FindByFurnace(furnace(nullptr, ""), kIntegrators, truth, seconds, Edges))},
         {"chi2", ToJson(nothing)},
         {"ttest", ToJson(FindByTiles(tiles(nullptr, ""), "path", "bdpt", seconds, Edges))}});
  for (const FilterFault& fault : FilterFaults()) {
    if (fault.subject != name) continue;
    if (!only.empty() && std::find(only.begin(), only.end(), fault.name) == only.end()) continue;
    const double itsTruth = fault.parameters.empty() ? truth : TrueMean(furnace(nullptr, fault.parameters));
    Print(
        {{"kind", "filter"},
         {"subject", name},
         {"name", fault.name},
         {"what", fault.what},
         {"budget", seconds},
         {"ours", ToJson(FindBySuite(subject, &fault, scratch))},
         {"furnace", ToJson(FindByFurnace(furnace(&fault, fault.parameters), kIntegrators, itsTruth, seconds, Edges))},
         {"chi2", ToJson(nothing)},
         {"ttest", ToJson(FindByTiles(tiles(&fault, fault.parameters), "path", "bdpt", seconds, Edges))}});
  }
}

void List() {
  for (const LightSubject& subject : LightSubjects()) std::printf("lights %s\n", subject.name.c_str());
  for (const FilterSubject& subject : FilterSubjects()) std::printf("filters %s\n", subject.name.c_str());
}

void RunWeights(const std::filesystem::path& file, bool record) {
  Json known;
  if (!record) std::ifstream(file) >> known;
  const WeightHelp help = record ? PrepareWeights() : WeightHelp{known["seconds"], known["truth"]};
  if (record) std::ofstream(file) << Json{{"seconds", help.seconds}, {"truth", help.truth}};
  const Finding ours = FindByProofs();
  Finding nothing;
  nothing.applies = false;
  Print({{"kind", "weights"},
         {"budget", help.seconds},
         {"ours", ToJson(ours)},
         {"furnace", ToJson(FindWeightsByFurnace(help))},
         {"chi2", ToJson(nothing)},
         {"ttest", ToJson(FindWeightsByTiles(help))}});
}

int Run(const std::vector<std::string>& words) {
  if (words.size() == 1 && words[0] == "list") {
    List();
    return 0;
  }
  const std::vector<std::string> names(words.begin() + std::min<ptrdiff_t>(2, std::ssize(words)), words.end());
  const TemporaryFolder scratch;
  suite::WriteSuiteInputs(scratch.Path());
  if (words.size() >= 2 && words[0] == "lights") {
    RunLights(words[1], names, scratch.Path());
  } else if (words.size() >= 2 && words[0] == "filters") {
    RunFilters(words[1], names, scratch.Path());
  } else if (words.size() >= 2 && words[0] == "weights") {
    RunWeights(words[1], names == std::vector<std::string>{"record"});
  } else {
    std::fprintf(stderr, "error: detection_bench takes list, lights SUBJECT, filters SUBJECT or weights FILE\n");
    return 2;
  }
  return 0;
}

}  // namespace
}  // namespace lampyr::test

int main(int count, char** arguments) {
  try {
    return lampyr::test::Run({arguments + 1, arguments + count});
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 1;
  }
}
