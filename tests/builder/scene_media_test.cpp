// Participating media in built scenes: the sides of shapes, and what camera and lights are in.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "geometry/medium_at.h"
#include "support/render_scene.h"

namespace lampyr::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr int32_t kAir = 0, kFog = 1, kMilk = 2;

const std::string kMedia =
    "MakeNamedMedium \"air\" \"string type\" \"homogeneous\"\nMakeNamedMedium \"fog\" \"string type\" "
    "\"homogeneous\"\nMakeNamedMedium \"milk\" \"string type\" \"homogeneous\"\n";

struct Scene {
  BuiltScene built;
  std::vector<std::string> warnings;

  const RenderScene& Render() const { return built.scene; }
  const GeometryAttributes& Attributes(uint32_t primitive) const { return built.scene.geometry->Attributes(primitive); }
};

// `options` stand before the camera, which is at the origin and looks along z. Line 5 is the first of `world`.
Scene Build(const std::string& world, const std::string& options = "") {
  Diagnostics diagnostics(Diagnostics::Mode::Collect);
  const std::string text = kMedia + options +
                           " Film \"rgb\" \"integer xresolution\" 4 \"integer yresolution\" 4 Camera \"perspective\" "
                           "MediumInterface \"\" WorldBegin\n" +
                           world;
  Scene scene;
  const SceneDescription description = ParseScene(text, "test.pbrt", diagnostics);
  scene.built = BuildScene(description, {}, true, diagnostics);
  for (const std::string& warning : diagnostics.Warnings()) {
    if (warning.find("the scene has no light") == std::string::npos) scene.warnings.push_back(warning);
  }
  return scene;
}

std::string ErrorOf(const std::string& world) {
  try {
    Build(world);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

std::string Sphere(float radius) {
  return "Shape \"sphere\" \"float radius\" " + std::to_string(radius) + "\n";
}

const std::string kInterface = "Material \"interface\" ";

TEST(SceneMedia, AreOnTheSidesOfShapes) {
  const Scene scene = Build("MediumInterface \"fog\" \"milk\"\n" + Sphere(1) + kInterface + Sphere(2) +
                            "MediumInterface \"\" \"air\"\n" + Sphere(3) + "Material \"diffuse\" " + Sphere(4) +
                            "MediumInterface \"air\"\n" + Sphere(5));
  ASSERT_EQ(scene.Render().geometry->PrimitiveCount(), 5u);
  EXPECT_TRUE(scene.Render().geometry->HasBoundaries());
  const struct {
    int32_t inside, outside;
    bool isBoundary;
  } expected[] = {{kFog, kMilk, false},
                  {kFog, kMilk, true},
                  {kVacuum, kAir, true},
                  {kVacuum, kAir, false},
                  {kSameMedium, kSameMedium, false}};
  for (uint32_t i = 0; i < 5; ++i) {
    EXPECT_EQ(scene.Attributes(i).insideMedium, expected[i].inside) << i;
    EXPECT_EQ(scene.Attributes(i).outsideMedium, expected[i].outside) << i;
    EXPECT_EQ(scene.Attributes(i).isBoundary, expected[i].isBoundary) << i;
  }
}

// As without media, rays pass them, and they do not enlarge the scene.
TEST(SceneMedia, InterfacesBetweenTheSameAreLeftOut) {
  const Scene scene =
      Build(Sphere(1) + kInterface + Sphere(2) + "MediumInterface \"fog\"\n" + Sphere(3) +
            "MediumInterface \"fog\" \"\" " + "Shape \"sphere\" \"float radius\" 4 \"float alpha\" 0\n");
  EXPECT_EQ(scene.Render().geometry->PrimitiveCount(), 1u);
  EXPECT_FALSE(scene.Render().geometry->HasBoundaries());
  EXPECT_EQ(scene.Render().geometry->GetBounds().max.x, Build(Sphere(1)).Render().geometry->GetBounds().max.x);
}

int32_t MediumOf(const Scene& scene, const Point3& p) {
  return MediumAt(*scene.Render().geometry, p, 0, kSameMedium);
}

TEST(SceneMedia, FollowReverseOrientationAndInstances) {
  const std::string shapes = kInterface + "MediumInterface \"fog\" \"milk\" " + Sphere(1);
  EXPECT_EQ(MediumOf(Build(shapes), Point3(0.0f)), kFog);
  EXPECT_EQ(MediumOf(Build("Scale -1 1 1 " + shapes), Point3(0.0f)), kFog);
  EXPECT_EQ(MediumOf(Build("ReverseOrientation " + shapes), Point3(0.0f)), kMilk);
  EXPECT_EQ(MediumOf(Build("ReverseOrientation Scale -1 1 1 " + shapes), Point3(0.0f)), kMilk);
  for (const bool isReversed : {false, true}) {
    const Scene scene = Build("ObjectBegin \"o\" " + std::string(isReversed ? "ReverseOrientation " : "") + shapes +
                              "ObjectEnd\nTranslate 5 0 0 ObjectInstance \"o\" Translate 5 0 0 Scale 1 -3 2 "
                              "ObjectInstance \"o\"\n");
    for (const float x : {5.0f, 10.0f}) EXPECT_EQ(MediumOf(scene, {x, 0, 0}), isReversed ? kMilk : kFog) << x;
    EXPECT_EQ(MediumOf(scene, {10, 2.9f, 0}), isReversed ? kMilk : kFog);
    EXPECT_NE(MediumOf(scene, {5, 2.9f, 0}), isReversed ? kMilk : kFog);
  }
  const Scene moving = Build("ActiveTransform EndTime Translate 9 0 0 ActiveTransform All " + shapes);
  EXPECT_EQ(MediumOf(moving, Point3(0.0f)), kFog);
  EXPECT_EQ(MediumAt(*moving.Render().geometry, {9, 0, 0}, 1, kVacuum), kFog);
}

// The mesh with triangles and patches is two shapes, each of which separates.
TEST(SceneMedia, ReachAllPartsOfAShape) {
  const Scene scene =
      Build(kInterface +
            "MediumInterface \"fog\" \"\"\nShape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0] "
            "\"integer indices\" [0 1 2]\nShape \"bilinearmesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0 1 1 0] "
            "\"integer indices\" [0 1 2 3]\nShape \"disk\"\nShape \"cylinder\"\n");
  ASSERT_EQ(scene.Render().geometry->PrimitiveCount(), 4u);
  for (uint32_t i = 0; i < 4; ++i) EXPECT_TRUE(scene.Attributes(i).isBoundary);
}

TEST(SceneMedia, AreNotSeparatedByCurves) {
  const std::string curve = "Shape \"curve\" \"point3 P\" [0 0 0 1 0 0 1 1 0 2 1 0]\n";
  const Scene scene = Build("MediumInterface \"fog\" \"\"\n" + curve + kInterface + curve);
  EXPECT_EQ(scene.Render().geometry->PrimitiveCount(), 1u);
  EXPECT_FALSE(scene.Render().geometry->HasBoundaries());
  EXPECT_THAT(scene.warnings,
              ElementsAre("test.pbrt:6:1: warning: curves do not separate participating media: the MediumInterface is "
                          "ignored",
                          HasSubstr("test.pbrt:7:22: warning: curves do not separate")));
}

TEST(SceneMedia, AreKnownByName) {
  EXPECT_EQ(ErrorOf("MediumInterface \"fgo\" \"milk\" " + Sphere(1)),
            "test.pbrt:5:1: error: there is no medium \"fgo\" (did you mean \"fog\"?)");
  Diagnostics diagnostics(Diagnostics::Mode::Collect);
  SceneDescription description = ParseScene(kMedia + "WorldBegin\n" + Sphere(1), "test.pbrt", diagnostics);
  description.shapes[0].outsideMedium = "mlik";
  try {
    BuildScene(description, {}, true, diagnostics);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(std::string(error.what()), "test.pbrt:5:1: error: there is no medium \"mlik\" (did you mean \"milk\"?)");
  }
}

const std::string kFogBall = kInterface + "MediumInterface \"fog\" \"\" " + Sphere(5) + "MediumInterface \"\"\n";
const std::string kInFog = "MediumInterface \"\" \"fog\"";

TEST(SceneMedia, AreAroundTheCamera) {
  EXPECT_EQ(Build("").Render().cameraMedium, kVacuum);
  EXPECT_EQ(Build("", kInFog).Render().cameraMedium, kFog);
  // pbrt-v4 takes what the file says.
  const Scene found = Build(kFogBall);
  EXPECT_EQ(found.Render().cameraMedium, kFog);
  EXPECT_THAT(found.warnings, ElementsAre(HasSubstr("the camera is in the medium \"fog\", and its rays start there")));
  EXPECT_THAT(Build(kFogBall, kInFog).warnings, IsEmpty());
  EXPECT_EQ(Build("Translate 6 0 0 " + kFogBall).Render().cameraMedium, kVacuum);
  // The medium around the scene contradicts the file.
  const Scene wrong = Build(kFogBall, "MediumInterface \"\" \"milk\"");
  EXPECT_EQ(wrong.Render().cameraMedium, kFog);
  EXPECT_THAT(wrong.warnings,
              ElementsAre(HasSubstr("the camera is in the medium \"fog\" by the surfaces around it, not "
                                    "in the medium \"milk\"")));
}

// The ball of radius 4 touches the camera.
TEST(SceneMedia, OfACameraOnABoundaryIsWhatItLooksInto) {
  const std::string ball = kInterface + "MediumInterface \"fog\" \"\" " + Sphere(4);
  const Scene away = Build("Translate 0 0 -4 " + ball), towards = Build("Translate 0 0 4 " + ball);
  EXPECT_EQ(away.Render().cameraMedium, kVacuum);
  EXPECT_THAT(away.warnings, IsEmpty());
  EXPECT_FALSE(away.Render().cameraExterior);
  EXPECT_EQ(towards.Render().cameraMedium, kFog);
  EXPECT_FALSE(towards.Render().cameraExterior);
  // Some of its rays go into the ball, the others do not.
  const Scene along = Build("Translate 0 0 4 " + ball, "LookAt 0 0 0  1 0 0  0 0 1 ");
  EXPECT_EQ(along.Render().cameraExterior, kVacuum);
  EXPECT_EQ(along.Render().MediumOf({Point3(0.0f), Vector3(0.8f, 0, 0.6f)}), kFog);
  EXPECT_EQ(along.Render().MediumOf({Point3(0.0f), Vector3(0.8f, 0, -0.6f)}), kVacuum);
}

std::vector<int32_t> LightMedia(const std::string& world, const std::string& options = kInFog) {
  return Build(world, options).Render().lightMedia;
}

TEST(SceneMedia, AreAroundLights) {
  const std::string point = "LightSource \"point\"\n";
  EXPECT_THAT(LightMedia(point, ""), ElementsAre(kVacuum));
  EXPECT_THAT(LightMedia(point), ElementsAre(kFog));  // fog is everywhere
  EXPECT_THAT(LightMedia(kFogBall + point + "Translate 7 0 0 " + point), ElementsAre(kFog, kVacuum));
  // Nothing separates milk from the fog that the camera is in.
  EXPECT_THAT(LightMedia("MediumInterface \"\" \"milk\" " + point), ElementsAre(kFog));
  EXPECT_THAT(Build("MediumInterface \"\" \"milk\" " + point, kInFog).warnings,
              ElementsAre(HasSubstr("warning: the light is said to be in the medium \"milk\" and the camera in the "
                                    "medium \"fog\", but no surface separates the two")));
  EXPECT_THAT(LightMedia(kFogBall + "MediumInterface \"\" \"milk\" " + point), ElementsAre(kFog));
  EXPECT_THAT(Build(kFogBall + "MediumInterface \"\" \"milk\" " + point, kInFog).warnings,
              ElementsAre(HasSubstr("test.pbrt:7:27: warning: the light is in the medium \"fog\" by the surfaces")));
  // Through a ball of air in the fog, and inside of an opaque one.
  EXPECT_THAT(LightMedia(kInterface + "MediumInterface \"air\" \"fog\" " + Sphere(2) + "MediumInterface \"\"\n" +
                         point + "Translate 3 0 0 Material \"diffuse\" " + Sphere(0.5f) + point),
              ElementsAre(kAir, kFog));
}

TEST(SceneMedia, AreBeforeAndBehindAreaLights) {
  const std::string area = "AreaLightSource \"diffuse\" \"bool twosided\" true\n";
  const Scene scene = Build(area + "Material \"diffuse\" " + Sphere(0.5f) + "MediumInterface \"milk\" \"air\" " +
                            Sphere(1) + "Translate 9 0 0 ReverseOrientation " + Sphere(1));
  EXPECT_THAT(scene.Render().lightMedia, ElementsAre(kMilk, kAir, kAir));
  EXPECT_THAT(scene.Render().lightBackMedia, ElementsAre(kMilk, kMilk, kMilk));
  EXPECT_EQ(MediumOf(scene, {9, 0, 0}), kAir);
  // In instances, by the medium that each is in.
  const std::string lamp = "ObjectBegin \"o\" AttributeBegin " + area + "Material \"diffuse\" " + Sphere(0.5f) +
                           "AttributeEnd ObjectEnd ObjectInstance \"o\" Translate 9 0 0 ObjectInstance \"o\"\n";
  EXPECT_THAT(LightMedia(kFogBall + lamp), ElementsAre(kFog, kVacuum));
  // In one that is said of both sides, whatever an opaque floor says.
  EXPECT_THAT(
      LightMedia("MediumInterface \"fog\" \"\" Translate 0 -1 0 Material \"diffuse\" Shape \"disk\" \"float radius\" "
                 "9 MediumInterface \"milk\" Translate 0 2 0 " +
                     area + "Shape \"disk\"\n",
                 ""),
      ElementsAre(kMilk));
  // A light with a surface of its own.
  EXPECT_THAT(LightMedia(kFogBall + "LightSource \"sphere\" Translate 9 0 0 LightSource \"sphere\"\n"),
              ElementsAre(kFog, kVacuum));
}

TEST(SceneMedia, DoNotEmitAsInterfaces) {
  const Scene scene = Build("AreaLightSource \"diffuse\" " + kInterface + "MediumInterface \"fog\" \"\" " + Sphere(1));
  EXPECT_TRUE(scene.Attributes(0).isBoundary);
  EXPECT_FALSE(scene.Render().lighting->HasLights());
  EXPECT_THAT(scene.warnings, testing::Contains(HasSubstr("emits no light, as in pbrt-v4")));
}

TEST(SceneMedia, AreWhereLightsAtInfinityStart) {
  const std::string sky = "LightSource \"infinite\" LightSource \"distant\"\n";
  EXPECT_THAT(LightMedia(sky, ""), ElementsAre(kVacuum, kVacuum));
  EXPECT_THAT(LightMedia(sky), ElementsAre(kFog, kFog));
  EXPECT_THAT(LightMedia(kFogBall + sky), ElementsAre(kVacuum, kVacuum));
  EXPECT_THAT(LightMedia(kInterface + "MediumInterface \"air\" \"fog\" " + Sphere(5) + sky, ""),
              ElementsAre(kFog, kFog));
}

// One warning, with the place of one of the shapes.
TEST(SceneMedia, WarnWhereBoundariesOverlap) {
  const Scene scene = Build(kInterface + "MediumInterface \"fog\" \"\"\n" + Sphere(5) +
                            "MediumInterface \"milk\" \"\"\nTranslate 5 5 5\n" + Sphere(9) +
                            "MediumInterface \"\" LightSource \"point\" \"point3 from\" [-4 -4 -4]\n");
  EXPECT_THAT(scene.warnings, testing::Contains(HasSubstr("contradict each other")).Times(1));
  EXPECT_THAT(scene.warnings,
              testing::Contains(testing::MatchesRegex("test.pbrt:(6|9):1: warning: the media on the .*")));
  // A curtain in the fog that is said to have none on one side.
  const std::string curtain = "Material \"diffusetransmission\" Translate 0 0 3 Shape \"disk\"\n";
  for (const char* sides : {"\"\" \"fog\"", "\"fog\" \"\""}) {
    const Scene hung = Build(std::string("MediumInterface ") + sides + "\n" + curtain, kInFog);
    const bool isSeen = hung.Attributes(0).insideMedium == kFog;  // the camera is behind it
    EXPECT_EQ(hung.warnings.size(), isSeen ? 0u : 1u) << sides;
  }
  // A light that reaches out of the medium that most of it is in: each ray starts where it is.
  const Scene reaching =
      Build(kFogBall + "AreaLightSource \"diffuse\" Material \"diffuse\" Shape \"disk\" \"float radius\" 20\n", kInFog);
  const RenderScene& lit = reaching.Render();
  EXPECT_THAT(lit.lightStartsVary, ElementsAre(1));
  EXPECT_EQ(lit.MediumOfLight(0, false, {Point3(0, 0, 0), Vector3(0, 0, 1)}), kFog);
  EXPECT_EQ(lit.MediumOfLight(0, false, {Point3(15, 0, 0), Vector3(-1, 0, 0)}), kVacuum);
  // A hundredth of a lamp is in the fog.
  const Scene tube = Build("Translate 45 0 0 " + kFogBall +
                           "Translate 5 0 0 Rotate 90 0 1 0 AreaLightSource \"diffuse\" "
                           "Material \"diffuse\" Shape \"cylinder\" \"float zmin\" -50.2 \"float zmax\" 50\n");
  EXPECT_THAT(tube.Render().lightStartsVary, ElementsAre(1));
}

// The scenes of pbrt-v4 with media: no warnings, and light where it is.
TEST(SceneMedia, OfPeerScenes) {
  const std::filesystem::path folder = std::filesystem::path(LAMPYR_SHARED_DATA) / "peer";
  if (!std::filesystem::exists(folder / "media-fog.pbrt")) GTEST_SKIP() << "no reference data";
  const struct {
    const char* name;
    int32_t camera;
    std::vector<int32_t> lights;
  } scenes[] = {{"media-fog", 0, {0}},
                {"media-spot", 0, {0}},
                {"media-ball", kVacuum, {kVacuum}},
                {"media-glass", kVacuum, {kVacuum}},
                {"media-grid", kVacuum, {kVacuum}},
                {"media-glow", kVacuum, {}},
                {"media-inside", kVacuum, {0}}};
  for (const auto& expected : scenes) {
    Diagnostics diagnostics(Diagnostics::Mode::Collect);
    RenderOverrides overrides;
    overrides.integrator = "path";
    const SceneDescription description = ReadScene(folder / (std::string(expected.name) + ".pbrt"), diagnostics);
    const BuiltScene built = BuildScene(description, overrides, true, diagnostics);
    EXPECT_EQ(built.scene.cameraMedium, expected.camera) << expected.name;
    std::vector<int32_t> lights = built.scene.lightMedia;
    EXPECT_EQ(lights, expected.lights) << expected.name;
    for (const std::string& warning : diagnostics.Warnings()) {
      EXPECT_EQ(warning.find("medium"), std::string::npos) << warning;
      EXPECT_EQ(warning.find("media on"), std::string::npos) << warning;
    }
  }
}

}  // namespace
}  // namespace lampyr::test
