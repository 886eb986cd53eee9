// Scene statements have the meaning that they have in pbrt-v4.
#include <gmock/gmock.h>
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

// Statements that are not followed give a warning at their place.
TEST(Warnings, AreGivenForWhatIsNotDone) {
  const std::pair<const char*, const char*> cases[] = {
      {"Film \"rgb\" \"string filename\" \"a.png\" WorldBegin Shape \"sphere\"",
       "1:12: warning: pictures are written as"},
      {"Film \"rgb\" \"string filename\" \"a.0001\" WorldBegin Shape \"sphere\"", ""},
      {"Film \"rgb\" \"string sensor\" \"sony_ilce_9\" WorldBegin Shape \"sphere\"",
       "1:12: warning: the colours of the"},
      {"Film \"rgb\" \"string sensor\" \"cie1931\" WorldBegin Shape \"sphere\"", ""},
      {"Film \"rgb\" \"integer pixelbounds\" [9 0 0 2000] WorldBegin Shape \"sphere\"",
       "1:12: warning: \"pixelbounds\" reaches"},
      {"Film \"rgb\" \"integer pixelbounds\" [9 0 0 12] WorldBegin Shape \"sphere\"", ""},
      {"WorldBegin Material \"diffusetransmission\" \"rgb transmittance\" [1 .8 .7] Shape \"sphere\"",
       "1:43: warning: the surface scatters more light than it receives: reflectance and transmittance add up to 1.25"},
      {"WorldBegin Material \"diffusetransmission\" \"rgb transmittance\" [.75 .7 .7] Shape \"sphere\"", ""},
      {"MakeNamedMedium \"f\" \"string type\" \"homogeneous\" WorldBegin MediumInterface \"f\" Material \"interface\" "
       "Shape \"sphere\"",
       "1:101: warning: this shape of material \"interface\" has the same medium on both sides"},
      {"WorldBegin Material \"interface\" Shape \"sphere\" \"float alpha\" 0", ""},
  };
  for (const auto& [text, warning] : cases) {
    Diagnostics diagnostics(Diagnostics::Mode::Collect);
    BuildScene(
        ParseScene(std::string("LookAt 0 0 5 0 0 0 0 1 0 Camera \"perspective\"\n") + text, "test.pbrt", diagnostics),
        {}, true, diagnostics);
    std::string told;
    for (const std::string& each : diagnostics.Warnings()) told += each + "\n";
    if (*warning == 0) {
      EXPECT_EQ(told.find("test.pbrt:2"), std::string::npos) << text << "\n" << told;
    } else {
      EXPECT_THAT(told, testing::HasSubstr("test.pbrt:2" + std::string(warning + 1))) << text;
    }
  }
}

TEST(Cameras, WhatASphericalOneCannotDoIsTold) {
  const auto warningsOf = [](const std::string& text) {
    Diagnostics diagnostics(Diagnostics::Mode::Collect);
    BuildScene(ParseScene(text + "\nWorldBegin LightSource \"infinite\"", "test.pbrt", diagnostics), {}, true,
               diagnostics);
    std::string told;
    for (const std::string& each : diagnostics.Warnings()) told += each + "\n";
    return told;
  };
  EXPECT_THAT(warningsOf("Camera \"spherical\" \"float lensradius\" 2"),
              testing::HasSubstr("test.pbrt:1:20: warning: \"lensradius\" has no effect on a spherical camera"));
  for (const char* name : {"float focaldistance", "float frameaspectratio"})
    EXPECT_THAT(warningsOf("Camera \"spherical\" \"" + std::string(name) + "\" 2"),
                testing::HasSubstr("has no effect on a spherical camera"));
  EXPECT_EQ(warningsOf("Camera \"spherical\" \"string mapping\" \"equirectangular\""), "");
  const std::string wide =
      "Camera \"spherical\" Film \"rgb\" \"integer xresolution\" 8 \"integer yresolution\" 8\n"
      "PixelFilter \"box\" \"float xradius\" ";
  EXPECT_EQ(warningsOf(wide + "7"), "");
  try {
    warningsOf(wide + "8");
    ADD_FAILURE() << "a filter as wide as all directions";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("test.pbrt:2:1: error: the radius of the filter of a spherical"));
  }
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
