// Light in participating media whose radiance is known: single scattering in closed form, absorbing and scattering
// slabs, the half space of Chandrasekhar, and media of colours against grey ones.
#include <functional>

#include "integrators/known_media.h"

namespace lampyr::test {
namespace {

// Simpson's rule with 2 n intervals.
double Integrate(const std::function<double(double)>& f, double a, double b, int n = 64) {
  const double h = (b - a) / (2 * n);
  double sum = f(a) + f(b);
  for (int i = 1; i < 2 * n; ++i) sum += f(a + i * h) * (i % 2 == 1 ? 4 : 2);
  return sum * h / 3;
}

double HenyeyGreenstein(double cosTheta, double g) {
  return (1 - g * g) / (4 * M_PI * std::pow(1 + g * g - 2 * g * cosTheta, 1.5));
}

class MediaAnalytic : public testing::TestWithParam<const char*> {
 protected:
  static std::string Named(const std::string& what) { return std::string(GetParam()) + ", " + what; }
};
INSTANTIATE_TEST_SUITE_P(Of, MediaAnalytic, testing::Values("path", "light", "bdpt", "vcm", "sppm", "auto"),
                         NameOfIntegrator);

// Single scattering of a point light of unit intensity at the distance D from the ray, with the foot δ, in the medium
// from t0 to t1. The camera is outside.
double SingleScattering(double scattering, double extinction, double D, double foot, double t0, double t1) {
  const auto inner = [&](double x) { return std::exp(-extinction * D * std::tan(x)); };
  const auto bound = [&](double t) { return M_PI / 4 + std::atan((t - foot) / D) / 2; };
  return scattering / (2 * M_PI * D) * std::exp(-extinction * (foot - t0)) * Integrate(inner, bound(t0), bound(t1));
}

TEST_P(MediaAnalytic, PointLightInHaze) {
  const double lightX = 1.5, foot = 2.1, t0 = 0.4, t1 = 6, intensity = 2;
  for (const auto& [scattering, absorption] : {std::pair{0.3, 0.4}, {0.7, 0.0}, {0.04, 0.0}}) {
    const double mean = Integrate(
                            [&](double x) {
                              return Integrate(
                                  [&](double y) {
                                    return SingleScattering(scattering, scattering + absorption,
                                                            std::hypot(lightX - x, y), foot, t0, t1);
                                  },
                                  0, 1, 16);
                            },
                            -1, 1, 16) /
                        2;
    const std::string text = ParallelView(1, "-1 1 -1 1") + Homogeneous("haze", Grey(scattering), Grey(absorption)) +
                             BoxOf("haze", {-3, -3, t0}, {3, 3, t1}) +
                             "MediumInterface \"\" \"haze\"\nLightSource \"point\" \"rgb I\" [2 2 2] \"point3 from\" "
                             "[1.5 0 2.1]\n";
    const int samples = scattering < 0.1 ? 768 : 256;
    ExpectKnown(Named("haze of " + std::to_string(scattering)), RenderKnown(text, GetParam(), samples, {.light = 24}),
                Grey(intensity * mean));
  }
}

TEST(MediaClosedForms, PointLightInThinHaze) {
  // σ_s I (θ_b - θ_a) / (4π D).
  const double angle = std::atan((6 - 2.1) / 1.3) - std::atan((0.4 - 2.1) / 1.3);
  EXPECT_NEAR(SingleScattering(1e-6, 1e-6, 1.3, 2.1, 0.4, 6) / (1e-6 * angle / (4 * M_PI * 1.3)), 1, 1e-5);
}

TEST_P(MediaAnalytic, SlabAcrossParallelLight) {
  // The slab is 0.8 thick along the view, and the light comes from above: at the depth y below its top
  // L = σ_s E p(90°) / σ_t (1 - e^(-σ_t W)) e^(-σ_t y).
  const Radiance scattering = {2, 0.5, 1}, absorption = {0.1, 1, 3};
  for (const double g : {0.0, 0.6, -0.9}) {
    Radiance expected;
    for (size_t c = 0; c < 3; ++c) {
      const double extinction = scattering[c] + absorption[c];
      const double depth = (std::exp(-0.1 * extinction) - std::exp(-1.1 * extinction)) / extinction;
      expected[c] = 3 * scattering[c] * HenyeyGreenstein(0, g) / extinction * (1 - std::exp(-extinction * 0.8)) * depth;
    }
    const std::string text =
        ParallelView(1) + Homogeneous("slab", scattering, absorption, g) +
        BoxOf("slab", {-0.55, -0.55, 1}, {0.55, 0.6, 1.8}) +
        "LightSource \"distant\" \"rgb L\" [3 3 3] \"point3 from\" [0 1 0] \"point3 to\" [0 0 0]\n";
    ExpectKnown(Named("lit slab, g " + std::to_string(g)), RenderKnown(text, GetParam(), 192), expected);
  }
}

// A plate of radiance 1 behind a slab.
std::string Plate() {
  return "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [1 1 1] Material \"diffuse\" \"rgb reflectance\" [0 0 "
         "0]\n"
         "Shape \"bilinearmesh\" \"point3 P\" [-1 -1 3  -1 1 3  1 -1 3  1 1 3] AttributeEnd\n";
}

// A grid needs no boundary: it is all there, wherever shapes, camera and lights are.
TEST(MediaClosedForms, GridWithoutABoundary) {
  const auto mean = [](const std::string& boundary) {
    const std::string scene =
        "Film \"rgb\" \"integer xresolution\" 4 \"integer yresolution\" 4\nPixelFilter \"box\"\nTranslate -0.5 -0.5 2\n"
        "MakeNamedMedium \"gas\" \"string type\" \"uniformgrid\" \"rgb sigma_s\" [0 0 0] \"rgb sigma_a\" [1 1 1] "
        "\"float density\" [2]\nIdentity\n" +
        std::string(boundary.empty() ? "MediumInterface \"\" \"gas\"\n" : "") +
        "LookAt 0 0 0  0 0 1  0 1 0\nCamera \"perspective\" \"float fov\" 10\nIntegrator \"path\"\nWorldBegin\n"
        "LightSource \"infinite\"\nTranslate 0 -2 0 Shape \"sphere\" \"float radius\" 0.1\n" +
        boundary;
    return MeanOf(RenderText(scene, 1024).image);
  };
  const MeanValue without = mean(""),
                  with = mean(
                      "Identity Material \"interface\" MediumInterface \"gas\" \"\" Translate 0 0 2.5 Shape "
                      "\"sphere\" \"float radius\" 1.5\n");
  EXPECT_LT(without.mean, 0.5);
  EXPECT_NEAR(without.mean, with.mean, 4.5 * std::hypot(without.standardError, with.standardError));
}

TEST_P(MediaAnalytic, SlabBeforeALamp) {
  // e^(-σ_t d) of the light that is not scattered.
  const Radiance extinction = {0.4, 1, 2.5};
  const Radiance half = {0.2, 0.5, 1.25};
  Radiance expected;
  for (size_t c = 0; c < 3; ++c) expected[c] = std::exp(-extinction[c] * 1.5);
  const std::string absorbing =
      ParallelView(0) + Homogeneous("slab", Grey(0), extinction) + BoxOf("slab", {-1, -1, 1}, {1, 1, 2.5}) + Plate();
  ExpectKnown(Named("absorbing slab"), RenderKnown(absorbing, GetParam(), 16), expected);
  const std::string scattering =
      ParallelView(0) + Homogeneous("slab", half, half, 0.5) + BoxOf("slab", {-1, -1, 1}, {1, 1, 2.5}) + Plate();
  ExpectKnown(Named("scattering slab"), RenderKnown(scattering, GetParam(), 256), expected);
}

// Chandrasekhar's H function of isotropic scattering, at the middles of n intervals of [0,1] and at other μ.
class HFunction {
 public:
  explicit HFunction(double albedo) : albedo_(albedo) {
    for (int round = 0; round < 60; ++round) {
      std::vector<double> next;
      for (int i = 0; i < kIntervals; ++i) next.push_back(At(Middle(i)));
      values_ = next;
    }
  }
  double At(double mu) const {
    double sum = 0;
    for (int i = 0; i < kIntervals; ++i)
      sum += Middle(i) * values_[static_cast<size_t>(i)] / (mu + Middle(i)) / kIntervals;
    return 1 / (std::sqrt(1 - albedo_) + albedo_ / 2 * sum);
  }

 private:
  static constexpr int kIntervals = 400;
  static double Middle(int i) { return (i + 0.5) / kIntervals; }
  double albedo_;
  std::vector<double> values_ = std::vector<double>(kIntervals, 1.0);
};

TEST_P(MediaAnalytic, HalfSpaceOfChandrasekhar) {
  const double albedo = 0.8, mu0 = 0.6, mu = 0.5;
  const HFunction h(albedo);
  const double expected = mu0 * albedo * h.At(mu) * h.At(mu0) / (4 * M_PI * (mu + mu0));
  EXPECT_NEAR(expected / mu0, 0.119334, 1e-6);  // of the irradiance μ₀ E₀; 0.071600 E₀
  // Edges are 10 mean free paths away from what is seen: 30 by 30 of the plane, at 60° from its normal.
  const std::string text =
      ParallelView(200, "-15 15 -7.5 7.5", "0 50 86.602540  0 0 0") +
      Homogeneous("sea", Grey(albedo), Grey(1 - albedo)) + BoxOf("sea", {-25, -20, -25}, {25, 0, 25}) +
      "LightSource \"distant\" \"rgb L\" [1 1 1] \"point3 from\" [0.8 0.6 0] \"point3 to\" [0 0 0]\n";
  ExpectKnown(Named("half space"), RenderKnown(text, GetParam(), 256, {.light = 12}), Grey(expected));
}

constexpr int kColourReplicas = 16;

// A render of each channel's coefficients in a grey medium, put together.
template <class Text>
Replicas ByChannels(const char* integrator, int samples, const Text& textOf) {
  Replicas together;
  for (size_t c = 0; c < 3; ++c) {
    RenderOverrides overrides;
    overrides.seed = 1000 * (c + 1);
    const Replicas grey = RenderReplicas(textOf(static_cast<int>(c)), integrator, kColourReplicas, samples, overrides);
    if (c == 0) together = grey;
    together.faults += grey.faults;
    for (size_t i = 0; i < grey.images.size(); ++i) {
      Image& image = together.images[i];
      for (size_t pixel = 0; pixel < static_cast<size_t>(image.width) * static_cast<size_t>(image.height); ++pixel) {
        const size_t at = pixel * image.channels.size() + c;
        image.data[at] = grey.images[i].data[at];
      }
    }
  }
  return together;
}

// A ball of the medium in parallel light, before a lamp.
std::string LitBall(const std::string& medium) {
  return "Film \"rgb\" \"integer xresolution\" 16 \"integer yresolution\" 16\nPixelFilter \"box\"\nLookAt 0 0 -3  0 0 "
         "0  "
         "0 1 0\nCamera \"orthographic\" \"float screenwindow\" [-1 1 -1 1]\nIntegrator \"path\" \"integer maxdepth\" "
         "12\nWorldBegin\n" +
         medium +
         "LightSource \"distant\" \"rgb L\" [3 3 3] \"point3 from\" [1 1 -1] \"point3 to\" [0 0 0]\n"
         "AttributeBegin Material \"interface\" MediumInterface \"gas\" \"\" Shape \"sphere\" AttributeEnd\n" +
         "AttributeBegin Translate 0 0 -1 " + Plate() + "AttributeEnd\n";
}

void ExpectChannels(const char* integrator, const std::function<std::string(int)>& mediumOf) {
  const int samples = integrator == std::string("light") ? 192 : 32;
  const Replicas coloured = RenderReplicas(LitBall(mediumOf(-1)), integrator, kColourReplicas, samples);
  const Replicas grey = ByChannels(integrator, samples, [&](int channel) { return LitBall(mediumOf(channel)); });
  EXPECT_EQ(coloured.faults + grey.faults, 0u);
  const Agreement result = CompareReplicas(coloured, grey, 8, 1e-4);
  EXPECT_LE(result.largestZ, result.thresholdZ);
  EXPECT_LE(result.chiSquared, result.chiSquaredThreshold);
  EXPECT_LE(std::abs(result.meanZ), result.meanThreshold);
  EXPECT_FALSE(CompareReplicas(coloured, grey, 8, 1e-4, 1.02).Agrees()) << "too noisy";
}

class MediaOfColours : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Of, MediaOfColours, testing::Values("path", "light", "bdpt", "vcm", "sppm"), NameOfIntegrator);

TEST_P(MediaOfColours, HomogeneousIsThreeGreyOnes) {
  const Radiance scattering = {3, 1, 0.3}, absorption = {0.1, 0.6, 1.5};
  ExpectChannels(GetParam(), [&](int channel) {
    if (channel < 0) return Homogeneous("gas", scattering, absorption, 0.4);
    const auto c = static_cast<size_t>(channel);
    return Homogeneous("gas", Grey(scattering[c]), Grey(absorption[c]), 0.4);
  });
}

TEST_P(MediaOfColours, GridIsThreeGreyOnes) {
  ExpectChannels(GetParam(), [](int channel) { return RgbGrid(channel, 0.5); });
}

}  // namespace
}  // namespace lampyr::test
