// Scene files that ask for more than a scene can need: depth, numbers of files and parameters, instances, subdivision.
// Each is refused where it is written, and before the memory is taken.
#include <gmock/gmock.h>

#include "badinput/hostile_support.h"
#include "scene/limits.h"

namespace lampyr {
namespace {

using testing::HasSubstr;

std::string Repeated(const std::string& text, size_t times) {
  std::string all;
  all.reserve(text.size() * times);
  for (size_t i = 0; i < times; ++i) all += text;
  return all;
}

TEST(HostileScene, ScopesAreNestedToALimit) {
  const std::string deep = "WorldBegin\n" + Repeated("AttributeBegin\n", limits::kOpenScopes);
  EXPECT_THAT(ParseError(deep), HasSubstr("this AttributeBegin has no AttributeEnd"));
  for (const char* one : {"AttributeBegin", "ObjectBegin \"o\""}) {
    const std::string error = ParseError(deep + one);
    EXPECT_THAT(error, HasSubstr("scene.pbrt:50002:1: error: scopes are nested more than 50000 deep"));
    EXPECT_THAT(error, HasSubstr("the innermost is the AttributeBegin at scene.pbrt:50001:1"));
  }
}

TEST(HostileScene, StatementsHaveParametersToALimit) {
  std::string text = "WorldBegin\nShape \"sphere\"";
  for (size_t i = 0; i < limits::kParameters; ++i) text += "\n\"float a" + std::to_string(i) + "\" 1";
  EXPECT_EQ(ParseError(text), "no error");
  EXPECT_EQ(ParseError(text + "\n\"float b\" 1"), "scene.pbrt:1003:1: error: a statement has at most 1000 parameters");
}

TEST(HostileScene, DefaultsAreFewAsEveryStatementCopiesThem) {
  const auto withValues = [](size_t count) {
    return ParseError("WorldBegin\nAttribute \"shape\" \"float a\" [ " + Repeated("1 ", count) + "]");
  };
  EXPECT_EQ(withValues(limits::kDefaultValues), "no error");
  EXPECT_THAT(withValues(limits::kDefaultValues + 1),
              HasSubstr("scene.pbrt:2:11: error: Attribute \"shape\" gives more than 64 parameters or 1000 values"));
  std::string text = "WorldBegin\n";
  for (size_t i = 0; i < limits::kDefaultParameters; ++i) {
    text += "Attribute \"light\" \"float a" + std::to_string(i) + "\" 1\n";
  }
  EXPECT_EQ(ParseError(text), "no error");
  EXPECT_THAT(ParseError(text + "Attribute \"light\" \"float b\" 1"), HasSubstr("scene.pbrt:66:11: error: Attribute"));
}

// Ten files, each of which includes the next one ten times, would be 10^10 files.
TEST(HostileScene, FilesThatMultiplyAreCounted) {
  const TemporaryFolder folder;
  folder.Write("f9", "#");
  for (int i = 8; i >= 0; --i) {
    folder.Write("f" + std::to_string(i), Repeated("Include \"f" + std::to_string(i + 1) + "\"\n", 10));
  }
  for (const char* statement : {"Include", "Import"}) {
    const std::string file = folder.Write("s.pbrt", std::string("WorldBegin ") + statement + " \"f0\"");
    const std::string error = ReadError(file);
    EXPECT_THAT(error, HasSubstr(": error: files are included more than 50000 times in all"));
    EXPECT_THAT(error, HasSubstr("(ObjectBegin)"));
  }
}

TEST(HostileScene, TextThatIsReadAgainAndAgainIsCounted) {
  const TemporaryFolder folder;
  constexpr size_t size = 64 * kMebibyte;
  folder.Write("long", std::string(size, '\n'));
  const std::string file = folder.Write("s.pbrt", "WorldBegin\n" + Repeated("Include \"long\"\n", 20));
  EXPECT_THAT(ReadError(file),
              HasSubstr("s.pbrt:19:9: error: files that are included again make more than 1 GiB of text"));
}

// Each level holds ten of the one below.
std::string NestedObjects(int levels) {
  std::string text = "WorldBegin\nObjectBegin \"o0\" Shape \"sphere\" ObjectEnd\n";
  for (int i = 1; i < levels; ++i) {
    text += "ObjectBegin \"o" + std::to_string(i) + "\" " +
            Repeated("ObjectInstance \"o" + std::to_string(i - 1) + "\" Translate 1 0 0 ", 10) + "ObjectEnd\n";
  }
  return text + "ObjectInstance \"o" + std::to_string(levels - 1) + "\"\n";
}

TEST(HostileScene, InstancesThatMultiplyAreCountedBeforeTheyAreMade) {
  EXPECT_THAT(ParseError(NestedObjects(11)), HasSubstr("nested instances multiply to more than 10 million"));
  EXPECT_EQ(BuildError(NestedObjects(4)), "no error");
  const PeakMemory peak;
  const std::string error = BuildError(NestedObjects(7));
  EXPECT_THAT(error, HasSubstr("scene.pbrt:9:1: error: 1111111 instances, of which this is the first, take 1.1 GiB"));
  EXPECT_THAT(error, HasSubstr("of memory, and there are 256 MiB in all"));
  EXPECT_LT(peak.GrownBy(), 64);
}

TEST(HostileScene, LightsOfInstancesAreCounted) {
  constexpr uint64_t memory = 20 * kMebibyte;
  std::string text = NestedObjects(5);  // 11 111 instances fit
  EXPECT_EQ(BuildError(text, {}, memory), "no error");
  const std::string light = "AreaLightSource \"diffuse\" ";
  text.insert(text.find("Shape"), light);
  EXPECT_THAT(BuildError(text, {}, memory),
              HasSubstr("scene.pbrt:2:44: error: the lights that this shape makes, with their tables, take"));
}

std::string Subdivision(const std::string& levels, int copies) {
  return "WorldBegin\n" + Repeated(
                              "Shape \"loopsubdiv\" \"point3 P\" [ 0 0 0 1 0 0 0 1 0 ] \"integer indices\" [ 0 1 2 ] "
                              "\"integer levels\" " +
                                  levels + "\n",
                              static_cast<size_t>(copies));
}

TEST(HostileScene, SubdivisionIsCountedBeforeItIsMade) {
  EXPECT_THAT(BuildError(Subdivision("30", 1)), HasSubstr(": error: \"levels\" must be from 0 to 10"));
  EXPECT_THAT(BuildError(Subdivision("-1", 1)), HasSubstr(": error: \"levels\" must be from 0 to 10"));
  EXPECT_EQ(BuildError(Subdivision("6", 2)), "no error");
  const PeakMemory peak;
  EXPECT_THAT(BuildError(Subdivision("10", 1), {}, 100 * kMebibyte),
              HasSubstr("scene.pbrt:2:81: error: 10 levels of 1 faces make 1048576 triangles, which take 128 MiB of "
                        "memory, and there are 100 MiB in all"));
  EXPECT_LT(peak.GrownBy(), 64);
  // Each would fit.
  EXPECT_THAT(
      BuildError(Subdivision("8", 20), {}, 100 * kMebibyte),
      HasSubstr("scene.pbrt:14:81: error: 8 levels of 1 faces make 65536 triangles, which take 8.0 MiB of memory "
                "besides the 96 MiB of the scene before them"));
}

// One flat curve of `segments` wild bends, each of which is divided into 256.
std::string BentCurve(int segments, const std::string& type) {
  return "Shape \"curve\" \"string type\" \"" + type + "\" \"float width\" 1e-6 \"point3 P\" [ 0 0 0 " +
         Repeated("0 9 0  0 -9 1  0 0 0  ", static_cast<size_t>(segments)) + "]\n";
}

TEST(HostileScene, CurvesAreCountedBeforeTheyAreDivided) {
  EXPECT_EQ(BuildError("WorldBegin\n" + BentCurve(62, "flat"), {}, 8 * kMebibyte), "no error");
  const std::string text = "WorldBegin\n" + BentCurve(625, "flat");
  EXPECT_EQ(BuildError("WorldBegin\n" + BentCurve(10000, "cylinder"), {}, 8 * kMebibyte), "no error");
  const PeakMemory peak;
  EXPECT_THAT(
      BuildError(text, {}, 8 * kMebibyte),
      HasSubstr("scene.pbrt:2:1: error: the segments of this curve, 160000 where bent ones are divided, take 39 "
                "MiB of memory, and there are 8.0 MiB in all"));
  EXPECT_LT(peak.GrownBy(), 16);
  // Each would fit.
  EXPECT_THAT(
      BuildError("WorldBegin\n" + Repeated(BentCurve(62, "flat"), 3), {}, 8 * kMebibyte),
      HasSubstr("scene.pbrt:4:1: error: the segments of this curve, 15872 where bent ones are divided, take 3.9 "
                "MiB of memory besides the 7.8 MiB of the scene before them"));
  // An object's curves are made once, however often it is there.
  EXPECT_EQ(BuildError("WorldBegin\nObjectBegin \"o\"\n" + BentCurve(62, "flat") + "ObjectEnd\n" +
                           Repeated("ObjectInstance \"o\"\n", 3),
                       {}, 8 * kMebibyte),
            "no error");
}

TEST(HostileScene, OneMeshThatIsNamedAgainAndAgainIsCounted) {
  const TemporaryFolder folder;
  constexpr size_t faces = 20000;
  folder.Write("a.ply",
               "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
               "element face " +
                   std::to_string(faces) +
                   "\nproperty list uchar int vertex_indices\nend_header\n"
                   "0 0 0 1 0 0 0 1 0\n" +
                   Repeated("3 0 1 2\n", faces));
  const std::string text = "WorldBegin\n" + Repeated("Shape \"plymesh\" \"string filename\" \"a.ply\"\n", 10);
  EXPECT_THAT(BuildError(text, folder.Path(), 16 * kMebibyte), HasSubstr("scene.pbrt:8:17: error: the faces of \""));
}

struct Value {
  const char* statement;
  const char* error;  // "": built
};

TEST(HostileScene, AbsurdNumbersAreRefusedOrHarmless) {
  const Value values[] = {
      {"Film \"rgb\" \"integer xresolution\" 65537 WorldBegin", "must be from 1 to 65536"},
      {"Film \"rgb\" \"integer yresolution\" -1 WorldBegin", "must be from 1 to 65536"},
      // The memory of the picture is checked by the render.
      {"Film \"rgb\" \"integer xresolution\" 65536 \"integer yresolution\" 65536 WorldBegin", ""},
      {"Sampler \"sobol\" \"integer pixelsamples\" 2147483647 WorldBegin", "must be from 1 to"},
      {"Sampler \"stratified\" \"integer xsamples\" 32768 \"integer ysamples\" 32769 WorldBegin", "must be from 1 to"},
      {"Integrator \"path\" \"integer maxdepth\" -1 WorldBegin", "must be 0 or more"},
      {"Integrator \"sppm\" \"integer photonsperiteration\" 2147483647 WorldBegin", ""},
      {"PixelFilter \"box\" \"float xradius\" 1e38 WorldBegin", ""},
      {"WorldBegin ObjectBegin \"o\" Shape \"sphere\" \"float radius\" 1e13 ObjectEnd Scale 1e-13 1e-13 1e-13 "
       "ObjectInstance \"o\"",
       "scales volumes by less than 1e-38"},
      {"Camera \"perspective\" \"float shutteropen\" 1 \"float shutterclose\" 0.5 WorldBegin",
       "\"shutterclose\" must be after \"shutteropen\""},
      {"WorldBegin Texture \"t\" \"float\" \"fbm\" \"integer octaves\" 2147483647", "octaves must be from 0 to 32"},
      {"WorldBegin Texture \"t\" \"float\" \"checkerboard\" \"float uscale\" 1e38", ""},
      {"WorldBegin Material \"coateddiffuse\" \"integer nsamples\" 2147483647 Shape \"sphere\"", ""},
      {"WorldBegin Material \"coateddiffuse\" \"integer maxdepth\" 2147483647 Shape \"sphere\"", ""},
      {"WorldBegin Shape \"curve\" \"point3 P\" [ 0 0 0 1 0 0 1 1 0 2 2 2 ] \"integer splitdepth\" 2147483647", ""},
      {"WorldBegin Shape \"trianglemesh\" \"point3 P\" [ 0 0 0 1 0 0 0 1 0 ] \"integer indices\" [ 0 1 3 ]",
       "index 3 is out of range"},
      {"WorldBegin Shape \"trianglemesh\" \"point3 P\" [ 0 0 0 1 0 0 0 1 0 ] \"integer indices\" [ 0 1 -1 ]",
       "index -1 is out of range"},
      {"WorldBegin Shape \"bilinearmesh\" \"point3 P\" [ 0 0 0 1 0 0 0 1 0 1 1 0 ] \"integer indices\" [ 0 1 2 "
       "2147483647 ]",
       "index 2147483647 is out of range"},
      {"WorldBegin Shape \"trianglemesh\" \"point3 P\" [ 1e38 0 0 1 0 0 0 1 0 ]", "farther out than 1e18"},
      {"WorldBegin Shape \"sphere\" \"float radius\" 1e30", "the shape reaches farther out than 1e18"},
      {"WorldBegin Scale 1e-20 1e-20 1e-20 Shape \"sphere\"", "makes it smaller than 1e-18 of itself"},
      {"WorldBegin LightSource \"infinite\" Translate 1e19 0 0 Shape \"sphere\"",
       "scene.pbrt:1:54: error: a shape is placed farther out than 1e18"},
      {"Camera \"perspective\" \"float lensradius\" 1e39 WorldBegin", "too large"},
      {"WorldBegin LightSource \"point\" \"point3 from\" [ 0 2e18 0 ]", "\"from\" is farther out than 1e18"},
      {"WorldBegin LightSource \"spot\" \"point3 from\" [ 0 -2e18 0 ]", "\"from\" is farther out than 1e18"},
      {"WorldBegin Translate 0 0 2e18 LightSource \"point\"", "is placed farther out than 1e18"},
      {"WorldBegin Translate 0 0 2e18 LightSource \"goniometric\"", "is placed farther out than 1e18"},
      {"WorldBegin Scale 1e20 1 1 Shape \"trianglemesh\" \"point3 P\" [ 1e38 0 0 1 0 0 0 1 0 ]",
       "farther out than 1e18"},
  };
  for (const Value& value : values) {
    const std::string error = BuildError(value.statement);
    if (*value.error == '\0') {
      EXPECT_EQ(error, "no error") << value.statement;
    } else {
      EXPECT_THAT(error, HasSubstr("scene.pbrt:1:")) << value.statement;
      EXPECT_THAT(error, HasSubstr(value.error)) << value.statement;
    }
  }
}

}  // namespace
}  // namespace lampyr
