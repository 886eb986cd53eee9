// IES files of every edition, symmetry and photometric type, against candela computed by hand.
#include "scene/ies_profile.h"

#include "scene_support.h"

namespace lampyr {
namespace {

constexpr double kPi = 3.14159265358979323846;

double At(const IesProfile& profile, double theta, double phi) {
  return profile.Intensity(theta * kPi / 180, phi * kPi / 180);
}

// The numbers after TILT=NONE: multiplier 2, two vertical angles (0 and 90), one plane, ballast 0.5, a third factor.
std::string Numbers(const std::string& thirdFactor) {
  return "1 1000 2 2 1 1 2 0.1 0.1 0.1\n0.5 " + thirdFactor + " 40\n0 90\n0\n10 20\n";
}

// A 2002 file of multiplier 1.
std::string File(const std::string& vertical, const std::string& horizontal, const std::string& candela, int type = 1) {
  const auto count = [](const std::string& numbers) {
    return std::to_string(1 + std::count(numbers.begin(), numbers.end(), ' '));
  };
  return "IESNA:LM-63-2002\n[TEST] own\n[MANUFAC] nobody\nTILT=NONE\n1 -1 1 " + count(vertical) + " " +
         count(horizontal) + " " + std::to_string(type) + " 2 0 0 0\n1 1 10\n" + vertical + "\n" + horizontal + "\n" +
         candela + "\n";
}

TEST(Ies, EditionsDifferInTheThirdFactor) {
  // 10 cd · 2 · 0.5 = 10; up to 1991 the ballast-lamp photometric factor, here 1.5, multiplies as well.
  const std::pair<const char*, double> editions[] = {
      {"Downlight by nobody\nNo 12\nTILT=NONE\n", 15},  // 1986: no first line of its own
      {"TILT=NONE\n", 15},
      {"IESNA91\n[TEST] 1\n[DATE] x\n[MORE] y\nTILT=NONE\n", 15},
      {"IESNA:LM-63-1995\n[TEST] 1\n[MANUFAC] n\n[_OWN] z\nTILT=NONE\n", 10},
      {"IESNA:LM-63-2002\n[TEST] 1\n[TESTLAB] n\n[ISSUEDATE] z\n[MANUFAC] n\nTILT=NONE\n", 10},
      {"IES:LM-63-2019\n[TEST] 1\nTILT=NONE\n", 10},
  };
  for (const auto& [labels, expected] : editions) {
    const auto profile = ParseIes(labels + Numbers("1.5"), "a.ies");
    EXPECT_NEAR(At(*profile, 0, 0), expected, 1e-12) << labels;
    EXPECT_NEAR(At(*profile, 45, 200), 1.5 * expected, 1e-12) << labels;
    EXPECT_NEAR(profile->Largest(), 2 * expected, 1e-12) << labels;
  }
}

TEST(Ies, SeparatorsAndLineEnds) {
  const char* texts[] = {
      "IESNA:LM-63-1995\r\nTILT=NONE\r\n1,1000,1,2,1,1,2,0,0,0\r\n1,1,1\r\n0,90\r\n0\r\n3,4\r\n",
      "IESNA:LM-63-1995\rTILT=NONE\r1 1000 1 2 1 1 2 0 0 0 1 1 1 0 90 0 3 4",
      "\xef\xbb\xbfIESNA:LM-63-1995\n  tilt = none \n1 1000 1 2 1 1 2 0 0 0 1 1 1\n\n\t0, 90\n0 3.0e0\n+4.",
      "IESNA:LM-63-1995\nTILT=NONE\n1 1000 1 2 1 1 2 0 0 0 1 1 1 0 90 0 3 4 and what follows\n\x1a",
  };
  for (const char* text : texts) {
    const auto profile = ParseIes(text, "a.ies");
    EXPECT_EQ(At(*profile, 0, 0), 3) << text;
    EXPECT_EQ(At(*profile, 90, 0), 4) << text;
  }
}

TEST(Ies, TiltIsOfTheLuminaireNotOfTheDirection) {
  // Factors over tilt: 0.9 at -10°, 0.5 at 10°; at a tilt of 0 it is 0.7, in all directions.
  const std::string tilt = "1\n2\n-10 10\n0.9 0.5\n";
  const auto included = ParseIes("IESNA91\nTILT=INCLUDE\n" + tilt + Numbers("1"), "a.ies");
  EXPECT_NEAR(At(*included, 0, 0), 7, 1e-12);
  EXPECT_NEAR(At(*included, 90, 0), 14, 1e-12);
  // Usual tables begin at 0° with a factor of 1.
  EXPECT_NEAR(At(*ParseIes("IESNA91\nTILT=INCLUDE\n2 3 0 45 90 1 0.8 0.6 " + Numbers("1"), "a.ies"), 45, 0), 15, 1e-12);

  const TemporaryFolder folder;
  folder.Write("lamp.tlt", tilt);
  const auto file = folder.Write("a.ies", "IESNA91\nTILT=lamp.tlt\n" + Numbers("1"));
  EXPECT_NEAR(At(*ReadIes(file.string(), {}), 0, 0), 7, 1e-12);
}

// Wrong counts, or decimal commas, would make another lamp of the same numbers. Remarks and an end of file of DOS are
// none.
TEST(Ies, NumbersThatAreLeftOverAreAnError) {
  const std::string right = File("0 45 90", "0", "1000 900 0");
  const auto error = [&](const std::string& text) -> std::string {
    try {
      ParseIes(text, "a.ies");
    } catch (const Error& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_EQ(error(right + "\x1a"), "");
  EXPECT_EQ(error(right + "END\n"), "");
  EXPECT_EQ(error(right + "2x36W T8\n"), "");
  EXPECT_NE(error(right + "5 6\n").find("a.ies:10:1: error: the file has more than the 3 candela values"),
            std::string::npos)
      << error(right + "5 6\n");
  EXPECT_NE(error(File("0 45 90", "0", "1000,5 900,5 0,0")).find("decimal commas"), std::string::npos);
}

TEST(Ies, OnePlaneStandsForAll) {
  const auto profile = ParseIes(File("0 30 90", "0", "10 40 0"), "a.ies");
  for (const double phi : {0.0, 91.0, 359.9, 360.0, -45.0}) {
    EXPECT_NEAR(At(*profile, 15, phi), 25, 1e-12);
    EXPECT_NEAR(At(*profile, 60, phi), 20, 1e-12);
  }
  EXPECT_EQ(profile->Phis().size(), 2u);
}

TEST(Ies, PlanesAreMirrored) {
  // Values at θ = 90° are 1 and what is written; at 0° all planes have 0.
  const auto at90 = [](const std::string& horizontal, const std::string& candela, double phi) {
    return At(*ParseIes(File("0 90", horizontal, candela), "a.ies"), 90, phi);
  };
  // 0°-90°: 10 at 0°, 20 at 90°, in all quadrants.
  for (const double phi : {45.0, 135.0, 225.0, 315.0}) EXPECT_NEAR(at90("0 90", "0 10 0 20", phi), 15, 1e-12) << phi;
  EXPECT_NEAR(at90("0 90", "0 10 0 20", 180), 10, 1e-12);
  EXPECT_NEAR(at90("0 90", "0 10 0 20", 270), 20, 1e-12);
  // 0°-180°: 10, 20, 60.
  EXPECT_NEAR(at90("0 90 180", "0 10 0 20 0 60", 135), 40, 1e-12);
  EXPECT_NEAR(at90("0 90 180", "0 10 0 20 0 60", 225), 40, 1e-12);
  EXPECT_NEAR(at90("0 90 180", "0 10 0 20 0 60", 270), 20, 1e-12);
  // 0°-360°: as it is.
  EXPECT_NEAR(at90("0 90 180 270 360", "0 1 0 2 0 3 0 9 0 1", 315), 5, 1e-12);
  EXPECT_NEAR(at90("0 90 180 270 360", "0 1 0 2 0 3 0 9 0 1", 135), 2.5, 1e-12);
  // Without the plane at 360°.
  EXPECT_NEAR(at90("0 90 180 270", "0 1 0 2 0 3 0 9", 315), 5, 1e-12);
  // 90°-270°: 5 at 90°, 7 at 180°, 11 at 270°; mirrored at the plane through 90° and 270°, so that 0° is as 180°.
  EXPECT_NEAR(at90("90 180 270", "0 5 0 7 0 11", 180), 7, 1e-12);
  EXPECT_NEAR(at90("90 180 270", "0 5 0 7 0 11", 0), 7, 1e-12);
  EXPECT_NEAR(at90("90 180 270", "0 5 0 7 0 11", 45), 6, 1e-12);
  EXPECT_NEAR(at90("90 180 270", "0 5 0 7 0 11", 315), 9, 1e-12);
  EXPECT_NEAR(at90("90 180 270", "0 5 0 7 0 11", 225), 9, 1e-12);
  // The same without a plane at 180°: 0° lies between 300° (mirrored from 240°, 7) and 60° (from 120°, 5).
  EXPECT_NEAR(at90("90 120 240 270", "0 4 0 5 0 7 0 8", 0), 6, 1e-12);
  EXPECT_NEAR(at90("90 120 240 270", "0 4 0 5 0 7 0 8", 30), 5.5, 1e-12);
  EXPECT_NEAR(at90("90 120 240 270", "0 4 0 5 0 7 0 8", 330), 6.5, 1e-12);
  EXPECT_NEAR(at90("90 120 240 270", "0 4 0 5 0 7 0 8", 75), 4.5, 1e-12);
}

TEST(Ies, BeyondTheMeasuredAnglesItIsDark) {
  const auto down = ParseIes(File("0 90", "0", "5 5"), "a.ies"), up = ParseIes(File("90 180", "0", "5 5"), "a.ies");
  EXPECT_EQ(At(*down, 90, 0), 5);
  EXPECT_EQ(At(*down, 90.001, 0), 0);
  EXPECT_EQ(At(*up, 90, 0), 5);
  EXPECT_EQ(At(*up, 89.999, 0), 0);
  EXPECT_EQ(At(*up, 180, 0), 5);
  EXPECT_EQ(At(*ParseIes(File("0 90 180", "0", "5 -3 5"), "a.ies"), 90, 0), 0);  // negative candela are none
}

TEST(Ies, PowerIsTheIntegralOfTheInterpolation) {
  const auto power = [](const std::string& text) { return ParseIes(text, "a.ies")->Power(); };
  EXPECT_NEAR(power(File("0 180", "0", "1 1")), 4 * kPi, 1e-12);
  EXPECT_NEAR(power(File("0 90", "0", "1 1")), 2 * kPi, 1e-12);
  EXPECT_NEAR(power(File("90 180", "0 90", "1 1 1 1")), 2 * kPi, 1e-12);
  // 1 at 0°, falling to 0 at 180°: 2π ∫ (1 - θ/π) sinθ dθ = 2π (2 - 1).
  EXPECT_NEAR(power(File("0 180", "0", "1 0")), 2 * kPi, 1e-12);
  // 0 at 60°, 3 at 90°, dark elsewhere: 2π · 3/h · ∫ (θ - π/3) sinθ dθ = 2π · 3/h · (sin 90° - sin 60°), h = π/6.
  EXPECT_NEAR(power(File("60 90", "0", "0 3")), 2 * kPi * 3 / (kPi / 6) * (1 - std::sqrt(0.75)), 1e-12);
  // 2 in one half turn and a mean of 5 in the other: hemisphere.
  EXPECT_NEAR(power(File("0 90", "0 180 360", "2 2 2 2 8 8")), kPi * 2 + kPi * 5, 1e-12);
  // A beam of 0.001°: π θ² / 3 for a cone.
  const double angle = 0.001 * kPi / 180;
  EXPECT_NEAR(power(File("0 0.001", "0", "1 0")) / (kPi * angle * angle / 3), 1, 1e-6);
}

// 200 + h + 2 v candela up to 45° to each side: the values that the grid of type C gives have to be those of the
// direction's own angles, forward being the nadir and up φ = 0 (so that right is φ = 270°).
TEST(Ies, TypesAAndBFaceForward) {
  const std::string values = "65 245 155 335";
  const auto typeA = ParseIes(File("-45 45", "-45 45", values, 3), "a.ies");
  const auto typeB = ParseIes(File("-45 45", "-45 45", values, 2), "a.ies");
  for (const auto& profile : {typeA, typeB}) {
    EXPECT_NEAR(At(*profile, 0, 0), 200, 1e-9);
    EXPECT_NEAR(At(*profile, 20, 0), 240, 0.1);    // v = 20
    EXPECT_NEAR(At(*profile, 20, 180), 160, 0.1);  // v = -20
    EXPECT_NEAR(At(*profile, 20, 270), 220, 0.1);  // h = 20
    EXPECT_NEAR(At(*profile, 20, 90), 180, 0.1);   // h = -20
    EXPECT_EQ(At(*profile, 60, 0), 0);
    EXPECT_EQ(At(*profile, 120, 0), 0);
  }
  // h = 30°, v = 20°. A: forward cos v cos h = 0.813798, right cos v sin h = 0.469846, up sin v = 0.342020.
  EXPECT_NEAR(At(*typeA, 35.5323, 306.0531), 270, 0.1);
  // B: right sin h = 0.5, up cos h sin v = 0.296198.
  EXPECT_NEAR(At(*typeB, 35.5323, 300.6428), 270, 0.1);
  // Angles from 0° are mirrored: 10 + |h| + 2 |v|.
  const auto mirrored = ParseIes(File("0 45", "0 45", "10 100 55 145", 2), "a.ies");
  for (const double phi : {300.6428, 180 - 300.6428, -300.6428, 180 + 300.6428})
    EXPECT_NEAR(At(*mirrored, 35.5323, phi), 80, 0.2) << phi;
}

TEST(Ies, KnotsAscendOverTheFullCircle) {
  for (const char* horizontal : {"0", "0 90", "0 45 180", "0 180 360", "90 100 270"}) {
    std::string candela = "1 2";
    for (const char* c = horizontal; *c; ++c) candela += *c == ' ' ? " 1 2" : "";
    const auto profile = ParseIes(File("0 90", horizontal, candela), "a.ies");
    EXPECT_TRUE(std::is_sorted(profile->Phis().begin(), profile->Phis().end())) << horizontal;
    EXPECT_EQ(profile->Phis().front(), 0) << horizontal;
    EXPECT_EQ(profile->Phis().back(), 2 * kPi) << horizontal;
  }
}

// The profiles of the scenes, against values that can be read off the files.
TEST(Ies, ProfilesOfTheScenes) {
  const auto read = [](const char* name) {
    return ReadIes(LAMPYR_SOURCE_DIR "/scenes/profiles/" + std::string(name), {});
  };
  const auto downlight = read("downlight.ies");
  EXPECT_EQ(At(*downlight, 0, 0), 1585);
  EXPECT_EQ(At(*downlight, 90, 77), 0);
  EXPECT_NEAR(At(*downlight, 47.5, 77), 41.6, 1e-9);  // between 54.3 at 45° and 28.9 at 50°
  // 0.95 is the ballast factor; the wings are across the lamps.
  const auto batwing = read("batwing.ies");
  EXPECT_NEAR(At(*batwing, 0, 0), 0.95 * 340, 1e-9);
  EXPECT_GT(At(*batwing, 35, 90), 2 * At(*batwing, 35, 0));
  EXPECT_NEAR(At(*batwing, 35, 90), At(*batwing, 35, 270), 1e-9);
  const auto wallwasher = read("wallwasher.ies");
  EXPECT_EQ(At(*wallwasher, 40, 0), 1607);
  EXPECT_GT(At(*wallwasher, 40, 0), 10 * At(*wallwasher, 40, 180));
  EXPECT_NEAR(At(*wallwasher, 40, 60), At(*wallwasher, 40, 300), 1e-9);
  for (const auto& profile : {downlight, batwing, wallwasher}) {
    EXPECT_GT(profile->Power(), 500);
    EXPECT_LT(profile->Power(), 3000);
  }
}

}  // namespace
}  // namespace lampyr
