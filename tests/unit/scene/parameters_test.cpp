// Reading parameters: values, defaults, and what is wrong said with its place.
#include <gmock/gmock.h>

#include <chrono>

#include "unit/scene/scene_support.h"

namespace lampyr {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

// The parameters of a Shape "s" at line 2; the first parameter is at column 11.
ParameterList Read(const std::string& parameters) {
  return Parse(InWorld("Shape \"s\" " + parameters)).shapes.at(0).shape.parameters;
}

TEST(Parameters, EveryType) {
  const ParameterList list =
      Read(R"("float f" 1.5 "integer i" -3 "bool b" true "bool q" [ "false" ] "string s" "x" "point2 p2" [ 1 2 ]
    "vector2 v2" [ 3 4 ] "point3 p3" [ 1 2 3 ] "vector3 v3" [ 4 5 6 ] "normal n" [ 0 0 1 0 1 0 ] "rgb c" [ .1 .2 .3 ]
    "spectrum e" "metal-Au-eta" "blackbody k" 6500 "texture t" "wood")");
  EXPECT_EQ(list.GetFloat("f", 0), 1.5);
  EXPECT_EQ(list.GetInteger("i", 0), -3);
  EXPECT_TRUE(list.GetBool("b", false));
  EXPECT_FALSE(list.GetBool("q", true));
  EXPECT_EQ(list.GetString("s", ""), "x");
  EXPECT_EQ(list.GetPoint2("p2", {}), Point2d(1, 2));
  EXPECT_THAT(list.GetPoint2s("v2"), ElementsAre(Point2d(3, 4)));
  EXPECT_EQ(list.GetPoint3("p3", {}), Point3d(1, 2, 3));
  EXPECT_EQ(list.GetVector3("v3", {}), Vector3d(4, 5, 6));
  EXPECT_THAT(list.GetPoint3s("n"), ElementsAre(Point3d(0, 0, 1), Point3d(0, 1, 0)));
  EXPECT_EQ(list.GetColor("c", {}, SpectrumRole::Albedo), Color(0.1f, 0.2f, 0.3f));
  EXPECT_EQ(list.GetTextureName("t"), "wood");
  EXPECT_EQ(list.GetTextureName("f"), std::nullopt);
  EXPECT_EQ(list.FindColor("absent", SpectrumRole::Albedo), std::nullopt);
  EXPECT_EQ(list.GetFloat("absent", 7), 7);
  EXPECT_TRUE(list.FindColor("e", SpectrumRole::Unbounded).has_value());
  EXPECT_TRUE(list.FindColor("k", SpectrumRole::Illuminant).has_value());
  Diagnostics strict(Diagnostics::Mode::Strict);
  list.CheckAllUsed({}, {}, strict);
}

TEST(Parameters, Lists) {
  const ParameterList list = Read(
      "\"float f\" [ 1 2 3 ] \"integer i\" [ 1 -2 ] \"string s\" [ \"a\" \"b\" ] \"bool b\" [ true false ]"
      " \"rgb c\" [ 1 0 0 0 1 0 ]");
  EXPECT_THAT(list.GetFloats("f"), ElementsAre(1, 2, 3));
  EXPECT_THAT(list.GetIntegers("i"), ElementsAre(1, -2));
  EXPECT_THAT(list.GetStrings("s"), ElementsAre("a", "b"));
  EXPECT_EQ(list.GetBools("b"), (std::vector<bool>{true, false}));
  EXPECT_THAT(list.GetColors("c", SpectrumRole::Albedo), ElementsAre(Color(1, 0, 0), Color(0, 1, 0)));
  EXPECT_TRUE(list.GetFloats("absent").empty());
}

TEST(Parameters, WrongTypeAndCountNameThePlace) {
  EXPECT_EQ(ErrorOf([] { Read("\"string radius\" \"x\"").GetFloat("radius", 1); }),
            "scene.pbrt:2:11: error: \"radius\" of Shape \"s\": expected float, found string");
  EXPECT_EQ(ErrorOf([] { Read("\"point3 P\" [ 1 2 ]").GetPoint3("P", {}); }),
            "scene.pbrt:2:11: error: \"P\" of Shape \"s\" needs 3 values, has 2");
  EXPECT_EQ(ErrorOf([] { Read("\"point3 P\" [ 1 2 3 4 ]").GetPoint3s("P"); }),
            "scene.pbrt:2:11: error: \"P\" of Shape \"s\" needs a multiple of 3 values, has 4");
  EXPECT_EQ(ErrorOf([] { Read("\"float f\" [ ]").GetFloat("f", 0); }),
            "scene.pbrt:2:11: error: \"f\" of Shape \"s\" has no values");
  EXPECT_EQ(ErrorOf([] { Read("\"float f\" [ 1 2 ]").GetFloat("f", 0); }),
            "scene.pbrt:2:11: error: \"f\" of Shape \"s\" needs 1 value, has 2");
  EXPECT_EQ(ErrorOf([] { Read("\"integer i\" [ 1 2 ]").GetInteger("i", 0); }),
            "scene.pbrt:2:11: error: \"i\" of Shape \"s\" needs 1 value, has 2");
  EXPECT_EQ(ErrorOf([] { Read("\"float c\" 1").GetColor("c", {}, SpectrumRole::Albedo); }),
            "scene.pbrt:2:11: error: \"c\" of Shape \"s\": expected rgb, spectrum or blackbody, found float");
  EXPECT_EQ(ErrorOf([] { Read("\"rgb c\" [ 1 1 ]").GetColor("c", {}, SpectrumRole::Albedo); }),
            "scene.pbrt:2:11: error: \"c\" of Shape \"s\" needs 3 values, has 2");
  EXPECT_EQ(ErrorOf([] { Read("\"rgb c\" [ 1 -1 1 ]").GetColor("c", {}, SpectrumRole::Illuminant); }),
            "scene.pbrt:2:11: error: \"c\" of Shape \"s\" has a negative component");
  EXPECT_THAT(ErrorOf([] { Read("\"rgb c\" [ 1 1.5 1 ]").GetColor("c", {}, SpectrumRole::Albedo); }),
              StartsWith("scene.pbrt:2:11: error: \"c\" of Shape \"s\" has a component above 1"));
  EXPECT_THAT(ErrorOf([] { Read("\"blackbody c\" 0").GetColor("c", {}, SpectrumRole::Illuminant); }),
              HasSubstr("above 0 K"));
}

TEST(Parameters, UnusedOnesAreFound) {
  const ParameterList list = Read("\"float radious\" 2");
  Diagnostics diagnostics(Diagnostics::Mode::Collect);
  EXPECT_EQ(ErrorOf([&] {
              list.CheckAllUsed({}, {"radius", "zmin"}, diagnostics);
            }),
            "scene.pbrt:2:11: error: Shape \"s\" has no parameter \"radious\" (did you mean \"radius\"?)");
  list.CheckAllUsed({"radious"}, {"radius"}, diagnostics);
  list.CheckAllUsed({}, {"radious"}, diagnostics);
  EXPECT_THAT(diagnostics.Warnings(),
              ElementsAre("scene.pbrt:2:11: warning: \"radious\" of Shape \"s\" is not supported yet: it is ignored",
                          "scene.pbrt:2:11: warning: \"radious\" of Shape \"s\" has no effect here"));
}

TEST(Parameters, FilesAreFoundBesideTheSceneThenBesideTheWriter) {
  const TemporaryFolder folder;
  folder.Write(
      "sub/inner.pbrt",
      "Shape \"a\" \"string filename\" \"mesh.ply\"\nShape \"b\" \"string filename\" \"sub/mesh.ply\"\n"
      "Shape \"c\" \"string filename\" \"nowhere.ply\" Shape \"d\" \"string filename\" \"/abs/m.ply\" Shape \"e\"");
  folder.Write("sub/mesh.ply", "");
  const auto scene = folder.Write("scene.pbrt", "WorldBegin Include \"sub/inner.pbrt\"");
  Diagnostics strict(Diagnostics::Mode::Strict);
  const SceneDescription description = ReadScene(scene, strict);
  const auto file = [&](size_t i) { return description.shapes.at(i).shape.parameters.GetFile("filename"); };
  EXPECT_EQ(file(0), (folder / "sub/mesh.ply").string());
  EXPECT_EQ(file(1), (folder / "sub/mesh.ply").string());
  EXPECT_EQ(file(2), (folder / "nowhere.ply").string());
  EXPECT_EQ(file(3), "/abs/m.ply");
  EXPECT_EQ(file(4), "");
}

TEST(Parameters, LongListsAreReadFast) {
  std::string text = "WorldBegin\nShape \"trianglemesh\" \"point3 P\" [";
  constexpr int kCount = 1'000'000;
  for (int i = 0; i < kCount; ++i) text += i % 3 == 2 ? " -0.00012345\n" : " 12.345678";
  text += " ]";
  const auto begin = std::chrono::steady_clock::now();
  const SceneDescription scene = Parse(text);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
  const Parameter* parameter = scene.shapes.at(0).shape.parameters.Find("P");
  ASSERT_EQ(parameter->numbers.size(), static_cast<size_t>(kCount));
  EXPECT_LE(parameter->numbers.capacity(), static_cast<size_t>(kCount) * 5 / 4);
  EXPECT_EQ(parameter->numbers.back(), 12.345678);
  const double rate = double(text.size()) / 1e6 / seconds.count();
  RecordProperty("megabytesPerSecond", std::to_string(rate));
  std::printf("[   info   ] %.0f MB/s\n", rate);
}

}  // namespace
}  // namespace lampyr
