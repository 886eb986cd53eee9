// How many samples each method takes to find a planted fault. Prints a line of JSON for each fault; tests/detection/run
// makes docs/detection.md of them.
//
//   detection_bench list                            what there is to run
//   detection_bench lights|filters SUBJECT [NAME…]  the faults of a subject, or those named, and the sound one
//   detection_bench weights TRUTH.json [record]     the integrators as they were built; `record` writes the true mean
//                                                   of the furnace, by sound ones
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <iostream>

#include "detection/baselines.h"
#include "detection/weight_search.h"
#include "suite/suite_inputs.h"
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

double TrueMean(const BaselineScene& scene) {
  MeanRadiance mean;
  for (int samples = 16; samples <= 256; samples *= 4) {
    mean = RenderMean(scene, "path", samples, 77);
    if (mean.error < 3e-3 * mean.mean) break;
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
  // For the correct light: the mean of the furnace, and the number of draws at which the χ² test rejects it.
  const double truth = TrueMean(furnace(nullptr));
  const Finding directions = FindByChiSquared(tiles(nullptr), ~uint64_t{0}, 2 * kLeastSeconds, Queries);
  const uint64_t draws = directions.found ? directions.draws / 4 : directions.draws;
  const auto print = [&](const LightFault* fault, const Json& about) {
    const Finding ours = FindBySuite(subject, fault, scratch);
    const double seconds = std::max(ours.seconds, kLeastSeconds);
    Json line = about;
    line.update({{"subject", name},
                 {"budget", seconds},
                 {"ours", ToJson(ours)},
                 {"furnace", ToJson(FindByFurnace(furnace(fault), kIntegrators, truth, seconds, Queries))},
                 {"chi2", ToJson(FindByChiSquared(tiles(fault), draws, seconds, Queries))},
                 {"chi2Limit", draws},
                 {"ttest", ToJson(FindByTiles(tiles(fault), "path", "bdpt", seconds, Queries))}});
    Print(line);
  };
  if (only.empty()) print(nullptr, {{"kind", "sound"}, {"name", name}});
  for (const LightFault& fault : LightFaults()) {
    if (fault.subject != name) continue;
    if (!only.empty() && std::find(only.begin(), only.end(), fault.name) == only.end()) continue;
    print(&fault, {{"kind", "light"}, {"name", fault.name}, {"what", fault.what}});
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
  const auto print = [&](const FilterFault* fault, const Json& about) {
    const std::string more = fault ? fault->parameters : "";
    const double truth = TrueMean(furnace(nullptr, more));
    const Finding ours = FindBySuite(subject, fault, scratch);
    const double seconds = std::max(ours.seconds, kLeastSeconds);
    Finding nothing;
    nothing.applies = false;
    Json line = about;
    line.update({{"subject", name},
                 {"budget", seconds},
                 {"ours", ToJson(ours)},
                 {"furnace", ToJson(FindByFurnace(furnace(fault, more), kIntegrators, truth, seconds, Edges))},
                 {"chi2", ToJson(nothing)},
                 {"ttest", ToJson(FindByTiles(tiles(fault, more), "path", "bdpt", seconds, Edges))}});
    Print(line);
  };
  if (only.empty()) print(nullptr, {{"kind", "sound"}, {"name", "filter " + name}});
  for (const FilterFault& fault : FilterFaults()) {
    if (fault.subject != name) continue;
    if (!only.empty() && std::find(only.begin(), only.end(), fault.name) == only.end()) continue;
    print(&fault, {{"kind", "filter"}, {"name", fault.name}, {"what", fault.what}});
  }
}

void List() {
  for (const LightSubject& subject : LightSubjects()) std::printf("lights %s\n", subject.name.c_str());
  for (const FilterSubject& subject : FilterSubjects()) std::printf("filters %s\n", subject.name.c_str());
  for (const PatchFault& fault : PatchFaults()) std::printf("patch %s %s\n", fault.name.c_str(), fault.what.c_str());
}

void RunWeights(const std::filesystem::path& file, bool record) {
  if (record) std::ofstream(file) << Json{{"truth", TrueMeanOfLamp()}};
  Json known;
  std::ifstream(file) >> known;
  const Finding ours = FindByProofs();
  const double seconds = std::max(ours.seconds, kLeastSeconds);
  Finding nothing;
  nothing.applies = false;
  Print({{"kind", "weights"},
         {"budget", seconds},
         {"ours", ToJson(ours)},
         {"furnace", ToJson(FindWeightsByFurnace(known.at("truth"), seconds))},
         {"chi2", ToJson(nothing)},
         {"ttest", ToJson(FindWeightsByTiles(seconds))}});
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
