// What the path integrator decides by itself: interfaces, several lights at infinity, the cosine of the shading normal,
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
        EXPECT_NEAR(value.mean, 1, 4.5 * value.standardError + 1e-4) << whole;
        EXPECT_EQ(rendered.outcome.counts.droppedSamples + rendered.rejectedRays, 0u) << whole;
      }
    }
  }
}

}  // namespace
}  // namespace lampyr::test
