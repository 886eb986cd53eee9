// Runs the pdf consistency suite on every type of light and the filter suite on every type of light filter, on those of
// a plugin, or the pdf suite on the lights of a scene. Prints a line for each light or filter and property, and a
// verdict.
#include <unistd.h>

#include <cstdio>

#include "app/command_line.h"
#include "app/commands.h"
#include "app/json_report.h"
#include "base/progress.h"
#include "render/build/plugins.h"
#include "render/build/scene_builder.h"
#include "suite/filter_suite.h"
#include "suite/properties.h"
#include "suite/scene_suite.h"
#include "suite/verdict.h"

namespace lampyr {

namespace {

// A temporary folder for the images of textured test lights; deleted by the destructor.
class ScratchFolder {
 public:
  ScratchFolder()
      : path_(std::filesystem::temp_directory_path() / ("lampyr-check-lights-" + std::to_string(getpid()))) {
    std::filesystem::create_directories(path_);
  }
  ~ScratchFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  const std::filesystem::path& Path() const { return path_; }

 private:
  std::filesystem::path path_;
};

struct ChosenTypes {
  std::vector<LightType> lights;
  std::vector<FilterType> filters;

  bool IsEmpty() const { return lights.empty() && filters.empty(); }
};

// The types with the requested name; otherwise those of the requested plugins; otherwise all.
ChosenTypes ChooseTypes(const CheckLightsOptions& options, const TypeRegistry& registry) {
  ChosenTypes types;
  if (options.type.empty() && !options.plugins.files.empty()) {
    for (const LightType* type : LightsOf(registry, options.plugins)) types.lights.push_back(*type);
    for (const FilterType* type : FiltersOf(registry, options.plugins)) types.filters.push_back(*type);
    if (types.IsEmpty()) throw UsageError("--plugin: expected a type of light or of light filter to check, found none");
    return types;
  }
  std::vector<std::string> names;
  const auto choose = [&](const auto& all, auto& chosen) {
    for (const auto* type : all) {
      names.push_back(type->name);
      if (options.type.empty() || type->name == options.type) chosen.push_back(*type);
    }
  };
  choose(registry.Lights(), types.lights);
  choose(registry.Filters(), types.filters);
  if (types.IsEmpty())
    throw UsageError("there is no light or filter \"" + options.type + "\"" + DidYouMean(options.type, names));
  return types;
}

// Throws a UsageError for a type without sample blocks: a type that was not tested must not pass.
template <class Type>
void RequireSamples(const std::vector<Type>& types, const char* what) {
  for (const Type& type : types) {
    if (type.samples.empty())
      throw UsageError(std::string("the ") + what + " \"" + type.name + "\" has no sample blocks to check it by");
  }
}

std::vector<SuiteResult> CheckTypes(const CheckLightsOptions& options, const SuiteOptions& suite) {
  const TypeRegistry registry = LoadTypes(options.plugins, nullptr);
  const ChosenTypes types = ChooseTypes(options, registry);
  RequireSamples(types.lights, "light");
  RequireSamples(types.filters, "filter");
  const ScratchFolder scratch;
  std::vector<SuiteResult> results;
  RunForeignCode(registry, [&] {
    SuiteOptions silent = suite;  // filters take negligible time beside lights
    if (!types.lights.empty()) {
      results = RunPdfSuite(types.lights, scratch.Path(), suite);
      silent.progress = nullptr;
    }
    if (types.filters.empty()) return;
    const std::vector<SuiteResult> filters = RunFilterSuite(types.filters, scratch.Path(), silent);
    results.insert(results.end(), filters.begin(), filters.end());
  });
  if (results.empty()) throw Error("nothing was checked");
  return results;
}

// Checks the lights of a scene. Errors of the scene are usage errors, as in rendering.
std::vector<SuiteResult> CheckScene(const CheckLightsOptions& options, const SuiteOptions& suite) {
  Diagnostics diagnostics;
  TypeRegistry types;
  std::vector<SceneLight> lights;
  BuiltScene built;
  try {
    const SceneDescription description = ReadScene(*options.scene, diagnostics);
    types = LoadTypes(options.plugins, &description);
    RunForeignCode(types, [&] { built = BuildScene(description, true, diagnostics, lights, types); });
  } catch (const UsageError&) {
    throw;
  } catch (const Error& error) {
    throw UsageError(error.Where(), error.Text());
  }
  std::vector<SuiteResult> results;
  RunForeignCode(types, [&] { results = RunPdfSuiteOnScene(*built.scene.lighting, lights, suite); });
  return results;
}

// Prints a verdict. For a failure, also the meaning of the property and the worst case.
void Print(const LightVerdict& verdict) {
  std::printf("%-6s %-34s %-20s %5zu cases, worst %s %.3g (threshold %.3g)%s%s\n", verdict.passed ? "ok" : "FAILED",
              verdict.light.c_str(), verdict.property.c_str(), verdict.cases,
              verdict.worst.isProbability ? "p" : "error", verdict.worst.statistic, verdict.worst.threshold,
              verdict.passed ? "" : ": ", verdict.passed ? "" : verdict.worst.caseName.c_str());
  if (verdict.passed) return;
  std::printf("         %s: %s\n", verdict.property.c_str(), MeaningOfVerdict(verdict).c_str());
  if (!verdict.worst.words.empty()) {
    std::printf("         worst: %s\n", verdict.worst.words.c_str());
  } else if (verdict.worst.isProbability) {
    std::printf("         worst: by chance with a probability of %.3g, where %.3g is too little, in the case \"%s\"\n",
                verdict.worst.statistic, verdict.worst.threshold, verdict.worst.caseName.c_str());
  } else {
    std::printf("         worst: an error of %.3g where %.3g is allowed, in the case \"%s\"\n", verdict.worst.statistic,
                verdict.worst.threshold, verdict.worst.caseName.c_str());
  }
}

}  // namespace

int RunCheckLights(const CheckLightsOptions& options) {
  SuiteOptions suite;
  suite.seed = options.seed;
  suite.threads = options.threads;
  Progress progress(false);
  suite.progress = [&](double fraction) { progress.Update(fraction, ""); };
  const std::vector<SuiteResult> results = options.scene ? CheckScene(options, suite) : CheckTypes(options, suite);
  progress.Clear();
  const double seconds = progress.Seconds();
  const std::vector<LightVerdict> verdicts = SummariseByProperty(results);
  size_t failed = 0;
  for (const LightVerdict& verdict : verdicts) failed += verdict.passed ? 0 : 1;
  if (options.json) {
    std::printf("%s", ToJson(verdicts).c_str());
  } else if (results.empty()) {
    std::printf("%s has no light: nothing to check\n", options.scene->string().c_str());
  } else {
    for (const LightVerdict& verdict : verdicts) Print(verdict);
    std::printf("%zu cases, %zu of %zu properties failed (family-wise error rate %g), %.1f s\n", results.size(), failed,
                verdicts.size(), suite.familyWise, seconds);
  }
  return failed == 0 ? kExitDone : kExitFailed;
}

}  // namespace lampyr
