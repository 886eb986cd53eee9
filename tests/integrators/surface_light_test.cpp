// Lights that are their own surface, in scenes: light sampling, directions of the receiver's and photons find the same
// light in the same place, with the same texture, still and moving; the camera sees them where they are.
#include <gtest/gtest.h>

#include <cmath>

#include "film/image.h"
#include "sampling/rng.h"
#include "sampling/warp.h"
#include "support/estimate.h"
#include "support/render_scene.h"
#include "support/temporary_folder.h"

namespace lampyr::test {
namespace {

// A 2 × 2 picture, one value for each quarter: upper left 1, upper right 2, lower left 4, lower right 8.
void WriteQuarters(const std::filesystem::path& file) {
  Image image(2, 2, {"R", "G", "B"});
  for (int i = 0; i < 4; ++i) {
    for (size_t c = 0; c < 3; ++c) image.At(i % 2, i / 2, c) = static_cast<float>(1 << i);
  }
  WriteExr(file, image, ExrPrecision::Float);
}

const std::string kHead = R"(Film "rgb" "integer xresolution" 4 "integer yresolution" 4
Camera "perspective"
WorldBegin
)";

const std::vector<std::string>& Types() {
  static const std::vector<std::string> types = {"\"rect\" \"float width\" 1.4 \"float height\" 0.8",
                                                 "\"disk\" \"float radius\" 0.6", "\"sphere\" \"float radius\" 0.45",
                                                 "\"cylinder\" \"float length\" 1.2 \"float radius\" 0.3"};
  return types;
}

// Above the receiver at the origin, which faces +y.
const std::vector<std::string>& Places() {
  static const std::vector<std::string> places = {
      "Translate 0.2 1.2 0.1 Rotate -90 1 0 0\n",
      "Translate 0.3 1.1 0 Rotate -120 1 0.3 0.2 Scale 1.3 0.7 0.9\n",
      "Translate -0.2 1 0.3 Scale -1 1 1 Rotate -70 1 0 0.4\n",
      "ConcatTransform [1 0 0.2 0  0.6 1 0 0  0 0.3 1 0  0 1.3 0 1] Rotate -80 1 0 0\n",
      "ActiveTransform StartTime Translate -0.8 1.2 0.1 Rotate -60 1 0 0\n"
      "ActiveTransform EndTime Translate 0.7 1 0 Rotate -130 1 0.2 0 Scale 1.2 0.8 1\nActiveTransform All\n",
      "Translate 0 1.2 0 Rotate -90 1 0 0\nActiveTransform EndTime Translate 0.6 0 0\nActiveTransform All\n"};
  return places;
}

BuiltScene Build(const std::string& text) {
  Diagnostics diagnostics(Diagnostics::Mode::Collect);
  return BuildScene(ParseScene(kHead + text, "test.pbrt", diagnostics), {}, true, diagnostics);
}

SurfacePoint ReceiverPoint() {
  SurfacePoint point;
  point.Ng = point.Ns = {0, 1, 0};
  return point;
}
const Receiver kReceiver{Point3(0.0f), {0, 1, 0}, false};

// At the origin, over the shutter: by light sampling, and by directions that know nothing of the light.
struct Found {
  Estimate irradiance;
  Estimate share;  // of the samples that arrive; ∫ selection · pdfDirect over the hemisphere
};
Found ByLight(const BuiltScene& built, int count) {
  const LightingServices& lighting = *built.scene.lighting;
  Rng rng(1);
  Found result;
  for (int i = 0; i < count; ++i) {
    const float time = built.scene.hasMotion ? rng.NextFloat() : 0.0f, uSelect = rng.NextFloat();
    const DirectSample direct = SampleOneLight(lighting, kReceiver, uSelect, rng.NextPoint2(), time, false);
    double x = 0, arrives = 0;
    if (direct && direct.sample->direction.y > 0) {
      arrives = static_cast<double>(lighting.Transmittance(ReceiverPoint(), direct, time).g);
      x = arrives * static_cast<double>(direct.sample->diffuse.g * direct.sample->direction.y /
                                        (direct.selection * direct.sample->pdfDirect).value);
    }
    result.irradiance.Add(x);
    result.share.Add(arrives);
  }
  return result;
}

Found ByDirections(const BuiltScene& built, int count) {
  const LightingServices& lighting = *built.scene.lighting;
  Rng rng(2);
  Found result;
  for (int i = 0; i < count; ++i) {
    const float time = built.scene.hasMotion ? rng.NextFloat() : 0.0f;
    Vector3 direction = SampleUniformSphere(rng.NextPoint2());
    direction.y = std::abs(direction.y);
    const Ray ray{Point3(0.0f), direction, kInfinity, time};
    double x = 0, density = 0;
    RayHit hit;
    if (built.scene.geometry->Intersect(ray, visibility::kIndirect, hit)) {
      const SurfacePoint point = built.scene.geometry->GetSurfacePoint(ray, hit);
      const auto found =
          lighting.EvaluateSamples(kReceiver, direction, glm::length(point.position), point, time, false);
      if (found) {
        x = static_cast<double>(found->evaluation.diffuse.g * direction.y * 2 * kPi);
        density = static_cast<double>((found->selection * found->evaluation.pdfDirect).value * 2 * kPi);
      }
    }
    result.irradiance.Add(x);
    result.share.Add(density);
  }
  return result;
}

TEST(SurfaceLight, FoundAloneAndSampledAloneAreTheSameLight) {
  const TemporaryFolder folder;
  WriteQuarters(folder / "quarters.exr");
  const std::string texture = " \"string texture:file\" \"" + (folder / "quarters.exr").string() + "\"";
  int cases = 0;
  for (const std::string& type : Types()) {
    for (const std::string& place : Places()) {
      for (const std::string& setting : {std::string(), texture, texture + " \"bool twoSided\" true"}) {
        const std::string what = type + setting + "\n" + place;
        const BuiltScene built = Build(place + "LightSource " + type + setting);
        EXPECT_EQ(built.scene.hasMotion, place.find("Active") != std::string::npos) << what;
        const Found light = ByLight(built, 30000), found = ByDirections(built, 200000);
        const double mean = light.irradiance.Mean();
        const double sigma = std::sqrt(light.irradiance.Variance() + found.irradiance.Variance());
        ASSERT_GT(mean, 0.05) << what;
        EXPECT_LT(sigma, 0.02 * mean) << what;
        EXPECT_NEAR(found.irradiance.Mean(), mean, 4.5 * sigma) << what;
        const double shareSigma = std::sqrt(light.share.Variance() + found.share.Variance());
        EXPECT_GT(light.share.Mean(), 0.2) << what;
        EXPECT_NEAR(found.share.Mean(), light.share.Mean(), 4.5 * shareSigma) << what;
        ++cases;
      }
    }
  }
  std::printf("%d cases\n", cases);
}

TEST(SurfaceLight, SamplesAndHitsAreTheSamePoints) {
  const TemporaryFolder folder;
  WriteQuarters(folder / "quarters.exr");
  int compared = 0, missed = 0;
  for (const std::string& type : Types()) {
    for (const std::string& place : Places()) {
      const BuiltScene built = Build(place + "LightSource " + type + " \"string texture:file\" \"" +
                                     (folder / "quarters.exr").string() + "\"");
      const LightingServices& lighting = *built.scene.lighting;
      Rng rng(3);
      for (int i = 0; i < 300; ++i) {
        const float time = built.scene.hasMotion ? rng.NextFloat() : 0.0f;
        const DirectSample direct = SampleOneLight(lighting, kReceiver, 0.5f, rng.NextPoint2(), time, true);
        if (!direct) continue;
        const LightSample& sample = *direct.sample;
        const Ray ray{Point3(0.0f), sample.direction, kInfinity, time};
        RayHit hit;
        const bool isHit = built.scene.geometry->Intersect(ray, visibility::kIndirect, hit);
        if (!isHit || std::abs(hit.t - sample.distance) > 1e-3f) {  // the rim
          ++missed;
          continue;
        }
        const SurfacePoint point = built.scene.geometry->GetSurfacePoint(ray, hit);
        ++compared;
        const float cosine = AbsDot(sample.direction, sample.normal);
        if (cosine < 0.05f) continue;
        EXPECT_LT(glm::distance(point.position, sample.position), 1e-5f / cosine) << type << place;
        EXPECT_GT(glm::dot(point.Ng, sample.normal), 0.9999f) << type << place;
        const auto found = lighting.EvaluateSamples(kReceiver, ray.direction, hit.t, point, time, true);
        ASSERT_TRUE(found) << type << place;
        EXPECT_NEAR(found->evaluation.pdfDirect.value / sample.pdfDirect.value, 1, 2e-3f / cosine) << type << place;
        EXPECT_NEAR(found->evaluation.pdfEmit.value / sample.pdfEmit.value, 1, 2e-3f) << type << place;
        EXPECT_NEAR(point.uv.x, sample.uvw.x, 1e-3f) << type << place;
        EXPECT_NEAR(point.uv.y, sample.uvw.y, 1e-3f) << type << place;
      }
    }
  }
  EXPECT_GT(compared, 5000);
  EXPECT_LT(missed, compared / 100);
}

// The camera looks along +z: x right, y up. Values of the picture's quarters.
std::vector<double> Seen(const std::string& light, const std::string& place) {
  const std::string scene = R"(Film "rgb" "integer xresolution" 4 "integer yresolution" 4
PixelFilter "box"
Camera "orthographic" "float screenwindow" [-1 1 -1 1]
WorldBegin
)";
  const Image image = RenderText(scene + place + "LightSource " + light, 4096).image;
  std::vector<double> values;
  for (int y = 0; y < 4; ++y) {
    for (int x = 0; x < 4; ++x) values.push_back(static_cast<double>(image.At(x, y, 1)));
  }
  return values;
}

TEST(SurfaceLight, CameraSeesItUprightWhereItIs) {
  const TemporaryFolder folder;
  WriteQuarters(folder / "quarters.exr");
  const std::string rect = "\"rect\" \"float width\" 2 \"float height\" 2";
  const std::string texture = " \"string texture:file\" \"" + (folder / "quarters.exr").string() + "\"";
  // The light emits along -z, towards the camera: its left side at +x is on the camera's right, pbrt's camera space
  // being left-handed. The outer pixels' corners are texel centres or beyond: plain values.
  const std::vector<double> seen = Seen(rect + texture, "Translate 0 0 3\n");
  EXPECT_NEAR(seen[0], 2, 0.01);
  EXPECT_NEAR(seen[3], 1, 0.01);
  EXPECT_NEAR(seen[12], 8, 0.01);
  EXPECT_NEAR(seen[15], 4, 0.01);
  // From behind it is black and opaque; invisible, it is not there.
  const std::string sky = "LightSource \"infinite\" \"rgb L\" [0.25 0.25 0.25]\n";
  for (const double x : Seen(rect, sky + "Translate 0 0 3 Rotate 180 0 1 0\n")) EXPECT_EQ(x, 0);
  for (const double x : Seen(rect + " \"bool cameraVisible\" false", sky + "Translate 0 0 3\n")) EXPECT_EQ(x, 0.25);
  for (const double x : Seen(rect, sky + "Translate 0 0 3\n")) EXPECT_EQ(x, 1);
  // Half of the width, and moving by it: x from -1 to 0, then 0 to 1.
  const std::string half = "\"rect\" \"float width\" 1 \"float height\" 2";
  const std::vector<double> moving =
      Seen(half, "Translate -0.5 0 3\nActiveTransform EndTime Translate 1 0 0\nActiveTransform All\n");
  for (int i = 0; i < 16; ++i) {
    const double covered = i % 4 == 0 || i % 4 == 3 ? 0.25 : 0.75;
    EXPECT_NEAR(moving[i], covered, 0.03) << i;
  }
}

}  // namespace
}  // namespace lampyr::test
