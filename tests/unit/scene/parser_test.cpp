// The scenes that statements describe: scopes, attributes, objects, materials, textures, lights.
#include <gmock/gmock.h>

#include "unit/scene/scene_support.h"

namespace lampyr {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

TEST(Parser, OptionsOfTheWholeGrammar) {
  const SceneDescription scene = Parse(R"(
    Option "seed" 7
    ColorSpace "srgb"
    Camera "perspective" "float fov" 45
    Film "rgb" "integer xresolution" [ 640 ] "string filename" "a.exr" "bool savefp16" false
    PixelFilter "mitchell" "float xradius" [ 2 ]
    Sampler "halton" "integer pixelsamples" 16
    Integrator "bdpt"
    Accelerator "bvh"
    WorldBegin)");
  EXPECT_EQ(scene.options.at("seed").integers, std::vector<int64_t>{7});
  EXPECT_EQ(scene.camera.type, "perspective");
  EXPECT_EQ(scene.camera.parameters.GetFloat("fov", 0), 45);
  EXPECT_EQ(scene.film.parameters.GetInteger("xresolution", 0), 640);
  EXPECT_EQ(scene.film.parameters.GetString("filename", ""), "a.exr");
  EXPECT_FALSE(scene.film.parameters.GetBool("savefp16", true));
  EXPECT_EQ(scene.pixelFilter.type, "mitchell");
  EXPECT_EQ(scene.sampler.parameters.GetInteger("pixelsamples", 0), 16);
  EXPECT_EQ(scene.integrator.type, "bdpt");
  EXPECT_EQ(scene.accelerator.type, "bvh");
  EXPECT_EQ(scene.film.where.ToString(), "scene.pbrt:5:5");
  EXPECT_EQ(scene.film.parameters.WhereOf("xresolution").ToString(), "scene.pbrt:5:16");
  EXPECT_EQ(scene.film.parameters.Owner(), "Film \"rgb\"");
  EXPECT_EQ(scene.integrator.parameters.WhereOf("absent").ToString(), "scene.pbrt:8:5");
}

TEST(Parser, StatementsNotGivenHaveNoType) {
  const SceneDescription scene = Parse("WorldBegin");
  EXPECT_EQ(scene.camera.type, "");
  EXPECT_EQ(scene.integrator.type, "");
  EXPECT_TRUE(scene.cameraToWorld.start.IsIdentity());
}

TEST(Parser, AttributeScopesSaveEverything) {
  const SceneDescription scene = Parse(InWorld(R"(
    Material "diffuse"
    AttributeBegin
      Translate 1 0 0  ReverseOrientation  Material "conductor"
      AreaLightSource "diffuse" "rgb L" [ 1 2 3 ]
      Shape "sphere"
      AttributeBegin ReverseOrientation Shape "sphere" AttributeEnd
      Shape "sphere"
    AttributeEnd
    Shape "sphere")"));
  ASSERT_EQ(scene.shapes.size(), 4u);
  const ShapeDescription &inner = scene.shapes[0], &innermost = scene.shapes[1], &again = scene.shapes[2],
                         &outer = scene.shapes[3];
  EXPECT_EQ(inner.material.index, 1);
  EXPECT_EQ(inner.areaLight, 0);
  EXPECT_TRUE(inner.reverseOrientation);
  EXPECT_FALSE(innermost.reverseOrientation);
  EXPECT_TRUE(again.reverseOrientation);
  EXPECT_EQ(outer.material.index, 0);
  EXPECT_EQ(outer.areaLight, -1);
  EXPECT_FALSE(outer.reverseOrientation);
  EXPECT_TRUE(outer.placement.start.IsIdentity());
  EXPECT_EQ(scene.materials.at(1).type, "conductor");
}

TEST(Parser, ShapeWithoutMaterialRefersToNone) {
  const SceneDescription scene = Parse(InWorld("Shape \"sphere\""));
  EXPECT_EQ(scene.shapes.at(0).material.index, -1);
  EXPECT_EQ(scene.shapes.at(0).material.name, "");
}

TEST(Parser, NamedMaterials) {
  const SceneDescription scene = Parse(InWorld(R"(
    NamedMaterial "late" Shape "sphere"
    MakeNamedMaterial "late" "string type" "diffuse" "rgb reflectance" [ .1 .2 .3 ]
    Material "diffuse" Shape "sphere")"));
  EXPECT_EQ(scene.shapes.at(0).material.name, "late");
  EXPECT_EQ(scene.shapes.at(0).material.index, -1);
  EXPECT_EQ(scene.shapes.at(1).material.name, "");
  EXPECT_EQ(scene.shapes.at(1).material.index, 0);
  EXPECT_EQ(scene.namedMaterials.at(0).material.type, "diffuse");
  const Color color = scene.namedMaterials[0].material.parameters.GetColor("reflectance", {}, SpectrumRole::Albedo);
  EXPECT_EQ(color, Color(0.1f, 0.2f, 0.3f));
}

TEST(Parser, AttributeGivesDefaultsToItsTarget) {
  const SceneDescription scene = Parse(InWorld(R"(
    Attribute "shape" "float radius" 2
    Attribute "material" "rgb reflectance" [ .5 .5 .5 ]
    Attribute "light" "float scale" 3
    AttributeBegin
      Attribute "shape" "float radius" 4 "float zmax" 1
      Shape "sphere"
      Shape "sphere" "float radius" 5
    AttributeEnd
    Shape "sphere"
    Material "diffuse"
    LightSource "point"
    AreaLightSource "diffuse"
    MakeNamedMaterial "m" "string type" "diffuse")"));
  EXPECT_EQ(scene.shapes.at(0).shape.parameters.GetFloat("radius", 0), 4);
  EXPECT_EQ(scene.shapes.at(0).shape.parameters.GetFloat("zmax", 0), 1);
  EXPECT_EQ(scene.shapes.at(1).shape.parameters.GetFloat("radius", 0), 5);
  EXPECT_EQ(scene.shapes.at(2).shape.parameters.GetFloat("radius", 0), 2);
  EXPECT_EQ(scene.shapes.at(2).shape.parameters.Find("zmax"), nullptr);
  EXPECT_NE(scene.materials.at(0).parameters.Find("reflectance"), nullptr);
  EXPECT_EQ(scene.lights.at(0).light.parameters.GetFloat("scale", 1), 3);
  EXPECT_EQ(scene.areaLights.at(0).parameters.GetFloat("scale", 1), 3);
  EXPECT_NE(scene.namedMaterials.at(0).material.parameters.Find("reflectance"), nullptr);
  EXPECT_TRUE(scene.shapes[0].attributes.empty());
  // A default that a statement has no use for is no error.
  Diagnostics strict(Diagnostics::Mode::Strict);
  scene.lights[0].light.parameters.CheckAllUsed({}, {}, strict);
  scene.materials[0].parameters.CheckAllUsed({}, {}, strict);
}

// As in pbrt-v4.
TEST(Parser, OfAParameterThatIsGivenTwiceTheLastCounts) {
  Diagnostics diagnostics(Diagnostics::Mode::Collect);
  const SceneDescription scene =
      ParseScene(InWorld("Shape \"sphere\" \"float radius\" 1 \"float zmin\" -1\n\"float radius\" 3\n"), "scene.pbrt",
                 diagnostics);
  EXPECT_EQ(scene.shapes.at(0).shape.parameters.GetFloat("radius", 0), 3);
  EXPECT_EQ(scene.shapes.at(0).shape.parameters.GetFloat("zmin", 0), -1);
  ASSERT_EQ(diagnostics.Warnings().size(), 1u);
  EXPECT_THAT(diagnostics.Warnings()[0], HasSubstr("\"radius\" is given twice; the value at scene.pbrt:"));
}

TEST(Parser, LinkingAttributesGoToTheShape) {
  Diagnostics diagnostics(Diagnostics::Mode::Collect);
  const SceneDescription scene =
      ParseScene(InWorld("Attribute \"lighting\" \"string subset\" [ \"keys\" \"rims\" ] Shape \"sphere\"\n"),
                 "scene.pbrt", diagnostics);
  EXPECT_THAT(scene.shapes.at(0).attributes.at("lighting").GetStrings("subset"), ElementsAre("keys", "rims"));
  EXPECT_THAT(diagnostics.Warnings(), ElementsAre());
}

TEST(Parser, LinkingAttributesHaveKnownNames) {
  EXPECT_THAT(
      ParseError(InWorld("Attribute \"lighting\" \"string subst\" \"keys\"\n")),
      HasSubstr(
          "scene.pbrt:2:22: error: Attribute \"lighting\" has no parameter \"subst\" (did you mean \"subset\"?)"));
  EXPECT_THAT(ParseError(InWorld("Attribute \"lightfilter\" \"string excludesubset\" \"keys\"\n")),
              HasSubstr("has no parameter \"excludesubset\""));
  EXPECT_THAT(ParseError(InWorld("Attribute \"lightfilter\" \"float subset\" 3\n")),
              HasSubstr("is of type \"float\", expected \"string\""));
}

// The last one before a light, within its scope.
TEST(Parser, LightFiltersBindByScope) {
  const SceneDescription scene = Parse(InWorld(R"(
    LightSource "point"
    LightFilter "rod" Translate 1 0 0 CoordinateSystem "there"
    LightSource "point"
    AttributeBegin
      LightFilter "barn" "string name" "doors"
      LightSource "point"
      LightFilter "ramp" "string coordsys" "there"
      AreaLightSource "diffuse"
      LightFilter "none"
      LightSource "point"
    AttributeEnd
    LightSource "point"
    AttributeBegin Translate 5 0 0 LightFilter "gobo" "string coordsys" "there" AttributeEnd
  )"));
  std::vector<int> bound;
  for (const LightDescription& light : scene.lights) bound.push_back(light.filter);
  EXPECT_THAT(bound, ElementsAre(-1, 0, 1, -1, 0));
  EXPECT_EQ(scene.areaLights.at(0).filter, 2);
  ASSERT_EQ(scene.lightFilters.size(), 4u);
  EXPECT_TRUE(scene.lightFilters[0].placement.start.IsIdentity());
  EXPECT_EQ(scene.lightFilters[1].filter.type, "barn");
  EXPECT_EQ(scene.lightFilters[3].placement.start.Point(Point3d(0.0)), Point3d(1, 0, 0));
}

TEST(Parser, LightFiltersThatCannotBe) {
  EXPECT_THAT(ParseError(InWorld("CoordinateSystem \"lamp\" LightFilter \"gobo\" \"string coordsys\" \"lmap\"")),
              HasSubstr("there is no coordinate system \"lmap\" (did you mean \"lamp\"?)"));
  EXPECT_THAT(ParseError(InWorld("LightFilter \"none\" \"float density\" 1")),
              HasSubstr("LightFilter \"none\" has no parameters"));
  EXPECT_THAT(WarningsOf(InWorld("ObjectBegin \"o\" LightFilter \"rod\" ObjectEnd")),
              ElementsAre("scene.pbrt:2:17: warning: a LightFilter within an object stays where it is written: it does "
                          "not move with the object's instances"));
}

TEST(Parser, ObjectsAndNestedInstances) {
  const SceneDescription scene = Parse(InWorld(R"(
    ObjectBegin "leaf"
      Translate 0 0 1  Shape "sphere"  Material "conductor"
    ObjectEnd
    Translate 5 0 0
    ObjectBegin "tree"
      Scale 2 2 2  ObjectInstance "leaf"  Shape "disk"
    ObjectEnd
    Translate 0 1 0
    ObjectInstance "tree"
    Shape "cylinder")"));
  ASSERT_EQ(scene.objects.size(), 2u);
  EXPECT_EQ(scene.objects[0].shapes.at(0).placement.start.Point({0, 0, 0}), Point3d(0, 0, 1));
  EXPECT_EQ(scene.objects[1].instances.at(0).object, "leaf");
  EXPECT_EQ(scene.objects[1].instances.at(0).placement.start.Point({1, 0, 0}), Point3d(7, 0, 0));
  EXPECT_EQ(scene.objects[1].shapes.at(0).placement.start.Point({1, 0, 0}), Point3d(7, 0, 0));
  EXPECT_EQ(scene.instances.at(0).object, "tree");
  EXPECT_EQ(scene.instances.at(0).placement.start.Point({0, 0, 0}), Point3d(5, 1, 0));
  ASSERT_EQ(scene.shapes.size(), 1u);
  EXPECT_EQ(scene.shapes[0].material.index, -1) << "an object's material ends with it";
}

TEST(Parser, TexturesAndLights) {
  const SceneDescription scene = Parse(InWorld(R"(
    Translate 1 2 3
    Texture "t" "spectrum" "imagemap" "string filename" "a.png"
    Texture "t" "float" "constant" "float value" .5
    LightSource "spot" "blackbody I" 5000 "point3 from" [ 1 2 3 ])"));
  ASSERT_EQ(scene.textures.size(), 2u);
  EXPECT_TRUE(scene.textures[0].isSpectrum);
  EXPECT_EQ(scene.textures[0].texture.type, "imagemap");
  EXPECT_EQ(scene.textures[0].placement.start.Point({0, 0, 0}), Point3d(1, 2, 3));
  EXPECT_FALSE(scene.textures[1].isSpectrum);
  EXPECT_EQ(scene.lights.at(0).light.type, "spot");
  EXPECT_EQ(scene.lights[0].placement.start.Point({0, 0, 0}), Point3d(1, 2, 3));
  EXPECT_EQ(scene.lights[0].light.parameters.GetPoint3("from", {}), Point3d(1, 2, 3));
}

TEST(Parser, WarnsOnceOfWhatIsNotSupported) {
  EXPECT_THAT(WarningsOf("Option \"wavefront\" true\nWorldBegin\n"),
              ElementsAre("scene.pbrt:1:1: warning: the option \"wavefront\" is not supported yet: it is ignored"));
  EXPECT_THAT(
      WarningsOf(InWorld("TransformBegin\nTransformEnd\nWorldEnd")),
      ElementsAre(
          "scene.pbrt:2:1: warning: TransformBegin is deprecated: it is taken as AttributeBegin, as pbrt-v4 does",
          "scene.pbrt:3:1: warning: TransformEnd is deprecated: it is taken as AttributeEnd, as pbrt-v4 does",
          "scene.pbrt:4:1: warning: WorldEnd is of pbrt-v3: it is ignored"));
  EXPECT_THAT(
      WarningsOf(InWorld("CoordinateSystem \"lamp\" CoordSysTransform \"lmap\"")),
      ElementsAre(
          "scene.pbrt:2:25: warning: there is no coordinate system \"lmap\" (did you mean \"lamp\"?): the transform "
          "stays as it is"));
  EXPECT_THAT(
      WarningsOf("ColorSpace \"rec2020\"\nFilm \"rgb\" WorldBegin"),
      ElementsAre(
          "scene.pbrt:2:1: warning: images in another colour space than \"srgb\" are not supported yet: the image "
          "is linear sRGB"));
  EXPECT_THAT(WarningsOf(InWorld("Shape \"sphere\"")), IsEmpty());
}

TEST(Parser, StrictMakesWarningsErrors) {
  Diagnostics strict(Diagnostics::Mode::Strict);
  EXPECT_EQ(ErrorOf([&] { ParseScene("WorldBegin WorldEnd", "s", strict); }).substr(0, 15), "s:1:12: error: ");
}

TEST(Parser, MediaReachShapesLightsAndTheCamera) {
  const SceneDescription scene = Parse(R"(
    Translate 1 2 3
    MakeNamedMedium "air" "string type" "homogeneous" "float g" 0.5
    MediumInterface "" "air"
    Camera "perspective"
    MediumInterface ""
    WorldBegin
    MakeNamedMedium "a" "string type" "cloud"
    Attribute "medium" "float density" 2
    Scale 2 2 2
    MakeNamedMedium "b" "string type" "uniformgrid"
    MediumInterface "a" "b" Shape "sphere" LightSource "point"
    MediumInterface "b" Shape "sphere")");
  ASSERT_EQ(scene.media.size(), 3u);
  EXPECT_EQ(scene.media[0].name, "air");
  EXPECT_EQ(scene.media[0].medium.type, "homogeneous");
  EXPECT_EQ(scene.media[0].medium.where.ToString(), "scene.pbrt:3:5");
  EXPECT_EQ(scene.media[0].medium.parameters.GetFloat("g", 0), 0.5);
  EXPECT_EQ(scene.media[0].placement.start.Point({0, 0, 0}), Point3d(1, 2, 3));
  EXPECT_TRUE(scene.media[1].placement.start.IsIdentity());
  EXPECT_EQ(scene.media[1].medium.parameters.GetFloat("density", 1), 1);
  EXPECT_EQ(scene.media[2].placement.start.Point({1, 1, 1}), Point3d(2, 2, 2));
  EXPECT_EQ(scene.media[2].medium.parameters.GetFloat("density", 1), 2);
  EXPECT_EQ(scene.cameraMedium, "air");
  EXPECT_EQ(scene.shapes.at(0).insideMedium, "a");
  EXPECT_EQ(scene.shapes.at(0).outsideMedium, "b");
  EXPECT_EQ(scene.lights.at(0).mediumName, "b");
  EXPECT_EQ(scene.shapes.at(1).insideMedium, "b");
  EXPECT_EQ(scene.shapes.at(1).outsideMedium, "b");
  EXPECT_EQ(Parse("Camera \"perspective\" WorldBegin").cameraMedium, "");
  EXPECT_EQ(ParseError(InWorld("MakeNamedMedium \"a\" \"float g\" 0")),
            "scene.pbrt:2:1: error: MakeNamedMedium \"a\" needs a \"string type\"");
}

// Shapes that are scaled to nothing are left out with a warning, until the end of the scope, Identity or Transform.
TEST(Parser, ShapesWithoutExtentAreLeftOut) {
  Diagnostics diagnostics(Diagnostics::Mode::Collect);
  const SceneDescription scene = ParseScene(InWorld(R"(
    ObjectBegin "o" Shape "sphere" Scale 1 1 0 Shape "sphere" ObjectEnd
    AttributeBegin
      ConcatTransform [ 1 2 3 0  2 4 6 0  0 0 1 0  0 0 0 1 ]
      Translate 1 0 0
      Shape "sphere"
      ObjectInstance "o"
      Identity
      Shape "disk"
    AttributeEnd
    Shape "cylinder"
    ObjectInstance "o")"),
                                            "scene.pbrt", diagnostics);
  ASSERT_EQ(scene.shapes.size(), 2u);
  EXPECT_EQ(scene.shapes[0].shape.type, "disk");
  EXPECT_EQ(scene.shapes[1].shape.type, "cylinder");
  EXPECT_EQ(scene.objects.at(0).shapes.size(), 1u);
  EXPECT_EQ(scene.instances.size(), 1u);
  EXPECT_TRUE(scene.shapes[1].placement.start.IsIdentity());
  ASSERT_EQ(diagnostics.Warnings().size(), 3u);
  EXPECT_THAT(diagnostics.Warnings()[0], HasSubstr("this Shape is left out: Scale at scene.pbrt:"));
  EXPECT_THAT(diagnostics.Warnings()[2], HasSubstr("this ObjectInstance is left out: ConcatTransform at scene.pbrt:"));
}

TEST(Parser, DeepNestingIsNoProblem) {
  std::string text = "WorldBegin\n";
  for (int i = 0; i < 20000; ++i) text += "AttributeBegin ";
  for (int i = 0; i < 20000; ++i) text += "AttributeEnd ";
  EXPECT_TRUE(Parse(text).shapes.empty());
  std::string objects = "WorldBegin\n";
  for (int i = 0; i < 5000; ++i) {
    objects +=
        "ObjectBegin \"o" + std::to_string(i) + "\" ObjectInstance \"o" + std::to_string(i + 1) + "\" ObjectEnd\n";
  }
  EXPECT_EQ(Parse(objects + "ObjectBegin \"o5000\" ObjectEnd").objects.size(), 5001u);
}

}  // namespace
}  // namespace lampyr
