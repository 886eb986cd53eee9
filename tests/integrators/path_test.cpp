// Properties of the path integrator alone: interfaces, several lights at infinity, the cosine of the shading normal,
// roulette in glass, rays that leave their surface.
#include <gtest/gtest.h>

#include <cmath>

#include "support/render_scene.h"

namespace lampyr::test {
namespace {

// A camera that sees a small patch around the origin; receivers lie there and face +y.
const std::string kHead = R"(Film "rgb" "integer xresolution" 8 "integer yresolution" 8
PixelFilter "box"
LookAt 0 0.02 0.01  0 0 0  0 1 0
Camera "perspective" "float fov" 0.5
Integrator "path" "integer maxdepth" 1
WorldBegin
)";
const std::string kWhiteDisk = R"(Material "diffuse" "rgb reflectance" [1 1 1]
AttributeBegin Rotate 90 1 0 0 Shape "disk" "float radius" 0.05 AttributeEnd
)";

void ExpectRadiance(const std::string& text, int samples, double expected, const std::string& what) {
  const Rendered rendered = RenderText(kHead + text, samples);
  const MeanValue value = MeanOf(rendered.image);
  EXPECT_LT(value.standardError, 0.01 * expected) << what;
  EXPECT_NEAR(value.mean, expected, 4.5 * value.standardError + 2e-4 * expected) << what;
  EXPECT_EQ(rendered.outcome.counts.droppedSamples + rendered.rejectedRays, 0u) << what;
}

TEST(Path, LightsAtInfinityAddUp) {
  ExpectRadiance(R"(LightSource "infinite" "rgb L" [0.25 0.25 0.25]
LightSource "infinite" "rgb L" [1 1 1]
LightSource "infinite" "rgb L" [2 2 2]
)" + kWhiteDisk,
                 1024, 3.25, "diffuse");
}

TEST(Path, InterfacesNeitherScatterNorShadeNorShine) {
  ExpectRadiance(kWhiteDisk + R"(AreaLightSource "diffuse" "rgb L" [2 2 2]
Translate 0 1.5 0
Shape "sphere" "float radius" 0.7
Material "interface"
Shape "sphere" "float radius" 1.4
)",
                 1024, 2 * std::pow(0.7 / 1.5, 2), "a light within an interface");
}

// A flat mesh whose vertex normals lean by 30° towards +x.
const std::string kLeaningMesh = R"(Material "diffuse" "rgb reflectance" [1 1 1]
Shape "trianglemesh" "point3 P" [-1 0 -1  -1 0 1  1 0 1  1 0 -1] "integer indices" [0 1 2 0 2 3]
  "normal N" [0.5 0.8660254 0  0.5 0.8660254 0  0.5 0.8660254 0  0.5 0.8660254 0]
)";

TEST(Path, TheCosineIsThatOfTheShadingNormal) {
  // From 30° on the side that the normals lean to, and from straight above.
  ExpectRadiance("LightSource \"distant\" \"rgb L\" [3 3 3] \"point3 from\" [0.5 0.8660254 0] \"point3 to\" [0 0 0]\n" +
                     kLeaningMesh,
                 4, 3 / M_PI, "along the shading normal");
  ExpectRadiance(
      "LightSource \"distant\" \"rgb L\" [3 3 3] \"point3 from\" [0 1 0] \"point3 to\" [0 0 0]\n" + kLeaningMesh, 4,
      3 / M_PI * std::cos(M_PI / 6), "along the geometric normal");
  // And both ways of finding a light agree about it: all of the hemisphere around the shading normal is open.
  ExpectRadiance("LightSource \"infinite\" \"rgb L\" [1 1 1]\n" + kLeaningMesh, 1024, 1, "furnace");
}

// A closed room with a ball of `material` behind the camera, which paths meet after a wall.
std::string RoomWithBalls(const std::string& material, const std::string& setting) {
  return R"(Film "rgb" "integer xresolution" 16 "integer yresolution" 16
PixelFilter "box"
LookAt 0 0 0  0 0 1  0 1 0
Camera "perspective" "float fov" 60
Integrator "path" "integer maxdepth" 5 )" +
         setting + R"(
WorldBegin
AttributeBegin AreaLightSource "diffuse" "rgb L" [5 5 5] Translate 0 0.8 0.2
Shape "sphere" "float radius" 0.1 AttributeEnd
AttributeBegin Material "diffuse" "rgb reflectance" [0.7 0.7 0.7] Shape "sphere" "float radius" 1 AttributeEnd
)" + "AttributeBegin " +
         material + " Translate 0 0 -0.5 Shape \"sphere\" \"float radius\" 0.3 AttributeEnd\n";
}

// Behind a wide bounce a mirror, clear glass or a gloss is as rough as pbrt-v4's rule says, and the picture that of a
// scene with that material, to the byte. In front of it nothing changes.
TEST(Path, RegularizedMaterialsAreRougherBehindAWideBounce) {
  const std::string rough = "\"bool remaproughness\" false \"float roughness\" ";
  const std::string on = "\"bool regularize\" true";
  struct Pair {
    std::string given, seen;
  };
  const std::vector<Pair> pairs = {
      {R"(Material "conductor" "rgb reflectance" [0.9 0.8 0.7] )",
       R"(Material "conductor" "rgb reflectance" [0.9 0.8 0.7] )" + rough + "0.1"},
      {"Material \"dielectric\" " + rough + "0.08", "Material \"dielectric\" " + rough + "0.16"},
      {"Material \"coateddiffuse\" " + rough + "0.2", "Material \"coateddiffuse\" " + rough + "0.3"},
      {R"(Material "coatedconductor" "bool remaproughness" false "float interface.roughness" 0.02 "float conductor.roughness" 0.4)",
       R"(Material "coatedconductor" "bool remaproughness" false "float interface.roughness" 0.1 "float conductor.roughness" 0.4)"},
      {R"(Material "diffuse" "rgb reflectance" [0.3 0.4 0.5])",
       R"(Material "diffuse" "rgb reflectance" [0.3 0.4 0.5])"},
      {R"(Material "thindielectric")", R"(Material "thindielectric")"}};
  for (const Pair& pair : pairs) {
    const Rendered regularized = RenderText(RoomWithBalls(pair.given, on), 16);
    const Rendered expected = RenderText(RoomWithBalls(pair.seen, ""), 16);
    EXPECT_EQ(regularized.image.data, expected.image.data) << pair.given;
    if (pair.given == pair.seen) continue;
    EXPECT_NE(regularized.image.data, RenderText(RoomWithBalls(pair.given, ""), 16).image.data) << pair.given;
  }
}

TEST(Path, RegularizedMixesAreMadeOnceForEachMaterial) {
  // Each mix names the one before it twice: made anew for each name, the last would be made of 2^40 materials.
  const auto mixes = [](const std::string& roughness) {
    std::string text =
        "MakeNamedMaterial \"m0\" \"string type\" \"conductor\" \"bool remaproughness\" false "
        "\"float roughness\" " +
        roughness + "\n";
    for (int i = 1; i <= 40; ++i) {
      const std::string before = "\"m" + std::to_string(i - 1) + "\"";
      text += "MakeNamedMaterial \"m" + std::to_string(i) + "\" \"string type\" \"mix\" \"string materials\" [" +
              before + " " + before + "]\n";
    }
    return text + "NamedMaterial \"m40\"\n";
  };
  EXPECT_EQ(RenderText(RoomWithBalls(mixes("0.02"), "\"bool regularize\" true"), 4).image.data,
            RenderText(RoomWithBalls(mixes("0.1"), ""), 4).image.data);
}

TEST(Path, RouletteKnowsWhatRefractionDoesToRadiance) {
  // The radiance that a path in glass may find is scaled by 1/η² on the way in: that is no reason to end it. All paths
  // of this scene weigh the same.
  for (const char* glass : {"\"dielectric\" \"float eta\" 1.5", "\"dielectric\" \"float eta\" 0.6"}) {
    const auto rendered = RenderText(std::string(R"(Film "rgb" "integer xresolution" 16 "integer yresolution" 16
LookAt 0 0 4  0 0 0  0 1 0
Camera "perspective" "float fov" 30
Integrator "path" "integer maxdepth" 1000
WorldBegin
LightSource "infinite" "rgb L" [1 1 1]
Material )") + glass + "\nShape \"sphere\"\n",
                                     64);
    const MeanValue value = MeanOf(rendered.image);
    EXPECT_NEAR(value.mean, 1, 1e-4) << glass;
    EXPECT_LT(value.standardError, 1e-5) << glass;
  }
}

// A white convex object under an even sky, one bounce: a ray that met its own surface again would find no light.
TEST(Path, ConvexObjectsDoNotShadeThemselves) {
  const std::string shapes[] = {
      "Shape \"sphere\"",
      "Rotate 60 1 1 0 Shape \"disk\"",
      "Rotate 60 1 1 0 Shape \"bilinearmesh\" \"point3 P\" [-1 -1 0 1 -1 0 -1 1 0 1 1 0]",
      "Shape \"loopsubdiv\" \"integer levels\" 3 \"point3 P\" [1 0 0 -1 0 0 0 1 0 0 -1 0 0 0 1 0 0 -1] \"integer "
      "indices\" [0 2 4 2 1 4 1 3 4 3 0 4 2 0 5 1 2 5 3 1 5 0 3 5]",
      "Shape \"curve\" \"string type\" \"cylinder\" \"float width\" 0.6 \"point3 P\" [0 -1 0 0 -0.3 0 0 0.3 0 0 1 0]",
      "Shape \"curve\" \"string type\" \"flat\" \"float width\" 0.6 \"point3 P\" [0 -1 0 0 -0.3 0 0 0.3 0 0 1 0]"};
  for (const std::string& shape : shapes) {
    // Another object on the other side keeps the origin where it is: floats are sparse at the one that is seen.
    for (const std::string place : {"0", "10000"}) {
      for (const bool instanced : {false, true}) {
        const std::string whole = instanced
                                      ? "ObjectBegin \"o\" Scale 1000 1000 1000 " + shape + " ObjectEnd Translate " +
                                            place + " 0 0 Scale 0.001 0.001 0.001 ObjectInstance \"o\""
                                      : "Translate " + place + " 0 0 " + shape;
        const auto rendered = RenderText(R"(Film "rgb" "integer xresolution" 32 "integer yresolution" 32
LookAt )" + place + " 0 4  " + place + R"( 0 0  0 1 0
Camera "perspective" "float fov" 30
Integrator "path" "integer maxdepth" 1
WorldBegin
LightSource "infinite"
Material "diffuse" "rgb reflectance" [1 1 1]
AttributeBegin Translate -)" + place + " 0 500 Shape \"sphere\" AttributeEnd\n" +
                                             whole,
                                         16);
        const MeanValue value = MeanOf(rendered.image);
        EXPECT_LT(value.standardError, 0.01) << whole;
        // Shading normals of a faceted shape: light that comes from behind the facets is lost.
        const double expected = shape.find("loopsubdiv") != std::string::npos ? 0.9987 : 1;
        EXPECT_NEAR(value.mean, expected, 4.5 * value.standardError + 1e-4) << whole;
        EXPECT_EQ(rendered.outcome.counts.droppedSamples + rendered.rejectedRays, 0u) << whole;
      }
    }
  }
}

}  // namespace
}  // namespace lampyr::test
