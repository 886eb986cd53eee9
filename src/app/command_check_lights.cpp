// The pdf consistency suite on every registered light: a line for each light and property, and a verdict.
#include <unistd.h>

#include <cstdio>

#include "app/command_line.h"
#include "app/commands.h"
#include "app/json_report.h"
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

}  // namespace

int RunCheckLights(const CheckLightsOptions& options) {
  const ScratchFolder scratch;
  SuiteOptions suite;
  suite.seed = options.seed;
  const std::vector<SuiteResult> results = RunPdfSuite(LightRegistry(), scratch.Path(), suite);
  const std::vector<LightVerdict> verdicts = SummariseByProperty(results);
  size_t failed = 0;
  for (const LightVerdict& verdict : verdicts) failed += verdict.passed ? 0 : 1;
  if (options.json) {
    std::printf("%s", ToJson(verdicts).c_str());
  } else {
    for (const LightVerdict& verdict : verdicts) {
      std::printf("%-6s %-34s %-20s %5zu cases, worst %s %.3g (threshold %.3g)%s%s\n", verdict.passed ? "ok" : "FAILED",
                  verdict.light.c_str(), verdict.property.c_str(), verdict.cases,
                  verdict.worst.isProbability ? "p" : "error", verdict.worst.statistic, verdict.worst.threshold,
                  verdict.passed ? "" : ": ", verdict.passed ? "" : verdict.worst.caseName.c_str());
    }
    std::printf("%zu cases, %zu of %zu properties failed (family-wise error rate %g)\n", results.size(), failed,
                verdicts.size(), suite.familyWise);
  }
  if (results.empty()) throw Error("no light was checked");
  return failed == 0 ? kExitDone : kExitFailed;
}

}  // namespace lampyr
