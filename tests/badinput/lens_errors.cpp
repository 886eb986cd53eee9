// Lens files that are none, or of lenses that cannot be made: each is refused with a place and a cure.
#include <gtest/gtest.h>

#include <random>

#include "camera/lens_file.h"
#include "render/build/scene_builder.h"
#include "scene/scene_description.h"
#include "unit/scene/scene_support.h"

namespace lampyr {
namespace {

std::string LensError(const std::string& text) {
  return ErrorOf([&] { ParseLensFile(text, "a.dat"); });
}

const std::string kStop = "0 2 0 10\n";
const std::string kLens = "# a lens\n40 3 1.5 20 # front\n\n-40 2 1 20\n0 60 0 8\n";

struct Case {
  std::string text;
  const char* where;
  const char* what;
};

TEST(LensErrors, SayWhereAndWhatWouldBeRight) {
  const Case cases[] = {
      {"", "a.dat:1:1", "has no numbers"},
      {"# nothing\n\n  # more\n", "a.dat:4:1", "has no numbers"},
      {"hello\n", "a.dat:1:1", "1 number: a surface has four"},
      {"1 2 3\n", "a.dat:1:1", "3 numbers"},
      {kStop + "  1 2 3 4 5\n", "a.dat:2:3", "more than 4 numbers"},
      {kStop + "40 x 1.5 20\n", "a.dat:2:4", "expected a thickness, a number, found \"x\""},
      {kStop + "40 3,5 1.5 20\n", "a.dat:2:4", "\"3,5\""},
      {kStop + "nan 3 1.5 20\n", "a.dat:2:1", "a radius of curvature is not finite"},
      {kStop + "40 inf 1.5 20\n", "a.dat:2:4", "a thickness is not finite"},
      {kStop + "1e99 3 1.5 20\n", "a.dat:2:1", "too large"},
      {kStop + "1e10 3 1.5 20\n", "a.dat:2:1", "at most 1e9"},
      {kStop + "40 -3 1.5 20\n", "a.dat:2:4", "from 0 to 1e9"},
      {kStop + "40 3 0.9 20\n", "a.dat:2:6", "from 1 (air) to 10"},
      {kStop + "40 3 -1.5 20\n", "a.dat:2:6", "from 1 (air) to 10"},
      {kStop + "40 3 1.5 0\n", "a.dat:2:10", "above 0"},
      {kStop + "40 3 1.5 -20\n", "a.dat:2:10", "above 0"},
      {kStop + "40 3 1.5 81\n", "a.dat:2:10", "does not fit a sphere with a radius of 40 mm: it has to be at most 80"},
      {"40 3 1.5 20\r\n-40 60 1 20\r\n", "a.dat:3:1", "no aperture stop"},
      {"40 5 1.5 20\r-40 60 1 20\r", "a.dat:3:1", "no aperture stop"},
      {kStop + kStop, "a.dat:2:1", "a second aperture stop (a radius of curvature of 0); the first is in line 1"},
      {"40 3 1.5 20\n0 2 0 10\n-40 60 1 20\n", "a.dat:2:5", "refracts nothing"},
      {"0 2 1.5 10\n", "a.dat:1:5", "refracts nothing"},
      {kStop + "40 3 1.5 20\n-40 60 1.5 20\n", "a.dat:3:8", "the film is in glass"},
      {kStop + "20 1 1.5 20\n-20 60 1 20\n", "a.dat:2:4", "overlaps the next one (line 3): 10 mm from the axis"},
      {"-20 1 1 20\n0 30 0 20\n-20 1 1.5 20\n20 30 1 20\n", "none", "no error"},
      {"20 1 1 20\n0 30 0 20\n", "a.dat:1:4", "overlaps the next one (line 2)"},
      {std::string("0 2 0\0 10", 9), "a.dat:1:5", "\"0?\""},
  };
  for (const Case& c : cases) {
    const std::string error = LensError(c.text);
    if (std::string(c.where) != "none") {
      EXPECT_NE(error.find(c.where), std::string::npos) << c.text << "\n" << error;
    }
    EXPECT_NE(error.find(c.what), std::string::npos) << c.text << "\n" << error;
  }
  EXPECT_EQ(LensError(kLens), "no error");
  std::string many = kStop;
  for (int i = 0; i < 127; ++i) many += "100 1 1 10\n";
  EXPECT_EQ(LensError(many), "no error");
  EXPECT_NE(LensError(many + "100 1 1 10\n").find("a.dat:129:1: error: the lens has more than 128 surfaces"),
            std::string::npos);
  // The thickness that the message asks for is enough.
  const std::string overlap = LensError(kStop + "20 1 1.5 20\n-20 60 1 20\n");
  const std::string least = overlap.substr(overlap.find("at least ") + 9, 5);
  EXPECT_EQ(LensError(kStop + "20 " + least + " 1.5 20\n-20 60 1 20\n"), "no error") << least;
}

TEST(LensErrors, DamagedFilesAreReadOrRefused) {
  std::mt19937 random(1);
  constexpr std::string_view kSpecial("0123456789.-+eE \n\r\t\0nN#\xff,i", 26);
  int refused = 0;
  for (int round = 0; round < 20000; ++round) {
    std::string text = kLens;
    for (unsigned i = random() % 4; i < 4 && !text.empty(); ++i) {
      const size_t at = random() % text.size();
      const char byte = kSpecial[random() % kSpecial.size()];
      if (random() % 2 == 0) {
        text[at] = byte;
      } else {
        text.insert(at, text.substr(at, random() % 9) + byte);
      }
    }
    try {
      const LensPrescription lens = ParseLensFile(text, "a.dat");
      ASSERT_GT(lens.Stop().apertureRadius, 0);
    } catch (const Error& error) {
      ++refused;
      ASSERT_NE(std::string(error.what()).find("a.dat:"), std::string::npos) << error.what();
    }
  }
  EXPECT_GT(refused, 1000);
  EXPECT_LT(refused, 19000);
}

// Errors of the camera's statement, and of the files that it names.
TEST(LensErrors, AreReportedForScenes) {
  const TemporaryFolder folder;
  folder.Write("lens.dat", kLens);
  folder.Write("diverging.dat", "0 2 0 10\n-40 1 1.5 20\n40 30 1 20\n");
  folder.Write("dark.dat", "0 60 0 1\n1e6 1 1.5 2\n-30 30 1 2\n");
  folder.Write("broken.dat", "40 3\n");
  folder.Write("shape.png", "no image");
  const auto build = [&](const std::string& camera, const std::string& film = "") {
    Diagnostics diagnostics(Diagnostics::Mode::Collect);
    const std::string error = ErrorOf([&] {
      BuildScene(ParseScene("Film \"rgb\" \"integer xresolution\" 4 \"integer yresolution\" 4 " + film +
                                "\nCamera \"realistic\" " + camera + "\nWorldBegin\nShape \"sphere\"\n",
                            (folder / "s.pbrt").string(), diagnostics),
                 {}, true, diagnostics);
    });
    std::string all = error;
    for (const std::string& warning : diagnostics.Warnings()) all += "\n" + warning;
    return all;
  };
  const std::string lens = "\"string lensfile\" \"lens.dat\" ";
  const Case cases[] = {
      {"", "s.pbrt:2:1", "needs a \"string lensfile\""},
      {"\"string lensfile\" \"none.dat\"", "s.pbrt:2:20", "none.dat"},
      {"\"string lensfile\" \"broken.dat\"", "broken.dat:1:1", "2 numbers"},
      {"\"string lensfile\" \"diverging.dat\"", "s.pbrt:2:20", "spreads light"},
      {lens + "\"float focusdistance\" 0.05", "s.pbrt:2:20", "it has to be at least"},
      {lens + "\"float focusdistance\" 0", "s.pbrt:2:", "\"focusdistance\" must be above 0"},
      {lens + "\"float aperturediameter\" -1", "s.pbrt:2:", "\"aperturediameter\" must be above 0"},
      {lens + "\"float aperturediameter\" 9", "s.pbrt:2:", "the lens's stop opens to 8 mm, which is used"},
      {lens + "\"float focaldistance\" 9", "s.pbrt:2:", "did you mean \"focusdistance\"?"},
      {lens + "\"string aperture\" \"pentagram\"", "s.pbrt:2:", "did you mean \"pentagon\"?"},
      {lens + "\"string aperture\" \"shape.png\"", "s.pbrt:2:", "shape.png"},
      {lens + "\"string aperture\" \"star\"", "no error", ""},
  };
  for (const Case& c : cases) {
    const std::string said = build(c.text);
    EXPECT_NE(said.find(c.where), std::string::npos) << c.text << "\n" << said;
    EXPECT_NE(said.find(c.what), std::string::npos) << c.text << "\n" << said;
  }
  EXPECT_NE(build(lens, "\"float diagonal\" 0").find("\"diagonal\" must be above 0"), std::string::npos);
}

}  // namespace
}  // namespace lampyr
