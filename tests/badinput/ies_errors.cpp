// IES files that are none, lie about themselves or are cut off: each is refused with a place and a cure, none crashes
// or takes memory for what it only announces.
#include <cmath>
#include <cstring>
#include <random>

#include "scene/ies_profile.h"
#include "unit/scene/scene_support.h"

namespace lampyr {
namespace {

std::string IesError(const std::string& text) {
  return ErrorOf([&] { ParseIes(text, "a.ies"); });
}

// After the labels; line 3 begins here.
std::string WithNumbers(const std::string& numbers) {
  return "IESNA:LM-63-2002\nTILT=NONE\n" + numbers;
}

struct Case {
  std::string text;
  const char* where;
  const char* what;
};

TEST(IesErrors, SayWhereAndWhatWouldBeRight) {
  const Case cases[] = {
      {"", "a.ies:1:1", "TILT=NONE"},
      {"hello\nworld\n", "a.ies:3:1", "not an IES file"},
      {"\xff\xfeI\0E", "a.ies:1:1", "UTF-16"},
      {"IESNA91\nTILT=\n1", "a.ies:2:1", "NONE, INCLUDE"},
      {"IESNA91\nTILT=nowhere.tlt\n1", "a.ies:2:1", "nowhere.tlt"},
      {"IESNA91\nTILT=INCLUDE\n4 1 0 1\n", "a.ies:3:1", "1, 2 or 3"},
      {"IESNA91\nTILT=INCLUDE\n1 1000000 0 1\n", "a.ies:3:3", "room for at most"},
      {"IESNA91\nTILT=INCLUDE\n1 2 10 0 1 1\n", "a.ies:3:8", "ascend"},
      {"IESNA91\nTILT=INCLUDE\n1 1 0 -1\n", "a.ies:3:7", "tilt factor"},
      {WithNumbers(""), "a.ies:3:1", "the file ends where the number of lamps"},
      {WithNumbers("one"), "a.ies:3:1", "expected the number of lamps, a number, found \"one\""},
      {WithNumbers("1 -1 -2 2 1 1 2 0 0 0"), "a.ies:3:6", "candela multiplier is -2"},
      {WithNumbers("1 -1 nan 2 1 1 2 0 0 0"), "a.ies:3:6", "not a finite number"},
      {WithNumbers("1 -1 1e99 2 1 1 2 0 0 0"), "a.ies:3:6", "too large"},
      {WithNumbers("1 -1 1 -5 1 1 2 0 0 0"), "a.ies:3:8", "number of vertical angles has to be a whole number"},
      {WithNumbers("1 -1 1 1 1 1 2 0 0 0"), "a.ies:3:8", "at least 2"},
      {WithNumbers("1 -1 1 2.5 1 1 2 0 0 0"), "a.ies:3:8", "whole number"},
      {WithNumbers("1 -1 1 2 0 1 2 0 0 0"), "a.ies:3:10", "number of horizontal angles"},
      {WithNumbers("1 -1 1 2000000000 1 1 2 0 0 0"), "a.ies:3:8", "announces 2000000000 vertical angles"},
      {WithNumbers("1 -1 1 1e18 1e18 1 2 0 0 0"), "a.ies:3:8", "room"},
      {WithNumbers("1 -1 1 8 8 1 2 0 0 0\n1 1 1\n0 1 2 3 4 5 6 7\n0 1 2 3 4 5 6 7\n1 2 3"), "a.ies:3:10",
       "announces 64 candela values"},
      {WithNumbers("1 -1 1 2 1 4 2 0 0 0"), "a.ies:3:12", "1 (type C), 2 (type B) or 3 (type A)"},
      {WithNumbers("1 -1 1 2 1 1 2 0 0 0\n-1 1 1\n0 90 0 1 1"), "a.ies:4:1", "ballast factor"},
      {WithNumbers("1 -1 1 2 1 1 2 0 0 0\n1 1 1\n90 0\n0 1 1"), "a.ies:5:4", "ascend"},
      {WithNumbers("1 -1 1 2 1 1 2 0 0 0\n1 1 1\n0 0\n0 1 1"), "a.ies:5:3", "ascend"},
      {WithNumbers("1 -1 1 2 1 1 2 0 0 0\n1 1 1\n0 190\n0 1 1"), "a.ies:5:3", "between 0 and 180"},
      {WithNumbers("1 -1 1 2 1 3 2 0 0 0\n1 1 1\n0 120\n0 1 1"), "a.ies:5:3", "between -90 and 90"},
      {WithNumbers("1 -1 1 2 1 3 2 0 0 0\n1 1 1\n0 90\n0 1 1"), "a.ies:6:1", "at least 2 horizontal angles"},
      {WithNumbers("1 -1 1 2 2 1 2 0 0 0\n1 1 1\n0 90\n0 100\n1 1 1 1"), "a.ies:6:1", "90, 180 or 360"},
      {WithNumbers("1 -1 1 2 2 1 2 0 0 0\n1 1 1\n0 90\n20 90\n1 1 1 1"), "a.ies:6:1", "start at 0"},
      {WithNumbers("1 -1 1 2 3 1 2 0 0 0\n1 1 1\n0 90\n0 90.001 90.004\n1 1 1 1 1 1"), "a.ies:6:1", "too close"},
      {WithNumbers("1 -1 1 2 1 1 2 0 0 0\n1 1 1\n0 90\n0\n7 "), "a.ies:7:3", "candela value 2 of 2"},
      {WithNumbers("1 -1 1 2 1 1 2 0 0 0\n1 1 1\n0 90\n0\n7 inf"), "a.ies:7:3", "not a finite number"},
      {WithNumbers("1 -1 1e20 2 1 1 2 0 0 0\n1 1 1\n0 90\n0\n7 1e20"), "a.ies:7:3",
       "candela value 1e+20, times the file's multipliers 1e+20, is 1e+40: it has to be at most 1e30"},
  };
  for (const Case& c : cases) {
    const std::string error = IesError(c.text);
    EXPECT_NE(error.find(c.where), std::string::npos) << c.text << "\n" << error;
    EXPECT_NE(error.find(c.what), std::string::npos) << c.text << "\n" << error;
  }
  // A NUL is no number, and is not printed.
  const std::string binary = IesError(WithNumbers(std::string("1 -1 \0\x01\x02 2", 9)));
  EXPECT_NE(binary.find("\"???\""), std::string::npos) << binary;
}

TEST(IesErrors, MissingFilesAreReportedWhereTheyAreNamed) {
  const FileLocation where{std::make_shared<const std::string>("scene.pbrt"), 7, 9};
  const TemporaryFolder folder;
  const std::string missing = ErrorOf([&] { ReadIes((folder / "no.ies").string(), where); });
  EXPECT_NE(missing.find("scene.pbrt:7:9"), std::string::npos) << missing;
  EXPECT_NE(missing.find("no.ies"), std::string::npos) << missing;
  EXPECT_NE(ErrorOf([&] { ReadIes(folder.Write("x/y.ies", "").parent_path().string(), where); }), "no error");
  // An error within the file has its location there.
  const auto broken = folder.Write("broken.ies", "IESNA91\nTILT=NONE\nx");
  const std::string error = ErrorOf([&] { ReadIes(broken.string(), where); });
  EXPECT_NE(error.find("broken.ies:3:1"), std::string::npos) << error;
}

constexpr const char* kFiles[] = {
    "IESNA:LM-63-2002\n[TEST] 1\n[MORE] 2\nTILT=NONE\n1 -1 1.5 5 3 1 2 0.1 0.2 0.3\n1.0 1.0 40\n0 20.5 45 70 90\n"
    "0 45 90\n900 800 500 20 0\n900 700 300 10 0\n900 600 200 5 1\n",
    "IESNA91\nTILT=INCLUDE\n1\n3\n0 45 90\n1 0.9 0.8\n2 1800 1 4 3 1 1 0 0 0\n0.95 1 60\n90 120 150 180\n90 180 270\n"
    "1 2 3 4\n5 6 7 8\n9 10 11 12\n",
    "old style\nTILT=NONE\n1,1000,1,3,3,2,1,0,0,0\n1,1,10\n-90,0,90\n-90,0,90\n1,2,3\n4,5,6\n7,8,9\n",
};

std::string Damaged(std::string text, std::mt19937& random) {
  constexpr std::string_view kSpecial = "0123456789.-+eE, \n\r\t\0nNaAiI=\xff\x1a[";
  const int changes = 1 + static_cast<int>(random() % 3);
  for (int i = 0; i < changes && !text.empty(); ++i) {
    const size_t at = random() % text.size(), length = std::min<size_t>(random() % 24, text.size() - at);
    const char byte = kSpecial[random() % kSpecial.size()];
    switch (random() % 6) {
      case 0:
        text[at] = byte;
        break;
      case 1:
        text.insert(at, 1, byte);
        break;
      case 2:
        text.erase(at, 1 + random() % 2);
        break;
      case 3:
        text.erase(at, length);
        break;
      case 4:
        text.insert(random() % text.size(), text.substr(at, length));
        break;
      default:
        text.resize(random() % 8 == 0 ? at : text.size());
        break;
    }
  }
  return text;
}

TEST(IesFuzz, DamagedFilesAreReadOrRefused) {
  std::mt19937 random(1986);
  int read = 0, refused = 0;
  for (int i = 0; i < 6000; ++i) {
    const std::string text = Damaged(kFiles[random() % std::size(kFiles)], random);
    try {
      const auto profile = ParseIes(text, "fuzz.ies");
      ++read;
      ASSERT_TRUE(std::isfinite(profile->Power()) && profile->Power() >= 0) << text;
      for (int k = 0; k < 20; ++k) {
        const double theta = 3.2 * (random() % 1000) / 1000.0, phi = 7 * (random() % 1000) / 1000.0 - 0.5;
        const double candela = profile->Intensity(theta, phi);
        ASSERT_TRUE(candela >= 0 && candela <= profile->Largest() * (1 + 1e-12)) << text;
      }
    } catch (const Error& error) {
      ++refused;
      ASSERT_GT(error.Where().line, 0) << error.what() << "\n" << text;
      ASSERT_GT(error.Where().column, 0) << error.what() << "\n" << text;
    }
  }
  EXPECT_GT(read, 500);
  EXPECT_GT(refused, 1000);
  std::printf("[   info   ] %d read, %d refused\n", read, refused);
}

}  // namespace
}  // namespace lampyr
