// Convergence of merged photons: the error of sppm and vcm falls as in theory, and to the picture of unbiased
// integrators.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "support/render_scene.h"

namespace lampyr::test {
namespace {

// A caustic on a floor, a wall near it, a diffuse ball: edges, corners and a focus, all of which light tracing finds.
const std::string kScene = R"(LookAt 0 1.6 -2.6  0 0.2 0.2  0 1 0
Camera "perspective" "float fov" 40
Film "rgb" "integer xresolution" 48 "integer yresolution" 32
PixelFilter "box"
Integrator "path" "integer maxdepth" 6
WorldBegin
LightSource "spot" "rgb I" [9 8 7] "point3 from" [-0.8 2.2 -0.4] "point3 to" [0 0.3 0] "float coneangle" 28
LightSource "infinite" "rgb L" [0.1 0.12 0.15]
Material "diffuse" "rgb reflectance" [0.6 0.55 0.5]
Shape "bilinearmesh" "point3 P" [-3 0 -3  3 0 -3  -3 0 3  3 0 3]
Shape "bilinearmesh" "point3 P" [-3 0 0.9  3 0 0.9  -3 2 0.9  3 2 0.9]
AttributeBegin Translate 0.7 0.25 0 Shape "sphere" "float radius" 0.25 AttributeEnd
AttributeBegin
Material "dielectric" "float eta" 1.5
Translate 0 0.62 0 Shape "sphere" "float radius" 0.3
AttributeEnd
)";

// Where the glass ball is not seen: through it, the reference would be missing what only photons find.
constexpr const char* kCrop = "0,48,18,32";

Rendered RenderBy(const char* integrator, int samplesPerPixel, uint64_t seed, double radius = 0) {
  RenderOverrides overrides;
  overrides.integrator = integrator;
  overrides.seed = seed;
  overrides.crop = kCrop;
  overrides.values["guide-photons"] = false;  // which would grow better from pass to pass
  if (radius > 0) overrides.values["radius"] = radius;
  return RenderText(kScene, samplesPerPixel, overrides);
}

double MeanSquaredError(const Image& a, const Image& b) {
  double sum = 0;
  for (int y = 0; y < a.height; ++y) {
    for (int x = 0; x < a.width; ++x) {
      for (size_t c = 0; c < 3; ++c) sum += std::pow(static_cast<double>(a.At(x, y, c) - b.At(x, y, c)), 2);
    }
  }
  return sum / (3.0 * a.width * a.height);
}

struct Convergence {
  const char* integrator;
  double steepest, flattest;  // slope of the squared error over passes
};
void PrintTo(const Convergence& convergence, std::ostream* out) {
  *out << convergence.integrator;
}

class PhotonConvergence : public testing::TestWithParam<Convergence> {};

// With α = 2/3 the variance of what only photons find falls as i^(-2/3), and so does the square of a blur that falls as
// the squared radius; at edges and corners, where the blur is as the radius, the bias falls as i^(-1/3) while it
// matters. vcm finds most of this light by other techniques, which have 1/i.
TEST_P(PhotonConvergence, ErrorFallsAsPredicted) {
  const Image reference = RenderBy("bdpt", 4096, 99).image;
  const int passes[] = {16, 64, 256};
  double errors[3];
  for (int i = 0; i < 3; ++i) {
    const int repeats = 32 >> 2 * i;
    errors[i] = 0;
    for (int k = 0; k < repeats; ++k) {
      const Rendered rendered = RenderBy(GetParam().integrator, passes[i], static_cast<uint64_t>(100 * i + k), 0.06);
      EXPECT_EQ(rendered.outcome.counts.droppedSamples, 0u);
      errors[i] += MeanSquaredError(rendered.image, reference) / repeats;
    }
    std::printf("%s: %4d passes, mean squared error %.3e", GetParam().integrator, passes[i], errors[i]);
    if (i > 0) std::printf(", slope %.2f", std::log(errors[i] / errors[i - 1]) / std::log(4.0));
    std::printf("\n");
  }
  const double slope = std::log(errors[2] / errors[0]) / std::log(16.0);
  std::printf("%s: slope of the mean squared error %.2f\n", GetParam().integrator, slope);
  EXPECT_GT(slope, GetParam().steepest);
  EXPECT_LT(slope, GetParam().flattest);
}

INSTANTIATE_TEST_SUITE_P(Of, PhotonConvergence,
                         testing::Values(Convergence{"sppm", -0.95, -0.55}, Convergence{"vcm", -1.3, -0.6}),
                         [](const auto& info) { return info.param.integrator; });

// The wall of a lampshade in two layers, whose distance is a quarter of the radius within which photons are gathered.
TEST(PhotonsOnSheets, OfOneDoNotLightTheNext) {
  const std::string text =
      "Film \"rgb\" \"integer xresolution\" 16 \"integer yresolution\" 16\nLookAt 0 0 6  0 0 0  0 1 0\n"
      "Camera \"perspective\" \"float fov\" 20\nWorldBegin\n"
      "LightSource \"point\" \"point3 from\" [0 0 -1] \"rgb I\" [5 5 5]\n"
      "Material \"diffusetransmission\" \"rgb reflectance\" [0.3 0.3 0.3] \"rgb transmittance\" [0.4 0.4 0.4]\n"
      "Shape \"sphere\" \"float radius\" 1.9\nShape \"sphere\" \"float radius\" 2\n";
  RenderOverrides overrides;
  overrides.integrator = "path";
  const double mean = MeanOf(RenderText(text, 512, overrides).image).mean;
  overrides.values["radius"] = 0.4;
  overrides.values["alpha"] = 1.0;
  for (const char* integrator : {"sppm", "vcm"}) {
    overrides.integrator = integrator;
    overrides.values["direct-photons"] = true;
    overrides.values["connect"] = false;
    const double merged = MeanOf(RenderText(text, 256, overrides).image).mean;  // its noise: 1.5 %
    std::printf("%s: %.4f, path %.4f\n", integrator, merged, mean);
    EXPECT_NEAR(merged / mean, 1, 0.05) << integrator;
  }
}

}  // namespace
}  // namespace lampyr::test
