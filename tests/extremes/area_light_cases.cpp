// Lights that are a surface: every shape from a millionth of the distance to a million of it, in scenes of all sizes
// and places; images of one texel; surfaces seen edge-on, touched, and half below the horizon.
#include <algorithm>

#include "extremes/extreme_case.h"
#include "extremes/floor_rig.h"
#include "extremes/light_files.h"

namespace lampyr::test {

namespace {

// A surface of radiance 3 around the origin of its own space that shines down (-y) at least.
struct RigSurface {
  std::string name;
  std::function<std::string(double size)> text;
  // At P on the floor, of a surface at `height` over the origin.
  std::function<double(const Point3d& P, double height, double size)> irradiance;
};

// Irradiance by a parallel rectangle that faces P: Lambert's formula corner by corner, and quadrature where that
// cancels.
double ParallelRectangle(const Point3d& P, double height, double width, double depth) {
  const double x0 = -0.5 * width - P.x, z0 = -0.5 * depth - P.z;
  if (std::max(width, depth) < 0.3 * height)
    return RectangleIrradiance({0, 0, 0}, {x0, height, z0}, {width, 0, 0}, {0, 0, depth}, 16);
  const auto corner = [height](double x, double z) {
    const double rx = std::hypot(x, height), rz = std::hypot(z, height);
    return 0.5 * (x / rx * std::atan(z / rx) + z / rz * std::atan(x / rz));
  };
  return corner(x0 + width, z0 + depth) - corner(x0, z0 + depth) - corner(x0 + width, z0) + corner(x0, z0);
}

// Irradiance by a parallel disk: π/2 (1 - A / √(A² + B²)) with A = h² + ρ² - a², B = 2ha, which avoids cancellation.
double ParallelDisk(const Point3d& P, double height, double radius) {
  const double A = height * height + P.x * P.x + P.z * P.z - radius * radius, B = 2 * height * radius;
  const double Q = std::hypot(A, B);
  return M_PI / 2 * (A > 0 ? B * B / (Q * (Q + A)) : (Q - A) / Q);
}

// Irradiance by a sphere that is all above the horizon.
double Sphere(const Point3d& P, double height, double radius) {
  const double d2 = height * height + P.x * P.x + P.z * P.z;
  return M_PI * radius * radius * height / (d2 * std::sqrt(d2));
}

// Irradiance by the outer side of a cylinder along x, by quadrature.
double Cylinder(const Point3d& P, double height, double radius, double length) {
  constexpr int n = 48, m = 96;
  double sum = 0;
  for (int i = 0; i < n * m; ++i) {
    const double x = length * ((i % n + 0.5) / n - 0.5), phi = 2 * M_PI * (i / n + 0.5) / m;
    const Vector3d normal(0, std::cos(phi), std::sin(phi));
    const Vector3d way = Vector3d(x, height, 0) + radius * normal - P;
    const double squared = glm::dot(way, way), facing = -glm::dot(way, normal);
    if (facing > 0 && way.y > 0) sum += facing * way.y / (squared * squared);
  }
  return sum * length * 2 * M_PI * radius / (n * m);
}

const std::string kDiffuse = "AreaLightSource \"diffuse\" \"rgb L\" [3 3 3] ";

std::vector<RigSurface> RigSurfaces() {
  const std::string down = "Rotate -90 1 0 0 ";  // -z to -y
  const auto square = [](const Point3d& P, double height, double size) {
    return 3 * ParallelRectangle(P, height, size, size);
  };
  const auto disk = [](const Point3d& P, double height, double size) {
    return 3 * ParallelDisk(P, height, 0.5 * size);
  };
  const auto sphere = [](const Point3d& P, double height, double size) { return 3 * Sphere(P, height, 0.5 * size); };
  const auto cylinder = [](const Point3d& P, double height, double size) {
    return 3 * Cylinder(P, height, 0.25 * size, size);
  };
  const auto ofSize = [](double factor, const char* name) {
    return [=](double size) { return " \"float " + std::string(name) + "\" " + Number(factor * size); };
  };
  const auto radius = ofSize(0.5, "radius");
  return {
      {"rect",
       [=](double size) {
         return down + "LightSource \"rect\" \"rgb color\" [3 3 3]" + ofSize(1, "width")(size) +
                ofSize(1, "height")(size);
       },
       square},
      {"disk", [=](double size) { return down + "LightSource \"disk\" \"rgb color\" [3 3 3]" + radius(size); }, disk},
      {"sphere", [=](double size) { return "LightSource \"sphere\" \"rgb color\" [3 3 3]" + radius(size); }, sphere},
      {"cylinder",
       [=](double size) {
         return "LightSource \"cylinder\" \"rgb color\" [3 3 3]" + ofSize(0.25, "radius")(size) +
                ofSize(1, "length")(size);
       },
       cylinder},
      {"mesh",
       [](double size) {
         const double a = 0.5 * size;
         return kDiffuse + "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] \"point3 P\" [" +
                Numbers({-a, 0, -a, a, 0, -a, a, 0, a, -a, 0, a}) + "]";
       },
       square},
      {"emitting sphere", [=](double size) { return kDiffuse + "Shape \"sphere\"" + radius(size); }, sphere},
      {"emitting disk", [=](double size) { return "Rotate 90 1 0 0 " + kDiffuse + "Shape \"disk\"" + radius(size); },
       disk},
      {"emitting cylinder",
       [=](double size) {
         return "Rotate 90 0 1 0 " + kDiffuse + "Shape \"cylinder\"" + ofSize(0.25, "radius")(size) +
                ofSize(-0.5, "zmin")(size) + ofSize(0.5, "zmax")(size);
       },
       cylinder},
      {"emitting patch",
       [](double size) {
         const double a = 0.5 * size;
         return kDiffuse + "Shape \"bilinearmesh\" \"point3 P\" [" + Numbers({-a, 0, -a, a, 0, -a, -a, 0, a, a, 0, a}) +
                "]";
       },
       square},
  };
}

FloorRig RigOf(double height) {
  FloorRig rig;
  rig.half = 0.5 * height;
  rig.middle = {0.2 * height, 0, -0.1 * height};
  rig.eye = 0.1 * height;
  rig.extent = 10 * height;
  rig.places = 16;
  return rig;
}

double Lit(const FloorRig& rig, const RigSurface& light, double height, double size) {
  return rig.Radiance([&](const Point3d& P) { return light.irradiance(P, height, size); });
}

// Lights of the suite end within their own block: what follows them is not theirs.
std::string At(double height, const std::string& light) {
  return "AttributeBegin Material \"diffuse\" \"rgb reflectance\" [0 0 0] Translate 0 " + Number(height) + " 0 " +
         light + " AttributeEnd\n";
}

void AddPlaces(const RigSurface& light, std::vector<ExtremeCase>& cases) {
  for (const double size : {1e-6, 1e-3, 1e3, 1e6}) {
    const FloorRig rig = RigOf(size);
    cases.push_back({light.name + ", everything of size " + Short(size), rig.Scene(At(size, light.text(0.5 * size))),
                     Lit(rig, light, size, 0.5 * size), kAll});
  }
  FloorRig moved = RigOf(1);
  moved.origin = {1e4, -2e4, 3e4};
  cases.push_back({light.name + ", 3.7e4 sizes from the origin", moved.Scene(At(1, light.text(0.5))),
                   Lit(moved, light, 1, 0.5), kAll});
  // The power of the last two is beyond what a float holds.
  struct Bright {
    double size, strength;
  };
  for (const Bright& bright : {Bright{1, 1e-30}, {1, 1e30}, {1e-6, 1e-30}, {1e6, 1e30}}) {
    std::string text = light.text(0.5 * bright.size);
    const size_t at = text.find("[3 3 3]") + 7;
    text.insert(at, " \"float intensity\" " + Number(bright.strength));
    cases.push_back({light.name + ", " + Short(bright.strength) + " times as bright" +
                         (bright.size != 1 ? ", of size " + Short(bright.size) : ""),
                     RigOf(bright.size).Scene(At(bright.size, text)),
                     bright.strength * Lit(RigOf(bright.size), light, bright.size, 0.5 * bright.size), kAll});
  }
}

void AddSizes(const RigSurface& light, std::vector<ExtremeCase>& cases) {
  struct Place {
    double size, distance;
  };
  for (const Place& place : {Place{1e-6, 1}, {1e-3, 1}, {1e-6, 1e-3}, {1, 1e3}, {1, 1e6}, {1e-6, 1e6}, {1e3, 1e6}}) {
    FloorRig rig = RigOf(std::min(place.distance, 1.0));
    cases.push_back({light.name + " of size " + Short(place.size) + " at a distance of " + Short(place.distance),
                     rig.Scene(At(place.distance, light.text(place.size))), Lit(rig, light, place.distance, place.size),
                     place.distance <= 1 ? kAll : kFromCamera});
  }
}

// Lights so near that they fill the sky, or almost touch.
void AddTouching(std::vector<ExtremeCase>& cases) {
  for (const RigSurface& light : RigSurfaces()) {
    const bool isFlat =
        light.name.find("cylinder") == std::string::npos && light.name.find("sphere") == std::string::npos;
    if (light.name.find("cylinder") != std::string::npos) continue;
    FloorRig rig;
    rig.eye = 4e-6;
    rig.half = 0.05;
    rig.middle = {0, 0, 0};
    rig.places = 256;
    if (!isFlat) rig.half = 2e-5;
    for (const double size : {1.0, 1e3}) {
      if (!isFlat && size > 1) continue;
      const double height = 1e-5 + (isFlat ? 0 : 0.5 * size);
      cases.push_back({light.name + " of size " + Short(size) + ", 1e-5 above the floor",
                       rig.Scene(At(height, light.text(size))), Lit(rig, light, height, size), kFromCamera});
    }
  }
  // A point below the middle of a long cylinder: πL R/H.
  FloorRig rig = RigOf(1);
  rig.half = 0.01;
  rig.middle = {0, 0, 0};
  for (const double radius : {1e-6, 1e-3, 0.5}) {
    cases.push_back(
        {"cylinder of radius " + Short(radius) + " and length 1e6, at a distance of 1",
         rig.Scene(At(1, "LightSource \"cylinder\" \"rgb color\" [3 3 3] \"float length\" 1e6 \"float radius\" " +
                             Number(radius))),
         rig.Radiance([&](const Point3d& P) { return 3 * M_PI * radius / (1 + P.z * P.z); }), kFromCamera, 32});
  }
  for (const double length : {1e-6, 1e-3}) {
    cases.push_back(
        {"cylinder of radius 0.2 and length " + Short(length),
         RigOf(1).Scene(At(1, "LightSource \"cylinder\" \"rgb color\" [3 3 3] \"float radius\" 0.2 \"float length\" " +
                                  Number(length))),
         RigOf(1).Radiance([&](const Point3d& P) { return 3 * Cylinder(P, 1, 0.2, length); }), kAll});
    cases.back().lightSamples = 512;
  }
}

// In the plane of the receiver, standing on it, turned away from it, half below it, around it.
void AddEdges(std::vector<ExtremeCase>& cases) {
  FloorRig rig = RigOf(1);
  const auto rect = [](const std::string& place, const std::string& size, const std::string& more = "") {
    return "AttributeBegin " + place + " LightSource \"rect\" \"rgb color\" [3 3 3] " + size + more + " AttributeEnd\n";
  };
  const std::string large = "\"float width\" 1 \"float height\" 1";
  for (const char* sides : {"", " \"bool twoSided\" true"}) {
    const std::string name = *sides ? "rect of two sides" : "rect";
    cases.push_back({name + ", in the plane of the floor",
                     rig.Scene(rect("Translate 5 0 0 Rotate -90 1 0 0", large, sides)), 0, kAll});
    cases.push_back({name + ", 1e-6 below the plane of the floor",
                     rig.Scene(rect("Translate 5 -1e-6 0 Rotate -90 1 0 0", large, sides)), 0, kAll});
    for (const double height : {1e-5, 1e-3}) {
      cases.push_back({name + ", " + Short(height) + " above the plane of the floor, at 5",
                       rig.Scene(rect("Translate 5 " + Number(height) + " 0 Rotate -90 1 0 0", large, sides)),
                       rig.Radiance([&](const Point3d& P) {
                         return 3 * RectangleIrradiance(P, {4.5, height, -0.5}, {1, 0, 0}, {0, 0, 1});
                       }),
                       kFromCamera, 32});
    }
  }
  cases.push_back({"rect, turned away", rig.Scene(rect("Translate 0 1 0 Rotate 90 1 0 0", large)), 0, kAll});
  for (const double high : {1.0, 1e-3, 1e-6}) {
    cases.push_back({"rect, " + Short(high) + " high, standing on the floor",
                     rig.Scene(rect("Translate 3 " + Number(0.5 * high) + " 0 Rotate 90 0 1 0",
                                    "\"float width\" 1 \"float height\" " + Number(high))),
                     rig.Radiance([&](const Point3d& P) {
                       return 3 * RectangleIrradiance(P, {3, 0, -0.5}, {0, 0, 1}, {0, high, 0});
                     }),
                     kFromCamera, 32});
    cases.push_back(
        {"rect, 1 by " + Short(high) + ", at a distance of 1",
         rig.Scene(rect("Translate 0 1 0 Rotate -90 1 0 0", "\"float width\" 1 \"float height\" " + Number(high))),
         rig.Radiance([&](const Point3d& P) { return 3 * ParallelRectangle(P, 1, 1, high); }), kAll, 8, 512});
  }
  // The middle on the horizon, at a distance D: L (α - sinα cosα) with sinα = R/D.
  for (const double radius : {1e-4, 0.1, 1.5}) {
    const double expected = rig.Radiance([&](const Point3d& P) {
      const double alpha = std::asin(radius / std::hypot(P.x - 3, P.z));
      // α - sin 2α / 2, by its series where it cancels.
      return 3 * (alpha < 1e-3 ? 2. / 3 * alpha * alpha * alpha : alpha - 0.5 * std::sin(2 * alpha));
    });
    cases.push_back(
        {"sphere of radius " + Short(radius) + ", half below the horizon",
         rig.Scene("AttributeBegin Translate 3 0 0 LightSource \"sphere\" \"rgb color\" [3 3 3] \"float radius\" " +
                   Number(radius) + " AttributeEnd\n"),
         expected, kFromCamera, 64});
  }
  for (const double radius : {1.0, 1e3, 1e6}) {
    FloorRig inside = rig;
    inside.extent = 0.5;
    inside.middle = {0, 0, 0};
    inside.half = 0.3;
    cases.push_back(
        {"inside of a sphere of radius " + Short(radius),
         inside.Scene("AttributeBegin ReverseOrientation AreaLightSource \"diffuse\" \"rgb L\" [3 3 3] Material "
                      "\"diffuse\" \"rgb reflectance\" [0 0 0] Shape \"sphere\" \"float radius\" " +
                      Number(radius) + " AttributeEnd\n"),
         0.5 / M_PI * 3 * M_PI, kFromCamera, 32});
  }
}

void AddImages(std::vector<ExtremeCase>& cases) {
  struct Texels {
    const char *name, *file;
    float bright, other;
  };
  // The four by 16 texels in the middle of 16 by 16.
  for (const Texels& texels : {Texels{"16 texels of 1e9 among 1e-3", "middle-bright", 1e9f, 1e-3f},
                               {"all black but 16 texels", "middle-only", 1, 0},
                               {"all black", "all-black", 0, 0}}) {
    const std::string file = WriteTexels(texels.file, 16, 16, [&](int x, int y) {
      return x >= 6 && x < 10 && y >= 6 && y < 10 ? texels.bright : texels.other;
    });
    const FloorRig rig = RigOf(1);
    for (const double size : {1.0, 1e-6}) {
      const auto of = [&](double part) {
        return rig.Radiance([&](const Point3d& P) { return ParallelRectangle(P, 1, part * size, part * size); });
      };
      const double expected = static_cast<double>(texels.other) * of(1) +
                              (static_cast<double>(texels.bright) - static_cast<double>(texels.other)) * of(0.25);
      cases.push_back({"rect of size " + Short(size) + ", " + texels.name,
                       rig.Scene(At(1, "Rotate -90 1 0 0 LightSource \"rect\" \"string texture:file\" \"" + file +
                                           "\" \"float width\" " + Number(size) + " \"float height\" " + Number(size))),
                       expected, kAll, 32, 512});
      if (size < 1) continue;
      // The triangles of a mesh are sampled evenly, whatever is on them.
      const double a = 0.5 * size;
      cases.push_back(
          {"mesh of size " + Short(size) + ", " + texels.name,
           rig.Scene(At(1, "AreaLightSource \"diffuse\" \"string filename\" \"" + file +
                               "\" Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] \"point2 uv\" [0 0 1 0 1 1 "
                               "0 1] \"point3 P\" [" +
                               Numbers({-a, 0, -a, a, 0, -a, a, 0, a, -a, 0, a}) + "]")),
           expected, kAll, 384, 2048});
    }
  }
}

// Cones and lobes of light that leave a surface.
void AddShapings(std::vector<ExtremeCase>& cases) {
  FloorRig rig = RigOf(1);
  rig.places = 128;
  const auto shaped = [&](const std::string& shaping) {
    return rig.Scene(
        At(1,
           "Rotate -90 1 0 0 LightSource \"rect\" \"rgb color\" [3 3 3] \"float width\" 1e-3 \"float height\" "
           "1e-3 " +
               shaping));
  };
  const auto lit = [&](const std::function<double(double cosine)>& shape) {
    return rig.Radiance([&](const Point3d& P) {
      return 3 * ParallelRectangle(P, 1, 1e-3, 1e-3) * shape(1 / std::sqrt(1 + P.x * P.x + P.z * P.z));
    });
  };
  cases.push_back({"rect with a focus of 1e3", shaped("\"float shaping:focus\" 1000"),
                   lit([](double cosine) { return std::pow(cosine, 1000); }), kFromCamera, 160});
  cases.push_back(
      {"rect with a focus of 1e-6", shaped("\"float shaping:focus\" 1e-6"), lit([](double) { return 1.0; }), kAll});
  FloorRig below = rig;
  below.middle = {0, 0, 0};
  below.half = 2e-3;
  below.extent = 0.01;
  const auto beam = [&](const char* shaping) {
    return below.Scene(
        At(1, std::string("Rotate -90 1 0 0 LightSource \"rect\" \"rgb color\" [3 3 3] \"float width\" 1e-3 \"float "
                          "height\" 1e-3 ") +
                  shaping));
  };
  // All that goes down within 0.01°: L · area · π sin²θ on the patch's area.
  const double sine = std::sin(0.01 * M_PI / 180);
  cases.push_back({"rect with a cone of 0.01°", beam("\"float shaping:cone:angle\" 0.01"),
                   0.5 / M_PI * 3 * 1e-6 * M_PI * sine * sine / (16e-6), kAll, 1024, 2048});
  cases.back().noise = 0.2;
  cases.push_back({"rect with a cone of 179.9°", shaped("\"float shaping:cone:angle\" 179.9"),
                   lit([](double) { return 1.0; }), kAll});
}

}  // namespace

std::vector<ExtremeCase> AreaLightCases() {
  std::vector<ExtremeCase> cases;
  for (const RigSurface& light : RigSurfaces()) {
    const size_t first = cases.size();
    AddPlaces(light, cases);
    AddSizes(light, cases);
    if (!light.name.starts_with("emitting")) continue;
    // Shapes that the lights above have, too.
    for (size_t i = first; i < cases.size(); ++i)
      std::erase(cases[i].integrators, "sppm"), std::erase(cases[i].integrators, "vcm");
  }
  // Most of what spheres and cylinders send out goes elsewhere.
  for (ExtremeCase& extreme : cases) {
    if (extreme.name.find("sphere") != std::string::npos || extreme.name.find("cylinder") != std::string::npos)
      extreme.lightSamples = 512, extreme.noise = 0.15;
  }
  AddTouching(cases);
  AddEdges(cases);
  AddImages(cases);
  AddShapings(cases);
  return cases;
}

}  // namespace lampyr::test
