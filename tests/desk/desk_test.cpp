// The lighting desk as its page uses it: what it refuses, what mixing shows, and that edits and kept scenes are what a
// fresh render of the same parameters is, byte by byte.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <csignal>
#include <string>
#include <thread>
#include <vector>

#include "film/image.h"
#include "support/desk_process.h"
#include "support/temporary_folder.h"

namespace lampyr::test {
namespace {

using Json = DeskProcess::Json;

class Desk : public testing::Test {
 protected:
  void SetUp() override {
    WriteBytes(folder_ / "scene.pbrt", kScene);
    WriteBytes(folder_ / "lights.pbrt", kLights);
  }

  // The picture that lampyr renders of the scene with these options.
  Image Rendered(const std::string& scene, const std::string& options = "--spp 4") {
    const Outcome outcome = RunLampyr(folder_.Path(), "render '" + scene + "' --quiet -o rendered.exr " + options);
    EXPECT_EQ(outcome.exitCode, 0) << outcome.output;
    return ReadImage(folder_ / "rendered.exr");
  }
  // The current state of the desk, written by *Keep*.
  Json Kept(const DeskProcess& desk, const Json& factors) {
    desk.WaitUntilDone();
    return desk.PostJson("keep", {{"factors", factors}});
  }
  Json Kept(const DeskProcess& desk) { return Kept(desk, desk.Neutral()); }

  // Expects the picture and its variances to be equal byte by byte.
  static void ExpectSamePicture(const Image& a, const Image& b) {
    const std::vector<std::string> channels = {"R", "G", "B", "variance.R", "variance.G", "variance.B"};
    const Image pictureA = ChannelsOf(a, channels), pictureB = ChannelsOf(b, channels);
    ASSERT_EQ(pictureA.channels.size(), channels.size());
    EXPECT_EQ(pictureA.data, pictureB.data);
  }
  static std::string Replaced(std::string text, const std::string& what, const std::string& by) {
    const size_t at = text.find(what);
    EXPECT_NE(at, std::string::npos) << what;
    return text.replace(at, what.size(), by);
  }

  static constexpr const char* kScene = R"(LookAt 0 1 3  0 0 0  0 1 0
Camera "perspective" "float fov" 40
Film "rgb" "integer xresolution" 48 "integer yresolution" 30
Sampler "sobol" "integer pixelsamples" 4
WorldBegin
LightSource "point" "rgb I" [4 4 4] "point3 from" [0 2 1]
# a comment with "quotes"
LightSource "spot" "rgb I" [ 9 8 7 ]   # and another
  "point3 from" [1 2 1] "point3 to" [ 0 0 0 ]
Attribute "light" "float intensity" 0.5
LightSource "infinite" "rgb L" [ 0.1 0.1 0.2 ]
AttributeBegin
  Translate 0 1.5 -1
  LightFilter "intmult" "float intensity" 0.8
  LightSource "rect" "float width" 0.5
AttributeEnd
Include "lights.pbrt"
Shape "trianglemesh" "point3 P" [-5 0 -5 -5 0 5 5 0 5 5 0 -5] "integer indices" [0 1 2 0 2 3]
)";
  static constexpr const char* kLights = R"(AttributeBegin
AreaLightSource "diffuse" "rgb L" [ 1 0.5 0.2 ]
Translate -1 0.5 0
Shape "sphere" "float radius" 0.2
AttributeEnd
)";
  TemporaryFolder folder_;
};

TEST_F(Desk, AnswersThoseAloneWhoKnowTheToken) {
  const DeskProcess desk(folder_.Path(), "scene.pbrt --quiet --spp 1");
  ASSERT_GT(desk.Port(), 0) << desk.Address();
  ASSERT_EQ(desk.Token().size(), 32u);
  const std::string page = "/" + desk.Token() + "/", port = ":" + std::to_string(desk.Port());
  const DeskReply good = desk.Send("GET", page);
  EXPECT_EQ(good.status, 200);
  EXPECT_NE(good.body.find("<title>lampyr desk</title>"), std::string::npos);
  EXPECT_NE(good.headers.find("default-src 'none'"), std::string::npos) << good.headers;
  EXPECT_EQ(desk.Send("GET", page, "", "", "localhost" + port).status, 200);
  std::string other = desk.Token();
  other[7] = other[7] == '0' ? '1' : '0';
  for (const std::string& path : {std::string("/"), std::string("/state"), std::string("/../etc/passwd"),
                                  "/" + other + "/", "/" + other + "/state", "/" + desk.Token(),
                                  page + "../../etc/passwd", page + "scene.pbrt", page + "desk.html", page + "x"}) {
    const DeskReply refused = desk.Send("GET", path);
    EXPECT_EQ(refused.status, 404) << path;
    EXPECT_EQ(refused.body, "") << path;
  }
  for (const std::string& host : {"evil.example" + port, std::string("127.0.0.1"), "127.0.0.1:1" + port.substr(1),
                                  "127.0.0.1" + port + ".evil.example", std::string("localhost")})
    EXPECT_EQ(desk.Send("GET", page + "state", "", "", host).status, 403) << host;
  EXPECT_EQ(desk.Send("GET " + page + " HTTP/1.1\r\nConnection: close\r\n\r\n").status, 403);
  EXPECT_EQ(desk.Send("GET", page, "", "Host: 127.0.0.1" + port + "\r\n").status, 403);
}

TEST_F(Desk, RefusesWhatOtherPagesSend) {
  const DeskProcess desk(folder_.Path(), "scene.pbrt --quiet --spp 1");
  const std::string path = "/" + desk.Token() + "/pause", port = ":" + std::to_string(desk.Port());
  for (const std::string& origin : {std::string("http://evil.example"), "https://127.0.0.1" + port, std::string("null"),
                                    std::string("http://127.0.0.1"), "http://127.0.0.1" + port + "0"})
    EXPECT_EQ(desk.Send("POST", path, "{\"on\": true}", "Origin: " + origin + "\r\n").status, 403) << origin;
  EXPECT_FALSE(desk.Get("state").at("isPaused").get<bool>());
  EXPECT_EQ(desk.Send("POST", path, "{\"on\": true}", "Origin: http://localhost" + port + "\r\n").status, 200);
  EXPECT_TRUE(desk.Get("state").at("isPaused").get<bool>());
  EXPECT_EQ(desk.Send("DELETE", path).status, 405);
  EXPECT_EQ(desk.Send("POST", path, "{").status, 422);
  EXPECT_EQ(desk.Send("POST", path, "[]").status, 422);
}

TEST_F(Desk, EndsOnASignal) {
  for (const int signal : {SIGINT, SIGTERM}) {
    DeskProcess desk(folder_.Path(), "scene.pbrt --quiet");
    ASSERT_GT(desk.Port(), 0);
    EXPECT_EQ(desk.End(signal), 0);
  }
}

// Also while something waits for a first pass, which never ends.
TEST_F(Desk, EndsWhileASceneIsToBeKept) {
  WriteBytes(
      folder_ / "white.pbrt",
      "Camera \"perspective\" \"float fov\" 60\nFilm \"rgb\" \"integer xresolution\" 16 \"integer yresolution\" 16\n"
      "Integrator \"path\" \"integer maxdepth\" 1000000000\nWorldBegin\nLightSource \"point\" \"point3 from\" "
      "[0 0.3 0.2]\nMaterial \"diffuse\" \"rgb reflectance\" [1 1 1]\nShape \"sphere\" \"float radius\" 2\n");
  DeskProcess desk(folder_.Path(), "white.pbrt --quiet");
  const Json neutral = desk.Neutral();
  std::thread keeps([&] { (void)desk.Post("keep", {{"factors", neutral}}); });
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  EXPECT_EQ(desk.End(SIGINT), 0);
  keeps.join();
}

// With all faders where they are, the screen shows the picture that is rendered.
TEST_F(Desk, MixesThePictureOfAllLights) {
  const DeskProcess desk(folder_.Path(), "scene.pbrt --quiet --spp 4");
  desk.WaitUntilDone();
  const DeskReply reply = desk.Post("picture", {{"factors", desk.Neutral()}, {"exposure", 1}, {"clip", false}});
  ASSERT_EQ(reply.status, 200);
  EXPECT_NE(reply.headers.find("X-Lampyr: 48 30 "), std::string::npos) << reply.headers;
  ASSERT_EQ(reply.body.size(), size_t{48} * 30 * 4);
  const Image rendered = Rendered("scene.pbrt", "--spp 4 --png --exposure 1");
  const Image png = ReadImage(folder_ / "rendered.png", ImageEncoding::Linear);
  for (int y = 0; y < 30; ++y) {
    for (int x = 0; x < 48; ++x) {
      for (int c = 0; c < 3; ++c) {
        const auto shown = static_cast<unsigned char>(reply.body[static_cast<size_t>(4 * (48 * y + x) + c)]);
        EXPECT_NEAR(shown, 255 * static_cast<double>(png.At(x, y, static_cast<size_t>(c))), 1.01) << x << ", " << y;
      }
    }
  }
  const Json pixel = desk.PostJson("pixel", {{"factors", desk.Neutral()}, {"x", 20}, {"y", 20}});
  EXPECT_NEAR(pixel.at("value").at(1).get<double>(), static_cast<double>(rendered.At(20, 20, 1)), 1e-6);
  const double deviation = std::sqrt(static_cast<double>(rendered.At(20, 20, 4)));
  EXPECT_NEAR(pixel.at("interval").at(1).get<double>(), 1.96 * deviation, 1e-6);
}

// The desk keeps the sums of the last mix and adds what has changed. Whatever came before, the screen shows the same.
TEST_F(Desk, MovesLeaveNoTrace) {
  const DeskProcess desk(folder_.Path(), "scene.pbrt --quiet --spp 4"),
      fresh(folder_.Path(), "scene.pbrt --quiet --spp 4");
  desk.WaitUntilDone();
  fresh.WaitUntilDone();
  const auto screen = [](const DeskProcess& of, const Json& factors) {
    return of.Post("picture", {{"factors", factors}, {"exposure", 1}, {"clip", false}}).body;
  };
  const Json neutral = desk.Neutral();
  const std::string first = screen(desk, neutral);
  Json factors = neutral;
  for (size_t i = 0; i < 100; ++i) {
    const double values[] = {1e6, 0, 0.3, 1e-3, 7};
    factors[i % factors.size()] = {values[i % 5], values[(i + 1) % 5], values[i % 3]};
    screen(desk, factors);
  }
  factors[0] = {0, 0, 0};
  factors[1] = {0.25, 1, 2};
  const std::string after = screen(desk, factors);
  EXPECT_EQ(after, screen(fresh, factors));
  EXPECT_NE(after, first);
  EXPECT_EQ(screen(desk, neutral), first);
}

// A factor scales a light's share alone, and the interval is not known then.
TEST_F(Desk, MixesByFactors) {
  const DeskProcess desk(folder_.Path(), "scene.pbrt --quiet --spp 4");
  desk.WaitUntilDone();
  const auto value = [&](const Json& factors) {
    return desk.PostJson("pixel", {{"factors", factors}, {"x", 20}, {"y", 20}}).at("value").at(0).get<double>();
  };
  const Json neutral = desk.Neutral();
  Json none = neutral, tripled = neutral;
  none[1] = {0, 0, 0};
  tripled[1] = {3, 3, 3};
  const double all = value(neutral), without = value(none);
  EXPECT_LT(without, all);
  EXPECT_NEAR(value(tripled), without + 3 * (all - without), 1e-5 * all);
  EXPECT_TRUE(desk.PostJson("pixel", {{"factors", none}, {"x", 20}, {"y", 20}}).at("interval").is_null());
  EXPECT_EQ(desk.Post("picture", {{"factors", Json::array()}, {"exposure", 0}, {"clip", true}}).status, 422);
  EXPECT_EQ(desk.Post("pixel", {{"factors", neutral}, {"x", 48}, {"y", 0}}).status, 422);
}

TEST_F(Desk, AnEditedSpotIsThatOfAFreshRender) {
  const DeskProcess desk(folder_.Path(), "scene.pbrt --quiet --spp 4");
  const size_t spot = desk.StatementAt("scene.pbrt:8");
  const Json restarted = desk.Edit(spot, "coneangle", {17.5});
  EXPECT_EQ(restarted.at("restart"), 2);
  EXPECT_EQ(desk.Parameter(spot, "coneangle").at("numbers"), Json({17.5}));
  EXPECT_TRUE(desk.Parameter(spot, "coneangle").at("isEdited").get<bool>());
  const Image shown = ReadImage(Kept(desk).at("picture").get<std::string>());
  WriteBytes(folder_ / "edited.pbrt", Replaced(kScene, "\"spot\"", "\"spot\" \"float coneangle\" 17.5"));
  ExpectSamePicture(shown, Rendered("edited.pbrt"));
}

// All kinds of edits: of points, of surfaces of lights, of shapes that emit, in an included file, of what an Attribute
// gives, of a filter; one after the other and taken back.
TEST_F(Desk, KeptScenesRenderToTheSameBytes) {
  const DeskProcess desk(folder_.Path(), "scene.pbrt --quiet --spp 4");
  const size_t point = desk.StatementAt("scene.pbrt:6"), rect = desk.StatementAt("scene.pbrt:15"),
               sky = desk.StatementAt("scene.pbrt:11"), ball = desk.StatementAt("lights.pbrt:2"),
               filter = desk.StatementAt("scene.pbrt:14");
  desk.Edit(point, "from", {0.3, 1.25, 0.1 + 0.2});
  desk.Edit(rect, "color", {0.9, 0.5, 0.125});
  desk.Edit(rect, "width", {0.9});
  desk.Edit(ball, "L", {3, 2, 1});
  desk.Edit(ball, "cameraVisible", {0});
  desk.Edit(sky, "intensity", {0.7});
  desk.Edit(filter, "intensity", {0.3});
  desk.Edit(point, "scale", {5});
  desk.PostJson("reset", {{"statement", point}, {"parameter", "scale"}});
  EXPECT_EQ(desk.Parameter(point, "scale").at("numbers"), Json({1}));
  const Json kept = Kept(desk);
  ASSERT_EQ(kept.at("scenes").size(), 2u);
  EXPECT_EQ(kept.at("scenes").at(1), (folder_ / "scene.desk.pbrt").string());
  const std::string text = ReadBytes(folder_ / "scene.desk.pbrt");
  for (const char* part :
       {"# a comment with \"quotes\"", "\"point3 from\" [ 0.3 1.25 0.30000000000000004 ]",
        "Include \"lights.desk.pbrt\"", "\"float width\" 0.9", "\"infinite\" \"float intensity\" 0.7"})
    EXPECT_NE(text.find(part), std::string::npos) << part << " in\n" << text;
  EXPECT_EQ(text.find("float scale"), std::string::npos) << text;
  ExpectSamePicture(ReadImage(kept.at("picture").get<std::string>()), Rendered("scene.desk.pbrt"));
  // Nothing is overwritten.
  const Json again = Kept(desk);
  EXPECT_EQ(again.at("scenes").at(1), (folder_ / "scene.desk-2.pbrt").string());
  EXPECT_EQ(ReadBytes(folder_ / "scene.desk.pbrt"), text);
}

TEST_F(Desk, FadersAreSetIntoTheLights) {
  const DeskProcess desk(folder_.Path(), "scene.pbrt --quiet --spp 4");
  Json factors = desk.Neutral();
  factors[0] = {2, 1, 0.5};
  factors[1] = {0, 0, 0};
  factors[2] = {3, 3, 3};
  // The picture is mixed; its scene has the factors in its lights.
  const Json mixed = Kept(desk, factors);
  const Image picture = ReadImage(mixed.at("picture").get<std::string>());
  EXPECT_LT(picture.ChannelIndex("variance.R"), 0);
  desk.PostJson("set", {{"factors", factors}});
  const Json kept = Kept(desk);
  EXPECT_EQ(ReadBytes(mixed.at("scenes").at(0).get<std::string>()),
            ReadBytes(kept.at("scenes").at(0).get<std::string>()));
  const Image rendered = Rendered("scene.desk.pbrt");
  ExpectSamePicture(ReadImage(kept.at("picture").get<std::string>()), rendered);
  // The mixed picture is the same up to noise.
  double sumMixed = 0, sumRendered = 0;
  for (int y = 0; y < 30; ++y) {
    for (int x = 0; x < 48; ++x) {
      sumMixed += static_cast<double>(picture.RgbAt(x, y).Average());
      sumRendered += static_cast<double>(rendered.RgbAt(x, y).Average());
    }
  }
  EXPECT_NEAR(sumMixed, sumRendered, 0.1 * sumRendered);
}

// Where nothing but a medium shines, the only fader is that of all light.
TEST_F(Desk, AGlowAloneIsMixedToo) {
  WriteBytes(folder_ / "glow.pbrt", R"(LookAt 0 0 3  0 0 0  0 1 0
Camera "perspective" "float fov" 40
Film "rgb" "integer xresolution" 24 "integer yresolution" 15
WorldBegin
MakeNamedMedium "glow" "string type" "homogeneous" "rgb sigma_a" [1 1 1] "rgb sigma_s" [0 0 0] "rgb Le" [1 1 1]
MediumInterface "glow" ""
Material "interface"
Shape "sphere"
)");
  const DeskProcess desk(folder_.Path(), "glow.pbrt --quiet --spp 4");
  const Image plain = ReadImage(Kept(desk, {{1, 1, 1}}).at("picture").get<std::string>());
  const Json kept = Kept(desk, {{4, 2, 1}});
  EXPECT_EQ(kept.at("notes").size(), 1u);
  const Image mixed = ReadImage(kept.at("picture").get<std::string>());
  const Color before = plain.RgbAt(12, 7), after = mixed.RgbAt(12, 7);
  EXPECT_GT(before.r, 0);
  EXPECT_EQ(after, before * Color(4, 2, 1));
  const auto variance = [](const Image& image) {
    return image.At(12, 7, static_cast<size_t>(image.ChannelIndex("variance.R")));
  };
  EXPECT_FLOAT_EQ(variance(mixed), 16 * variance(plain));
  EXPECT_EQ(desk.PostJson("set", {{"factors", {{4, 4, 4}}}}).at("notes").size(), 1u);
}

TEST_F(Desk, MistakesAreToldAndChangeNothing) {
  const DeskProcess desk(folder_.Path(), "scene.pbrt --quiet --spp 4");
  desk.WaitUntilDone();
  const size_t spot = desk.StatementAt("scene.pbrt:8"), rect = desk.StatementAt("scene.pbrt:15"),
               filter = desk.StatementAt("scene.pbrt:14");
  const auto mistake = [&](size_t statement, const char* parameter, const Json& value, const char* key = "numbers") {
    const DeskReply reply = desk.Post("edit", {{"statement", statement}, {"parameter", parameter}, {key, value}});
    EXPECT_EQ(reply.status, 422) << reply.body;
    return reply.body;
  };
  EXPECT_NE(mistake(spot, "coneangle", {200}).find("out of range: (0,180] is allowed"), std::string::npos);
  EXPECT_NE(mistake(spot, "I", {-1, 1, 1}).find("negative"), std::string::npos) << mistake(spot, "I", {-1, 1, 1});
  EXPECT_NE(mistake(spot, "from", {1, 2}).find("3 numbers are wanted"), std::string::npos);
  EXPECT_NE(mistake(spot, "from", {1, 2, nullptr}).find("a number is wanted"), std::string::npos);
  EXPECT_NE(mistake(spot, "conangle", {2}).find("has no parameter"), std::string::npos);
  EXPECT_NE(mistake(spot, "name", "x", "text").find("is edited in the scene's file"), std::string::npos);
  EXPECT_NE(mistake(spot, "shaping:ies:file", "/etc/passwd", "text").find("is edited in the scene's file"),
            std::string::npos);
  EXPECT_NE(mistake(rect, "width", {0}).find("out of range"), std::string::npos);
  EXPECT_NE(mistake(filter, "combineMode", "melt", "text").find("melt"), std::string::npos);
  EXPECT_NE(mistake(99, "coneangle", {20}).find("no such light"), std::string::npos);
  EXPECT_EQ(desk.Get("state").at("restart"), 1);
  EXPECT_EQ(desk.Parameter(spot, "coneangle").at("numbers"), Json({30}));
  const Json kept = Kept(desk);
  EXPECT_EQ(ReadBytes(kept.at("scenes").at(0).get<std::string>()), kScene);
  ExpectSamePicture(ReadImage(kept.at("picture").get<std::string>()), Rendered("scene.pbrt"));
}

// Light groups are faders; what auto chooses is chosen anew, photons and light paths know the edited light, and what is
// learned between passes is what a render learns.
TEST_F(Desk, WorksWithGroupsAndOtherIntegrators) {
  std::string grouped = Replaced(kScene, "\"point\"", "\"point\" \"string lightGroup\" \"key\"");
  grouped = Replaced(grouped, "\"spot\"", "\"spot\" \"string lightGroup\" \"key\"");
  WriteBytes(folder_ / "grouped.pbrt", grouped);
  for (const std::string integrator :
       {"auto --spp 4", "bdpt --spp 4", "vcm --spp 19", "sppm --spp 9", "path --learn-always --spp 70"}) {
    SCOPED_TRACE(integrator);
    const std::string options = "--seed 7 --integrator " + integrator;
    const DeskProcess desk(folder_.Path(), "grouped.pbrt --quiet " + options);
    const Json faders = desk.Get("lights").at("faders");
    ASSERT_EQ(faders.size(), 2u);
    EXPECT_EQ(faders.at(0).at("label"), "key");
    EXPECT_EQ(faders.at(0).at("statements").size(), 2u);
    EXPECT_EQ(faders.at(1).at("label"), "rest");
    desk.Edit(desk.StatementAt("grouped.pbrt:8"), "coneangle", {12});
    desk.Edit(desk.StatementAt("lights.pbrt:2"), "scale", {4});
    const Json kept = Kept(desk);
    ExpectSamePicture(ReadImage(kept.at("picture").get<std::string>()),
                      Rendered(kept.at("scenes").at(1).get<std::string>(), options));
  }
}

// The guide of a pixel is a density over all directions, and is largest towards the wall that lights the floor.
TEST_F(Desk, ShowsWhereAPixelsPathsGo) {
  // The floor is lit by a spot behind a wall, by way of the wall at x = -2: the picture has that on the right.
  WriteBytes(folder_ / "indirect.pbrt", R"(LookAt 0 1 4  0 0.5 0  0 1 0
Camera "perspective" "float fov" 40
Film "rgb" "integer xresolution" 48 "integer yresolution" 32
Sampler "sobol" "integer pixelsamples" 16
WorldBegin
Material "diffuse" "rgb reflectance" [ 0.8 0.8 0.8 ]
Shape "bilinearmesh" "point3 P" [ -2 0 -2  2 0 -2  -2 0 2  2 0 2 ]
Shape "bilinearmesh" "point3 P" [ -2 0 -2  -2 0 2  -2 3 -2  -2 3 2 ]
Shape "bilinearmesh" "point3 P" [ 1 0 -2  1 0 2  1 2 -2  1 2 2 ]
LightSource "spot" "rgb I" [ 200 200 200 ] "point3 from" [ 2 2.5 0 ] "point3 to" [ -2 2 0 ] "float coneangle" 12
)");
  const DeskProcess desk(folder_.Path(), "indirect.pbrt --quiet --integrator path --spp 16 --guide-always");
  desk.WaitUntilDone();
  const Json guide = desk.PostJson("guide", {{"x", 24}, {"y", 22}});
  ASSERT_TRUE(guide.at("isGuided").get<bool>()) << guide.dump().substr(0, 300);
  EXPECT_TRUE(guide.at("isUsed").get<bool>());
  EXPECT_GT(guide.at("share").get<double>(), 0);
  EXPECT_GT(guide.at("regions").get<int>(), 0);
  const int columns = guide.at("columns").get<int>(), rows = guide.at("rows").get<int>();
  const auto densities = guide.at("densities").get<std::vector<double>>();
  ASSERT_EQ(densities.size(), static_cast<size_t>(columns * rows));
  constexpr double kPiExact = 3.14159265358979323846;
  double all = 0, right = 0;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const double solidAngle =
          2 * kPiExact / columns * (kPiExact / rows) * std::cos(kPiExact * ((row + 0.5) / rows - 0.5));
      const double part = densities[static_cast<size_t>(row * columns + column)] * solidAngle;
      all += part;
      if (column >= columns / 2) right += part;
    }
  }
  EXPECT_NEAR(all, 1, 0.05);
  EXPECT_GT(right, 0.8 * all);
  for (int x = 2; x < 48; x += 4) {
    const Json other = desk.PostJson("guide", {{"x", x}, {"y", 26}});
    EXPECT_EQ(other.at("isGuided").get<bool>(), other.at("share").get<double>() > 0) << x;
  }
  // The background has no walks.
  EXPECT_FALSE(desk.PostJson("guide", {{"x", 24}, {"y", 0}}).at("isGuided").get<bool>());
  const DeskProcess unguided(folder_.Path(), "indirect.pbrt --quiet --integrator path --spp 2 --no-guide-paths");
  unguided.WaitUntilDone();
  const Json none = unguided.PostJson("guide", {{"x", 24}, {"y", 22}});
  EXPECT_FALSE(none.at("isLearned").get<bool>());
  EXPECT_FALSE(none.at("isGuided").get<bool>());
}

TEST_F(Desk, ToldMistakesOfTheCommandLine) {
  const Outcome missing = RunLampyr(folder_.Path(), "desk nothing.pbrt");
  EXPECT_EQ(missing.exitCode, 2) << missing.output;
  const Outcome wrong = RunLampyr(folder_.Path(), "desk scene.pbrt --prot 8");
  EXPECT_EQ(wrong.exitCode, 2);
  EXPECT_NE(wrong.output.find("did you mean \"--port\"?"), std::string::npos) << wrong.output;
  const DeskProcess desk(folder_.Path(), "scene.pbrt --quiet --spp 1");
  const Outcome taken = RunLampyr(folder_.Path(), "desk scene.pbrt --port " + std::to_string(desk.Port()));
  EXPECT_NE(taken.exitCode, 0);
  EXPECT_NE(taken.output.find("cannot be used"), std::string::npos) << taken.output;
}

// Edits are written into the files that were read. If these have changed meanwhile, nothing is kept.
TEST_F(Desk, KeepsNothingOfFilesThatHaveChanged) {
  const DeskProcess desk(folder_.Path(), "scene.pbrt --quiet --spp 1");
  desk.WaitUntilDone();
  EXPECT_EQ(desk.Post("keep", {{"factors", desk.Neutral()}}).status, 200);
  WriteBytes(folder_ / "lights.pbrt", std::string(kLights) + "# changed\n");
  const DeskReply reply = desk.Post("keep", {{"factors", desk.Neutral()}});
  EXPECT_EQ(reply.status, 422);
  EXPECT_NE(reply.body.find("have changed"), std::string::npos) << reply.body;
}

// A file that is included twice, under other attributes each time, and by other names: one statement, whose lights keep
// what is their own.
TEST_F(Desk, StatementsThatAreReadTwiceAreOne) {
  WriteBytes(folder_ / "lamp.pbrt", "LightSource \"point\" \"rgb I\" [1 2 3] \"point3 from\" [0 1 1]\n");
  std::filesystem::create_directory(folder_ / "sub");
  WriteBytes(folder_ / "twice.pbrt",
             "Film \"rgb\" \"integer xresolution\" 16 \"integer yresolution\" 10\nLookAt 0 1 3  0 0 0  0 1 0\n"
             "Camera \"perspective\"\nWorldBegin\nInclude \"lamp.pbrt\"\n"
             "AttributeBegin Translate 1 0 0 Attribute \"light\" \"float intensity\" 3 Include \"sub/../lamp.pbrt\" "
             "AttributeEnd\n"
             "Shape \"sphere\" \"float radius\" 0.5\n");
  const DeskProcess desk(folder_.Path(), "twice.pbrt --quiet --spp 4");
  const Json statements = desk.Get("lights").at("statements");
  ASSERT_EQ(statements.size(), 1u);
  EXPECT_EQ(statements[0].at("lights").get<int>(), 2);
  Json half = desk.Neutral();
  for (Json& factor : half) factor = {0.5, 0.5, 0.5};
  EXPECT_EQ(desk.Post("set", {{"factors", half}}).status, 422);
  EXPECT_EQ(desk.Post("edit", {{"statement", 0}, {"parameter", "scale"}, {"numbers", {2}}}).status, 200);
  EXPECT_EQ(desk.Post("edit", {{"statement", 0.5}, {"parameter", "scale"}, {"numbers", {2}}}).status, 422);
  EXPECT_EQ(desk.Post("edit", {{"statement", 1e30}, {"parameter", "scale"}, {"numbers", {2}}}).status, 422);
  const Json kept = Kept(desk);
  ExpectSamePicture(ReadImage(kept.at("picture").get<std::string>()),
                    Rendered(kept.at("scenes").back().get<std::string>()));
}

}  // namespace
}  // namespace lampyr::test
