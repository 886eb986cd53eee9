#include "fuzz/target_support.h"
#include "support/render_scene.h"

namespace lampyr::fuzz {

bool BuildSceneText(std::string_view bytes) {
  Diagnostics diagnostics(Diagnostics::Mode::Collect);
  return AcceptErrors([&] {
    const SceneDescription description = ParseScene(std::string(bytes), SceneName(), diagnostics);
    RenderOverrides overrides;
    overrides.width = overrides.height = 3;
    overrides.values["max-depth"] = 3;
    overrides.values["photons"] = 9;
    overrides.values["photon-memory"] = 1 << 24;
    overrides.memory = 1 << 25;  // a million emitting triangles take half a minute under sanitizers
    test::RenderBuilt(BuildScene(description, overrides, true, diagnostics), 1, 1);
  });
}

}  // namespace lampyr::fuzz
