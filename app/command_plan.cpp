#include <unistd.h>

#include <algorithm>
#include <cstdio>

#include "app/command_line.h"
#include "app/commands.h"
#include "base/terminal.h"
#include "render/analysis/plan.h"
#include "render/load_scene.h"
#include "render/settings/integrator_choice.h"

namespace lampyr {

namespace {

// Table of the pilot's estimates, a row for each candidate; all figures are per sample. `values`: settings of the
// integrators.
void PrintPilot(const RenderPilot& pilot, const Settings& values) {
  if (pilot.candidates.empty()) return;
  std::printf("\n%-5s %5s %5s %7s %4s %6s %7s %s\n", "pilot", "paths", "merge", "relMSE", "+-", "µs", "product",
              "misses");
  for (const PilotCandidate& candidate : pilot.candidates) {
    char missing[32] = "";
    if (candidate.missing > kNegligibleLight)
      std::snprintf(missing, sizeof missing, "  %.2g %%", 100 * candidate.missing);
    const UsedCounts used = candidate.counts.Mean(CountedTechniquesOf(candidate.integrator, values));
    char on[16] = "";
    if (used.continuing < 1) std::snprintf(on, sizeof on, "  on %.0f%%", 100 * used.continuing);
    char lights[24] = "";
    if (candidate.counts.lightSamples > 1)
      std::snprintf(lights, sizeof lights, "  %d lights", candidate.counts.lightSamples);
    std::printf("%-5s %5g %4.0f%% %7.3g %3.0f%% %5.2f %7.3g%s%s%s%s%s\n", candidate.integrator.c_str(), used.lightPaths,
                100 * used.merging, candidate.error, 100 * candidate.uncertainty / candidate.error,
                candidate.cost * 1e-3, candidate.error * candidate.cost * 1e-3, missing,
                candidate.counts.startsWide ? "  wide" : "", on, lights, &candidate == pilot.Best() ? "  <" : "");
  }
}

}  // namespace

int RunPlan(const PlanOptions& options) {
  if (options.overrides.integrator) CheckIntegratorName(*options.overrides.integrator);
  // The integrator is chosen by the plan itself.
  RenderOverrides overrides = options.overrides;
  overrides.integrator = "path";
  overrides.threads = options.threads;
  const LoadedScene loaded = LoadScene(options.scene, options.plugins, overrides, options.strict, true);
  RenderSettings settings = loaded.built.settings;
  if (options.overrides.integrator) settings.integrator = *options.overrides.integrator;
  ScenePlan plan;
  RunForeignCode(loaded.types, [&] { plan = PlanFor(loaded.built.scene, settings, options.threads); });
  size_t subject = 0, choice = 0;
  for (const PlanDecision& decision : plan.decisions) {
    subject = std::max(subject, decision.subject.size());
    choice = std::max(choice, decision.choice.size());
  }
  constexpr int kUnbounded = 1 << 20;  // in a file or a pipe: one line each
  const int columns = TerminalColumns(STDOUT_FILENO, kUnbounded);
  for (const PlanDecision& decision : plan.decisions) {
    const auto padded = [](const std::string& text, size_t size) {
      return text + std::string(size + 2 - text.size(), ' ');
    };
    const std::string row = padded(decision.subject, subject) + padded(decision.choice, choice);
    std::printf("%s", Indented(row, decision.reason, columns).c_str());
  }
  PrintPilot(plan.pilot, settings.values);
  const std::string& named = loaded.built.settings.namedIntegrator;
  if (settings.integrator == "auto" && !named.empty() && named != plan.integrator) {
    const std::string note = "The scene names " + named + ": `lampyr render` renders with " + named + ", and with " +
                             plan.integrator + " by --integrator auto.";
    std::printf("%s", Indented("", note, columns).c_str());
  }
  return kExitDone;
}

}  // namespace lampyr
