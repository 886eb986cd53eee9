// The plan of a render: which features the scene requires, each decision with its reason. Derived from facts about the
// scene and a few thousand rays, without images.
#pragma once

#include <string>
#include <vector>

#include "integrators/walk/integrator.h"
#include "render/settings/render_settings.h"

namespace lampyr {

struct PlanDecision {
  std::string subject, choice, reason;
};

struct ScenePlan {
  std::string integrator;  // that suits the scene; "auto" selects it
  std::vector<PlanDecision> decisions;
};

// The integrator that suits the scene. Deterministic for a scene and its size; a few thousand rays.
PlanDecision ChooseIntegrator(const RenderScene& scene, const RenderSettings& settings);

// Deterministic for a scene and its settings.
ScenePlan PlanFor(const RenderScene& scene, const RenderSettings& settings);

}  // namespace lampyr
