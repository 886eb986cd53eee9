// Scenes whose radiance is known in closed form.
#include <gtest/gtest.h>

#include <cmath>

#include "support/render_scene.h"

namespace lampyr::test {
namespace {

const std::string kSmallFilm = R"(Film "rgb" "integer xresolution" 16 "integer yresolution" 16
PixelFilter "box"
)";

// Mean within four standard errors, and that error itself small enough for the test to mean something.
void ExpectMean(const Image& image, double expected, double largestRelativeError) {
  const MeanValue value = MeanOf(image);
  EXPECT_LT(value.standardError, largestRelativeError * expected);
  EXPECT_NEAR(value.mean, expected, 4 * value.standardError + 2e-6 * expected);
}

double FresnelNormal(double eta) {
  return std::pow((eta - 1) / (eta + 1), 2);
}

// By each integrator that finds all of this light.
class Analytic : public testing::TestWithParam<const char*> {
 protected:
  static Rendered Render(const std::string& text, int samplesPerPixel, RenderOverrides overrides = {},
                         int threads = 1) {
    overrides.integrator = GetParam();
    return RenderText(text, samplesPerPixel, overrides, threads);
  }
};
INSTANTIATE_TEST_SUITE_P(Of, Analytic, testing::Values("path", "bdpt"), [](const auto& info) { return info.param; });

TEST_P(Analytic, ClosedFurnace) {
  // L = E / (1 - ρ) everywhere inside a closed surface that emits E and reflects ρ.
  for (const double reflectance : {0.2, 0.5, 0.8}) {
    const auto rendered = Render(kSmallFilm + R"(Camera "perspective" "float fov" 70
Integrator "path" "integer maxdepth" 400
WorldBegin
AreaLightSource "diffuse" "rgb L" [1 1 1]
Material "diffuse" "rgb reflectance" [)" +
                                     std::to_string(reflectance) + " " + std::to_string(reflectance) + " " +
                                     std::to_string(reflectance) + R"(]
ReverseOrientation
Shape "sphere" "float radius" 3
)",
                                 256);
    ExpectMean(rendered.image, 1 / (1 - reflectance), 0.01);
    EXPECT_EQ(rendered.outcome.counts.droppedSamples, 0u);
  }
}

TEST_P(Analytic, FurnaceInABoxOfTriangles) {
  const auto rendered = Render(kSmallFilm + R"(Camera "perspective" "float fov" 70
Integrator "path" "integer maxdepth" 400
WorldBegin
AreaLightSource "diffuse" "rgb L" [1 1 1]
Material "diffuse" "rgb reflectance" [0.5 0.5 0.5]
Shape "trianglemesh" "point3 P" [-1 -1 -1  1 -1 -1  1 1 -1  -1 1 -1  -1 -1 1  1 -1 1  1 1 1  -1 1 1]
  "integer indices" [0 1 2 0 2 3  4 6 5 4 7 6  0 5 1 0 4 5  3 2 6 3 6 7  0 3 7 0 7 4  1 5 6 1 6 2]
)",
                               256);
  ExpectMean(rendered.image, 2.0, 0.01);
}

TEST_P(Analytic, PointLightInADiffuseSphere) {
  // Direct light only: E = I / r², L = ρ/π · I / r².
  const auto rendered = Render(kSmallFilm + R"(Camera "perspective" "float fov" 60
Integrator "path" "integer maxdepth" 1
WorldBegin
LightSource "point" "rgb I" [10 10 10]
Material "diffuse" "rgb reflectance" [0.5 0.5 0.5]
Shape "sphere" "float radius" 2
)",
                               16);
  const MeanValue value = MeanOf(rendered.image);
  EXPECT_NEAR(value.mean, 0.5 / M_PI * 10 / 4, 1e-4 + 4 * value.standardError);
  EXPECT_LT(value.standardError, 0.01);
}

TEST_P(Analytic, SquareLightOverAPlane) {
  // Irradiance under the middle of a parallel square of half side a at height h, by Lambert's formula.
  const double a = 0.5, h = 1;
  const double q = a / std::sqrt(a * a + h * h);
  const double formFactor = 4 / M_PI * q * std::atan(q);  // 4 quarters, each (2/2π)·q·atan(q)
  // The camera sees a tiny patch around the point straight below the light.
  const auto rendered = Render(kSmallFilm + R"(LookAt 0 0.5 2  0 0 0  0 1 0
Camera "perspective" "float fov" 0.2
Integrator "path" "integer maxdepth" 1
WorldBegin
Material "diffuse" "rgb reflectance" [0.5 0.5 0.5]
Shape "trianglemesh" "point3 P" [-5 0 -5 -5 0 5 5 0 5 5 0 -5] "integer indices" [0 1 2 0 2 3]
AreaLightSource "diffuse" "rgb L" [1 1 1]
Shape "trianglemesh" "point3 P" [-0.5 1 -0.5 0.5 1 -0.5 0.5 1 0.5 -0.5 1 0.5] "integer indices" [0 1 2 0 2 3]
)",
                               1024);
  ExpectMean(rendered.image, 0.5 * formFactor, 0.002);
}

TEST_P(Analytic, SphereLightOverAPlane) {
  // Irradiance under a sphere of radius r at distance d: π L (r/d)².
  const auto rendered = Render(kSmallFilm + R"(LookAt 0 0.5 2  0 0 0  0 1 0
Camera "perspective" "float fov" 0.2
Integrator "path" "integer maxdepth" 1
WorldBegin
Material "diffuse" "rgb reflectance" [0.5 0.5 0.5]
Shape "trianglemesh" "point3 P" [-5 0 -5 -5 0 5 5 0 5 5 0 -5] "integer indices" [0 1 2 0 2 3]
AttributeBegin
AreaLightSource "diffuse" "rgb L" [7 7 7]
Translate 0 2 0
Shape "sphere" "float radius" 0.5
AttributeEnd
)",
                               256);
  ExpectMean(rendered.image, 0.5 * 7 * std::pow(0.5 / 2, 2), 0.002);
}

TEST_P(Analytic, DistantLightOnAPlane) {
  const auto rendered = Render(kSmallFilm + R"(LookAt 0 1 2  0 0 0  0 1 0
Camera "perspective" "float fov" 1
Integrator "path" "integer maxdepth" 1
WorldBegin
LightSource "distant" "rgb L" [3 3 3] "point3 from" [0 1 1] "point3 to" [0 0 0]
Material "diffuse" "rgb reflectance" [0.5 0.5 0.5]
Shape "trianglemesh" "point3 P" [-5 0 -5 -5 0 5 5 0 5 5 0 -5] "integer indices" [0 1 2 0 2 3]
)",
                               1);
  EXPECT_NEAR(MeanOf(rendered.image).mean, 0.5 / M_PI * 3 * std::sqrt(0.5), 1e-5);
}

TEST_P(Analytic, EnvironmentAlone) {
  const auto rendered = Render(kSmallFilm + R"(Camera "perspective" "float fov" 60
WorldBegin
LightSource "infinite" "rgb L" [0.3 0.3 0.3]
)",
                               2);
  EXPECT_NEAR(MeanOf(rendered.image).mean, 0.3, 1e-6);
}

TEST_P(Analytic, WhiteFurnaceWithGlassIsInvisible) {
  // A lossless object in a constant environment cannot be seen.
  for (const char* material : {R"("dielectric" "float eta" 1.5)", R"("dielectric" "float eta" 1)",
                               R"("thindielectric" "float eta" 1.5)", R"("diffuse" "rgb reflectance" [1 1 1])"}) {
    const auto rendered = Render(kSmallFilm + R"(LookAt 0 0 4 0 0 0 0 1 0
Camera "perspective" "float fov" 30
Integrator "path" "integer maxdepth" 1000
WorldBegin
LightSource "infinite" "rgb L" [1 1 1]
Material )" + material + "\nShape \"sphere\"\n",
                                 64);
    const MeanValue value = MeanOf(rendered.image);
    EXPECT_NEAR(value.mean, 1, 4 * value.standardError + 1e-4) << material;
    EXPECT_LT(value.standardError, 0.01) << material;
  }
}

TEST_P(Analytic, RadianceInsideGlassIsSquaredIndexTimesOutside) {
  const auto rendered = Render(kSmallFilm + R"(Camera "perspective" "float fov" 60
Integrator "path" "integer maxdepth" 1000
WorldBegin
LightSource "infinite" "rgb L" [1 1 1]
Material "dielectric" "float eta" 1.5
Shape "sphere" "float radius" 2
)",
                               256);
  ExpectMean(rendered.image, 2.25, 0.01);
}

TEST_P(Analytic, GlassSlabTransmittance) {
  // Normal incidence through both faces, all interreflections: T = (1-R)/(1+R).
  const double R = FresnelNormal(1.5);
  const auto rendered = Render(kSmallFilm + R"(LookAt 0 0 4 0 0 0 0 1 0
Camera "orthographic" "float screenwindow" [-0.1 0.1 -0.1 0.1]
Integrator "path" "integer maxdepth" 100
WorldBegin
Material "dielectric" "float eta" 1.5
Shape "trianglemesh" "point3 P" [-9 -9 0.5 9 -9 0.5 9 9 0.5 -9 9 0.5] "integer indices" [0 1 2 0 2 3]
Shape "trianglemesh" "point3 P" [-9 -9 -0.5 -9 9 -0.5 9 9 -0.5 9 -9 -0.5] "integer indices" [0 1 2 0 2 3]
Material "diffuse" "rgb reflectance" [0 0 0]
AreaLightSource "diffuse" "rgb L" [1 1 1]
Shape "trianglemesh" "point3 P" [-1 -1 -2 1 -1 -2 1 1 -2 -1 1 -2] "integer indices" [0 1 2 0 2 3]
)",
                               1024);
  ExpectMean(rendered.image, (1 - R) / (1 + R), 0.002);
}

TEST_P(Analytic, MirrorShowsTheLightTimesItsReflectance) {
  const auto rendered = Render(kSmallFilm + R"(LookAt 0 0 1 0 0 0 0 1 0
Camera "perspective" "float fov" 10
WorldBegin
Material "conductor" "rgb reflectance" [0.7 0.7 0.7] "float roughness" 0
Shape "trianglemesh" "point3 P" [-1 -1 0 1 -1 0 1 1 0 -1 1 0] "integer indices" [0 1 2 0 2 3]
LightSource "infinite" "rgb L" [2 2 2]
)",
                               4);
  EXPECT_NEAR(MeanOf(rendered.image).mean, 1.4, 0.005);
}

TEST_P(Analytic, TwoKindsOfLightAddUp) {
  // The selection probability must be in every technique: each light alone, then all together.
  const std::string head = kSmallFilm + R"(LookAt 0 1 3  0 0 0  0 1 0
Camera "perspective" "float fov" 40
Integrator "path" "integer maxdepth" 3
WorldBegin
)";
  const std::string lights[] = {"LightSource \"point\" \"rgb I\" [1 1 1] \"point3 from\" [1 2 0]\n",
                                "LightSource \"infinite\" \"rgb L\" [0.2 0.2 0.2]\n",
                                "LightSource \"distant\" \"rgb L\" [0.5 0.5 0.5] \"point3 from\" [0 3 1]\n",
                                "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [6 6 6] Translate -1 1.5 0 Shape "
                                "\"sphere\" \"float radius\" 0.2 AttributeEnd\n"};
  const std::string ground = R"(Material "diffuse" "rgb reflectance" [0.5 0.5 0.5]
Shape "trianglemesh" "point3 P" [-5 0 -5 -5 0 5 5 0 5 5 0 -5] "integer indices" [0 1 2 0 2 3]
AttributeBegin
Material "conductor" "float roughness" 0.3 "rgb reflectance" [0.8 0.8 0.8]
Translate 0 0.4 0 Shape "sphere" "float radius" 0.4
AttributeEnd
)";
  // The lamp is a thing to be seen, too: it stands in every render, dark in the others.
  const std::string darkLamp =
      "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [0 0 0] Translate -1 1.5 0 Shape \"sphere\" \"float "
      "radius\" 0.2 AttributeEnd\n";
  double sum = 0, variance = 0;
  std::string all;
  for (const std::string& light : lights) {
    const bool isLamp = light[0] == 'A';
    const MeanValue value = MeanOf(Render(head + light + (isLamp ? "" : darkLamp) + ground, 256).image);
    sum += value.mean;
    variance += value.standardError * value.standardError;
    all += light;
  }
  for (const char* selection : {"uniform", "power"}) {
    RenderOverrides overrides;
    overrides.values["light-sampler"] = selection;
    const MeanValue together = MeanOf(Render(head + all + ground, 1024, overrides).image);
    const double error = std::sqrt(variance + together.standardError * together.standardError);
    EXPECT_LT(error, 0.01 * sum);
    EXPECT_NEAR(together.mean, sum, 4 * error) << selection;
  }
}

TEST_P(Analytic, OneLightSplitIntoManyIsTheSameLight) {
  const std::string head = kSmallFilm + R"(LookAt 0 1 3  0 0.5 0  0 1 0
Camera "perspective" "float fov" 40
Integrator "path" "integer maxdepth" 2
WorldBegin
Shape "trianglemesh" "point3 P" [-5 0 -5 -5 0 5 5 0 5 5 0 -5] "integer indices" [0 1 2 0 2 3]
AreaLightSource "diffuse" "rgb L" [5 5 5]
)";
  const std::string whole = head +
                            "Shape \"trianglemesh\" \"point3 P\" [-1 1.5 -0.5 1 1.5 -0.5 1 1.5 0.5 -1 1.5 0.5] "
                            "\"integer indices\" [0 1 2 0 2 3]\n";
  std::string parts = head;
  for (int i = 0; i < 8; ++i) {
    const std::string x0 = std::to_string(-1 + i * 0.25), x1 = std::to_string(-1 + (i + 1) * 0.25);
    parts += "Shape \"trianglemesh\" \"point3 P\" [" + x0 + " 1.5 -0.5 " + x1 + " 1.5 -0.5 " + x1 + " 1.5 0.5 " + x0 +
             " 1.5 0.5] \"integer indices\" [0 1 2 0 2 3]\n";
  }
  const MeanValue one = MeanOf(Render(whole, 256).image), many = MeanOf(Render(parts, 256).image);
  EXPECT_NEAR(one.mean, many.mean, 4 * std::hypot(one.standardError, many.standardError));
  EXPECT_LT(one.standardError, 0.01 * one.mean);
}

TEST_P(Analytic, ErrorFallsAsOneOverSamples) {
  // Independent samples: the slope of MSE over samples is -1 in log-log.
  const std::string text = kSmallFilm + R"(LookAt 0 1 3  0 0 0  0 1 0
Camera "perspective" "float fov" 40
Sampler "independent"
Integrator "path" "integer maxdepth" 3
WorldBegin
Shape "trianglemesh" "point3 P" [-5 0 -5 -5 0 5 5 0 5 5 0 -5] "integer indices" [0 1 2 0 2 3]
AreaLightSource "diffuse" "rgb L" [5 5 5]
Translate 0 1 0
Shape "sphere" "float radius" 0.3
)";
  const Image reference = Render(text, 16384).image;
  std::vector<double> logSamples, logError;
  for (int samples = 4; samples <= 256; samples *= 4) {
    RenderOverrides overrides;
    overrides.seed = static_cast<uint64_t>(samples);
    const Image image = Render(text, samples, overrides).image;
    double sum = 0;
    for (int y = 0; y < 16; ++y) {
      for (int x = 0; x < 16; ++x) sum += std::pow(static_cast<double>(image.At(x, y, 1) - reference.At(x, y, 1)), 2);
    }
    logSamples.push_back(std::log(samples));
    logError.push_back(std::log(sum / 256));
  }
  const double slope = (logError.back() - logError.front()) / (logSamples.back() - logSamples.front());
  EXPECT_NEAR(slope, -1, 0.15);
}

}  // namespace
}  // namespace lampyr::test
