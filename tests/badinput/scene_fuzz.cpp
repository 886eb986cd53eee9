// Thousands of damaged copies of a valid scene: each is read, or refused with an Error that has a place; none crashes.
#include <random>

#include "scene/spectrum.h"
#include "unit/scene/scene_support.h"

namespace lampyr {
namespace {

constexpr const char* kScene = R"(# every statement once
Option "seed" 3
LookAt 0 0 5  0 0 0  0 1 0
Camera "perspective" "float fov" [ 45 ] "float screenwindow" [ -1 1 -1 1 ]
Film "rgb" "integer xresolution" 64 "string filename" "a \"b\".exr" "bool savefp16" false
PixelFilter "gaussian" Sampler "halton" "integer pixelsamples" 4 Integrator "path"
TransformTimes 0 1 ActiveTransform EndTime Translate 0 1 0 ActiveTransform All
ColorSpace "rec2020"
WorldBegin
MakeNamedMedium "fog" "string type" "homogeneous" "rgb sigma_a" [ 1 1 1 ]
MakeNamedMedium "smoke" "string type" "uniformgrid" "integer nx" 2 "float density" [ 1 .5 ] "float temperature" [ 900 99 ]
MediumInterface "fog" ""
Texture "t" "spectrum" "imagemap" "string filename" "t.png"
MakeNamedMaterial "m" "string type" "diffuse" "texture reflectance" "t"
LightSource "distant" "blackbody L" 5000 "point3 from" [ 1 2 3 ] "spectrum x" [ 400 1 700 2 ]
AttributeBegin
  Attribute "shape" "float alpha" .5
  Rotate 30 0 1 0 Scale 1 2 3 CoordinateSystem "c"
  AreaLightSource "diffuse" "rgb L" [ 1 2 3 ] "spectrum y" "metal-Au-eta"
  NamedMaterial "m" ReverseOrientation
  Shape "trianglemesh" "point3 P" [ -1 0 -1 -1 0 1 1e0 .0 +1 ] "integer indices" [ 0 1 2 ] "normal N" [ 0 0 1 0 0 1 0 0 1 ]
AttributeEnd
ObjectBegin "o" ConcatTransform [ 1 0 0 0 0 1 0 0 0 0 1 0 1 2 3 1 ] Shape "sphere" ObjectEnd
ObjectBegin "p" ObjectInstance "o" ObjectEnd
CoordSysTransform "c" ObjectInstance "p" Identity
Attribute "lighting" "string subset" [ "keys" ] LightFilter "gobo" "string name" "leaves"
)";

// Bytes that mean something to the grammar come more often than others.
char RandomByte(std::mt19937& random) {
  constexpr std::string_view kSpecial = "\"[]#\\\n\r \t.-+eE0123456789\0\xff\xc3";
  return random() % 2 ? kSpecial[random() % kSpecial.size()] : static_cast<char>(random() % 256);
}

std::string Damaged(std::string text, std::mt19937& random) {
  const int changes = random() % 3 == 0 ? 2 + static_cast<int>(random() % 3) : 1;
  for (int i = 0; i < changes && !text.empty(); ++i) {
    const size_t at = random() % text.size();
    const size_t length = std::min<size_t>(random() % 40, text.size() - at);
    switch (random() % 11) {
      case 0:
      case 1:
      case 2:
        text[at] = RandomByte(random);
        break;
      case 3:
      case 4:
        text.insert(at, 1, RandomByte(random));
        break;
      case 5:
      case 6:
        text.erase(at, 1);
        break;
      case 7:
      case 8:
        text.erase(at, length);
        break;
      case 9:
        text.insert(random() % text.size(), text.substr(at, length));
        break;
      default:
        text.resize(at);
        break;
    }
  }
  return text;
}

// Asks for everything in every way; the getters must throw Errors at worst.
void ReadAllParameters(const ParameterList& list) {
  for (const Parameter& parameter : list.All()) {
    const std::string& name = parameter.name;
    const auto attempt = [](const auto& read) { ErrorOf(read); };
    attempt([&] { list.GetFloat(name, 0); });
    attempt([&] { list.GetInteger(name, 0); });
    attempt([&] { list.GetBool(name, false); });
    attempt([&] { list.GetString(name, ""); });
    attempt([&] { list.GetPoint2s(name); });
    attempt([&] { list.GetPoint3s(name); });
    attempt([&] { list.GetFile(name); });
    for (const SpectrumRole role : {SpectrumRole::Albedo, SpectrumRole::Unbounded, SpectrumRole::Illuminant}) {
      attempt([&] {
        for (const Color& color : list.GetColors(name, role)) EXPECT_TRUE(color.IsValid()) << name;
      });
    }
  }
}

void ReadAllParameters(const SceneDescription& scene) {
  ReadAllParameters(scene.camera.parameters);
  ReadAllParameters(scene.film.parameters);
  for (const auto& light : scene.lights) ReadAllParameters(light.light.parameters);
  for (const auto& light : scene.areaLights) ReadAllParameters(light.parameters);
  for (const auto& shape : scene.shapes) ReadAllParameters(shape.shape.parameters);
}

TEST(SceneFuzz, DamagedScenesAreReadOrRefused) {
  std::mt19937 random(20240217);
  int read = 0, refused = 0;
  for (int i = 0; i < 6000; ++i) {
    const std::string text = Damaged(kScene, random);
    Diagnostics diagnostics(Diagnostics::Mode::Collect);
    try {
      const SceneDescription scene = ParseScene(text, "fuzz.pbrt", diagnostics);
      ++read;
      if (read % 8 == 0) ReadAllParameters(scene);
    } catch (const Error& error) {
      ++refused;
      ASSERT_GT(error.Where().line, 0) << error.what() << "\n" << text;
      ASSERT_GT(error.Where().column, 0) << error.what() << "\n" << text;
      ASSERT_FALSE(error.Text().empty());
    }
  }
  EXPECT_GT(read, 500);
  EXPECT_GT(refused, 1000);
  std::printf("[   info   ] %d read, %d refused\n", read, refused);
}

TEST(SceneFuzz, TheSceneItselfIsRead) {
  Diagnostics diagnostics(Diagnostics::Mode::Collect);
  const SceneDescription scene = ParseScene(kScene, "fuzz.pbrt", diagnostics);
  EXPECT_EQ(scene.shapes.size(), 1u);
  ReadAllParameters(scene);
}

TEST(SceneFuzz, DamagedGzipFilesAreReadOrRefused) {
  const TemporaryFolder folder;
  const std::string bytes = ReadAll(folder.WriteGzipped("s.gz", kScene));
  std::mt19937 random(7);
  for (int i = 0; i < 300; ++i) {
    const auto file = folder.Write("s.gz", Damaged(bytes, random));
    EXPECT_FALSE(ReadError(file).empty());
  }
}

TEST(SceneFuzz, NoiseIsRefused) {
  std::mt19937 random(11);
  for (int i = 0; i < 500; ++i) {
    std::string text(random() % 200, ' ');
    for (char& c : text) c = RandomByte(random);
    EXPECT_NE(ParseError(text), "no error");
  }
}

}  // namespace
}  // namespace lampyr
