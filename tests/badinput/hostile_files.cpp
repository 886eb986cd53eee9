// Files that are named to do harm: pipes that nobody writes to, devices without an end, folders, paths that lead out of
// the scene, compressed files that grow without bounds, headers that announce what is not there.
#include <gmock/gmock.h>
#include <sys/stat.h>

#include "badinput/hostile_support.h"
#include "geometry/ply.h"
#include "scene/ies_profile.h"

namespace lampyr {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

std::vector<std::string> WarningsOfFile(const std::filesystem::path& file) {
  Diagnostics diagnostics(Diagnostics::Mode::Collect);
  ReadScene(file, diagnostics);
  return diagnostics.Warnings();
}

// Each statement that reads a file, with the file's name as FILE.
constexpr const char* kReaders[] = {
    "Include \"FILE\"",
    "Import \"FILE\"",
    "Shape \"plymesh\" \"string filename\" \"FILE\"",
    "Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"FILE\"",
    "Material \"diffuse\" \"string normalmap\" \"FILE\" Shape \"sphere\"",
    "Material \"diffuse\" \"spectrum reflectance\" \"FILE\" Shape \"sphere\"",
    "LightSource \"point\" \"spectrum I\" \"FILE\"",
    "LightSource \"infinite\" \"string filename\" \"FILE\"",
    "LightSource \"goniometric\" \"string filename\" \"FILE\"",
    "LightSource \"projection\" \"string filename\" \"FILE\"",
    "LightSource \"rect\" \"string texture:file\" \"FILE\"",
    "LightSource \"spot\" \"string shaping:ies:file\" \"FILE\"",
    "LightFilter \"gobo\" \"string filename\" \"FILE\" LightSource \"point\"",
};

std::string Reading(const std::string& statement, const std::string& file) {
  std::string text = "WorldBegin\n" + statement;
  text.replace(text.find("FILE"), 4, file);
  return text;
}

TEST(HostileFiles, PipesDevicesAndFoldersAreNotWaitedFor) {
  const TemporaryFolder folder;
  ASSERT_EQ(mkfifo((folder / "pipe").c_str(), 0600), 0);
  std::filesystem::create_symlink("/dev/zero", folder / "endless");
  for (const char* statement : kReaders) {
    for (const char* name : {"pipe", "/dev/zero", "/dev/stdin/", "endless", "."}) {
      const std::string error = BuildError(Reading(statement, name), folder.Path());
      EXPECT_THAT(error, HasSubstr("scene.pbrt:2:")) << statement << " " << name;
    }
    const std::string error = BuildError(Reading(statement, "pipe"), folder.Path());
    EXPECT_THAT(error, HasSubstr("not a regular file")) << statement;
    EXPECT_THAT(error, HasSubstr("pipe")) << statement;
  }
}

TEST(HostileFiles, IncludesThatLeaveTheSceneAreTold) {
  const TemporaryFolder folder;
  folder.Write("here/a/part", "Shape \"sphere\"");
  folder.Write("here/b/part", "Shape \"sphere\"");
  folder.Write("far/part", "Shape \"sphere\"");
  std::filesystem::create_symlink(folder / "far/part", folder / "here/a/link");
  const auto warnings = [&](const std::string& name) {
    return WarningsOfFile(folder.Write("here/a/s.pbrt", "WorldBegin\n Include \"" + name + "\""));
  };
  for (const char* name : {"part", "./part", "../a/part", "../b/part", "../../here/b/part"}) {
    EXPECT_THAT(warnings(name), IsEmpty()) << name;
  }
  const std::string far = std::filesystem::canonical(folder / "far/part").string();
  const std::string told = (folder / "here/a/s.pbrt").string() +
                           ":2:10: warning: Include leaves the folders of the scene: \"" + far + "\" is read";
  for (const std::string& name :
       {std::string("../../far/part"), far, std::string("link"), std::string("../../../../../../../../../..") + far}) {
    EXPECT_THAT(warnings(name), ElementsAre(told)) << name;
  }
}

TEST(HostileFiles, WhatIsNoSceneIsRefusedWhereverItLies) {
  const std::string error = BuildError("WorldBegin\nInclude \"../../../../../../../../../../../etc/passwd\"", "/tmp");
  EXPECT_THAT(error, HasSubstr("etc/passwd:1:1: error: there is no statement"));
}

TEST(HostileFiles, CompressedFilesGrowToALimit) {
  const TemporaryFolder folder;
  constexpr size_t size = 80 * kMebibyte;
  const std::string scene = folder.WriteGzipped("s.pbrt.gz", "WorldBegin" + std::string(size, ' '));
  const std::string ply = folder.WriteGzipped("a.ply", "ply\nformat ascii 1.0\n" + std::string(size, '\n'));
  const PeakMemory peak;
  EXPECT_THAT(ReadError(scene), HasSubstr("grows to more than 200 times its size when it is decompressed"));
  EXPECT_THAT(BuildError("WorldBegin\nInclude \"s.pbrt.gz\"", folder.Path()), HasSubstr("scene.pbrt:2:9: error"));
  EXPECT_THAT(ErrorOf([&] { ReadPly(ply); }), HasSubstr("grows to more than 200 times its size"));
  EXPECT_LT(peak.GrownBy(), 400);
  // The same ratio is fine in a small file.
  EXPECT_EQ(ReadError(folder.WriteGzipped("small.gz", "WorldBegin" + std::string(4 * kMebibyte, ' '))), "no error");
}

TEST(HostileFiles, CountsThatAFileDoesNotHoldTakeNoMemory) {
  const std::string counts[] = {"4294967279",          "4294967295",          "4294967296",          "2147483648",
                                "9223372036854775807", "9223372036854775808", "18446744073709551615"};
  const PeakMemory peak;
  for (const std::string& count : counts) {
    for (const char* format : {"ascii", "binary_little_endian", "binary_big_endian"}) {
      const std::string vertices = std::string("ply\nformat ") + format + " 1.0\nelement vertex " + count +
                                   "\nproperty double x\nproperty double y\nproperty double z\n"
                                   "element face 1\nproperty list uchar int vertex_indices\nend_header\n0123456789";
      EXPECT_THAT(ErrorOf([&] { ParsePly(vertices, "a.ply"); }), HasSubstr("more than the file holds")) << vertices;
      const std::string faces = std::string("ply\nformat ") + format +
                                " 1.0\nelement vertex 0\nproperty float x\nproperty float y\nproperty float z\n"
                                "element face " +
                                count + "\nproperty list uint int vertex_indices\nend_header\n\xff\xff";
      EXPECT_THAT(ErrorOf([&] { ParsePly(faces, "a.ply"); }), HasSubstr("more than the file holds")) << faces;
    }
    const std::string list =
        "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
        "property float z\nelement face 1\nproperty list uint int vertex_indices\nend_header\n"
        "0 0 0\n" +
        count + " 0 0 0\n";
    EXPECT_THAT(ErrorOf([&] { ParsePly(list, "a.ply"); }), HasSubstr("is longer than the file")) << list;
    const std::string ies = "IESNA91\nTILT=NONE\n1 -1 1 " + count + " " + count + " 1 2 0 0 0\n1 1 1\n0 90\n0\n1 1";
    EXPECT_THAT(ErrorOf([&] { ParseIes(ies, "a.ies"); }), HasSubstr("a.ies:3:8: error")) << ies;
  }
  EXPECT_LT(peak.GrownBy(), 64);
}

}  // namespace
}  // namespace lampyr
