// Light in participating media whose radiance is known: single scattering in closed form, absorbing and scattering
// slabs, furnaces, the half space of Chandrasekhar, and media of colours against grey ones.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "support/replicas.h"

namespace lampyr::test {
namespace {

constexpr int kReplicas = 16;
constexpr int kMostComparisons = 1000;  // of this file, for the family-wise rate

using Radiance = std::array<double, 3>;

std::string Rgb(const std::string& name, const Radiance& value) {
  return " \"rgb " + name + "\" [" + std::to_string(value[0]) + " " + std::to_string(value[1]) + " " +
         std::to_string(value[2]) + "]";
}
Radiance Grey(double value) {
  return {value, value, value};
}

std::string Homogeneous(const std::string& name, const Radiance& scattering, const Radiance& absorption, double g = 0,
                        const std::string& more = "") {
  return "MakeNamedMedium \"" + name + "\" \"string type\" \"homogeneous\"" + Rgb("sigma_s", scattering) +
         Rgb("sigma_a", absorption) + " \"float g\" " + std::to_string(g) + " " + more + "\n";
}

// A parallel camera at the origin that looks along z.
std::string Head(int depth, const std::string& window = "-.5 .5 -.5 .5", const std::string& lookAt = "0 0 0  0 0 1") {
  return "Film \"rgb\" \"integer xresolution\" 4 \"integer yresolution\" 4\nPixelFilter \"box\"\nLookAt " + lookAt +
         "  0 1 0\nCamera \"orthographic\" \"float screenwindow\" [" + window +
         "]\nIntegrator \"path\" \"integer maxdepth\" " + std::to_string(depth) + "\nWorldBegin\n";
}

// A box without a surface of its own, full of `medium`.
std::string Box(const std::string& medium, const Vector3d& low, const Vector3d& high) {
  std::string points;
  for (const double z : {low.z, high.z}) {
    const double corners[4][2] = {{low.x, low.y}, {high.x, low.y}, {high.x, high.y}, {low.x, high.y}};
    for (const auto& corner : corners)
      points += std::to_string(corner[0]) + " " + std::to_string(corner[1]) + " " + std::to_string(z) + "  ";
  }
  return "AttributeBegin Material \"interface\" MediumInterface \"" + medium +
         "\" \"\" Shape \"trianglemesh\" \"point3 P\" [" + points +
         "] \"integer indices\" [0 2 1 0 3 2  4 5 6 4 6 7  0 1 5 0 5 4  3 6 2 3 7 6  0 7 3 0 4 7  1 2 6 1 6 5] "
         "AttributeEnd\n";
}

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

// The image's mean by independent renders, per channel: within their error, which notices `noticed` of the value.
void ExpectMean(const Replicas& replicas, const Radiance& expected, double noticed = 0.01) {
  static const double student = StudentQuantileTwoSided(SidakRate(1e-3, kMostComparisons), kReplicas - 1);
  EXPECT_EQ(replicas.faults, 0u);
  const Image& first = replicas.images[0];
  for (size_t c = 0; c < 3; ++c) {
    const auto moments =
        replicas_internal::MomentsOf(replicas_internal::Means(replicas, c, 0, 0, first.width, first.height));
    const double noise = student * std::sqrt(moments.variance);
    EXPECT_LT(noise, noticed * expected[c]) << "too noisy: " << moments.mean << " in channel " << c;
    EXPECT_NEAR(moments.mean, expected[c], noise + 1e-5 * expected[c]) << "channel " << c;
  }
}

std::string NameOfParameter(const testing::TestParamInfo<const char*>& info) {
  return info.param;
}

class MediaAnalytic : public testing::TestWithParam<const char*> {
 protected:
  // `samples`: per pixel of each render; of light tracing `lightFactor` times as many.
  static Replicas Render(const std::string& text, int samples, int lightFactor = 8) {
    return RenderReplicas(text, GetParam(), kReplicas, IsLight() ? lightFactor * samples : samples);
  }
  static bool IsLight() { return GetParam() == std::string("light"); }
  // Most paths of light tracing end beside what is seen.
  static double Noticed() { return IsLight() ? 0.03 : 0.01; }
};
INSTANTIATE_TEST_SUITE_P(Of, MediaAnalytic, testing::Values("path", "light", "bdpt", "vcm", "sppm"), NameOfParameter);

// Without pure light tracing, whose paths do not start in glowing media.
// sppm: GlowingMedia.FurnaceOfPhotonMapping.
class MediaFurnace : public MediaAnalytic {};
INSTANTIATE_TEST_SUITE_P(Of, MediaFurnace, testing::Values("path", "bdpt", "vcm"), NameOfParameter);
// Without sppm, which blurs over a pixel: several mean free paths here.
class MediaHalfSpace : public MediaAnalytic {};
INSTANTIATE_TEST_SUITE_P(Of, MediaHalfSpace, testing::Values("path", "light", "bdpt", "vcm"), NameOfParameter);

// Of a point light of unit intensity at the distance D from the ray, with the foot δ, in the medium from t0 to t1. The
// camera is outside.
double SingleScattering(double scattering, double extinction, double D, double foot, double t0, double t1) {
  const auto inner = [&](double x) { return std::exp(-extinction * D * std::tan(x)); };
  const auto bound = [&](double t) { return M_PI / 4 + std::atan((t - foot) / D) / 2; };
  return scattering / (2 * M_PI * D) * std::exp(-extinction * (foot - t0)) * Integrate(inner, bound(t0), bound(t1));
}

TEST_P(MediaAnalytic, PointLightInHaze) {
  const double lightX = 1.3, foot = 2.1, t0 = 0.4, t1 = 6, intensity = 2;
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
    const std::string text = Head(1, "-1 1 -1 1") + Homogeneous("haze", Grey(scattering), Grey(absorption)) +
                             Box("haze", {-3, -3, t0}, {3, 3, t1}) +
                             "MediumInterface \"\" \"haze\"\nLightSource \"point\" \"rgb I\" [2 2 2] \"point3 from\" "
                             "[1.3 0 2.1]\n";
    const bool isThin = scattering < 0.1;
    ExpectMean(Render(text, isThin ? 8192 : 1024, isThin ? 2 : 4), Grey(intensity * mean), 2 * Noticed());
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
        Head(1) + Homogeneous("slab", scattering, absorption, g) + Box("slab", {-0.55, -0.55, 1}, {0.55, 0.6, 1.8}) +
        "LightSource \"distant\" \"rgb L\" [3 3 3] \"point3 from\" [0 1 0] \"point3 to\" [0 0 0]\n";
    ExpectMean(Render(text, 512), expected, Noticed());
  }
}

// A plate of radiance 1 behind a slab.
std::string Plate() {
  return "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [1 1 1] Material \"diffuse\" \"rgb reflectance\" [0 0 "
         "0]\n"
         "Shape \"bilinearmesh\" \"point3 P\" [-1 -1 3  -1 1 3  1 -1 3  1 1 3] AttributeEnd\n";
}

TEST_P(MediaAnalytic, SlabBeforeALamp) {
  // e^(-σ_t d) of the light that is not scattered.
  const Radiance extinction = {0.4, 1, 2.5};
  const Radiance half = {0.2, 0.5, 1.25};
  Radiance expected;
  for (size_t c = 0; c < 3; ++c) expected[c] = std::exp(-extinction[c] * 1.5);
  const std::string absorbing =
      Head(0) + Homogeneous("slab", Grey(0), extinction) + Box("slab", {-1, -1, 1}, {1, 1, 2.5}) + Plate();
  ExpectMean(Render(absorbing, 64, 64), expected);
  const std::string scattering =
      Head(0) + Homogeneous("slab", half, half, 0.5) + Box("slab", {-1, -1, 1}, {1, 1, 2.5}) + Plate();
  ExpectMean(Render(scattering, 1024, 4), expected);
}

// A closed sphere of radius 1 around the camera that emits `kFurnace` and reflects nothing, full of the medium "gas".
const Radiance kFurnace = {1, 0.5, 0.25};
std::string Furnace(const std::string& medium, const std::string& around) {
  return "Film \"rgb\" \"integer xresolution\" 4 \"integer yresolution\" 4\nPixelFilter \"box\"\n" + medium +
         "MediumInterface \"\" \"" + around +
         "\"\nCamera \"perspective\" \"float fov\" 90\nIntegrator \"path\" \"integer maxdepth\" 400\nWorldBegin\n"
         "AttributeBegin AreaLightSource \"diffuse\"" +
         Rgb("L", kFurnace) +
         " Material \"diffuse\" \"rgb reflectance\" [0 0 0] ReverseOrientation MediumInterface \"\" \"" + around +
         "\" Shape \"sphere\" AttributeEnd\n";
}

TEST_P(MediaFurnace, Homogeneous) {
  struct Gas {
    Radiance scattering, absorption;
    double g;
  };
  for (const Gas& gas : {Gas{Grey(0), Grey(0.7), 0}, Gas{Grey(2), Grey(0.5), 0}, Gas{Grey(1), Grey(1), 0.9},
                         Gas{Grey(1), Grey(1), -0.9}, Gas{{0.2, 0.6, 1}, {1, 0.4, 0.2}, 0.4}}) {
    const std::string medium = Homogeneous("gas", gas.scattering, gas.absorption, gas.g, Rgb("Le", kFurnace));
    ExpectMean(Render(Furnace(medium, "gas"), 256), kFurnace, 0.03);
  }
}

// 6 × 6 × 6 voxels over the sphere; those at the sides, where the interpolation falls off, are empty.
template <class Value>
std::string Voxels(const Value& value) {
  std::string text;
  for (int z = 0; z < 6; ++z) {
    for (int y = 0; y < 6; ++y) {
      for (int x = 0; x < 6; ++x) {
        const bool isRim = std::min({x, y, z}) == 0 || std::max({x, y, z}) == 5;
        text += value(x + 6 * y + 36 * z, isRim) + " ";
      }
    }
  }
  return text;
}
double Density(int voxel) {
  return 0.3 * (voxel * 37 % 11);
}
const std::string kSphereBox =
    " \"integer nx\" 6 \"integer ny\" 6 \"integer nz\" 6 \"point3 p0\" [-1 -1 -1] \"point3 p1\" [1 1 1] ";

TEST_P(MediaFurnace, UniformGrid) {
  const std::string densities =
      Voxels([](int voxel, bool isRim) { return std::to_string(isRim ? 0.0 : Density(voxel)); });
  const std::string medium = "MakeNamedMedium \"gas\" \"string type\" \"uniformgrid\"" + kSphereBox +
                             Rgb("sigma_s", {1, 0.6, 0.3}) + Rgb("sigma_a", {0.3, 1, 0.6}) + " \"float g\" 0.5" +
                             Rgb("Le", kFurnace) + " \"float density\" [" + densities + "]\n";
  ExpectMean(Render(Furnace(medium, "gas"), 256), kFurnace, 0.03);
}

// `channel`: a grey grid of that channel's coefficients; -1: the grid of colours.
std::string RgbGrid(int channel, double g, const std::string& more = "") {
  const auto colours = [channel](int shift) {
    return Voxels([&](int voxel, bool isRim) {
      std::string text;
      for (int c = 0; c < 3; ++c) {
        const int shown = channel < 0 ? c : channel;
        text += std::to_string(isRim ? 0.0 : Density(voxel + shift * (shown + 1))) + " ";
      }
      return text;
    });
  };
  return "MakeNamedMedium \"gas\" \"string type\" \"rgbgrid\"" + kSphereBox + " \"float g\" " + std::to_string(g) +
         " \"rgb sigma_s\" [" + colours(1) + "] \"rgb sigma_a\" [" + colours(2) + "] " + more + "\n";
}

TEST_P(MediaFurnace, RgbGrid) {
  const std::string emission = Voxels([](int, bool) { return std::string("1 0.5 0.25"); });
  ExpectMean(Render(Furnace(RgbGrid(-1, -0.3, "\"rgb Le\" [" + emission + "]"), "gas"), 256), kFurnace, 0.03);
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

TEST_P(MediaHalfSpace, OfChandrasekhar) {
  const double albedo = 0.8, mu0 = 0.6, mu = 0.5;
  const HFunction h(albedo);
  const double expected = mu0 * albedo * h.At(mu) * h.At(mu0) / (4 * M_PI * (mu + mu0));
  EXPECT_NEAR(expected / mu0, 0.119334, 1e-6);
  // Edges are 10 mean free paths away from what is seen: 30 by 30 of the plane, at 60° from its normal.
  const std::string text =
      Head(200, "-15 15 -7.5 7.5", "0 50 86.602540  0 0 0") + Homogeneous("sea", Grey(albedo), Grey(1 - albedo)) +
      Box("sea", {-25, -20, -25}, {25, 0, 25}) +
      "LightSource \"distant\" \"rgb L\" [1 1 1] \"point3 from\" [0.8 0.6 0] \"point3 to\" [0 0 0]\n";
  ExpectMean(Render(text, 1024), Grey(expected), Noticed());
}

// A render of each channel's coefficients in a grey medium, put together.
template <class Text>
Replicas ByChannels(const char* integrator, int samples, const Text& textOf) {
  Replicas together;
  for (size_t c = 0; c < 3; ++c) {
    RenderOverrides overrides;
    overrides.seed = 1000 * (c + 1);
    const Replicas grey = RenderReplicas(textOf(static_cast<int>(c)), integrator, kReplicas, samples, overrides);
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
  const Replicas coloured = RenderReplicas(LitBall(mediumOf(-1)), integrator, kReplicas, samples);
  const Replicas grey = ByChannels(integrator, samples, [&](int channel) { return LitBall(mediumOf(channel)); });
  EXPECT_EQ(coloured.faults + grey.faults, 0u);
  const Agreement result = CompareReplicas(coloured, grey, 8, 1e-4);
  EXPECT_LE(result.largestZ, result.thresholdZ);
  EXPECT_LE(result.chiSquared, result.chiSquaredThreshold);
  EXPECT_LE(std::abs(result.meanZ), result.meanThreshold);
  EXPECT_FALSE(CompareReplicas(coloured, grey, 8, 1e-4, 1.02).Agrees()) << "too noisy";
}

class MediaOfColours : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Of, MediaOfColours, testing::Values("path", "light", "bdpt"), NameOfParameter);

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
