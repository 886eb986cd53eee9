// Things that are made of other things by name: textures, materials, filters, instances, imports. A few lines can ask
// for more levels than the stack has, or for more evaluations than a machine can make; many lines must not take the
// square of their number.
#include <gmock/gmock.h>

#include <chrono>

#include "badinput/hostile_support.h"
#include "scene/limits.h"
#include "support/render_scene.h"

namespace lampyr {
namespace {

using testing::HasSubstr;

constexpr const char* kHead = R"(Film "rgb" "integer xresolution" 3 "integer yresolution" 3
Camera "perspective" "float fov" 20
WorldBegin
)";

// The error of the scene, or "no error" after rendering 3 × 3 pixels.
std::string RenderError(const std::string& world) {
  RenderOverrides overrides;
  overrides.integrator = "path";
  overrides.values["max-depth"] = 2;
  overrides.memory = 256 * kMebibyte;
  return ErrorOf([&] { test::RenderText(kHead + world, 1, overrides); });
}

double SecondsOf(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// Statement 0, then `count - 1` in which # is the own number and @ that of the one before.
std::string Chain(const std::string& first, const std::string& next, size_t count) {
  std::string text = first + "\n";
  for (size_t i = 1; i < count; ++i) {
    for (const char c : next) {
      if (c == '#') {
        text += std::to_string(i);
      } else if (c == '@') {
        text += std::to_string(i - 1);
      } else {
        text += c;
      }
    }
    text += "\n";
  }
  return text;
}

std::string Last(size_t count) {
  return std::to_string(count - 1) + "\"\n";
}

// A graph of one kind: the first statement, one that names its predecessor, one that names it twice, and what makes the
// last one count.
struct Kind {
  const char* what;  // in the message
  std::string first, next, twice, use, after;
  bool multiplies = true;  // asks both of what it names
};

const std::string kLit = "LightSource \"point\" \"point3 from\" [ 0 0 1 ]\nTranslate 0 0 4\nShape \"sphere\"\n";

std::vector<Kind> Kinds() {
  return {
      {"light filters", "LightFilter \"rod\" \"string name\" \"x0\"",
       "LightFilter \"combiner\" \"string name\" \"x#\" \"string filters\" \"x@\"",
       "LightFilter \"combiner\" \"string name\" \"x#\" \"string filters\" [ \"x@\" \"x@\" ]",
       "LightFilter \"combiner\" \"string filters\" \"x", kLit},
      {"light filters", "LightFilter \"rod\" \"string name\" \"x0\"",
       "LightFilter \"combiner\" \"string name\" \"x#\" \"string filters\" \"x@\" \"string mode\" \"max\"",
       "LightFilter \"combiner\" \"string name\" \"x#\" \"string filters\" [ \"x@\" \"x@\" ] \"string mode\" \"max\"",
       "LightFilter \"combiner\" \"string filters\" \"x", kLit},
      {"textures", "Texture \"x0\" \"spectrum\" \"checkerboard\"",
       "Texture \"x#\" \"spectrum\" \"scale\" \"texture tex\" \"x@\" \"float scale\" 0.9",
       "Texture \"x#\" \"spectrum\" \"mix\" \"texture tex1\" \"x@\" \"texture tex2\" \"x@\"",
       "Material \"diffuse\" \"texture reflectance\" \"x", kLit},
      {"textures", "Texture \"x0\" \"float\" \"fbm\"",
       "Texture \"x#\" \"float\" \"scale\" \"texture tex\" \"x@\" \"float scale\" 0.9",
       "Texture \"x#\" \"float\" \"scale\" \"texture tex\" \"x@\" \"texture scale\" \"x@\"",
       "Material \"mix\" \"string materials\" [ \"a\" \"a\" ] \"texture amount\" \"x",
       "MakeNamedMaterial \"a\" \"string type\" \"diffuse\"\n" + kLit},
      {"materials",
       "MakeNamedMaterial \"x0\" \"string type\" \"diffuse\"\nMakeNamedMaterial \"a\" \"string type\" \"diffuse\"",
       "MakeNamedMaterial \"x#\" \"string type\" \"mix\" \"string materials\" [ \"a\" \"x@\" ] \"float amount\" "
       "0.999999",
       "MakeNamedMaterial \"x#\" \"string type\" \"mix\" \"string materials\" [ \"x@\" \"x@\" ]", "NamedMaterial \"x",
       kLit, false},
  };
}

TEST(HostileGraphs, AreAsDeepAsTheStackBears) {
  for (const Kind& kind : Kinds()) {
    constexpr size_t most = limits::kNestedNames - 1;
    EXPECT_EQ(RenderError(Chain(kind.first, kind.next, most) + kind.use + Last(most) + kind.after), "no error");
    constexpr size_t absurd = 12'000;
    const std::string error = RenderError(Chain(kind.first, kind.next, absurd) + kind.use + Last(absurd) + kind.after);
    EXPECT_THAT(error, HasSubstr(": error: " + std::string(kind.what))) << kind.next;
    EXPECT_THAT(error, HasSubstr("256 deep")) << kind.next;
    const size_t line = 4 + limits::kNestedNames + (kind.multiplies ? 0 : 1);
    EXPECT_THAT(error, HasSubstr("test.pbrt:" + std::to_string(line) + ":1")) << kind.next;
  }
}

TEST(HostileGraphs, MultiplyToALimit) {
  for (const Kind& kind : Kinds()) {
    constexpr size_t few = 8, many = 40;
    EXPECT_EQ(RenderError(Chain(kind.first, kind.twice, few) + kind.use + Last(few) + kind.after), "no error");
    std::string error;
    const double seconds = SecondsOf(
        [&] { error = RenderError(Chain(kind.first, kind.twice, many) + kind.use + Last(many) + kind.after); });
    EXPECT_LT(seconds, 5) << kind.twice;
    if (kind.multiplies) {
      // 2^10 - 1 evaluations of the tenth are fewer than the limit, those of the eleventh are more.
      static_assert(limits::kEvaluations >= 1023 && limits::kEvaluations < 2047);
      EXPECT_THAT(error, HasSubstr("test.pbrt:14:1: error: " + std::string(kind.what) +
                                   " within one another multiply to more than 2000 evaluations"))
          << kind.twice;
    } else {
      EXPECT_EQ(error, "no error") << kind.twice;
    }
  }
}

// As many evaluations as statements are allowed, because they are in proportion to the file.
TEST(HostileGraphs, OneOfManyIsNoMultiple) {
  std::string text, names;
  for (size_t i = 0; i <= limits::kEvaluations; ++i) {
    const std::string name = "\"x" + std::to_string(i) + "\" ";
    text += "LightFilter \"rod\" \"string name\" " + name + "\n";
    names += name;
  }
  text += "LightFilter \"combiner\" \"string filters\" [ " + names + "]\n";
  EXPECT_EQ(RenderError(text + kLit), "no error");
}

// A constant is no texture to be asked.
TEST(HostileGraphs, ConstantsAreNotAsked) {
  const std::string text =
      Chain("Texture \"x0\" \"float\" \"constant\" \"float value\" 0.5",
            "Texture \"x#\" \"float\" \"mix\" \"texture tex1\" \"x@\" \"texture tex2\" \"x@\"", 1000);
  EXPECT_EQ(RenderError(text + "Material \"dielectric\" \"texture roughness\" \"x999\"\n" + kLit), "no error");
}

TEST(HostileGraphs, MaterialsInReverseOrderAreCountedToo) {
  std::string text;
  constexpr int count = 12'000;
  for (int i = count; i > 0; --i) {
    const std::string next = "\"x" + std::to_string(i - 1) + "\"";
    text += "MakeNamedMaterial \"x" + std::to_string(i) + "\" \"string type\" \"mix\" \"string materials\" [ " + next +
            next + " ]\n";
  }
  text += "MakeNamedMaterial \"x0\" \"string type\" \"diffuse\"\n";
  EXPECT_THAT(RenderError(text + kLit), HasSubstr("test.pbrt:259:1: error: materials are mixed more than 256 deep"));
}

TEST(HostileGraphs, MotionsAreNestedToALimit) {
  const std::string first = "ObjectBegin \"x0\" Shape \"sphere\" ObjectEnd";
  const std::string next =
      "AttributeBegin ActiveTransform EndTime Translate 0.1 0 0 ActiveTransform All Translate 3 0 0 ObjectBegin \"x#\" "
      "Shape \"sphere\" ObjectInstance \"x@\" ObjectEnd AttributeEnd";
  const auto error = [&](size_t count, uint64_t memory) {
    return BuildError(kHead + Chain(first, next, count) + "ObjectInstance \"x" + Last(count), {}, memory);
  };
  EXPECT_EQ(error(50, 256 * kMebibyte), "no error");
  EXPECT_THAT(error(2000, 1024 * kMebibyte), HasSubstr("error: motions are nested more than 256 deep"));
  const PeakMemory peak;
  EXPECT_THAT(error(250, 10 * kMebibyte), HasSubstr("the motions of instances within one another take"));
  EXPECT_LT(peak.GrownBy(), 64);
}

// Twice as many of them take twice as long, and not four times. What is measured are tens of milliseconds.
TEST(HostileGraphs, NamesAreLookedUpInLinearTime) {
  constexpr size_t count = 20'000;
  const std::string named = Chain("MakeNamedMaterial \"x0\" \"string type\" \"diffuse\"",
                                  "MakeNamedMaterial \"x#\" \"string type\" \"diffuse\"", count);
  const std::string filters =
      Chain("LightFilter \"rod\" \"string name\" \"x0\" \"string linkingGroups\" \"g0\"",
            "LightFilter \"rod\" \"string name\" \"x#\" \"string linkingGroups\" \"g#\"", count);
  std::string systems = Chain("CoordinateSystem \"x0\"", "CoordinateSystem \"x#\"", count);
  systems += Chain("CoordSysTransform \"y0\"", "CoordSysTransform \"y#\"", count);
  for (const std::string& text : {named, filters, systems}) {
    std::string error;
    EXPECT_LT(SecondsOf([&] { error = RenderError(text + kLit); }), 5);
    EXPECT_EQ(error, "no error");
  }
}

// Each surface names a group of its own: their product is a table.
TEST(HostileGraphs, LinksMultiplyToALimit) {
  constexpr size_t count = 12'000;
  const auto text = [&](size_t surfaces) {
    const std::string filters = Chain("LightFilter \"rod\" \"string linkingGroups\" \"g0\"",
                                      "LightFilter \"rod\" \"string linkingGroups\" \"g#\"", count);
    return filters + kLit +
           Chain("Attribute \"lightfilter\" \"string subset\" \"g0\" Shape \"sphere\"",
                 "Attribute \"lightfilter\" \"string subset\" \"g#\" Shape \"sphere\"", surfaces);
  };
  EXPECT_EQ(BuildError(kHead + text(20)), "no error");
  const PeakMemory peak;
  EXPECT_THAT(
      BuildError(kHead + text(count)),
      HasSubstr("error: the attributes \"lighting\" and \"lightfilter\" make 12001 classes of surfaces, and tell "
                "12001 lights or filters apart: their product is more than 134217728"));
  EXPECT_LT(peak.GrownBy(), 256);
}

// A name that is of nothing is compared with others only where these are few.
TEST(HostileGraphs, UnknownNamesAreToldInLinearTime) {
  constexpr size_t count = 4'000;
  std::string text =
      Chain("LightSource \"point\" \"string name\" \"a0\"", "LightSource \"point\" \"string name\" \"a#\"", count);
  text += "Attribute \"lighting\" \"string subset\" [";
  for (size_t i = 0; i < 1000; ++i) text += " \"b" + std::to_string(i) + "\"";
  text += " ] Shape \"sphere\"\n";
  EXPECT_LT(SecondsOf([&] { EXPECT_EQ(BuildError(kHead + text), "no error"); }), 5);
}

TEST(HostileGraphs, ImportsDoNotCopyWhatTheyKeep) {
  const TemporaryFolder folder;
  folder.Write("f", "CoordinateSystem \"own\" Translate 1 0 0 CoordinateSystem \"x5\"");
  constexpr size_t count = 10'000;
  std::string text = "WorldBegin\n" + Chain("CoordinateSystem \"x0\"", "CoordinateSystem \"x#\"", count);
  for (size_t i = 0; i < count; ++i) text += "Import \"f\"\n";
  const std::string file =
      folder.Write("s.pbrt", text + "CoordSysTransform \"x5\" Shape \"sphere\" CoordSysTransform \"own\"");
  Diagnostics diagnostics(Diagnostics::Mode::Collect);
  SceneDescription scene;
  EXPECT_LT(SecondsOf([&] { scene = ReadScene(file, diagnostics); }), 5);
  // State that the imported file has set is gone afterwards, and state that it has changed is restored.
  EXPECT_EQ(scene.shapes.front().placement.start.Point(Point3d(0.0)), Point3d(0.0));
  ASSERT_EQ(diagnostics.Warnings().size(), 1u);
  EXPECT_THAT(diagnostics.Warnings().front(), HasSubstr("there is no coordinate system \"own\""));
}

}  // namespace
}  // namespace lampyr
