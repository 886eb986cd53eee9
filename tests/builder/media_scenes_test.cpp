// The scenes of this repository that have participating media say everything that the builder asks for: no warning.
#include <gtest/gtest.h>

#include "render/build/scene_builder.h"
#include "scene/scene_description.h"

namespace lampyr {
namespace {

TEST(MediaScenes, AreBuiltWithoutWarnings) {
  for (const char* name : {"lighthouse", "underwater", "tea", "cloud"}) {
    Diagnostics diagnostics(Diagnostics::Mode::Collect);
    const std::string file = std::string(LAMPYR_SOURCE_DIR) + "/scenes/" + name + ".pbrt";
    const BuiltScene built = BuildScene(ReadScene(file, diagnostics), {}, true, diagnostics);
    EXPECT_FALSE(built.scene.media.empty()) << name;
    for (const auto& warning : diagnostics.Warnings()) ADD_FAILURE() << warning;
  }
}

}  // namespace
}  // namespace lampyr
