// Scenes with nothing in them, lights without light, and a million lights.
#include <cmath>

#include "extremes/extreme_case.h"
#include "extremes/floor_rig.h"
#include "extremes/light_files.h"
#include "sampling/rng.h"

namespace lampyr::test {

namespace {

const std::string kHead = "Film \"rgb\" \"integer xresolution\" 4 \"integer yresolution\" 4\nPixelFilter \"box\"\n";
const std::string kCamera = kHead + "LookAt 0 0 3 0 0 0 0 1 0\nCamera \"perspective\" \"float fov\" 40\nWorldBegin\n";
const std::string kFloor =
    "Material \"diffuse\" \"rgb reflectance\" [0.5 0.5 0.5] Shape \"bilinearmesh\" \"point3 P\" [-9 0 -9 9 0 -9 -9 0 9 "
    "9 0 9]\n";

void AddNothing(std::vector<ExtremeCase>& cases) {
  const auto dark = [&](const std::string& name, const std::string& scene) {
    ExtremeCase extreme{name, scene, 0, kAll};
    extreme.warning = "the scene has no light";
    cases.push_back(extreme);
  };
  dark("empty text", kHead + "WorldBegin\n");
  dark("only a camera", kCamera);
  dark("only a surface", kCamera + "Shape \"sphere\"\n");
  dark("only a zero-area triangle",
       kCamera + "Shape \"trianglemesh\" \"integer indices\" [0 1 1] \"point3 P\" [0 0 0 1 0 0 0 1 0]\n");
  cases.push_back({"only a point", kCamera + "LightSource \"point\"\n", 0, kAll});
  cases.back().warning = "no shape for light to fall on";
  cases.push_back({"only a sun", kCamera + "LightSource \"distant\"\n", 0, kAll});
  cases.back().warning = "no shape for light to fall on";
  cases.push_back({"only a sky", kCamera + "LightSource \"infinite\" \"rgb L\" [0.3 0.3 0.3]\n", 0.3, kFromCamera});
  cases.push_back({"only a sky of a wide sun",
                   kCamera + "LightSource \"distant\" \"rgb L\" [0.3 0.3 0.3] \"float angle\" 360\n", 0.3,
                   kFromCamera});
  cases.push_back(
      {"only a portal",
       kCamera + "LightSource \"portal\" \"float width\" 100 \"float height\" 100 \"rgb color\" [0.3 0.3 0.3]\n", 0,
       kAll});
  cases.push_back({"only a portal that is seen",
                   kCamera + "Rotate 180 0 1 0 LightSource \"portal\" \"float width\" 100 \"float height\" 100 \"rgb "
                             "color\" [0.3 0.3 0.3]\n",
                   0.3, kFromCamera});
  cases.push_back(
      {"only a rect that is seen",
       kCamera +
           "Rotate 180 0 1 0 LightSource \"rect\" \"float width\" 10 \"float height\" 10 \"rgb color\" [0.3 0.3 0.3]\n",
       0.3, kAll, 8, 1024});
  cases.push_back({"only a mesh of two zero-area triangles that shines, and a sky",
                   kCamera + "LightSource \"infinite\" \"rgb L\" [0.3 0.3 0.3] AreaLightSource \"diffuse\" Shape "
                             "\"trianglemesh\" \"integer indices\" [0 1 1 0 0 2] "
                             "\"point3 P\" [0 0 0 1 0 0 0 1 0]\n",
                   0.3, kFromCamera});
  cases.back().warning = "has no area";
  // A sphere far away that nothing else stands beside.
  cases.push_back({"only a sphere that shines, 1e6 away",
                   kHead + "LookAt 1e6 0 4 1e6 0 0 0 1 0\nCamera \"perspective\" \"float fov\" 10\nWorldBegin\n"
                           "Translate 1e6 0 0 LightSource \"sphere\" \"rgb color\" [3 3 3] \"float radius\" 0.5\n",
                   3 * std::min(1.0, M_PI / 4 * std::pow(std::tan(std::asin(0.125)) / std::tan(5 * M_PI / 180), 2)),
                   {"path", "bdpt"},
                   64});
}

void AddDarkLights(std::vector<ExtremeCase>& cases) {
  const std::string black = WriteTexels("no-light", 16, 8, [](int, int) { return 0.0f; });
  const std::string square = WriteTexels("no-light-square", 8, 8, [](int, int) { return 0.0f; });
  const FloorRig rig;
  const std::string above = "AttributeBegin Translate 0 1 0 Rotate -90 1 0 0 ";
  struct Light {
    std::string name, text;
  };
  const std::vector<Light> lights = {
      {"point", "LightSource \"point\" \"rgb I\" [0 0 0]"},
      {"spot", "LightSource \"spot\" \"rgb I\" [0 0 0]"},
      {"goniometric", "LightSource \"goniometric\" \"string filename\" \"" + square + "\""},
      {"projection", "LightSource \"projection\" \"string filename\" \"" + square + "\""},
      {"distant", "LightSource \"distant\" \"rgb L\" [0 0 0]"},
      {"distant of 10°", "LightSource \"distant\" \"rgb L\" [0 0 0] \"float angle\" 10"},
      {"infinite", "LightSource \"infinite\" \"rgb L\" [0 0 0]"},
      {"infinite with an image", "LightSource \"infinite\" \"string filename\" \"" + square + "\""},
      {"dome", "LightSource \"dome\" \"float intensity\" 0"},
      {"dome with an image", "LightSource \"dome\" \"string texture:file\" \"" + black + "\""},
      {"portal", "LightSource \"portal\" \"float intensity\" 0"},
      {"portal with an image", "LightSource \"portal\" \"string texture:file\" \"" + black + "\""},
      {"rect", "LightSource \"rect\" \"float intensity\" 0"},
      {"rect with an image", "LightSource \"rect\" \"string texture:file\" \"" + black + "\""},
      {"disk", "LightSource \"disk\" \"float intensity\" 0"},
      {"sphere", "LightSource \"sphere\" \"float intensity\" 0"},
      {"cylinder", "LightSource \"cylinder\" \"float intensity\" 0"},
      {"mesh", "AreaLightSource \"diffuse\" \"rgb L\" [0 0 0] Shape \"sphere\" \"float radius\" 0.5"},
  };
  std::string all;
  for (const Light& light : lights) {
    const std::string text = above + light.text + " AttributeEnd\n";
    cases.push_back({light.name + " without light", rig.Scene(text, 3), 0, kAll});
    all += text;
  }
  cases.push_back({"all of these without light", rig.Scene(all, 3), 0, kAll});
  cases.push_back({"all of these without light, and a point",
                   rig.Scene("LightSource \"point\" \"rgb I\" [3 3 3] \"point3 from\" [0 0.4 0]\n" + all, 1),
                   rig.Radiance([](const Point3d& P) { return 3 * 0.4 / std::pow(P.x * P.x + P.z * P.z + 0.16, 1.5); }),
                   kFromCamera, 32});
}

// Lights that differ by sixty decades: the dim ones are not lost, nor the bright ones.
void AddContrasts(std::vector<ExtremeCase>& cases) {
  const FloorRig rig;
  const auto point = [](double strength, double x) {
    return "LightSource \"point\" \"rgb I\" [3 3 3] \"float intensity\" " + Number(strength) + " \"point3 from\" [" +
           Numbers({x, 1, 0}) + "]\n";
  };
  const auto lit = [&](double x) {
    return rig.Radiance([&](const Point3d& P) { return 3 / std::pow((P.x - x) * (P.x - x) + P.z * P.z + 1, 1.5); });
  };
  cases.push_back(
      {"a point of 1e30 and one of 1e-30", rig.Scene(point(1e30, 0) + point(1e-30, 1)), 1e30 * lit(0), kFromCamera});
  // All bright parts are hidden.
  cases.push_back(
      {"a point of 1e30 below the floor, and one of 1 above it",
       rig.Scene(point(1, 0) + "LightSource \"point\" \"rgb I\" [3e30 3e30 3e30] \"point3 from\" [0 -1 0]\n"), lit(0),
       kFromCamera, 32});
  for (const double radiance : {1e-36, 1e32}) {
    cases.push_back(
        {"sky of " + Short(radiance),
         rig.Scene("LightSource \"infinite\" \"rgb L\" [1 1 1] \"float intensity\" " + Number(radiance) + "\n"),
         0.5 * radiance, kFromCamera, 32});
  }
}

void AddMany(std::vector<ExtremeCase>& cases) {
  FloorRig rig;
  rig.extent = 3;
  constexpr int count = 1000000;
  // Points of a total intensity of 3 in a cube of side 1 above the floor.
  const auto places = [] {
    std::vector<Point3d> points;
    Rng rng(7);
    for (int i = 0; i < count; ++i) {
      const Point2 u = rng.NextPoint2();
      points.emplace_back(static_cast<double>(u.x) - 0.5, 1 + static_cast<double>(rng.NextFloat()),
                          static_cast<double>(u.y) - 0.5);
    }
    return points;
  };
  const std::vector<Point3d> points = places();
  FloorRig coarse = rig;
  coarse.places = 4;
  ExtremeCase million{"a million points",
                      rig.Scene("LightSource \"point\" \"rgb I\" [3e-6 3e-6 3e-6]\n"),
                      coarse.Radiance([&](const Point3d& P) {
                        double sum = 0;
                        for (const Point3d& point : points) {
                          const Vector3d way = point - P;
                          const double squared = glm::dot(way, way);
                          sum += 3e-6 * way.y / (squared * std::sqrt(squared));
                        }
                        return sum;
                      }),
                      {"path", "light", "bdpt", "vcm"},
                      16,
                      1024};
  million.bias = 5e-3;  // of the quadrature of the expected value, 4 by 4 places
  million.change = [places](SceneDescription& description) {
    const LightDescription light = description.lights.front();
    description.lights.clear();
    for (const Point3d& at : places()) {
      description.lights.push_back(light);
      description.lights.back().placement.start = description.lights.back().placement.end =
          light.placement.start * Transform::Translate(Vector3d(at));
    }
  };
  cases.push_back(million);
  // A lamp of a million triangles.
  ExtremeCase mesh{"a lamp of half a million triangles",
                   rig.Scene("Translate 0 1 0 Material \"diffuse\" \"rgb reflectance\" [0 0 0] AreaLightSource "
                             "\"diffuse\" \"rgb L\" [3 3 3] "
                             "Shape \"trianglemesh\" \"integer indices\" [0 1 2] \"point3 P\" [0 0 0 1 0 0 0 0 1]\n"),
                   rig.Radiance([](const Point3d& P) {
                     return 3 * RectangleIrradiance(P, {-0.25, 1, -0.25}, {0.5, 0, 0}, {0, 0, 0.5}, 16);
                   }),
                   {"path", "light", "bdpt", "vcm"},
                   16,
                   1024};
  mesh.change = [](SceneDescription& description) {
    constexpr int n = 500;
    std::vector<Parameter> parameters = description.shapes.back().shape.parameters.All();
    for (Parameter& parameter : parameters) {
      if (parameter.name == "P") {
        parameter.numbers.clear();
        for (int i = 0; i < (n + 1) * (n + 1); ++i) {
          for (const double x : {0.5 * (i % (n + 1)) / n - 0.25, 0.0, 0.5 * (i / (n + 1)) / n - 0.25})
            parameter.numbers.push_back(x);
        }
      } else {
        parameter.integers.clear();
        for (int64_t i = 0; i < n * n; ++i) {
          const int64_t corner = i / n * (n + 1) + i % n;
          for (const int64_t k : {corner, corner + 1, corner + n + 2, corner, corner + n + 2, corner + n + 1})
            parameter.integers.push_back(k);
        }
      }
    }
    StatementDescription& shape = description.shapes.back().shape;
    shape.parameters = ParameterList(shape.where, shape.parameters.Owner(), parameters);
  };
  cases.push_back(mesh);
}

}  // namespace

std::vector<ExtremeCase> DegenerateCases() {
  std::vector<ExtremeCase> cases;
  AddNothing(cases);
  AddDarkLights(cases);
  AddContrasts(cases);
  AddMany(cases);
  return cases;
}

}  // namespace lampyr::test
