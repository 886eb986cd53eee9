#include <algorithm>
#include <cstdio>

#include "app/command_line.h"
#include "app/commands.h"
#include "render/analysis/plan.h"
#include "render/load_scene.h"

namespace lampyr {

int RunPlan(const PlanOptions& options) {
  const LoadedScene loaded = LoadScene(options.scene, options.plugins, options.overrides, options.strict, true);
  RenderSettings settings = loaded.built.settings;
  if (options.overrides.integrator) settings.integrator = *options.overrides.integrator;
  ScenePlan plan;
  RunForeignCode(loaded.types, [&] { plan = PlanFor(loaded.built.scene, settings); });
  size_t subject = 0, choice = 0;
  for (const PlanDecision& decision : plan.decisions) {
    subject = std::max(subject, decision.subject.size());
    choice = std::max(choice, decision.choice.size());
  }
  for (const PlanDecision& decision : plan.decisions) {
    std::printf("%-*s  %-*s  %s\n", static_cast<int>(subject), decision.subject.c_str(), static_cast<int>(choice),
                decision.choice.c_str(), decision.reason.c_str());
  }
  return kExitDone;
}

}  // namespace lampyr
