// Surfaces huge and tiny beside each other, stretched, instanced at all scales, with triangles that are none; and
// places far from the origin.
#include <cmath>

#include "extremes/extreme_case.h"
#include "extremes/floor_rig.h"

namespace lampyr::test {

namespace {

const std::string kPoint = "LightSource \"point\" \"rgb I\" [3 3 3] \"point3 from\" ";

double UnderPoint(const FloorRig& rig, double height) {
  return rig.Radiance(
      [&](const Point3d& P) { return 3 * height / std::pow(P.x * P.x + P.z * P.z + height * height, 1.5); });
}
// A square of radiance 3, `size` wide, parallel to the floor.
double UnderSquare(const FloorRig& rig, double height, double width, double depth) {
  return rig.Radiance([&](const Point3d& P) {
    return 3 * RectangleIrradiance(P, {-0.5 * width, height, -0.5 * depth}, {width, 0, 0}, {0, 0, depth});
  });
}

// Corners a million away are rounded to a sixteenth: turned, the floor is not where it should be.
void Limit(double extent, double turn, ExtremeCase& extreme) {
  if (extent < 1e6) return;
  extreme.warning = "points on it are rounded to";
  if (turn == 0) return;
  extreme.limit = "corners at 1e6 are rounded to 0.06";
  extreme.bias = 0.06;
}

FloorRig SmallRig() {
  FloorRig rig;
  rig.places = 16;
  return rig;
}

void AddFloors(std::vector<ExtremeCase>& cases) {
  for (const double extent : {1e2, 1e4, 1e6}) {
    for (const double turn : {0.0, 50.0}) {
      FloorRig rig = SmallRig();
      rig.extent = extent;
      rig.turn = turn;
      const std::string name = "floor of half width " + Short(extent) + (turn != 0 ? ", turned" : "");
      cases.push_back({name + ", point at 1", rig.Scene(kPoint + "[0 1 0]\n"), UnderPoint(rig, 1), kFromCamera});
      Limit(extent, turn, cases.back());
      const double e = extent;
      rig.floor = "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] \"point3 P\" [" +
                  Numbers({-e, 0, -e, e, 0, -e, e, 0, e, -e, 0, e}) + "]\n";
      cases.push_back(
          {name + ", of two triangles, point at 1", rig.Scene(kPoint + "[0 1 0]\n"), UnderPoint(rig, 1), kFromCamera});
      Limit(extent, turn, cases.back());
    }
  }
}

// Triangles without area, in the floor and in the lamp: three points in a line, two that are one, all one.
void AddZeroAreas(std::vector<ExtremeCase>& cases) {
  const std::string none = " 0 1 1  2 2 2  0 4 1  3 3 0";
  FloorRig rig = SmallRig();
  const auto mesh = [&](double size, bool isLamp) {
    const double a = 0.5 * size, b = isLamp ? a : -a;
    return "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3" + none + "] \"point3 P\" [" +
           Numbers({-a, 0, -b, a, 0, -b, a, 0, b, -a, 0, b, 0, 0, -b}) + "]\n";
  };
  rig.floor = mesh(20, false);
  const std::string lamp =
      "AttributeBegin Material \"diffuse\" \"rgb reflectance\" [0 0 0] Translate 0 1 0 AreaLightSource "
      "\"diffuse\" \"rgb L\" [3 3 3] ";
  cases.push_back({"floor with triangles without area", rig.Scene(kPoint + "[0 1 0]\n"), UnderPoint(rig, 1), kAll});
  cases.push_back({"floor and lamp with triangles without area", rig.Scene(lamp + mesh(0.5, true) + "AttributeEnd\n"),
                   UnderSquare(rig, 1, 0.5, 0.5), kAll, 8, 512});
  cases.push_back(
      {"lamp of nothing but triangles without area",
       rig.Scene(
           kPoint + "[0 1 0]\n" + lamp +
           "Shape \"trianglemesh\" \"integer indices\" [0 1 1 2 2 2] \"point3 P\" [0 0 0 1 0 0 2 0 0] AttributeEnd\n"),
       UnderPoint(rig, 1), kAll});
  cases.back().warning = "has no area";
  // A lamp of a needle of a triangle beside a broad one.
  for (const double width : {1e-3, 1e-6}) {
    const double w = width, a = 0.25;
    cases.push_back(
        {"lamp of a square and of needles " + Short(width) + " wide",
         rig.Scene(lamp + "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3  1 4 5  1 5 2] \"point3 P\" [" +
                   Numbers({-a, 0, -a, a - w, 0, -a, a - w, 0, a, -a, 0, a, a, 0, -a, a, 0, a}) + "] AttributeEnd\n"),
         UnderSquare(rig, 1, 0.5, 0.5), kAll, 8, 512});
  }
}

void AddInstances(std::vector<ExtremeCase>& cases) {
  const std::string dark = "Material \"diffuse\" \"rgb reflectance\" [0 0 0] ";
  for (const double scale : {1e-6, 1e-3, 1e3, 1e6}) {
    const double a = 0.25 / scale;
    const FloorRig rig = SmallRig();
    const std::string object = "ObjectBegin \"lamp\" " + dark +
                               "AreaLightSource \"diffuse\" \"rgb L\" [3 3 3] Shape \"trianglemesh\" "
                               "\"integer indices\" [0 1 2 0 2 3] \"point3 P\" [" +
                               Numbers({-a, 0, -a, a, 0, -a, a, 0, a, -a, 0, a}) + "] ObjectEnd\n";
    const std::string by = "Scale " + Numbers({scale, scale, scale});
    cases.push_back({"lamp instanced at a scale of " + Short(scale),
                     rig.Scene(object + "Translate 0 1 0 " + by + " ObjectInstance \"lamp\"\n"),
                     UnderSquare(rig, 1, 0.5, 0.5), kAll, 8, 512});
    FloorRig floor = rig;
    const double e = 20 / scale;
    floor.floor = "AttributeBegin Identity ObjectBegin \"floor\" Shape \"bilinearmesh\" \"point3 P\" [" +
                  Numbers({-e, 0, -e, e, 0, -e, -e, 0, e, e, 0, e}) + "] ObjectEnd AttributeEnd " + by +
                  " ObjectInstance \"floor\"\n";
    cases.push_back({"floor instanced at a scale of " + Short(scale), floor.Scene(kPoint + "[0 1 0]\n"),
                     UnderPoint(floor, 1), kAll});
    for (const char* light : {"rect", "disk", "sphere"}) {
      const std::string kind = light;
      const std::string size = kind == "rect"
                                   ? "\"float width\" " + Number(2 * a) + " \"float height\" " + Number(2 * a)
                                   : "\"float radius\" " + Number(a);
      const double expected = rig.Radiance([&](const Point3d& P) {
        const double d2 = 1 + P.x * P.x + P.z * P.z;
        if (kind == "sphere") return 3 * M_PI * 0.0625 / std::pow(d2, 1.5);
        if (kind == "rect") return 3 * RectangleIrradiance(P, {-0.25, 1, -0.25}, {0.5, 0, 0}, {0, 0, 0.5}, 32);
        const double A = d2 - 0.0625, B = 0.5, Q = std::hypot(A, B);
        return 3 * M_PI / 2 * B * B / (Q * (Q + A));
      });
      cases.push_back({kind + " under a scale of " + Short(scale),
                       rig.Scene("Translate 0 1 0 Rotate -90 1 0 0 " + by + " LightSource \"" + kind +
                                 "\" \"rgb color\" [3 3 3] " + size + "\n"),
                       expected, kAll, 8, 1024});
    }
  }
  // Stretched by 1e4 in one direction, or squeezed.
  for (const double stretch : {1e4, 1e-4}) {
    const FloorRig rig = SmallRig();
    const double width = 0.5 * stretch, shown = std::min(width, 5000.0);
    const auto lambert = [&](const Point3d& P) {
      const auto corner = [](double x, double z) {
        const double rx = std::hypot(x, 1.0), rz = std::hypot(z, 1.0);
        return 0.5 * (x / rx * std::atan(z / rx) + z / rz * std::atan(x / rz));
      };
      const double x0 = -0.5 * shown - P.x, x1 = x0 + shown, z0 = -0.25 - P.z, z1 = z0 + 0.5;
      return 3 * (corner(x1, z1) - corner(x0, z1) - corner(x1, z0) + corner(x0, z0));
    };
    cases.push_back({"rect stretched by " + Short(stretch),
                     rig.Scene("Translate 0 1 0 Scale " + Number(stretch) +
                               " 1 1 Rotate -90 1 0 0 LightSource \"rect\" \"rgb color\" [3 3 3] "
                               "\"float width\" 0.5 \"float height\" 0.5\n"),
                     rig.Radiance(lambert), kFromCamera, 64});
    cases.push_back({"mesh stretched by " + Short(stretch),
                     rig.Scene("Translate 0 1 0 Scale " + Number(stretch) + " 1 1 " + dark +
                               "AreaLightSource \"diffuse\" \"rgb L\" [3 3 3] Shape "
                               "\"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] \"point3 P\" [-0.25 0 -0.25 0.25 0 "
                               "-0.25 0.25 0 0.25 -0.25 0 0.25]\n"),
                     rig.Radiance(lambert), kFromCamera, 64});
    FloorRig squeezed = rig;
    const double e = 20 / stretch;
    squeezed.floor = "Scale " + Number(stretch) + " 1 1 Shape \"bilinearmesh\" \"point3 P\" [" +
                     Numbers({-e, 0, -20, e, 0, -20, -e, 0, 20, e, 0, 20}) + "]\n";
    cases.push_back(
        {"floor stretched by " + Short(stretch), squeezed.Scene(kPoint + "[0 1 0]\n"), UnderPoint(rig, 1), kAll});
  }
}

void AddPlaces(std::vector<ExtremeCase>& cases) {
  for (const double far : {1e4, 1e6, 1e9}) {
    for (const double turn : {0.0, 50.0}) {
      FloorRig rig = SmallRig();
      rig.origin = {far, -2 * far, 0.5 * far};
      rig.turn = turn;
      const std::string name = Short(far) + " sizes from the origin" + (turn != 0 ? ", turned" : "");
      cases.push_back({"point, " + name, rig.Scene(kPoint + "[0 1 0]\n"), UnderPoint(rig, 1), kAll});
      cases.push_back({"rect, " + name,
                       rig.Scene("Translate 0 1 0 Rotate -90 1 0 0 LightSource \"rect\" \"rgb color\" [3 3 3] \"float "
                                 "width\" 0.5 \"float height\" 0.5\n"),
                       UnderSquare(rig, 1, 0.5, 0.5), kAll, 8, 512});
    }
  }
  // Something small in the middle of a plain that goes on for a million of its sizes, off the plain's middle.
  for (const double off : {0.0, 1e2, 1e4}) {
    FloorRig rig = SmallRig();
    rig.turn = 50;
    rig.extent = 10;
    rig.origin = {off, 0, 0.3 * off};
    cases.push_back({"point, " + Short(off) + " from the middle of a scene of size 1e5",
                     rig.Scene(kPoint + "[0 1 0]\nTranslate " + Numbers({-off, -50, -0.3 * off}) +
                               " Shape \"bilinearmesh\" \"point3 P\" [-1e5 0 -1e5 1e5 0 -1e5 -1e5 0 1e5 1e5 0 1e5]\n"),
                     UnderPoint(rig, 1), kFromCamera, 32});
  }
}

}  // namespace

std::vector<ExtremeCase> GeometryCases() {
  std::vector<ExtremeCase> cases;
  AddFloors(cases);
  AddZeroAreas(cases);
  AddInstances(cases);
  AddPlaces(cases);
  return cases;
}

}  // namespace lampyr::test
