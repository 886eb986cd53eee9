// Photons: radii next to nothing and larger than the scene, one of them or none, none that lands; many small lamps.
#include <cmath>

#include "extremes/extreme_case.h"
#include "extremes/floor_rig.h"

namespace lampyr::test {

namespace {

// A point of intensity 3 in the middle of a sphere of radius 2 and reflectance 0.5: E = I/r² everywhere, and
// L = ρ/π E (1 + ρ + ρ² …). A cap of a sphere within a distance r of a point has the area π r²: photons do not blur it.
std::string Ball(const std::string& light = "LightSource \"point\" \"rgb I\" [3 3 3]\n") {
  return "Film \"rgb\" \"integer xresolution\" 4 \"integer yresolution\" 4\nPixelFilter \"box\"\nCamera "
         "\"perspective\" \"float "
         "fov\" 60\nIntegrator \"path\" \"integer maxdepth\" 40\nWorldBegin\n" +
         light + "Material \"diffuse\" \"rgb reflectance\" [0.5 0.5 0.5]\nShape \"sphere\" \"float radius\" 2\n";
}
const double kDirect = 0.5 / M_PI * 3 / 4, kAllLight = 2 * kDirect;
const std::vector<std::string> kPhotons = {"sppm", "vcm"};

void AddRadii(std::vector<ExtremeCase>& cases) {
  for (const double radius : {1e-12, 1e-9, 1e-3}) {
    ExtremeCase extreme{"photons within " + Short(radius) + " of a sphere of radius 2", Ball(), kAllLight, {"vcm"}, 16};
    extreme.overrides.values["radius"] = radius;
    extreme.noise = 0.3;
    cases.push_back(extreme);
  }
  for (const double radius : {0.03, 0.3, 1.0}) {
    ExtremeCase extreme{"photons within " + Short(radius) + " of a sphere of radius 2", Ball(), kAllLight, kPhotons, 4};
    extreme.overrides.values["radius"] = radius;
    extreme.noise = 0.3;
    extreme.overrides.values["photons"] = radius < 0.1 ? 4096 : 512;
    cases.push_back(extreme);
  }
  for (const double alpha : {1e-3, 1.0}) {
    ExtremeCase extreme{"photons whose radius shrinks with α " + Short(alpha), Ball(), kAllLight, kPhotons, 4};
    extreme.overrides.values["radius"] = 0.5;
    extreme.overrides.values["photons"] = 512;
    extreme.overrides.values["alpha"] = alpha;
    cases.push_back(extreme);
  }
  for (const double size : {1e-6, 1e6}) {
    const std::string text = "Scale " + Numbers({1 / size, 1 / size, 1 / size}) + "\n" + Ball();
    std::string scaled = text;
    scaled.replace(scaled.find("WorldBegin\n"), 11, "WorldBegin\nScale " + Numbers({size, size, size}) + "\n");
    ExtremeCase extreme{"photons in a sphere of radius " + Short(size) + " times 2", scaled, kAllLight / (size * size),
                        kPhotons, 4};
    extreme.overrides.values["radius"] = 0.5 * size;
    extreme.overrides.values["photons"] = 256;
    cases.push_back(extreme);
  }
  for (const double strength : {1e-30, 1e30}) {
    ExtremeCase extreme{"photons " + Short(strength) + " times as bright",
                        Ball("LightSource \"point\" \"rgb I\" [3 3 3] \"float intensity\" " + Number(strength) + "\n"),
                        strength * kAllLight, kPhotons, 4};
    extreme.overrides.values["radius"] = 0.5;
    extreme.overrides.values["photons"] = 256;
    cases.push_back(extreme);
  }
}

void AddCounts(std::vector<ExtremeCase>& cases) {
  for (const int count : {1, 20000}) {
    ExtremeCase extreme{std::to_string(count) + " light paths a pass", Ball(), kAllLight, kPhotons,
                        count == 1 ? 256 : 1};
    extreme.overrides.values["radius"] = count == 1 ? 1 : 0.05;
    extreme.overrides.values["photons"] = int64_t{count};
    extreme.noise = count == 1 ? 0.3 : 0.25;
    cases.push_back(extreme);
  }
  // All photons go where nothing is, or to the far side of the floor; what is seen is lit by a light that has none.
  const FloorRig rig;
  const std::string even = "LightSource \"infinite\" \"rgb L\" [3 3 3] \"bool traceLightPaths\" false\n";
  for (const char* to : {"0 9 0", "1e6 2 0"}) {
    cases.push_back(
        {std::string("no photon that lands: a spot towards ") + to,
         rig.Scene(even + "LightSource \"spot\" \"rgb I\" [3e6 3e6 3e6] \"point3 from\" [0 2 0] \"point3 to\" [" + to +
                       "] \"float coneangle\" 1 \"float conedeltaangle\" 0.5\n",
                   4),
         1.5, kFromCamera, 32});
  }
  cases.push_back(
      {"no photon that lands: a spot below the floor",
       rig.Scene(even + "LightSource \"spot\" \"rgb I\" [3e6 3e6 3e6] \"point3 from\" [0 -2 0] \"point3 to\" [0 0 0]\n",
                 4),
       1.5, kFromCamera, 32});
  cases.push_back({"no photon at all", rig.Scene(even, 4), 1.5, kFromCamera, 32});
}

// Fifty small lamps far away, and one above the floor: photons go by power, and are worth nothing there.
void AddManyLamps(std::vector<ExtremeCase>& cases) {
  FloorRig rig;
  rig.extent = 3;
  std::string lamps;
  double expected = 0;
  for (int i = 0; i < 50; ++i) {
    const Point3d at(1000.0 + 10 * i, 500, -300.0 * i);
    lamps += "LightSource \"point\" \"rgb I\" [1e3 1e3 1e3] \"point3 from\" [" + Numbers({at.x, at.y, at.z}) + "]\n";
    expected += rig.Radiance([&](const Point3d& P) { return 1e3 * at.y / std::pow(glm::length(at - P), 3); });
  }
  lamps += "LightSource \"point\" \"rgb I\" [3 3 3] \"point3 from\" [0 1 0]\n";
  expected += rig.Radiance([](const Point3d& P) { return 3 / std::pow(1 + P.x * P.x + P.z * P.z, 1.5); });
  cases.push_back({"fifty lamps far away and one near", rig.Scene(lamps, 3), expected, kFromCamera, 32});
}

}  // namespace

std::vector<ExtremeCase> PhotonCases() {
  std::vector<ExtremeCase> cases;
  AddRadii(cases);
  AddCounts(cases);
  AddManyLamps(cases);
  return cases;
}

}  // namespace lampyr::test
