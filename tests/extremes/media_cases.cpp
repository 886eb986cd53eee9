// Participating media: mean free paths from next to nothing to far beyond the scene, media that only scatter or only
// absorb, narrow lobes, cameras and boundaries on boundaries, grids with next to nothing in them.
#include <algorithm>
#include <cmath>

#include "extremes/extreme_case.h"

namespace lampyr::test {

namespace {

std::string Grey(const std::string& name, double value) {
  return " \"rgb " + name + "\" [" + Numbers({value, value, value}) + "]";
}
std::string Homogeneous(const std::string& name, double scattering, double absorption, double g = 0,
                        const std::string& more = "") {
  return "MakeNamedMedium \"" + name + "\" \"string type\" \"homogeneous\"" + Grey("sigma_s", scattering) +
         Grey("sigma_a", absorption) + " \"float g\" " + Number(g) + more + "\n";
}

// A parallel camera at z = `eye` that looks along z times `towards`, at a square of half side `half`.
std::string Head(int depth, double half = 0.25, double eye = -2, double towards = 1) {
  return "Film \"rgb\" \"integer xresolution\" 4 \"integer yresolution\" 4\nPixelFilter \"box\"\nLookAt " +
         Numbers({0, 0, eye, 0, 0, eye + towards}) + " 0 1 0\nCamera \"orthographic\" \"float screenwindow\" [" +
         Numbers({-half, half, -half, half}) + "]\nIntegrator \"path\" \"integer maxdepth\" " + std::to_string(depth) +
         "\nWorldBegin\n";
}

// A box of [-1, 1]² from z0 to z1, full of `medium`.
std::string Slab(const std::string& medium, double z0, double z1) {
  return "AttributeBegin Material \"interface\" MediumInterface \"" + medium +
         "\" \"\" Shape \"trianglemesh\" \"point3 P\" [" +
         Numbers({-1, -1, z0, 1, -1, z0, 1, 1, z0, -1, 1, z0, -1, -1, z1, 1, -1, z1, 1, 1, z1, -1, 1, z1}) +
         "] \"integer indices\" [0 2 1 0 3 2  4 5 6 4 6 7  0 1 5 0 5 4  3 6 2 3 7 6  0 7 3 0 4 7  1 2 6 1 6 5] "
         "AttributeEnd\n";
}

const std::string kSky = "LightSource \"infinite\" \"rgb L\" [3 3 3]\n";

void AddMeanFreePaths(std::vector<ExtremeCase>& cases) {
  for (const double path : {1e-6, 1e-3, 1.0, 1e3, 1e6}) {
    const std::string name = "mean free path " + Short(path);
    cases.push_back({name + ", absorbing, before a sky",
                     Head(1) + kSky + Homogeneous("gas", 0, 1 / path) + Slab("gas", 0, 1), 3 * std::exp(-1 / path),
                     kFromCamera});
    ExtremeCase glow{name + ", glowing, without scattering",
                     Head(1) + Homogeneous("gas", 0, 1 / path, 0, Grey("Le", 3)) + Slab("gas", 0, 1),
                     -3 * std::expm1(-1 / path), kFromCamera};
    cases.push_back(glow);
  }
  // A sky is the same everywhere, in what does not absorb, too.
  for (const double path : {0.5, 1e3, 1e6}) {
    for (const double g : {0.0, 0.99, -0.99}) {
      ExtremeCase extreme{"albedo 1, mean free path " + Short(path) + ", g " + Short(g) + ", under a sky",
                          Head(2000) + kSky + Homogeneous("gas", 1 / path, 0, g) + Slab("gas", 0, 1), 3, kFromCamera};
      extreme.samples = path < 1 ? 64 : 8;
      cases.push_back(extreme);
    }
  }
}

// The half space of albedo 0.8 in parallel light (Chandrasekhar): 0.0716004 E₀, seen at 60°, lit at 53°.
void AddHalfSpaces(std::vector<ExtremeCase>& cases) {
  for (const double path : {1e-6, 1e-4, 1e-2}) {
    ExtremeCase extreme{
        "mean free path " + Short(path) + ", albedo 0.8, in the sun",
        "Film \"rgb\" \"integer xresolution\" 4 \"integer yresolution\" 4\nPixelFilter \"box\"\nLookAt 0 1.7320508 -1  "
        "0 0 0  0 1 0\nCamera \"orthographic\" \"float screenwindow\" [-.3 .3 -.3 .3]\nIntegrator \"path\" "
        "\"integer maxdepth\" 200\nWorldBegin\nLightSource \"distant\" \"rgb L\" [3 3 3] \"point3 from\" [0.8 0 -0.6] "
        "\"point3 to\" [0 0 0]\n" +
            Homogeneous("gas", 0.8 / path, 0.2 / path) + Slab("gas", 0, 1),
        3 * 0.0716004,
        kAll,
        64,
        512};
    cases.push_back(extreme);
  }
}

void AddPlaces(std::vector<ExtremeCase>& cases) {
  const std::string gas = Homogeneous("gas", 0, 1);
  ExtremeCase onBoundary{"camera on a boundary, towards the medium", Head(1, 0.25, 0) + kSky + gas + Slab("gas", 0, 1),
                         3 * std::exp(-1.0), kFromCamera};
  onBoundary.warning = "the camera is in the medium";
  cases.push_back(onBoundary);
  cases.push_back({"camera on a boundary, away from the medium", Head(1, 0.25, 0, -1) + kSky + gas + Slab("gas", 0, 1),
                   3, kFromCamera});
  ExtremeCase along{
      "camera on a boundary, along it",
      "Film \"rgb\" \"integer xresolution\" 4 \"integer yresolution\" 4\nPixelFilter \"box\"\nLookAt 0 0 0  "
      "1 0 0  0 0 1\nCamera \"perspective\" \"float fov\" 1\nIntegrator \"path\"\nWorldBegin\n" +
          kSky + gas + Slab("gas", 0, 1),
      1.5 * (1 + std::exp(-1.0)), kFromCamera};
  along.warning = "the camera is in the medium";
  cases.push_back(along);
  const std::string denser = Homogeneous("denser", 0, 2);
  const double next = std::nextafter(1.0f, 2.0f);
  cases.push_back({"two boundaries in one place",
                   Head(1) + kSky + gas + denser + Slab("gas", 0, 1) + Slab("denser", 1, 2), 3 * std::exp(-3.0),
                   kFromCamera});
  cases.push_back({"two boundaries a rounding error apart",
                   Head(1) + kSky + gas + denser + Slab("gas", 0, 1) + Slab("denser", next, 2), 3 * std::exp(-3.0),
                   kFromCamera});
  cases.push_back({"two boundaries that overlap by a rounding error",
                   Head(1) + kSky + gas + denser + Slab("gas", 0, next) + Slab("denser", 1, 2), 3 * std::exp(-3.0),
                   kFromCamera});
}

// 5 × 5 × 5 voxels over a cube of side 1, of which the middle one has a density.
std::string Grid(double density, double scattering, double absorption, const std::string& more) {
  std::string densities;
  for (int i = 0; i < 125; ++i) densities += i == 62 ? Number(density) + " " : "0 ";
  return "MakeNamedMedium \"gas\" \"string type\" \"uniformgrid\" \"integer nx\" 5 \"integer ny\" 5 \"integer nz\" 5 "
         "\"point3 p0\" [-.5 -.5 0] \"point3 p1\" [.5 .5 1]" +
         Grey("sigma_s", scattering) + Grey("sigma_a", absorption) + more + " \"float density\" [" + densities + "]\n";
}

// Mean of 1 - e^(-τ) over a square around a voxel of side h, whose density is a tent in each direction.
double VoxelOpacity(double largestDepth, double h, double half) {
  constexpr int kPlaces = 400;
  double sum = 0;
  for (int i = 0; i < kPlaces; ++i) {
    for (int j = 0; j < kPlaces; ++j) {
      const double x = half * (i + 0.5) / kPlaces, y = half * (j + 0.5) / kPlaces;
      const double tents = std::max(0.0, 1 - x / h) * std::max(0.0, 1 - y / h);
      sum -= std::expm1(-largestDepth * tents);
    }
  }
  return sum / (kPlaces * kPlaces);
}

void AddGrids(std::vector<ExtremeCase>& cases) {
  cases.push_back({"empty grid", Head(1) + kSky + Grid(0, 1, 1, "") + Slab("gas", 0, 1), 3, kFromCamera});
  for (const double density : {1e-6, 1e-2, 1.0, 1e3}) {
    const double opacity = VoxelOpacity(0.2 * density * 40, 0.2, 0.25);
    ExtremeCase dark{"one voxel of density " + Short(density) + " that absorbs, before a sky",
                     Head(1) + kSky + Grid(density, 0, 40, "") + Slab("gas", 0, 1), 3 * (1 - opacity), kFromCamera};
    cases.push_back(dark);
    if (density < 1e-3) continue;
    ExtremeCase bright{"one voxel of density " + Short(density) + " that glows",
                       Head(1) + Grid(density, 0, 40, Grey("Le", 3)) + Slab("gas", 0, 1), 3 * opacity, kFromCamera};
    bright.samples = density < 0.1 ? 512 : density < 100 ? 64 : 20;
    if (density > 100) bright.noise = 0.15;  // thousands of tentative collisions a ray
    cases.push_back(bright);
  }
}

// A point of light in the medium, on the axis of the view: single scattering is 1 / D at the distance D from the axis.
void AddLightOnTheRay(std::vector<ExtremeCase>& cases) {
  const double scattering = 0.5, half = 0.25;
  // σ_s I / (4π D) ∫ e^(-σ_s (t + r)) dθ over the directions from the light.
  const auto radiance = [&](double D) {
    constexpr int kSteps = 200;
    const double from = std::atan(-0.5 / D), to = std::atan(0.5 / D);
    double sum = 0;
    for (int i = 0; i < kSteps; ++i) {
      const double theta = from + (to - from) * (i + 0.5) / kSteps;
      sum += std::exp(-scattering * (0.5 + D * std::tan(theta) + D / std::cos(theta))) * (to - from) / kSteps;
    }
    return scattering * 3 / (4 * M_PI * D) * sum;
  };
  // Over the square in polar coordinates, in which D cancels.
  double sum = 0;
  constexpr int kTurns = 64, kRadii = 64;
  for (int i = 0; i < kTurns; ++i) {
    const double phi = M_PI / 4 * (i + 0.5) / kTurns, reach = half / std::cos(phi);
    for (int j = 0; j < kRadii; ++j) {
      const double D = reach * (j + 0.5) / kRadii;
      sum += radiance(D) * D * reach / kRadii * M_PI / 4 / kTurns;
    }
  }
  ExtremeCase extreme{"a light on the axis of the view",
                      Head(1) + Homogeneous("gas", scattering, 0) + Slab("gas", 0, 1) +
                          "LightSource \"point\" \"rgb I\" [3 3 3] \"point3 from\" [0 0 0.5]\n",
                      8 * sum / (4 * half * half),
                      kAll,
                      512,
                      4096};
  extreme.noise = 0.3;
  cases.push_back(extreme);
}

}  // namespace

std::vector<ExtremeCase> MediaCases() {
  std::vector<ExtremeCase> cases;
  AddMeanFreePaths(cases);
  AddHalfSpaces(cases);
  AddPlaces(cases);
  AddGrids(cases);
  AddLightOnTheRay(cases);
  return cases;
}

}  // namespace lampyr::test
