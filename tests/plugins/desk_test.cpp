// A plugin's light on the lighting desk: edited as any other, because its own Edit is what is called.
#include <gtest/gtest.h>

#include "film/image.h"
#include "plugins/plugins_fixture.h"
#include "support/desk_process.h"

namespace lampyr::test {
namespace {

using PluginsOnTheDesk = Plugins;

TEST_F(PluginsOnTheDesk, EditAndKeepARing) {
  Write("scene.pbrt", SceneWith(kRing));
  const std::string plugin = " --plugin '" + RingPlugin().string() + "'";
  const DeskProcess desk(folder_.Path(), "scene.pbrt --quiet --spp 4" + plugin);
  ASSERT_GT(desk.Port(), 0) << desk.Address();
  const DeskProcess::Json lights = desk.Get("lights");
  ASSERT_EQ(lights.at("statements").size(), 1u);
  EXPECT_EQ(lights.at("statements").at(0).at("type"), "ring");
  desk.Edit(0, "outerRadius", {0.8});
  desk.Edit(0, "intensity", {2.5});
  const DeskReply wrong =
      desk.Post("edit", {{"statement", 0}, {"parameter", "innerRadius"}, {"numbers", std::vector<double>{0.9}}});
  EXPECT_EQ(wrong.status, 422);
  EXPECT_NE(wrong.body.find("innerRadius must be less than outerRadius"), std::string::npos) << wrong.body;
  desk.WaitUntilDone();
  const DeskProcess::Json kept = desk.PostJson("keep", {{"factors", desk.Neutral()}});
  ASSERT_EQ(kept.at("scenes").size(), 1u);
  ASSERT_EQ(Run("render scene.desk.pbrt --quiet --spp 4 -o rendered.exr" + plugin).exitCode, 0);
  const std::vector<std::string> channels = {"R", "G", "B", "variance.R", "variance.G", "variance.B"};
  const Image shown = ChannelsOf(ReadImage(kept.at("picture").get<std::string>()), channels);
  ASSERT_EQ(shown.channels.size(), channels.size());
  EXPECT_EQ(shown.data, ChannelsOf(ReadImage(folder_ / "rendered.exr"), channels).data);
}

}  // namespace
}  // namespace lampyr::test
