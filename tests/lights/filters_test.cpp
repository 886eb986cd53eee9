// Light filters one by one, against values worked out by hand.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "film/image.h"
#include "lights/filters/filter_type.h"
#include "scene/scene_description.h"
#include "support/temporary_folder.h"
#include "textures/texture_library.h"

namespace lampyr::test {
namespace {

std::unique_ptr<LightFilter> Make(const std::string& type, const std::string& parameters,
                                  const Transform& placement = Transform(),
                                  const std::vector<FilterInstance>& others = {}) {
  Diagnostics diagnostics(Diagnostics::Mode::Collect);
  const SceneDescription scene =
      ParseScene("WorldBegin\nLightFilter \"" + type + "\" " + parameters, "test.pbrt", diagnostics);
  const TextureLibrary textures({}, Transform(), diagnostics);
  FilterBuildContext build;
  build.transform = {placement.ToAffine(), placement.Inverse().ToAffine()};
  build.textures = &textures;
  build.find = [&](const std::string& name, const FileLocation& where) {
    for (const FilterInstance& other : others) {
      if (other.name == name) return other;
    }
    throw Error(where, "no " + name);
  };
  return MakeFilter(*FindFilterType(type), scene.lightFilters.at(0).filter.parameters, build);
}

struct Filtered {
  Color diffuse, specular;
};

// White light from `light` at `receiver`, filtered.
Filtered Filter(const LightFilter& filter, const Point3& receiver, const Point3& light,
                const uint8_t* enabled = nullptr) {
  Filtered result{Color(1.0f), Color(1.0f)};
  const Vector3 toLight = glm::normalize(light - receiver);
  const float distance = glm::distance(light, receiver);
  const PdfSolidAngle pdf(1);
  filter.Filter({0, enabled}, {1, &receiver, &toLight, &distance, &pdf, &result.diffuse, &result.specular});
  return result;
}

float Factor(const LightFilter& filter, const Point3& receiver, const Point3& light = Point3(0.0f)) {
  const Filtered result = Filter(filter, receiver, light);
  EXPECT_EQ(result.diffuse, result.specular);
  EXPECT_EQ(result.diffuse.r, result.diffuse.b);
  return result.diffuse.r;
}

constexpr float kNear = 2e-6f;

TEST(BarnFilter, IsAnOpeningWithDoors) {
  const auto barn =
      Make("barn", "\"float width\" 2 \"float height\" 1 \"float distance\" 2 \"float left\" 0.5 \"float edge\" 0.4");
  // The plane is z = -2; a receiver at z = -4 is seen through it at half its offset.
  EXPECT_EQ(Factor(*barn, {0, 0, -4}), 1);
  EXPECT_EQ(Factor(*barn, {1.98f, 0.98f, -4}), 1);
  EXPECT_EQ(Factor(*barn, {-0.98f, 0, -4}), 1);                     // the left door is shut by 0.5
  EXPECT_NEAR(Factor(*barn, {-1.4f, 0, -4}), 0.5f, 1e-5f);          // in the middle of the rim
  EXPECT_NEAR(Factor(*barn, {-1.2f, 0, -4}), 1 - 0.15625f, 1e-5f);  // a quarter: 3/16 − 2/64
  EXPECT_EQ(Factor(*barn, {-1.9f, 0, -4}), 0);
  EXPECT_EQ(Factor(*barn, {0, 1.9f, -4}), 0);
  EXPECT_EQ(Factor(*barn, {0, 0, 4}), 0);      // behind the light
  EXPECT_EQ(Factor(*barn, {0, 0, -1.9f}), 0);  // in front of the opening
  // The ray itself passes the opening: from another point on the light, at another position.
  EXPECT_EQ(Factor(*barn, {1.9f, 0, -4}, {1.9f, 0, 0}), 0);
  EXPECT_EQ(Factor(*barn, {3.9f, 0, -4}, {-1.9f, 0, 0}), 1);
  // From infinity.
  const Point3 receiver(0.5f, 0, -9);
  const Vector3 up(0, 0, 1);
  const float distance = kInfinity;
  const PdfSolidAngle pdf(1);
  Color diffuse(1.0f), specular(1.0f);
  barn->Filter({}, {1, &receiver, &up, &distance, &pdf, &diffuse, &specular});
  EXPECT_EQ(diffuse.r, 1);
}

TEST(BarnFilter, AnalyticLooksFromItsOrigin) {
  const auto barn = Make("barn", "\"string mode\" \"analytic\" \"float radius\" 0.5");
  // A disk of radius 0.5 at distance 1, wherever the light is.
  for (const Point3& light : {Point3(0.0f), Point3(3, 0, 0), Point3(0, 0, 7)}) {
    EXPECT_EQ(Factor(*barn, {0.98f, 0, -2}, light), 1);
    EXPECT_EQ(Factor(*barn, {1.02f, 0, -2}, light), 0);
    EXPECT_EQ(Factor(*barn, {0.75f, 0.75f, -2}, light), 0);
    EXPECT_EQ(Factor(*barn, {0.65f, 0.65f, -2}, light), 1);
  }
  EXPECT_EQ(Factor(*Make("barn", "\"float left\" 0.6 \"float right\" 0.5"), {0, 0, -2}), 0) << "shut";
}

TEST(RegionFilters, AreSpheresAndBoxes) {
  const auto sphere = Make("blocker", "\"float radius\" 1 \"float edge\" 1");
  EXPECT_EQ(Factor(*sphere, {0.9f, 0, 0}), 0);
  EXPECT_NEAR(Factor(*sphere, {0, 1.5f, 0}), 0.5f, kNear);
  EXPECT_EQ(Factor(*sphere, {0, 0, 2.1f}), 1);
  const auto box = Make("blocker",
                        "\"string shape\" \"box\" \"float width\" 2 \"float height\" 4 \"float depth\" 6 \"float "
                        "rounding\" 0.5 \"rgb color\" [0.25 0.25 0.25]");
  EXPECT_EQ(Factor(*box, {0.99f, 0, 0}), 0.25f);
  EXPECT_EQ(Factor(*box, {1.01f, 0, 0}), 1);
  EXPECT_EQ(Factor(*box, {0, 1.99f, 2}), 0.25f);
  EXPECT_EQ(Factor(*box, {0.9f, 1.9f, 0}), 1);  // beyond the rounded corner: 0.4²·2 > 0.5²
  EXPECT_EQ(Factor(*box, {0.8f, 1.8f, 0}), 0.25f);
  const auto rod = Make("rod", "\"float right\" 1 \"float bottom\" -0.25 \"float edge\" 2 \"float falloff\" 2");
  EXPECT_EQ(Factor(*rod, {1.4f, 0, 0}), 0);
  EXPECT_EQ(Factor(*rod, {-0.4f, 0, 0}), 0);
  EXPECT_NEAR(Factor(*rod, {2.5f, 0, 0}), 1 - 0.25f, kNear);  // half way out, squared
  EXPECT_NEAR(Factor(*rod, {0, -1.25f, 0}), 1 - 0.25f, kNear);
}

TEST(RampFilter, GoesByDistanceOrAngle) {
  const auto distance = Make("ramp", "\"float begin\" 1 \"float end\" 3");
  EXPECT_EQ(Factor(*distance, {0.5f, 0, 0}), 0);
  EXPECT_NEAR(Factor(*distance, {0, 2.5f, 0}), 0.75f, kNear);
  EXPECT_EQ(Factor(*distance, {0, 0, 4}), 1);
  const auto angle =
      Make("ramp",
           "\"string mode\" \"angle\" \"float knots\" [0 0.5 1] \"rgb colors\" [1 1 1 0.5 0.5 0.5 0 0 0] "
           "\"string interpolation\" \"smooth\"");
  EXPECT_EQ(Factor(*angle, {0, 0, -3}), 1);
  EXPECT_NEAR(Factor(*angle, {2, 0, -2}), 0.5f, kNear);                             // 45°
  EXPECT_NEAR(Factor(*angle, {0, std::tan(22.5f * kPi / 180), -1}), 0.75f, kNear);  // between, at its middle
  EXPECT_EQ(Factor(*angle, {1, 0, 0}), 0);
  EXPECT_EQ(Factor(*angle, {0, 0, 3}), 0);
  const auto steps =
      Make("ramp", "\"string interpolation\" \"constant\" \"float knots\" [0.2 0.6] \"rgb colors\" [3 3 3 2 2 2]");
  EXPECT_EQ(Factor(*steps, {0.1f, 0, 0}), 3);
  EXPECT_EQ(Factor(*steps, {0.5f, 0, 0}), 3);
  EXPECT_EQ(Factor(*steps, {0.7f, 0, 0}), 2);
}

// Four texels, each of another colour; the beam goes along −z.
TEST(BeamImages, LieUprightInTheBeam) {
  const TemporaryFolder folder;
  Image image(2, 2, {"R", "G", "B"});
  const float texels[] = {1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1};  // red, green; blue, white
  image.data.assign(std::begin(texels), std::end(texels));
  const std::string file = "\"string filename\" \"" + (folder / "texels.exr").string() + "\" ";
  WriteExr(folder / "texels.exr", image, ExrPrecision::Float);
  for (const char* type : {"gobo", "cookie"}) {
    const auto filter = Make(type, file + "\"float width\" 4 \"float height\" 2 \"rgb fill\" [0.5 0.5 0.5]");
    const auto at = [&](float x, float y) { return Filter(*filter, {2 * x, 2 * y, -2}, Point3(0.0f)).diffuse; };
    EXPECT_EQ(at(-1, 0.5f), Color(1, 0, 0)) << type;
    EXPECT_EQ(at(1, 0.5f), Color(0, 1, 0));
    EXPECT_EQ(at(-1, -0.5f), Color(0, 0, 1));
    EXPECT_EQ(at(1, -0.5f), Color(1.0f));
    EXPECT_EQ(at(0, 0), Color(0.5f));
    EXPECT_EQ(at(2.1f, 0), Color(0.5f));
    EXPECT_EQ(at(0, -1.1f), Color(0.5f));
    EXPECT_EQ(Filter(*filter, {0, 0, 2}, Point3(0.0f)).diffuse, Color(0.5f)) << "behind the light";
    const auto tiled = Make(type, file + "\"bool tile\" true \"rgb tint\" [2 1 1]");
    EXPECT_EQ(Filter(*tiled, {7.5f, 10.5f, -2}, Point3(0.0f)).diffuse, Color(2, 0, 0));
    EXPECT_EQ(Filter(*tiled, {-7.5f, 10.5f, -2}, Point3(0.0f)).diffuse, Color(0, 1, 0));
    // The blur is so wide that nothing is left of the pattern, and the fill contributes.
    const auto blurred = Make(type, file + "\"bool tile\" true \"float blur\" 1");
    EXPECT_NEAR(Filter(*blurred, {0.3f, 0.4f, -2}, Point3(0.0f)).diffuse.r, 0.5f, 0.01f);
    const auto faded = Make(type, file + "\"float blur\" 0.5");
    EXPECT_NEAR(Filter(*faded, {1, 1, -2}, Point3(0.0f)).diffuse.Average(), 0.5f * (0.4444f * 0.5f), 0.1f);
  }
  // A large image is blurred at no more texels than that takes: half black, half white, and between them the integral
  // of a Gaussian.
  Image large(3000, 7, {"R", "G", "B"});
  for (int y = 0; y < 7; ++y) {
    for (int x = 1500; x < 3000; ++x) large.At(x, y, 0) = large.At(x, y, 1) = large.At(x, y, 2) = 1;
  }
  WriteExr(folder / "large.exr", large, ExrPrecision::Float);
  const auto step = Make("gobo", "\"string filename\" \"" + (folder / "large.exr").string() +
                                     "\" \"float blur\" 0.04 \"rgb fill\" [0 0 0]");
  for (const float x : {-0.1f, -0.04f, 0.0f, 0.02f, 0.08f}) {
    EXPECT_NEAR(Filter(*step, {2 * x, 0, -2}, Point3(0.0f)).diffuse.r, 0.5f * std::erfc(-x / 0.04f / std::sqrt(2.0f)),
                4e-3f)
        << x;
  }
  // Of the two, only the gobo's image moves with the point on the light.
  const auto gobo = Make("gobo", file), cookie = Make("cookie", file);
  EXPECT_EQ(Filter(*gobo, {0.25f, 0.25f, -2}, {0.25f, 0.25f, 0}).diffuse, Color(0, 1, 0));
  EXPECT_EQ(Filter(*gobo, {0.25f, 0.25f, -2}, {-0.75f, 0.25f, 0}).diffuse, Color(1, 0, 0));
  EXPECT_EQ(Filter(*cookie, {0.5f, 0.5f, -2}, {-0.75f, 0.25f, 0}).diffuse, Color(0, 1, 0));
}

TEST(IntMultFilter, MultipliesAndSaturates) {
  const auto filter = Make("intmult", "\"float intensity\" 3 \"float exposure\" 1 \"rgb tint\" [1 0.5 0]");
  EXPECT_EQ(Filter(*filter, {0, 0, 0}, {1, 0, 0}).diffuse, Color(6, 3, 0));
  EXPECT_NEAR(filter->GetRadianceModifier().value(), 3, kNear);
  // Half of the effect lies half way to the whole.
  const std::string deep = "\"rgb tint\" [1 0.3 0.2] \"float saturation\" 1.4 ";
  const Color whole = Filter(*Make("intmult", deep), {0, 0, 0}, {1, 0, 0}).diffuse;
  const Color half = Filter(*Make("intmult", deep + "\"float density\" 0.5"), {0, 0, 0}, {1, 0, 0}).diffuse;
  EXPECT_NEAR(half.r, 0.5f + 0.5f * whole.r, kNear);
  EXPECT_NEAR(half.g, 0.5f + 0.5f * whole.g, kNear);
  EXPECT_NEAR(Make("intmult", deep)->GetRadianceModifier().value(), std::max(whole.Average(), 0.5f), kNear);
  const auto grey = Make("intmult", "\"rgb tint\" [1 0 0] \"float saturation\" 0");
  EXPECT_NEAR(Filter(*grey, {0, 0, 0}, {1, 0, 0}).diffuse.g, Color(1, 0, 0).Luminance(), kNear);
}

TEST(FilterSettings, DensityInvertAndLobes) {
  const auto Blocker = [](const std::string& settings) { return Make("blocker", "\"float radius\" 1 " + settings); };
  const Point3 inside(0.0f), outside(2, 0, 0), light(0, 9, 0);
  EXPECT_EQ(Filter(*Blocker("\"float density\" 0.25"), inside, light).diffuse, Color(0.75f));
  EXPECT_EQ(Filter(*Blocker("\"bool invert\" true"), inside, light).diffuse, Color(1.0f));
  EXPECT_EQ(Filter(*Blocker("\"bool invert\" true"), outside, light).diffuse, Color(0.0f));
  const Filtered lobes =
      Filter(*Blocker("\"float diffuse\" 0.5 \"float density\" 0.5 \"float specular\" 0"), inside, light);
  EXPECT_EQ(lobes.diffuse, Color(0.75f));
  EXPECT_EQ(lobes.specular, Color(1.0f));
  EXPECT_TRUE(Blocker("\"float density\" 0")->IsIdentity());
  EXPECT_FALSE(Blocker("")->IsIdentity());
  EXPECT_FALSE(Blocker("")->GetRadianceModifier());
  EXPECT_EQ(*Blocker("\"string linkingGroups\" \" a ,b, \"")->GetProperty(FilterProperty::LinkingGroups),
            (std::vector<std::string>{"a", "b"}));
}

// Moved, turned, and stretched.
TEST(FilterSettings, AreInTheFiltersOwnSpace) {
  const Transform placement =
      Transform::Translate({5, 0, 0}) * Transform::Rotate(-90, {1, 0, 0}) * Transform::Scale({2, 1, 1});
  const auto barn = Make("barn", "", placement);  // it looks down
  EXPECT_EQ(Factor(*barn, {6.9f, -2, 0}, {5, 0, 0}), 1);
  EXPECT_EQ(Factor(*barn, {7.1f, -2, 0}, {5, 0, 0}), 0);
  EXPECT_EQ(Factor(*barn, {5, -2, 0.9f}, {5, 0, 0}), 1);
  EXPECT_EQ(Factor(*barn, {5, -2, 1.1f}, {5, 0, 0}), 0);
}

TEST(CombinerFilter, CombinesByModeThenMultiplies) {
  std::vector<FilterInstance> others;
  const auto add = [&](const char* name, CombineMode mode, const char* intensity, uint32_t linking = 0) {
    others.push_back({Make("intmult", "\"float intensity\" " + std::string(intensity)), name, mode, linking});
  };
  add("a", CombineMode::Max, "0.5");
  add("b", CombineMode::Max, "0.25");
  add("c", CombineMode::Min, "0.5");
  add("d", CombineMode::Min, "0.125", 1);
  add("e", CombineMode::Screen, "0.5");
  add("f", CombineMode::Screen, "0.75");
  add("g", CombineMode::Multiply, "3");
  add("h", CombineMode::Multiply, "2");
  const auto all = Make("combiner", "\"string filters\" [ \"a, b\" \"c\" \"d,e,f,g,h\" ]", Transform(), others);
  const auto factor = [&](const LightFilter& filter, const uint8_t* enabled) {
    return Filter(filter, Point3(0.0f), {1, 0, 0}, enabled).diffuse.g;
  };
  const uint8_t on[] = {1, 1}, off[] = {1, 0};
  EXPECT_NEAR(factor(*all, on), 0.5f * 0.125f * 0.875f * 6, kNear);
  EXPECT_NEAR(factor(*all, off), 0.5f * 0.5f * 0.875f * 6, kNear);
  EXPECT_NEAR(
      factor(*Make("combiner", "\"string filters\" \"a,b,g\" \"string mode\" \"min\"", Transform(), others), on), 0.25f,
      kNear);
  EXPECT_FALSE(all->GetRadianceModifier());
  EXPECT_NEAR(Make("combiner", "\"string filters\" \"g,h\"", Transform(), others)->GetRadianceModifier().value(), 6,
              kNear);
  // A product that no float holds is not 0: a light of 1e30 shines through both, and must have a chance.
  add("i", CombineMode::Multiply, "1e-25");
  add("j", CombineMode::Multiply, "1e-26");
  EXPECT_GT(Make("combiner", "\"string filters\" \"i,j\"", Transform(), others)->GetRadianceModifier().value(), 0);
  add("k", CombineMode::Multiply, "0");
  EXPECT_EQ(Make("combiner", "\"string filters\" \"i,k\"", Transform(), others)->GetRadianceModifier().value(), 0);
  // A batch that is larger than what it combines at once.
  constexpr int count = 1000;
  std::vector<Point3> receivers(count);
  std::vector<Vector3> directions(count, Vector3(0, 0, 1));
  std::vector<float> distances(count, 1.0f);
  std::vector<PdfSolidAngle> pdfs(count, PdfSolidAngle(1));
  std::vector<Color> diffuse(count, Color(1.0f)), specular(count, Color(2.0f));
  all->Filter({0, on}, {count, receivers.data(), directions.data(), distances.data(), pdfs.data(), diffuse.data(),
                        specular.data()});
  for (int i = 0; i < count; ++i) {
    EXPECT_EQ(diffuse[i], diffuse[0]);
    EXPECT_EQ(specular[i], diffuse[0] * 2);
  }
}

std::string MakeError(const std::string& type, const std::string& parameters) {
  try {
    Make(type, parameters);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(FilterErrors, SayWhatWouldBeRight) {
  EXPECT_EQ(MakeError("barn", "\"float widht\" 1"),
            "test.pbrt:2:20: error: LightFilter \"barn\" has no parameter \"widht\" (did you mean \"width\"?)");
  EXPECT_EQ(MakeError("barn", "\"float width\" -1"),
            "test.pbrt:2:20: error: LightFilter \"barn\": parameter \"width\" is out of range: > 0 is allowed");
  EXPECT_EQ(MakeError("gobo", ""), "test.pbrt:2:1: error: LightFilter \"gobo\" needs a \"string filename\"");
  EXPECT_EQ(
      MakeError("cookie", "\"string filename\" \"nowhere.png\" \"string mode\" \"physicl\""),
      "test.pbrt:2:54: error: LightFilter \"cookie\": \"mode\" is physical or analytic, not \"physicl\" (did you mean "
      "\"physical\"?)");
  EXPECT_EQ(MakeError("rod", "\"float left\" -2"),
            "test.pbrt:2:1: error: LightFilter \"rod\": its sides leave nothing of the box");
  EXPECT_EQ(MakeError("ramp", "\"float knots\" [0 0.5 1]"),
            "test.pbrt:2:1: error: LightFilter \"ramp\": 3 \"knots\" and 2 \"colors\" must be as many");
  EXPECT_EQ(MakeError("combiner", ""),
            "test.pbrt:2:1: error: LightFilter \"combiner\" needs the names of its \"filters\"");
  EXPECT_EQ(MakeError("blocker", "\"string combineMode\" \"mx\""), "no error");  // whoever holds it reads that
}

}  // namespace
}  // namespace lampyr::test
