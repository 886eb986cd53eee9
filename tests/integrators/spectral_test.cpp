// Light by wavelength: known answers of refraction, white that stays white, colours of light, and what does not depend
// on the division of the work.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/byte_stream.h"
#include "render/both_paths.h"
#include "scene/spectrum.h"
#include "spectral/cie.h"
#include "spectral/color_space.h"
#include "support/render_scene.h"
#include "support/replicas.h"
#include "support/whole.h"

namespace lampyr::test {
namespace {

constexpr double kPiExact = std::numbers::pi;

SpectralCurve Water() {
  return SpectralCurve([](double wavelength) { return CauchyCoefficients{1.3242, 0.003091, 0}.IndexAt(wavelength); });
}

// A wavelength's smooth dielectric at a face with the outward normal `n`.
Bsdf FaceOf(double eta, const Vector3& n) {
  return Bsdf(Frame::FromNormal(n), n,
              DispersiveBsdf{TrowbridgeReitz(0, 0), Color(1.2f, static_cast<float>(eta), 1.9f), 1});
}

// The direction in which light that travels along `d` leaves a face by the event that `uLobe` chooses.
Vector3 Through(const Bsdf& face, const Vector3& d, float uLobe) {
  const BsdfSample sample = face.Sample(-d, uLobe, Point2(0.5f), TransportMode::Importance);
  EXPECT_TRUE(sample);
  return sample.wi;
}

constexpr float kRefracts = 0.9999f, kReflects = 0;

// A prism of 60 degrees deviates least where the path is symmetric: 2 asin(n sin 30°) - 60°.
TEST(Dispersion, OfAPrismAtItsLeastDeviation) {
  const auto glass = FindNamedCurve("glass-F11", SpectrumRole::Unbounded);
  ASSERT_TRUE(glass);
  for (const double wavelength : {400.0, 486.1, 587.6, 656.3, 750.0}) {
    const double n = glass->At(wavelength), incidence = std::asin(n * 0.5);
    const double half = kPiExact / 6;
    const Vector3 in(-std::cos(half), std::sin(half), 0), out(std::cos(half), std::sin(half), 0);
    // Travels at the angle of incidence to the first face, on the side of the base.
    const double angle = half - incidence;
    const Vector3 d(static_cast<float>(std::cos(angle)), static_cast<float>(-std::sin(angle)), 0);
    const Vector3 inside = Through(FaceOf(n, in), d, kRefracts);
    EXPECT_NEAR(inside.y, 0, 1e-6) << wavelength;
    const Vector3 after = Through(FaceOf(n, out), inside, kRefracts);
    const double deviation = std::acos(static_cast<double>(glm::dot(d, after)));
    EXPECT_NEAR(deviation, 2 * incidence - 2 * half, 1e-5) << wavelength;
  }
}

// The angle between the sun and the light of a drop that is refracted, reflected inside and refracted again is largest
// at Descartes' angle, 4 r - 2 i with cos² i = (n² - 1) / 3: 42.4 degrees in red, 40.5 in violet.
TEST(Dispersion, OfTheRainbow) {
  const SpectralCurve water = Water();
  for (const auto& [wavelength, known] : {std::pair(700.0, 42.4), std::pair(405.0, 40.6)}) {
    const double n = water.At(wavelength);
    double largest = 0;
    for (int i = 1; i < 20000; ++i) {
      const double b = i / 20000.0;
      const Vector3 d(1, 0, 0);
      Vector3 normal(static_cast<float>(-std::sqrt(1 - b * b)), static_cast<float>(b), 0);
      Vector3 direction = Through(FaceOf(n, normal), d, kRefracts);
      Vector3 point = normal;
      const auto cross = [&] {
        point = glm::normalize(point - 2 * glm::dot(point, direction) * direction);
        normal = point;
      };
      cross();
      direction = Through(FaceOf(n, normal), direction, kReflects);
      cross();
      direction = Through(FaceOf(n, normal), direction, kRefracts);
      largest = std::max(largest, std::acos(std::clamp(-static_cast<double>(direction.x), -1.0, 1.0)));
    }
    const double i = std::acos(std::sqrt((n * n - 1) / 3)), r = std::asin(std::sin(i) / n);
    EXPECT_NEAR(largest, 4 * r - 2 * i, 2e-4) << wavelength;
    EXPECT_NEAR(largest * 180 / kPiExact, known, 0.2) << wavelength;
  }
}

// A smooth dispersive face conserves energy: its reflection and the refractions of the three lanes add up to 1.
TEST(Dispersion, LosesNothing) {
  for (const float cosine : {1.0f, 0.6f, 0.1f}) {
    for (const float side : {1.0f, -1.0f}) {
      Color sum;
      for (int lane = 0; lane < 3; ++lane) {
        const DispersiveBsdf face{TrowbridgeReitz(0, 0), Color(1.4f, 1.6f, 2.2f), lane};
        constexpr int kSteps = 4000;
        for (int i = 0; i < kSteps; ++i) {
          const Vector3 wo(std::sqrt(1 - cosine * cosine), 0, side * cosine);
          const float u = (static_cast<float>(i) + 0.5f) / kSteps;
          const BsdfSample sample = face.Sample(wo, u, Point2(0.5f), TransportMode::Importance);
          sum += sample.Weight() * ((sample.isDispersion ? 1.0f : 1.0f / 3) / kSteps);
        }
      }
      for (const float ofLane : {sum.r, sum.g, sum.b}) EXPECT_NEAR(ofLane, 1, 2e-3) << cosine << " " << side;
    }
  }
}

// Where the light of a band of wavelengths arrives behind a prism: on the far side of a sheet, seen from there.
std::string PrismScene(double wavelength) {
  const auto number = [](double x) { return std::to_string(x); };
  const double n = FindNamedCurve("glass-F11", SpectrumRole::Unbounded)->At(550), i = std::asin(0.5 * n);
  const double half = kPiExact / 6, before = half - i, after = i - half;
  // The beam arrives from the left and below, and leaves to the right and downwards at least deviation for 550 nm.
  const Point2d from(-10 * std::cos(before), 10 * std::sin(before));
  const Point2d sheet(4 * std::cos(after), -4 * std::sin(after));
  const std::string band = "[" + number(wavelength - 11) + " 0 " + number(wavelength - 10) + " 1 " +
                           number(wavelength + 10) + " 1 " + number(wavelength + 11) + " 0]";
  const Point2d eye(1.5 * sheet.x, 1.5 * sheet.y);
  return "Film \"rgb\" \"integer xresolution\" 96 \"integer yresolution\" 16\nPixelFilter \"box\"\n"
         "LookAt " +
         number(eye.x) + " " + number(eye.y) +
         " 0  0 0 0  0 0 1\n"
         "Camera \"orthographic\" \"float screenwindow\" [-0.6 0.6 -0.1 0.1]\n"
         "Integrator \"bdpt\" \"integer maxdepth\" 4\nWorldBegin\n"
         "LightSource \"spot\" \"spectrum I\" " +
         band + " \"float scale\" 100 \"point3 from\" [" + number(from.x) + " " + number(from.y) +
         " 0] \"point3 to\" [0 0 0] \"float coneangle\" 0.15 \"float conedeltaangle\" 0.01\n"
         "AttributeBegin Material \"dielectric\" \"spectrum eta\" \"glass-F11\"\n"
         "Shape \"trianglemesh\" \"point3 P\" [-0.57735 -0.5 -0.3  0 0.5 -0.3  0.57735 -0.5 -0.3  "
         "-0.57735 -0.5 0.3  0 0.5 0.3  0.57735 -0.5 0.3] \"integer indices\" "
         "[0 1 2 3 5 4 0 3 4 0 4 1 1 4 5 1 5 2 0 2 5 0 5 3] AttributeEnd\n"
         "AttributeBegin Material \"diffusetransmission\" \"rgb reflectance\" [0 0 0] \"rgb transmittance\" [1 1 1]\n"
         "Translate " +
         number(sheet.x) + " " + number(sheet.y) + " 0 Rotate " + number(-after * 180 / kPiExact) +
         " 0 0 1 Rotate 90 0 1 0 Shape \"disk\" \"float radius\" 2 AttributeEnd\n";
}

// Mean of the column over the light of a picture, in [0,1], and the light.
std::pair<double, double> CentroidOf(const Image& image) {
  double sum = 0, moment = 0;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      double value = 0;
      for (size_t c = 0; c < 3; ++c) value += std::abs(static_cast<double>(image.At(x, y, c)));
      sum += value;
      moment += value * (x + 0.5) / image.width;
    }
  }
  return {moment / sum, sum};
}

// Refraction of a unit direction at a face with the outward normal n, from an index n1 to n2.
Point2d Refracted(const Point2d& d, const Point2d& normal, double n1, double n2) {
  const Point2d n = glm::dot(d, normal) < 0 ? normal : -normal;
  const double ratio = n1 / n2, cosine = -glm::dot(d, n);
  return ratio * d + (ratio * cosine - std::sqrt(1 - ratio * ratio * (1 - cosine * cosine))) * n;
}
// Where a ray meets the line of points x with n·x = h.
Point2d Met(const Point2d& origin, const Point2d& d, const Point2d& n, double h) {
  return origin + (h - glm::dot(n, origin)) / glm::dot(n, d) * d;
}

// Where the middle of the beam meets the sheet, by Snell's law, along the sheet from the place of 550 nm.
double ExpectedPlace(double wavelength) {
  const auto glass = FindNamedCurve("glass-F11", SpectrumRole::Unbounded);
  const double half = kPiExact / 6, i = std::asin(0.5 * glass->At(550)), tilt = i - half, index = glass->At(wavelength);
  const Point2d in(-std::cos(half), std::sin(half)), out(std::cos(half), std::sin(half));
  const Point2d d(std::cos(tilt), std::sin(tilt)), sheet(std::cos(tilt), -std::sin(tilt));
  constexpr double kFace = 0.25;  // distance of the faces from the origin
  const Point2d entry = Met(-10.0 * d, d, in, kFace), inside = Refracted(d, in, 1, index);
  const Point2d exit = Met(entry, inside, out, kFace), after = Refracted(inside, out, index, 1);
  return glm::dot(Met(exit, after, sheet, 4), Point2d(sheet.y, -sheet.x));
}
double ExpectedShift(double wavelength) {
  return ExpectedPlace(wavelength) - ExpectedPlace(550);
}

TEST(Dispersion, OfAPrismInPictures) {
  for (const char* integrator : {"light", "bdpt", "vcm", "sppm"}) {
    double middle = 0;
    for (const double wavelength : {550.0, 450.0, 500.0, 620.0}) {
      RenderOverrides overrides;
      overrides.integrator = integrator;
      const auto [centroid, light] = CentroidOf(RenderText(PrismScene(wavelength), 192, overrides, 2).image);
      ASSERT_GT(light, 0) << integrator << " " << wavelength;
      const double at = (centroid - 0.5) * 1.2;  // the width of the screen
      if (wavelength == 550) middle = at;
      // Blue is deviated most: away from where the beam came from. The picture is seen from behind.
      EXPECT_NEAR(std::abs(at - middle), std::abs(ExpectedShift(wavelength)), 0.006) << integrator << " " << wavelength;
      EXPECT_NEAR(std::abs(middle), std::abs(ExpectedPlace(550)), 0.01) << integrator;
    }
  }
}

std::string GrayRoom(const std::string& object) {
  return "Film \"rgb\" \"integer xresolution\" 24 \"integer yresolution\" 24\n"
         "LookAt 0 0.2 2.4  0 -0.2 0  0 1 0 Camera \"perspective\" \"float fov\" 40\n"
         "Integrator \"path\" \"integer maxdepth\" 6\nWorldBegin\n"
         "LightSource \"infinite\" \"rgb L\" [1 1 1]\nMaterial \"diffuse\" \"rgb reflectance\" [0.5 0.5 0.5]\n"
         "Shape \"bilinearmesh\" \"point3 P\" [-3 -0.5 -3  3 -0.5 -3  -3 -0.5 3  3 -0.5 3]\n" +
         object;
}

double MeanOfChannel(const Image& image, size_t channel) {
  double sum = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) sum += static_cast<double>(image.At(x, y, channel));
  return sum / (image.width * image.height);
}

// A prism under a sky that is 1 everywhere shows 1 everywhere. To an eye inside it, where one lane may be reflected in
// total and another refracted before the path has dispersed, each wavelength shows what glass of its index does.
TEST(Spectral, FurnaceWithAPrism) {
  const auto scene = [](const std::string& eye, const std::string& index) {
    return "Film \"rgb\" \"integer xresolution\" 24 \"integer yresolution\" 16\nPixelFilter \"box\"\n" + eye +
           "Integrator \"path\" \"integer maxdepth\" 60\nWorldBegin\nLightSource \"infinite\" \"rgb L\" [1 1 1]\n"
           "Material \"dielectric\" " +
           index +
           "\nShape \"trianglemesh\" \"point3 P\" [-0.57735 -0.5 -0.3  0 0.5 -0.3  0.57735 -0.5 -0.3  "
           "-0.57735 -0.5 0.3  0 0.5 0.3  0.57735 -0.5 0.3] \"integer indices\" "
           "[0 1 2 3 5 4 0 3 4 0 4 1 1 4 5 1 5 2 0 2 5 0 5 3]\n";
  };
  const std::string inside = "LookAt 0 -0.1 0  1 0.2 0.1  0 1 0 Camera \"perspective\" \"float fov\" 120\n";
  constexpr double kFirst = 360, kStep = 20;
  std::vector<double> ofWavelength;
  for (double wavelength = kFirst; wavelength <= 840; wavelength += kStep) {
    const double n = CauchyCoefficients{1.3, 0.06, 0}.IndexAt(wavelength);
    ofWavelength.push_back(
        MeanOfChannel(RenderText(scene(inside, "\"float eta\" " + std::to_string(n)), 256, {}, 2).image, 1));
  }
  const Vector3d seenInside = ColorOf(SpectralCurve([&](double wavelength) {
    const auto i = static_cast<size_t>((wavelength - kFirst) / kStep);
    return std::lerp(ofWavelength[i], ofWavelength[std::min(i + 1, ofWavelength.size() - 1)],
                     (wavelength - kFirst) / kStep - static_cast<double>(i));
  }));
  const std::pair<std::string, Vector3d> eyes[] = {
      {"LookAt 1.2 2 3  0 0 0  0 1 0 Camera \"perspective\" \"float fov\" 22\n", Vector3d(1.0)}, {inside, seenInside}};
  constexpr int kSeeds = 8;
  for (const auto& [eye, known] : eyes) {
    const double bound = eye == inside ? 6e-3 : 1e-3;  // of the error of a mean
    for (const char* integrator : {"path", "vcm", "bdpt", "sppm"}) {
      if (!IsWhole() && integrator == std::string("bdpt")) break;
      Vector3d sum(0.0), squares(0.0);
      for (uint64_t seed = 0; seed < kSeeds; ++seed) {
        RenderOverrides overrides;
        overrides.integrator = integrator;
        overrides.seed = seed;
        const Image image = RenderText(scene(eye, "\"float cauchy\" [ 1.3 0.06 0 ]"), 128, overrides, 2).image;
        const Vector3d means(MeanOfChannel(image, 0), MeanOfChannel(image, 1), MeanOfChannel(image, 2));
        sum += means / static_cast<double>(kSeeds);
        squares += means * means / static_cast<double>(kSeeds);
      }
      for (int c = 0; c < 3; ++c) {
        const double error = std::sqrt(std::max(squares[c] - sum[c] * sum[c], 0.0) / (kSeeds - 1));
        EXPECT_NEAR(sum[c], known[c], 4.5 * error + 1e-3) << integrator << " " << c << " " << eye;
        EXPECT_LT(error, bound) << integrator << " " << c << " " << eye;
      }
    }
  }
}

// Without dispersion: gray light through glass of one index stays gray, and is that of red, green and blue. A pass with
// more light than others tints the picture by its wavelengths, which is noise: several seeds tell how much.
TEST(Spectral, WhiteStaysWhite) {
  const std::string text =
      GrayRoom("Material \"dielectric\" Translate 0 -0.1 0 Shape \"sphere\" \"float radius\" 0.4\n");
  constexpr int kSeeds = 6;
  for (const auto& [integrator, samples] : {std::pair("path", 1024), std::pair("bdpt", 256), std::pair("light", 1024),
                                            std::pair("vcm", 256), std::pair("sppm", 1024)}) {
    if (!IsWhole() && integrator != std::string("path") && integrator != std::string("vcm")) continue;
    double sum[2] = {0, 0}, squares[2] = {0, 0}, means = 0;  // of red and blue
    for (uint64_t seed = 0; seed < kSeeds; ++seed) {
      RenderOverrides overrides;
      overrides.integrator = integrator;
      overrides.spectral = true;
      overrides.seed = seed;
      const Image image = RenderText(text, samples, overrides, 2).image;
      for (size_t i = 0; i < 2; ++i) {
        const double tint = MeanOfChannel(image, 2 * i) / MeanOfChannel(image, 1) - 1;
        sum[i] += tint;
        squares[i] += tint * tint;
      }
      means += MeanOfChannel(image, 1) / kSeeds;
    }
    for (size_t i = 0; i < 2; ++i) {
      const double mean = sum[i] / kSeeds;
      const double error = std::sqrt((squares[i] / kSeeds - mean * mean) / (kSeeds - 1));
      EXPECT_LT(std::abs(mean), std::max(1e-3, 4 * error)) << integrator << " " << i;
      EXPECT_LT(error, std::string(integrator) == "light" ? 4e-3 : 5e-4) << integrator << ": too noisy";
    }
    // Merging and light tracing are tested in the matrix, where the noise is known.
    if (std::string(integrator) != "path" && std::string(integrator) != "bdpt") continue;
    RenderOverrides overrides;
    overrides.integrator = integrator;
    overrides.spectral = false;
    EXPECT_NEAR(means, MeanOfChannel(RenderText(text, 4 * samples, overrides, 2).image, 1), 3e-3 * means);
  }
}

// A texture that does not vary is the spectrum that it names, as a parameter would be.
TEST(Spectral, ConstantTexturesKeepTheirSpectra) {
  const std::string head =
      "Film \"rgb\" \"integer xresolution\" 4 \"integer yresolution\" 4\nLookAt 0 0 3 0 0 0 0 1 0\n"
      "Camera \"orthographic\"\nIntegrator \"path\"\nWorldBegin\nLightSource \"infinite\" \"rgb L\" [1 1 1]\n";
  const std::string sphere = "Shape \"sphere\"\n";
  const std::string direct =
      head + "Material \"conductor\" \"spectrum eta\" \"metal-Au-eta\" \"spectrum k\" \"metal-Au-k\"\n";
  const std::string textured = head +
                               "Texture \"eta\" \"spectrum\" \"constant\" \"spectrum value\" \"metal-Au-eta\"\n"
                               "Texture \"k\" \"spectrum\" \"constant\" \"spectrum value\" \"metal-Au-k\"\n"
                               "Material \"conductor\" \"texture eta\" \"eta\" \"texture k\" \"k\"\n";
  for (const bool isSpectral : {false, true}) {
    RenderOverrides overrides;
    overrides.spectral = isSpectral;
    EXPECT_EQ(RenderText(direct + sphere, 4, overrides).image.data,
              RenderText(textured + sphere, 4, overrides).image.data);
  }
}

// Any number of passes: the picture of a white surface is white after each.
TEST(Spectral, WhiteIsWhiteAfterAnyNumberOfPasses) {
  const std::string text =
      "Film \"rgb\" \"integer xresolution\" 4 \"integer yresolution\" 4\nCamera \"perspective\"\nIntegrator \"path\"\n"
      "WorldBegin\nLightSource \"infinite\" \"rgb L\" [1 1 1]\n";
  RenderOverrides overrides;
  overrides.spectral = true;
  for (const int passes : {1, 2, 3, 5, 8, 100}) {
    const Image image = RenderText(text, passes, overrides).image;
    for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(image.At(1, 2, c), 1, 1e-5) << passes;
  }
}

// Seen once, colours of lights and surfaces are those that they have as red, green and blue.
TEST(Spectral, ColoursAreKept) {
  const auto scene = [](const std::string& light, const std::string& reflectance) {
    return "Film \"rgb\" \"integer xresolution\" 4 \"integer yresolution\" 4\nLookAt 0 0 3 0 0 0 0 1 0\n"
           "Camera \"orthographic\"\nIntegrator \"path\" \"integer maxdepth\" 1\nWorldBegin\n"
           "LightSource \"infinite\" " +
           light + "\nMaterial \"diffuse\" " + reflectance + " Shape \"disk\" \"float radius\" 4\n";
  };
  const std::string white = "\"rgb reflectance\" [1 1 1]", even = "\"rgb L\" [1 1 1]";
  const std::string scenes[] = {scene("\"rgb L\" [0.9 0.1 0.05]", white),
                                scene(even, "\"rgb reflectance\" [0.05 0.6 0.1]"),
                                scene(even, "\"rgb reflectance\" [0.1 0.1 0.9]"),
                                scene("\"blackbody L\" 3000", white),
                                scene("\"blackbody L\" 8000", white),
                                scene("\"spectrum L\" \"stdillum-D65\"", white),
                                scene(even, "\"spectrum reflectance\" [400 0.2 500 0.6 600 0.3 700 0.5]")};
  for (const std::string& text : scenes) {
    RenderOverrides overrides;
    overrides.spectral = false;
    const Image rgb = RenderText(text, 16, overrides).image;
    overrides.spectral = true;
    const Image spectral = RenderText(text, 1024, overrides).image;
    const double largest = std::max({MeanOfChannel(rgb, 0), MeanOfChannel(rgb, 1), MeanOfChannel(rgb, 2)});
    for (size_t c = 0; c < 3; ++c)
      EXPECT_NEAR(MeanOfChannel(spectral, c), MeanOfChannel(rgb, c), 5e-3 * largest) << text << c;
  }
}

// A part of the shutter's time, long or short, has passes of all wavelengths.
TEST(Spectral, TimesAndWavelengthsOfPassesAreStratifiedTogether) {
  constexpr uint32_t kCells = 8;
  for (const uint64_t seed : {1u, 2u, 3u}) {
    for (const uint32_t first : {0u, 64u, 128u}) {
      std::vector<int> cells(kCells * kCells);
      for (uint32_t pass = first; pass < first + kCells * kCells; ++pass) {
        const SharedByPass shared(seed, nullptr, pass);
        const auto of = [](float x) { return static_cast<size_t>(x * kCells); };
        ++cells[of(shared.time) * kCells + of(shared.wavelengths)];
      }
      for (const int count : cells) EXPECT_EQ(count, 1) << seed << ", from " << first;
    }
  }
}

// A lamp that passes before a grey wall hides it for a part of the time, and lights it from elsewhere in another part.
TEST(Spectral, MovingThingsAreGrey) {
  for (const char* integrator : {"bdpt", "vcm", "sppm"}) {
    const std::string text = std::string("Film \"rgb\" \"integer xresolution\" 16 \"integer yresolution\" 16\n") +
                             "LookAt 0 -3 0  0 0 0  0 0 1\nCamera \"perspective\" \"float fov\" 40\nIntegrator \"" +
                             integrator + R"(" "integer maxdepth" 3
WorldBegin
AttributeBegin AreaLightSource "diffuse" "rgb L" [1 1 1]
ActiveTransform EndTime Translate 1 0 0 ActiveTransform All
Translate -0.5 0 0 Shape "sphere" "float radius" 0.3 AttributeEnd
Material "diffuse" "rgb reflectance" [0.5 0.5 0.5]
Shape "bilinearmesh" "point3 P" [-2 1 -2  2 1 -2  -2 1 2  2 1 2]
)";
    for (const uint64_t seed : {1u, 2u}) {
      RenderOverrides overrides;
      overrides.spectral = true;
      overrides.seed = seed;
      const Image image = RenderText(text, 256, overrides, 2).image;
      Vector3d sum(0.0);
      for (int y = 4; y < 12; ++y) {
        for (int x = 12; x < 16; ++x)
          for (size_t c = 0; c < 3; ++c) sum[static_cast<int>(c)] += static_cast<double>(image.At(x, y, c));
      }
      std::printf("[   info   ] %s, seed %d: R/G %.3f, B/G %.3f\n", integrator, static_cast<int>(seed), sum.x / sum.y,
                  sum.z / sum.y);
      EXPECT_NEAR(sum.x / sum.y, 1, 0.05) << integrator << ", seed " << seed;
      EXPECT_NEAR(sum.z / sum.y, 1, 0.05) << integrator << ", seed " << seed;
    }
  }
}

std::string Caustic(const std::string& integrator) {
  return "Film \"rgb\" \"integer xresolution\" 48 \"integer yresolution\" 48\n"
         "LookAt 0 2 0.01  0 0 0  0 0 -1 Camera \"orthographic\" \"float screenwindow\" [-1 -0.3 -0.35 0.35]\n"
         "Integrator \"" +
         integrator +
         "\" \"integer maxdepth\" 5\nWorldBegin\n"
         "LightSource \"spot\" \"rgb I\" [40 40 40] \"point3 from\" [-3 3 0] \"point3 to\" [0 0.6 0] \"float "
         "coneangle\" 7\n"
         "Material \"diffuse\" \"rgb reflectance\" [0.6 0.6 0.6]\n"
         "Shape \"bilinearmesh\" \"point3 P\" [-3 0 -3  3 0 -3  -3 0 3  3 0 3]\n"
         "Material \"dielectric\" \"float cauchy\" [1.45 0.02] Translate 0 0.6 0 Shape \"sphere\" \"float radius\" "
         "0.3\n";
}

// The colour of a caustic as a whole is right after a few passes.
TEST(Spectral, HueOfACausticAfterFourPasses) {
  const auto hue = [](const Image& image) {
    const double r = MeanOfChannel(image, 0), g = MeanOfChannel(image, 1), b = MeanOfChannel(image, 2);
    return std::array<double, 3>{r / (r + g + b), g / (r + g + b), b / (r + g + b)};
  };
  for (const char* integrator : {"vcm", "sppm", "light", "bdpt"}) {
    if (!IsWhole() && integrator == std::string("light")) break;
    RenderOverrides overrides;
    overrides.width = overrides.height = 96;
    const auto converged = hue(RenderText(Caustic(integrator), 64, overrides, 2).image);
    for (const uint64_t seed : {1, 2, 3}) {
      overrides.seed = seed;
      const auto early = hue(RenderText(Caustic(integrator), 4, overrides, 2).image);
      for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(early[c], converged[c], 0.05 * converged[c]) << integrator << c;
    }
  }
}

// Threads, and the division into passes, do not change the picture.
TEST(Spectral, PicturesDoNotDependOnThreads) {
  for (const char* integrator : {"path", "light", "bdpt", "vcm", "sppm"}) {
    for (const bool isAdaptive : {false, true}) {
      RenderOverrides overrides;
      if (isAdaptive) overrides.adaptive.emplace();
      const Rendered one = RenderText(Caustic(integrator), 6, overrides, 1),
                     three = RenderText(Caustic(integrator), 6, overrides, 3);
      EXPECT_EQ(one.image.data, three.image.data) << integrator;
      EXPECT_EQ(one.outcome.counts.droppedSamples, 0u) << integrator;
    }
  }
}

// Mean colour of the bands of a picture, in linear Rec. 709.
Vector3d ColourOfBands(const Image& image, const SpectralBands& bands) {
  Vector3d observed(0.0);
  constexpr int parts = 50;
  for (int band = 0; band < bands.count; ++band) {
    const double mean = MeanOfChannel(image, static_cast<size_t>(6 + band));
    for (int k = 0; k < parts; ++k) {
      const double at = bands.from + (band + (k + 0.5) / parts) * bands.Width();
      observed += mean * ColorMatching(at) * bands.Width() / (parts * 106.857);
    }
  }
  return XyzToRec709(observed);
}

TEST(Spectral, RefusesBandsThatAreNone) {
  const std::pair<const char*, const char*> cases[] = {
      {"\"float lambdamin\" 300", "error: \"lambdamin\" must be from 360 to 830 nm"},
      {"\"float lambdamax\" 900", "error: \"lambdamax\" must be from 360 to 830 nm"},
      {"\"float lambdamin\" 500 \"float lambdamax\" 500.5", "\"lambdamax\" must be above \"lambdamin\""},
      {"\"integer nbuckets\" 0", "error: \"nbuckets\""},
      {"\"integer nbuckets\" 513", "error: \"nbuckets\""},
  };
  for (const auto& [parameters, message] : cases) {
    SCOPED_TRACE(parameters);
    try {
      RenderText("Film \"spectral\" \"integer xresolution\" 1 \"integer yresolution\" 1 " + std::string(parameters) +
                     "\nCamera \"perspective\"\nWorldBegin\nLightSource \"point\"\n",
                 1);
      ADD_FAILURE() << "no error";
    } catch (const Error& e) {
      EXPECT_NE(std::string(e.what()).find(message), std::string::npos) << e.what();
      EXPECT_NE(std::string(e.what()).find(":1:"), std::string::npos) << e.what();
    }
  }
}

// A black body lights a surface whose reflectance rises with the wavelength: bands of the picture are those of the
// product, in every integrator, and the picture is what the observer sees of them.
TEST(Spectral, BandsAreTheSpectrum) {
  const auto scene = [](const std::string& integrator) {
    return "Film \"spectral\" \"integer xresolution\" 8 \"integer yresolution\" 8 \"integer nbuckets\" 20\n"
           "LookAt 0 2 0.01  0 0 0  0 0 -1 Camera \"orthographic\" \"float screenwindow\" [-0.3 0.3 -0.3 0.3]\n"
           "Integrator \"" +
           integrator +
           "\" \"integer maxdepth\" 3\nWorldBegin\n"
           "AttributeBegin Translate 0 2.5 0 Rotate 90 1 0 0 AreaLightSource \"diffuse\" \"blackbody L\" 3000 "
           "Shape \"disk\" \"float radius\" 0.5 AttributeEnd\n"
           "Material \"diffuse\" \"spectrum reflectance\" [360 0.1 830 0.9]\n"
           "Shape \"bilinearmesh\" \"point3 P\" [-1 0 -1  1 0 -1  -1 0 1  1 0 1]\n";
  };
  const auto expected = [](double wavelength) {
    const double x = wavelength * 1e-9, c = 1.438776877e-2;
    return std::pow(560e-9 / x, 5) * std::expm1(c / (560e-9 * 3000)) / std::expm1(c / (x * 3000)) *
           (0.1 + 0.8 * (wavelength - 360) / 470);
  };
  for (const char* integrator : {"path", "light", "bdpt", "vcm", "sppm"}) {
    for (const bool isAdaptive : {false, true}) {
      if (isAdaptive && std::string(integrator) == "light") continue;
      SCOPED_TRACE(integrator);
      RenderOverrides overrides;
      if (isAdaptive) overrides.adaptive.emplace();
      // Light tracing has as many light paths as the picture has pixels: too few of 8 × 8.
      if (integrator == std::string("light")) overrides.width = overrides.height = 64;
      const Image image = RenderText(scene(integrator), 256, overrides, 2).image;
      ASSERT_EQ(image.channels.size(), 26u + (image.ChannelIndex(kSplatShareChannel) >= 0 ? 1 : 0));
      double sums[2] = {0, 0};
      const auto mean = [&](int band) { return MeanOfChannel(image, static_cast<size_t>(6 + band)); };
      const SpectralBands bands{20, 360, 830};
      const auto middle = [&](int band) { return bands.from + (band + 0.5) * bands.Width(); };
      for (int band = 0; band < bands.count; ++band) {
        sums[0] += mean(band);
        sums[1] += expected(middle(band));
      }
      for (int band = 0; band < bands.count; ++band) {
        EXPECT_NEAR(mean(band) / sums[0] * sums[1] / expected(middle(band)), 1, 0.04) << middle(band);
      }
      const Vector3d seen = ColourOfBands(image, bands);
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(seen[c], MeanOfChannel(image, static_cast<size_t>(c)), 0.03 * seen.y) << c;
    }
  }
}

// The spectra of a lamp multiply, and so does what has none, which is upsampled.
TEST(Spectral, SpectraOfALampMultiply) {
  const auto emitted = [](const std::string& parameters, uint32_t pass) {
    RenderOverrides overrides;
    overrides.integrator = "path";
    overrides.spectral = true;
    Diagnostics diagnostics(Diagnostics::Mode::Collect);
    const BuiltScene built =
        BuildScene(ParseScene("Camera \"perspective\" WorldBegin LightSource \"infinite\" " + parameters, "test.pbrt",
                              diagnostics),
                   overrides, true, diagnostics);
    const RenderScene there =
        built.scene.AtWavelengths(std::make_shared<const Wavelengths>(Wavelengths::OfPass(1, pass)), {});
    return there.lighting->EscapedEmissionForCamera(0, {Point3(0.0f), Vector3(0, 0, 1)});
  };
  const std::string black = "\"blackbody L\" 2500 ", tint = "\"rgb color\" [1 0.3 0.05] ";
  const std::string warm = "\"bool enableColorTemperature\" true \"float colorTemperature\" 2500 ";
  for (uint32_t pass = 0; pass < 8; ++pass) {
    const Color white = emitted("", pass), ofBlack = emitted(black, pass);
    for (const auto& [both, other] : {std::pair(black + tint, tint), std::pair(black + warm, warm)}) {
      const Color product = ofBlack * emitted(other, pass), whole = emitted(both, pass) * white;
      for (const auto& [a, b] :
           {std::pair(product.r, whole.r), std::pair(product.g, whole.g), std::pair(product.b, whole.b)})
        EXPECT_NEAR(a, b, 1e-3f * b) << both << pass;
    }
  }
}

// Light goes through two coloured panes, and the camera looks through them: their spectra multiply, not their colours,
// which would be green by half. Where there is a medium somewhere, rays are followed from pane to pane.
TEST(Spectral, SpectraOfPanesMultiply) {
  const auto scene = [](const std::string& medium) {
    return "LookAt 0 3 0.01  0 0 0  0 1 0\n"
           "Film \"rgb\" \"integer xresolution\" 12 \"integer yresolution\" 12\n"
           "PixelFilter \"box\" Camera \"perspective\" \"float fov\" 40\n" +
           medium +
           "AttributeBegin Material \"thindielectric\" \"float eta\" 1.0001 \"rgb transmittance\" [0.9 0.5 0.02]\n"
           "Shape \"bilinearmesh\" \"point3 P\" [-9 1 -9  9 1 -9  -9 1 9  9 1 9] AttributeEnd\n"
           "AttributeBegin Material \"thindielectric\" \"float eta\" 1.0001 \"rgb transmittance\" [0.02 0.5 0.9]\n"
           "Shape \"bilinearmesh\" \"point3 P\" [-9 1.2 -9  9 1.2 -9  -9 1.2 9  9 1.2 9] AttributeEnd\n"
           "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [9 9 9] Translate 0 4 1.5\n"
           "Shape \"sphere\" \"float radius\" 0.5 AttributeEnd\n"
           "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [0.5 0.5 0.5] Translate 0.3 0.2 0.2\n"
           "Shape \"sphere\" \"float radius\" 0.15 AttributeEnd\n"
           "Material \"diffuse\" \"rgb reflectance\" [0.5 0.5 0.5]\n"
           "Shape \"bilinearmesh\" \"point3 P\" [-1 0 -1  1 0 -1  -1 0 1  1 0 1]\n";
  };
  const std::string plain = "WorldBegin\n",
                    somewhere =
                        "WorldBegin MakeNamedMedium \"m\" \"string type\" \"homogeneous\"\n"
                        "AttributeBegin MediumInterface \"m\" \"\" Material \"interface\" Translate 0 -9 0\n"
                        "Shape \"sphere\" \"float radius\" 0.1 AttributeEnd\n";
  RenderOverrides overrides;
  overrides.spectral = true;
  const Replicas reference = RenderReplicas(scene(somewhere), "path", 16, 128, overrides);
  overrides.seed = 1000;
  for (const char* integrator : {"path", "light", "bdpt", "vcm", "sppm"}) {
    for (const std::string& medium : {plain, somewhere}) {
      const Agreement agreement =
          CompareReplicas(RenderReplicas(scene(medium), integrator, 16, 128, overrides), reference, 6, 1e-4);
      EXPECT_TRUE(agreement.Agrees()) << integrator << (medium == plain ? ", without media: " : ", with: ")
                                      << agreement.bias << " ± " << agreement.biasError;
      std::printf("[   info   ] %s: %.2f %% ± %.2f %%\n", integrator, 100 * agreement.bias, 100 * agreement.biasError);
    }
  }
}

// Bands hold all of the light, and at its wavelengths, where glass disperses it: the caustic that is splatted, merged
// and connected.
TEST(Spectral, BandsOfDispersedLight) {
  for (const char* integrator : {"light", "bdpt", "vcm", "sppm"}) {
    RenderOverrides overrides;
    overrides.spectralBands = 47;
    const Image image = RenderText(Caustic(integrator), 128, overrides, 2).image;
    const Vector3d seen = ColourOfBands(image, {47, 360, 830});
    for (int c = 0; c < 3; ++c) {
      const double mean = MeanOfChannel(image, static_cast<size_t>(c));
      EXPECT_NEAR(seen[c], mean, 0.01 * mean) << integrator << " " << c;
    }
  }
}

// The film is saved and loaded with what it knows of white.
TEST(Spectral, FilmsKeepTheirWhite) {
  Film film(4, 2, {0, 0, 4, 2});
  film.Pixel(1, 1).Add(Color(1, 2, 3), 1);
  film.CountWhite({0.5, 1.0, 2.0});
  std::string bytes;
  ByteWriter writer([&](const void* data, size_t count) { bytes.append(static_cast<const char*>(data), count); });
  film.Save(writer);
  Film loaded = film.EmptyCopy();
  ByteReader reader(std::as_bytes(std::span(bytes)));
  loaded.Load(reader);
  EXPECT_EQ(loaded.Develop().data, film.Develop().data);
  EXPECT_FLOAT_EQ(film.Develop().At(1, 1, 0), 2);
  EXPECT_FLOAT_EQ(film.Develop().At(1, 1, 2), 1.5f);
  Film both = film.EmptyCopy();
  both.CountWhite({1.5, 1.0, 0.0});
  both.Add(film);
  EXPECT_FLOAT_EQ(both.Develop().At(1, 1, 0), 1);
}

}  // namespace
}  // namespace lampyr::test
