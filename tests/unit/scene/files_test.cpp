// Scenes in several files: Include, Import, gzip, the hash of what was read; and whole published scenes.
#include <gmock/gmock.h>

#include "unit/scene/scene_support.h"

namespace lampyr {
namespace {

SceneDescription ReadStrict(const std::filesystem::path& file) {
  Diagnostics strict(Diagnostics::Mode::Strict);
  return ReadScene(file, strict);
}

TEST(SceneFiles, IncludeIsAsIfWrittenThere) {
  const TemporaryFolder folder;
  folder.Write("parts/lens.pbrt", "Translate 1 0 0\nShape \"sphere\"\nAttributeBegin Include \"more.pbrt\"");
  folder.Write("parts/more.pbrt", "Shape \"disk\" AttributeEnd Scale 2 2 2");
  const auto scene =
      folder.Write("scene.pbrt", "Film \"rgb\" WorldBegin Include \"parts/lens.pbrt\" Shape \"cylinder\"");
  const SceneDescription description = ReadStrict(scene);
  ASSERT_EQ(description.shapes.size(), 3u);
  EXPECT_EQ(description.shapes[2].placement.start.Point({1, 0, 0}), Point3d(3, 0, 0));
  EXPECT_EQ(description.shapes[0].shape.where.ToString(), (folder / "parts/lens.pbrt").string() + ":2:1");
  EXPECT_EQ(description.shapes[1].shape.where.ToString(), (folder / "parts/more.pbrt").string() + ":1:1");
  EXPECT_EQ(description.shapes[2].shape.where.ToString(), scene.string() + ":1:49");
  EXPECT_EQ(description.file, scene);
}

TEST(SceneFiles, TheSameFileTwiceIsFine) {
  const TemporaryFolder folder;
  folder.Write("a.pbrt", "Shape \"sphere\"");
  const auto scene = folder.Write("scene.pbrt", "WorldBegin Include \"a.pbrt\" Include \"a.pbrt\" Import \"a.pbrt\"");
  EXPECT_EQ(ReadStrict(scene).shapes.size(), 3u);
}

TEST(SceneFiles, ImportKeepsItsStateToItself) {
  const TemporaryFolder folder;
  folder.Write("part.pbrt",
               "Shape \"disk\" Translate 0 0 9 ReverseOrientation CoordinateSystem \"x\" Material \"conductor\"\n"
               "MakeNamedMaterial \"m\" \"string type\" \"diffuse\" Texture \"t\" \"float\" \"constant\" ObjectBegin "
               "\"o\" Shape \"curve\" "
               "ObjectEnd\nLightSource \"point\" Attribute \"shape\" \"float alpha\" 0");
  const auto scene =
      folder.Write("scene.pbrt",
                   "WorldBegin Translate 1 0 0 Material \"diffuse\"\n"
                   "Import \"part.pbrt\" Shape \"sphere\" ObjectInstance \"o\" NamedMaterial \"m\" Shape \"cylinder\"");
  const SceneDescription description = ReadStrict(scene);
  ASSERT_EQ(description.shapes.size(), 3u);
  EXPECT_EQ(description.shapes[0].placement.start.Point({0, 0, 0}), Point3d(1, 0, 0))
      << "starts from the importer's state";
  EXPECT_EQ(description.shapes[0].material.index, 0);
  EXPECT_EQ(description.shapes[1].placement.start.Point({0, 0, 0}), Point3d(1, 0, 0));
  EXPECT_EQ(description.shapes[1].material.index, 0);
  EXPECT_FALSE(description.shapes[1].reverseOrientation);
  EXPECT_EQ(description.shapes[1].shape.parameters.Find("alpha"), nullptr);
  EXPECT_EQ(description.objects.size(), 1u);
  EXPECT_EQ(description.textures.size(), 1u);
  EXPECT_EQ(description.lights.at(0).placement.start.Point({0, 0, 0}), Point3d(1, 0, 9));
}

TEST(SceneFiles, ImportWithinAnObjectAddsToIt) {
  const TemporaryFolder folder;
  folder.Write("part.pbrt", "Shape \"disk\"");
  const auto scene = folder.Write("scene.pbrt", "WorldBegin ObjectBegin \"o\" Import \"part.pbrt\" ObjectEnd");
  EXPECT_EQ(ReadStrict(scene).objects.at(0).shapes.size(), 1u);
}

TEST(SceneFiles, GzipGivesTheSameScene) {
  const TemporaryFolder folder;
  std::string text = "WorldBegin\n";
  for (int i = 0; i < 20000; ++i) text += "Shape \"sphere\" \"float radius\" " + std::to_string(i + 1) + "\n";
  const SceneDescription plain = ReadStrict(folder.Write("plain.pbrt", text));
  const auto gzipped = folder.WriteGzipped("scene.pbrt.gz", text);
  const SceneDescription packed = ReadStrict(gzipped);
  EXPECT_EQ(packed.shapes.size(), 20000u);
  EXPECT_EQ(packed.contentHash, plain.contentHash);
  EXPECT_EQ(packed.shapes[41].shape.where.ToString(), gzipped.string() + ":43:1");
  // Two members, as `cat a.gz b.gz` makes them, and a gzipped include.
  folder.WriteGzipped("a.gz", "WorldBegin Shape \"sphere\" ");
  folder.WriteGzipped("b.gz", "Include \"c.gz\"");
  folder.WriteGzipped("c.gz", "Shape \"disk\"");
  const auto both = folder.Write("both.gz", ReadAll(folder / "a.gz") + ReadAll(folder / "b.gz"));
  EXPECT_EQ(ReadStrict(both).shapes.size(), 2u);
  // Zeros behind the data, as copies of whole blocks leave them.
  const auto padded = folder.Write("padded.gz", ReadAll(folder / "a.gz") + std::string(512, '\0'));
  EXPECT_EQ(ReadStrict(padded).shapes.size(), 1u);
}

TEST(SceneFiles, HashTellsContents) {
  const std::string text = "WorldBegin Shape \"sphere\"";
  EXPECT_EQ(Parse(text).contentHash, Parse(text).contentHash);
  EXPECT_EQ(Parse(text).contentHash.size(), 32u);
  EXPECT_NE(Parse(text).contentHash, Parse(text + " ").contentHash);
  EXPECT_NE(Parse(text).contentHash, Parse("WorldBegin Shape \"sphera\"").contentHash);
  const TemporaryFolder a, b;
  for (const TemporaryFolder* folder : {&a, &b}) {
    folder->Write("part.pbrt", folder == &a ? "Shape \"disk\"" : "Shape \"desk\"");
    folder->Write("scene.pbrt", "WorldBegin Include \"part.pbrt\"");
  }
  const std::string hashOfA = ReadStrict(a / "scene.pbrt").contentHash;
  EXPECT_NE(hashOfA, ReadStrict(b / "scene.pbrt").contentHash);
  b.Write("part.pbrt", "Shape \"disk\"");
  EXPECT_EQ(hashOfA, ReadStrict(b / "scene.pbrt").contentHash) << "where a scene lies does not matter";
}

TEST(SceneFiles, OurOwnScenesHaveNoWarnings) {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(std::filesystem::path(LAMPYR_SOURCE_DIR) / "scenes")) {
    if (entry.path().extension() != ".pbrt") continue;
    EXPECT_FALSE(ReadStrict(entry.path()).shapes.empty()) << entry.path();
    ++count;
  }
  EXPECT_GE(count, 8);
}

TEST(SceneFiles, PublishedScenes) {
  const std::filesystem::path data = LAMPYR_SHARED_DATA;
  std::vector<std::filesystem::path> files;
  std::error_code absent;
  for (const auto& entry : std::filesystem::directory_iterator(data / "peer", absent)) {
    if (entry.path().extension() == ".pbrt") files.push_back(entry.path());
  }
  if (std::filesystem::exists(data / "killeroo/killeroo-simple.pbrt", absent))
    files.push_back(data / "killeroo/killeroo-simple.pbrt");
  if (files.empty()) GTEST_SKIP() << "no scenes at " << data;
  for (const std::filesystem::path& file : files) {
    Diagnostics diagnostics(Diagnostics::Mode::Collect);
    const SceneDescription scene = ReadScene(file, diagnostics);
    EXPECT_TRUE(diagnostics.Warnings().empty()) << diagnostics.Warnings().front();
    EXPECT_EQ(scene.media.empty(), file.filename().string().find("media-") != 0) << file;
    EXPECT_EQ(scene.camera.type, "perspective") << file;
    EXPECT_FALSE(scene.shapes.empty()) << file;
    EXPECT_TRUE(!scene.media.empty() || !scene.lights.empty() || !scene.areaLights.empty()) << file;
    if (file.filename() == "lights600.pbrt") {
      EXPECT_EQ(scene.areaLights.size(), 600u);
    }
    if (file.filename() == "killeroo-simple.pbrt") {
      EXPECT_EQ(scene.shapes.size(), 5u);
    }
  }
}

}  // namespace
}  // namespace lampyr
