// Lights at infinity: suns from a hundredth of a degree to the whole sphere, skies whose light is all in one texel, and
// windows to them; in scenes of all sizes.
#include <algorithm>

#include "extremes/extreme_case.h"
#include "extremes/floor_rig.h"
#include "extremes/light_files.h"

namespace lampyr::test {

namespace {

struct RigSky {
  std::string name;
  std::string text;  // one statement, of radiance or irradiance 3
  double irradiance;
};

// ∫ cosθ dω of a texel of a sky of 2n × n texels in row `row` from the zenith.
double TexelIrradiance(int row, int n) {
  const double low = M_PI * row / n, high = M_PI * (row + 1) / n;
  return M_PI / n * 0.5 * (std::pow(std::sin(std::min(high, M_PI / 2)), 2) - std::pow(std::sin(low), 2));
}

// A camera next to the floor, which is hardly larger than what is seen of it: photons come from all over the scene.
FloorRig RigOf(double size) {
  FloorRig rig;
  rig.half = 0.5 * size;
  rig.middle = {0.3 * size, 0, -0.2 * size};
  rig.eye = 0.1 * size;
  rig.extent = size;
  return rig;
}

std::vector<RigSky> RigSkies() {
  const std::string down = " \"point3 from\" [0 1 0] \"point3 to\" [0 0 0]";
  const std::string even = WriteTexels("even-sky", 16, 8, [](int, int) { return 3.0f; });
  const std::string square = WriteTexels("even-square", 8, 8, [](int, int) { return 3.0f; });
  return {
      {"distant", "LightSource \"distant\" \"rgb L\" [3 3 3]" + down, 3},
      {"distant of 30°", "LightSource \"distant\" \"rgb L\" [3 3 3] \"float angle\" 30" + down,
       3 * M_PI * std::pow(std::sin(15 * M_PI / 180), 2)},
      {"infinite", "LightSource \"infinite\" \"rgb L\" [3 3 3]", 3 * M_PI},
      {"infinite with an image", "LightSource \"infinite\" \"string filename\" \"" + square + "\"", 3 * M_PI},
      {"dome", "LightSource \"dome\" \"rgb color\" [3 3 3]", 3 * M_PI},
      {"dome with an image", "LightSource \"dome\" \"string texture:file\" \"" + even + "\"", 3 * M_PI},
  };
}

double Lit(double irradiance) {
  return 0.5 / M_PI * irradiance;
}

void AddPlaces(const RigSky& sky, std::vector<ExtremeCase>& cases) {
  for (const double size : {1e-6, 1e-3, 1e3, 1e6}) {
    cases.push_back(
        {sky.name + ", everything of size " + Short(size), RigOf(size).Scene(sky.text), Lit(sky.irradiance), kAll});
  }
  FloorRig moved = RigOf(1);
  moved.origin = {1e4, -2e4, 3e4};
  cases.push_back({sky.name + ", 3.7e4 sizes from the origin", moved.Scene(sky.text), Lit(sky.irradiance), kAll});
  for (const double strength : {1e-30, 1e30}) {
    // The power of what falls on so large a scene, or so small a one, is beyond what a float holds.
    const double size = strength < 1 ? 1e-6 : 1e6;
    cases.push_back({sky.name + ", " + Short(strength) + " times as bright, everything of size " + Short(size),
                     RigOf(size).Scene(sky.text + " \"float intensity\" " + Number(strength)),
                     strength * Lit(sky.irradiance), kAll});
    cases.push_back({sky.name + ", " + Short(strength) + " times as bright",
                     RigOf(1).Scene(sky.text + " \"float intensity\" " + Number(strength)),
                     strength * Lit(sky.irradiance), kAll});
  }
}

void AddSuns(std::vector<ExtremeCase>& cases) {
  const std::string down = " \"point3 from\" [0 1 0] \"point3 to\" [0 0 0]";
  const std::string aside = " \"point3 from\" [0 1 2] \"point3 to\" [0 0 0]";
  const double cosine = 1 / std::sqrt(5.0);
  for (const double angle : {1e-4, 0.01, 0.53, 179.9, 180.0, 359.9, 360.0}) {
    const double sine = std::sin(std::min(angle, 180.0) * M_PI / 360);
    const std::string text = "LightSource \"distant\" \"rgb L\" [3 3 3] \"float angle\" " + Number(angle);
    cases.push_back(
        {"distant of " + Short(angle) + "°", RigOf(1).Scene(text + down), Lit(3 * M_PI * sine * sine), kAll});
    const double wide = angle > 180 ? 1 / (2 - std::pow(std::sin(angle * M_PI / 360), 2)) : 1;
    cases.push_back({"distant of " + Short(angle) + "°, normalised",
                     RigOf(1).Scene(text + " \"bool normalize\" true" + down), Lit(3 * wide), kAll});
    if (angle < 1) {
      cases.push_back({"distant of " + Short(angle) + "°, aslant, by its illuminance",
                       RigOf(1).Scene(text + " \"float illuminance\" 2" + aside), Lit(6 * cosine), kAll});
    }
  }
  cases.push_back(
      {"distant, 1e-6 above the horizon",
       RigOf(1).Scene("LightSource \"distant\" \"rgb L\" [3 3 3] \"point3 from\" [1 1e-6 0] \"point3 to\" [0 0 0]"),
       Lit(3e-6), kFromCamera});
  cases.push_back(
      {"distant, in the plane of the floor",
       RigOf(1).Scene("LightSource \"distant\" \"rgb L\" [3 3 3] \"point3 from\" [1 0 0] \"point3 to\" [0 0 0]"), 0,
       kAll});
  // Half of the sun has set.
  const double angle = 10;
  cases.push_back(
      {"distant of 10°, half below the horizon",
       RigOf(1).Scene("LightSource \"distant\" \"rgb L\" [3 3 3] \"float angle\" 10 \"point3 from\" [1 0 0] "
                      "\"point3 to\" [0 0 0]"),
       // ∫ sinθ sinφ over the half disk: (θ - sinθ cosθ).
       Lit(3 * (angle * M_PI / 360 - 0.5 * std::sin(angle * M_PI / 180))), kFromCamera, 16});
}

void AddTexels(std::vector<ExtremeCase>& cases) {
  struct Texel {
    const char* name;
    int row;
    float bright, other;
  };
  for (const Texel& texel : {Texel{"one texel of 1e9 among 1e-3, at the zenith", 0, 1e9f, 1e-3f},
                             {"one texel of 1e9 among 1e-3, at the horizon", 3, 1e9f, 1e-3f},
                             {"one texel of 1e9 among 1e-3, below the floor", 6, 1e9f, 1e-3f},
                             {"all black but one texel", 1, 3, 0},
                             {"all black", 1, 0, 0}}) {
    double irradiance = (static_cast<double>(texel.bright) - static_cast<double>(texel.other)) *
                        (texel.row < 4 ? TexelIrradiance(texel.row, 8) : 0.0);
    irradiance += static_cast<double>(texel.other) * M_PI;
    const std::string file =
        WriteTexels(std::string("sky-") + std::to_string(texel.row) + (texel.other > 0 ? "b" : "k") +
                        (texel.bright > 0 ? "1" : "0"),
                    16, 8, [&](int x, int y) { return x == 5 && y == texel.row ? texel.bright : texel.other; });
    ExtremeCase extreme{std::string("dome, ") + texel.name,
                        RigOf(1).Scene("LightSource \"dome\" \"string texture:file\" \"" + file + "\"\n"),
                        Lit(irradiance), kAll};
    // All photons go to the texel that nobody sees, all but few.
    if (texel.row == 6) {
      extreme.integrators = kFromCamera;
      extreme.samples = 512;
    }
    if (texel.row == 3) extreme.lightSamples = 1024;
    cases.push_back(extreme);
  }
}

std::string Portal(double height, double width, double depth, const std::string& more = "") {
  return "AttributeBegin Translate 0 " + Number(height) +
         " 0 Rotate -90 1 0 0 LightSource \"portal\" \"rgb color\" [3 3 3] \"float width\" " + Number(width) +
         " \"float height\" " + Number(depth) + more + " AttributeEnd\n";
}

// The side along z of the window is that of its local y.
double UnderPortal(const FloorRig& rig, double height, double width, double depth) {
  return rig.Radiance([&](const Point3d& P) {
    return 3 * RectangleIrradiance(P, {-0.5 * width, height, -0.5 * depth}, {width, 0, 0}, {0, 0, depth});
  });
}

void AddPortals(std::vector<ExtremeCase>& cases) {
  for (const double size : {1e-6, 1e-3, 1e3, 1e6}) {
    FloorRig rig = RigOf(size);
    cases.push_back({"portal, everything of size " + Short(size), rig.Scene(Portal(size, size, 0.5 * size)),
                     UnderPortal(rig, size, size, 0.5 * size), kAll});
  }
  FloorRig moved = RigOf(1);
  moved.origin = {1e4, -2e4, 3e4};
  cases.push_back(
      {"portal, 3.7e4 sizes from the origin", moved.Scene(Portal(1, 1, 0.5)), UnderPortal(moved, 1, 1, 0.5), kAll});
  for (const double strength : {1e-30, 1e30}) {
    cases.push_back({"portal, " + Short(strength) + " times as bright",
                     RigOf(1).Scene(Portal(1, 1, 0.5, " \"float intensity\" " + Number(strength))),
                     strength * UnderPortal(RigOf(1), 1, 1, 0.5), kAll});
  }
  for (const double width : {1e-6, 1e-3}) {
    cases.push_back({"portal of size " + Short(width) + " at a distance of 1", RigOf(1).Scene(Portal(1, width, width)),
                     UnderPortal(RigOf(1), 1, width, width), kFromCamera});
    cases.push_back({"portal, " + Short(width) + " wide and 1 long", RigOf(1).Scene(Portal(1, width, 1)),
                     UnderPortal(RigOf(1), 1, width, 1), kFromCamera});
  }
  for (const double height : {1e2, 1e4, 1e6}) {
    cases.push_back({"portal at a distance of " + Short(height), RigOf(1).Scene(Portal(height, 1, 1)),
                     UnderPortal(RigOf(1), height, 1, 1), kFromCamera});
  }
  FloorRig near = RigOf(1);
  near.middle = {0, 0, 0};
  near.half = 0.1;
  near.eye = 5e-6;
  cases.push_back({"portal, 1e-5 above the floor", near.Scene(Portal(1e-5, 1, 1)), Lit(3 * M_PI), kFromCamera});
  // The portal stands on the floor and shines along it (-x).
  for (const double high : {1.0, 1e-3, 1e-6}) {
    const FloorRig rig = RigOf(1);
    cases.push_back({"portal, " + Short(high) + " high, standing on the floor",
                     rig.Scene("AttributeBegin Translate 3 " + Number(0.5 * high) +
                               " 0 Rotate 90 0 1 0 LightSource \"portal\" \"rgb color\" [3 3 3] \"float width\" 1 "
                               "\"float height\" " +
                               Number(high) + " AttributeEnd\n"),
                     rig.Radiance([&](const Point3d& P) {
                       return 3 * RectangleIrradiance(P, {3, 0, -0.5}, {0, 0, 1}, {0, high, 0});
                     }),
                     kFromCamera, 16});
  }
}

}  // namespace

std::vector<ExtremeCase> InfiniteLightCases() {
  std::vector<ExtremeCase> cases;
  for (const RigSky& sky : RigSkies()) AddPlaces(sky, cases);
  // Light comes from all around, and photons leave a disk of the scene's size.
  for (ExtremeCase& extreme : cases) extreme.lightSamples = 512, extreme.noise = 0.15;
  AddSuns(cases);
  for (ExtremeCase& extreme : cases) extreme.lightSamples = std::max(extreme.lightSamples, 512);
  AddTexels(cases);
  AddPortals(cases);
  return cases;
}

}  // namespace lampyr::test
