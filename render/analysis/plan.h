// What a scene requires, and what is therefore modelled: each decision with its reason. Facts about the scene and a few
// thousand rays, no pictures.
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
  std::string integrator;  // that suits the scene: what "auto" stands for
  std::vector<PlanDecision> decisions;
};

// Always the same for a scene and its settings.
ScenePlan PlanFor(const RenderScene& scene, const RenderSettings& settings);

}  // namespace lampyr
