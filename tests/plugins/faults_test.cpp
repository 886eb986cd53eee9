// Plugins that are broken: each is refused with the file, what was expected and what was found. Whoever asked for it is
// told so with exit code 2; where it merely lay in a folder, the work goes on. Nothing ends the process.
#include <elf.h>

#include <cstring>

#include "plugins/plugins_fixture.h"

namespace lampyr::test {
namespace {

namespace fs = std::filesystem;

class BrokenPlugins : public Plugins {
 protected:
  void SetUp() override {
    Write("plain.pbrt", SceneWith("LightSource \"disk\" \"float intensity\" 4"));
    fs::create_directory(folder_ / "folder");
  }

  // By option, by scene, and from a folder.
  void ExpectRefused(const fs::path& plugin, const std::string& expected, const std::string& found) {
    SCOPED_TRACE(plugin);
    const std::vector<std::string> texts = {"the plugin \"" + plugin.string() + "\": expected " + expected,
                                            "found " + found};
    const Outcome byOption = Run("render plain.pbrt -o out.exr --quiet --plugin '" + plugin.string() + "'");
    ExpectSays(byOption, 2, texts);
    EXPECT_TRUE(byOption.output.starts_with("error: ")) << byOption.output;
    Write("asks.pbrt", SceneWith("LightSource \"disk\"", "Option \"plugins\" \"" + plugin.string() + "\""));
    ExpectSays(Run("render asks.pbrt -o out.exr --quiet --allow-scene-plugins"), 2, texts);
    EXPECT_FALSE(Exists("out.exr"));
    if (!fs::is_regular_file(plugin)) return;
    const fs::path link = folder_ / "folder/it.so";
    fs::create_symlink(plugin, link);
    ExpectSays(Run("render plain.pbrt -o out.exr --quiet", "folder"), 0,
               {"warning: the plugin \"folder/it.so\": expected " + expected, "found " + found, "left out"});
    EXPECT_TRUE(Exists("out.exr"));
    fs::remove(link);
    fs::remove(folder_ / "out.exr");
  }
};

TEST_F(BrokenPlugins, OfAnotherAbi) {
  // The plugin also lacks symbols, functions and tables, and would end the process on loading.
  ExpectRefused(FaultyPlugin("other_abi"), "the ABI \"lampyr ", "\"lampyr 0.0.1, plugin interface 0, layout 7\"");
}

TEST_F(BrokenPlugins, AtTheDoor) {
  ExpectRefused(FaultyPlugin("no_entry"), "the entry point \"lampyr_plugin\"", "none");
  ExpectRefused(FaultyPlugin("unresolved"), "only symbols that this lampyr has",
                "the undefined symbol lampyr::NotInAnyLampyr(int)");
  ExpectRefused(FaultyPlugin("throws_exception"), "types from its entry point",
                "an exception: no licence for this light");
  ExpectRefused(FaultyPlugin("throws_number"), "types from its entry point", "something thrown that is no exception");
  ExpectRefused(FaultyPlugin("returns_null"), "types from its entry point", "null");
  ExpectRefused(FaultyPlugin("brings_nothing"), "types of lights or filters", "none");
  ExpectRefused(FaultyPlugin("null_factory"), "a factory for \"unmade\"", "null");
  ExpectRefused(FaultyPlugin("no_name"), "a name for a light", "an empty one");
}

TEST_F(BrokenPlugins, ThatAreNoSharedLibraries) {
  const fs::path file = folder_ / "file.so";
  ExpectRefused(file, "a shared library", "no such file");
  ExpectRefused(folder_ / "folder", "a shared library", "a folder");
  ExpectRefused("/dev/zero", "a shared library", "something that is no file");
  Write("file.so", "");
  ExpectRefused(file, "a shared library", "an empty file");
  Write("file.so", "#!/bin/sh\necho it is a light\n");
  ExpectRefused(file, "a shared library (ELF)", "another kind of file");
  Write("file.so",
        "\x7f"
        "ELF");
  ExpectRefused(file, "64 bytes at least", "4: its end is missing");
  // A shared library, and a program, that have nothing to do with lampyr.
  ExpectRefused(fs::path(LAMPYR_BINARY).parent_path() / "lampyr_image_module.so", "the ABI",
                "a shared library without");
  ExpectRefused(LAMPYR_BINARY, "the ABI", "a shared library without");
}

// Wherever it ends: loading what is not there would end the process.
TEST_F(BrokenPlugins, ThatAreTruncated) {
  const std::string whole = ReadBytes(RingPlugin());
  const fs::path file = folder_ / "file.so";
  for (const double part : {0.001, 0.01, 0.3, 0.8, 0.9999}) {
    Write("file.so", whole.substr(0, static_cast<size_t>(part * static_cast<double>(whole.size()))));
    SCOPED_TRACE(part);
    const Outcome outcome = Run("lights --plugin file.so");
    ExpectSays(outcome, 2, {"the plugin \"file.so\": expected ", "bytes at least, found ", "its end is missing"});
  }
  ExpectRefused(file, "", "");
}

TEST_F(BrokenPlugins, ForAnotherMachine) {
  std::string bytes = ReadBytes(RingPlugin());
  const Elf64_Half other = EM_S390;
  std::memcpy(bytes.data() + offsetof(Elf64_Ehdr, e_machine), &other, sizeof other);
  Write("file.so", bytes);
  ExpectRefused(folder_ / "file.so", "a shared library for this machine", "one for another");
  bytes = ReadBytes(RingPlugin());
  bytes[EI_CLASS] = ELFCLASS32;
  Write("file.so", bytes);
  ExpectRefused(folder_ / "file.so", "a shared library for this machine", "one for another");
}

// Every byte of the headers, turned over: a message, or it loads; and the program is still there to say so.
TEST_F(BrokenPlugins, WithBrokenHeaders) {
  const std::string whole = ReadBytes(FaultyPlugin("other_abi"));
  for (size_t at = 0; at < sizeof(Elf64_Ehdr) + 3 * sizeof(Elf64_Phdr); at += 7) {
    std::string bytes = whole;
    bytes[at] = static_cast<char>(~bytes[at]);
    Write("file.so", bytes);
    const Outcome outcome = Run("lights --plugin file.so");
    ExpectSays(outcome, 2, {"the plugin \"file.so\": expected "});
  }
}

TEST_F(BrokenPlugins, WithANameThatIsTaken) {
  ExpectRefused(FaultyPlugin("taken_name"), "types of new names",
                "LightSource \"rect\", which lampyr itself has already");
  fs::copy_file(RingPlugin(), folder_ / "folder/copy.so");
  const std::string ring = RingPlugin().string();
  ExpectSays(Run("lights --plugin '" + ring + "' --plugin folder/copy.so"), 2,
             {"the plugin \"folder/copy.so\": expected types of new names, found LightSource \"ring\"",
              "which the plugin \"" + ring + "\" has already"});
  // A plugin that is named takes precedence over those in a folder.
  const Outcome outcome = Run("lights --plugin '" + ring + "'", "folder");
  ExpectSays(outcome, 0, {"warning: the plugin \"folder/copy.so\"", "from the plugin \"" + ring + "\""});
}

// The loader of the system cannot be used after that: it ends, but with a message.
TEST_F(BrokenPlugins, WithStaticConstructorsThatThrow) {
  const std::string file = FaultyPlugin("static_throws").string();
  const std::vector<std::string> texts = {"the plugin \"", "static_throws.so\": expected a library that can be loaded",
                                          "found static constructors that throw: thrown while loading"};
  ExpectSays(Run("lights --plugin '" + file + "'"), 2, texts);
  fs::create_symlink(file, folder_ / "folder/static_throws.so");
  ExpectSays(Run("render plain.pbrt -o out.exr --quiet", "folder"), 2, texts);
}

class MisbehavingTypes : public Plugins {
 protected:
  static std::string With() { return " --quiet -o out.exr --plugin '" + FaultyPlugin("behaviour").string() + "' "; }
  // Where the light is made: exit code 2, at the statement.
  void ExpectUnmade(const std::string& type, const std::string& found) {
    SCOPED_TRACE(type);
    Write("scene.pbrt", SceneWith("LightSource \"" + type + "\""));
    ExpectSays(Run("render scene.pbrt" + With()), 2,
               {"scene.pbrt:9:1: error: LightSource \"" + type + "\" of the plugin \"" +
                FaultyPlugin("behaviour").string() + "\": expected a light, found " + found});
    EXPECT_FALSE(Exists("out.exr"));
  }
  // While it is at work: the render has failed, and what was there before is still there.
  void ExpectFails(const std::string& type, const std::string& integrator, const std::string& found) {
    SCOPED_TRACE(type + " " + integrator);
    Write("scene.pbrt", SceneWith("LightSource \"" + type + "\""));
    Write("out.exr", "a picture from before");
    ExpectSays(Run("render scene.pbrt --threads 4 --integrator " + integrator + With()), 1,
               {"error: expected no exception, found " + found, FaultyPlugin("behaviour").string()});
    EXPECT_EQ(Read("out.exr"), "a picture from before");
  }
};

TEST_F(MisbehavingTypes, FactoriesThatMakeNothing) {
  ExpectUnmade("throws-exception", "an exception: out of gas");
  ExpectUnmade("throws-error", "an error: the mantle is torn");
  ExpectUnmade("throws-number", "something thrown that is no exception");
  ExpectUnmade("makes-null", "null");
  Write("scene.pbrt", SceneWith("LightFilter \"filter-throws\" LightSource \"rect\""));
  ExpectSays(Run("render scene.pbrt" + With()), 2,
             {"scene.pbrt:9:1: error: LightFilter \"filter-throws\" of the plugin ",
              "expected a filter, found something thrown that is no exception"});
  // An Error that says where is what it is for a built-in light: it crosses from the plugin as the class that it is.
  Write("scene.pbrt", SceneWith("LightSource \"throws-located-error\" \"float intensity\" 2"));
  const Outcome outcome = Run("render scene.pbrt" + With());
  EXPECT_EQ(outcome.exitCode, 2);
  EXPECT_TRUE(outcome.output.starts_with("scene.pbrt:9:")) << outcome.output;
  EXPECT_TRUE(outcome.output.ends_with(": error: too bright for its socket\n")) << outcome.output;
}

TEST_F(MisbehavingTypes, LightsThatThrowAtWork) {
  for (const char* integrator : {"path", "bdpt"}) {
    ExpectFails("throws-in-samples", integrator, "one: burnt out");
    // By way of the library that traces rays, which lets no exception pass.
    ExpectFails("throws-in-surface", integrator, "one: no such surface");
  }
  ExpectFails("throws-in-photons", "light", "something thrown that is none");
  ExpectFails("throws-in-photons", "sppm", "something thrown that is none");
}

// Paths that start nowhere are not traced: the picture is written, and said to be wrong.
TEST_F(MisbehavingTypes, LightsWhosePathsStartNowhere) {
  Write("scene.pbrt", SceneWith("LightSource \"lost\" LightSource \"point\""));
  for (const char* integrator : {"light", "bdpt", "vcm", "sppm"}) {
    SCOPED_TRACE(integrator);
    ExpectSays(Run("render scene.pbrt --spp 4 --integrator " + std::string(integrator) + With()), 1,
               {"error: ", "the picture is wrong, and its error is unknown"});
    EXPECT_TRUE(Exists("out.exr"));
    fs::remove(folder_ / "out.exr");
  }
}

// Samples with a negative density are not used, and are not passed over in silence.
TEST_F(MisbehavingTypes, LightsOfNegativeDensities) {
  Write("scene.pbrt", SceneWith("LightSource \"negative\" LightSource \"point\""));
  for (const char* integrator : {"path", "bdpt", "vcm", "sppm"}) {
    SCOPED_TRACE(integrator);
    ExpectSays(Run("render scene.pbrt --spp 4 --integrator " + std::string(integrator) + With()), 1,
               {"samples were dropped", "the picture is wrong, and its error is unknown"});
    fs::remove(folder_ / "out.exr");
  }
}

// A light that throws where the scene is built: that scene cannot be used.
TEST_F(MisbehavingTypes, LightsThatThrowWhileTheSceneIsBuilt) {
  Write("scene.pbrt", SceneWith("LightSource \"throws-in-bounds\" LightSource \"point\""));
  ExpectSays(Run("render scene.pbrt" + With()), 2, {"something thrown that is none", "behaviour.so"});
  EXPECT_FALSE(Exists("out.exr"));
}

TEST_F(MisbehavingTypes, InTheSuite) {
  const std::string plugin = " --plugin '" + FaultyPlugin("behaviour").string() + "'";
  ExpectSays(Run("check-lights --type throws-in-samples" + plugin), 1,
             {"FAILED throws-in-samples[0]", "exceptions", "it has thrown: burnt out"});
  ExpectSays(Run("check-lights --type makes-null" + plugin), 1, {"expected a light, found null"});
}

}  // namespace
}  // namespace lampyr::test
