// Transmission of cut-outs and thin glass is the same for shadow rays, scattered rays and photons, layer by layer.
#include <gtest/gtest.h>

#include <cmath>

#include "materials/dielectric.h"
#include "support/render_scene.h"
#include "support/replicas.h"

namespace lampyr::test {
namespace {

const std::string kLookDown =
    "LookAt 0 9 0.001  0 0 0  0 1 0\nCamera \"orthographic\" \"float screenwindow\" [-0.05 0.05 -0.05 0.05]\n"
    "Film \"rgb\" \"integer xresolution\" 8 \"integer yresolution\" 8\nPixelFilter \"box\"\n"
    "Integrator \"path\" \"integer maxdepth\" 1\nWorldBegin\n";
const std::string kFloor =
    "Material \"diffuse\" \"rgb reflectance\" [0.5 0.5 0.5]\n"
    "Shape \"bilinearmesh\" \"point3 P\" [ -4 0 -4  4 0 -4  -4 0 4  4 0 4 ]\n";
// In the way of the light of the sun, not of the camera, which looks along the other way from the plumb line.
const std::string kSun = "LightSource \"distant\" \"rgb L\" [1 1 1] \"point3 from\" [4 3 0] \"point3 to\" [0 0 0]\n";

std::string Layers(const std::string& material, const std::string& shapeParameters, int count,
                   const char* kind = "bilinearmesh") {
  std::string text = "AttributeBegin " + material + "\n";
  for (int i = 0; i < count; ++i) {
    const std::string height = std::to_string(0.5 + 0.25 * i);
    text += std::string(kind) == "disk"
                ? "AttributeBegin Translate 2 " + height + " 0 Rotate 90 1 0 0 Shape \"disk\" \"float radius\" 1.9 " +
                      shapeParameters + " AttributeEnd\n"
                : "Shape \"" + std::string(kind) + "\" \"point3 P\" [ 0.1 " + height + " -1  4 " + height +
                      " -1  0.1 " + height + " 1  4 " + height + " 1 ] " +
                      (std::string(kind) == "trianglemesh" ? "\"integer indices\" [ 0 1 2 1 3 2 ] " : "") +
                      shapeParameters + "\n";
  }
  return text + "AttributeEnd\n";
}

Color Measure(const std::string& layers, const char* integrator, int samples = 64) {
  RenderOverrides overrides;
  overrides.integrator = integrator;
  const Image image = RenderText(kLookDown + kSun + kFloor + layers, samples, overrides).image;
  Color sum;
  for (int y = 0; y < 8; ++y) {
    for (int x = 0; x < 8; ++x) sum += image.RgbAt(x, y);
  }
  return sum / 64.0f;
}

// The sun comes in at the cosine 0.6 through so many layers.
TEST(Transmission, IsTheProductOfItsLayers) {
  const double open = 0.5 / std::numbers::pi * 0.6;
  const double glass = 1 - static_cast<double>(ThinReflectance(0.6f, 1.5f));
  for (const char* kind : {"bilinearmesh", "trianglemesh", "disk"}) {
    for (const int count : {0, 1, 2, 7}) {
      const Color clear = Measure(Layers("Material \"thindielectric\" \"float eta\" 1.5", "", count, kind), "path");
      EXPECT_NEAR(static_cast<double>(clear.g), open * std::pow(glass, count), 1e-6) << kind << " " << count;
      const Color tinted = Measure(
          Layers("Material \"thindielectric\" \"float eta\" 1.5 \"rgb transmittance\" [0.9 0.5 0]", "", count, kind),
          "path");
      EXPECT_NEAR(static_cast<double>(tinted.r), open * std::pow(0.9 * glass, count), 1e-6) << kind << " " << count;
      EXPECT_NEAR(static_cast<double>(tinted.g), open * std::pow(0.5 * glass, count), 1e-6);
      EXPECT_NEAR(static_cast<double>(tinted.b), count == 0 ? open : 0, 1e-6);
      const Color cut = Measure(Layers("Material \"diffuse\"", "\"float alpha\" 0.25", count, kind), "path");
      EXPECT_NEAR(static_cast<double>(cut.g), open * std::pow(0.75, count), 1e-6) << kind << " " << count;
      // A part of the sheet is cut out, and what is left of it is glass.
      const Color both = Measure(Layers("Material \"thindielectric\" \"rgb transmittance\" [0.5 0.5 0.5]",
                                        "\"float alpha\" 0.25", count, kind),
                                 "path");
      EXPECT_NEAR(static_cast<double>(both.g), open * std::pow(0.75 + 0.25 * 0.5 * glass, count), 1e-6)
          << kind << " " << count;
    }
  }
}

// Photons pass by chance, and with the same mean. A part of the floor is seen through the layers, too.
TEST(Transmission, OfPhotonsIsTheSame) {
  const std::string layers =
      Layers("Material \"thindielectric\" \"rgb transmittance\" [0.9 0.5 0.2]", "\"float alpha\" 0.7", 3);
  const auto measure = [&](const char* integrator, int samples) {
    RenderOverrides overrides;
    overrides.integrator = integrator;
    std::string head = kLookDown;
    const std::string small = "[-0.05 0.05 -0.05 0.05]";
    head.replace(head.find(small), small.size(), "[-0.4 0.4 -0.4 0.4]");
    return RenderText(head + kSun + kFloor + layers, samples, overrides).image;
  };
  const auto mean = [](const Image& image, size_t channel) {
    const char* variance[] = {"variance.R", "variance.G", "variance.B"};
    MeanValue result;
    for (int y = 0; y < 8; ++y) {
      for (int x = 0; x < 8; ++x) {
        result.mean += static_cast<double>(image.At(x, y, channel)) / 64;
        result.standardError +=
            static_cast<double>(image.At(x, y, static_cast<size_t>(image.ChannelIndex(variance[channel])))) / 4096;
      }
    }
    result.standardError = std::sqrt(result.standardError);
    return result;
  };
  const Image path = measure("path", 4096);
  for (const char* integrator : {"light", "bdpt"}) {
    const Image other = measure(integrator, 32768);
    for (size_t channel = 0; channel < 3; ++channel) {
      const MeanValue a = mean(path, channel), b = mean(other, channel);
      EXPECT_NEAR(b.mean, a.mean, 4 * std::hypot(a.standardError, b.standardError)) << integrator;
      EXPECT_LT(b.standardError, 0.02 * a.mean);
    }
  }
}

// A closed ball of thin glass: both its walls, and both hits of a curve's or quadric's, count.
TEST(Transmission, ThroughBothSidesOfABall) {
  const std::string ball =
      "AttributeBegin Material \"thindielectric\" \"rgb transmittance\" [0.5 0.5 0.5] Translate 2 1.5 0 Shape "
      "\"sphere\" \"float radius\" 1 AttributeEnd\n";
  const double glass = 1 - static_cast<double>(ThinReflectance(1, 1.5f));
  EXPECT_NEAR(static_cast<double>(Measure(ball, "path").g), 0.5 / std::numbers::pi * 0.6 * std::pow(0.5 * glass, 2),
              1e-4);
}

// The same for camera rays: each layer colours the background and the lamp.
TEST(Transmission, OfWhatTheCameraSees) {
  for (const char* integrator : {"path", "bdpt", "sppm", "vcm"}) {
    for (const char* light : {"LightSource \"infinite\" \"rgb L\" [1 1 1]\n",
                              "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [1 1 1] \"bool twosided\" true "
                              "Shape \"bilinearmesh\" \"point3 P\" "
                              "[ -4 -1 -4  4 -1 -4  -4 -1 4  4 -1 4 ] AttributeEnd\n"}) {
      const std::string pane =
          "Material \"thindielectric\" \"float eta\" 1 \"rgb transmittance\" [0.9 0.5 0.2]\n"
          "Shape \"bilinearmesh\" \"point3 P\" [ -4 2 -4  4 2 -4  -4 2 4  4 2 4 ]\nShape \"bilinearmesh\" \"point3 P\" "
          "[ -4 3 -4  4 3 -4  -4 3 4  4 3 4 ]\n";
      RenderOverrides overrides;
      overrides.integrator = integrator;
      const MeanValue seen = MeanOf(RenderText(kLookDown + light + pane, 1024, overrides).image);
      EXPECT_NEAR(seen.mean, 0.25, 4 * seen.standardError + 1e-6) << integrator << " " << light;
    }
  }
}

// Panes, leaves and lights of all kinds, also behind glass that no path would have found them through.
TEST(Transmission, AllTechniquesAgree) {
  const std::string text = R"(LookAt 0 2.2 3.6  0 0.5 0  0 1 0
Camera "perspective" "float fov" 30
Film "rgb" "integer xresolution" 24 "integer yresolution" 24
PixelFilter "gaussian"
Integrator "path" "integer maxdepth" 4
WorldBegin
LightSource "point" "rgb I" [6 5 4] "point3 from" [-0.8 1.6 0.2]
AttributeBegin AreaLightSource "diffuse" "rgb L" [5 6 7] Translate 0.8 1.7 0 Shape "sphere" "float radius" 0.3 AttributeEnd
LightSource "infinite" "rgb L" [0.1 0.1 0.15]
Material "diffuse" "rgb reflectance" [0.6 0.5 0.4]
Shape "bilinearmesh" "point3 P" [ -2.5 0 -2.5  2.5 0 -2.5  -2.5 0 2.5  2.5 0 2.5 ]
AttributeBegin Translate -0.5 0.35 0 Shape "sphere" "float radius" 0.35 AttributeEnd
Texture "red" "spectrum" "checkerboard" "float uscale" 4 "float vscale" 4 "rgb tex1" [1 0.2 0.1] "rgb tex2" [0.9 0.9 1]
Texture "holes" "float" "checkerboard" "float uscale" 6 "float vscale" 6 "float tex1" 1 "float tex2" 0.3
AttributeBegin Material "thindielectric" "texture transmittance" "red"
Shape "bilinearmesh" "point3 P" [ -1.6 1 -0.6  0 1.1 -0.6  -1.6 1 0.8  0 1 0.8 ]
Translate 0.7 0.4 0.5 Shape "sphere" "float radius" 0.4 AttributeEnd
AttributeBegin Material "diffuse" "rgb reflectance" [0.2 0.6 0.1]
Shape "bilinearmesh" "point3 P" [ 0.2 1.2 -0.5  1.4 1.2 -0.5  0.2 1 0.7  1.4 1.2 0.7 ] "texture alpha" "holes" AttributeEnd
)";
  // Path tracing cannot find what the glass reflects of the point onto the floor.
  const std::string withoutPoint = [&] {
    const size_t start = text.find("LightSource \"point\"");
    return std::string(text).erase(start, text.find('\n', start) - start);
  }();
  ASSERT_EQ(withoutPoint.find("\"point\""), std::string::npos);
  struct Pair {
    const char *first, *second;
    const std::string& scene;
    int secondSamples;
  };
  uint64_t seed = 0;
  for (const Pair& pair :
       {Pair{"bdpt", "path", withoutPoint, 64}, {"vcm", "bdpt", text, 64}, {"sppm", "bdpt", text, 64}}) {
    RenderOverrides overrides;
    overrides.values["radius"] = 0.01;
    overrides.values["photons"] = 6000;
    const Replicas second = RenderReplicas(pair.scene, pair.second, 12, pair.secondSamples, overrides);
    overrides.seed = seed += 1000;
    const Replicas first = RenderReplicas(pair.scene, pair.first, 12, 64, overrides);
    const Agreement result = CompareReplicas(first, second, 8, 3e-4);
    std::printf("%s and %s: largest |z| %.2f (%.2f), chi2 %.1f (%.1f), bias %+.3f %% +- %.3f %%\n", pair.first,
                pair.second, result.largestZ, result.thresholdZ, result.chiSquared, result.chiSquaredThreshold,
                100 * result.bias, 196 * result.biasError);
    EXPECT_TRUE(result.Agrees()) << pair.first << " and " << pair.second;
    EXPECT_EQ(first.faults + second.faults, 0u);
    EXPECT_FALSE(CompareReplicas(first, second, 8, 3e-4, 1.04).Agrees()) << pair.first << ": too noisy";
  }
}

}  // namespace
}  // namespace lampyr::test
