// Cameras a million away with a field of a thousandth of a degree, lenses of all sizes, and film of all speeds.
#include <cmath>

#include "extremes/extreme_case.h"
#include "extremes/floor_rig.h"

namespace lampyr::test {

namespace {

const std::string kPoint = "LightSource \"point\" \"rgb I\" [3 3 3] \"point3 from\" [0 10 0]\n";
const std::string kSun = "LightSource \"distant\" \"rgb L\" [3 3 3] \"point3 from\" [0 1 1] \"point3 to\" [0 0 0]\n";

double UnderPoint(const FloorRig& rig) {
  return rig.Radiance([](const Point3d& P) { return 3 * 10 / std::pow(P.x * P.x + P.z * P.z + 100, 1.5); });
}

void AddFields(std::vector<ExtremeCase>& cases) {
  struct Field {
    double distance, fov;
  };
  for (const Field& field : {Field{1e6, 1e-3}, {1e6, 1e-4}, {1e3, 0.01}, {1e-3, 90}, {0.1, 120}}) {
    FloorRig rig;
    rig.eye = field.distance;
    rig.half = field.distance * std::tan(field.fov * M_PI / 360);
    rig.extent = std::max(20.0, 2 * rig.half);
    rig.camera = "Camera \"perspective\" \"float fov\" " + Number(field.fov);
    cases.push_back(
        {"perspective camera at a distance of " + Short(field.distance) + ", " + Short(field.fov) + "° wide",
         rig.Scene(kPoint), UnderPoint(rig), rig.half > 1 ? kAll : kFromCamera, 8, 1024});
  }
  for (const double fov : {1e-3, 170.0, 179.0}) {
    FloorRig rig;
    rig.eye = 0.05;
    rig.extent = 20;
    rig.camera = "Camera \"perspective\" \"float fov\" " + Number(fov);
    cases.push_back({"perspective camera, " + Short(fov) + "° wide, under the sun", rig.Scene(kSun),
                     1.5 / M_PI * std::sqrt(0.5), kFromCamera});
  }
  for (const double half : {1e-6, 1e-3, 1e3, 1e6}) {
    FloorRig rig;
    rig.eye = 1;
    rig.half = half;
    rig.extent = std::max(1e-3, 2 * half);
    cases.push_back({"orthographic camera, " + Short(half) + " of half width, under the sun", rig.Scene(kSun),
                     1.5 / M_PI * std::sqrt(0.5), half >= 1e-3 ? kAll : kFromCamera});
  }
  // Inside a ball that shines by itself and reflects a half.
  for (const double radius : {1e-6, 1.0, 1e6}) {
    for (const char* camera : {"Camera \"spherical\"", "Camera \"perspective\" \"float fov\" 175"}) {
      const bool isSpherical = std::string(camera).find("spherical") != std::string::npos;
      ExtremeCase extreme{
          std::string(isSpherical ? "spherical camera" : "perspective camera of 175°") +
              " in a shining ball of radius " + Short(radius),
          std::string("Film \"rgb\" \"integer xresolution\" 4 \"integer yresolution\" 4\nPixelFilter \"box\"\n") +
              camera +
              "\nIntegrator \"path\" \"integer maxdepth\" 60\nWorldBegin\nReverseOrientation AreaLightSource "
              "\"diffuse\" \"rgb L\" [1 1 "
              "1]\nMaterial \"diffuse\" \"rgb reflectance\" [0.5 0.5 0.5]\nShape \"sphere\" \"float radius\" " +
              Number(radius) + "\n",
          2, kFromCamera, 32};
      extreme.overrides.values["radius"] = 0.3 * radius;
      extreme.overrides.values["photons"] = 256;
      cases.push_back(extreme);
    }
  }
}

void AddLenses(std::vector<ExtremeCase>& cases) {
  for (const double radius : {1e-6, 1e-2, 1e2}) {
    for (const double focus : {1e-3, 1.0, 1e6}) {
      FloorRig rig;
      rig.eye = 1;
      rig.extent = 1e3;
      // Beyond a lens that is wide and focused near, rays are next to parallel to the film: they meet no floor.
      if (radius > 10 * focus) continue;
      rig.camera = "Camera \"perspective\" \"float fov\" 30 \"float lensradius\" " + Number(radius) +
                   " \"float focaldistance\" " + Number(focus);
      cases.push_back({"lens of radius " + Short(radius) + ", focused at " + Short(focus), rig.Scene(kSun),
                       1.5 / M_PI * std::sqrt(0.5), kFromCamera});
    }
  }
}

// The value of film is radiance times exposure time and ISO / 100.
void AddFilm(std::vector<ExtremeCase>& cases) {
  struct Speed {
    double iso, exposure, strength;
  };
  for (const Speed& speed :
       {Speed{1e-3, 1, 1}, {1e6, 1, 1}, {100, 1e-9, 1e9}, {100, 1e9, 1e-9}, {1e12, 1e12, 1e-24}, {1e-6, 1e-6, 1e12}}) {
    FloorRig rig;
    rig.film = "\"float iso\" " + Number(speed.iso);
    rig.camera =
        "Camera \"orthographic\" \"float screenwindow\" [-0.5 0.5 -0.5 0.5] \"float shutteropen\" 0 \"float "
        "shutterclose\" " +
        Number(speed.exposure);
    const double expected = 1.5 / M_PI * std::sqrt(0.5) * speed.strength * speed.iso / 100 * speed.exposure;
    rig.extent = 1;
    cases.push_back({"ISO " + Short(speed.iso) + ", exposed for " + Short(speed.exposure) + ", " +
                         Short(speed.strength) + " times as bright",
                     rig.Scene("LightSource \"distant\" \"rgb L\" [3 3 3] \"float intensity\" " +
                               Number(speed.strength) + " \"point3 from\" [0 1 1] \"point3 to\" [0 0 0]\n"),
                     expected, kAll});
  }
  for (const char* filter :
       {"PixelFilter \"gaussian\" \"float xradius\" 40 \"float yradius\" 40 \"float sigma\" 10",
        "PixelFilter \"box\" \"float xradius\" 1e-3 \"float yradius\" 1e-3", "PixelFilter \"mitchell\"",
        "PixelFilter \"sinc\" \"float xradius\" 8 \"float yradius\" 8"}) {
    FloorRig rig;
    rig.extent = 100;
    std::string text = rig.Scene(kSun);
    text.replace(text.find("PixelFilter \"box\""), 17, filter);
    cases.push_back({std::string(filter).substr(12), text, 1.5 / M_PI * std::sqrt(0.5), kFromCamera, 64});
    // Weights below 0 cancel in part: samples of one pixel are few.
    std::erase(cases.back().name, '"');
  }
}

}  // namespace

std::vector<ExtremeCase> CameraCases() {
  std::vector<ExtremeCase> cases;
  AddFields(cases);
  AddLenses(cases);
  AddFilm(cases);
  return cases;
}

}  // namespace lampyr::test
