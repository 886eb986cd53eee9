// Lights that are a point: I cosθ / d² over sizes, distances, places and intensities; cones next to nothing and next to
// everything; images of one texel.
#include <algorithm>

#include "extremes/extreme_case.h"
#include "extremes/floor_rig.h"
#include "extremes/light_files.h"

namespace lampyr::test {

namespace {

// A light at the origin of its own space, above the floor, that shines down (-y) at least.
struct RigPoint {
  std::string name;
  std::string text;                                  // with an intensity of 3 where its profile is 1
  std::function<double(const Vector3d&)> intensity;  // by the unit direction of light
};

const std::string kLookDown = "Rotate -90 1 0 0 ";  // -z to -y

double Smoothstep(double t) {
  t = std::clamp(t, 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

std::vector<RigPoint> RigPoints() {
  const auto cosine = [](const Vector3d& d) { return -d.y; };
  std::vector<RigPoint> points;
  points.push_back({"point", "LightSource \"point\" \"rgb I\" [3 3 3]", [](const Vector3d&) { return 3.0; }});
  points.push_back({"spot",
                    "LightSource \"spot\" \"rgb I\" [3 3 3] \"point3 to\" [0 -1 0] \"float coneangle\" 60 "
                    "\"float conedeltaangle\" 50",
                    [cosine](const Vector3d& d) {
                      const double edge = std::cos(60 * M_PI / 180), core = std::cos(10 * M_PI / 180);
                      return 3 * Smoothstep((cosine(d) - edge) / (core - edge));
                    }});
  points.push_back({"goniometric",
                    "LightSource \"goniometric\" \"rgb I\" [3 3 3] \"string filename\" \"" +
                        WriteTexels("even", 8, 8, [](int, int) { return 1.0f; }) + "\"",
                    [](const Vector3d&) { return 3.0; }});
  // Its +z looks down.
  points.push_back(
      {"projection",
       "Rotate 90 1 0 0 LightSource \"projection\" \"float fov\" 120 \"float scale\" 3 \"string filename\" \"" +
           WriteTexels("even", 8, 8, [](int, int) { return 1.0f; }) + "\"",
       [](const Vector3d& d) {
         const double reach = -d.y * std::tan(60 * M_PI / 180);
         return std::max(std::abs(d.x), std::abs(d.z)) <= reach ? 3.0 : 0.0;
       }});
  // 100 and 40 cd at 0° and 90°, between them in proportion to the angle; 0 above.
  points.push_back(
      {"point with an IES profile",
       kLookDown + "LightSource \"point\" \"rgb I\" [0.03 0.03 0.03] \"string shaping:ies:file\" \"" +
           WriteText("lamp.ies", "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 2 1 1 2 0 0 0\n1 1 0\n0 90\n0\n100 40\n") + "\"",
       [cosine](const Vector3d& d) { return 3 - 1.8 * std::acos(cosine(d)) / (M_PI / 2); }});
  points.push_back(
      {"point with a cone",
       kLookDown + "LightSource \"point\" \"rgb I\" [3 3 3] \"float shaping:cone:angle\" 80 "
                   "\"float shaping:cone:softness\" 1",
       [cosine](const Vector3d& d) { return 3 * (1 - Smoothstep(std::acos(cosine(d)) * 180 / M_PI / 80)); }});
  return points;
}

// Radiance of the floor below a light `height` above its origin.
double Lit(const FloorRig& rig, double height, const std::function<double(const Vector3d&)>& intensity) {
  return rig.Radiance([&](const Point3d& P) {
    const Vector3d way = P - Point3d(0, height, 0);
    const double distance = glm::length(way);
    return intensity(way / distance) * height / (distance * distance * distance);
  });
}

// The rig that belongs to a light at a height: a patch beside the point below the light, of its size.
FloorRig RigOf(double height) {
  FloorRig rig;
  rig.half = 0.3 * height;
  rig.middle = {0.3 * height, 0, -0.2 * height};
  rig.eye = 0.2 * height;
  rig.extent = 10 * height;
  return rig;
}

std::string At(double height, const std::string& light, const std::string& strength = "") {
  return "AttributeBegin Translate 0 " + Number(height) + " 0 " + light + strength + " AttributeEnd\n";
}

void AddScaled(const RigPoint& light, std::vector<ExtremeCase>& cases) {
  for (const double size : {1e-6, 1e-3, 1e3, 1e6}) {
    const FloorRig rig = RigOf(size);
    cases.push_back({light.name + ", everything of size " + Short(size), rig.Scene(At(size, light.text)),
                     Lit(rig, size, light.intensity), kAll});
  }
  FloorRig moved = RigOf(1);
  moved.origin = {1e4, -2e4, 3e4};
  cases.push_back({light.name + ", 3.7e4 sizes from the origin", moved.Scene(At(1, light.text)),
                   Lit(moved, 1, light.intensity), kAll});
}

// A patch, and a floor of hardly more: places on a surface are known to 1e-7 of its size.
void Narrow(FloorRig& rig, double half) {
  rig.half = half;
  rig.extent = 4 * half;
  rig.places = 512;
}

// A floor of size 1: what is seen of it is as small as the distance, or 1.
void AddDistances(const RigPoint& light, std::vector<ExtremeCase>& cases) {
  for (const double height : {1e-5, 1e-2, 1e2, 1e6}) {
    FloorRig rig = RigOf(std::min(height, 1.0));
    rig.extent = 1;
    cases.push_back({light.name + ", at a distance of " + Short(height), rig.Scene(At(height, light.text)),
                     Lit(rig, height, light.intensity), height < 1 ? kAll : kFromCamera});
  }
}

void AddIntensities(const RigPoint& light, std::vector<ExtremeCase>& cases) {
  const FloorRig rig = RigOf(1);
  for (const double strength : {1e-30, 1e30}) {
    cases.push_back({light.name + ", " + Short(strength) + " times as bright",
                     rig.Scene(At(1, light.text, " \"float intensity\" " + Number(strength))),
                     strength * Lit(rig, 1, light.intensity), kAll});
  }
}

// Spots from a needle to nearly the whole sphere: the patch is as wide as the cone's soft edge, or 1.
void AddCones(std::vector<ExtremeCase>& cases) {
  struct Cone {
    double angle, delta;
  };
  for (const Cone& cone : {Cone{0.01, 0.01},
                           {0.01, 0.001},
                           {0.01, 0},
                           {1, 1e-4},
                           {89.9, 0.1},
                           {90, 90},
                           {179.9, 0.1},
                           {179.9, 179.9},
                           {180, 0},
                           {180, 180}}) {
    const auto oneMinusCos = [](double degrees) { return 2 * std::pow(std::sin(degrees * M_PI / 360), 2); };
    const double end = oneMinusCos(cone.angle), start = oneMinusCos(cone.angle - cone.delta);
    FloorRig rig = RigOf(1);
    rig.middle = {0, 0, 0};
    const bool isNeedle = cone.angle < 45;
    if (isNeedle) Narrow(rig, 1.5 * std::tan(cone.angle * M_PI / 180));
    const double expected = Lit(rig, 1, [&](const Vector3d& d) {
      const double w = (d.x * d.x + d.z * d.z) / (1 - d.y);  // 1 - cosθ, with cosθ = -d.y
      if (w <= start) return 3.0;
      return w >= end ? 0.0 : 3 * Smoothstep((end - w) / (end - start));
    });
    ExtremeCase extreme{"spot of " + Short(cone.angle) + "°, soft over " + Short(cone.delta) + "°",
                        rig.Scene(At(1,
                                     "LightSource \"spot\" \"rgb I\" [3 3 3] \"point3 to\" [0 -1 0] \"float "
                                     "coneangle\" " +
                                         Number(cone.angle) + " \"float conedeltaangle\" " + Number(cone.delta))),
                        expected, kAll, isNeedle ? 128 : 8};
    cases.push_back(extreme);
  }
  for (const double angle : {0.01, 179.9, 180.0}) {
    for (const double softness : {0.0, 1.0}) {
      FloorRig rig = RigOf(1);
      rig.middle = {0, 0, 0};
      const bool isNeedle = angle < 45;
      if (isNeedle) Narrow(rig, 1.5 * std::tan(angle * M_PI / 180));
      const double expected = Lit(rig, 1, [&](const Vector3d& d) {
        const double theta = std::atan2(std::hypot(d.x, d.z), -d.y) * 180 / M_PI;
        if (softness == 0) return theta <= angle ? 3.0 : 0.0;
        return 3 * (1 - Smoothstep(theta / angle));
      });
      ExtremeCase extreme{"point with a cone of " + Short(angle) + "°, softness " + Short(softness),
                          rig.Scene(At(1, kLookDown +
                                              "LightSource \"point\" \"rgb I\" [3 3 3] \"float "
                                              "shaping:cone:angle\" " +
                                              Number(angle) + " \"float shaping:cone:softness\" " + Number(softness))),
                          expected, kAll, isNeedle ? 128 : 8};
      cases.push_back(extreme);
    }
  }
}

void AddImages(std::vector<ExtremeCase>& cases) {
  // A projector's field: its image covers tan(fov/2) of the floor around the point below.
  for (const double fov : {1e-3, 0.1, 170.0, 179.0}) {
    FloorRig rig = RigOf(1);
    rig.middle = {0, 0, 0};
    const double reach = std::tan(fov * M_PI / 360);
    if (reach < 0.6) Narrow(rig, 0.5 * reach);
    ExtremeCase extreme{"projection of " + Short(fov) + "°",
                        rig.Scene(At(1, "Rotate 90 1 0 0 LightSource \"projection\" \"float fov\" " + Number(fov) +
                                            " \"float scale\" 3 \"string filename\" \"" +
                                            WriteTexels("even", 8, 8, [](int, int) { return 1.0f; }) + "\"")),
                        Lit(rig, 1, [](const Vector3d&) { return 3.0; }), kAll};
    if (fov > 175) extreme.lightSamples = 4096;
    cases.push_back(extreme);
  }
  // One texel of 16 by 16 holds all light: that right of and above the middle, 2 m wide on the floor of 32.
  const auto oneOf = [](float bright, float other) {
    return [=](int x, int y) { return x == 8 && y == 7 ? bright : other; };
  };
  struct Texels {
    const char* name;
    float bright, other;
  };
  for (const Texels& texels : {Texels{"one texel of 1e9 among 1e-3", 1e9f, 1e-3f}, {"all black but one texel", 1, 0}}) {
    FloorRig rig = RigOf(1);
    const double fov = 2 * std::atan(8.0) * 180 / M_PI;  // 16 m on the floor, 1 m a texel
    rig.middle = {0.5, 0, 0.5};
    rig.half = 0.4;
    cases.push_back(
        {std::string("projection, ") + texels.name,
         rig.Scene(At(
             1, "Rotate 90 1 0 0 LightSource \"projection\" \"float fov\" " + Number(fov) + " \"string filename\" \"" +
                    WriteTexels(texels.other > 0 ? "bright" : "only", 16, 16, oneOf(texels.bright, texels.other)) +
                    "\"")),
         Lit(rig, 1, [&](const Vector3d&) { return static_cast<double>(texels.bright); }), kAll});
    // Straight down is the corner of the equal-area square: turned over, it is the middle, of four texels.
    FloorRig below = RigOf(1);
    below.middle = {0, 0, 0};
    const auto middle = [&](int x, int y) {
      return (x == 7 || x == 8) && (y == 7 || y == 8) ? texels.bright : texels.other;
    };
    below.half = 0.05;
    cases.push_back(
        {std::string("goniometric, ") + texels.name,
         below.Scene(At(1, "Rotate 180 1 0 0 LightSource \"goniometric\" \"string filename\" \"" +
                               WriteTexels(texels.other > 0 ? "bright-middle" : "only-middle", 16, 16, middle) + "\"")),
         Lit(below, 1, [&](const Vector3d&) { return static_cast<double>(texels.bright); }), kAll});
  }
  // All light of a profile within a tenth of a degree.
  FloorRig rig = RigOf(1);
  rig.middle = {0, 0, 0};
  Narrow(rig, 1.5 * std::tan(0.1 * M_PI / 180));
  ExtremeCase needle{
      "point with an IES profile of 0.1°",
      rig.Scene(At(1, kLookDown +
                          "LightSource \"point\" \"rgb I\" [1e-6 1e-6 1e-6] \"string "
                          "shaping:ies:file\" \"" +
                          WriteText("needle.ies",
                                    "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 3 1 1 2 0 0 0\n1 1 0\n0 0.1 90\n0\n"
                                    "1000000 0 0\n") +
                          "\"")),
      Lit(rig, 1,
          [](const Vector3d& d) {
            const double theta = std::atan2(std::hypot(d.x, d.z), -d.y) * 180 / M_PI;
            return std::max(0.0, 1 - theta / 0.1);
          }),
      kAll, 64};
  cases.push_back(needle);
}

// Light that arrives at no more than a grain of a degree, or not at all.
void AddGrazing(std::vector<ExtremeCase>& cases) {
  const std::string point = "LightSource \"point\" \"rgb I\" [3 3 3] \"point3 from\" ";
  FloorRig rig;
  rig.half = 0.1;
  rig.middle = {0, 0, 0};
  for (const double height : {1e-6, 1e-4, 1e-2}) {
    const double expected = rig.Radiance([&](const Point3d& P) {
      const Vector3d way = P - Point3d(3, height, 0);
      return 3 * height / std::pow(glm::length(way), 3);
    });
    cases.push_back({"point, " + Short(height) + " above the horizon at 3",
                     rig.Scene(point + "[" + Numbers({3, height, 0}) + "]\n"), expected, kFromCamera});
  }
  cases.push_back({"point in the plane of the floor", rig.Scene(point + "[3 0 0]\n"), 0, kAll});
  cases.push_back({"point on the floor that is seen", rig.Scene(point + "[0.05 0 0.05]\n"), 0, kAll});
  cases.push_back({"point below the floor", rig.Scene(point + "[0 -1 0]\n"), 0, kAll});
}

}  // namespace

std::vector<ExtremeCase> PointLightCases() {
  std::vector<ExtremeCase> cases;
  for (const RigPoint& light : RigPoints()) {
    AddScaled(light, cases);
    AddDistances(light, cases);
    AddIntensities(light, cases);
  }
  for (ExtremeCase& extreme : cases) extreme.lightSamples = 128;
  AddCones(cases);
  AddImages(cases);
  AddGrazing(cases);
  return cases;
}

}  // namespace lampyr::test
