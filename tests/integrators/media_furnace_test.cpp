// Furnaces: in an enclosure of radiance B, full of a medium that emits σ_a B, everything has the radiance B, whatever
// the medium scatters, and whatever bound of its extinction collisions are sampled by.
#include <fstream>

#include "integrators/known_media.h"
#include "media/box_medium.h"
#include "support/temporary_folder.h"
#include "support/volume_writer.h"

namespace lampyr::test {
namespace {

const Radiance kFurnace = {1, 0.5, 0.25};

// A closed sphere of radius 1 around the camera that emits `radiance` and reflects nothing, full of the medium "gas".
std::string Furnace(const std::string& medium, const Radiance& radiance = kFurnace) {
  return "Film \"rgb\" \"integer xresolution\" 4 \"integer yresolution\" 4\nPixelFilter \"box\"\n" + medium +
         "MediumInterface \"\" \"gas\"\nCamera \"perspective\" \"float fov\" 90\nIntegrator \"path\" \"integer "
         "maxdepth\" 400\nWorldBegin\nAttributeBegin AreaLightSource \"diffuse\"" +
         Rgb("L", radiance) +
         " Material \"diffuse\" \"rgb reflectance\" [0 0 0] ReverseOrientation MediumInterface \"\" \"gas\" Shape "
         "\"sphere\" AttributeEnd\n";
}

// Without light tracing, whose variance has no bound with the camera in a medium (GlowingMediaScenes in
// tests/agreement compares it with path tracing).
class MediaFurnace : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Of, MediaFurnace, testing::Values("path", "bdpt", "vcm", "sppm", "auto"), NameOfIntegrator);

TEST_P(MediaFurnace, Homogeneous) {
  struct Gas {
    Radiance scattering, absorption;
    double g;
  };
  int number = 0;
  for (const Gas& gas : {Gas{Grey(0), Grey(0.7), 0}, Gas{Grey(2), Grey(0.5), 0}, Gas{Grey(1), Grey(1), 0.9},
                         Gas{Grey(1), Grey(1), -0.9}, Gas{{0.2, 0.6, 1}, {1, 0.4, 0.2}, 0.4}}) {
    const std::string medium = Homogeneous("gas", gas.scattering, gas.absorption, gas.g, Rgb("Le", kFurnace));
    ExpectKnown(std::string(GetParam()) + ", furnace " + std::to_string(++number),
                RenderKnown(Furnace(medium), GetParam(), 128), kFurnace);
  }
}

// White, and far denser in one channel: it has its light still after dozens of collisions. The weights of connections
// take the mean over the channels for the density, so that they are noisier.
TEST_P(MediaFurnace, OfOneColourDenserThanTheOthers) {
  const std::string integrator = GetParam();
  const double precision = integrator == "bdpt" || integrator == "vcm" ? 0.05 : 0.01;
  for (const Radiance& scattering : {Radiance{0.1, 1, 5}, Radiance{5, 0.1, 1}}) {
    const std::string medium = Homogeneous("gas", scattering, Grey(0), 0);
    ExpectKnown(integrator + ", white furnace of colours", RenderKnown(Furnace(medium), GetParam(), 128), kFurnace,
                precision);
  }
}

std::string UniformGrid() {
  const std::string densities =
      Voxels([](int voxel, bool isRim) { return std::to_string(isRim ? 0.0 : VoxelDensity(voxel)); });
  return "MakeNamedMedium \"gas\" \"string type\" \"uniformgrid\"" + kVoxelBox + Rgb("sigma_s", {1, 0.8, 0.6}) +
         Rgb("sigma_a", {0.5, 0.8, 0.6}) + " \"float g\" 0.5" + Rgb("Le", kFurnace) + " \"float density\" [" +
         densities + "]\n";
}

TEST_P(MediaFurnace, UniformGrid) {
  ExpectKnown(std::string(GetParam()) + ", furnace of a grid", RenderKnown(Furnace(UniformGrid()), GetParam(), 224),
              kFurnace);
}

TEST_P(MediaFurnace, RgbGrid) {
  const std::string emission = Voxels([](int, bool) { return std::string("1 0.5 0.25"); });
  ExpectKnown(std::string(GetParam()) + ", furnace of an rgbgrid",
              RenderKnown(Furnace(RgbGrid(-1, -0.3, "\"rgb Le\" [" + emission + "]")), GetParam(), 256), kFurnace);
}

// A medium with a bound of its extinction that is `factor` times as large.
class Loose final : public BoxMedium {
 public:
  Loose(const Medium& medium, float factor)
      : BoxMedium(medium.Name(), medium.Asymmetry(), medium.IsEmissive(), SpaceOf(medium),
                  Scaled(*medium.Majorants(), SpaceOf(medium), factor)),
        medium_(medium) {}

 private:
  MediumCoefficients AtInside(const Point3& p) const override { return medium_.At(ToSpace().Inverse().Point(p)); }
  static const Affine& SpaceOf(const Medium& medium) { return dynamic_cast<const BoxMedium&>(medium).ToSpace(); }
  static MajorantGrid Scaled(const MajorantGrid& grid, const Affine& toSpace, float factor) {
    std::vector<float> majorants = grid.Values();
    for (float& majorant : majorants) majorant *= factor;
    const auto& [nx, ny, nz] = grid.Resolution();
    return {grid.Bounds(), nx, ny, nz, majorants, toSpace};
  }

  const Medium& medium_;
};

BuiltScene Build(const std::string& text, const std::string& integrator) {
  RenderOverrides overrides;
  overrides.integrator = integrator;
  if (integrator == "vcm" || integrator == "auto") overrides.values["radius"] = 0.01;
  Diagnostics diagnostics(Diagnostics::Mode::Collect);
  return BuildScene(ParseScene(text, "furnace.pbrt", diagnostics), overrides, true, diagnostics);
}

Replicas RenderBuiltKnown(BuiltScene& built, int samples) {
  Replicas replicas;
  for (int i = 0; i < kMediaReplicas; ++i) {
    built.settings.seed = static_cast<uint64_t>(i);
    const Rendered rendered = RenderBuilt(built, samples, 1);
    replicas.images.push_back(rendered.image);
    replicas.faults += rendered.outcome.counts.droppedSamples + rendered.rejectedRays;
  }
  return replicas;
}

// Ten times as many tentative collisions change nothing but time.
TEST_P(MediaFurnace, LooseMajorants) {
  BuiltScene built = Build(Furnace(UniformGrid()), GetParam());
  const std::shared_ptr<const Medium> tight = built.scene.media[0];
  built.scene.media[0] = std::make_shared<Loose>(*tight, 10.0f);
  ASSERT_EQ(built.scene.media[0]->Majorants()->At(Point3(0.1f)), 10 * tight->Majorants()->At(Point3(0.1f)));
  ExpectKnown(std::string(GetParam()) + ", 10 times the majorant", RenderBuiltKnown(built, 288), kFurnace);
}

// Sparse voxels that glow by a temperature: the enclosure has the radiance that the medium says.
TEST_P(MediaFurnace, NanoVdb) {
  const TemporaryFolder folder;
  const nanovdb::CoordBBox box({-6, -6, -6}, {6, 6, 6});
  const auto isRim = [](const nanovdb::Coord& at) {
    return std::max({std::abs(at[0]), std::abs(at[1]), std::abs(at[2])}) > 5;
  };
  const nanovdb::Map map = ScalingMap(0.14, nanovdb::Vec3d(0.0));
  const Volume density{"density", box,
                       [&](const nanovdb::Coord& at) {
                         return isRim(at) ? 0.0f
                                          : 0.3f * static_cast<float>((at[0] * 7 + at[1] * 5 + at[2] * 3 + 99) % 8);
                       },
                       map};
  const Volume temperature{"temperature", box, [](const nanovdb::Coord&) { return 4000.0f; }, map};
  const std::string file = (folder / "gas.nvdb").string();
  std::ofstream(file, std::ios::binary) << VolumeFile({density, temperature});
  const std::string medium = "MakeNamedMedium \"gas\" \"string type\" \"nanovdb\" \"string filename\" \"" + file +
                             "\" \"float Lescale\" 0.02 \"float g\" -0.4" + Rgb("sigma_s", {1, 0.8, 0.6}) +
                             Rgb("sigma_a", {0.5, 0.8, 0.6}) + "\n";
  const BuiltScene built = Build(Furnace(medium), GetParam());
  const MediumCoefficients here = built.scene.media[0]->At(Point3(0.07f, 0.14f, 0.21f));
  ASSERT_GT(here.emission.b, 0);
  const Radiance radiance = {static_cast<double>(here.emission.r / here.absorption.r),
                             static_cast<double>(here.emission.g / here.absorption.g),
                             static_cast<double>(here.emission.b / here.absorption.b)};
  ExpectKnown(std::string(GetParam()) + ", furnace of nanovdb", RenderKnown(Furnace(medium, radiance), GetParam(), 160),
              radiance);
}

}  // namespace
}  // namespace lampyr::test
