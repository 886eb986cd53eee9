// The pdf consistency suite on every type of light, on those of a plugin, or on the lights of a scene: a line for each
// light and property, and a verdict.
#include <unistd.h>

#include <cstdio>

#include "app/command_line.h"
#include "app/commands.h"
#include "app/json_report.h"
#include "app/plugins.h"
#include "app/scene_builder.h"
#include "base/progress.h"
#include "lights/suite/verdict.h"

namespace lampyr {

namespace {

// A folder of its own for the images that textured lights are tested with; gone when this is.
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

// The type that is named; else those of the plugins that are asked for; else all.
std::vector<LightType> ChooseTypes(const CheckLightsOptions& options, const TypeRegistry& registry) {
  std::vector<LightType> types;
  if (options.type.empty() && !options.plugins.files.empty()) {
    for (const LightType* type : LightsOf(registry, options.plugins)) types.push_back(*type);
    if (types.empty()) throw UsageError("--plugin: expected a type of light to check, found none");
    return types;
  }
  std::vector<std::string> names;
  for (const LightType* type : registry.Lights()) {
    names.push_back(type->name);
    if (options.type.empty() || type->name == options.type) types.push_back(*type);
  }
  if (types.empty()) throw UsageError("there is no light \"" + options.type + "\"" + DidYouMean(options.type, names));
  return types;
}

std::vector<SuiteResult> CheckTypes(const CheckLightsOptions& options, const SuiteOptions& suite) {
  const TypeRegistry registry = LoadTypes(options.plugins, nullptr);
  const std::vector<LightType> types = ChooseTypes(options, registry);
  for (const LightType& type : types) {
    // What was not looked at must not pass.
    if (type.samples.empty()) throw UsageError("the light \"" + type.name + "\" has no sample blocks to check it by");
  }
  const ScratchFolder scratch;
  std::vector<SuiteResult> results;
  RunForeignCode(registry, [&] { results = RunPdfSuite(types, scratch.Path(), suite); });
  if (results.empty()) throw Error("no light was checked");
  return results;
}

// Errors of the scene are errors of usage, as when it is rendered.
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

void Print(const LightVerdict& verdict) {
  std::printf("%-6s %-34s %-20s %5zu cases, worst %s %.3g (threshold %.3g)%s%s\n", verdict.passed ? "ok" : "FAILED",
              verdict.light.c_str(), verdict.property.c_str(), verdict.cases,
              verdict.worst.isProbability ? "p" : "error", verdict.worst.statistic, verdict.worst.threshold,
              verdict.passed ? "" : ": ", verdict.passed ? "" : verdict.worst.caseName.c_str());
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
