// The pdf consistency suite on every registered light, or on the lights of a scene: a line for each light and property,
// and a verdict.
#include <unistd.h>

#include <cstdio>

#include "app/command_line.h"
#include "app/commands.h"
#include "app/json_report.h"
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

// `only`: the name of a type, "" for all.
std::vector<SuiteResult> CheckTypes(const std::string& only, const SuiteOptions& suite) {
  std::vector<LightType> types;
  std::vector<std::string> names;
  for (const LightType& type : LightRegistry()) {
    names.push_back(type.name);
    if (only.empty() || type.name == only) types.push_back(type);
  }
  if (types.empty()) throw UsageError("there is no light \"" + only + "\"" + DidYouMean(only, names));
  const ScratchFolder scratch;
  std::vector<SuiteResult> results = RunPdfSuite(types, scratch.Path(), suite);
  if (results.empty()) throw Error("no light was checked");
  return results;
}

// Errors of the scene are errors of usage, as when it is rendered.
std::vector<SuiteResult> CheckScene(const std::filesystem::path& file, const SuiteOptions& suite) {
  Diagnostics diagnostics;
  std::vector<SceneLight> lights;
  const BuiltScene built = [&] {
    try {
      return BuildScene(ReadScene(file, diagnostics), true, diagnostics, lights);
    } catch (const UsageError&) {
      throw;
    } catch (const Error& error) {
      throw UsageError(error.Where(), error.Text());
    }
  }();
  return RunPdfSuiteOnScene(*built.scene.lighting, lights, suite);
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
  const std::vector<SuiteResult> results =
      options.scene ? CheckScene(*options.scene, suite) : CheckTypes(options.type, suite);
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
