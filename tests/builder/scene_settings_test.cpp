// Scene statements have the meaning that they have in pbrt-v4.
#include <gtest/gtest.h>

#include "scene/referenced_files.h"
#include "spectral/color_space.h"
#include "support/render_scene.h"
#include "support/temporary_folder.h"

namespace lampyr::test {
namespace {

// The background of a scene whose sky is one colour.
Color Background(const std::string& world) {
  const Image image =
      RenderText(
          "Film \"rgb\" \"integer xresolution\" 4 \"integer yresolution\" 4 Camera \"perspective\" WorldBegin " + world,
          1)
          .image;
  return image.RgbAt(1, 1);
}

// A light that names no colour has the white of its colour space: the same as if it were written out.
TEST(ColorSpaces, LightsWithoutAColourHaveTheirWhite) {
  for (const std::string space : {"srgb", "dci-p3", "rec2020", "aces2065-1"}) {
    const std::string begin = "ColorSpace \"" + space + "\" LightSource \"infinite\" ";
    const Color named = Background(begin + "\"rgb L\" [1 1 1]"), unnamed = Background(begin);
    EXPECT_NEAR(unnamed.r, named.r, 1e-6f) << space;
    EXPECT_NEAR(unnamed.g, named.g, 1e-6f) << space;
    EXPECT_NEAR(unnamed.b, named.b, 1e-6f) << space;
  }
  EXPECT_GT(Background("ColorSpace \"aces2065-1\" LightSource \"infinite\"").r, 1.03f);
}

// The tilt of an IES profile is in a file of its own, which a render must not overwrite and which parts depend on.
TEST(ReferencedFiles, HoldTheTiltOfProfiles) {
  const TemporaryFolder folder;
  WriteBytes(folder / "a.tlt", "1 1 0 1");
  WriteBytes(folder / "a.ies", "IESNA91\nTILT=a.tlt\n1 -1 1 2 1 1 2 0 0 0 1 1 1 0 90 0 5 5");
  Diagnostics diagnostics(Diagnostics::Mode::Collect);
  const SceneDescription scene =
      ParseScene("WorldBegin LightSource \"point\" \"string ies:file\" \"" + (folder / "a.ies").string() + "\"",
                 "test.pbrt", diagnostics);
  EXPECT_EQ(ReferencedFiles(scene),
            (std::vector<std::string>{(folder / "a.ies").string(), (folder / "a.tlt").string()}));
}

// Fractions are those of floats, and bounds may be in any order.
TEST(CropWindow, IsThatOfPbrt) {
  for (const std::string window : {"[0 0.55 0 1]", "[0.55 0 0 1]", "[0.55 0 1 0]"}) {
    Diagnostics diagnostics(Diagnostics::Mode::Collect);
    const SceneDescription scene =
        ParseScene("Film \"rgb\" \"integer xresolution\" 100 \"integer yresolution\" 4 \"float cropwindow\" " + window +
                       " Camera \"perspective\" WorldBegin",
                   "test.pbrt", diagnostics);
    const RenderSettings settings = ReadRenderSettings(scene, {}, diagnostics);
    EXPECT_EQ(settings.crop.Width(), 55) << window;
    EXPECT_EQ(settings.crop.Height(), 4) << window;
  }
}

}  // namespace
}  // namespace lampyr::test
