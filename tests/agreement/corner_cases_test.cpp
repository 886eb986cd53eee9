// Scenes at the edges of what integrators can sample: what one of them finds, the others find. Means of whole pictures
// by independent replicas, channel by channel.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "support/replicas.h"

namespace lampyr::test {
namespace {

struct Corner {
  const char* name;
  std::string text;
  std::vector<std::string> integrators;  // the first one is what the others are compared to
  int samples = 64;
  double notices = 0.05;  // twice the standard error of a difference has to be below that, relative
  double blur = 0.01;     // relative difference that merging, or rounding, may make
};

std::string Number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.9g", value);
  return text;
}

double MeanOfChannel(const Image& image, size_t channel) {
  double sum = 0;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) sum += static_cast<double>(image.At(x, y, channel));
  }
  return sum / (static_cast<double>(image.width) * image.height);
}

std::string Film(const std::string& view) {
  return view +
         "Film \"rgb\" \"integer xresolution\" 12 \"integer yresolution\" 12\nPixelFilter \"box\"\n"
         "Integrator \"path\" \"integer maxdepth\" 3\n";
}

const std::string kAbove = Film("LookAt 0 3 0  0 0 0  0 0 1 Camera \"perspective\" \"float fov\" 40\n");
const std::string kInFront = Film("LookAt 0 1 -4  0 0.8 0  0 1 0 Camera \"perspective\" \"float fov\" 50\n");
const std::string kFloor =
    "Material \"diffuse\" \"rgb reflectance\" [ 0.6 0.5 0.4 ]\n"
    "Shape \"trianglemesh\" \"point3 P\" [ -5 0 -5  5 0 -5  5 0 5  -5 0 5 ] \"integer indices\" [ 0 1 2 0 2 3 ]\n";

// A sphere of which the inner side emits, and of which both do, where rays pass its surface.
std::string PassedSphere(const std::string& emission, const std::string& placement) {
  return kAbove + "WorldBegin\nAttributeBegin\nAreaLightSource \"diffuse\" \"rgb L\" [ 1 1 1 ] " + emission +
         "\nTranslate 0 1.5 1.2\n" + placement +
         "Shape \"sphere\" \"float radius\" 0.5 \"float alpha\" 0\nAttributeEnd\n" + kFloor;
}

// A fire of the given size; its radiance makes up for that.
std::string Fire(double radius, const std::string& placement, double brightness = 1) {
  const double density = 0.4 / radius;
  return kInFront + "WorldBegin\n" + kFloor +
         "AttributeBegin\nMakeNamedMedium \"fire\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [ " +
         Number(density) + " " + Number(2 * density) + " " + Number(density) + " ] \"rgb sigma_s\" [ 0.1 0.1 0.1 ] " +
         "\"rgb Le\" [ 1 0.6 0.3 ] \"float Lescale\" " + Number(brightness / (radius * radius)) +
         "\nMediumInterface \"fire\" \"\"\nMaterial \"interface\"\n" + placement +
         "Shape \"sphere\" \"float radius\" " + Number(radius) + "\nAttributeEnd\n";
}

// A tube of 64 sides, of which each is a thousand times as long as wide, seen directly: nothing else is lit.
std::string SlenderTube() {
  constexpr int kSides = 64;
  std::string positions, indices;
  for (int i = 0; i < kSides; ++i) {
    const double angle = 2 * 3.14159265358979 * i / kSides;
    const std::string circle = Number(0.01 * std::cos(angle)) + " " + Number(0.01 * std::sin(angle)) + " ";
    positions += "-1 " + circle + "1 " + circle;
    const std::string a = Number(2 * i) + " ", b = Number(2 * i + 1) + " ", c = Number(2 * ((i + 1) % kSides)) + " ",
                      d = Number(2 * ((i + 1) % kSides) + 1) + " ";
    indices += a + b + c + c + b + d;
  }
  return Film("LookAt 0 1 10  0 0 0  0 1 0 Camera \"perspective\" \"float fov\" 14\n") +
         "WorldBegin\nRotate 20 0 0 1\nMaterial \"diffuse\" \"rgb reflectance\" [ 0 0 0 ]\nAreaLightSource \"diffuse\" "
         "\"rgb L\" [ 100 100 100 ] \"bool twosided\" true\nShape \"trianglemesh\" \"integer indices\" [ " +
         indices + "] \"point3 P\" [ " + positions + "]\n";
}

// A quadrilateral above a floor, where a unit has the given length.
std::string LargeQuad(double scale) {
  const auto at = [&](double value) { return Number(value * scale) + " "; };
  const std::string corner = at(0.5);
  return Film("LookAt 0 " + at(0.9) + "0  0 0 0  0 0 1 Camera \"perspective\" \"float fov\" 40\n") +
         "WorldBegin\nAttributeBegin\nAreaLightSource \"diffuse\" \"rgb L\" [ 10 10 10 ]\nReverseOrientation\n"
         "Shape \"bilinearmesh\" \"point3 P\" [ -" +
         corner + at(1) + "-" + corner + corner + at(1) + "-" + corner + "-" + corner + at(1) + corner + corner +
         at(1) + corner + "] \"integer indices\" [ 0 2 1 3 ]\nAttributeEnd\nScale " + at(1) + at(1) + at(1) + "\n" +
         kFloor;
}

// A room of fog with a lamp and a ball, where a unit has the given length.
std::string Fog(double scale) {
  const auto at = [&](double value) { return Number(value * scale) + " "; };
  const std::string scattering = Number(0.4 / scale) + " ", absorption = Number(0.1 / scale) + " ";
  return "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" \"rgb sigma_s\" [ " + scattering + scattering +
         scattering + "] \"rgb sigma_a\" [ " + absorption + absorption + absorption +
         "]\nMediumInterface \"\" \"fog\"\n" +
         Film("LookAt 0 " + at(1) + at(-4) + " 0 " + at(0.8) + "0  0 1 0 Camera \"perspective\" \"float fov\" 50\n") +
         "WorldBegin\nMediumInterface \"fog\" \"fog\"\nScale " + at(1) + at(1) + at(1) + "\n" + kFloor +
         "AttributeBegin\nAreaLightSource \"diffuse\" \"rgb L\" [ 10 10 10 ] \"bool twosided\" true\n"
         "Translate 0 2 0 Shape \"sphere\" \"float radius\" 0.3\nAttributeEnd\n"
         "Translate 0.6 0.5 0 Shape \"sphere\" \"float radius\" 0.4\n";
}

// A floor with a dim lamp above it, and a bright one behind it that a black plane hides.
std::string BetweenLamps(const std::string& materials) {
  const auto lamp = [](const char* radiance, const char* corners) {
    return std::string(
               "AttributeBegin\nMaterial \"diffuse\" \"rgb reflectance\" [ 0 0 0 ]\nAreaLightSource \"diffuse\" "
               "\"rgb L\" [ ") +
           radiance + " ]\nShape \"trianglemesh\" \"point3 P\" [ " + corners +
           " ] \"integer indices\" [ 0 1 2 0 2 3 ]\nAttributeEnd\n";
  };
  return "LookAt 0 0 5  0 0 0  0 1 0 Camera \"perspective\" \"float fov\" 90\nFilm \"rgb\" \"integer xresolution\" 24 "
         "\"integer yresolution\" 24\nPixelFilter \"box\"\nIntegrator \"path\" \"integer maxdepth\" 1\nWorldBegin\n" +
         materials +
         "MakeNamedMaterial \"d\" \"string type\" \"diffuse\" \"rgb reflectance\" [ 0.5 0.5 0.5 ]\n"
         "Material \"mix\" \"string materials\" [ \"other\" \"d\" ] \"float amount\" 0.5\n"
         "Shape \"trianglemesh\" \"point3 P\" [ -6 -6 0  6 -6 0  6 6 0  -6 6 0 ] \"point2 uv\" [ 0 0 1 0 1 1 0 1 ] "
         "\"integer indices\" [ 0 1 2 0 2 3 ]\nMaterial \"diffuse\" \"rgb reflectance\" [ 0 0 0 ]\nShape "
         "\"trianglemesh\" "
         "\"point3 P\" [ -99 -99 -0.5  99 -99 -0.5  99 99 -0.5  -99 99 -0.5 ] \"integer indices\" [ 0 1 2 0 2 3 ]\n" +
         lamp("10 10 10", "-0.2 -0.2 1  -0.2 0.2 1  0.2 0.2 1  0.2 -0.2 1") +
         lamp("40 40 40", "-2 -2 -2  2 -2 -2  2 2 -2  -2 2 -2");
}

std::vector<Corner> Corners() {
  const std::string beams =
      "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" \"rgb sigma_s\" [ 0.02 0.02 0.02 ] \"rgb sigma_a\" "
      "[ 0.002 0.002 0.002 ]\nMediumInterface \"\" \"fog\"\n" +
      Film("LookAt 0 0 -4  0 0 0  0 1 0 Camera \"perspective\" \"float fov\" 40\n") +
      "WorldBegin\nMediumInterface \"fog\"\nLightSource \"spot\" \"rgb I\" [ 6 6 6 ] \"float coneangle\" 15 \"point3 "
      "from\" "
      "[ -3 0 0 ] \"point3 to\" [ 0 0 0 ]\nAttributeBegin\nMaterial \"thindielectric\" \"float eta\" 1.2 \"rgb "
      "transmittance\" [ 0.9 0.3 0.05 ]\nShape \"trianglemesh\" \"point3 P\" [ -1 -2 -2  -1 2 -2  -1 2 2  -1 -2 2 ] "
      "\"integer indices\" [ 0 1 2 0 2 3 ]\nAttributeEnd\n";
  const std::string distant =
      Film("LookAt 0 0 -4  0 0 0  0 1 0 Camera \"perspective\" \"float fov\" 32\n") +
      "WorldBegin\nMakeNamedMedium \"fog\" \"string type\" \"homogeneous\" \"rgb sigma_s\" [ 0.1 0.1 0.1 ] \"rgb "
      "sigma_a\" [ 0 0 0 ]\nLightSource \"spot\" \"point3 from\" [ 37000 80000 47000 ] \"point3 to\" [ 0 0 0 ] \"float "
      "coneangle\" 0.00115 \"float conedeltaangle\" 1.15e-5 \"rgb I\" [ 1e10 1e10 1e10 ]\n"
      "Material \"interface\" MediumInterface \"fog\" \"\" Shape \"sphere\" \"float radius\" 1\n";
  // An eighth of a tube is in ink, which no other light passes.
  const std::string tube =
      kInFront +
      "WorldBegin\nMakeNamedMedium \"ink\" \"string type\" \"homogeneous\" \"rgb sigma_s\" [ 0 0 0 ] \"rgb sigma_a\" "
      "[ 10 10 10 ]\nAttributeBegin\nAreaLightSource \"diffuse\" \"rgb L\" [ 10 10 10 ]\nTranslate 0.7 1 0 Rotate 90 0 "
      "1 0 "
      "Shape \"cylinder\" \"float radius\" 0.05 \"float zmin\" -2 \"float zmax\" 2\nAttributeEnd\nAttributeBegin\n"
      "Material \"interface\" MediumInterface \"ink\" \"\" Translate 0 1 0 Shape \"sphere\" \"float radius\" 0.25\n"
      "AttributeEnd\n" +
      kFloor;
  // The floor turns its inner side, which is said to be empty, to the lamp, which is said to be in fog.
  const std::string twosided =
      "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" \"rgb sigma_s\" [ 0.5 0.5 0.5 ] \"rgb sigma_a\" "
      "[ 0.05 0.05 0.05 ]\nMediumInterface \"\" \"fog\"\n" +
      kInFront + "WorldBegin\n" + kFloor +
      "AttributeBegin\nMediumInterface \"fog\"\nAreaLightSource \"diffuse\" \"rgb L\" [ 9 8 7 ] \"bool twosided\" "
      "true\n"
      "Translate 0 1.8 0 Rotate 90 1 0 0 Shape \"disk\" \"float radius\" 0.5\nAttributeEnd\n";
  // A lamp whose size and scale are far from 1, while their product is 1.
  const auto rect = [](const char* view, const char* placement, const char* lamp) {
    return Film(view) + "WorldBegin\nAttributeBegin\nTranslate 0 2 0 Rotate -90 1 0 0 " + placement +
           " LightSource \"rect\" " + lamp + "\nAttributeEnd\nRotate -90 1 0 0 Shape \"disk\" \"float radius\" 2\n";
  };
  const char* const view = "LookAt 0 3 4  0 0 0  0 1 0 Camera \"perspective\" \"float fov\" 40\n";
  // All connections to the camera have one direction.
  const std::string parallel =
      "MakeNamedMedium \"fog\" \"string type\" \"uniformgrid\" \"integer nx\" 2 \"integer ny\" 2 \"integer nz\" 2 "
      "\"float "
      "density\" [ 1 0.2 0.5 3 0 2 0.1 1 ] \"point3 p0\" [ -3 -1 -3 ] \"point3 p1\" [ 3 3 3 ] \"rgb sigma_s\" [ 0 0 0 "
      "] "
      "\"rgb sigma_a\" [ 0.1 0.1 0.1 ] \"rgb Le\" [ 0.1 0.1 0.1 ]\nMediumInterface \"\" \"fog\"\n" +
      Film("LookAt 0 1 -5  0 1 0  0 1 0 Camera \"orthographic\" \"float screenwindow\" [ -2 2.2 -1.4 1.8 ]\n") +
      "WorldBegin\nMediumInterface \"fog\"\nMaterial \"diffuse\" \"rgb reflectance\" [ 0 0 0 ]\nShape \"bilinearmesh\" "
      "\"point3 P\" [ -4 -1.1 -4  4 -1.1 -4  -4 -1.1 4  4 -1.1 4 ]\n";
  const std::string portal =
      kAbove +
      "WorldBegin\nAttributeBegin\nTranslate 0 1 0 Rotate -90 1 0 0\nLightSource \"portal\" \"float width\" 1 \"float "
      "height\" 1\nAttributeEnd\nLightSource \"spot\" \"point3 from\" [ 0 2 0 ] \"point3 to\" [ 0 5 0 ] \"rgb I\" "
      "[ 5 5 5 ]\n" +
      kFloor + "Translate 0 20 0\n" + kFloor;
  const std::string moves = "ActiveTransform EndTime Translate 0.9 0.2 0\nActiveTransform All Translate -0.5 0.6 0\n";
  const std::string unused =
      kAbove +
      "WorldBegin\nLightSource \"distant\" \"point3 from\" [ 0 1 0 ] \"point3 to\" [ 0 0 0 ]\nShape \"trianglemesh\" "
      "\"point3 P\" [ -5 0 -5  5 0 -5  5 0 5  -5 0 5  1000 1000 1000 ] \"integer indices\" [ 0 1 2 0 2 3 ]\n";
  const std::string glass = "MakeNamedMaterial \"other\" \"string type\" \"dielectric\" \"float roughness\" 0\n";
  const std::string slope =
      "Texture \"slope\" \"float\" \"bilerp\" \"float v10\" 0 \"float v11\" 0 \"float v00\" 0 \"float v01\" 60\n"
      "MakeNamedMaterial \"other\" \"string type\" \"diffuse\" \"rgb reflectance\" [ 0 0 0 ] \"texture displacement\" "
      "\"slope\"\n";
  // Fog and a lamp, above a ground that ends far away.
  const std::string farGround =
      "AttributeBegin\nTranslate 0 -3 0 Material \"diffuse\" \"rgb reflectance\" [ 0 0 0 ]\nShape \"bilinearmesh\" "
      "\"point3 P\" [ -500 0 500  500 0 500  -500 0 -500  500 0 -500 ]\nAttributeEnd\n";
  const std::string smallFog =
      Film("LookAt 0 0.3 4  0 0 0  0 1 0 Camera \"perspective\" \"float fov\" 40\n") +
      "WorldBegin\nMakeNamedMedium \"unused\" \"string type\" \"homogeneous\"\n"
      "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [ 0.05 0.05 0.05 ] \"rgb "
      "sigma_s\" [ 0.3 0.3 0.3 ]\nAttributeBegin\nMediumInterface \"fog\" \"\" Material \"interface\" Shape \"sphere\" "
      "\"float radius\" 2\nAttributeEnd\nMediumInterface \"fog\"\nMaterial \"diffuse\"\nShape \"bilinearmesh\" "
      "\"point3 P\" [ -1 -0.5 1  1 -0.5 1  -1 -0.5 -1  1 -0.5 -1 ]\nLightSource \"point\" \"rgb I\" [ 2 2 2 ] "
      "\"point3 from\" [ 0 0.5 0 ]\nMediumInterface \"\"\n" +
      farGround;
  // A pixel shows less than the rounding of positions at the scene's edge, which is `size` away.
  const auto detail = [](const std::string& size, const std::string& pane) {
    return Film("LookAt 0.08 0.06 0.1  0 0.01 0  0 1 0 Camera \"perspective\" \"float fov\" 40\n") + "WorldBegin\n" +
           pane +
           "Material \"diffuse\"\nShape \"bilinearmesh\" \"point3 P\" [ -1 0 1  1 0 1  -1 0 -1  1 0 -1 ]\n"
           "Shape \"bilinearmesh\" \"point3 P\" [ -" +
           size + " -1 " + size + " " + size + " -1 " + size + " -" + size + " -1 -" + size + " " + size + " -1 -" +
           size +
           " ]\nShape \"bilinearmesh\" \"point3 P\" [ -0.05 0 -0.03  0.05 0 -0.03  -0.05 0.1 -0.03  0.05 0.1 -0.03 ]\n"
           "Material \"diffuse\" \"rgb reflectance\" [ 0 0 0 ] Translate 0 0.03 0 Rotate -90 1 0 0 LightSource "
           "\"disk\" "
           "\"rgb color\" [ 10 10 10 ] \"float radius\" 0.005\n";
  };
  const char* const pane =
      "AttributeBegin\nMaterial \"thindielectric\" Translate 0.0794 0.0596 0.0993\nShape \"sphere\" \"float radius\" "
      "0.0005\nAttributeEnd\n";
  return {
      {"tube_of_slender_triangles", SlenderTube(), {"path", "light", "bdpt", "vcm"}, 512},
      {"small_fog_above_a_far_ground", smallFog, {"bdpt", "vcm", "sppm"}, 256},
      {"detail_of_a_large_scene", detail("1e6", ""), {"path", "bdpt", "vcm", "sppm"}},
      {"detail_behind_a_pane", detail("1e4", pane), {"path", "bdpt", "vcm"}},
      {"mixed_with_glass_between_lamps", BetweenLamps(glass), {"path", "bdpt", "vcm"}, 256, 0.1, 0.02},
      {"mixed_with_a_slope_between_lamps", BetweenLamps(slope), {"path", "bdpt", "vcm"}, 256, 0.1, 0.02},
      {"vertex_that_no_face_uses", unused, {"path", "light", "bdpt", "sppm"}},
      {"sphere_of_two_sides_that_rays_pass",
       PassedSphere("\"bool twosided\" true", ""),
       {"path", "bdpt", "vcm", "sppm"}},
      {"sphere_inside_out_that_rays_pass", PassedSphere("", "ReverseOrientation\n"), {"path", "bdpt", "vcm", "sppm"}},
      {"beams_behind_a_tinted_pane", beams, {"path", "bdpt", "vcm", "sppm"}, 256},
      {"fog_far_from_its_lamp", distant, {"path", "light", "bdpt", "vcm"}, 256},
      {"ink_around_a_part_of_a_lamp", tube, {"path", "light", "bdpt", "vcm", "sppm"}, 256},
      {"fog_said_of_both_sides_of_a_lamp", twosided, {"path", "light", "bdpt", "vcm", "sppm"}, 256},
      {"tiny_lamp_placed_large",
       rect(view, "Scale 1e20 1e20 1e20", "\"float width\" 1e-20 \"float height\" 1e-20"),
       {"path", "light", "bdpt", "vcm", "sppm"},
       128},
      {"large_lamp_placed_tiny",
       rect(view, "Scale 1e-20 1e-20 1e-20", "\"float width\" 1e20 \"float height\" 1e20"),
       {"path", "light", "bdpt", "vcm", "sppm"},
       128},
      {"dim_lamp_of_a_small_scene",
       Film("LookAt 0 3e-15 4e-15  0 0 0  0 1 0 Camera \"perspective\" \"float fov\" 40\n") +
           "WorldBegin\nScale 1e-15 1e-15 1e-15\nAttributeBegin\nTranslate 0 2 0 Rotate -90 1 0 0 LightSource \"rect\" "
           "\"float intensity\" 1e-20\nAttributeEnd\nRotate -90 1 0 0 Shape \"disk\" \"float radius\" 2\n",
       {"path", "light", "bdpt", "vcm", "sppm"},
       128},
      {"glow_seen_in_parallel", parallel, {"path", "light", "bdpt", "vcm", "sppm"}, 256},
      {"portal_behind_the_middle", portal, {"path", "bdpt", "vcm", "sppm"}},
      {"small_fire", Fire(0.012, "Translate 0.31 0.45 0.22\n"), {"path", "light"}, 1024, 0.2},
      {"moving_fire", Fire(0.2, moves), {"path", "light", "sppm"}, 512, 0.08},
      {"dim_fire", Fire(0.2, "Translate 0 0.6 0\n", 1e-30), {"path", "light", "sppm"}, 256},
      {"large_quadrilateral", LargeQuad(1e10), {"path", "bdpt", "light", "sppm"}, 256},
      {"small_quadrilateral", LargeQuad(1e-10), {"path", "bdpt", "light", "sppm"}, 256},
      {"large_fog", Fog(1e14), {"path", "bdpt", "vcm"}},
      {"small_fog", Fog(1e-14), {"path", "bdpt", "vcm"}},
  };
}

class CornerCases : public ::testing::TestWithParam<Corner> {};

TEST_P(CornerCases, AreTheSameToAllIntegrators) {
  constexpr int kReplicas = 8;
  const Corner& corner = GetParam();
  struct Means {
    std::array<double, 3> mean{}, variance{};  // variance: of the mean
  };
  const auto meansOf = [&](const std::string& integrator) {
    const Replicas replicas = RenderReplicas(corner.text, integrator, kReplicas, corner.samples);
    EXPECT_EQ(replicas.faults, 0u) << integrator;
    Means means;
    for (size_t c = 0; c < 3; ++c) {
      double sum = 0, squares = 0;
      for (const Image& image : replicas.images) {
        const double mean = MeanOfChannel(image, c);
        sum += mean / kReplicas;
        squares += mean * mean / kReplicas;
      }
      means.mean[c] = sum;
      means.variance[c] = std::max(squares - sum * sum, 0.0) / (kReplicas - 1);
    }
    return means;
  };
  const Means known = meansOf(corner.integrators.front());
  for (size_t i = 1; i < corner.integrators.size(); ++i) {
    const Means means = meansOf(corner.integrators[i]);
    for (size_t c = 0; c < 3; ++c) {
      ASSERT_GT(known.mean[c], 0);
      const double difference = means.mean[c] / known.mean[c] - 1;
      const double error = std::sqrt(means.variance[c] + known.variance[c]) / known.mean[c];
      std::printf("[   info   ] %s %s %zu: %+.2f %% +- %.2f %%\n", corner.name, corner.integrators[i].c_str(), c,
                  100 * difference, 100 * error);
      // Student's t of 7 to 14 degrees of freedom exceeds 6 once in a thousand cases, at most.
      EXPECT_LT(std::abs(difference), 6 * error + corner.blur) << corner.integrators[i] << ", channel " << c;
      EXPECT_LT(2 * error, corner.notices) << corner.integrators[i] << ": too noisy to notice anything";
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, CornerCases, ::testing::ValuesIn(Corners()),
                         [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace lampyr::test
