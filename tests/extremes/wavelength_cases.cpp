// Light by wavelength: glass that hardly disperses and glass that disperses beyond all that exists, of any size, in
// light of any strength; and colours at the edge of what red, green and blue can be.
#include "extremes/extreme_case.h"
#include "extremes/floor_rig.h"

namespace lampyr::test {

namespace {

// A ball of radius `size` before a sky of radiance `light`, which shines through it as if it were not there: what a
// smooth dielectric reflects and refracts is the same from all sides, at every wavelength.
std::string DispersingBall(const std::string& eta, double size, double light) {
  return "Film \"rgb\" \"integer xresolution\" 4 \"integer yresolution\" 4\nPixelFilter \"box\"\nLookAt " +
         Numbers({0, 0, -3 * size, 0, 0, 0}) + " 0 1 0\nCamera \"orthographic\" \"float screenwindow\" [" +
         Numbers({-size, size, -size, size}) +
         "]\nIntegrator \"path\" \"integer maxdepth\" 500\nWorldBegin\nLightSource \"infinite\" \"rgb L\" [" +
         Numbers({light, light, light}) + "]\nMaterial \"dielectric\" " + eta + " Shape \"sphere\" \"float radius\" " +
         Number(size) + "\n";
}

struct Glass {
  const char *name, *eta;
};
constexpr Glass kGlasses[] = {
    {"BK7", "\"spectrum eta\" \"glass-BK7\""},
    {"n from 1.000011 to 1.00001", "\"spectrum eta\" [ 400 1.000011 700 1.00001 ]"},
    {"n from 1.4 to 4.1", "\"float cauchy\" [ 1 0.2 0.05 ]"},
    {"n from 4 to 1.05", "\"spectrum eta\" [ 380 4 720 1.05 ]"},
    {"n that steps from 1.2 to 2.4 within 0.001 nm", "\"spectrum eta\" [ 550 1.2 550.001 2.4 ]"},
    {"n that falls through 1", "\"spectrum eta\" [ 400 1.3 700 0.8 ]"},
};

void AddDispersingBalls(std::vector<ExtremeCase>& cases) {
  for (const Glass& glass : kGlasses)
    cases.push_back({std::string("ball of glass, ") + glass.name, DispersingBall(glass.eta, 1, 3), 3, kFromCamera});
  for (const double size : {1e-6, 1e-3, 1e3, 1e6})
    cases.push_back({"ball of F11, of size " + Short(size), DispersingBall("\"spectrum eta\" \"glass-F11\"", size, 3),
                     3, kFromCamera});
  for (const double light : {1e-30, 1e30})
    cases.push_back({"ball of F11, " + Short(light) + " times as bright",
                     DispersingBall("\"spectrum eta\" \"glass-F11\"", 1, 3 * light), 3 * light, kFromCamera});
}

// A floor under a point, carried by wavelength though nothing disperses: green, which is measured, stays what it is.
void AddFloorsByWavelengthByWavelength(std::vector<ExtremeCase>& cases) {
  const auto add = [&](const std::string& name, const std::string& color, double light) {
    FloorRig rig;
    const std::string point = "LightSource \"point\" \"rgb I\" [" + color + "] \"float scale\" " + Number(light) +
                              " \"point3 from\" [0 1 0]\n";
    ExtremeCase extreme{name + ", by wavelength",
                        rig.Scene(point),
                        rig.Radiance([&](const Point3d& P) {
                          const double d = std::sqrt(P.x * P.x + 1 + P.z * P.z);
                          return 3 * light / (d * d * d);
                        }),
                        {"path", "bdpt", "sppm", "vcm"}};
    extreme.overrides.spectral = true;
    extreme.samples = 64;  // so many wavelengths: saturated colours are means over them
    cases.push_back(extreme);
  };
  for (const double light : {1e-30, 1.0, 1e30}) add("a point of " + Short(light), "3 3 3", light);
  add("a green point", "0 3 0", 1);
  add("a point whose green is 1e6 times its red and blue", "3e-6 3 3e-6", 1);
}

}  // namespace

std::vector<ExtremeCase> WavelengthCases() {
  std::vector<ExtremeCase> cases;
  AddDispersingBalls(cases);
  AddFloorsByWavelengthByWavelength(cases);
  return cases;
}

}  // namespace lampyr::test
