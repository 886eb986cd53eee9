// The plan of a render: which features the scene requires, each decision with its reason. Derived from facts about the
// scene and a pilot.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "render/analysis/pilot.h"
#include "render/settings/render_settings.h"

namespace lampyr {

struct PlanDecision {
  std::string subject, choice, reason;
};

struct IntegratorChoice {
  PlanDecision decision;
  std::shared_ptr<const TechniqueCounts> counts;  // of bdpt and vcm
  // relMSE in equal time of the integrator as the command line names it, over that with these counts.
  double gainOfCounts = 1;

  // The settings with this integrator.
  void Apply(RenderSettings& settings) const;
};

struct ScenePlan {
  std::string integrator;  // that suits the scene; "auto" selects it
  std::vector<PlanDecision> decisions;
  RenderPilot pilot;  // of the choice of the integrator; empty where none was needed
};

// The integrator that suits the scene, by a pilot. Deterministic for a scene, its size and its settings.
// `threads`: 0: all.
IntegratorChoice ChooseIntegrator(const RenderScene& scene, const RenderSettings& settings, int threads = 0);

// Deterministic for a scene and its settings. `threads`: 0: all.
ScenePlan PlanFor(const RenderScene& scene, const RenderSettings& settings, int threads = 0);

}  // namespace lampyr
