// Materials at the ends of their parameters, and paths of a thousand events.
#include <cmath>

#include "extremes/extreme_case.h"
#include "extremes/floor_rig.h"

namespace lampyr::test {

namespace {

std::string Gray(double value) {
  return "[" + Numbers({value, value, value}) + "]";
}

const std::vector<std::string> kThroughSmooth = {"path", "bdpt", "sppm", "vcm"};

// Radiance of a mirror under a uniform sky, seen from straight above.
void AddMirrors(std::vector<ExtremeCase>& cases) {
  for (const char* remap : {"", " \"bool remaproughness\" false"}) {
    for (const double roughness : {0.0, 1e-9, 1e-5, 1.1e-3, 1e-2}) {
      FloorRig rig;
      rig.material = "Material \"conductor\" \"rgb reflectance\" [0.7 0.7 0.7] \"float roughness\" " +
                     Number(roughness) + remap + "\n";
      cases.push_back(
          {"mirror of roughness " + Short(roughness) + (*remap ? ", not remapped" : "") + " under an even sky",
           rig.Scene("LightSource \"infinite\" \"rgb L\" [3 3 3]\n", 3), 2.1, kThroughSmooth});
    }
  }
  // The sun of 20° in the mirror: of the lobe at the zenith, GGX has tan²/(α² + tan²) of its normals within 5°.
  for (const double alpha : {1e-5, 1.01e-3, 2e-3, 2e-2}) {
    FloorRig rig;
    rig.half = 0.01;
    rig.material =
        "Material \"conductor\" \"rgb reflectance\" [0.7 0.7 0.7] \"bool remaproughness\" false \"float roughness\" " +
        Number(alpha) + "\n";
    const double t2 = std::pow(std::tan(5 * M_PI / 180), 2);
    cases.push_back({"sun of 20° in a mirror of roughness " + Short(alpha),
                     rig.Scene("LightSource \"distant\" \"rgb L\" [3 3 3] \"float angle\" 20 \"point3 from\" [0 1 0] "
                               "\"point3 to\" [0 0 0]\n",
                               1),
                     2.1 * (alpha < 1e-3 ? 1 : t2 / (t2 + alpha * alpha)), kThroughSmooth, 64});
  }
  // A lamp as large as the lobe is nothing: a needle of a density, times a needle of a light.
  for (const double radius : {1e-2, 1e-5}) {
    FloorRig rig;
    rig.half = 0.2 * radius;
    rig.middle = {0, 0, 0};
    rig.extent = 1;
    rig.material = "Material \"conductor\" \"rgb reflectance\" [0.7 0.7 0.7]\n";
    cases.push_back(
        {"lamp of radius " + Short(radius) + " in a mirror",
         rig.Scene("AttributeBegin Translate 0 1 0 LightSource \"sphere\" \"rgb color\" [3 3 3] \"float radius\" " +
                       Number(radius) + " AttributeEnd\n",
                   1),
         2.1, kThroughSmooth});
  }
}

// A clear ball in an even sky is not seen, whatever it is made of.
void AddBalls(std::vector<ExtremeCase>& cases) {
  const auto ball = [](const std::string& material, double radius) {
    return "Film \"rgb\" \"integer xresolution\" 4 \"integer yresolution\" 4\nPixelFilter \"box\"\nLookAt 0 0 " +
           Number(4 * radius) +
           " 0 0 0 0 1 0\nCamera \"perspective\" \"float fov\" 40\nIntegrator \"path\" \"integer maxdepth\" "
           "1000\nWorldBegin\n"
           "LightSource \"infinite\" \"rgb L\" [1 1 1]\nMaterial " +
           material + "\nShape \"sphere\" \"float radius\" " + Number(radius) + "\n";
  };
  for (const double eta : {1.0, 1.0001, 1.5, 2.5, 100.0, 1 / 1.5}) {
    cases.push_back(
        {"ball of η " + Short(eta), ball("\"dielectric\" \"float eta\" " + Number(eta), 1), 1, kThroughSmooth, 64});
  }
  for (const double roughness : {1e-9, 1e-5, 1e-3}) {
    ExtremeCase rough{"ball of η 1.5 and roughness " + Short(roughness),
                      ball("\"dielectric\" \"float eta\" 1.5 \"float roughness\" " + Number(roughness), 1), 1,
                      kThroughSmooth, 32};
    // Light that microfacets shadow is lost, which matters at the rim alone.
    if (roughness > 1e-4) rough.bias = 5e-3;
    // Few of the ball's directions are wide enough for photons, and few photons come to each.
    rough.overrides.values["radius"] = 0.1;
    rough.overrides.values["photons"] = 1024;
    cases.push_back(rough);
  }
  cases.push_back({"ball of η 1.0001 and roughness 1e-5",
                   ball("\"dielectric\" \"float eta\" 1.0001 \"float roughness\" 1e-5", 1), 1, kThroughSmooth, 64});
  for (const double radius : {1e-6, 1e6}) {
    cases.push_back({"ball of η 1.5, of radius " + Short(radius), ball("\"dielectric\" \"float eta\" 1.5", radius), 1,
                     kThroughSmooth, 64});
  }
  cases.push_back({"ball of reflectance 1", ball("\"diffuse\" \"rgb reflectance\" [1 1 1]", 1), 1, kThroughSmooth, 32});
  // Half of the image's side is tan 20°; the ball's rim is at asin(1/4).
  cases.push_back({"ball of reflectance 0", ball("\"diffuse\" \"rgb reflectance\" [0 0 0]", 1),
                   1 - M_PI / 4 * std::pow(std::tan(std::asin(0.25)) / std::tan(20 * M_PI / 180), 2), kThroughSmooth,
                   512});
}

// A lamp within a ball of glass that next to nothing refracts.
void AddLampsInGlass(std::vector<ExtremeCase>& cases) {
  for (const double eta : {1.0, 1.0001}) {
    FloorRig rig;
    rig.middle = {0.2, 0, -0.1};
    rig.extent = 10;
    ExtremeCase extreme{
        "lamp in a ball of η " + Short(eta),
        rig.Scene("Translate 0 1 0 LightSource \"sphere\" \"rgb color\" [3 3 3] \"float radius\" 0.3\nMaterial "
                  "\"dielectric\" "
                  "\"float eta\" " +
                      Number(eta) + " Shape \"sphere\" \"float radius\" 0.5\n",
                  6),
        rig.Radiance([](const Point3d& P) { return 3 * M_PI * 0.09 / std::pow(1 + P.x * P.x + P.z * P.z, 1.5); }),
        kAll,
        64,
        1024};
    extreme.overrides.values["radius"] = 0.05;
    extreme.overrides.values["photons"] = 256;
    extreme.noise = 0.3;
    // One part in a million is reflected, and photons are blurred.
    extreme.bias = 2e-3;
    cases.push_back(extreme);
  }
}

// Sheets over the floor: each lets (1 - R) / (1 + R) pass, by number.
void AddSheets(std::vector<ExtremeCase>& cases) {
  const double R = std::pow(0.5 / 2.5, 2), pass = (1 - R) / (1 + R);
  const auto stack = [](int count, const std::string& material) {
    std::string text = "AttributeBegin Material \"thindielectric\" " + material + "\n";
    for (int i = 0; i < count; ++i) {
      const double y = 0.5 + 0.001 * i;
      text += "Shape \"bilinearmesh\" \"point3 P\" [" + Numbers({-9, y, -9, 9, y, -9, -9, y, 9, 9, y, 9}) + "]\n";
    }
    return text + "AttributeEnd\n";
  };
  const std::string sun = "LightSource \"distant\" \"rgb L\" [3 3 3] \"point3 from\" [0 1 0] \"point3 to\" [0 0 0]\n";
  FloorRig rig;
  rig.extent = 1;
  for (const int count : {1, 10, 200}) {
    cases.push_back({"sun through " + std::to_string(count) + " sheets of glass",
                     rig.Scene(sun + stack(count, "\"float eta\" 1.5")), 1.5 / M_PI * std::pow(pass, count),
                     count == 1 ? kAll : kFromCamera, 64, 2048});
    cases.back().noise = 0.15;
    // Photons pass by chance: one in ten million, which all that vcm leaves to merging would hang on.
    if (count > 100) cases.back().integrators = {"path", "bdpt", "sppm"}, cases.back().samples = 8;
  }
  cases.push_back(
      {"sun of 1e30 through a sheet that lets 1e-30 pass",
       rig.Scene("LightSource \"distant\" \"rgb L\" [3e30 3e30 3e30] \"point3 from\" [0 1 0] \"point3 to\" [0 0 0]\n" +
                 stack(1, "\"float eta\" 1 \"rgb transmittance\" [1e-30 1e-30 1e-30]")),
       1.5 / M_PI, kAll, 64, 2048});
  cases.back().noise = 0.15;
  FloorRig above = rig;
  above.eye = 1;
  cases.push_back({"sun of 1e34 through a sheet that lets 1e-20 pass, seen through it",
                   above.Scene("LightSource \"distant\" \"rgb L\" [3e34 3e34 3e34] \"point3 from\" [0 1 0] \"point3 "
                               "to\" [0 0 0]\n" +
                               stack(1, "\"float eta\" 1 \"rgb transmittance\" [1e-20 1e-20 1e-20]")),
                   1.5e-6 / M_PI,
                   // Not vcm: one photon in ten thousand is seen, and what it brings is too dim to learn from where
                   // photons are of use. The mean is right, but hangs on a few photons.
                   {"path", "light", "bdpt", "sppm"},
                   64,
                   2048});
  cases.back().noise = 0.15;
  cases.push_back({"sun through a sheet that lets nothing pass",
                   rig.Scene(sun + stack(1, "\"float eta\" 1 \"rgb transmittance\" [0 0 0]")), 0, kAll});
}

// L = E (1 - ρ^n) / (1 - ρ) within a closed surface that emits E and reflects ρ, for n - 1 events.
void AddFurnaces(std::vector<ExtremeCase>& cases) {
  struct Furnace {
    double reflectance;
    int events;
    std::vector<std::string> integrators;
    int samples;
    double noise = 0.1;
  };
  for (const Furnace& furnace : {Furnace{0.5, 100, {"path", "bdpt", "sppm", "vcm"}, 64},
                                 {0.99, 1000, {"path", "sppm"}, 24, 0.8},
                                 {0.99, 1000, {"bdpt", "vcm"}, 8, 0.8},
                                 {0.99, 10, {"path", "bdpt", "sppm", "vcm"}, 32, 0.2},
                                 {0.999, 1000, {"path"}, 64, 0.2}}) {
    const double expected = (1 - std::pow(furnace.reflectance, furnace.events + 1)) / (1 - furnace.reflectance);
    ExtremeCase extreme{"furnace of reflectance " + Short(furnace.reflectance) + ", " + std::to_string(furnace.events) +
                            " events" + (furnace.integrators[0] == "bdpt" ? ", connected" : ""),
                        "Film \"rgb\" \"integer xresolution\" 1 \"integer yresolution\" 1\nPixelFilter \"box\"\nCamera "
                        "\"perspective\" \"float fov\" 70\n"
                        "Integrator \"path\" \"integer maxdepth\" " +
                            std::to_string(furnace.events) +
                            "\nWorldBegin\nReverseOrientation AreaLightSource \"diffuse\" \"rgb L\" [1 1 1]\nMaterial "
                            "\"diffuse\" \"rgb "
                            "reflectance\" " +
                            Gray(furnace.reflectance) + "\nShape \"sphere\" \"float radius\" 3\n",
                        expected, furnace.integrators, furnace.samples};
    extreme.noise = furnace.noise;
    extreme.overrides.values["radius"] = 1;  // a cap of a sphere within a distance r of a point has the area π r²
    extreme.overrides.values["photons"] = 64;
    cases.push_back(extreme);
  }
  // The camera in the middle of a mirror that shines: every ray comes back to where it was.
  for (const double reflectance : {0.9, 0.99}) {
    cases.push_back({"middle of a mirror of reflectance " + Short(reflectance) + " that shines, 1000 events",
                     "Film \"rgb\" \"integer xresolution\" 1 \"integer yresolution\" 1\nPixelFilter \"box\"\nCamera "
                     "\"perspective\" \"float fov\" 1\n"
                     "Integrator \"path\" \"integer maxdepth\" 1000\nWorldBegin\nReverseOrientation AreaLightSource "
                     "\"diffuse\" \"rgb L\" [1 1 "
                     "1]\nMaterial \"conductor\" \"rgb reflectance\" " +
                         Gray(reflectance) + "\nShape \"sphere\" \"float radius\" 3\n",
                     (1 - std::pow(reflectance, 1001)) / (1 - reflectance),
                     {"path", "bdpt", "sppm", "vcm"},
                     reflectance > 0.95 ? 64 : 128});
    cases.back().noise = reflectance > 0.95 ? 0.6 : 0.1;
    cases.back().bias = 2e-3;
  }
}

}  // namespace

std::vector<ExtremeCase> MaterialCases() {
  std::vector<ExtremeCase> cases;
  AddMirrors(cases);
  AddBalls(cases);
  AddLampsInGlass(cases);
  AddSheets(cases);
  AddFurnaces(cases);
  return cases;
}

}  // namespace lampyr::test
